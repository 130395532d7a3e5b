"""Block diagrams and plots as data, before any format draws them."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias, overload

from symobs.exact import Scalar
from symobs.formula.phrases import FIGURES
from symobs.formula.tree import Conjunction, Formula, Letter, Literal, Negative
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.formula.tree import Relation


# Plots as data, in coordinates of the plane, before any format draws them.


#: A point of a picture.  Coordinates are rational: what is drawn can be held against what is exact.
Place: TypeAlias = "tuple[Fraction, Fraction]"
Interval: TypeAlias = "tuple[Fraction, Fraction]"


@dataclass
class Curve:
    """A segment of the curve of `equation`, either a `boundary` of the region or a dividing curve."""

    points: tuple[Place, ...]
    equation: Relation
    boundary: bool = True


@dataclass
class MarkedPoint:
    """A marked point: `stable` or `unstable` (a sample of a cell), or `excluded` (a hole of the region)."""

    place: Place
    kind: str


@dataclass
class RegionPicture:
    """A region of two parameters inside a window: filled areas (closed polygons), curves, marks.

    `drawn_for` are the values given to other symbols, since a picture needs numbers.
    """

    axes: tuple[str, str]
    window: tuple[Interval, Interval]
    areas: tuple[tuple[Place, ...], ...]
    curves: tuple[Curve, ...]
    marks: tuple[MarkedPoint, ...] = ()
    drawn_for: tuple[tuple[str, Scalar], ...] = ()


@dataclass
class End:
    """An end of an interval on a line: its position, and its label."""

    place: Fraction
    label: Scalar | str


@dataclass
class LinePicture:
    """Open intervals of one parameter; a missing end lies beyond the window."""

    axis: str
    window: Interval
    pieces: tuple[tuple[End | None, End | None], ...]
    marks: tuple[tuple[Fraction, str], ...] = ()
    drawn_for: tuple[tuple[str, Scalar], ...] = ()


@dataclass
class PoleMap:
    """A root locus: the paths of the poles over a range of a parameter, with begin and end marked.

    The stability boundary is the imaginary axis moved left by `margin`, or in discrete time the circle of radius `radius`.
    `along` are the values of the parameter at the points of each path.
    """

    variable: str
    moved: str
    values: Interval
    paths: tuple[tuple[Place, ...], ...]
    window: tuple[Interval, Interval]
    discrete: bool = False
    margin: Fraction | None = None
    radius: Fraction | None = None
    along: tuple[tuple[Fraction, ...], ...] = ()
    #: The zeros of the loop, to which the roots go as the parameter grows: the rings are there instead of at the ends.
    zeros: tuple[Place, ...] | None = None
    drawn_for: tuple[tuple[str, Scalar], ...] = ()


@dataclass
class PlottedResponse:
    """The time response of one signal component: `row` times the state.

    `component` counts from 1, and is 0 where the signal has no other; a `dashed` response is an estimate.
    `heights` are its values, in whole parts of one, at equal distances from the begin of the window to its end.
    """

    signal: str
    component: int
    row: tuple[Fraction, ...]
    heights: tuple[int, ...]
    dashed: bool = False


@dataclass
class TimeResponse:
    """Time responses: the stacked `states` satisfy a linear equation, with initial states `starts`.

    Heights of responses are counted in `parts` of one.  In `discrete` time they stand at 0, 1, 2, … and are exact.
    """

    states: tuple[str, ...]
    starts: tuple[tuple[Fraction, ...], ...]
    responses: tuple[PlottedResponse, ...]
    window: tuple[Interval, Interval]
    parts: int
    drawn_for: tuple[tuple[str, Scalar], ...] = ()
    discrete: bool = False

    def points(self, response: PlottedResponse) -> list[Place]:
        """Return the points of one of the responses."""
        begin, end = self.window[0]
        step = (end - begin) / (len(response.heights) - 1)
        return [(begin + k * step, Fraction(height, self.parts)) for k, height in enumerate(response.heights)]


@dataclass
class NyquistPicture:
    """The values of a loop along half of the boundary of stability, poles on it passed on the unstable side.

    `contour` are the places on the boundary, from 0 or 1 on upwards; the other half has the conjugate values.
    """

    contour: tuple[Place, ...]
    values: tuple[Place, ...]
    window: tuple[Interval, Interval]
    discrete: bool = False
    indented: bool = False
    delay: Fraction = Fraction(0)


@dataclass
class BodePicture:
    """The modulus of a loop in decibels and its phase in degrees at places of the boundary of stability.

    `across` are the decimal logarithms of the frequency there, in discrete time of the angle.  The window is that of the
    logarithms and of the decibels; phases fill theirs.  The asymptotes of the modulus bend at the moduli of poles and zeros.
    """

    contour: tuple[Place, ...]
    across: tuple[Fraction, ...]
    levels: tuple[Fraction, ...]
    phases: tuple[Fraction, ...]
    window: tuple[Interval, Interval]
    discrete: bool = False
    delay: Fraction = Fraction(0)
    asymptotes: tuple[Place, ...] = ()

    @property
    def gain_margin(self) -> tuple[Place, Place] | None:
        """The bar from the curve of the modulus to 0 dB where the phase passes −180° (and whole turns), the shortest one."""
        passes = _passes(self.across, [(phase + 180) / 360 for phase in self.phases], self.levels)
        found = min(passes, key=lambda each: abs(each[1]), default=None)
        return None if found is None else ((found[0], found[1]), (found[0], Fraction(0)))

    @property
    def phase_margin(self) -> tuple[Place, Place] | None:
        """The bar from the curve of the phase to −180° (and turns) where the modulus passes 0 dB, the shortest one."""
        bars = [
            ((x, phase), (x, Fraction(360 * round((phase + 180) / 360) - 180)))
            for x, phase in _passes(self.across, self.levels, self.phases, every=False)
        ]
        return min(bars, key=lambda bar: abs(bar[0][1] - bar[1][1]), default=None)


def _passes(
    across: Sequence[Fraction], first: Sequence[Fraction], second: Sequence[Fraction], *, every: bool = True
) -> list[Place]:
    """Return (x, height of the second curve) where the first one passes 0, or with `every` any whole number."""
    found: list[Place] = []
    for (x, a, b), (y, c, d) in pairwise(zip(across, first, second, strict=True)):
        level = Fraction(round((a + c) / 2)) if every else Fraction(0)
        if a != c and (a - level) * (c - level) <= 0:
            part = (level - a) / (c - a)
            found.append((x + part * (y - x), b + part * (d - b)))
    return found


@dataclass
class Branch:
    """A piece of a branch of equilibria: the value of each signal as a function of the parameter, and points of the one drawn.

    It is `stable` where the linearisation is asymptotically stable.
    """

    at: tuple[tuple[str, Scalar], ...]
    points: tuple[Place, ...]
    stable: bool


@dataclass
class BranchPicture:
    """The values of a state at equilibria over a parameter; `marks` are branch points with the exact value of the parameter."""

    axes: tuple[str, str]
    states: tuple[str, ...]
    window: tuple[Interval, Interval]
    branches: tuple[Branch, ...]
    marks: tuple[tuple[Place, Scalar], ...] = ()
    discrete: bool = False


#: What stands on a page, and is checked with it.
Picture: TypeAlias = RegionPicture | LinePicture | PoleMap | TimeResponse | NyquistPicture | BodePicture | BranchPicture
#: A line through values that were rounded to binary numbers; values of a sweep are exact, what joins them is not.
Run: TypeAlias = "tuple[tuple[float, float], ...]"


@dataclass
class SweepCurves:
    """Columns of a sweep over one name: of each its name, the lines through its values, and the gaps without any.

    Columns that are `infinite` at all points are only named.
    """

    axis: str
    columns: tuple[tuple[Formula | str, tuple[Run, ...], tuple[tuple[float, float], ...]], ...]
    window: tuple[float, float]
    points: int
    infinite: tuple[Formula | str, ...] = ()


@dataclass
class SweepMap:
    """A column of a sweep over two names: lines of equal values; in the rectangles `gaps` there are none."""

    axes: tuple[str, str]
    column: Formula | str
    window: tuple[tuple[float, float], tuple[float, float]]
    levels: tuple[tuple[Fraction, tuple[Run, ...]], ...]
    points: int
    gaps: tuple[Run, ...] = ()


Drawn: TypeAlias = Picture | SweepCurves | SweepMap


# Signal-flow figures: where every node of a block diagram stands and how the signals run between them.
#
# A figure is written as it looks, in the table `FIGURES` beside its task. Its grid places the nodes:
#
# a name with a capital a box; the label of that name is its gain (primes are left out: A' has the label A) ∫name an
# integrator, in discrete time a delay; the label `name` is its output any other name a point: a junction where several
# wires end, a branch where several begin, an end of the figure where none does; a label of that name is the signal
# there
#
# and its routes say which way the wires run: `a > b` straight, `a -| b` first across, then up or down, `a |- b` first
# up or down, then across. A wire may have a gain too, `a >[U] b`, which is 1 or -1: a sign. An optional box without a
# label is not drawn, nor what hangs on it alone: so one figure serves plants with and without feedthrough. All
# mathematics comes with the labels, their signs too.


#: A gain or a signal; in the box of a whole system its equations.
Label: TypeAlias = Formula | Conjunction
Labels: TypeAlias = "Mapping[str, Label]"


@dataclass
class Wire:
    """A wire from one node to another; `turn` is `>`, `-|` or `|-`, `gain` the label of a sign or empty."""

    begin: str
    turn: str
    end: str
    gain: str = ""


@dataclass
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
