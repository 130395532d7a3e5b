"""Check of a region plot against the exact region, to within visible accuracy (trusted).

Curves, areas, marks and the grid are each held by themselves against where the polynomial is stable.  That a curve
passes by is seen from a change of sign.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property, lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.root_location import has_positive_minors, value_at, vanishes_near
from symobs.exact.cad.decomposition import PlaneCurve
from symobs.formula.figures import Figure, figure_of, is_box, is_integrator, key, without_sign
from symobs.formula.tree import (
    Block,
    Conjunction,
    Derivative,
    Environment,
    Formula,
    Identity,
    Letter,
    Literal,
    Product,
    Relation,
    Sum,
    children,
    letters,
)
from symobs.formula.tree.plain_text import plain_relation
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.stability import bilinear, stability

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.formula.figures import Curve, Interval, Label, MarkedPoint, Place, RegionPicture, Wire


# Check of block diagrams (trusted): the equation at every node is compared with the established ones.
#
# What leaves a node is the label there, or else the sum of what comes in; a box multiplies it by its gain. So a
# labelled point says that its label is this sum, an integrator that the derivative of its output is, and a box of a
# whole system that its equations hold and that the signals which enter and leave it are those they speak of. In a
# figure of transfer functions the input is 1 and the output is what the label `response` says.


def equations_of(name: str, labels: Mapping[str, Label], environment: Environment) -> Iterator[Relation]:
    """Yield the equations of a diagram.  Raises `ValueError` where nothing can be read."""
    figure = figure_of(name).without_missing(labels)
    unused = {*labels} - {key(node) for node in figure.place} - {wire.gain for wire in figure.wires} - {"response"}
    is_named = {signal for signal, _ in figure_of(name).signals}
    if unused - is_named:
        raise ValueError(f"a label {min(unused - is_named)}, which is not in the figure")
    flow = _Flow(figure, labels, environment)
    for label, letter in figure.letters:
        yield Relation((Letter(letter), without_sign(flow.label(label))[1]), ("=",))
    for node in figure.place:
        yield from flow.said_at(node)


class _Flow:
    """A figure with its labels, in an environment."""

    def __init__(self, figure: Figure, labels: Mapping[str, Label], environment: Environment) -> None:
        self.figure, self.labels, self.environment = figure, labels, environment
        self.output = {node for node in figure.place if figure.response and not figure.out_of(node)}

    def label(self, name: str) -> Formula:
        """Return a label that must be there."""
        found = self.labels.get(name)
        if found is None or isinstance(found, Conjunction):
            raise ValueError(f"no formula for {name}")
        return found

    def said_at(self, node: str) -> Iterator[Relation]:
        """Yield the equation of a node, if it has one."""
        wires = self.figure.into(node)
        label = self.labels.get(key(node))
        if isinstance(label, Conjunction):
            yield from label.relations
            self.hold_to_its_signals(node, label)
        elif is_integrator(node):
            yield Relation((Derivative(self.label(key(node))), self.total(wires)), ("=",))
        elif self.figure.response:
            if key(node) in self.output:
                yield Relation((self.label("response"), self.total(wires)), ("=",))
        elif not is_box(node) and label is not None and wires and not self.is_from_system(wires):
            yield Relation((label, self.total(wires)), ("=",))

    def leaving(self, node: str) -> Formula:
        """Return what leaves a node.  A loop with neither an integrator nor a signal in it has no end: RecursionError."""
        wires = self.figure.into(node)
        if self.figure.response and not wires:
            return Identity(self.environment.sizes.get("u", 1))
        if key(node) in self.output:
            return self.label("response")
        if is_box(node):
            arriving = [self.through(wire) for wire in wires]
            entering = arriving[0] if len(wires) == 1 else Block(tuple((part,) for part in arriving))
            return Product((self.label(key(node)), entering))
        if not self.figure.response and (key(node) in self.labels or not wires):
            return self.label(key(node))
        return self.total(wires)

    def total(self, wires: list[Wire]) -> Formula:
        """Return the sum of what arrives on some wires."""
        arriving = tuple(self.through(wire) for wire in wires)
        return arriving[0] if len(arriving) == 1 else Sum(arriving)

    def through(self, wire: Wire) -> Formula:
        """Return the signal on a wire; a gain ±1 is a sign."""
        arriving = self.leaving(wire.begin)
        if not wire.gain:
            return arriving
        gain = self.label(wire.gain)
        if without_sign(gain)[1] != Literal(Scalar.of(1)):
            raise ValueError("a gain on a wire, where only a sign is drawn")
        return Product((gain, arriving))

    def is_from_system(self, wires: list[Wire]) -> bool:
        """Return whether wires come from the box of a whole system, whose equations define its outputs."""
        return any(isinstance(self.labels.get(wire.begin), Conjunction) for wire in wires)

    def hold_to_its_signals(self, node: str, equations: Conjunction) -> None:
        """Reject a system with signals other than those at its box and its own state."""
        members = [member for relation in equations.relations for member in relation.members]
        spoken = {name for member in members for name in letters(member)} & self.environment.signals.keys()
        states = {name for member in members for name in _differentiated(member)}
        around = [self.leaving(wire.begin) for wire in self.figure.into(node)]
        around += [self.label(key(wire.end)) for wire in self.figure.out_of(node)]
        at_box = {signal.name for signal in around if isinstance(signal, Letter)}
        if not all(isinstance(signal, Letter) for signal in around):
            raise ValueError(f"the box {node}, around which not all signals are letters")
        if spoken - states != at_box - states:
            raise ValueError(f"the box {node}, whose equations do not speak of the signals around it")


def _differentiated(formula: Formula) -> frozenset[str]:
    """Return the signals whose derivative stands in a formula."""
    own = letters(formula.operand) if isinstance(formula, Derivative) else frozenset[str]()
    return own.union(*(_differentiated(part) for part in children(formula)))


# Places of a picture: whether they lie in its window, whether a polynomial is stable there (trusted).


#: A condition of stability is all but zero where it is so much smaller than at the points around.
_SMALLER = 16
_NOWHERE = (Fraction(0), Fraction(0))


#: The numbers that a declared sign allows.
ALLOWS: dict[str, Callable[[Fraction], bool]] = {
    "positive": lambda value: value > 0,
    "negative": lambda value: value < 0,
    "nonnegative": lambda value: value >= 0,
    "nonpositive": lambda value: value <= 0,
    "nonzero": lambda value: value != 0,
    "real": lambda _: True,
}


def within(place: Place, window: tuple[Interval, Interval], near: Place = _NOWHERE) -> bool:
    """Return whether a place lies in the window, to visible accuracy."""
    return all(low - step <= part <= high + step for part, (low, high), step in zip(place, window, near, strict=True))


def written(place: Place) -> str:
    """Return a place as text."""
    return f"({', '.join(map(str, place))})"


@dataclass
class Stability:
    """Stability of a polynomial over the axes of a plot, which are parameters with declared signs."""

    polynomial: Scalar
    variable: str
    axes: tuple[str, ...]
    signs: tuple[str, ...]
    discrete: bool

    def is_stable(self, *place: Fraction) -> bool:
        """Return whether all roots are stable where the signs allow it; where the degree drops a root has gone to infinity."""
        if not all(ALLOWS[sign](part) for sign, part in zip(self.signs, place, strict=True)):
            return False
        point = dict(zip(self.axes, place, strict=True))
        below, lead, coefficients = self._parts
        if value_at(below, point) == 0 or value_at(lead, point) == 0:
            return False
        return has_positive_minors([value_at(c, point) for c in coefficients])

    @cached_property
    def _parts(self) -> tuple[Scalar, Scalar, tuple[Scalar, ...]]:
        """The denominator, the leading coefficient, and all coefficients of what is stable in continuous time alike."""
        found = self.polynomial.numerator.coefficients(self.variable)
        return self.polynomial.denominator, found[0], tuple(bilinear(found)) if self.discrete else found

    def is_excluded(self, place: tuple[Fraction, ...], around: Sequence[tuple[Fraction, ...]]) -> bool:
        """Return whether a point is not stable, or one that is not lies near: there a condition all but vanishes."""
        if not self.is_stable(*place):
            return True
        conditions = stability(self.polynomial, self.variable, {}, discrete=self.discrete).positive
        leading = self.polynomial.coefficients(self.variable)[0]
        return any(
            _SMALLER * abs(_number(value, self.axes, place)) <= min(abs(_number(value, self.axes, p)) for p in around)
            for value in (leading, *conditions)
        )


def _at(axes: Sequence[str], place: Sequence[Fraction]) -> dict[str, Scalar]:
    return {name: Scalar.of(part) for name, part in zip(axes, place, strict=True)}


def _number(value: Scalar, axes: Sequence[str], place: Sequence[Fraction]) -> Fraction:
    return value.substitute(_at(axes, place)).fraction()


#: Parts of a window: what is near a curve, and what the middle of a drawn segment may lie off its curve.
_NEAR, _BETWEEN = Fraction(1, 500), Fraction(1, 50)
#: How many places in a row are asked for all over a window and beside a curve, and how far beside it.
_PLACES, _ASKED, _BESIDE = 7, 8, Fraction(1, 10_000)
_ON_SEGMENT = (Fraction(2, 7), Fraction(5, 9), Fraction(3, 4))
_ALONG = (Fraction(1, 10), Fraction(1, 2), Fraction(9, 10))


def faults_of_region(picture: RegionPicture, equations: dict[Relation, Scalar], test: Stability) -> Iterator[str]:
    """Yield the faults of a region plot."""
    window = picture.window
    if any(low >= high for low, high in window):
        yield "the window is empty"
        return
    for curve in picture.curves:
        yield from faults_of_curve(curve, equations[curve.equation], window, test)
    drawn = tuple(value for value in equations.values() if _is_of_curve(value, test))
    excluded = frozenset(mark.place for mark in picture.marks if mark.kind == "excluded")
    for area in picture.areas:
        yield from faults_of_area(area, drawn, excluded, window, test)
    filled = _filled(picture.areas, tuple(mark.place for mark in picture.marks))
    for mark in picture.marks:
        yield from faults_of_mark(mark, mark.place in filled, window, test)
    places = tuple(_grid(window))
    yield from faults_of_grid(places, _filled(picture.areas, places), drawn, window, test)


def faults_of_curve(curve: Curve, value: Scalar, window: tuple[Interval, Interval], test: Stability) -> Iterator[str]:
    """Yield the faults of a curve value = 0."""
    equation = plain_relation(curve.equation, test.variable)
    if not _is_of_curve(value, test):
        yield f"{equation} is the equation of a curve"
        return
    near, between = _part(window, _NEAR), _part(window, _BETWEEN)
    middles = [_middle(a, b) for a, b in pairwise(curve.points)]
    inside = [place for place in middles if within(place, window)]
    if not all(passes(value, test.axes, place, near) for place in curve.points) or not all(
        passes(value, test.axes, place, between) for place in inside
    ):
        yield equation
    elif curve.boundary not in _are_boundaries(curve, window, test):
        yield f"{equation} is {'a' if curve.boundary else 'no'} boundary"


def _is_of_curve(value: Scalar, test: Stability) -> bool:
    """Return whether a value vanishes on a curve in the plane of the axes."""
    return not value.is_constant and value.names <= set(test.axes)


def faults_of_area(
    area: tuple[Place, ...],
    drawn: tuple[Scalar, ...],
    excluded: frozenset[Place],
    window: tuple[Interval, Interval],
    test: Stability,
) -> Iterator[str]:
    """Yield the faults of an area: its edges lie on drawn curves or the border, and all inside is stable."""
    near, between = _part(window, _NEAR), _part(window, _BETWEEN)
    curved = list(_sloping(area, near))
    ends = {place for edge in curved for place in edge}
    for place in area:
        if not within(place, window, near):
            yield f"an edge at {written(place)}, outside of the window"
        elif (place in ends or not _on_border(place, window, near)) and not _is_drawn(drawn, test.axes, place, near):
            yield f"an edge at {written(place)}"
    for middle in (_middle(*edge) for edge in curved):
        if not _is_drawn(drawn, test.axes, middle, between):
            yield f"an edge at {written(middle)}"
    samples = (place for place in _inside(area, near[0]) if place not in excluded)
    yield from (f"{written(place)} is stable" for place in samples if not test.is_stable(*place))


def faults_of_mark(
    mark: MarkedPoint,
    is_filled: bool,  # noqa: FBT001 - the tests keep what is asked by position
    window: tuple[Interval, Interval],
    test: Stability,
) -> Iterator[str]:
    """Yield the faults of a mark: it and the shade agree with the stability at its place."""
    (x, y), (dx, dy) = mark.place, _part(window, _NEAR)
    around = [(x - dx, y), (x + dx, y), (x, y - dy), (x, y + dy)]
    is_stable = test.is_stable(x, y)
    agrees = {
        "stable": is_stable and is_filled,
        "unstable": not is_stable and not is_filled,
        "excluded": test.is_excluded((x, y), around),
    }
    if not agrees.get(mark.kind):
        yield f"{written(mark.place)} is {mark.kind}"


def faults_of_grid(
    places: tuple[Place, ...],
    filled: frozenset[Place],
    drawn: tuple[Scalar, ...],
    window: tuple[Interval, Interval],
    test: Stability,
) -> Iterator[str]:
    """Yield which places are filled and not stable, or stable and not filled, away from all that is drawn."""
    near = _part(window, _NEAR)
    for place in places:
        is_apart = not _is_drawn(drawn, test.axes, place, near)
        if is_apart and test.is_stable(*place) != (place in filled):
            yield f"{written(place)} is {'not ' if test.is_stable(*place) else ''}stable"


def _part(window: tuple[Interval, Interval], part: Fraction) -> Place:
    """Return the same part of the width and of the height of a window."""
    (left, right), (bottom, top) = window
    return (right - left) * part, (top - bottom) * part


def _is_drawn(drawn: Sequence[Scalar], axes: Sequence[str], place: Place, step: Place) -> bool:
    """Return whether one of the curves that are drawn passes by."""
    return any(passes(value, axes, place, step) for value in drawn)


def _filled(areas: Sequence[tuple[Place, ...]], places: tuple[Place, ...]) -> frozenset[Place]:
    """Return those of some places that lie in one of the areas."""
    return frozenset(place for area in areas for place in within_area(area, places))


def passes(value: Scalar, axes: Sequence[str], place: Place, step: Place) -> bool:
    """Return whether the curve value = 0 has a point on the cross of half-width `step` at a place."""
    (x, y), (dx, dy), curve = place, step, _curve(value, *axes)
    return vanishes_near(curve.on_vertical(x), y, dy) or vanishes_near(curve.on_horizontal(y), x, dx)


@lru_cache(maxsize=64)
def _curve(value: Scalar, first: str, second: str) -> PlaneCurve:
    """Return a polynomial in two names ready to be cut by lines."""
    return PlaneCurve(value, (first, second))


def _middle(a: Place, b: Place) -> Place:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _sloping(area: Sequence[Place], near: Place) -> Iterator[tuple[Place, Place]]:
    """Yield the edges that can be seen to be parallel to no axis: they are parts of curves, on the border too."""
    for a, b in zip(area, (*area[1:], area[0]), strict=True):
        if all(abs(p - q) > step for p, q, step in zip(a, b, near, strict=True)):
            yield a, b


def _grid(window: tuple[Interval, Interval]) -> Iterator[Place]:
    """Yield places all over the window."""
    (left, right), (bottom, top) = window
    for i in range(_PLACES):
        for j in range(_PLACES):
            x, y = Fraction(97 * i + 41, 97 * _PLACES), Fraction(97 * j + 43, 97 * _PLACES)
            yield left + (right - left) * x, bottom + (top - bottom) * y


def _are_boundaries(curve: Curve, window: tuple[Interval, Interval], test: Stability) -> set[bool]:
    """Return whether a curve can be called a boundary, and whether it can be called none.

    At some of its points a place on either side is asked for; a boundary is what something stable lies beside.
    """
    width, height = (high - low for low, high in window)
    points = curve.points if len(curve.points) > 2 else _along(*curve.points)
    seen: set[bool] = set()
    for k in range(1, len(points) - 1, max(1, len(points) // _ASKED)):
        (x, y), (x0, y0), (x1, y1) = points[k], points[k - 1], points[k + 1]
        across = (y0 - y1) / height, (x1 - x0) / width
        if not any(across):
            continue  # it turns back here
        size = _BESIDE / max(map(abs, across))
        aside = across[0] * size * width, across[1] * size * height
        for place in ((x + aside[0], y + aside[1]), (x - aside[0], y - aside[1])):
            if within(place, window):
                seen.add(test.is_stable(*place))
    return {True in seen} if seen else {True, False}


def _along(a: Place, b: Place) -> tuple[Place, ...]:
    """Return places on a segment, ends included, none at its middle, where another curve may cross."""
    return tuple((a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part) for part in (0, *_ON_SEGMENT, 1))


def _on_border(place: Place, window: tuple[Interval, Interval], near: Place) -> bool:
    """Return whether a place lies on the border of the window."""
    return any(
        part <= low + step or part >= high - step for part, (low, high), step in zip(place, window, near, strict=True)
    )


def _inside(area: Sequence[Place], near: Fraction) -> Iterator[Place]:
    """Yield places inside a polygon, at three heights three on every stretch; none on what is too short to be seen."""
    heights = [y for _, y in area]
    bottom, top = min(heights), max(heights)
    for k in (1, 2, 3):
        y = bottom + (top - bottom) * (Fraction(k, 4) + Fraction(1, 97))
        crossings = sorted(_crossings(area, y))
        for a, b in zip(crossings[::2], crossings[1::2], strict=True):
            if b - a > 2 * near:
                yield from ((a + (b - a) * part, y) for part in _ALONG)


def _crossings(area: Sequence[Place], y: Fraction) -> Iterator[Fraction]:
    """Yield where the edges of a polygon cross a horizontal line."""
    above, below = y.numerator, y.denominator  # the integers of a fraction are compared in a fraction of the time
    sides = [height.numerator * below <= above * height.denominator for _, height in area]
    for k, side in enumerate(sides):
        if side != sides[k - 1]:
            (x0, y0), (x1, y1) = area[k - 1], area[k]
            yield x0 + (x1 - x0) * (y - y0) / (y1 - y0)


def within_area(area: Sequence[Place], places: Sequence[Place]) -> list[Place]:
    """Return those of some places that lie in a polygon: an odd number of crossings is to their left."""
    crossings = {y: list(_crossings(area, y)) for _, y in places}
    return [(x, y) for x, y in places if sum(crossing < x for crossing in crossings[y]) % 2 == 1]
