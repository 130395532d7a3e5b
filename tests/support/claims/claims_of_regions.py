"""The fields of a stability region that follow from its answer, held at points against the roots."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.algebra import is_stable, value_at
from tests.support.regions.region_answers import from_json, holds, in_cells, in_intervals
from tests.support.regions.region_facts import in_w, moved_at, points, table_at
from tests.support.regions.region_roots import compare, value
from tests.support.regions.region_texts import bound, expression

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion
    from tests.support.algebra import Point

#: Half of the last digit that is shown.
_HALF = Fraction(51, 10**8)


def region_holds(part: StabilityRegion, at: Point) -> None:
    """Hold every derived field at a point, and at others drawn from there."""
    fields, boundary = part.fields, part.question.boundary
    names = [*fields["parameters"], *part.question.symbols]
    drawn = points(names, part.plant.symbols.signs, at[boundary.variable], 25)
    samples = [{name: at[name] for name in names}, *drawn]
    assert sorted(names) == sorted(part.answer["polynomial"].names - {boundary.variable})
    said = from_json(part.to_json(), fields["parameters"])

    def stable(point: Mapping[str, Fraction]) -> bool:
        return is_stable(moved_at(part, point), discrete=boundary.discrete)

    assert [[value_at(entry, with_epsilon(part, at)) for entry in row] for row in fields["routh_table"]] == table_at(
        part.answer["routh"], leading(part, at), with_epsilon(part, at)
    )
    inside = holds(said.stable_if, names)
    between = in_intervals(said.intervals) if said.intervals is not None else None
    cells = in_cells(said.cells) if said.cells is not None else None
    for point in samples:
        found = stable(point)
        assert inside(tuple(point[name] for name in names)) == found
        assert not (found and said.empty)
        assert between is None or between(point[names[0]]) == found
        if cells is not None and (seen := cells(point)) is not None and not any(map(point.__eq__, holes_of(part))):
            assert seen == found
        if cells is not None and not is_on_wall(part, point):
            assert is_in_part(part, point) == found or point in holes_of(part)
        if said.bounded and names:
            assert not stable({name: 10**9 * x + 10**8 for name, x in point.items()})
    for point in samples[:5]:
        points_hold(part, stable, point)
    if fields.get("irredundant") and not said.empty:
        assert each_is_needed(said.stable_if, names, part)


def points_hold(part: StabilityRegion, stable: Any, at: Point) -> None:
    """Hold the points that are named: samples of the region and of its cells, and what is left out."""
    fields = part.fields
    for sample in fields.get("sample_points", ()):
        assert stable(read(sample, at))
    for component in fields.get("components", ()):
        assert stable(read(component["sample"], at))
        assert not (component["bounded"] is False and fields["bounded"])
    for cell in fields.get("cells", ()):
        assert stable(read(cell["sample"])) == cell["stable"] == (cell["component"] is not None)
    for hole in holes_of(part):
        assert not stable(hole)
        near = [{**hole, name: x + d} for name, x in hole.items() for d in (Fraction(-1, 10**9), Fraction(1, 10**9))]
        assert all(map(stable, near))
    assert not fields.get("excluded_curves")
    assert fields["empty"] == (fields["stable_if"] == ["False"])
    for exact, decimal in zip(fields.get("intervals", ()), fields.get("intervals_decimal", ()), strict=True):
        for end, shown in zip(exact, decimal, strict=True):
            node = bound(end, ())
            if node is None:
                assert shown == end
                continue
            assert compare(node, Fraction(shown) - _HALF, {}) > 0 > compare(node, Fraction(shown) + _HALF, {})


def read(point: Mapping[str, str], at: Point | None = None) -> dict[str, Fraction]:
    """Return a point that is named, its parts possibly in symbols whose values are given."""
    return {**(at or {}), **{name: value(expression(text), at or {}) for name, text in point.items()}}


def holes_of(part: StabilityRegion) -> list[dict[str, Fraction]]:
    return [read(hole) for hole in part.fields.get("excluded_points", ())]


def with_epsilon(part: StabilityRegion, at: Point) -> dict[str, Fraction]:
    return {**at, part.answer["routh"].epsilon: Fraction(1, 97)}


def leading(part: StabilityRegion, at: Point) -> list[Fraction]:
    """Return the coefficients that the table begins with."""
    a = moved_at(part, at)
    return [value_at(part.question.critical.scale, at) * c for c in in_w(a)] if part.plant.is_discrete else a


def pieces(part: StabilityRegion) -> list[tuple[list[str], list[str], list[bool]]]:
    """Return the bounds of both parameters in every part of a component."""
    x, y = part.region.names  # type: ignore[union-attr]
    return [(p[x], p[y], p["closed"]) for component in part.fields["components"] for p in component["parts"]]


def is_in_part(part: StabilityRegion, point: Mapping[str, Fraction]) -> bool:
    """Tell whether a point lies in a part of a component."""
    x, y = part.region.names  # type: ignore[union-attr]

    def within(ends: list[str], value: Fraction, known: Mapping[str, Fraction], closed: list[bool]) -> bool:
        low, high = (bound(end, tuple(known)) for end in ends)
        above = low is None or compare(low, value, known) < closed[0]
        return above and (high is None or compare(high, value, known) > -closed[1])

    return any(
        within(xs, point[x], {}, closed) and within(ys, point[y], {x: point[x]}, [False, False])
        for xs, ys, closed in pieces(part)
    )


def is_on_wall(part: StabilityRegion, point: Mapping[str, Fraction]) -> bool:
    """Tell whether a point stands over an end of some part, where the bounds need have no meaning."""
    (x, _) = part.region.names  # type: ignore[union-attr]
    ends = [bound(end, ()) for xs, _, _ in pieces(part) for end in xs]
    return any(end is not None and compare(end, point[x], {}) == 0 for end in ends)


def each_is_needed(relations: tuple[str, ...], names: list[str], part: StabilityRegion) -> bool:
    """Tell whether for each inequality there is a point where the others hold and it does not."""
    drawn = [tuple(p[name] for name in names) for p in points(names, part.plant.symbols.signs, "needed", 300)]
    own = [holds([relation], names) for relation in relations]
    seen = [[inside(point) for inside in own] for point in drawn]
    return all(any(not row[k] and sum(row) == len(row) - 1 for row in seen) for k in range(len(own)))
