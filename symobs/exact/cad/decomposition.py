"""The plane divided by algebraic curves: cylinders between vertical lines, the stacks of cells over them, and adjacency.

A cylindrical decomposition after Collins (1975) of the open cells alone.  Over a cylinder no curve meets another, turns back
or runs off to infinity, so the branches keep their number and their order, and one rational point stands for a cell.
"""

from __future__ import annotations

from functools import cached_property
from itertools import combinations, pairwise
from typing import TYPE_CHECKING

from flint import fmpq, fmpq_poly, fmpz_poly

from symobs.exact.algebraic.real_algebraic import RealNumber, irreducible_factors, rational_between, real_roots
from symobs.exact.core.field import Field
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


@dataclass(frozen=True)
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


@dataclass(frozen=True)
class Branch:
    """The root number `number` (from 0, ascending) of one curve over a cylinder."""

    curve: int
    number: int


@dataclass(frozen=True)
class Cylinder:
    """The cylinder between two neighbouring critical lines (None: unbounded on that side), with the sample point `x`."""

    left: RealNumber | None
    right: RealNumber | None
    x: Fraction
    branches: tuple[Branch, ...]
    samples: tuple[Fraction, ...]


@dataclass(frozen=True)
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
