"""Layout of block diagrams: columns as wide as their boxes, gaps as wide as their labels.

The format says how wide it writes a label; x grows to the right, y downwards, in the unit of the format (em, or columns
and lines of a terminal).  A sign before the gain of a box moves on to the junction behind it, where readers look for it.
"""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar
from symobs.formula.figures import Figure, figure_of, is_box, is_integrator, key, letter_for, without_sign
from symobs.formula.tree import Conjunction, Derivative, Letter, Literal, Power, Quotient
from symobs.ground.dataclass import dataclass
from symobs.pages.drawings.scene import Box, Rectangle, Scene, Sign, Stroke, TextLabel

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.formula.figures import Label, Wire
    from symobs.pages.drawings.scene import Point
    from symobs.pages.page.blocks import Drawing

Measure: TypeAlias = "Callable[[Label], Point]"


@dataclass
class Metrics:
    """The measures of a format: size of a label, and spacing.

    inside      between a box and its label, across and down
    smallest    height of a box
    junction    diameter of a junction
    point       of a point that is not drawn
    gap         between columns and between rows
    beside      on both sides of what is written over a wire
    sign        what a sign beside a vertical wire takes of the space to its right
    rates       whether the inputs of integrators are written out
    """

    measure: Measure
    inside: Point
    smallest: float
    junction: float
    gap: Point
    beside: float
    point: float = 0.0
    sign: float = 0.0
    rates: bool = True


def diagram_scene(drawing: Drawing, metrics: Metrics, width: float, *, discrete: bool) -> Scene:
    """Return the layout of a diagram within a width; labels that are too wide are replaced by letters, widest first."""
    labels = dict(drawing.labels)
    figure = figure_of(drawing.name).without_missing(labels)
    letters = dict(figure.letters)
    while True:
        scene = _Arranging(figure, labels, metrics, discrete=discrete).scene()
        if scene.whole.right <= width or not letters:
            return scene
        widest = max(letters, key=lambda name: metrics.measure(without_sign(labels[name])[1])[0])
        labels[widest] = letter_for(drawing.name, widest, labels[widest]) or labels[widest]
        del letters[widest]


class _Arranging:
    """The computation of the layout of a figure with labels."""

    def __init__(self, figure: Figure, labels: dict[str, Label], metrics: Metrics, *, discrete: bool) -> None:
        self.figure, self.labels, self.metrics = figure, labels, metrics
        one, variable = Literal(Scalar.of(1)), Letter("s")
        self.integrator: Label = Power(variable, -1) if discrete else Quotient(one, variable)
        self.sizes = {node: self.size_of(node) for node in figure.place}
        self.over = dict(self.written_over())
        self.columns, width = self.positions(0, self.widths_of_gaps())
        self.rows, height = self.positions(1, {})
        self.ends = width, height

    # -- sizes --------------------------------------------------------------------------------------------------------

    def shown(self, node: str) -> Label | None:
        """Return the label of a box, or of an end of the figure."""
        if is_integrator(node):
            return self.integrator
        label = self.labels.get(key(node))
        if is_box(node) and label is not None:
            return without_sign(label)[1] if self.hands_on_its_sign(node) else label
        return label if self.is_end(node) else None

    def hands_on_its_sign(self, node: str) -> bool:
        """Return whether a box is followed by a junction, which takes over its sign."""
        ends = [wire.end for wire in self.figure.out_of(node)]
        return len(ends) == 1 and self.figure.is_junction(ends[0])

    def is_end(self, node: str) -> bool:
        """Return whether a node is an input or output of the figure."""
        is_between = bool(self.figure.into(node)) and bool(self.figure.out_of(node))
        return not (is_between or is_box(node) or is_integrator(node))

    def size_of(self, node: str) -> Point:
        """Return the width and height of a node."""
        shown, metrics = self.shown(node), self.metrics
        if shown is not None:
            width, height = metrics.measure(shown)
            if self.is_end(node):
                return width + 2 * metrics.beside, height
            return width + 2 * metrics.inside[0], max(metrics.smallest, height + 2 * metrics.inside[1])
        size = metrics.junction if self.figure.is_junction(node) else metrics.point
        return size, size

    # -- what is written over wires -------------------------------------------------------------------------------------

    def written_over(self) -> Iterator[tuple[Wire, tuple[Label, bool]]]:
        """Yield the labelled wires, and whether the label is at their beginning."""
        at_ends = {key(node) for node in self.figure.place if self.is_end(node)}
        for node in self.figure.place:
            label = self.labels.get(key(node))
            if is_box(node) or label is None or isinstance(label, Conjunction) or self.is_end(node):
                continue
            into, out = self.figure.into(node), self.figure.out_of(node)
            if is_integrator(node) and self.metrics.rates and len(into) == 1 and self.ends_across(into[0]):
                yield into[0], (Derivative(label), False)
            if key(node) in at_ends:
                continue
            across = [wire for wire in out if self.begins_across(wire)]
            arriving = [wire for wire in into if len(into) == 1 and self.ends_across(wire)]
            if across or not arriving:
                yield (across or out)[0], (label, True)
            else:
                yield arriving[0], (label, False)

    def begins_across(self, wire: Wire) -> bool:
        """Return whether a wire begins horizontally."""
        return wire.turn == "-|" or (wire.turn == ">" and self.row(wire.begin) == self.row(wire.end))

    def ends_across(self, wire: Wire) -> bool:
        """Return whether a wire ends horizontally."""
        return wire.turn == "|-" or (wire.turn == ">" and self.row(wire.begin) == self.row(wire.end))

    def row(self, node: str) -> int:
        """Return the row of a node in the grid."""
        return self.figure.place[node][1]

    def is_entered_from_above(self, node: str) -> bool:
        """Return whether the sign of an entering wire occupies the place of the label of the leaving wire."""
        arriving = [wire for wire in self.figure.into(node) if not self.ends_across(wire)]
        return self.figure.is_junction(node) and any(self.row(wire.begin) < self.row(node) for wire in arriving)

    def widths_of_gaps(self) -> dict[tuple[int, int], float]:
        """Return the widths of the gaps with labels between neighbouring columns."""
        used = sorted({column for column, _ in self.figure.place.values()})
        wanted: dict[tuple[int, int], float] = {}
        for wire, (label, _) in self.over.items():
            ends = sorted(self.figure.place[node][0] for node in (wire.begin, wire.end))
            for pair in pairwise(used):
                if list(pair) == ends:
                    sign = self.metrics.sign if self.is_entered_from_above(wire.begin) else 0
                    room = self.metrics.measure(label)[0] + 2 * self.metrics.beside + sign
                    wanted[pair] = max(room, wanted.get(pair, 0.0))
        return wanted

    # -- places -------------------------------------------------------------------------------------------------------

    def positions(self, axis: int, gaps: dict[tuple[int, int], float]) -> tuple[dict[int, float], float]:
        """Return the centre of every column (row) in use, and where the last one ends."""
        used = sorted({place[axis] for place in self.figure.place.values()})
        middles: dict[int, float] = {}
        edge, last = 0.0, None
        for index in used:
            thick = max(self.sizes[node][axis] for node, place in self.figure.place.items() if place[axis] == index)
            if last is not None:
                edge += max(self.metrics.gap[axis], gaps.get((last, index), 0.0))
            middles[index] = edge + thick / 2
            edge, last = edge + thick, index
        return middles, edge

    def at(self, node: str) -> Point:
        """Return the centre of a node."""
        column, row = self.figure.place[node]
        return self.columns[column], self.rows[row]

    def border(self, node: str, towards: Point) -> Point:
        """Return the point where a wire from `towards` meets a node."""
        (x, y), (width, height) = self.at(node), self.sizes[node]
        if not self.is_drawn(node):
            return x, y
        if abs(towards[0] - x) > abs(towards[1] - y):
            return x + _sign(towards[0] - x) * width / 2, y
        return x, y + _sign(towards[1] - y) * height / 2

    def corners(self, wire: Wire) -> tuple[Point, ...]:
        """Return a wire from border to border."""
        begin, end = self.at(wire.begin), self.at(wire.end)
        turn = {"-|": [(end[0], begin[1])], "|-": [(begin[0], end[1])]}.get(wire.turn, [])
        bends = [corner for corner in turn if corner not in {begin, end}]
        inner = [begin, *bends, end]
        return self.border(wire.begin, inner[1]), *bends, self.border(wire.end, inner[-2])

    # -- the whole ----------------------------------------------------------------------------------------------------

    def scene(self) -> Scene:
        """Return the complete layout."""
        nodes = list(self.figure.place)
        boxes = [node for node in nodes if is_box(node) or is_integrator(node)]
        ends = [node for node in nodes if self.is_end(node)]
        plain = [node for node in nodes if not self.is_drawn(node)]
        junctions = [Sign("junction", self.at(node)) for node in nodes if self.figure.is_junction(node)]
        branches = [Sign("branch", self.at(node)) for node in plain if len(self.figure.out_of(node)) > 1]
        names = [TextLabel(_given(self.shown(node)), self.at(node)) for node in ends]
        over = [self.label(wire, label, begins) for wire, (label, begins) in self.over.items()]
        return Scene(
            frame=Rectangle(0.0, 0.0, *self.ends),
            whole=Rectangle(0.0, 0.0, *self.ends),
            strokes=tuple(
                Stroke(self.corners(wire), "arrow" if self.is_drawn(wire.end) else "wire") for wire in self.figure.wires
            ),
            boxes=tuple(Box(self.at(node), self.sizes[node], _given(self.shown(node))) for node in boxes),
            signs=(*junctions, *branches, *self.signs()),
            texts=(*names, *over),
            is_diagram=True,
        )

    def is_drawn(self, node: str) -> bool:
        """Return whether wires end at the border of a node: a box, a junction, or a label at an end of the figure."""
        return self.shown(node) is not None or self.figure.is_junction(node)

    def label(self, wire: Wire, label: Label, at_beginning: bool) -> TextLabel:  # noqa: FBT001
        """Return the label of a wire, in the middle of its first or last segment."""
        points = self.corners(wire)
        (x0, y0), (x1, y1) = points[:2] if at_beginning else points[-2:]
        return TextLabel(label, ((x0 + x1) / 2, (y0 + y1) / 2), "above" if y0 == y1 else "right")

    def signs(self) -> Iterator[Sign]:
        """Yield the signs at the junctions."""
        for wire in self.figure.wires:
            if not self.figure.is_junction(wire.end):
                continue
            gain = self.labels.get(wire.gain) if wire.gain else None
            if gain is None and is_box(wire.begin) and self.hands_on_its_sign(wire.begin):
                gain = self.labels[key(wire.begin)]
            (x0, y0), (x1, y1) = self.corners(wire)[-2:]
            towards = (_sign(x1 - x0), _sign(y1 - y0))
            yield Sign("-" if gain is not None and without_sign(gain)[0] else "+", (x1, y1), towards)


def _sign(number: float) -> float:
    return float((number > 0) - (number < 0))


def _given(label: Label | None) -> Label:
    assert label is not None  # noqa: S101 - boxes without a label are not drawn, nor ends without a signal
    return label
