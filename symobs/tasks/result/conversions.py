"""Conversion of exact values to SymPy and JSON."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Factored, Matrix, Root, Scalar, Shifted
from symobs.exact.core.generators import PI, symbols_named
from symobs.system.conditions import Condition

if TYPE_CHECKING:
    from collections.abc import Container, Iterable, Mapping

    from symobs.system import StateSpace

_IMAGINARY = re.compile(r"\bI\b")
_RELATIONS = {"!=": "!=", "=": "==", "==": "==", ">": ">", ">=": ">=", "<": "<", "<=": "<="}


def signs(plant: StateSpace, values: Iterable[Any] = ()) -> dict[str, str]:
    """Return every symbol of a plant and of some values with its sign."""
    names = {*plant.symbols.signs, *plant.matrices.symbols}.union(*(getattr(value, "names", ()) for value in values))
    names = {plain for name in names for plain in symbols_named(name)} - {plant.variable, "t", PI}
    return {name: plant.symbols.sign(name) for name in sorted(names)}


def to_json(value: Any, symbols: Container[str] = ()) -> Any:
    """Return JSON of a value: exact strings, nested lists, JSON integers and booleans.

    Beside a symbol I the imaginary unit is sqrt(-1).
    """
    if isinstance(value, Matrix):
        return [[str(entry) for entry in row] for row in value.rows]
    if isinstance(value, (Complex, Root, Shifted)) and "I" in symbols and "sqrt(-1)" not in str(value):
        return _IMAGINARY.sub("sqrt(-1)", str(value)) if "I" not in value.names else str(value)
    if isinstance(value, (Scalar, Complex, Factored, Root, Shifted)):
        return str(value)
    if isinstance(value, Condition):
        return f"{value.expression} {_RELATIONS[value.operator]} 0"
    if isinstance(value, (list, tuple)):
        return [to_json(entry, symbols) for entry in value]
    if isinstance(value, dict):
        return {key: to_json(entry, symbols) for key, entry in value.items()}
    return value


def vector(value: Matrix) -> list[str]:
    """Return a column as a flat list."""
    return [str(entry) for entry in value.entries]


def to_sympy(value: Any, objects: Mapping[str, Any]) -> Any:
    """Return the SymPy object of a value; what has none (texts, integers) stays."""
    from symobs.exact.sympy_bridge import conversion  # noqa: PLC0415 - SymPy only when asked for

    if isinstance(value, Matrix):
        return conversion.matrix_to_sympy(value, objects)
    if isinstance(value, Scalar):
        return conversion.scalar_to_sympy(value, objects)
    if isinstance(value, Factored):
        return conversion.factored_to_sympy(value, objects)
    if isinstance(value, Complex):
        return conversion.complex_to_sympy(value, objects)
    if isinstance(value, Root):
        return conversion.root_to_sympy(value, objects)
    if isinstance(value, Shifted):
        return conversion.scalar_to_sympy(value.value, objects) - conversion.root_to_sympy(value.root, objects)
    if isinstance(value, Condition):
        return conversion.relation_to_sympy(value.expression, value.operator, objects)
    if isinstance(value, tuple) and value and all(isinstance(row, tuple) and _are_factored(row) for row in value):
        return conversion.table_to_sympy(value, objects)
    if isinstance(value, (list, tuple)):
        return tuple(to_sympy(entry, objects) for entry in value)
    if isinstance(value, dict):
        return {key: to_sympy(entry, objects) for key, entry in value.items()}
    return value


def _are_factored(row: tuple[Any, ...]) -> bool:
    return bool(row) and all(isinstance(entry, Factored) for entry in row)
