"""Places of a picture: whether they lie in its window, whether a polynomial is stable there (trusted)."""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.rational_points import value_at
from symobs.exact.algebraic.root_location import has_positive_minors
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.stability import bilinear, stability

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.formula.figures.plot import Interval, Place

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
    """Return whether a place lies in the window, to visible accuracy."""
    return all(low - step <= part <= high + step for part, (low, high), step in zip(place, window, near, strict=True))


def written(place: Place) -> str:
    """Return a place as text."""
    return f"({', '.join(map(str, place))})"


@dataclass(frozen=True)
class Stability:
    """Stability of a polynomial over the axes of a plot, which are parameters with declared signs."""

    polynomial: Scalar
    variable: str
    axes: tuple[str, ...]
    signs: tuple[str, ...]
    discrete: bool

    def is_stable(self, *place: Fraction) -> bool:
        """Return whether all roots are stable where the signs allow it; where the degree drops a root has gone to infinity."""
        if not all(ALLOWS[sign](part) for sign, part in zip(self.signs, place, strict=True)):
            return False
        point = dict(zip(self.axes, place, strict=True))
        below, lead, coefficients = self._parts
        if value_at(below, point) == 0 or value_at(lead, point) == 0:
            return False
        return has_positive_minors([value_at(c, point) for c in coefficients])

    @cached_property
    def _parts(self) -> tuple[Scalar, Scalar, tuple[Scalar, ...]]:
        """The denominator, the leading coefficient, and all coefficients of what is stable in continuous time alike."""
        found = self.polynomial.numerator.coefficients(self.variable)
        return self.polynomial.denominator, found[0], tuple(bilinear(found)) if self.discrete else found

    def is_excluded(self, place: tuple[Fraction, ...], around: Sequence[tuple[Fraction, ...]]) -> bool:
        """Return whether a point is not stable, or one that is not lies near: there a condition all but vanishes."""
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
