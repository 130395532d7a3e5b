"""Places of a picture: whether they lie in its window, whether a polynomial is stable there, and how they are written."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.record import dataclass
from symobs.stability import stability

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.picture import Interval, Place

#: A condition of stability is all but zero where it is so much smaller than at the points around.
_SMALLER = 16
_NOWHERE = (Fraction(0), Fraction(0))
#: The numbers that a declared sign allows.
ALLOWS: dict[str, Callable[[Fraction], bool]] = {
    "positive": lambda value: value > 0,
    "negative": lambda value: value < 0,
    "nonnegative": lambda value: value >= 0,
    "nonpositive": lambda value: value <= 0,
    "nonzero": lambda value: value != 0,
    "real": lambda _: True,
}


def within(place: Place, window: tuple[Interval, Interval], near: Place = _NOWHERE) -> bool:
    """Whether a place lies in the window, or as near to it as cannot be told apart."""
    return all(low - step <= part <= high + step for part, (low, high), step in zip(place, window, near, strict=True))


def written(place: Place) -> str:
    """Return a place as text."""
    return f"({', '.join(map(str, place))})"


@dataclass(frozen=True)
class Stability:
    """Where in a picture a polynomial is stable: its axes are parameters of these declared signs."""

    polynomial: Scalar
    variable: str
    axes: tuple[str, ...]
    signs: tuple[str, ...]
    discrete: bool

    def is_stable(self, *place: Fraction) -> bool:
        """Whether all roots are stable where the signs allow it; where the degree drops a root has gone to infinity."""
        if not all(ALLOWS[sign](part) for sign, part in zip(self.signs, place, strict=True)):
            return False
        try:
            there = self.polynomial.substitute(_at(self.axes, place))
        except ZeroDivisionError:
            return False
        if there.degree(self.variable) < self.polynomial.degree(self.variable):
            return False
        return stability(there, self.variable, {}, discrete=self.discrete).verdict == "yes"

    def is_excluded(self, place: tuple[Fraction, ...], around: Sequence[tuple[Fraction, ...]]) -> bool:
        """Whether a point is not stable, or one that is not lies near: there a condition all but vanishes."""
        if not self.is_stable(*place):
            return True
        conditions = stability(self.polynomial, self.variable, {}, discrete=self.discrete).positive
        leading = self.polynomial.coefficients(self.variable)[0]
        return any(
            _SMALLER * abs(_number(value, self.axes, place)) <= min(abs(_number(value, self.axes, p)) for p in around)
            for value in (leading, *conditions)
        )


def _at(axes: Sequence[str], place: Sequence[Fraction]) -> dict[str, Scalar]:
    return {name: Scalar.of(part) for name, part in zip(axes, place, strict=True)}


def _number(value: Scalar, axes: Sequence[str], place: Sequence[Fraction]) -> Fraction:
    return value.substitute(_at(axes, place)).fraction()
