"""Places of a picture: whether they lie in its window, and how they are written in messages."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from symobs.picture import Interval, Place

_NOWHERE = (Fraction(0), Fraction(0))


def within(place: Place, window: tuple[Interval, Interval], near: Place = _NOWHERE) -> bool:
    """Whether a place lies in the window, or as near to it as cannot be told apart."""
    return all(low - step <= part <= high + step for part, (low, high), step in zip(place, window, near, strict=True))


def written(place: Place) -> str:
    """Return a place as text."""
    return f"({', '.join(map(str, place))})"
