"""Roots of a polynomial in decimals: the texts that a page prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact.algebraic.enclosure import sign_of_number
from symobs.exact.numerals.rounded_roots import are_rounded_roots, is_exact, is_zero, root_parts
from symobs.exact.numerals.written_digits import significant

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact.algebraic.polynomial_roots import Root
    from symobs.exact.numerals.rounded_roots import Bounds, RootText


def rounded_roots(roots: Sequence[Root], digits: int) -> tuple[RootText, ...] | None:
    """Return the texts of roots, None where one has parameters or cannot be separated from its neighbours."""
    parts = root_parts(roots, digits)
    if parts is None:
        return None
    texts: list[RootText] = []
    for real, imaginary in parts:
        first = _text(real, digits)
        second = "" if is_zero(imaginary) else _text(imaginary, digits)
        if first is None or second is None:
            return None
        exact = is_exact(real, first) and (not second or is_exact(imaginary, second))
        texts.append((first, second, not exact))
    return tuple(texts) if are_rounded_roots(roots, tuple(texts), digits) else None


def _text(bounds: Bounds, digits: int) -> str | None:
    """Return the signed text of a part."""
    if is_zero(bounds):
        return "0"
    sign = sign_of_number(bounds[0])
    if sign not in {"positive", "negative"}:
        return None
    size = significant(bounds[0] if sign == "positive" else -bounds[1], digits)
    return None if size is None else f"{'-' * (sign == 'negative')}{size}"
