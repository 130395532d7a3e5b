"""Captions of plots with numbered curves."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.phrases import PHRASES
from symobs.render.page.plot_captions import caption_sentence
from symobs.render.page.prose import filled, joined

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula import Formula, Relation
    from symobs.render.page.blocks import Inline, Inlines
    from symobs.render.plots.scene import Scene


def numbered(equations: Sequence[Formula | Relation]) -> Inlines:
    """Return the list of the equations of curves labelled by numbers."""
    if len(equations) == 1:
        return filled(caption_sentence("curve", curve=equations[0]))
    words: list[Inline] = [PHRASES["picture_curves"]]
    for place, equation in enumerate(equations, 1):
        words += [f"{',' if place > 1 else ''} ({place}) ", equation]
    return joined((*words, "."))


def below(words: Inlines, scene: Scene) -> Inlines:
    """Return a caption with the equations of numbered curves added."""
    return joined((*words, " ", *numbered(scene.numbered))) if scene.numbered else words
