"""Lines and polygons clipped to a rectangle, joined and thinned; the frame of a plot."""

from __future__ import annotations

from itertools import pairwise
from math import hypot
from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.pages.drawings.scene import Rectangle

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from fractions import Fraction

    from symobs.pages.drawings.scene import Point

#: Of equally distant points, as a circle has them, the first counts: rounding, which differs between machines, does not decide.
_FARTHER = 1 + 1e-9


@dataclass(frozen=True)
class Frame:
    """A window of the plane and its rectangle on paper."""

    horizontal: tuple[float, float]
    vertical: tuple[float, float]
    width: float
    height: float

    @property
    def box(self) -> Rectangle:
        """The rectangle."""
        return Rectangle(0.0, 0.0, self.width, self.height)

    def at(self, x: float | Fraction, y: float | Fraction) -> Point:
        """Return the point on paper of a place in the plane."""
        (left, right), (bottom, top) = self.horizontal, self.vertical
        return (float(x) - left) / (right - left) * self.width, (float(y) - bottom) / (top - bottom) * self.height

    def lines(self, places: Iterable[tuple[float | Fraction, float | Fraction]]) -> list[tuple[Point, ...]]:
        """Return the parts of a line in the plane inside the frame."""
        return [thinned(run) for run in clipped([self.at(x, y) for x, y in places], self.box)]

    def areas(self, places: Iterable[tuple[float | Fraction, float | Fraction]]) -> list[tuple[Point, ...]]:
        """Return the part of a polygon inside the frame."""
        area = clipped_area([self.at(x, y) for x, y in places], self.box)
        return [thinned((*area, area[0]))[:-1]] if area else []


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
        if square > largest * _FARTHER:
            largest, farthest = square, index
    return largest, farthest
