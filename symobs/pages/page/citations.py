"""What the sentences of a page refer to: the literature, numbered in the order of the page, and equations before them."""

from __future__ import annotations

import string
from typing import TYPE_CHECKING

from symobs.formula.phrases import PHRASES, RESTS_ON, THEOREMS
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.phrases.literature import bibliography, cited
from symobs.formula.tree import Relation
from symobs.pages.page.detail_level import at_detail
from symobs.pages.page.prose import NUMBER
from symobs.pages.page.side_by_side import is_beside, row_by_row

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.formula.phrases.languages import Language
    from symobs.proof.derivation import Sentence, Step
    from symobs.tasks.result import Document


def cited_literature(steps: Iterable[Step], language: Language = ENGLISH) -> tuple[tuple[str, ...], dict[str, str]]:
    """Return the works cited, in the order of the page, and how each theorem is cited by their numbers."""
    works: dict[str, int] = {}
    citations: dict[str, str] = {}
    for theorem in dict.fromkeys(RESTS_ON[said.key] for said in _sentences(steps) if said.key in RESTS_ON):
        places = [
            f"{works.setdefault(key, len(works) + 1)}{', ' * bool(place)}{language.place(place)}"
            for key, place in cited(THEOREMS[theorem])
        ]
        citations[theorem] = f"[{'; '.join(places)}]"
    return tuple(works), citations


def referred_to(steps: Iterable[Step]) -> Iterator[Relation]:
    """Yield the equations to which sentences refer by a number."""
    for said in _sentences(steps):
        slots = dict(said.slots)
        for _, name, form, _ in string.Formatter().parse(PHRASES[said.key]):
            if form == NUMBER and isinstance(slot := slots[str(name)], Relation):
                yield slot


def bibliography_of(document: Document) -> str:
    """Return the works that a page cites, as a BibTeX file."""
    steps = (step for derivation in document.derivations for step in at_detail(derivation.steps, document.detail))
    return bibliography(cited_literature(steps)[0])


def _sentences(steps: Iterable[Step]) -> Iterator[Sentence]:
    for step in steps:
        found = getattr(step, "sentence", None)
        if found is not None:
            yield found
        yield from getattr(step, "findings", ())
        yield from _sentences(row_by_row(step) if is_beside(step) else getattr(step, "steps", ()))
