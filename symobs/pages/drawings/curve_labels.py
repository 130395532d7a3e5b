"""Placement of the equations of curves: beside the curve, inside the frame, without overlap."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from math import hypot
from operator import itemgetter
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from symobs.ground.dataclass import dataclass
from symobs.pages.drawings.scene import Rectangle, TextLabel

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence
    from fractions import Fraction

    from symobs.formula.tree import Formula, Relation
    from symobs.pages.drawings.scene import Content, Measure, Point


# Lines and polygons clipped to a rectangle, joined and thinned; the frame of a plot.


#: Of equally distant points, as a circle has them, the first counts: rounding, which differs between machines, does not decide.
_FARTHER = 1 + 1e-9


@dataclass
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


#: Points between a curve and its label, around a label, from one trial to the next; beyond _FAR, distance is no gain.
_GAP, _CLEAR, _STEP, _FAR = 3.5, 2.0, 5.0, 30.0
#: Lines are looked at in pieces of so many segments, since most lie far from a label.
_SEGMENTS = 6
#: What it is worth, in points of distance, to stand outside the shaded areas, on no pale line, near a curve's middle.
_UNSHADED, _FREE, _MIDDLE = 6.0, 5.0, 4.0
#: What is written at a curve: its equation, or what it is the response of.
Name = TypeVar("Name", bound="Formula | Relation")
Lines: TypeAlias = "tuple[tuple[Point, ...], ...]"


@dataclass
class Surroundings:
    """Constraints of a label: frame, lines not to cross, occupied boxes, and lines and areas to avoid."""

    frame: Rectangle
    lines: Lines
    taken: tuple[Rectangle, ...]
    pale: Lines
    shades: Lines


def labelled(
    curves: Mapping[Name, Lines], around: Surroundings, measure: Measure
) -> tuple[list[TextLabel], list[Name]]:
    """Return the equations placed beside their curves, and those without a place, labelled by numbers.

    The longest is placed first, and numbers last.  A number may stand over a sample if need be, or over anything.
    """
    written: list[TextLabel] = []
    left: list[Name] = []
    for equation in sorted(curves, key=lambda equation: -measure(equation)[0]):
        text = _best(equation, curves[equation], _beside(around, written, measure), measure)
        if text is None:
            left.append(equation)
        else:
            written.append(text)
    numbered = [equation for equation in curves if equation in left]
    for place, equation in enumerate(numbered, 1):
        strict = _beside(around, written, measure)
        rooms = (strict, replace(strict, taken=()), replace(strict, taken=(), lines=()))
        found = (_best(f"({place})", curves[equation], room, measure) for room in rooms)
        written += [text for text in (next((text for text in found if text is not None), None),) if text is not None]
    return written, numbered


def _beside(around: Surroundings, written: Sequence[TextLabel], measure: Measure) -> Surroundings:
    """Return the constraints with some texts placed."""
    boxes = (text.box(measure(text.content)).grown(_CLEAR) for text in written)
    return replace(around, taken=(*around.taken, *boxes))


def _best(content: Content, lines: Lines, around: Surroundings, measure: Measure) -> TextLabel | None:
    """Return a label at the place farthest from everything else."""
    (width, height), taken = measure(content), around.taken
    own = set(lines)
    others = [place for line in around.lines if line not in own for place in _places(line)]
    pieces = [piece for line in around.lines for piece in _pieces(line)]
    room = around.frame.grown(-_CLEAR)
    best, worth = None, float("-inf")
    for (x, y), from_middle in sorted(_trials(lines, width, height), key=itemgetter(1)):
        if _FAR + _FAR / 3 - _MIDDLE * from_middle + _FREE + _UNSHADED <= worth:
            break  # no farther one is worth more
        left, bottom = x - width / 2, y - height / 2
        right, top = left + width, bottom + height
        if left < room.left or right > room.right or bottom < room.bottom or top > room.top:
            continue
        box = Rectangle(left, bottom, right, top)
        if any(box.meets(other) for other in taken) or (best is None and _is_crossed(box.grown(_CLEAR), pieces)):
            continue
        value = min([_FAR, *(_apart(box, other) for other in taken)]) / 3
        value -= _MIDDLE * from_middle
        value += _FREE * (not any(_crosses(line, box) for line in around.pale))
        value += _UNSHADED * (not any(contains(area, box.centre) for area in around.shades))
        value += _distance(box, others, worth - value)
        if value > worth and (best is None or not _is_crossed(box.grown(_CLEAR), pieces)):
            best, worth = (x, y), value
    return None if best is None else TextLabel(content, best)


def _trials(lines: Lines, width: float, height: float) -> Iterator[tuple[Point, float]]:
    """Yield centres of labels on both sides of lines, with their distance from the middle of the line (0 to 1)."""
    for line in lines:
        length = sum(hypot(b[0] - a[0], b[1] - a[1]) for a, b in pairwise(line))
        for (x, y), (dx, dy), along in walk(line, _STEP):
            away = _GAP + abs(dy) * width / 2 + abs(dx) * height / 2
            from_middle = abs(2 * along / length - 1)
            yield (x - dy * away, y + dx * away), from_middle
            yield (x + dy * away, y - dx * away), from_middle


def walk(line: Sequence[Point], step: float) -> Iterator[tuple[Point, Point, float]]:
    """Yield equidistant places along a line, with direction and arc length."""
    gone, due = 0.0, step / 2
    for a, b in pairwise(line):
        length = hypot(b[0] - a[0], b[1] - a[1])
        while length and due <= gone + length:
            part = (due - gone) / length
            direction = (b[0] - a[0]) / length, (b[1] - a[1]) / length
            yield (a[0] + part * (b[0] - a[0]), a[1] + part * (b[1] - a[1])), direction, due
            due += step
        gone += length


@lru_cache(maxsize=64)
def _pieces(line: Sequence[Point]) -> tuple[tuple[float, float, float, float, Sequence[Point]], ...]:
    """Return a line in pieces of some segments, each after its bounding box (left, bottom, right, top)."""
    found = []
    for first in range(0, len(line) - 1, _SEGMENTS):
        points = line[first : first + _SEGMENTS + 1]
        xs, ys = zip(*points, strict=True)
        found.append((min(xs), min(ys), max(xs), max(ys), points))
    return tuple(found)


def _is_crossed(box: Rectangle, pieces: Sequence[tuple[float, float, float, float, Sequence[Point]]]) -> bool:
    """Return whether one of the pieces intersects a box."""
    left, bottom, right, top = box.left, box.bottom, box.right, box.top
    for piece_left, piece_bottom, piece_right, piece_top, points in pieces:
        is_aside = piece_left > right or left > piece_right or piece_bottom > top or bottom > piece_top
        if not is_aside and _crosses(points, box):
            return True
    return False


def _crosses(line: Sequence[Point], box: Rectangle) -> bool:
    """Return whether a line intersects a box."""
    return any(segment_in(a, b, box) is not None for a, b in pairwise(line))


@lru_cache(maxsize=64)
def _places(line: Sequence[Point]) -> list[Point]:
    """Return the places along a line used for distances."""
    return [point for point, _, _ in walk(line, _STEP)] or list(line)


def _distance(box: Rectangle, places: list[Point], enough: float) -> float:
    """Return the distance of places from a box, up to _FAR, or any value below `enough`.

    A place that is so near is put first: it is near to the next box, too.
    """
    left, right, bottom, top = box.left, box.right, box.bottom, box.top
    nearest = _FAR
    for index, (x, y) in enumerate(places):
        dx = left - x if x < left else x - right if x > right else 0.0
        if dx < nearest:
            dy = bottom - y if y < bottom else y - top if y > top else 0.0
            if dy < nearest:
                nearest = min(nearest, hypot(dx, dy))
                if nearest <= enough:
                    places.insert(0, places.pop(index))
                    break
    return nearest


def _apart(box: Rectangle, other: Rectangle) -> float:
    return hypot(
        max(box.left - other.right, 0.0, other.left - box.right),
        max(box.bottom - other.top, 0.0, other.bottom - box.top),
    )


def contains(area: Sequence[Point], place: Point) -> bool:
    """Return whether a place lies in a polygon."""
    x, y = place
    crossings = 0
    for (x0, y0), (x1, y1) in zip(area, [*area[1:], *area[:1]], strict=True):
        if (y0 <= y) != (y1 <= y) and x0 + (x1 - x0) * (y - y0) / (y1 - y0) < x:
            crossings += 1
    return crossings % 2 == 1
