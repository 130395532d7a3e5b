"""Signal-flow figures: where every node of a block diagram stands and how the signals run between them.

A figure is written as it looks, in the table `FIGURES` beside its task.  Its grid places the nodes:

    a name with a capital     a box; the label of that name is its gain (primes are left out: A' has the label A)
    ∫name                     an integrator, in discrete time a delay; the label `name` is its output
    any other name            a point: a junction where several wires end, a branch where several begin, an end of the
                              figure where none does; a label of that name is the signal there

and its routes say which way the wires run: `a > b` straight, `a -| b` first across, then up or down, `a |- b` first up
or down, then across.  A wire may have a gain too, `a >[U] b`, which is 1 or -1: a sign.  An optional box without a
label is not drawn, nor what hangs on it alone: so one figure serves plants with and without feedthrough.  All
mathematics comes with the labels, their signs too.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property, lru_cache
from typing import TYPE_CHECKING, TypeAlias, overload

from symobs.exact import Scalar
from symobs.formula.phrases import FIGURES
from symobs.formula.tree import Conjunction, Formula, Letter, Literal, Negative
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping

#: A gain or a signal; in the box of a whole system its equations.
Label: TypeAlias = Formula | Conjunction
Labels: TypeAlias = "Mapping[str, Label]"


@dataclass(frozen=True)
class Wire:
    """A wire from one node to another; `turn` is `>`, `-|` or `|-`, `gain` the label of a sign or empty."""

    begin: str
    turn: str
    end: str
    gain: str = ""


@dataclass(frozen=True)
class Figure:
    """Nodes on a grid, and wires.

    signals     what the points are called where the page does not say otherwise: label → letter
    letters     what stands for a label that is too wide to be drawn: label → letter
    optional    boxes that may have no label
    response    whether the figure is drawn for transfer functions: then the label `response` is the one from its input
                to its output, and the signals are names only
    """

    places: tuple[tuple[str, tuple[int, int]], ...]
    wires: tuple[Wire, ...]
    signals: tuple[tuple[str, str], ...] = ()
    letters: tuple[tuple[str, str], ...] = ()
    optional: tuple[str, ...] = ()
    response: bool = False

    @cached_property
    def place(self) -> dict[str, tuple[int, int]]:
        """Column and row of every node."""
        return dict(self.places)

    def into(self, node: str) -> list[Wire]:
        """Return the wires that end at a node."""
        return self._ends[1].get(node, [])

    def out_of(self, node: str) -> list[Wire]:
        """Return the wires that begin at a node."""
        return self._ends[0].get(node, [])

    @cached_property
    def _ends(self) -> tuple[dict[str, list[Wire]], dict[str, list[Wire]]]:
        """The wires by the node where they begin, and by the one where they end."""
        begin: dict[str, list[Wire]] = {}
        end: dict[str, list[Wire]] = {}
        for wire in self.wires:
            begin.setdefault(wire.begin, []).append(wire)
            end.setdefault(wire.end, []).append(wire)
        return begin, end

    def is_junction(self, node: str) -> bool:
        """Return whether signals are added at a node."""
        return not is_box(node) and not is_integrator(node) and len(self.into(node)) > 1

    def without_missing(self, labels: Labels) -> Figure:
        """Return the figure without unlabelled blocks and the wires and nodes connected to them alone."""
        gone = {node for node in self.place if is_box(node) and key(node) in self.optional and key(node) not in labels}
        while True:
            wires = [wire for wire in self.wires if not {wire.begin, wire.end} & gone]
            loose = {node for node in self.place if node not in gone and self._is_loose(node, wires)}
            if not loose:
                break
            gone |= loose
        places = tuple((node, place) for node, place in self.places if node not in gone)
        return replace(self, places=places, wires=tuple(wires))

    def _is_loose(self, node: str, wires: list[Wire]) -> bool:
        """Return whether a node has lost all wires of one of its sides."""
        has_lost_entry = bool(self.into(node)) and not any(wire.end == node for wire in wires)
        return has_lost_entry or (bool(self.out_of(node)) and not any(wire.begin == node for wire in wires))


def is_box(node: str) -> bool:
    """Return whether a node is a gain block."""
    return node[0].isupper()


def is_integrator(node: str) -> bool:
    """Return whether a node is an integrator or a delay."""
    return node[0] == "∫"


def key(node: str) -> str:
    """Return the label of a node."""
    return node.lstrip("∫").rstrip("'")


@overload
def without_sign(label: Formula) -> tuple[bool, Formula]: ...


@overload
def without_sign(label: Label) -> tuple[bool, Label]: ...


def without_sign(label: Label) -> tuple[bool, Label]:
    """Return whether a label is a negative, and its operand."""
    negative = False
    while isinstance(label, Negative):
        negative, label = not negative, label.operand
    return negative, label


def letter_for(name: str, place: str, label: Label) -> Formula | None:
    """Return the default label of a place in a figure, with its sign; None if there is none."""
    letter = dict(figure_of(name).letters).get(place)
    if letter is None:
        return None
    return Negative(Letter(letter)) if without_sign(label)[0] else Letter(letter)


def _figure(
    *,
    grid: str,
    routes: tuple[str, ...],
    signals: Mapping[str, str],
    letters: Mapping[str, str] | None = None,
    optional: tuple[str, ...] = (),
    response: bool = False,
) -> Figure:
    rows = [row.split() for row in grid.strip().splitlines()]
    places = tuple((name, (i, j)) for j, row in enumerate(rows) for i, name in enumerate(row) if name != ".")
    wires: list[Wire] = []
    for route in routes:
        words = route.split()
        for begin, way, end in zip(words[::2], words[1::2], words[2::2], strict=False):
            turn, _, gain = way.rstrip("]").partition("[")
            wires.append(Wire(begin, turn, end, gain))
    named = tuple(signals.items()), tuple((letters or {}).items())
    return Figure(places, tuple(wires), *named, optional, response)


@lru_cache(maxsize=32)
def figure_of(name: str) -> Figure:
    """Return a figure by its name."""
    return _figure(**FIGURES[name])


def with_signals(name: str, labels: Mapping[str, Label]) -> dict[str, Label]:
    """Return the labels with the signal names of the figure added, and minus for open signs."""
    own: dict[str, Label] = {signal: Letter(letter) for signal, letter in figure_of(name).signals}
    own |= {wire.gain: Negative(Literal(Scalar.of(1))) for wire in figure_of(name).wires if wire.gain}
    return {**own, **labels}
