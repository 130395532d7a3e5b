"""Numerals on pages in decimals: rounded or exact, and the formula that one stands for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import is_written_exactly
from symobs.formula.tree.nodes import Literal, Numeral, children, with_children

if TYPE_CHECKING:
    from symobs.formula.tree.nodes import Formula


def is_rounded(shown: Formula) -> bool:
    """Return whether a decimal in a formula is not exactly its number."""
    if isinstance(shown, Numeral):
        return not is_written_exactly(shown.value, shown.text)
    return any(map(is_rounded, children(shown)))


def exact_meaning(shown: Formula) -> Formula:
    """Return a formula with the exact number in place of each decimal."""
    if isinstance(shown, Numeral):
        return Literal(shown.value)
    return with_children(shown, tuple(map(exact_meaning, children(shown))))
