"""Captions of plots: the equations of numbered curves, and running text broken into rows of words in plot files."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, TypeVar

from symobs.formula.convention import STANDARD
from symobs.formula.tree import Roots
from symobs.pages.drawings.scene import Rectangle
from symobs.pages.page.plot_captions import caption, caption_sentence
from symobs.pages.page.prose import filled, joined

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.formula.figures.plot import Drawn
    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Formula, Relation
    from symobs.pages.drawings.scene import Point, Scene
    from symobs.pages.page.blocks import Inline, Inlines

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
