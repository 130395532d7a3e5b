"""Points and room for answers, added to the parts of a question on a sheet."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.pages.page.blocks import AnswerSpace, Paragraph
from symobs.pages.page.prose import joined

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.pages.page.blocks import Block

    #: Points in words, empty where nothing is said of them, and the room for an answer, if there is one.
    Part = tuple[str, AnswerSpace | None]


def handed_out(blocks: Sequence[Block], parts: Sequence[Part]) -> tuple[Block, ...]:
    """Return a question with points and room for each of its parts, its last paragraphs."""
    paragraphs = [place for place, block in enumerate(blocks) if isinstance(block, Paragraph)]
    added = dict(zip(paragraphs[-len(parts) :], parts, strict=True)) if parts else {}
    written: list[Block] = []
    for place, block in enumerate(blocks):
        points, space = added.get(place, ("", None))
        if points and isinstance(block, Paragraph):
            written.append(Paragraph(joined((*block.inlines, f" ({points})".replace(" ", "\N{NO-BREAK SPACE}")))))
        else:
            written.append(block)
        if space is not None:
            written.append(space)
    return tuple(written)
