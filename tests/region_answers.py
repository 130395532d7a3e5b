"""What symobs says of a region, read from its JSON alone, and held against single points."""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.region_algebra import All, Membership
from tests.region_roots import UndefinedError, compare
from tests.region_texts import Call, expression, rational_formula, statement

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from tests.region_problem import Problem
    from tests.region_texts import Node


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
        tuple(_point(sample) for sample in result.get("sample_points") or ()),
    )


def _point(sample: Mapping[str, Any]) -> dict[str, Fraction]:
    values = sample.get("point", sample)
    return {name: Fraction(str(value)) for name, value in values.items() if isinstance(value, (str, int))}


def _cell(cell: Mapping[str, Any], parameters: Sequence[str]) -> Cell:
    bounds = [(name, str(cell[name][0]), str(cell[name][1])) for name in parameters]
    if any(_names(text) for text in bounds[0][1:]):
        bounds.reverse()
    return Cell(tuple(bounds), cell["stable"], _point(cell["sample"]), cell.get("component"))


def _names(text: str) -> bool:
    """Tell whether a bound depends on a parameter: the generator of a CRootOf is none."""
    node = expression(text) if text not in {"oo", "-oo"} else None
    return node is not None and not (isinstance(node, Call) and node.function == "CRootOf") and bool(_in(node))


def _in(node: Node) -> set[str]:
    match node:
        case Call("CRootOf"):
            return set()
        case Call(_, arguments):
            return set().union(*(_in(argument) for argument in arguments))
    found: set[str] = set()
    for part in ("left", "right", "base"):
        if hasattr(node, part):
            found |= _in(getattr(node, part))
    return found | ({node.name} if hasattr(node, "name") else set())


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
    return Membership(All(tuple(rational_formula(statement(text)) for text in relations)), names)


def in_intervals(intervals: Sequence[tuple[str, str]]) -> Callable[[Fraction], bool]:
    """Return the test whether a number lies in a union of open intervals."""
    read = [(_bound(low), _bound(high)) for low, high in intervals]

    def inside(x: Fraction) -> bool:
        return any(_above(x, low, {}) and _below(x, high, {}) for low, high in read)

    return inside


def _bound(text: str) -> Node | None:
    return None if text in {"oo", "-oo"} else expression(text)


def _above(x: Fraction, low: Node | None, point: Mapping[str, Fraction]) -> bool:
    return low is None or compare(low, x, point) < 0


def _below(x: Fraction, high: Node | None, point: Mapping[str, Fraction]) -> bool:
    return high is None or compare(high, x, point) > 0


def in_cells(cells: Sequence[Cell]) -> Callable[[Mapping[str, Fraction]], bool | None]:
    """Return the test which says "stable" of the cell a point lies in, None on the lines between cells.

    Raises where two cells hold the point.
    """
    read = [[(name, _bound(low), _bound(high)) for name, low, high in cell.bounds] for cell in cells]

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
        found = [cell for cell, bounds in zip(cells, read, strict=True) if inside(bounds, point)]
        if len(found) > 1:
            raise AssertionError(f"{dict(point)} lies in {len(found)} cells: {found}")
        return found[0].stable if found else None

    return verdict
