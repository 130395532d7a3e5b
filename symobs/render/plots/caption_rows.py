"""Captions inside plot files: running text broken into rows of words."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, TypeVar

from symobs.formula import Roots

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.formula import Formula, Relation
    from symobs.render.page.blocks import Inlines

Piece = TypeVar("Piece")

#: Points from the picture to the first row, and from row to row.
ABOVE, ROW = 9.0, 12.5
#: A row is at least as wide as this, however narrow the picture.
NARROWEST = 250.0


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


def rows_of(
    words: Sequence[list[Piece]], width: Callable[[Piece], float], space: float, room: float
) -> list[list[list[Piece]]]:
    """Return the words in rows of limited width."""
    rows: list[list[list[Piece]]] = []
    filled = 0.0
    for word in words:
        wide = sum(map(width, word))
        if rows and filled + space + wide <= room:
            rows[-1].append(word)
            filled += space + wide
        else:
            rows.append([word])
            filled = wide
    return rows


def spaced(row: Sequence[list[Piece]], space: Piece) -> list[Piece]:
    """Return the pieces of a row with a space between two words."""
    pieces = list(row[0])
    for _, word in pairwise(row):
        pieces += [space, *word]
    return pieces
