"""A region of two parameters in words of formulas: over intervals of one, bounds of the other.

A branch of degree 1 or 2 is written as a quotient or with a square root, others by their number among the real roots of
their polynomial.  Neighbouring cells with the same bounds are one part.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.enclosure import decimal
from symobs.exact.functions import square_part, square_root
from symobs.formula import Literal, Relation

if TYPE_CHECKING:
    from collections.abc import Mapping
    from fractions import Fraction

    from symobs.exact import RealNumber
    from symobs.exact.plane import Branch, Slab
    from symobs.region.plane import Cell, PlaneRegion


@dataclass(frozen=True)
class Edge:
    """A branch: the root `number` (from 0) in y of a polynomial, and its closed form where there is one."""

    polynomial: Scalar
    number: int
    closed: Scalar | None


@dataclass(frozen=True)
class Part:
    """low < x < high and lower(x) < y < upper(x), None where there is no bound; `reaches` a high end that belongs to it."""

    component: int
    low: RealNumber | None
    high: RealNumber | None
    lower: Edge | None
    upper: Edge | None
    cells: tuple[int, ...]
    reaches: bool = False


def parts(region: PlaneRegion) -> tuple[Part, ...]:
    """Return the parts of all components, from left to right."""
    component_of = {cell: k for k, component in enumerate(region.components) for cell in component.cells}
    follows = _followers(region)
    found: dict[int, Part] = {}
    for number, component in sorted(component_of.items()):
        slab, lower, upper = edges_of(region, region.cells[number])
        part = Part(component, slab.left, slab.right, lower, upper, (number,))
        before = found.get(follows.get(number, -1))
        if before is not None:
            last = before.cells[-1]
            del found[last]
            if (before.lower, before.upper) == (lower, upper):
                part = replace(part, low=before.low, cells=(*before.cells, number))
            else:
                found[-1 - last] = replace(before, reaches=True)
        found[number] = part
    return tuple(sorted(found.values(), key=lambda part: (part.component, part.cells[0])))


def _followers(region: PlaneRegion) -> dict[int, int]:
    """Return for each cell the one to its left that it goes on from: they meet along one piece of a wall, and no other."""
    meetings: dict[tuple[int, int], int] = {}
    for left, right, _, _ in region.joins:
        meetings[left, right] = meetings.get((left, right), 0) + 1
    lefts = [left for left, _ in meetings]
    rights = [right for _, right in meetings]
    return {
        right: left
        for (left, right), count in meetings.items()
        if count == 1 and lefts.count(left) == 1 and rights.count(right) == 1
    }


def between(name: str, low: Scalar | None, high: Scalar | None, closing: str = "<") -> Relation | None:
    """Return low < name < high, or what of it is bounded; None where nothing is."""
    symbol = Literal(Scalar.symbol(name))
    if low is not None and high is not None:
        return Relation((Literal(low), symbol, Literal(high)), ("<", closing))
    if low is not None:
        return Relation((symbol, Literal(low)), (">",))
    return None if high is None else Relation((symbol, Literal(high)), (closing,))


def relations_of(part: Part, names: tuple[str, str]) -> tuple[Relation, ...]:
    """Return the inequalities of a part whose bounds have closed forms: of x, then of y."""
    x, y = names
    ends = [None if number is None else number.scalar(x) for number in (part.low, part.high)]
    bounds = [None if edge is None else edge.closed for edge in (part.lower, part.upper)]
    first = between(x, ends[0], ends[1], "<=" if part.reaches else "<")
    return tuple(found for found in (first, between(y, bounds[0], bounds[1])) if found is not None)


def is_written(part: Part) -> bool:
    """Tell whether every bound of y has a closed form."""
    return all(edge is None or edge.closed is not None for edge in (part.lower, part.upper))


def edges_of(region: PlaneRegion, cell: Cell) -> tuple[Slab, Edge | None, Edge | None]:
    """Return the slab of a cell, and what bounds it below and above."""
    slab, below, above = region.bounds(cell)
    return slab, _edge(region, slab, below), _edge(region, slab, above)


def _edge(region: PlaneRegion, slab: Slab, branch: Branch | None) -> Edge | None:
    if branch is None:
        return None
    polynomial = region.plane.curves[branch.curve].scalar
    return Edge(polynomial, branch.number, _closed(polynomial, region.names, branch.number, slab.x))


def _closed(polynomial: Scalar, names: tuple[str, str], number: int, x: Fraction) -> Scalar | None:
    """Return a root in y of degree 1 or 2, the one of this number at x and as far as the slab reaches."""
    coefficients = polynomial.coefficients(names[1])
    if len(coefficients) == 2:
        return -coefficients[1] / coefficients[0]
    if len(coefficients) != 3:
        return None
    a, b, c = coefficients
    radical = _root_of_polynomial(b * b - 4 * a * c)
    roots = [(radical - b) / (2 * a), (-radical - b) / (2 * a)]
    roots.sort(key=lambda root: _near(root, {names[0]: Scalar.of(x)}))
    return roots[number]


def _root_of_polynomial(radicand: Scalar) -> Scalar:
    """Return √radicand, the largest square that divides its content in front."""
    unit, _ = radicand.factors()
    square = Scalar.of(square_part(abs(unit.fraction().numerator)))
    return square * square_root(radicand / square**2)


def _near(value: Scalar, point: Mapping[str, Scalar]) -> float:
    from symobs.exact.functions import substitute  # noqa: PLC0415 - roots of polynomials only

    return decimal(substitute(value, dict(point)))
