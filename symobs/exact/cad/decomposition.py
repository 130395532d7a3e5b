"""The plane divided by algebraic curves: cylinders between vertical lines, the stacks of cells over them, and adjacency.

A cylindrical decomposition after Collins (1975) of the open cells alone.  Over a cylinder no curve meets another, turns back
or runs off to infinity, so the branches keep their number and their order, and one rational point stands for a cell.
"""

from __future__ import annotations

import itertools
from functools import cached_property
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import acb_poly, arb, arb_mat, fmpq, fmpq_poly, fmpz_poly

from symobs.exact.algebraic.real_algebraic import (
    FIRST_BITS,
    RealNumber,
    at_ball,
    ends_of,
    irreducible_factors,
    rational_between,
    real_roots,
    simplest_between,
)
from symobs.exact.core.field import Field
from symobs.exact.core.ring import Precision
from symobs.exact.ideals import TooLarge
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from fractions import Fraction

    from flint import fmpz_mpoly

    from symobs.exact.core.scalar import Scalar


class PlaneCurve:
    """The curve f(x, y) = 0 of an irreducible polynomial with integer coefficients."""

    def __init__(self, polynomial: Scalar, names: tuple[str, str]) -> None:
        """Take an irreducible polynomial in these two names."""
        self.scalar = polynomial
        self.names = names
        field = Field.of(names)
        self.inside = polynomial.within(field).numerator_part
        places = [field.position[name] for name in names]
        self.by_second = _collected(self.inside, places[1], places[0])
        self.by_first = _collected(self.inside, places[0], places[1])

    @property
    def degree(self) -> int:
        """The degree in the second name: 0 for vertical lines."""
        return len(self.by_second) - 1

    def on_vertical(self, x: Fraction) -> fmpz_poly:
        """Return a multiple of f(x, ·), primitive."""
        return _cut(self.by_second, x)

    def on_horizontal(self, y: Fraction) -> fmpz_poly:
        """Return a multiple of f(·, y), primitive."""
        return _cut(self.by_first, y)


def _collected(polynomial: fmpz_mpoly, outer: int, inner: int) -> list[fmpz_poly]:
    """Return the coefficients of the powers of one generator, lowest first, as polynomials in the other."""
    rows: dict[int, dict[int, int]] = {}
    for powers, coefficient in polynomial.terms():
        rows.setdefault(int(powers[outer]), {})[int(powers[inner])] = int(coefficient)
    found = []
    for k in range(max(rows, default=0) + 1):
        row = rows.get(k, {})
        found.append(fmpz_poly([row.get(j, 0) for j in range(max(row, default=-1) + 1)]))
    return found


def _cut(coefficients: Sequence[fmpz_poly], at: Fraction) -> fmpz_poly:
    """Return a positive multiple of Σ cₖ(at) yᵏ that is primitive over the integers."""
    place = fmpq(at.numerator, at.denominator)
    polynomial = fmpq_poly([coefficient(place) for coefficient in coefficients]).numer()
    content = polynomial.content()
    return polynomial // content if content > 1 else polynomial


@dataclass
class Event:
    """A projection factor: a polynomial in x that vanishes where curves are unbounded, singular, or meet."""

    polynomial: fmpz_poly
    curves: tuple[int, ...]
    kind: str

    def times_at(self, x: RealNumber) -> int:
        """Return the multiplicity of a number as a root: 0, 1, or 2 for more."""
        once, rest = divmod(self.polynomial, x.polynomial)
        if rest:
            return 0
        return 1 if once % x.polynomial else 2


@dataclass
class Branch:
    """The root number `number` (from 0, ascending) of one curve over a cylinder."""

    curve: int
    number: int


@dataclass
class Cylinder:
    """The cylinder between two neighbouring critical lines (None: unbounded on that side), with the sample point `x`."""

    left: RealNumber | None
    right: RealNumber | None
    x: Fraction
    branches: tuple[Branch, ...]
    samples: tuple[Fraction, ...]


@dataclass
class CriticalLine:
    """A vertical line at a root of the projection, between cylinder `index` and the next one."""

    index: int
    x: RealNumber


class Plane:
    """The plane divided by curves.  `names` are (x, y): stacks stand over x."""

    def __init__(self, polynomials: Iterable[Scalar], names: tuple[str, str]) -> None:
        """Take distinct irreducible polynomials in these names."""
        self.names = names
        self.curves = tuple(PlaneCurve(polynomial, names) for polynomial in polynomials)

    @cached_property
    def events(self) -> tuple[Event, ...]:
        """The projection factors: leading coefficients, discriminants and resultants."""
        found: list[Event] = []
        for index, curve in enumerate(self.curves):
            found.append(Event(curve.by_second[-1], (index,), "lead"))
            if curve.degree > 1:
                found.append(
                    Event(in_first(curve.inside.discriminant(self.names[1]), self.names), (index,), "meets itself")
                )
        risen = [(index, curve) for index, curve in enumerate(self.curves) if curve.degree]
        for (i, one), (j, other) in combinations(risen, 2):
            found.append(Event(in_first(one.inside.resultant(other.inside, self.names[1]), self.names), (i, j), "meet"))
        return tuple(found)

    @cached_property
    def projection(self) -> tuple[fmpz_poly, ...]:
        """The irreducible projection factors in x."""
        factors = [f for event in self.events for f in irreducible_factors(event.polynomial)]
        return tuple({_key(f): f for f in factors}.values())

    @cached_property
    def critical_lines(self) -> tuple[CriticalLine, ...]:
        """The real roots of the projection, ascending."""
        roots = sorted(root for factor in self.projection for root in real_roots(factor))
        return tuple(CriticalLine(index, root) for index, root in enumerate(roots))

    @cached_property
    def cylinders(self) -> tuple[Cylinder, ...]:
        """The cylinders from left to right."""
        ends = [None, *(line.x for line in self.critical_lines), None]
        return tuple(self._cylinder(left, right) for left, right in pairwise(ends))

    def _cylinder(self, left: RealNumber | None, right: RealNumber | None) -> Cylinder:
        x = rational_between(left, right)
        roots = sorted(
            (root, curve, number) for curve, found in enumerate(self.roots_over(x)) for number, root in enumerate(found)
        )
        ends = [None, *(root for root, _, _ in roots), None]
        samples = [rational_between(low, high) for low, high in pairwise(ends)]
        return Cylinder(left, right, x, tuple(Branch(curve, number) for _, curve, number in roots), tuple(samples))

    def roots_over(self, x: Fraction) -> list[list[RealNumber]]:
        """Return the real roots in y of every curve over a point x of a cylinder."""
        return [real_roots(curve.on_vertical(x)) if curve.degree else [] for curve in self.curves]

    def vertical_at(self, line: CriticalLine) -> tuple[int, ...]:
        """Return the curves that contain the critical line."""
        return tuple(
            index
            for index, curve in enumerate(self.curves)
            if not curve.degree and line.x.sign_of(curve.by_second[0]) == 0
        )

    def runs_off(self, line: CriticalLine) -> bool:
        """Return whether a branch may be unbounded at a critical line: a leading coefficient vanishes there."""
        return any(curve.degree and line.x.sign_of(curve.by_second[-1]) == 0 for curve in self.curves)


def in_first(polynomial: fmpz_mpoly, names: tuple[str, str]) -> fmpz_poly:
    """Return a polynomial that is free of the second name."""
    field = Field.of(names)
    place = field.position[names[0]]
    terms = {int(powers[place]): int(coefficient) for powers, coefficient in polynomial.terms()}
    return fmpz_poly([terms.get(k, 0) for k in range(max(terms, default=-1) + 1)])


def _key(polynomial: fmpz_poly) -> tuple[int, ...]:
    return tuple(int(c) for c in polynomial.coeffs())


# The fibre over a critical line of a decomposition, and the adjacency of the cells on its two sides.
#
# Over an irrational critical line x = α the curves have coefficients in Q(α). Their common square-free part is found
# there exactly, by Euclid's algorithm modulo the minimal polynomial of α; its roots are then isolated in balls.


#: A polynomial in y with coefficients in Q(α), lowest first, each reduced modulo the minimal polynomial.
Upright: TypeAlias = "list[fmpq_poly]"
#: Up to this degree of α Euclid's algorithm over Q(α) ends in reasonable time.
LARGEST_DEGREE = 16


@dataclass
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
    return Fibre(separators, left, _places(plane, rational_between(line.x, right_end), separators))


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
        raise TooLarge(f"a critical line of degree {x.degree} on which several things happen")
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
