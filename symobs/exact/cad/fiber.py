"""The fibre over a critical line of a decomposition, and the adjacency of the cells on its two sides.

Over an irrational critical line x = α the curves have coefficients in Q(α).  Their common square-free part is found there
exactly, by Euclid's algorithm modulo the minimal polynomial of α; its roots are then isolated in balls.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import acb_poly, arb, arb_mat, fmpq, fmpq_poly

from symobs.exact.algebraic.real_algebraic import (
    FIRST_BITS,
    RealNumber,
    at_ball,
    ends_of,
    rational_between,
    real_roots,
    simplest_between,
)
from symobs.exact.core.precision import Precision
from symobs.exact.ideals.ideal import TooLarge
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact.cad.decomposition import CriticalLine, Event, Plane, PlaneCurve

#: A polynomial in y with coefficients in Q(α), lowest first, each reduced modulo the minimal polynomial.
Upright: TypeAlias = "list[fmpq_poly]"
#: Up to this degree of α Euclid's algorithm over Q(α) ends in reasonable time.
LARGEST_DEGREE = 16


@dataclass(frozen=True)
class Fibre:
    """A critical line: rational separators σ₀ < … < σ_N around the N points of all curves on it, and the cells at each σ.

    `left[j]` and `right[j]` are the places in their stacks of the cells that meet the critical line at height σⱼ.
    """

    separators: tuple[Fraction, ...]
    left: tuple[int, ...]
    right: tuple[int, ...]

    @property
    def alone(self) -> tuple[int, ...]:
        """The indices of the isolated points of the curves on the critical line."""
        return tuple(
            j
            for j in range(len(self.separators) - 1)
            if self.left[j] == self.left[j + 1] and self.right[j] == self.right[j + 1]
        )

    def unbounded(self, side: tuple[int, ...], count: int) -> frozenset[int]:
        """Return the cells of a stack of `count` that are unbounded at this critical line."""
        return frozenset(range(side[-1], count)) | frozenset(range(side[0] + 1))


def fibre(plane: Plane, line: CriticalLine) -> Fibre:
    """Return the fibre over a critical line."""
    separators = _separators(plane, line.x)
    before, after = plane.cylinders[line.index], plane.cylinders[line.index + 1]
    left_end, right_end = before.left, after.right
    for height in separators:
        for curve in plane.curves:
            if not curve.degree:
                continue
            for root in real_roots(curve.on_horizontal(height)):
                if root < line.x and (left_end is None or left_end < root):
                    left_end = root
                if line.x < root and (right_end is None or root < right_end):
                    right_end = root
    left = _places(plane, rational_between(left_end, line.x), separators)
    right = _places(plane, rational_between(line.x, right_end), separators)
    return Fibre(separators, left, right)


def point_between(plane: Plane, line: CriticalLine, low: Fraction, high: Fraction) -> RealNumber | None:
    """Return the height of the one point of the curves on a rational critical line between two separators."""
    if not line.x.is_rational:
        return None
    inside = {
        root
        for curve in plane.curves
        if curve.degree
        for root in real_roots(curve.on_vertical(line.x.fraction))
        if RealNumber.of(low) < root < RealNumber.of(high)
    }
    return inside.pop() if len(inside) == 1 else None


def curves_between(plane: Plane, line: CriticalLine, low: Fraction, high: Fraction) -> tuple[int, ...]:
    """Return the curves that have a point on a critical line between two separators."""
    return tuple(
        index
        for index, curve in enumerate(plane.curves)
        if curve.degree and any(low < end < high for end, _ in _points_of(curve, line.x))
    )


def place_between(plane: Plane, line: CriticalLine, low: Fraction, high: Fraction) -> tuple[Fraction, Fraction]:
    """Return an interval around the one point of the curves on a critical line between two separators."""
    places = [ends for curve in plane.curves if curve.degree for ends in _points_of(curve, line.x)]
    return next(ends for ends in places if low < ends[0] and ends[1] < high)


def _points_of(curve: PlaneCurve, x: RealNumber) -> list[tuple[Fraction, Fraction]]:
    """Return disjoint intervals around the points of one curve on the line over x."""
    if x.is_rational:
        return [root.interval() for root in real_roots(curve.on_vertical(x.fraction))]
    tower = _Tower(x)
    upright = tower.reduced([fmpq_poly(c) for c in curve.by_second])
    return tower.real_roots(tower.quotient(upright, tower.gcd(upright, tower.derivative(upright))))


def _places(plane: Plane, x: Fraction, separators: Sequence[Fraction]) -> tuple[int, ...]:
    """Return how many branches over x lie below each separator."""
    roots = [root for found in plane.roots_over(x) for root in found]
    return tuple(sum(root < RealNumber.of(height) for root in roots) for height in separators)


def _separators(plane: Plane, x: RealNumber) -> tuple[Fraction, ...]:
    """Return simple rational heights below, between and above the points of the curves on the line over x."""
    risen = [curve for curve in plane.curves if curve.degree]
    if x.is_rational:
        points = sorted({root for curve in risen for root in real_roots(curve.on_vertical(x.fraction))})
        ends: list[RealNumber | None] = [None, *points, None]
        return tuple(rational_between(low, high) for low, high in itertools.pairwise(ends))
    here = [(event, times) for event in plane.events if (times := event.times_at(x))]
    if len(here) == 1 and here[0][1] == 1 and here[0][0].kind != "lead":
        balls = _around_one_event(plane, x, here[0][0])
    else:
        balls = _by_euclid(risen, x)
    lows = [None, *(ball[1] for ball in balls)]
    highs = [*(ball[0] for ball in balls), None]
    return tuple(simplest_between(low, high) for low, high in zip(lows, highs, strict=True))


def _by_euclid(curves: Sequence[PlaneCurve], x: RealNumber) -> list[tuple[Fraction, Fraction]]:
    """Return intervals around the points on a line: the square-free part of the product is found over Q(α)."""
    if x.degree > LARGEST_DEGREE:
        message = f"a critical line of degree {x.degree} on which several things happen"
        raise TooLarge(message)
    together: Upright = [fmpq_poly([1])]
    tower = _Tower(x)
    for curve in curves:
        upright = tower.reduced([fmpq_poly(c) for c in curve.by_second])
        upright = tower.quotient(upright, tower.gcd(upright, tower.derivative(upright)))
        new = tower.quotient(upright, tower.gcd(upright, together))
        together = tower.product(together, new)
    return tower.real_roots(together)


def _around_one_event(plane: Plane, x: RealNumber, event: Event) -> list[tuple[Fraction, Fraction]]:
    """Return intervals around the points on a line with exactly one double root, by balls alone.

    A simple root of the discriminant leaves one double root, a simple root of the resultant one common root: both are
    −s₀/s₁ for the subresultant s₁ y + s₀, and one of the two is divided out.
    """
    bits = 2 * FIRST_BITS
    while True:
        found = _divided_out(plane, x, event, bits)
        if found is not None:
            return found
        bits *= 2


def _divided_out(plane: Plane, x: RealNumber, event: Event, bits: int) -> list[tuple[Fraction, Fraction]] | None:
    with Precision(4 * bits):
        rows = {
            index: [at_ball(c, x.ball(2 * bits), 2 * bits) for c in curve.by_second]
            for index, curve in enumerate(plane.curves)
            if curve.degree
        }
        first = rows[event.curves[0]]
        second = rows[event.curves[1]] if len(event.curves) == 2 else [c * k for k, c in enumerate(first)][1:]
        below, above = _subresultant(first, second)
        if below.contains(0):
            return None
        rows[event.curves[0]] = _deflated(first, -above / below)
        product = [arb(1)]
        for row in rows.values():
            product = [
                sum((product[i] * row[k - i] for i in range(len(product)) if 0 <= k - i < len(row)), arb(0))
                for k in range(len(product) + len(row) - 1)
            ]
    return _isolated(product, 2 * bits) if len(product) > 1 else []


def _subresultant(one: Sequence[arb], other: Sequence[arb]) -> tuple[arb, arb]:
    """Return (s₁, s₀) of the first subresultant s₁ y + s₀ of two polynomials, lowest coefficient first."""
    m, n = len(one) - 1, len(other) - 1
    rows = [_shifted(one, k, m + n - 1) for k in range(n - 2, -1, -1)]
    rows += [_shifted(other, k, m + n - 1) for k in range(m - 2, -1, -1)]
    size = m + n - 2
    if not size:
        return one[1], one[0]
    # the columns are those of y^(m+n−2) … y², and then that of y or of 1
    tables = [[[*reversed(row[2:]), row[last]] for row in rows] for last in (1, 0)]
    s1, s0 = (arb_mat(size, size, [entry for row in table for entry in row]).det() for table in tables)
    return s1, s0


def _shifted(polynomial: Sequence[arb], power: int, width: int) -> list[arb]:
    return [arb(0)] * power + list(polynomial) + [arb(0)] * (width - power - len(polynomial))


def _deflated(polynomial: Sequence[arb], root: arb) -> list[arb]:
    """Return the polynomial divided by y − root, lowest coefficient first."""
    quotient = [polynomial[-1]]
    for coefficient in reversed(polynomial[1:-1]):
        quotient.append(quotient[-1] * root + coefficient)
    return list(reversed(quotient))


class _Tower:
    """Polynomials over Q(α)."""

    def __init__(self, alpha: RealNumber) -> None:
        self.alpha = alpha
        self.modulus = fmpq_poly(alpha.polynomial)

    def reduced(self, polynomial: Upright) -> Upright:
        found = [c % self.modulus for c in polynomial]
        while found and not found[-1]:
            found.pop()
        return found

    def derivative(self, polynomial: Upright) -> Upright:
        return [c * k for k, c in enumerate(polynomial)][1:]

    def product(self, left: Upright, right: Upright) -> Upright:
        found = [fmpq_poly() for _ in range(len(left) + len(right) - 1)]
        for i, a in enumerate(left):
            for j, b in enumerate(right):
                found[i + j] += a * b
        return self.reduced(found)

    def monic(self, polynomial: Upright) -> Upright:
        lead = polynomial[-1]
        if lead.degree() == 0:
            return [c / lead[0] for c in polynomial]
        _, inverse, _ = lead.xgcd(self.modulus)
        return self.reduced([c * inverse for c in polynomial])

    def divided(self, above: Upright, below: Upright) -> tuple[Upright, Upright]:
        """Return quotient and remainder; the divisor is monic."""
        rest, quotient = list(above), [fmpq_poly() for _ in range(max(1, len(above) - len(below) + 1))]
        while len(rest) >= len(below):
            lead, shift = rest[-1], len(rest) - len(below)
            quotient[shift] = lead
            for k, c in enumerate(below[:-1]):
                rest[shift + k] -= lead * c
            rest = self.reduced(rest[:-1])
        return quotient, rest

    def quotient(self, above: Upright, below: Upright) -> Upright:
        return above if len(below) < 2 else self.divided(above, self.monic(below))[0]

    def gcd(self, left: Upright, right: Upright) -> Upright:
        """Return the monic greatest common divisor."""
        while right:
            right = self.monic(right)
            left, right = right, (self.divided(left, right)[1] if len(right) > 1 else [])
        return left

    def real_roots(self, polynomial: Upright) -> list[tuple[Fraction, Fraction]]:
        """Return disjoint rational intervals around the real roots of a square-free polynomial, ascending."""
        if len(polynomial) < 2:
            return []
        bits = FIRST_BITS
        while True:
            found = _isolated([self._ball(c, bits) for c in polynomial], bits)
            if found is not None:
                return found
            bits *= 2

    def _ball(self, coefficient: fmpq_poly, bits: int) -> arb:
        with Precision(2 * bits):
            point, value = self.alpha.ball(2 * bits), arb(0)
            for c in reversed(coefficient.coeffs()):
                value = value * point + arb(fmpq(c))
            return value


def _isolated(coefficients: Sequence[arb], bits: int) -> list[tuple[Fraction, Fraction]] | None:
    """Return intervals around the real roots, None if this precision does not suffice.

    The balls hold one root each; the conjugate of a root lies in the conjugate ball, so a root is real where that meets
    no ball but its own.
    """
    try:
        with Precision(2 * bits):
            roots: list[Any] = acb_poly(coefficients).roots(maxprec=4 * bits)
    except ValueError:
        return None
    found = []
    for index, root in enumerate(roots):
        if not root.imag.contains(0):
            continue
        mirrored = root.conjugate()
        if any(mirrored.overlaps(other) for place, other in enumerate(roots) if place != index):
            return None
        found.append(ends_of(root.real, 2 * bits))
    found.sort()
    if any(one[1] >= other[0] for one, other in itertools.pairwise(found)):
        return None
    return found
