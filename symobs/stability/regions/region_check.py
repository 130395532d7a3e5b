"""Check of a region by independent means (trusted).

The plane's division is proved by `decomposition_check`.  The critical values are held against determinants of numbers at
random points, the verdict in every cell against the isolated roots of the polynomial at its sample, the list of
inequalities against the cells of a division in which nothing listed changes its sign inside a cell.
"""

from __future__ import annotations

import random
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.exact.algebraic.enclosure import sign_of_number
from symobs.exact.algebraic.real_algebraic import integer_factor
from symobs.exact.algebraic.root_location import count_roots_by_half_plane, value_at
from symobs.exact.cad.decomposition_check import holds, is_line
from symobs.exact.core.generators import normal_form, substitute
from symobs.stability.criteria.critical_polynomials import irreducible
from symobs.stability.regions.description import adjacencies_of, is_regular
from symobs.stability.regions.region import PlaneRegion, is_exact

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact.cad.decomposition import Cylinder
    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials
    from symobs.stability.regions.description import CylindricalPart, Edge
    from symobs.stability.regions.region import LineRegion, RegionInequality

_POINTS = 3


def are_critical(critical: CriticalPolynomials) -> bool:
    """Return whether the coefficients are those of the shifted polynomial, and the critical factors complete.

    At random points: (w − 1)ⁿ χ((w + 1)/(w − 1)) = Σ aₖ wⁿ⁻ᵏ in discrete time, else χ itself; a₀, aₙ and the determinant of the
    n − 1 first rows and columns of Hurwitz' matrix must vanish where a product of powers of the factors does.
    """
    generator = random.Random(f"{critical.polynomial} {critical.boundary}")  # noqa: S311 - repeatable by design
    order = critical.order
    for _ in range(_POINTS):
        point = {name: Fraction(generator.getrandbits(61)) for name in critical.parameters}
        a = critical.at(point)
        ratios = {_ratio(critical, a, point, Scalar.of(generator.getrandbits(61))) for _ in range(2)}
        if len(ratios) != 1 or ratios.pop().is_zero:
            return False
        rows = [[a[2 * j - i] if 0 <= 2 * j - i <= order else 0 for j in range(1, order)] for i in range(1, order)]
        last = Matrix.of(rows).determinant().fraction() if rows else Fraction(1)
        found = [value_at(v, point) for v in critical.values]
        if set(found) != {a[0], a[-1], *([last] if order > 1 else [])}:
            return False
    return all(_is_product(value, critical.factors) for value in (*critical.values, critical.denominator))


def _is_product(value: Scalar, factors: Sequence[Scalar]) -> bool:
    """Return whether a polynomial is a product of powers of these, up to a number."""
    for factor in factors:
        while not value.is_constant and (quotient := value / factor).denominator.is_constant:
            value = quotient
    return value.is_constant


def _ratio(critical: CriticalPolynomials, a: Sequence[Fraction], point: Mapping[str, Fraction], w: Scalar) -> Scalar:
    """Return Σ aₖ wⁿ⁻ᵏ divided by the polynomial at the number that w stands for, times (w − 1)ⁿ in discrete time."""
    boundary, value = critical.boundary, Scalar.of(0)
    for coefficient in a:
        value = value * w + coefficient
    where = (w + 1) / (w - 1) * boundary.radius if boundary.discrete else w - boundary.margin
    there = {name: Scalar.of(value) for name, value in point.items()}
    polynomial = critical.polynomial.substitute({**there, boundary.variable: where})
    return value / (polynomial * (w - 1) ** critical.order if boundary.discrete else polynomial)


@lru_cache(maxsize=256)
def is_region(region: LineRegion | PlaneRegion, bounds: tuple[RegionInequality, ...] | None) -> bool:
    """Return whether a region is correct, and these inequalities hold exactly on it (None: it is empty)."""
    critical = region.critical
    if critical.never:
        return bounds is None
    if not are_critical(critical) or not _is_bounded_by_signs(region):
        return False
    if not all(critical.allows(sample.point) for sample in region.samples(())):
        return False
    if bounds is None:
        return _is_divided(region, ()) and region.empty
    further = [f for f in irreducible(bound.polynomial for bound in bounds) if f not in critical.factors]
    return _is_divided(region, ()) and (not further or _is_divided(region, further)) and is_exact(region, bounds)


def _is_bounded_by_signs(region: LineRegion | PlaneRegion) -> bool:
    """Return whether no cell holds allowed and forbidden values: its sample would speak for both."""
    names, signs = region.names if isinstance(region, PlaneRegion) else (region.name,), region.critical.signs
    return all(Scalar.symbol(name) in region.critical.factors for name in names if signs.get(name, "real") != "real")


def _is_divided(region: LineRegion | PlaneRegion, further: Sequence[Scalar]) -> bool:
    """Return whether a decomposition is complete, and the isolated roots agree with the stability of every cell."""
    if isinstance(region, PlaneRegion):
        whole = holds(region.divided(further))
    else:
        factors = [integer_factor(f, region.name) for f in (*region.critical.factors, *further)]
        whole = is_line(region.divided(further), factors)
    return whole and all(
        sample.stable == (count_roots_by_half_plane(region.critical.at(sample.point)) == (region.critical.order, 0, 0))
        for sample in region.samples(further)
    )


def are_parts(region: PlaneRegion, parts: Sequence[CylindricalPart]) -> bool:
    """Return whether the parts are all stable cells, each once, and every closed form equals its branch.

    A closed form solves the branch's polynomial identically, is continuous over the cylinder, and lies between the two samples
    around the branch at the cylinder's point: no other branch does.
    """
    listed = [number for part in parts for number in part.cells]
    if sorted(listed) != [number for number, cell in enumerate(region.cells) if cell.stable]:
        return False
    lefts, rights = ({k: m for m in adjacencies_of(region) for k in [getattr(m, side)]} for side in ("left", "right"))
    for part in parts:
        at_end, at_start = lefts.get(part.cells[-1]), rights.get(part.cells[0])
        if part.reaches and not (at_end and at_end.left_alone and is_regular(part, part.high)):
            return False
        if part.begins and not (at_start and at_start.right_alone and is_regular(part, part.low)):
            return False
    return all(_is_part(region, part, number) for part in parts for number in part.cells)


def _is_part(region: PlaneRegion, part: CylindricalPart, number: int) -> bool:
    cell = region.cells[number]
    cylinder, below, above = region.bounds(cell)
    ends = (region.cells[part.cells[0]], region.cells[part.cells[-1]])
    if (part.low, part.high) != (region.bounds(ends[0])[0].left, region.bounds(ends[1])[0].right):
        return False
    for edge, branch, place in ((part.lower, below, cell.height - 1), (part.upper, above, cell.height)):
        if (edge is None) != (branch is None):
            return False
        if edge is None or branch is None:
            continue
        polynomial = region.plane.curves[branch.curve].scalar
        if (edge.polynomial, edge.number) != (polynomial, branch.number):
            return False
        if edge.closed is not None and not _is_branch(edge, region.names, cylinder, place):
            return False
    return True


def _is_branch(edge: Edge, names: tuple[str, str], cylinder: Cylinder, place: int) -> bool:
    """Return whether a closed form is a root, and lies between the adjacent samples at the cylinder's point."""
    assert edge.closed is not None  # noqa: S101 - asked only where there is one
    left = normal_form(edge.polynomial.substitute({names[1]: edge.closed}))
    at_point = substitute(edge.closed, {names[0]: Scalar.of(cylinder.x)})
    low, high = (Scalar.of(y) for y in cylinder.samples[place : place + 2])
    return (
        left.is_zero and sign_of_number(at_point - low) == "positive" and sign_of_number(high - at_point) == "positive"
    )
