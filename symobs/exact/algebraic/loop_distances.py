"""How far a loop N/P of numbers is from −1 on the boundary of stability, and its slowest root, every digit certain.

On the boundary |P + N|² and |P|² are polynomials of one real number x: x = ω² ≥ 0 where s = jω, and −1 ≤ x = cos θ ≤ 1 where
z = e^{jθ}.  Their ratio r = |1 + N/P|² is smallest at an end or where its derivative vanishes; where |N/P| = 1 the angle from
N/P to −1 is 2 arcsin(√r/2).  Where these x are is decided exactly; values there are enclosed.
"""

from __future__ import annotations

from functools import cached_property, reduce
from typing import TYPE_CHECKING, Any

from flint import arb, fmpz_poly

from symobs.exact.algebraic.real_algebraic import (
    FIRST_BITS,
    RealNumber,
    at_ball,
    ends_of,
    irreducible_factors,
    real_roots,
    roots_of_scalar,
    rounded_to,
)
from symobs.exact.algebraic.root_location import integers
from symobs.exact.core.polynomial import resultant
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from fractions import Fraction

#: What no distance is smaller than, where there is nothing to measure.
INFINITE = "oo"
#: Angles, distances and peaks are rounded to so many digits after the point.
MARGIN_DIGITS = 6
_MOST_BITS = 4096


@dataclass
class Loop:
    """A loop whose closed loop is stable: |P + N|² and |P|² on the boundary, without what they share, and |P|² − |N|²."""

    closed: fmpz_poly
    opened: fmpz_poly
    crossing: fmpz_poly
    discrete: bool

    @staticmethod
    def of(closed: Sequence[Fraction], opened: Sequence[Fraction], *, discrete: bool) -> Loop:
        """Return the loop with the characteristic polynomials P + N and P of one degree, leads 1 first."""
        whole = integers([*closed, *opened])
        first, second = (fmpz_poly(list(reversed(part))) for part in (whole[: len(closed)], whole[len(closed) :]))
        one, other, moved = (_square(p, discrete=discrete) for p in (first, second, first - second))
        common = one.gcd(other)  # it has no root on the boundary: the closed loop is stable
        return Loop(one // common, other // common, other - moved, discrete)

    def modulus(self, digits: int) -> str | None:
        """Return min |1 + N/P| with so many digits after the point."""
        return certain(self._distance, digits)

    def peak(self, digits: int) -> str | None:
        """Return max |1/(1 + N/P)|, the peak of the sensitivity."""
        return certain(lambda bits: 1 / self._distance(bits), digits)

    @cached_property
    def _distance(self) -> Callable[[int], arb]:
        slope = self.closed.derivative() * self.opened - self.closed * self.opened.derivative()
        met = [*self._inside(slope), *(x for x in self._ends if x.sign_of(self.opened))]

        def least(bits: int) -> arb:
            at_infinity = [] if self.discrete else [arb(1)]  # N/P vanishes there
            return reduce(arb.min, [*at_infinity, *(self._ratio(x, bits) for x in met)]).sqrt()

        return least

    def phase(self, digits: int) -> str | None:
        """Return the least angle in degrees by which N/P can be turned until it meets −1, `oo` where it never does."""
        met = [*self._inside(self.crossing), *(x for x in self._ends if not x.sign_of(self.crossing))]

        def least(bits: int) -> arb:
            found = reduce(arb.min, [self._ratio(x, bits) for x in met])
            return 2 * arb.atan2(found.sqrt(), (4 - found).nonnegative_part().sqrt()) * 180 / arb.pi()

        return certain(least, digits) if met else INFINITE

    @property
    def _ends(self) -> list[RealNumber]:
        """The finite ends of the range of x."""
        return [RealNumber.of(-1), RealNumber.of(1)] if self.discrete else [RealNumber.of(0)]

    def _inside(self, polynomial: fmpz_poly) -> list[RealNumber]:
        """Return the roots inside the range of x where N/P is finite."""
        low, high = (RealNumber.of(-1), RealNumber.of(1)) if self.discrete else (RealNumber.of(0), None)
        found = [x for x in real_roots(polynomial) if low < x and (high is None or x < high)] if polynomial else []
        return [x for x in found if x.sign_of(self.opened)]

    def _ratio(self, x: RealNumber, bits: int) -> arb:
        ball = x.ball(bits)
        with Precision(bits):
            return (at_ball(self.closed, ball, bits) / at_ball(self.opened, ball, bits)).nonnegative_part()


def _square(polynomial: fmpz_poly, *, discrete: bool) -> fmpz_poly:
    """Return |p|² on the boundary as a polynomial of x."""
    given = polynomial.coeffs()
    if not discrete:
        even, odd = (fmpz_poly([c if k % 2 == 0 else -c for k, c in enumerate(given[start::2])]) for start in (0, 1))
        return even * even + fmpz_poly([0, 1]) * odd * odd
    before, now, found = fmpz_poly([1]), fmpz_poly([0, 1]), fmpz_poly([sum(c * c for c in given)])
    for k in range(1, len(given)):  # Σ pᵢ pᵢ₊ₖ 2 cos kθ
        found += 2 * sum(a * b for a, b in zip(given, given[k:], strict=False)) * now
        before, now = now, fmpz_poly([0, 2]) * now - before
    return found


def certain(value: Callable[[int], arb], digits: int) -> str | None:
    """Return a number with so many digits after the point, each certain; None where they cannot be told."""
    bits = FIRST_BITS
    while bits <= _MOST_BITS:
        with Precision(bits):
            ball = value(bits)
        if ball.is_finite():
            shown = {rounded_to(end, digits) for end in ends_of(ball, bits)}
            if len(shown) == 1:
                return shown.pop()
        bits *= 2
    return None


def nearest_double(number: RealNumber) -> float:
    """Return the binary number nearest to a real number."""
    bits = FIRST_BITS
    while True:
        low, high = map(float, number.interval(bits))
        if low == high:
            return low
        bits *= 2


# -- the slowest root -------------------------------------------------------------------------------------------------


def slowest_root(coefficients: Sequence[Fraction], *, discrete: bool) -> RealNumber:
    """Return the largest real part of the roots of a polynomial, in discrete time the largest modulus."""
    whole = fmpz_poly(list(reversed(integers(coefficients))))
    return max(_slowest(factor, discrete=discrete) for factor in irreducible_factors(whole))


def _slowest(factor: fmpz_poly, *, discrete: bool) -> RealNumber:
    """Return the same of an irreducible polynomial: among the halves of sums, the roots of products of two roots.

    Real parts are halves of sums of two roots; the largest one is that among these numbers which its enclosure leaves.
    """
    if factor.degree() == 1:
        root = real_roots(factor)[0].fraction
        return RealNumber.of(abs(root) if discrete else root)
    x, y = Scalar.symbol("x"), Scalar.symbol("y")
    p, mirrored = Scalar.of(0), Scalar.of(0)
    for power, coefficient in enumerate(factor.coeffs()):
        p += Scalar.of(int(coefficient)) * x**power
        other = y**power * y**power * x ** (int(factor.degree()) - power) if discrete else (2 * y - x) ** power
        mirrored += Scalar.of(int(coefficient)) * other
    candidates = roots_of_scalar(resultant(p, mirrored, "x"), "y")
    bits = FIRST_BITS
    while True:
        with Precision(bits):
            found: Any = factor.complex_roots()
            sizes = [abs(root) if discrete else root.real for root, _ in found]
            largest = reduce(arb.max, sizes)
            near = [number for number in candidates if number.ball(bits).overlaps(largest)]
        if len(near) == 1:
            return near[0]
        bits *= 2


__all__ = ["INFINITE", "Loop", "certain", "nearest_double", "slowest_root"]
