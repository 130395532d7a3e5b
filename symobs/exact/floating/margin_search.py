"""The margin with which the matrix of a loop is stable, searched for by trying proofs."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from flint import arb

from symobs.exact.core.ring import Precision
from symobs.exact.floating.stability_margin import is_in_disc, is_left_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.exact.floating.stability_margin import Enclosed

#: A margin is looked for from this power of ten down, with three digits.
_LEAST_EXPONENT = -15


def disc_margin(enclosed: Enclosed) -> Fraction | None:
    """Return some δ > 0 such that every eigenvalue has |z| < 1 − δ, proved; None where no δ is proved."""
    return _largest(lambda margin: is_in_disc(enclosed, margin), Fraction(999, 1000))


def half_plane_margin(enclosed: Enclosed) -> Fraction | None:
    """Return some α > 0 such that every eigenvalue has Re s < −α, proved; None where no α is proved."""
    size = size_of(enclosed)
    return _largest(lambda margin: is_left_of(enclosed, margin, size), size)


def size_of(enclosed: Enclosed) -> Fraction:
    """Return a number of the size of the largest row sum, at least 1."""
    with Precision(64):
        matrix = enclosed(64)
        largest = max((float(sum((abs(entry) for entry in row), arb(0)).mid()) for row in matrix.tolist()), default=1.0)
    return Fraction(max(1, round(largest)))


def _largest(is_proved: Callable[[Fraction], bool], bound: Fraction) -> Fraction | None:
    """Return the largest margin of three digits that is proved, at most `bound`; None where not even 0 is."""
    if not is_proved(Fraction(0)):
        return None
    if is_proved(bound):
        return bound
    exponent = len(str(int(bound)))
    while exponent > _LEAST_EXPONENT and not (Fraction(10) ** exponent < bound and is_proved(Fraction(10) ** exponent)):
        exponent -= 1
    found, step = Fraction(0), Fraction(10) ** exponent
    for _ in range(3):
        while found + step < bound and is_proved(found + step):
            found += step
        step /= 10
    return found
