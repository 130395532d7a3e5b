"""Block diagrams: what is drawn is what the page says, found by elimination; and what is drawn can be read."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from functools import cache
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.formula.figures import figure_of, is_box, is_integrator
from symobs.formula.phrases import PHRASES
from symobs.pages.drawings.diagram_layout import diagram_scene
from symobs.pages.drawings.svg import metrics_of, svg, svg_scene
from symobs.pages.drawings.text import cells_of, sketch
from symobs.pages.drawings.tikz import metrics_for
from symobs.pages.page.blocks import Drawing
from symobs.pages.page.narrator import narrate
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from symobs.proof.derivation import Diagram
from symobs.proof.derivation.steps import everything_in
from symobs.system import StateSpace
from symobs.tasks.result import Document

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from symobs.pages.drawings.diagram_layout import Metrics
    from symobs.pages.drawings.scene import Scene
    from symobs.tasks.result import Result


SERVO = ("[0 1; 0 -1]", "[0; 1]", "[1 0]")
POLES: dict[str, Any] = {"control_poles": [-2, -2], "observer_poles": [-10, -10]}


def servo(D: str = "[0]", dt: int | bool = 0) -> StateSpace:  # noqa: FBT001
    return StateSpace(*SERVO, D, dt=dt)


def diagrams(result: Result) -> list[Diagram]:
    return [step for step in everything_in(result.derivation.steps) if isinstance(step, Diagram)]


PAGES: dict[str, Callable[[], Result]] = {
    "observer": lambda: symobs.observer(servo(), poles=[-10, -10]),
    "observer with feedthrough": lambda: symobs.observer(servo("[1]"), poles=[-10, -10]),
    "discrete observer": lambda: symobs.observer(servo(dt=True), poles=[0, 0]),
    "by ansatz": lambda: symobs.observer(servo(), poles=[-10, -10], method="existence"),
    "compensator": lambda: symobs.compensator(servo(), **POLES),
    "compensator with feedthrough": lambda: symobs.compensator(servo("[1]"), **POLES),
    "minimal-order compensator": lambda: symobs.compensator(
        servo(), control_poles=[-2, -2], observer_poles=[-10], observer="minimal"
    ),
    "parametric compensator": lambda: symobs.compensator(
        StateSpace("[0 1 0; 0 0 1; -a -b -c]", "[0; 0; 1]", "[1 d 0]"),
        control_poles=["-p", "-q", "-w"],
        observer_poles=["-p", "-q", "-w"],
    ),
    "several": lambda: symobs.compensator(
        StateSpace("[0 1; 0 -1]", "[1 0; 0 2]", "[1 1; 0 1]"), control_poles=[-2, -3], observer_poles=[-10, -11]
    ),
    "feedforward": lambda: symobs.feedforward(servo(), **POLES),
    "feedforward of a measured state": lambda: symobs.feedforward(servo("[2]"), control_poles=[-2, -2]),
    "feedforward with feedthrough": lambda: symobs.feedforward(
        servo("[1]"), control_poles=[-2, -2], observer_poles=[-10], observer="minimal"
    ),
    "tracking": lambda: symobs.tracking(
        servo(), control_poles=[-2, -2], observer_poles=[-10], observer="minimal", reference_matrix="[0 1; -4 0]"
    ),
    "minimal-order observer": lambda: symobs.reduced_order_observer(servo(), poles=[-10]),
    "minimal-order observer with feedthrough": lambda: symobs.reduced_order_observer(servo("[2]"), poles=[-10]),
    "discrete minimal-order observer": lambda: symobs.reduced_order_observer(servo(dt=True), poles=["1/2"]),
}
every_page = pytest.mark.parametrize("page", [*map(cache, PAGES.values())], ids=PAGES.keys())


# -- what can be read -------------------------------------------------------------------------------------------------


@every_page
def test_nothing_runs_through_anything(page: Callable[[], Result]) -> None:
    """In every format: boxes apart, no wire through a box, wires that cross only where a branch is drawn."""
    result = page()
    discrete = result.derivation.discrete
    variable = result.derivation.variable
    latex = LatexPrinter(variable, discrete=discrete)
    text = TextPrinter(variable, discrete=discrete)
    for step in diagrams(result):
        drawing = Drawing(step.name, step.labels)
        for metrics in (metrics_for(latex), metrics_of(text), cells_of(text, 4), cells_of(text, 2)):
            assert list(collisions(diagram_scene(drawing, metrics, 1000, discrete=discrete), metrics)) == []


def collisions(found: Scene, metrics: Metrics) -> Iterator[str]:
    boxes = [(box.centre[0], box.centre[1], *box.size) for box in found.boxes]
    boxes += [(*sign.place, metrics.junction, metrics.junction) for sign in found.signs if sign.kind == "junction"]
    for one, other in combinations(boxes, 2):
        if all(abs(one[k] - other[k]) < (one[k + 2] + other[k + 2]) / 2 for k in (0, 1)):
            yield f"{one} and {other} overlap"
    stretches = [(index, *pair) for index, line in enumerate(found.strokes) for pair in pairwise(line.points)]
    for _, begin, end in stretches:
        (left, right), (top, bottom) = sorted((begin[0], end[0])), sorted((begin[1], end[1]))
        for x, y, width, height in boxes:
            is_beside = left > x + width / 2 - 0.01 or right < x - width / 2 + 0.01
            if not is_beside and top < y + height / 2 - 0.01 and bottom > y - height / 2 + 0.01:
                yield f"a wire from {begin} to {end} through the box at {x, y}"
    branches = {sign.place for sign in found.signs if sign.kind == "branch"}
    for (i, *first), (j, *second) in combinations(stretches, 2):
        if i != j and (place := crossing(first, second)) and place not in branches:
            yield f"wires cross at {place}"
    for x, y in (text.place for text in found.texts if text.anchor == "above"):
        if any(abs(x - bx) < width / 2 and abs(y - by) < height / 2 for bx, by, width, height in boxes):
            yield f"something is written over the box at {x, y}"


def crossing(one: Sequence[Any], other: Sequence[Any]) -> tuple[float, float] | None:
    """Where a horizontal and a vertical stretch cross, both in their inside."""
    if one[0][0] == one[1][0]:
        one, other = other, one
    if one[0][1] != one[1][1] or other[0][0] != other[1][0]:
        return None
    x, y = other[0][0], one[0][1]
    is_inside = min(one[0][0], one[1][0]) < x < max(one[0][0], one[1][0])
    return (x, y) if is_inside and min(other[0][1], other[1][1]) < y < max(other[0][1], other[1][1]) else None


@every_page
def test_a_sketch_fits_a_terminal(page: Callable[[], Result]) -> None:
    result = page()
    printer = TextPrinter(result.derivation.variable, discrete=result.derivation.discrete)
    for step in diagrams(result):
        lines = sketch(Drawing(step.name, step.labels), printer, 76).splitlines()
        assert max(map(len, lines)) <= 77
        whole = "\n".join(lines)
        assert whole.count("┌") == whole.count("┐") or "┐" in whole
        assert whole.count("▶") + whole.count("◀") + whole.count("▲") + whole.count("▼") == heads(step)


def heads(step: Diagram) -> int:
    """Arrows end at boxes, junctions and outputs."""
    figure = figure_of(step.name).without_missing(dict(step.labels))
    ends = [wire.end for wire in figure.wires]
    return sum(
        is_box(node) or is_integrator(node) or figure.is_junction(node) or not figure.out_of(node) for node in ends
    )


@every_page
def test_svg_is_well_formed_and_asks_for_nothing(page: Callable[[], Result]) -> None:
    result = page()
    printer = TextPrinter(result.derivation.variable, discrete=result.derivation.discrete)
    for block in narrate(Document("", "", (result,))):
        if not isinstance(block, Drawing):
            continue
        written = svg(svg_scene(block, printer), printer, PHRASES["block_diagram"])
        root = ET.fromstring(written)  # noqa: S314 - our own text
        tags = {element.tag.rpartition("}")[2] for element in root.iter()}
        assert tags <= {"svg", "title", "path", "rect", "circle", "text", "tspan"}
        assert "href" not in written
        assert "id=" not in written
        left, top, width, height = map(float, root.attrib["viewBox"].split())
        for element in root.iter("{http://www.w3.org/2000/svg}text"):
            assert left < float(element.attrib["x"]) < left + width
            assert top < float(element.attrib["y"]) < top + height
