"""The fields of a stability region: exact texts, decimals beside."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.stability.inequalities.solved_bounds import box
from symobs.stability.inequalities.written_form import as_inequality
from symobs.stability.regions.description import are_whole
from symobs.stability.regions.interval_region import LineRegion

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from fractions import Fraction

    from symobs.exact import RealNumber
    from symobs.stability.inequalities.simplify import Simplified
    from symobs.stability.regions.description import CylindricalPart, Edge
    from symobs.stability.regions.interval_region import IntervalPiece
    from symobs.stability.regions.plane_region import PlaneRegion
    from symobs.stability.regions.short_list import RegionInequality
    from symobs.tasks.analysis.stability_region.stability_region_question import RegionQuestion

DIGITS = 6


def stable_if(
    bounds: Sequence[RegionInequality] | None, region: object, signs: Mapping[str, str], parameters: Sequence[str]
) -> list[str]:
    """Return the inequalities as texts; of a single interval its ends."""
    if bounds is None:
        return ["False"]
    if isinstance(region, LineRegion) and len(region.intervals) == 1 and not region.cuts:
        return ends_of(region.intervals[0], region.name, signs)
    return [" ".join(map(str, solved(bound, signs, parameters))) for bound in bounds]


def solved(bound: RegionInequality, signs: Mapping[str, str], parameters: Sequence[str] = ()) -> tuple[Any, str, Any]:
    """Return an inequality solved for a parameter where its coefficient has a certain sign."""
    if bound.operator == "!=":
        left, operator, right = as_inequality(bound.polynomial, signs, parameters)
        return left, "!=" if operator else operator, right
    return as_inequality(bound.polynomial, signs, parameters)


def of_conditions(found: Simplified, question: RegionQuestion) -> dict[str, Any]:
    """Return the fields of a region given by inequalities alone: empty, bounded, a sample point."""
    empty = True if found.verdict == "no" else False if found.point is not None or found.verdict == "yes" else None
    limits = box(found.positive, question.parameters, question.plant.symbols.signs) if found.verdict != "no" else None
    fields: dict[str, Any] = {"empty": empty, "irredundant": found.irredundant, "bounded": None}
    if limits is not None and not limits.needs:
        fields["bounded"] = limits.bounded
        fields["components"] = [{"bounded": limits.bounded, "sample": _texts(limits.sample)}]
    point = limits.sample if limits is not None and limits.sample else found.point
    fields["sample_points"] = [_texts(point)] if point else []
    return fields


def _texts(point: Mapping[str, Any] | None) -> dict[str, str]:
    return {name: str(value) for name, value in (point or {}).items()}


def ends_of(piece: IntervalPiece, name: str, signs: Mapping[str, str]) -> list[str]:
    """Return name > low and name < high, without bounds implied by the declared sign."""
    found = []
    if piece.low is not None and not (
        signs.get(name) == "positive" and piece.low.is_rational and not piece.low.fraction
    ):
        found.append(f"{name} > {piece.low.text(name)}")
    if piece.high is not None and not (
        signs.get(name) == "negative" and piece.high.is_rational and not piece.high.fraction
    ):
        found.append(f"{name} < {piece.high.text(name)}")
    return found


def end(number: RealNumber | None, side: str, name: str = "x") -> str:
    """Return an end of an interval as an exact text."""
    return f"{side}oo".lstrip("+") if number is None else number.text(name)


def decimals(number: RealNumber | None, side: str) -> str:
    """Return an end of an interval as a decimal, rounded."""
    return f"{side}oo".lstrip("+") if number is None else number.decimal(DIGITS)


def intervals_of(region: LineRegion) -> dict[str, Any]:
    """Return the open intervals, exact and in decimals, the points left out between them, and a point of each."""
    name, pieces = region.name, region.intervals
    return {
        "bounded": region.bounded,
        "intervals": [[end(p.low, "-", name), end(p.high, "+", name)] for p in pieces],
        "intervals_decimal": [[decimals(p.low, "-"), decimals(p.high, "+")] for p in pieces],
        "excluded_points": [{name: point.text(name)} for point in region.cuts],
        "sample_points": [{name: str(piece.sample)} for piece in pieces],
    }


def _edge(edge: Edge | None, side: str, name: str) -> str:
    """Return a bound as an exact text: in closed form, or as a root of its polynomial in `name`."""
    if edge is None:
        return f"{side}oo".lstrip("+")
    return str(edge.closed) if edge.closed is not None else f"CRootOf({edge.polynomial}, {name}, {edge.number})"


def _point(region: PlaneRegion, sample: tuple[Fraction, Fraction]) -> dict[str, str]:
    return {name: str(value) for name, value in zip(region.names, sample, strict=True)}


def cells_of(region: PlaneRegion) -> list[dict[str, Any]]:
    """Return every open cell: its bounds, a point of it, whether it is stable, and its component."""
    from symobs.stability.regions.description import edges_over  # noqa: PLC0415 - only where cells are asked for

    component = {cell: k for k, found in enumerate(region.components) for cell in found.cells}
    x, y = region.names
    widths = [[end(cylinder.left, "-", x), end(cylinder.right, "+", x)] for cylinder in region.plane.cylinders]
    heights = [
        [_edge(None, "-", y), *(_edge(edge, "", y) for edge in edges_over(region, index)), _edge(None, "+", y)]
        for index in range(len(widths))
    ]
    return [
        {
            "sample": _point(region, cell.sample),
            "stable": cell.stable,
            "component": component.get(number),
            x: list(widths[cell.cylinder]),
            y: heights[cell.cylinder][cell.height : cell.height + 2],
        }
        for number, cell in enumerate(region.cells)
        if cell.allowed
    ]


def components_of(region: PlaneRegion, parts: Sequence[CylindricalPart]) -> list[dict[str, Any]]:
    """Return every connected component: bounded or not, a point of it, and bounds of y over intervals of x."""
    x, y = region.names
    listed = []
    for number, component in enumerate(region.components):
        own = [part for part in parts if part.component == number]
        listed.append(
            {
                "bounded": component.bounded,
                "sample": _point(region, region.cells[component.cells[0]].sample),
                "parts_are_whole": are_whole(region, parts),
                "parts": [
                    {
                        x: [end(part.low, "-", x), end(part.high, "+", x)],
                        y: [_edge(part.lower, "-", y), _edge(part.upper, "+", y)],
                        "closed": [part.begins, part.reaches],
                    }
                    for part in own
                ],
            }
        )
    return listed


def excluded_of(region: PlaneRegion) -> dict[str, Any]:
    """Return isolated points and curves that the region surrounds without containing them, and a point of each component."""
    x, y = region.names
    points = [
        {x: hole.x.text(x), y: hole.y.text(y) if hole.y is not None else f"about {float(hole.near[1]):.6g}"}
        for hole in region.holes
    ]
    samples = [_point(region, region.cells[component.cells[0]].sample) for component in region.components]
    curves = [f"{factor} == 0" for factor in region.surrounded()]
    return {"excluded_points": points, "excluded_curves": curves, "sample_points": samples}
