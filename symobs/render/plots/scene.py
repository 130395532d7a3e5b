"""Scenes: plots on paper, in points, for the writers of TikZ, SVG and matplotlib.

The origin is the lower left corner of the frame, y grows upwards.  Everything is clipped to the frame already, and
every text has its place: a format only writes down.
"""

from __future__ import annotations

from itertools import pairwise
from math import hypot
from typing import TYPE_CHECKING, TypeAlias

from symobs._dataclass import dataclass
from symobs.formula import Formula, Relation

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

#: What is written: mathematics, or a text such as a number of a tick.
Content: TypeAlias = Formula | Relation | str
Point: TypeAlias = tuple[float, float]
#: How wide and how high a format writes something, in points.
Measure: TypeAlias = "Callable[[Content], tuple[float, float]]"

FONT_SIZE = 9.0


@dataclass(frozen=True)
class Rectangle:
    """A rectangle."""

    left: float
    bottom: float
    right: float
    top: float

    def grown(self, by: float) -> Rectangle:
        """Return the rectangle with a margin added."""
        return Rectangle(self.left - by, self.bottom - by, self.right + by, self.top + by)

    def meets(self, other: Rectangle) -> bool:
        """Return whether two rectangles overlap."""
        return (
            self.left < other.right and other.left < self.right and self.bottom < other.top and other.bottom < self.top
        )

    def holds(self, other: Rectangle) -> bool:
        """Return whether another rectangle lies inside this one."""
        return (
            self.left <= other.left
            and other.right <= self.right
            and self.bottom <= other.bottom
            and other.top <= self.top
        )

    @property
    def centre(self) -> Point:
        """The middle."""
        return (self.left + self.right) / 2, (self.bottom + self.top) / 2


@dataclass(frozen=True)
class TextLabel:
    """A label with the `anchor` of its box (center, north, south, east or west) at `place`."""

    content: Content
    place: Point
    anchor: str = "center"

    def box(self, size: tuple[float, float]) -> Rectangle:
        """Return the rectangle of the label."""
        (x, y), (width, height) = self.place, size
        left = {"west": x, "east": x - width}.get(self.anchor, x - width / 2)
        bottom = {"south": y, "north": y - height}.get(self.anchor, y - height / 2)
        return Rectangle(left, bottom, left + width, bottom + height)


@dataclass(frozen=True)
class Stroke:
    """A line in one of the styles of `STYLES`."""

    points: tuple[Point, ...]
    style: str


@dataclass(frozen=True)
class Sign:
    """A small sign: a `dot`, a `cross`, a `ring`, or the `arrow` that points in a direction."""

    kind: str
    place: Point
    direction: Point = (1.0, 0.0)


@dataclass(frozen=True)
class Style:
    """The style of a line: its width, its colour (ink, text or `pale`), and its dashes."""

    width: float
    colour: str
    dashes: tuple[float, float] | None = None


STYLES = {
    "axis": Style(0.5, "text"),
    "tick": Style(0.4, "text"),
    "zero": Style(0.3, "pale"),
    "boundary": Style(1.0, "ink"),
    "divider": Style(0.4, "text", (2.5, 1.8)),
    "piece": Style(2.6, "ink"),
    "path": Style(0.9, "ink"),
    "estimate": Style(0.9, "ink", (3.0, 2.0)),
}
RADIUS = {"dot": 1.6, "cross": 2.2, "ring": 2.3}
ARROW = 5.0


@dataclass(frozen=True)
class Scene:
    """A plot on paper; `numbered` are the equations of curves labelled by numbers."""

    frame: Rectangle
    whole: Rectangle
    shades: tuple[tuple[Point, ...], ...]
    strokes: tuple[Stroke, ...]
    signs: tuple[Sign, ...]
    texts: tuple[TextLabel, ...]
    numbered: tuple[Formula | Relation, ...] = ()


def coordinate(value: float) -> str:
    """Return a length with the significant digits."""
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def arrow_head(sign: Sign) -> tuple[Point, Point, Point]:
    """Return the corners of an arrow's head, its tip first."""
    (x, y), (dx, dy) = sign.place, sign.direction
    length = hypot(dx, dy)
    ux, uy = dx / length * ARROW, dy / length * ARROW
    return (x, y), (x - ux - 0.38 * uy, y - uy + 0.38 * ux), (x - ux + 0.38 * uy, y - uy - 0.38 * ux)


def whole_of(strokes: Iterable[Stroke], texts: Iterable[TextLabel], measure: Measure, margin: float = 3.0) -> Rectangle:
    """Return the bounding rectangle."""
    corners = [point for stroke in strokes for point in stroke.points]
    for text in texts:
        box = text.box(measure(text.content))
        corners += [(box.left, box.bottom), (box.right, box.top)]
    xs, ys = zip(*corners, strict=True)
    return Rectangle(min(xs), min(ys), max(xs), max(ys)).grown(margin)


# -- clipping ---------------------------------------------------------------------------------------------------------


def clipped(points: Sequence[Point], frame: Rectangle) -> Iterator[tuple[Point, ...]]:
    """Yield the parts of a line that lie in a rectangle."""
    run: list[Point] = []
    for a, b in pairwise(points):
        inside = segment_in(a, b, frame)
        if inside is None:
            if len(run) > 1:
                yield tuple(run)
            run = []
            continue
        if run and run[-1] != inside[0]:
            yield tuple(run)
            run = []
        run = run or [inside[0]]
        run.append(inside[1])
        if inside[1] != b:
            yield tuple(run)
            run = []
    if len(run) > 1:
        yield tuple(run)


def chained(lines: Sequence[tuple[Point, ...]], near: float = 0.2) -> list[tuple[Point, ...]]:
    """Return the lines, consecutive ones joined."""
    left = [line for line in lines if len(line) > 1]
    joined: list[tuple[Point, ...]] = []
    while left:
        line = left.pop()
        while (found := _next(line, left, near)) is not None:
            index, line = found
            left.pop(index)
        joined.append(line)
    return joined


def _next(
    line: tuple[Point, ...], others: Sequence[tuple[Point, ...]], near: float
) -> tuple[int, tuple[Point, ...]] | None:
    """Return the line that continues this one, and both joined."""
    for index, other in enumerate(others):
        for first, second in ((line, other), (other, line), (line, other[::-1]), (other[::-1], line)):
            if hypot(first[-1][0] - second[0][0], first[-1][1] - second[0][1]) <= near:
                return index, (*first, *second)
    return None


def segment_in(a: Point, b: Point, box: Rectangle) -> tuple[Point, Point] | None:
    """Return the part of a segment in a rectangle, None if there is none."""
    (x0, y0), (x1, y1), left, right, bottom, top = a, b, box.left, box.right, box.bottom, box.top
    if left <= x0 <= right and left <= x1 <= right and bottom <= y0 <= top and bottom <= y1 <= top:
        return a, b
    if (x0 < left and x1 < left) or (x0 > right and x1 > right) or (y0 < bottom and y1 < bottom) or (y0 > top < y1):
        return None
    start, stop = 0.0, 1.0
    dx, dy = b[0] - a[0], b[1] - a[1]
    sides = ((-dx, a[0] - box.left), (dx, box.right - a[0]), (-dy, a[1] - box.bottom), (dy, box.top - a[1]))
    for slope, room in sides:
        if slope == 0:
            if room < 0:
                return None
        elif slope < 0:
            start = max(start, room / slope)
        else:
            stop = min(stop, room / slope)
    if start > stop:
        return None
    first = a if start == 0 else (a[0] + start * dx, a[1] + start * dy)
    last = b if stop == 1 else (a[0] + stop * dx, a[1] + stop * dy)
    return first, last


def clipped_area(points: Sequence[Point], frame: Rectangle) -> tuple[Point, ...]:
    """Return the intersection of a polygon with a rectangle, counter-clockwise."""
    area = list(points)
    for axis, edge, sign in ((0, frame.left, 1), (0, frame.right, -1), (1, frame.bottom, 1), (1, frame.top, -1)):
        area = list(_cut(area, axis, edge, sign))
        if not area:
            return ()
    turn = sum(a[0] * b[1] - b[0] * a[1] for a, b in zip(area, [*area[1:], area[0]], strict=True))
    return tuple(area if turn >= 0 else reversed(area))


def _cut(area: Sequence[Point], axis: int, edge: float, sign: int) -> Iterator[Point]:
    """Yield the corners of the part on one side of a line parallel to an axis."""
    for a, b in zip(area, [*area[1:], *area[:1]], strict=True):
        before, after = sign * (a[axis] - edge), sign * (b[axis] - edge)
        if before >= 0:
            yield a
        if (before >= 0) != (after >= 0):
            part = before / (before - after)
            yield (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1]))


def thinned(points: Sequence[Point], tolerance: float = 0.04) -> tuple[Point, ...]:
    """Return a line through fewer of its points, visually equal (Douglas and Peucker)."""
    kept = {0, len(points) - 1}
    spans = [(0, len(points) - 1)]
    while spans:
        first, last = spans.pop()
        square, farthest = _farthest(points, first, last)
        if square > tolerance * tolerance:
            kept.add(farthest)
            spans += [(first, farthest), (farthest, last)]
    return tuple(points[index] for index in sorted(kept)) if points else ()


def _farthest(points: Sequence[Point], first: int, last: int) -> tuple[float, int]:
    """Return the squared largest distance from the chord between two points of a line, and its index."""
    (x0, y0), (x1, y1) = points[first], points[last]
    ux, uy = x1 - x0, y1 - y0
    length = ux * ux + uy * uy
    largest, farthest = 0.0, first
    for index in range(first + 1, last):
        dx, dy = points[index][0] - x0, points[index][1] - y0
        along = dx * ux + dy * uy
        if 0.0 < along < length:
            across = dx * uy - dy * ux
            square = across * across / length
        else:
            if along > 0.0:
                dx, dy = dx - ux, dy - uy
            square = dx * dx + dy * dy
        if square > largest:
            largest, farthest = square, index
    return largest, farthest
