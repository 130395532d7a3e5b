"""Stability regions of two parameters: cells, components and holes."""

from __future__ import annotations

from functools import cached_property, lru_cache
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

from symobs.exact import TooLarge
from symobs.exact.cad.decomposition import Branch, CriticalLine, Cylinder, Plane
from symobs.exact.cad.fiber import Fibre, curves_between, fibre, place_between, point_between
from symobs.ground.dataclass import dataclass
from symobs.stability.regions.short_list import Sample

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

    from symobs.exact import RealNumber, Scalar
    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials

#: The plane is divided where the degrees of all discriminants and resultants sum to no more than this.
LARGEST_PROJECTION = 170
#: With the conditions of a short list besides, it may be this much larger.
_LARGER = 3


@dataclass(frozen=True)
class Cell:
    """An open cell: its place (cylinder, height in the stack), a rational point in it, and whether it is stable there.

    What the declared signs do not allow is not `allowed`, and not stable.
    """

    cylinder: int
    height: int
    sample: tuple[Fraction, Fraction]
    stable: bool
    allowed: bool = True


@dataclass(frozen=True)
class Component:
    """A connected component of the region: the numbers of its cells, and whether it is bounded."""

    cells: tuple[int, ...]
    bounded: bool


@dataclass(frozen=True)
class Hole:
    """An isolated excluded point of the region; `y` is None if it has no closed form."""

    x: RealNumber
    y: RealNumber | None
    near: tuple[Fraction, Fraction]


@dataclass(frozen=True)
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
