"""The constants of a problem file: names for numbers, `r = "sqrt(3)"` or `c = "cos(theta)"`, that texts may use."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar
from symobs.exact.algebraic.real_algebraic import roots_of_scalar
from symobs.exact.core.generators import PI, function_named
from symobs.formula.expression import declared_name, parse_polynomial, parse_scalar
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError
from symobs.problem.expect.roots import COUNTED
from symobs.problem.file_tables import came
from symobs.system.reading import require_known

if TYPE_CHECKING:
    from collections.abc import Mapping
    from contextlib import AbstractContextManager

    from symobs.system import Symbols

_MAX_CONSTANTS = 100


def with_constants(table: Mapping[str, Any], symbols: Symbols, errors: AbstractContextManager[Any, Any]) -> Symbols:
    """Return the symbols with named constants; `errors` collects the faults."""
    for name, value in list(table.items())[: _MAX_CONSTANTS + 1]:
        before = symbols
        with errors:
            symbols = _with_constant(name, value, symbols)
        if symbols is before and name not in symbols.signs:  # what uses it is no second error
            symbols = replace(symbols, constants={**symbols.constants, name: Scalar.of(1)})
    return symbols


def _with_constant(name: str, value: Any, symbols: Symbols) -> Symbols:
    """Return the symbols with one more name for a number; those before it may occur in its text.

    Raises `InputError` where the name is a symbol too, and where the value is no number.
    """
    where, known = f"constants.{shown(name, 40)}", symbols.constants
    declared_name(name, where)
    if len(known) == _MAX_CONSTANTS:
        message = f"more than {_MAX_CONSTANTS} constants are declared"
        raise InputError(message, where="constants", repair="write the numbers themselves")
    if name in symbols.signs:
        message = f"{name} is declared as a symbol, too"
        raise InputError(message, where=where, repair="keep one of the two declarations")
    if not isinstance(value, (str, int)) or isinstance(value, bool):
        raise InputError(f"a number is expected, but {came(value)} came", where=where, repair='write r = "sqrt(3)"')
    found = _counted(value, where) or parse_scalar(value, {**symbols.signs, **known}, where=where, functions=True)
    if any(function_named(part) is None for part in found.names - {PI}):
        message = f"{name} contains a symbol that is not inside a function, and a constant is a number"
        raise InputError(message, where=where, repair="write the expression where it is needed")
    require_known([found], where)
    return replace(symbols, constants={**known, name: found})


def _counted(value: object, where: str) -> Scalar | None:
    """Return the real root that `CRootOf(x^3 - x - 1, 0)` names, counted from the least; None for another text."""
    written = COUNTED.fullmatch(value) if isinstance(value, str) else None
    if written is None:
        return None
    roots = roots_of_scalar(parse_polynomial(written[1], "x", {}, where=where), "x")
    if int(written[2]) >= len(roots):
        message = f"the polynomial has {len(roots)} real roots, and the first of them is number 0"
        raise InputError(message, where=where, repair='write r = "CRootOf(x^3 - x - 1, 0)"')
    return roots[int(written[2])].scalar()
