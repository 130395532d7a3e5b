"""Placement of the equations of curves: beside the curve, inside the frame, without overlap."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from itertools import pairwise
from math import hypot
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from symobs.ground.dataclass import dataclass
from symobs.pages.drawings.clipping import segment_in
from symobs.pages.drawings.scene import Rectangle, TextLabel

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.formula.tree import Formula, Relation
    from symobs.pages.drawings.scene import Content, Measure, Point

#: Points between a curve and its label, around a label, from one trial to the next; beyond _FAR, distance is no gain.
_GAP, _CLEAR, _STEP, _FAR = 3.5, 2.0, 5.0, 30.0
#: Lines are looked at in pieces of so many segments, since most lie far from a label.
_SEGMENTS = 6
#: What it is worth, in points of distance, to stand outside the shaded areas, on no pale line, near a curve's middle.
_UNSHADED, _FREE, _MIDDLE = 6.0, 5.0, 4.0


#: What is written at a curve: its equation, or what it is the response of.
Name = TypeVar("Name", bound="Formula | Relation")
Lines: TypeAlias = "tuple[tuple[Point, ...], ...]"


@dataclass(frozen=True)
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
    for (x, y), from_middle in _trials(lines, width, height):
        highest = _FAR + _FAR / 3 - _MIDDLE * from_middle + _FREE + _UNSHADED
        left, bottom = x - width / 2, y - height / 2
        right, top = left + width, bottom + height
        if highest <= worth or left < room.left or right > room.right or bottom < room.bottom or top > room.top:
            continue
        box = Rectangle(left, bottom, right, top)
        if any(box.meets(other) for other in taken) or _is_crossed(box.grown(_CLEAR), pieces):
            continue
        value = min([_FAR, *(_apart(box, other) for other in taken)]) / 3
        value -= _MIDDLE * from_middle
        value += _FREE * (not any(_crosses(line, box) for line in around.pale))
        value += _UNSHADED * (not any(contains(area, box.centre) for area in around.shades))
        value += _distance(box, others, worth - value)
        if value > worth:
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


def _distance(box: Rectangle, places: Iterable[Point], enough: float) -> float:
    """Return the distance of places from a box, up to _FAR, or any value below `enough`."""
    left, right, bottom, top = box.left, box.right, box.bottom, box.top
    nearest = _FAR
    for x, y in places:
        dx = left - x if x < left else x - right if x > right else 0.0
        if dx < nearest:
            dy = bottom - y if y < bottom else y - top if y > top else 0.0
            if dy < nearest:
                nearest = min(nearest, hypot(dx, dy))
                if nearest <= enough:
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
