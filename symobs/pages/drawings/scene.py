"""Scenes: plots and block diagrams laid out, for the writers of TikZ, SVG, text and matplotlib.

A plot is in points, its origin the lower left corner of the frame, and y grows upwards.  A diagram is in the unit of its
format (em, points, or columns and lines of a terminal), its origin the upper left corner, and y grows downwards.
Everything is clipped already, and every text has its place: a format only writes down.
"""

from __future__ import annotations

from itertools import pairwise
from math import hypot
from typing import TYPE_CHECKING, TypeAlias, TypeVar

from symobs.formula.convention import STANDARD
from symobs.formula.tree import Conjunction, Formula, Relation, Roots
from symobs.ground.dataclass import dataclass
from symobs.pages.page.plot_captions import caption, caption_sentence
from symobs.pages.page.prose import filled, joined

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from symobs.formula.figures import Drawn
    from symobs.formula.phrases.languages import Language
    from symobs.pages.page.blocks import Inline, Inlines


#: What is written: mathematics, in several lines for a system of equations, or a text such as a number of a tick.
Content: TypeAlias = Formula | Relation | Conjunction | str
Point: TypeAlias = tuple[float, float]
#: How wide and how high a format writes something, in points.
Measure: TypeAlias = "Callable[[Content], tuple[float, float]]"
FONT_SIZE = 9.0


@dataclass
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


@dataclass
class TextLabel:
    """A label with the `anchor` of its box (center, north, south, east or west) at `place`; or `above`, or to its `right`."""

    content: Content
    place: Point
    anchor: str = "center"

    def box(self, size: tuple[float, float]) -> Rectangle:
        """Return the rectangle of the label."""
        (x, y), (width, height) = self.place, size
        left = {"west": x, "east": x - width}.get(self.anchor, x - width / 2)
        bottom = {"south": y, "north": y - height}.get(self.anchor, y - height / 2)
        return Rectangle(left, bottom, left + width, bottom + height)


@dataclass
class Stroke:
    """A line in one of the styles of `STYLES`."""

    points: tuple[Point, ...]
    style: str


@dataclass
class Box:
    """A box of a diagram with its label in the middle."""

    centre: Point
    size: Point
    content: Content


@dataclass
class Sign:
    """A small sign: a `dot`, a `cross`, a `ring`, or the `arrow` that points in a direction.

    In a diagram a `junction`, a `branch`, and the `+` or `-` of a wire that arrives at a junction in a direction.
    """

    kind: str
    place: Point
    direction: Point = (1.0, 0.0)


@dataclass
class Style:
    """The style of a line: its width, its colour (ink, text or `pale`), its dashes, and the head of an arrow."""

    width: float
    colour: str
    dashes: tuple[float, ...] | None = None
    has_head: bool = False


STYLES = {
    "axis": Style(0.5, "text", has_head=True),
    "wire": Style(0.9, "text"),
    "arrow": Style(0.9, "text", has_head=True),
    "tick": Style(0.4, "text"),
    "zero": Style(0.3, "pale"),
    "boundary": Style(1.0, "ink"),
    "divider": Style(0.4, "text", (2.5, 1.8)),
    "piece": Style(2.6, "ink"),
    "path": Style(0.9, "ink"),
    "path 2": Style(0.9, "ink", (5.0, 2.0)),
    "path 3": Style(0.9, "ink", (1.2, 1.6)),
    "path 4": Style(0.9, "ink", (5.0, 2.0, 1.2, 2.0)),
    "estimate": Style(0.9, "ink", (3.0, 2.0)),
    "state 2": Style(0.6, "text"),
    "estimate 2": Style(0.6, "text", (3.0, 2.0)),
    "state 3": Style(1.6, "ink"),
    "estimate 3": Style(1.6, "ink", (3.0, 2.0)),
}


RADIUS = {"dot": 1.6, "cross": 2.2, "ring": 2.3}
ARROW = 5.0


@dataclass
class Scene:
    """A plot in its frame, or a block diagram; `numbered` are the equations of curves labelled by numbers."""

    frame: Rectangle
    whole: Rectangle
    shades: tuple[tuple[Point, ...], ...] = ()
    strokes: tuple[Stroke, ...] = ()
    boxes: tuple[Box, ...] = ()
    signs: tuple[Sign, ...] = ()
    texts: tuple[TextLabel, ...] = ()
    numbered: tuple[Formula | Relation, ...] = ()
    is_diagram: bool = False


def coordinate(value: float) -> str:
    """Return a length with the significant digits."""
    return f"{round(value, 2) + 0.0:.2f}".rstrip("0").rstrip(".")


def arrow_head(tip: Point, direction: Point, long: float = ARROW) -> tuple[Point, Point, Point]:
    """Return the corners of an arrow's head, its tip first."""
    (x, y), (dx, dy) = tip, direction
    length = hypot(dx, dy)
    ux, uy = dx / length * long, dy / length * long
    return (x, y), (x - ux - 0.38 * uy, y - uy + 0.38 * ux), (x - ux + 0.38 * uy, y - uy - 0.38 * ux)


def head_of(stroke: Stroke, long: float = ARROW) -> tuple[Point, Point, Point]:
    """Return the corners of the head at the end of a line."""
    (x0, y0), (x1, y1) = stroke.points[-2:]
    return arrow_head((x1, y1), (x1 - x0, y1 - y0), long)


def whole_of(strokes: Iterable[Stroke], texts: Iterable[TextLabel], measure: Measure, margin: float = 3.0) -> Rectangle:
    """Return the bounding rectangle."""
    corners = [point for stroke in strokes for point in stroke.points]
    for text in texts:
        box = text.box(measure(text.content))
        corners += [(box.left, box.bottom), (box.right, box.top)]
    xs, ys = zip(*corners, strict=True)
    return Rectangle(min(xs), min(ys), max(xs), max(ys)).grown(margin)


# Captions of plots: the equations of numbered curves, and running text broken into rows of words in plot files.


Piece = TypeVar("Piece")
#: Points from the picture to the first row, and from row to row.
ABOVE, ROW = 9.0, 12.5
#: A row is at least as wide as this, however narrow the picture.
NARROWEST = 250.0


def numbered(equations: Sequence[Formula | Relation], language: Language) -> Inlines:
    """Return the list of the equations of curves labelled by numbers."""
    if len(equations) == 1:
        return filled(caption_sentence("curve", curve=equations[0]), STANDARD, language)
    words: list[Inline] = [language.phrases["picture_curves"]]
    for place, equation in enumerate(equations, 1):
        words += [f"{',' if place > 1 else ''} ({place}) ", equation]
    return joined((*words, "."))


def below(words: Inlines, scene: Scene, language: Language) -> Inlines:
    """Return a caption with the equations of numbered curves added."""
    return joined((*words, " ", *numbered(scene.numbered, language))) if scene.numbered else words


def caption_below(
    picture: Drawn,
    scene: Scene,
    language: Language,
    plain: Callable[[str], Piece],
    mathematics: Callable[[Formula | Relation], list[Piece]],
    width: Callable[[Piece], float],
    space: float,
) -> tuple[Rectangle, list[tuple[Point, list[list[Piece]]]]]:
    """Return the rectangle of a plot with its caption, and the rows of the caption, in words, with their places."""
    box = scene.whole
    words = words_of(below(caption(picture, language), scene, language), plain, mathematics)
    rows: list[list[list[Piece]]] = []
    taken = widest = 0.0
    for word in words:
        wide = sum(map(width, word))
        if rows and taken + space + wide <= max(box.right - box.left, NARROWEST):
            rows[-1].append(word)
            taken += space + wide
        else:
            rows.append([word])
            taken = wide
        widest = max(widest, taken)
    whole = Rectangle(box.left, box.bottom - ABOVE - ROW * len(rows), max(box.right, box.left + 6 + widest), box.top)
    return whole, [((box.left + 3, box.bottom - ABOVE - ROW * (k + 0.5)), row) for k, row in enumerate(rows)]


def words_of(
    inlines: Inlines, plain: Callable[[str], Piece], mathematics: Callable[[Formula | Relation], list[Piece]]
) -> list[list[Piece]]:
    """Return running text as words of inseparable pieces; long mathematics is several words."""
    words: list[list[Piece]] = [[]]
    for inline in inlines:
        if isinstance(inline, Roots):
            raise TypeError(inline)
        pieces: Sequence[Piece | None]
        if isinstance(inline, str):
            pieces = [plain(part) if part else None for part in inline.split(" ")]
        else:
            pieces = mathematics(inline)
        for place, piece in enumerate(pieces):
            words += [[]] if place else []
            words[-1] += [] if piece is None else [piece]
    return [word for word in words if word]


def spaced(row: Sequence[list[Piece]], space: Piece) -> list[Piece]:
    """Return the pieces of a row with a space between two words."""
    pieces = list(row[0])
    for _, word in pairwise(row):
        pieces += [space, *word]
    return pieces
