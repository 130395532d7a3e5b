"""The fast path for plain texts: numbers and names with signs, products and quotients, without spaces.

It reads a text or leaves it alone: whatever is wrong, or could mean something else, is for the grammar to say.
"""

from __future__ import annotations

import re
from itertools import chain
from typing import TYPE_CHECKING

from symobs.exact import Field, Scalar
from symobs.expression.names import FUNCTIONS, NAME, refusal

if TYPE_CHECKING:
    from symobs.expression.names import Scope

_ATOM = r"(?:[A-Za-z][A-Za-z0-9_]*|[0-9]{1,18}(?:\.[0-9]{1,18})?)"
_CELL = re.compile(rf"[+-]?{_ATOM}(?:[*/]{_ATOM}){{0,8}}")
_ATOMS = re.compile(rf"([*/+-]?)({_ATOM})")
_MOST_NAMES = 100


def plain_rows(text: str, scope: Scope) -> tuple[list[list[Scalar]], bool] | None:
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
        return None
    names = set(NAME.findall(inside))
    if len(names) > _MOST_NAMES or not all(_is_symbol(name, scope) for name in names):
        return None
    field = Field.of(names) if scope.context is None else scope.context
    known = {name: Scalar.generator(field, name) for name in names}
    try:
        return [[known.get(cell) or _value(_ATOMS.findall(cell), known) for cell in line] for line in lines], bracketed
    except ZeroDivisionError:
        return None


def _is_symbol(name: str, scope: Scope) -> bool:
    """Return whether a name is declared, or may be a symbol where every name may."""
    if name in FUNCTIONS or scope.is_imaginary_unit(name) or refusal(name):
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
