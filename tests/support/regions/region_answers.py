"""What symobs says of a region, read from its JSON alone, and held against single points."""

from __future__ import annotations

import json
import re
from contextlib import suppress
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.regions.region_algebra import All, Membership, sign_holds
from tests.support.regions.region_roots import UndefinedError, compare, sign
from tests.support.regions.region_texts import Binary, Relation, UnreadableError, bound, rational_formula, statement

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from tests.support.regions.region_algebra import Formula
    from tests.support.regions.region_problem import Problem
    from tests.support.regions.region_texts import Node


@dataclass(frozen=True)
class Cell:
    """An open cell: `bounds` of the first variable, then of the second, which may depend on the first."""

    bounds: tuple[tuple[str, str, str], ...]
    stable: bool
    sample: Mapping[str, Fraction]
    component: int | None = None


@dataclass(frozen=True)
class Answer:
    """The fields of the JSON."""

    stable_if: tuple[str, ...]
    intervals: tuple[tuple[str, str], ...] | None = None
    cells: tuple[Cell, ...] | None = None
    components: int | None = None
    excluded_points: tuple[Mapping[str, str], ...] = ()
    empty: bool | None = None
    bounded: bool | None = None
    verdict: str = ""
    samples: tuple[Mapping[str, Fraction], ...] = field(default=())


def from_json(text: str, parameters: Sequence[str]) -> Answer:
    """Read the first result of a JSON text."""
    result = json.loads(text)["results"][0]
    cells = result.get("cells")
    intervals = result.get("intervals")
    components = result.get("components")
    return Answer(
        tuple(result["stable_if"]),
        None if intervals is None else tuple((str(low), str(high)) for low, high in intervals),
        None if cells is None else tuple(_cell(cell, parameters) for cell in cells),
        None if components is None else len(components),
        tuple(result.get("excluded_points") or ()),
        result.get("empty"),
        result.get("bounded"),
        result.get("verdict", ""),
        tuple(_point(sample) for sample in result.get("sample_points") or () if not _has_symbols(sample)),
    )


def _has_symbols(sample: Mapping[str, Any]) -> bool:
    return any(re.search("[A-Za-z]", str(value)) for value in sample.get("point", sample).values())


def _point(sample: Mapping[str, Any]) -> dict[str, Fraction]:
    values = sample.get("point", sample)
    return {name: Fraction(str(value)) for name, value in values.items() if isinstance(value, (str, int))}


def _cell(cell: Mapping[str, Any], parameters: Sequence[str]) -> Cell:
    bounds = [(name, str(cell[name][0]), str(cell[name][1])) for name in parameters]
    if len(parameters) == 2 and re.search(rf"\b{parameters[1]}\b", " ".join(bounds[0][1:])):
        bounds.reverse()
    return Cell(tuple(bounds), cell["stable"], _point(cell["sample"]), cell.get("component"))


def ask(problem: Problem) -> Answer:
    """Let symobs answer, in process."""
    return from_json(call(problem).to_json(), problem.parameters)


def call(problem: Problem) -> Any:
    """Return what `symobs.stability_region` returns."""
    import symobs  # noqa: PLC0415 - the oracles are independent of it

    return symobs.stability_region(problem.text, **problem.keywords)  # type: ignore[attr-defined, unused-ignore]


# -- membership -----------------------------------------------------------------------------------------------------


def holds(relations: Sequence[str], names: Sequence[str]) -> Callable[[Sequence[Fraction]], bool]:
    """Return the test whether a conjunction holds at a point."""
    rational: list[Formula] = []
    others: list[Relation] = []
    for found in map(statement, relations):
        try:
            rational.append(rational_formula(found))
        except UnreadableError:
            if not isinstance(found, Relation):
                raise
            others.append(found)
    member = Membership(All(tuple(rational)), names)

    def inside(point: Sequence[Fraction]) -> bool:
        return member(point) and all(_relation_holds(r, dict(zip(names, point, strict=True))) for r in others)

    return inside


def _relation_holds(relation: Relation, point: Mapping[str, Fraction]) -> bool:
    """Tell whether a relation with roots holds; where a part is undefined it does not."""
    try:
        return sign_holds(sign(Binary("-", relation.left, relation.right), point), relation.op)
    except UndefinedError:
        return False


def in_intervals(intervals: Sequence[tuple[str, str]]) -> Callable[[Fraction], bool]:
    """Return the test whether a number lies in a union of open intervals."""
    read = [(bound(low, ()), bound(high, ())) for low, high in intervals]

    def inside(x: Fraction) -> bool:
        return any(_above(x, low, {}) and _below(x, high, {}) for low, high in read)

    return inside


def _above(x: Fraction, low: Node | None, point: Mapping[str, Fraction]) -> bool:
    return low is None or compare(low, x, point) < 0


def _below(x: Fraction, high: Node | None, point: Mapping[str, Fraction]) -> bool:
    return high is None or compare(high, x, point) > 0


def in_cells(cells: Sequence[Cell]) -> Callable[[Mapping[str, Fraction]], bool | None]:
    """Return the test which says "stable" of the cell a point lies in, None on the lines between cells.

    Raises where two cells hold the point.  A cell whose bounds are words is not looked at.
    """
    readable: list[tuple[Cell, list[tuple[str, Node | None, Node | None]]]] = []
    for cell in cells:
        with suppress(UnreadableError):
            names = [name for name, _, _ in cell.bounds]
            readable.append((cell, [(n, bound(low, names), bound(high, names)) for n, low, high in cell.bounds]))

    def inside(bounds: Sequence[tuple[str, Node | None, Node | None]], point: Mapping[str, Fraction]) -> bool:
        known: dict[str, Fraction] = {}
        for name, low, high in bounds:
            try:
                if not (_above(point[name], low, known) and _below(point[name], high, known)):
                    return False
            except UndefinedError:
                return False
            known[name] = point[name]
        return True

    def verdict(point: Mapping[str, Fraction]) -> bool | None:
        found = [cell for cell, bounds in readable if inside(bounds, point)]
        if len(found) > 1:
            raise AssertionError(f"{dict(point)} lies in {len(found)} cells: {found}")
        return found[0].stable if found else None

    return verdict
