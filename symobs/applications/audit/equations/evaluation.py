"""Evaluation of printed equations: exact values or signals, or a `Misfit` of sizes."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.applications.audit.equations.letter_values import INSTANTS
from symobs.applications.audit.equations.matrix_functions import (
    MOST_BITS,
    MOST_DEGREE,
    MOST_TERMS,
    Misfit,
    Unknown,
    applied,
    integrated,
    no_fit,
    require_small,
    sized,
    too_large,
)
from symobs.applications.audit.equations.sizes import (
    Flexible,
    Printed,
    alike,
    common,
    equal,
    fitted,
    is_signal,
    kind_of,
    shape,
)
from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.rounded_decimals import as_generator, decimals_in
from symobs.formula.expression.syntax_tree import SyntaxNode, exponent_of
from symobs.formula.tree import Apply, Letter, Literal, Signal
from symobs.formula.tree.term import Term, block
from symobs.ground.errors import InputError
from symobs.proof.certificate.claims import EVALUATION_ERRORS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.audit.equations.reading import Reading

#: So many primes may stand behind each other: derivatives, or transposes.
_MOST_PRIMES = 8


def value_of(node: SyntaxNode, reading: Reading) -> Printed:
    """Return the value of a tree; raises Misfit, Unknown and BudgetExceeded."""
    key = node.text if node.kind == "letter" else id(node)
    if reading.kept is not None and key in reading.kept:
        known: Printed = reading.kept[key][1]
        return known
    found = _value(node, reading)
    if isinstance(found, Term):
        _bounded(found)
        if node.parts and not is_signal(found):  # what stands around it need not evaluate its formula again
            found = Term(Literal(found.value), found.environment)
    if reading.kept is not None:
        reading.kept[key] = (node, found)
    return found


def _bounded(term: Term) -> None:
    value = term.value
    for part in value.coefficients.values() if isinstance(value, Signal) else (value,):
        if part.size > MOST_TERMS or max(part.lengths()) > MOST_BITS or max(part.degrees()) > MOST_DEGREE:
            raise too_large()


def _value(node: SyntaxNode, reading: Reading) -> Printed:
    parts = node.parts
    match node.kind:
        case "number":
            decimal = as_generator(node.text, node.places[0]) if reading.rounding and node.places else None
            assert isinstance(node.value, Scalar)  # noqa: S101 - an invariant of the grammar
            return Term(Literal(decimal or node.value), reading.environment)
        case "letter":
            return _letter(node.text, reading)
        case "sum":
            return _sum(parts, reading)
        case "negative":
            inner = value_of(parts[0], reading)
            return Flexible(-inner.factor) if isinstance(inner, Flexible) else -inner
        case "product":
            total = value_of(parts[0], reading)
            for i, part in enumerate(parts[1:], start=1):
                total = _times(total, value_of(part, reading), SyntaxNode("product", parts[:i]), part)
                if isinstance(total, Term):
                    _bounded(total)
            return total
        case "quotient":
            return _quotient(parts, reading)
        case "power":
            return _power(parts[0], exponent_of(node) or 0, reading)
        case "at":
            return _at(parts[0], parts[1], reading)
        case "primed":
            return _primed(parts[0], reading)
        case "block":
            return _block([row.parts for row in parts], reading)
        case _:
            return _call(node, reading)


def _letter(name: str, reading: Reading) -> Printed:
    environment = reading.environment
    if name in environment.signs:
        return Term(Literal(Scalar.symbol(name)), environment)
    if environment.defines(name) and name != "s":
        return Term(Letter(name), environment)
    if name in {environment.variable, *INSTANTS}:
        return Term(Literal(Scalar.symbol(name)), environment)
    if name == "I":
        return Flexible(Scalar.of(1))
    raise Unknown(name)


def _sum(parts: Sequence[SyntaxNode], reading: Reading) -> Printed:
    found = [value_of(part, reading) for part in parts]
    terms = [(part, value) for part, value in zip(parts, found, strict=True) if isinstance(value, Term)]
    if not terms:
        return Flexible(sum((value.factor for value in found if isinstance(value, Flexible)), Scalar.of(0)))
    if any(isinstance(value, Flexible) for value in found) and all(shape(value) is None for _, value in terms):
        raise no_fit("a number stands beside the identity matrix")
    (head, first) = next(((part, value) for part, value in terms if shape(value) is not None), terms[0])
    total: Term | None = None
    for part, value in zip(parts, found, strict=True):
        term = fitted(value, first) if isinstance(value, Flexible) else value
        if not alike(term, first):
            raise no_fit(f"{_unsigned(head)} {kind_of(first)}, but {_unsigned(part)} {kind_of(term)}")
        total = term if total is None else total + term
    assert total is not None  # noqa: S101 - a sum has parts
    return total


def _unsigned(part: SyntaxNode) -> SyntaxNode:
    return part.parts[0] if part.kind == "negative" else part


def _times(left: Printed, right: Printed, before: SyntaxNode, behind: SyntaxNode) -> Printed:
    if isinstance(left, Flexible):
        if isinstance(right, Flexible):
            return Flexible(left.factor * right.factor)
        return right * left.factor if left.factor != Scalar.of(1) else right
    if isinstance(right, Flexible):
        if shape(left) is None:
            return Flexible(right.factor * left.value)
        return left * right.factor if right.factor != Scalar.of(1) else left
    if is_signal(left):
        if is_signal(right) or shape(right) not in (None, (1, 1)):
            raise Misfit(f"{before} is a signal; {behind} has to stand before it")
        return Term(Literal(right.scalar), right.environment) @ left
    first, second = shape(left), shape(right)
    if first is not None and second is not None and first[1] != second[0]:
        raise no_fit(f"{before} {kind_of(left)} and {behind} {kind_of(right)}")
    return left @ right


def _quotient(parts: Sequence[SyntaxNode], reading: Reading) -> Printed:
    above, below = (value_of(part, reading) for part in parts)
    if isinstance(below, Flexible) or is_signal(below) or shape(below) not in (None, (1, 1)):
        raise Misfit(f"{parts[1]} is no number to divide by")
    divisor = below.scalar
    if divisor.is_zero:
        raise Misfit(f"{parts[1]} is 0")
    reading.fails_where([divisor], f"{parts[1]} is 0")
    return Flexible(above.factor / divisor) if isinstance(above, Flexible) else above / below


def _power(base: SyntaxNode, exponent: int, reading: Reading) -> Printed:
    value = value_of(base, reading)
    if isinstance(value, Flexible):
        if exponent < 0:
            _require_inverse(base, value.factor, reading)
        return Flexible(value.factor**exponent)
    size = shape(value)
    if is_signal(value) or (size is not None and size[0] != size[1]):
        raise no_fit(f"{base} {kind_of(value)}: only square matrices have powers and inverses")
    if exponent < 0:
        if isinstance(value.value, Matrix):
            require_small(value.value)
        whole = value.scalar if size in (None, (1, 1)) else value.value.determinant()
        _require_inverse(base, whole, reading)
        value, exponent = value.inverse, -exponent
    if not exponent:
        return Term(Literal(Scalar.of(1) if size is None else Matrix.identity(size[0])), reading.environment)
    total: Term = value
    for _ in range(exponent - 1):
        total = total @ value
        _bounded(total)
    return total


def _require_inverse(base: SyntaxNode, determinant: Scalar, reading: Reading) -> None:
    if determinant.is_zero:
        raise Misfit(f"{base} has no inverse")
    reading.fails_where([determinant], f"{base} has no inverse")


def _at(function: SyntaxNode, argument: SyntaxNode, reading: Reading) -> Printed:
    """Return a function at its argument: P(0), φ(A); at its own variable, and at a time, it is itself."""
    value, variable = value_of(function, reading), reading.environment.variable
    varies = isinstance(value, Term) and not is_signal(value) and variable in value.value.names
    if argument.kind == "letter" and (argument.text == variable or (argument.text == "t" and not varies)):
        return value
    if not isinstance(value, Term) or not varies:
        raise Misfit(f"{function} is no function of {variable}")
    where = value_of(argument, reading)
    if isinstance(where, Flexible) or is_signal(where):
        raise Misfit(f"{argument} is no number here")
    if isinstance(where.value, Matrix) and where.value.shape != (1, 1):
        return _at_matrix(function, value, argument, where)
    try:
        found = value.value.substitute({variable: where.scalar})
        below = value.value.common_denominator().substitute({variable: where.scalar})
    except ZeroDivisionError:
        raise Misfit(f"{function}({argument}) has no value") from None
    if below.is_zero:
        raise Misfit(f"{function}({argument}) has no value")
    reading.fails_where([below], f"{function}({argument}) has no value")
    return Term(Literal(found), reading.environment)


def _at_matrix(function: SyntaxNode, value: Term, argument: SyntaxNode, where: Term) -> Term:
    polynomial = function.kind == "letter" and isinstance(value.value, Scalar)
    if not polynomial or not value.value.is_polynomial_in(where.environment.variable):
        raise Misfit(f"{function} is no polynomial, which alone has a value at a matrix")
    if where.value.shape[0] != where.value.shape[1]:
        raise no_fit(f"{argument} {kind_of(where)}, but a polynomial takes a square matrix")
    return Term(Apply(f"{function.text}_at", where.formula), where.environment)


def _primed(base: SyntaxNode, reading: Reading) -> Printed:
    inner, primes = base, 1
    while inner.kind == "primed":
        inner, primes = inner.parts[0], primes + 1
    if primes > _MOST_PRIMES:  # each derivative of a signal is longer than the one before
        raise Misfit(f"{primes} primes stand behind each other, more than {_MOST_PRIMES}")
    value = value_of(base, reading)
    if isinstance(value, Flexible):
        return value
    if not is_signal(value):
        return value if shape(value) is None else value.T
    rate = value.derivative
    try:
        rate.value  # noqa: B018 - whether there is one
    except EVALUATION_ERRORS:
        raise Misfit(f"the derivative of {base} is not known here") from None
    return rate


# -- blocks -----------------------------------------------------------------------------------------------------------


def _block(rows: Sequence[Sequence[SyntaxNode]], reading: Reading) -> Printed:
    found = [[value_of(entry, reading) for entry in row] for row in rows]
    found = [[_zero(value) for value in row] for row in found] if _in_blocks(found) else found
    heights: list[int | None] = [None] * len(rows)
    widths: list[int | None] = [None] * len(rows[0])
    for i, row in enumerate(found):
        for j, value in enumerate(row):
            if isinstance(value, Term):
                height, width = shape(value) or (1, 1)
                for sizes, index, size, what in ((heights, i, height, "row"), (widths, j, width, "column")):
                    if sizes[index] not in (None, size):
                        plural = f"{what}{'s' if size != 1 else ''}"
                        message = (
                            f"{rows[i][j]} has {size} {plural}, but another entry of its {what} has {sizes[index]}"
                        )
                        raise no_fit(message)
                    sizes[index] = size
    _spread(found, heights, widths)
    order = reading.environment.values["A"].shape[0] if "A" in reading.environment.values else 1  # type: ignore[union-attr]
    terms = []
    for i, row in enumerate(found):
        line = []
        for j, value in enumerate(row):
            room = (heights[i] or order, widths[j] or order)
            line.append(value if isinstance(value, Term) else _of_size(value, room, reading))
        terms.append(line)
    if any(is_signal(term) for line in terms for term in line) and not all(
        len(line) == 1 and is_signal(line[0]) for line in terms
    ):
        raise Misfit("signals are stacked in one column, with nothing else beside them")
    return block([list(line) for line in terms])


def _in_blocks(found: Sequence[Sequence[Printed]]) -> bool:
    """Return whether a bracket contains matrices, so that a number 0 denotes a zero matrix."""
    values = [value for row in found for value in row]
    return any(isinstance(value, Flexible) or shape(value) not in (None, (1, 1)) for value in values)


def _zero(value: Printed) -> Printed:
    if isinstance(value, Term) and isinstance(value.value, Scalar) and value.value.is_zero:
        return Flexible(Scalar.of(0))
    return value


def _spread(found: Sequence[Sequence[Printed]], heights: list[int | None], widths: list[int | None]) -> None:
    """Propagate sizes between block rows and columns through identity matrices, until nothing changes."""
    for _ in range(len(heights) + len(widths)):
        for i, row in enumerate(found):
            for j, value in enumerate(row):
                if isinstance(value, Flexible) and not value.factor.is_zero:
                    heights[i] = heights[i] or widths[j]
                    widths[j] = widths[j] or heights[i]


def _of_size(value: Flexible, size: tuple[int, int], reading: Reading) -> Term:
    if value.factor.is_zero:
        return Term(Literal(Matrix.zeros(*size)), reading.environment)
    if size[0] != size[1]:
        raise no_fit(f"the identity matrix stands where a {sized(size)} block belongs")
    return Term(Literal(Matrix.identity(size[0]) * value.factor), reading.environment)


# -- functions --------------------------------------------------------------------------------------------------------


def _call(node: SyntaxNode, reading: Reading) -> Printed:
    if node.text == "integral":
        return _integral(node.parts, reading)
    found = [value_of(part, reading) for part in node.parts]
    if node.text == "size":
        return _size(node.parts[0], found[0], reading)
    arguments = [_argument(part, value) for part, value in zip(node.parts, found, strict=True)]
    return Term(Literal(applied(node, arguments, reading)), reading.environment)


def _argument(part: SyntaxNode, value: Printed) -> Matrix:
    if isinstance(value, Flexible) or is_signal(value):
        raise Misfit(f"{part} is no matrix here")
    return value.value if isinstance(value.value, Matrix) else Matrix.of([[value.value]])


def _size(part: SyntaxNode, value: Printed, reading: Reading) -> Term:
    if isinstance(value, Flexible):
        raise Misfit(f"{part} has any size")
    return Term(Literal(Matrix.row(list(shape(value) or (1, 1)))), reading.environment)


def _integral(parts: Sequence[SyntaxNode], reading: Reading) -> Term:
    if parts[1].kind != "letter":
        raise Misfit(f"{parts[1]} is no time to integrate over")
    integrand, begin, end = (_argument(part, value_of(part, reading)) for part in (parts[0], *parts[2:]))
    found = integrated(integrand, parts[1].text, (begin[0, 0], end[0, 0]))
    if found is None:
        raise InputError(f"the integral of {parts[0]} has no closed form here", repair="leave the entry out")
    new = found.common_denominator() / integrand.common_denominator()
    reading.fails_where([new], f"the integral of {parts[0]} is another")
    return Term(Literal(found), reading.environment)


def as_printed(node: SyntaxNode, reading: Reading) -> Matrix | Scalar | None:
    """Return a printed value with decimals as generators, None if decimals are operands of a computation.

    They are compared where numbers, symbols, sums, products and quotients make up a number or the entries of one bracket.
    """
    if _written_as(node, reading) is None:
        return None
    found = value_of(node, replace(reading, rounding=True))
    return None if isinstance(found, Flexible) or is_signal(found) else found.value


def _written_as(node: SyntaxNode, reading: Reading) -> str | None:
    """Return `number` or `block` for a value that is written out, None for what refers to other values."""
    plain = {*reading.environment.signs, reading.environment.variable, *INSTANTS}
    kinds = [_written_as(part, reading) for part in node.parts]
    match node.kind:
        case "number":
            return "number"
        case "letter":
            return "number" if node.text in plain else None
        case "negative" | "primed" | "sum":
            return kinds[0] if len(set(kinds)) == 1 else None
        case "product":
            return None if None in kinds or kinds.count("block") > 1 else "block" if "block" in kinds else "number"
        case "quotient" | "power":
            return kinds[0] if kinds[1] == "number" and (kinds[0] == "number" or node.kind == "quotient") else None
        case "row" | "block":
            return node.kind if set(kinds) == {"row" if node.kind == "block" else "number"} else None
        case _:
            return None


def holds(left: SyntaxNode, right: SyntaxNode, reading: Reading) -> bool:
    """Return whether an equation holds; sizes that do not match make it false."""
    try:
        return equal(*common(value_of(left, reading), value_of(right, reading), reading.environment))
    except (Misfit, Unknown, *EVALUATION_ERRORS):  # InputError is a ValueError
        return False


def is_rounded(node: SyntaxNode, reading: Reading) -> bool:
    """Return whether a side is a value written out with decimals."""
    value = as_printed(node, reading)
    return value is not None and bool(decimals_in(value))
