"""Description of a region of two parameters: over intervals of one, bounds of the other.

A branch of degree 1 or 2 is written as a quotient or with a square root, others by their number among the real roots of
their polynomial.  Neighbouring cells with the same bounds are one part.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.enclosure import sign_of_number
from symobs.exact.algebraic.real_algebraic import integer_factor
from symobs.exact.core.generators import square_part, square_root, substitute
from symobs.formula.tree import Literal, Relation
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact import RealNumber
    from symobs.exact.cad.decomposition import Branch, Cylinder
    from symobs.stability.regions.region import Cell, PlaneRegion


@dataclass
class Edge:
    """A branch: the root `number` (from 0) in y of a polynomial, and its closed form where there is one."""

    polynomial: Scalar
    number: int
    closed: Scalar | None
    name: str

    def is_finite_at(self, x: RealNumber) -> bool:
        """Return whether the branch is bounded there: its leading coefficient, or denominator, is nonzero."""
        below = self.polynomial.coefficients(self.name)[0] if self.closed is None else self.closed.denominator
        return below.is_constant or x.sign_of(integer_factor(below, next(iter(below.names)))) != 0


@dataclass
class CylindricalPart:
    """A cylindrical part: low < x < high and lower(x) < y < upper(x), None for no bound.

    `begins` and `reaches`: whether the lower and the higher end of x belong to it, with the bounds that stand there.
    """

    component: int
    low: RealNumber | None
    high: RealNumber | None
    lower: Edge | None
    upper: Edge | None
    cells: tuple[int, ...]
    begins: bool = False
    reaches: bool = False


def parts(region: PlaneRegion) -> tuple[CylindricalPart, ...]:
    """Return the parts of all components, from left to right."""
    component_of = {cell: k for k, component in enumerate(region.components) for cell in component.cells}
    meetings = adjacencies_of(region)
    goes_on = {m.right: m.left for m in meetings if m.left_alone and m.right_alone}
    found: dict[int, CylindricalPart] = {}
    for number, component in sorted(component_of.items()):
        cylinder, lower, upper = edges_of(region, region.cells[number])
        part = CylindricalPart(component, cylinder.left, cylinder.right, lower, upper, (number,))
        before = found.get(goes_on.get(number, -1))
        if before and (before.lower, before.upper) == (lower, upper) and is_regular(part, cylinder.left):
            del found[before.cells[-1]]
            part = replace(part, low=before.low, cells=(*before.cells, number))
        found[number] = part
    first = {part.cells[0]: key for key, part in found.items()}
    for meeting in meetings:
        if meeting.left not in found or meeting.right not in first:
            continue  # inside one part
        left, right = found[meeting.left], found[first[meeting.right]]
        if meeting.left_alone and is_regular(left, left.high):
            found[meeting.left] = replace(left, reaches=True)
        elif meeting.right_alone and is_regular(right, right.low):
            found[first[meeting.right]] = replace(right, begins=True)
    return tuple(sorted(found.values(), key=lambda part: (part.component, part.cells[0])))


@dataclass
class Adjacency:
    """Two stable cells adjacent along a segment of a critical line, and whether the segment is the whole side of a cell."""

    left: int
    right: int
    left_alone: bool
    right_alone: bool


def adjacencies_of(region: PlaneRegion) -> list[Adjacency]:
    """Return all adjacencies, critical line by critical line."""
    lefts = Counter(left for left, _, _, _ in region.joins)
    rights = Counter(right for _, right, _, _ in region.joins)
    return [Adjacency(left, right, lefts[left] == 1, rights[right] == 1) for left, right, _, _ in region.joins]


def is_regular(part: CylindricalPart, end: RealNumber | None) -> bool:
    """Return whether the bounds of a part are defined at one of its ends."""
    edges = [edge for edge in (part.lower, part.upper) if edge is not None]
    # the number of a root may be another one on the critical line itself
    return end is not None and all(edge.closed is not None and edge.is_finite_at(end) for edge in edges)


def are_whole(region: PlaneRegion, found: Sequence[CylindricalPart]) -> bool:
    """Return whether the parts cover the region: each segment between adjacent cells belongs to a part."""
    part_of = {cell: part for part in found for cell in part.cells}
    return not region.holes and all(
        part_of[m.left] is part_of[m.right]
        or (part_of[m.left].reaches and m.left_alone)
        or (part_of[m.right].begins and m.right_alone)
        for m in adjacencies_of(region)
    )


def between(
    name: str, low: Scalar | None, high: Scalar | None, opening: str = "<", closing: str = "<"
) -> Relation | None:
    """Return low < name < high, without infinite bounds, None if both are infinite."""
    symbol = Literal(Scalar.symbol(name))
    if low is not None and high is not None:
        return Relation((Literal(low), symbol, Literal(high)), (opening, closing))
    if low is not None:
        return Relation((symbol, Literal(low)), (opening.replace("<", ">"),))
    return None if high is None else Relation((symbol, Literal(high)), (closing,))


def relations_of(part: CylindricalPart, names: tuple[str, str]) -> tuple[Relation, ...]:
    """Return the inequalities of a part with closed forms: of x, then of y."""
    x, y = names
    ends = [None if number is None else number.scalar(x) for number in (part.low, part.high)]
    bounds = [None if edge is None else edge.closed for edge in (part.lower, part.upper)]
    first = between(x, ends[0], ends[1], "<=" if part.begins else "<", "<=" if part.reaches else "<")
    return tuple(found for found in (first, between(y, bounds[0], bounds[1])) if found is not None)


def is_written(part: CylindricalPart) -> bool:
    """Return whether every bound of y has a closed form."""
    return all(edge is None or edge.closed is not None for edge in (part.lower, part.upper))


def edges_of(region: PlaneRegion, cell: Cell) -> tuple[Cylinder, Edge | None, Edge | None]:
    """Return the cylinder of a cell, and its lower and upper bound."""
    edges: tuple[Edge | None, ...] = (None, *edges_over(region, cell.cylinder), None)
    return region.plane.cylinders[cell.cylinder], edges[cell.height], edges[cell.height + 1]


def edges_over(region: PlaneRegion, index: int) -> tuple[Edge, ...]:
    """Return the branches over a cylinder from below."""
    known = region.edges
    if index not in known:
        cylinder = region.plane.cylinders[index]
        known[index] = tuple(_edge(region, cylinder, branch) for branch in cylinder.branches)
    return known[index]


def _edge(region: PlaneRegion, cylinder: Cylinder, branch: Branch) -> Edge:
    polynomial = region.plane.curves[branch.curve].scalar
    closed = _closed(polynomial, region.names, branch.number, cylinder.x)
    return Edge(polynomial, branch.number, closed, region.names[1])


def _closed(polynomial: Scalar, names: tuple[str, str], number: int, x: Fraction) -> Scalar | None:
    """Return the closed form of the root in y of this index over the cylinder, for degree 1 or 2."""
    coefficients = polynomial.coefficients(names[1])
    if len(coefficients) == 2:
        return -coefficients[1] / coefficients[0]
    if len(coefficients) != 3:
        return None
    a, b, c = coefficients
    radical = _root_of_polynomial(b * b - 4 * a * c)
    lower, upper = (-radical - b) / (2 * a), (radical - b) / (2 * a)
    if sign_of_number(substitute(radical / a, {names[0]: Scalar.of(x)})) == "negative":
        lower, upper = upper, lower
    return upper if number else lower


def _root_of_polynomial(radicand: Scalar) -> Scalar:
    """Return √radicand, the largest square that divides its content in front."""
    unit, _ = radicand.factors()
    square = Scalar.of(square_part(abs(unit.fraction().numerator)))
    return square * square_root(radicand / square**2)
