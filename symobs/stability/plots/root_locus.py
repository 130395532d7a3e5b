"""Root locus in one parameter: the roots at every node, each joined to the nearest at the next node."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.real_algebraic import roots_of_scalar
from symobs.exact.algebraic.root_location import complex_roots
from symobs.exact.core.polynomial import discriminant
from symobs.formula.figures.plot import PoleMap
from symobs.stability.plots.region_plot import range_around

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.figures.plot import Place
    from symobs.stability.criteria.critical_polynomials import StabilityBoundary
    from symobs.stability.regions.interval_region import LineRegion

#: Nodes along the way, and how near to a double root, in parts of the way, further ones stand on both sides of it.
NODES = 120
_BESIDE = (Fraction(1, 3000), Fraction(1, 600), Fraction(1, 200))
#: A root is known to about 50 bits of its modulus: in a window so much longer than wide its place cannot be drawn.
_LONGEST = 1 << 40


def pole_map(region: LineRegion, polynomial: Scalar, boundary: StabilityBoundary) -> PoleMap | None:
    """Return the root locus over the window of a region, None if a root goes to infinity or the window is too long."""
    name, variable = region.name, boundary.variable
    if not polynomial.coefficients(variable)[0].is_constant or not boundary.names <= {variable}:
        return None
    low, high = _way(region)
    if _runs_off(polynomial, name, low, high):
        return None
    nodes = _nodes(polynomial, variable, name, low, high)
    rows = [_roots(polynomial, variable, name, value) for value in nodes]
    paths = [[root] for root in rows[0]]
    for row in rows[1:]:
        for path, root in zip(paths, _paired([path[-1] for path in paths], row), strict=True):
            path.append(root)
    places = [place for path in paths for place in path]
    window = range_around([x for x, _ in places], spread=True), range_around([y for _, y in places], spread=True)
    sides = [end - begin for begin, end in window]
    if max(sides) > _LONGEST * min(sides):
        return None
    margin = None if boundary.discrete else boundary.margin.fraction()
    radius = boundary.radius.fraction() if boundary.discrete else None
    return PoleMap(
        variable,
        name,
        (nodes[0], nodes[-1]),
        tuple(tuple(path) for path in paths),
        window,
        boundary.discrete,
        margin,
        radius,
        tuple(tuple(nodes) for _ in paths),
    )


def _way(region: LineRegion) -> tuple[Fraction, Fraction]:
    """Return the range of the parameter: all ends of the region, with a margin."""
    ends = [end.interval()[0] for piece in region.intervals for end in (piece.low, piece.high) if end is not None]
    samples = [piece.sample for piece in region.intervals]
    low, high = range_around(ends + samples or [Fraction(0)])
    sign = region.critical.signs.get(region.name)
    if sign in {"positive", "nonnegative"}:
        low = max(low, Fraction(0))
    if sign in {"negative", "nonpositive"}:
        high = min(high, Fraction(0))
    return low, high


def _runs_off(polynomial: Scalar, name: str, low: Fraction, high: Fraction) -> bool:
    """Return whether a denominator vanishes on the way: of `s^2 + s + 1/a` at a = 0, where the roots have no bound."""
    below = polynomial.denominator
    places = [root.interval() for root in roots_of_scalar(below, name)] if name in below.names else []
    return any(begin <= high and low <= end for begin, end in places)


def _nodes(polynomial: Scalar, variable: str, name: str, low: Fraction, high: Fraction) -> list[Fraction]:
    """Return values of the parameter, evenly spaced and close to those with a double root."""
    way = high - low
    found = {low + way * k / NODES for k in range(NODES + 1)}
    meeting = discriminant(polynomial, variable)
    if meeting.names == {name} and not meeting.is_constant:
        for root in roots_of_scalar(meeting, name):
            where = root.interval()[0].limit_denominator(1 << 24)
            found |= {where + sign * way * part for part in _BESIDE for sign in (-1, 1)} | {where}
    return sorted(value for value in found if low <= value <= high)


def _roots(polynomial: Scalar, variable: str, name: str, value: Fraction) -> list[Place]:
    there = polynomial.substitute({name: Scalar.of(value)})
    return sorted(complex_roots([c.fraction() for c in there.coefficients(variable)]))


def _paired(before: Sequence[Place], after: Sequence[Place]) -> list[Place]:
    """Return the roots in the order of the previous ones, nearest pairs first."""
    distances = sorted(
        ((x - a) ** 2 + (y - b) ** 2, i, j) for i, (x, y) in enumerate(before) for j, (a, b) in enumerate(after)
    )
    chosen: dict[int, int] = {}
    for _, i, j in distances:
        if i not in chosen and j not in chosen.values():
            chosen[i] = j
    return [after[chosen[i]] for i in range(len(before))]
