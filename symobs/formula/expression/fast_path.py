"""The fast path for plain texts: numbers and names with signs, products and quotients, and a+bi, without spaces.

It reads a text or leaves it alone: whatever is wrong, or could mean something else, is for the grammar to say.
"""

from __future__ import annotations

import re
from itertools import chain
from typing import TYPE_CHECKING

from symobs.exact import Complex, Field, Scalar
from symobs.formula.expression.names import FUNCTIONS, NAME, refusal

if TYPE_CHECKING:
    from symobs.formula.expression.names import Scope
    from symobs.formula.expression.size_limits import Number

_NUMBER = r"[0-9]{1,18}(?:\.[0-9]{1,18})?"
_ATOM = rf"(?:[A-Za-z][A-Za-z0-9_]*|{_NUMBER})"
_CELL = re.compile(rf"[+-]?{_ATOM}(?:[*/]{_ATOM}){{0,8}}")
_SIGNED = rf"[+-]?{_NUMBER}(?:/{_NUMBER})?"
#: A real part, if any, and an imaginary one: -1+3/2i.
_COMPLEX = re.compile(rf"(?:({_SIGNED})(?=[+-]))?([+-]?)({_NUMBER}(?:/{_NUMBER})?)?([A-Za-z])")
_ATOMS = re.compile(rf"([*/+-]?)({_ATOM})")
_MOST_NAMES = 100


def plain_rows(text: str, scope: Scope) -> tuple[list[list[Number]], bool] | None:
    """Return rows of entries, and whether they are in brackets; None if the text is not plain."""
    inside = text.strip(" ")
    if scope.rounding and "." in inside:
        return None
    bracketed = inside[:1] == "[" and inside[-1:] == "]"
    if bracketed:
        lines = [line.split() for line in inside[1:-1].split(";")]
    else:
        lines = [[cell.strip(" ") for cell in inside.split(",")]]
    if "\n" in inside or "\r" in inside or len({len(line) for line in lines}) != 1 or not lines[0]:
        return None
    if not all(map(_CELL.fullmatch, chain.from_iterable(lines))):
        return None if bracketed else _complex_numbers(lines[0], scope)
    names = set(NAME.findall(inside))
    if len(names) > _MOST_NAMES or not all(_is_symbol(name, scope) for name in names):
        return None
    field = Field.of(names) if scope.context is None else scope.context
    known = {name: Scalar.generator(field, name) for name in names}
    try:
        return [[known.get(cell) or _value(_ATOMS.findall(cell), known) for cell in line] for line in lines], bracketed
    except ZeroDivisionError:
        return None


def _complex_numbers(cells: list[str], scope: Scope) -> tuple[list[list[Number]], bool] | None:
    """Return one row of numbers, some of them complex."""
    found: list[Number] = []
    for cell in cells:
        if _CELL.fullmatch(cell) and not NAME.search(cell):
            real, sign, size, unit = cell, "", "0", "i"
        elif parts := _COMPLEX.fullmatch(cell):
            real, sign, size, unit = parts[1] or "0", parts[2], parts[3] or "1", parts[4]
        else:
            return None
        if not scope.is_imaginary_unit(unit):
            return None
        try:
            values = [_value(_ATOMS.findall(text), {}) for text in (real, sign + size)]
        except ZeroDivisionError:
            return None
        found.append(Complex(*values) if values[1] else values[0])
    return [found], False


def _is_symbol(name: str, scope: Scope) -> bool:
    """Return whether a name is declared, or may be a symbol where every name may."""
    if name in FUNCTIONS or scope.is_imaginary_unit(name) or refusal(name) or (scope.poles and scope.unit_first(name)):
        return False
    return scope.names is None or (scope.declares(name) and scope.constant(name) is None)


def _value(cell: list[tuple[str, str]], known: dict[str, Scalar]) -> Scalar:
    """Return ± a * b / c …, from the left."""
    values = [known[atom] if atom in known else _number(atom) for _, atom in cell]
    total = -values[0] if cell[0][0] == "-" else values[0]
    for (operator, _), value in zip(cell[1:], values[1:], strict=True):
        total = total / value if operator == "/" else total * value
    return total


def _number(text: str) -> Scalar:
    whole, _, decimals = text.partition(".")
    return Scalar.rational(int(whole + decimals), 10 ** len(decimals))
