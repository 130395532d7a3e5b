"""Stability regions of two parameters: cells, components and holes."""

from __future__ import annotations

import itertools
from dataclasses import replace
from functools import cached_property, lru_cache
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from symobs.exact import Scalar, TooLarge
from symobs.exact.algebraic.real_algebraic import rational_between, roots_of_scalar
from symobs.exact.algebraic.root_location import sign_at
from symobs.exact.cad.decomposition import (
    Branch,
    CriticalLine,
    Cylinder,
    Fibre,
    Plane,
    curves_between,
    fibre,
    place_between,
    point_between,
)
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.critical_polynomials import irreducible
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from fractions import Fraction

    from symobs.exact import RealNumber
    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials


# A short list of strict inequalities that holds exactly on a region of one or two parameters.
#
# The region is known as cells. Candidates are the critical factors and the conditions of Liénard and Chipart; a list is
# right when it holds at a point of every stable cell and fails at a point of every other one, in a division fine enough
# that no listed polynomial changes its sign inside a cell, and when it excludes the curves and the points that the
# region surrounds without containing them.


class RegionInequality(NamedTuple):
    """polynomial > 0, or with the operator `!=` polynomial ≠ 0."""

    polynomial: Scalar
    operator: str = ">"

    def at(self, point: dict[str, Fraction]) -> bool:
        """Return whether the inequality holds at a rational point."""
        sign = sign_at(self.polynomial, point)
        return sign > 0 if self.operator == ">" else sign != 0


@dataclass
class Sample:
    """A rational point of an open cell, and whether the polynomial is stable in the cell."""

    point: dict[str, Fraction]
    stable: bool


class ExactRegion(Protocol):
    """The interface of exact regions of one and two parameters."""

    @property
    def critical(self) -> CriticalPolynomials:
        """The critical polynomials."""

    def samples(self, further: Sequence[Scalar]) -> list[Sample]:
        """Return a point of every open cell, none of the further polynomials changing its sign inside one."""

    def surrounded(self) -> tuple[Scalar, ...]:
        """Return critical factors that vanish on every curve with the region on both sides."""

    def through_holes(self) -> tuple[tuple[Scalar, ...], ...]:
        """Return, for every isolated excluded point, the critical factors that vanish there."""


@lru_cache(maxsize=256)
def short_list(region: ExactRegion) -> tuple[RegionInequality, ...]:
    """Return the inequalities of a nonempty region; none if every admissible point is stable."""
    samples = region.samples(())
    bounds = [RegionInequality(factor, "!=") for factor in region.surrounded()]
    bounds += _oriented(region.critical.proper, samples)
    listed = {bound.polynomial for bound in bounds} | {-bound.polynomial for bound in bounds}
    bounds += [
        RegionInequality(through[0], "!=") for through in region.through_holes() if not listed.intersection(through)
    ]
    waiting = _candidates(region.critical, samples)
    while True:
        missed = [sample for sample in samples if not sample.stable and _hold(bounds, sample)]
        if missed:
            bounds.append(_next(waiting, missed, samples))
            continue
        finer = region.samples(irreducible(bound.polynomial for bound in bounds))
        wrong = {b for b in bounds if any(s.stable and not b.at(s.point) for s in finer)}
        bounds = [bound for bound in bounds if bound not in wrong]
        samples = finer
        if not wrong and all(sample.stable or not _hold(bounds, sample) for sample in finer):
            break
    return _without_the_superfluous(bounds, samples, region.through_holes())


def is_exact(region: ExactRegion, bounds: Sequence[RegionInequality]) -> bool:
    """Return whether these inequalities hold exactly on the region."""
    factors = irreducible(bound.polynomial for bound in bounds)
    # these do not vanish anywhere in the region; of others a curve or a point inside might be left out by a list
    known = {*region.critical.factors, *irreducible(region.critical.conditions)}
    if not known.issuperset(factors):
        return False
    right = all(sample.stable == _hold(bounds, sample) for sample in region.samples(factors))
    cuts = all(factor in factors for factor in region.surrounded())
    holes = all(any(factor in factors for factor in through) for through in region.through_holes())
    return right and cuts and holes


def _hold(bounds: Iterable[RegionInequality], sample: Sample) -> bool:
    return all(bound.at(sample.point) for bound in bounds)


def _oriented(polynomials: Iterable[Scalar], samples: Sequence[Sample]) -> list[RegionInequality]:
    """Return the polynomials of constant sign at all stable samples, signed to be positive."""
    found = []
    for polynomial in polynomials:
        signs = {sign_at(polynomial, sample.point) > 0 for sample in samples if sample.stable}
        if len(signs) == 1:
            found.append(RegionInequality(polynomial if signs.pop() else -polynomial))
    return found


def _candidates(critical: CriticalPolynomials, samples: Sequence[Sample]) -> list[RegionInequality]:
    """Return the factors of the conditions with constant sign on the region, and their cofactors, simple ones first."""
    found: dict[RegionInequality, None] = {}
    for condition in critical.conditions:
        if condition.is_constant:
            continue
        unit, factors = condition.factors()
        rest = Scalar.of(1 if sign_of(unit, {}) == "positive" else -1)
        for factor, power in factors:
            oriented = _oriented([factor], samples)
            if oriented:
                found |= dict.fromkeys(oriented)
                rest = rest if oriented[0].polynomial == factor or power % 2 == 0 else -rest
            elif power % 2:
                rest = rest * factor
        if not rest.is_constant:
            found[RegionInequality(rest)] = None
    return sorted(found, key=lambda bound: _length(bound.polynomial))


def _length(polynomial: Scalar) -> tuple[int, int]:
    return polynomial.degrees()[0], polynomial.size


def _next(waiting: list[RegionInequality], missed: Sequence[Sample], samples: Sequence[Sample]) -> RegionInequality:
    """Remove the simplest candidate that excludes a wrongly included point and no stable one."""
    for bound in waiting:
        stable = all(bound.at(sample.point) for sample in samples if sample.stable)
        if stable and not all(bound.at(sample.point) for sample in missed):
            waiting.remove(bound)
            return bound
    message = "the conditions of stability do not describe the region"
    raise AssertionError(message)


def _without_the_superfluous(
    bounds: Sequence[RegionInequality], samples: Sequence[Sample], holes: Sequence[tuple[Scalar, ...]]
) -> tuple[RegionInequality, ...]:
    """Drop implied inequalities, the longest first, except those that alone exclude a curve or a point."""
    kept = list(bounds)
    unstable = [sample for sample in samples if not sample.stable]
    for bound in sorted(bounds, key=lambda b: _length(b.polynomial), reverse=True):
        others = [other for other in kept if other is not bound]
        left = irreducible(other.polynomial for other in others)
        alone = any(not any(factor in left for factor in through) for through in holes)
        if bound.operator == ">" and not alone and not any(_hold(others, sample) for sample in unstable):
            kept = others
    return tuple(sorted(kept, key=lambda b: _length(b.polynomial)))


#: The plane is divided where the degrees of all discriminants and resultants sum to no more than this.
LARGEST_PROJECTION = 170
#: With the conditions of a short list besides, it may be this much larger.
_LARGER = 3


@dataclass
class Cell:
    """An open cell: its place (cylinder, height in the stack), a rational point in it, and whether it is stable there.

    What the declared signs do not allow is not `allowed`, and not stable.
    """

    cylinder: int
    height: int
    sample: tuple[Fraction, Fraction]
    stable: bool
    allowed: bool = True


@dataclass
class Component:
    """A connected component of the region: the numbers of its cells, and whether it is bounded."""

    cells: tuple[int, ...]
    bounded: bool


@dataclass
class Hole:
    """An isolated excluded point of the region; `y` is None if it has no closed form."""

    x: RealNumber
    y: RealNumber | None
    near: tuple[Fraction, Fraction]


@dataclass
class PlaneRegion:
    """The set of stable (x, y), `names`, as cells of the plane divided by the critical curves."""

    critical: CriticalPolynomials
    names: tuple[str, str]

    @cached_property
    def plane(self) -> Plane:
        """The plane divided by the critical curves."""
        return Plane(self.critical.factors, self.names)

    @cached_property
    def cells(self) -> tuple[Cell, ...]:
        """All cells, cylinder by cylinder from left to right, each stack from below."""
        found = []
        for index, cylinder in enumerate(self.plane.cylinders):
            for height, y in enumerate(cylinder.samples):
                point = self._point(cylinder.x, y)
                allowed = self.critical.allows(point)
                stable = allowed and self.critical.is_stable(point)
                found.append(Cell(index, height, (cylinder.x, y), stable, allowed))
        return tuple(found)

    @cached_property
    def _numbers(self) -> dict[tuple[int, int], int]:
        return {(cell.cylinder, cell.height): number for number, cell in enumerate(self.cells)}

    def cell_at(self, cylinder: int, height: int) -> Cell:
        """Return the cell at a place."""
        return self.cells[self._numbers[cylinder, height]]

    def stable_in(self, cylinder: int) -> tuple[bool, ...]:
        """Return which cells of a stack are stable."""
        count = len(self.plane.cylinders[cylinder].samples)
        return tuple(self.cell_at(cylinder, height).stable for height in range(count))

    def bounds(self, cell: Cell) -> tuple[Cylinder, Branch | None, Branch | None]:
        """Return the cylinder of a cell and the branches below and above it."""
        cylinder = self.plane.cylinders[cell.cylinder]
        branches: tuple[Branch | None, ...] = (None, *cylinder.branches, None)
        return cylinder, branches[cell.height], branches[cell.height + 1]

    @cached_property
    def edges(self) -> dict[int, tuple[Any, ...]]:
        """The branches over cylinders with their closed forms, as far as they were asked for."""
        return {}

    @cached_property
    def fibres(self) -> dict[int, Fibre]:
        """The fibres over critical lines with stable cells on both sides, or where a stable cell may be unbounded."""
        found: dict[int, Fibre] = {}
        for line in self.plane.critical_lines:
            left, right = any(self.stable_in(line.index)), any(self.stable_in(line.index + 1))
            if (left and right) or ((left or right) and self.plane.runs_off(line)):
                found[line.index] = fibre(self.plane, line)
        return found

    @cached_property
    def joins(self) -> tuple[tuple[int, int, int, int], ...]:
        """Stable cells that meet at a critical line: (number on the left, on the right, line, number of the separator)."""
        return tuple(self._joins())

    def _joins(self) -> Iterator[tuple[int, int, int, int]]:
        for index, found in self.fibres.items():
            if self.plane.vertical_at(self.plane.critical_lines[index]):
                continue
            for gap, (low, high) in enumerate(zip(found.left, found.right, strict=True)):
                left, right = self._numbers[index, low], self._numbers[index + 1, high]
                if self.cells[left].stable != self.cells[right].stable:
                    message = "a stable cell meets one that is not"
                    raise AssertionError(message)
                if self.cells[left].stable:
                    yield left, right, index, gap

    @cached_property
    def components(self) -> tuple[Component, ...]:
        """The connected components, from left to right."""
        leader = {number: number for number, cell in enumerate(self.cells) if cell.stable}

        def find(number: int) -> int:
            while leader[number] != number:
                number = leader[number]
            return number

        for left, right, _, _ in self.joins:
            first, second = sorted((find(left), find(right)))
            leader[second] = first
        together: dict[int, list[int]] = {}
        for number in leader:
            together.setdefault(find(number), []).append(number)
        return tuple(
            Component(tuple(members), not any(self._is_unbounded(number) for number in members))
            for members in together.values()
        )

    def _is_unbounded(self, number: int) -> bool:
        cell = self.cells[number]
        cylinder, below, above = self.bounds(cell)
        if below is None or above is None or cylinder.left is None or cylinder.right is None:
            return True
        count = len(cylinder.samples)
        for index, side in ((cell.cylinder - 1, "right"), (cell.cylinder, "left")):
            found = self.fibres.get(index)
            if found and cell.height in found.unbounded(getattr(found, side), count):
                return True
        return False

    @cached_property
    def _places_of_holes(self) -> tuple[tuple[int, int], ...]:
        """The holes by critical line and number on it."""
        return tuple(
            (index, number)
            for index, found in self.fibres.items()
            if not self.plane.vertical_at(self.plane.critical_lines[index])
            for number in found.alone
            if self.cell_at(index, found.left[number]).stable
        )

    @cached_property
    def holes(self) -> tuple[Hole, ...]:
        """The isolated excluded points."""
        found = []
        for index, number in self._places_of_holes:
            low, high = self.fibres[index].separators[number : number + 2]
            found.append(self._hole(self.plane.critical_lines[index], low, high))
        return tuple(found)

    def _hole(self, line: CriticalLine, low: Fraction, high: Fraction) -> Hole:
        y = point_between(self.plane, line, low, high)
        bottom, top = place_between(self.plane, line, low, high)
        return Hole(line.x, y, (line.x.interval()[0], (bottom + top) / 2))

    @cached_property
    def cuts(self) -> tuple[tuple[int, int], ...]:
        """The excluded branches (cylinder, number in the stack) with stable cells on both sides."""
        return tuple(
            (cylinder, place)
            for cylinder in range(len(self.plane.cylinders))
            for place, pair in enumerate(_pairs(self.stable_in(cylinder)))
            if all(pair)
        )

    @cached_property
    def walls_cut(self) -> tuple[tuple[int, int], ...]:
        """The excluded segments (critical line, separator) of vertical lines with stable cells on both sides."""
        return tuple(
            (index, gap)
            for index, found in self.fibres.items()
            if self.plane.vertical_at(self.plane.critical_lines[index])
            for gap, (low, high) in enumerate(zip(found.left, found.right, strict=True))
            if self.cell_at(index, low).stable and self.cell_at(index + 1, high).stable
        )

    # -- for the inequalities ----------------------------------------------------------------------------------------

    def samples(self, further: Sequence[Scalar]) -> list[Sample]:
        """Return a point of every open cell, none of the further polynomials changing its sign inside one."""
        plane = self.divided(further)
        if plane is self.plane:
            return [Sample(self._point(*cell.sample), cell.stable) for cell in self.cells if cell.allowed]
        if plane not in self._sampled:
            points = [self._point(cylinder.x, y) for cylinder in plane.cylinders for y in cylinder.samples]
            allowed = [point for point in points if self.critical.allows(point)]
            self._sampled[plane] = [Sample(point, self.critical.is_stable(point)) for point in allowed]
        return self._sampled[plane]

    @cached_property
    def _sampled(self) -> dict[Plane, list[Sample]]:
        return {}

    def divided(self, further: Sequence[Scalar]) -> Plane:
        """Return the plane divided by further irreducible polynomials besides."""
        others = [polynomial for polynomial in further if polynomial not in self.critical.factors]
        if not others:
            return self.plane
        key = frozenset(others)
        if key not in self._finer:
            polynomials = (*self.critical.factors, *others)
            if projection_size(polynomials, self.names) > _LARGER * LARGEST_PROJECTION:
                raise TooLarge("the conditions of stability are of too high a degree")
            self._finer[key] = Plane(polynomials, self.names)
        return self._finer[key]

    @cached_property
    def _finer(self) -> dict[frozenset[Scalar], Plane]:
        return {}

    def _point(self, x: Fraction, y: Fraction) -> dict[str, Fraction]:
        return {self.names[0]: x, self.names[1]: y}

    def surrounded(self) -> tuple[Scalar, ...]:
        """Return critical factors that vanish on every curve with the region on both sides."""
        curves = [self.plane.cylinders[cylinder].branches[place].curve for cylinder, place in self.cuts]
        for index, _ in self.walls_cut:
            curves += self.plane.vertical_at(self.plane.critical_lines[index])
        factors = dict.fromkeys(self.critical.factors[curve] for curve in curves)
        return tuple(factor for factor in factors if factor in self.critical.proper)

    def through_holes(self) -> tuple[tuple[Scalar, ...], ...]:
        """Return, for every isolated excluded point, the critical factors that vanish there."""
        found = []
        for index, number in self._places_of_holes:
            separators = self.fibres[index].separators
            curves = curves_between(self.plane, self.plane.critical_lines[index], *separators[number : number + 2])
            found.append(tuple(self.critical.factors[curve] for curve in curves))
        return tuple(found)

    @property
    def empty(self) -> bool:
        """Whether the region is empty."""
        return self.critical.never or not any(cell.stable for cell in self.cells)

    @property
    def everywhere(self) -> bool:
        """Whether every admissible point is stable."""
        stable = all(cell.stable for cell in self.cells if cell.allowed)
        return stable and not self.surrounded() and not self.holes

    @property
    def bounded(self) -> bool:
        """Whether every component is bounded."""
        return all(component.bounded for component in self.components)


def _pairs(values: Sequence[bool]) -> list[tuple[bool, bool]]:
    return list(pairwise(values))


@lru_cache(maxsize=64)
def plane_region(critical: CriticalPolynomials, names: tuple[str, str]) -> PlaneRegion:
    """Return the region, with the projection on the name that gives the other the lower degree."""

    def height(name: str) -> tuple[int, int]:
        degrees = [factor.degree(name) for factor in critical.factors]
        return max(degrees, default=0), sum(degrees)

    first, second = names
    return PlaneRegion(critical, (second, first) if height(first) < height(second) else (first, second))


def can_be_divided(region: PlaneRegion) -> bool:
    """Return whether the plane can be divided in reasonable time: FLINT's resultants cannot be interrupted."""
    if region.critical.never:
        return True
    if projection_size(region.critical.factors, region.names) > LARGEST_PROJECTION:
        return False
    try:
        return region.components is not None
    except TooLarge:
        return False


def projection_size(polynomials: Sequence[Scalar], names: tuple[str, str]) -> int:
    """Return a bound of the degrees of all discriminants and resultants together."""
    degrees = [(polynomial.degree(names[0]), polynomial.degree(names[1])) for polynomial in polynomials]
    total = sum(max(0, 2 * high - 1) * wide for wide, high in degrees)
    return total + sum(one[0] * other[1] + one[1] * other[0] for one, other in combinations(degrees, 2))


# Stability regions of one parameter: open intervals between critical points.


@dataclass
class IntervalPiece:
    """An open interval between neighbouring critical points (None: none on that side), and whether it is stable."""

    low: RealNumber | None
    high: RealNumber | None
    sample: Fraction
    stable: bool


@dataclass
class LineRegion:
    """The set of stable values of one parameter."""

    critical: CriticalPolynomials
    name: str

    @cached_property
    def points(self) -> tuple[RealNumber, ...]:
        """The real roots of the critical polynomials, ascending."""
        return tuple(sorted({root for factor in self.critical.factors for root in roots_of_scalar(factor, self.name)}))

    @cached_property
    def pieces(self) -> tuple[IntervalPiece, ...]:
        """The intervals between them that the declared sign allows, from left to right."""
        return self._pieces(self.points)

    def _pieces(self, points: Sequence[RealNumber]) -> tuple[IntervalPiece, ...]:
        ends = [None, *points, None]
        found = []
        for low, high in itertools.pairwise(ends):
            sample = rational_between(low, high)
            point = {self.name: sample}
            if self.critical.allows(point):
                found.append(IntervalPiece(low, high, sample, self.critical.is_stable(point)))
        return tuple(found)

    @cached_property
    def intervals(self) -> tuple[IntervalPiece, ...]:
        """The stable ones."""
        return tuple(piece for piece in self.pieces if piece.stable)

    @cached_property
    def cuts(self) -> tuple[RealNumber, ...]:
        """The excluded points with stable intervals on both sides."""
        pairs = zip(self.pieces[:-1], self.pieces[1:], strict=True)
        return tuple(high.low for low, high in pairs if low.stable and high.stable and high.low is not None)

    # -- for the inequalities ----------------------------------------------------------------------------------------

    def samples(self, further: Sequence[Scalar]) -> list[Sample]:
        """Return a point of every open interval, none of the further polynomials changing its sign inside one."""
        pieces = self._pieces(self.divided(further)) if further else self.pieces
        return [Sample({self.name: piece.sample}, piece.stable) for piece in pieces]

    def divided(self, further: Sequence[Scalar]) -> tuple[RealNumber, ...]:
        """Return the critical points and the roots of further irreducible polynomials, ascending."""
        more = {root for polynomial in further for root in roots_of_scalar(polynomial, self.name)}
        return tuple(sorted(more.union(self.points)))

    def surrounded(self) -> tuple[Scalar, ...]:
        """Return the critical factors that vanish at points with the region on both sides."""
        return tuple(
            factor
            for factor in self.critical.proper
            if any(root in self.cuts for root in roots_of_scalar(factor, self.name))
        )

    def through_holes(self) -> tuple[tuple[Scalar, ...], ...]:
        """Return nothing: an excluded point of a line is a cut."""
        return ()

    @property
    def empty(self) -> bool:
        """Whether the region is empty."""
        return not self.intervals

    @property
    def everywhere(self) -> bool:
        """Whether every admissible value is stable."""
        return len(self.pieces) == len(self.intervals) and not self.surrounded()

    @property
    def bounded(self) -> bool:
        """Whether every interval is bounded."""
        return all(piece.low is not None and piece.high is not None for piece in self.intervals)


# Choice of the exact region of a polynomial, within limits of time.


@lru_cache(maxsize=64)
def exact_region(critical: CriticalPolynomials, names: tuple[str, ...]) -> LineRegion | PlaneRegion | None:
    """Return the exact region in one or two parameters, None for more parameters or too high a degree.

    A parameter that may be 0 and not beyond has a boundary that belongs to it, which open cells do not see.
    """
    if any(critical.signs.get(name) in {"nonnegative", "nonpositive"} for name in names):
        return None
    critical = replace(critical, asked=names)
    if len(names) == 1:
        return LineRegion(critical, names[0])
    if len(names) != 2:
        return None
    found = plane_region(critical, (names[0], names[1]))
    if not can_be_divided(found):
        return None
    try:
        if not critical.never and not found.empty:
            short_list(found)
    except TooLarge:
        return None
    return found
