"""The narrator: from the steps of checked derivations to the blocks of a page.

Every sentence comes from `phrases`; the narrator only decides what follows what: a sentence before its display,
displays without a sentence between them on one line, what is given said once, sections numbered through the page.
"""

from __future__ import annotations

import string
from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.derivation import Case, Conclude, Define, Diagram, Equal, Given, Note, Section, Solve
from symobs.formula import Predicate
from symobs.phrases import PHRASES
from symobs.render.blocks import (
    Block,
    CaseBlock,
    Caution,
    Display,
    Drawing,
    Heading,
    Inline,
    Inlines,
    Paragraph,
    Title,
    Verified,
)
from symobs.render.conventions import letters_used, stated_conventions

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.derivation import Sentence, Step
    from symobs.formula import Formula, Relation
    from symobs.method import Document

#: The few words of a page that belong to no step.
LABELS: dict[str, str] = {
    "conventions": "Conventions:",
    "observer_matrix": "observer matrix",
    "error": "error",
    "case": "Case",
    "caution": "A caution.",
}


def narrate(document: Document) -> tuple[Block, ...]:
    """Return the blocks of a document; a derivation with a false line raises before a word is written."""
    for derivation in document.derivations:
        derivation.check()
    page = _Page()
    page.blocks.append(_title(document))
    for derivation in document.derivations:
        page.tell(_given_first(derivation.steps))
    return _punctuated(page.blocks)


class _Page:
    """The blocks written so far, and what the next ones depend on."""

    def __init__(self, given: dict[Formula, Relation] | None = None, *, numbered: bool = True) -> None:
        self.blocks: list[Block] = []
        self.given = given or {}
        self.numbers = [0]
        self.numbered = numbered

    def tell(self, steps: Sequence[Step]) -> None:
        for step in steps:
            self.tell_step(step)

    def tell_step(self, step: Step) -> None:
        match step:
            case Given(relations, sentence):
                self.tell_given(relations, sentence)
            case Define(relation, sentence, answer):
                self.say(sentence)
                self.show((relation,), boxed=answer)
            case Equal(relations, sentence, answer):
                self.say(sentence)
                self.show(relations, boxed=answer)
            case Solve(equation, solution, sentence):
                self.say(sentence)
                self.show((equation, solution))
            case Conclude(sentence, _, verified) if verified:
                self.blocks.append(Verified(_filled(sentence)))
            case Note(sentence, _, caution) if caution:
                self.blocks.append(Caution(LABELS["caution"], _filled(sentence)))
            case Conclude(sentence) | Note(sentence):
                self.say(sentence)
            case Diagram(name, labels):
                self.blocks.append(Drawing(name, labels))
            case Case(when, steps, sentence):
                self.tell_case(when, steps, sentence)
            case Section(title, steps):
                self.tell_section(title, steps)

    def tell_given(self, relations: tuple[Relation, ...], sentence: Sentence | None) -> None:
        """Show what is given and not on the page already; the sentence ends it, as in a problem's statement."""
        news = tuple(relation for relation in relations if self.given.get(relation.members[0]) != relation)
        self.given.update((relation.members[0], relation) for relation in news)
        if not news and not sentence:
            return
        self.blocks.append(Heading("", (PHRASES["given"],)))
        self.show(news)
        self.say(sentence)

    def tell_section(self, title: Sentence, steps: tuple[Step, ...]) -> None:
        self.numbers[-1] += 1
        number = ".".join(str(part) for part in self.numbers) + "." if self.numbered else ""
        self.blocks.append(Heading(number, _filled(title)))
        self.numbers.append(0)
        self.tell(steps)
        self.numbers.pop()

    def tell_case(self, when: Relation, steps: tuple[Step, ...], sentence: Sentence | None) -> None:
        """Tell the steps of a case on a page of their own: what is given there is given nowhere else."""
        inner = _Page(dict(self.given), numbered=False)
        inner.say(sentence)
        inner.tell(_given_first(steps))
        self.blocks.append(CaseBlock((f"{LABELS['case']} ", when, "."), _punctuated(inner.blocks)))

    def say(self, sentence: Sentence | None) -> None:
        """Add a sentence, to the paragraph before it where there is one."""
        if sentence is None:
            return
        inlines = _filled(sentence)
        if self.blocks and isinstance(last := self.blocks[-1], Paragraph):
            self.blocks[-1] = Paragraph(_joined((*last.inlines, " ", *inlines)))
        else:
            self.blocks.append(Paragraph(inlines))

    def show(self, relations: tuple[Relation, ...], *, boxed: bool = False) -> None:
        """Add a display, to the display before it where that one goes on; a box ends a display."""
        if not relations:
            return
        if self.blocks and isinstance(last := self.blocks[-1], Display) and not last.boxed:
            self.blocks[-1] = Display((*last.relations, *relations), boxed)
        else:
            self.blocks.append(Display(relations, boxed))


def _given_first(steps: Sequence[Step]) -> list[Step]:
    return sorted(steps, key=lambda step: not isinstance(step, Given))


def _title(document: Document) -> Title:
    steps = [step for derivation in document.derivations for step in derivation.steps]
    conventions = stated_conventions(letters_used(steps), LABELS)
    if not conventions:
        return Title(document.title, _as_sentence(document.source), ())
    listed: list[Inline] = [f"{LABELS['conventions']} "]
    for convention in conventions:
        listed += [*convention, ", "]
    return Title(document.title, _as_sentence(document.source), _joined((*listed[:-1], ".")))


def _as_sentence(text: str) -> str:
    text = text.strip()
    return f"{text}." if text and text[-1] not in ".!?" else text


def _filled(sentence: Sentence) -> Inlines:
    """Return the phrase of a sentence with its slots filled; of a predicate the phrase names the subject."""
    slots = dict(sentence.slots)
    inlines: list[Inline] = []
    for text, name, _, _ in string.Formatter().parse(PHRASES[sentence.key]):
        inlines.append(text)
        if name is not None:
            value = slots[name]
            inlines.append(value.subject if isinstance(value, Predicate) else value)
    return _joined(inlines)


def _joined(inlines: Sequence[Inline]) -> Inlines:
    """Return the same inlines, neighbouring texts made one and empty ones left out."""
    joined: list[Inline] = []
    for inline in inlines:
        if isinstance(inline, str) and joined and isinstance(before := joined[-1], str):
            joined[-1] = before + inline
        elif inline != "":
            joined.append(inline)
    return tuple(joined)


def _punctuated(blocks: Sequence[Block]) -> tuple[Block, ...]:
    """Return the blocks with a mark after every display that is not an answer's box.

    A comma where the sentence goes on in small letters after it, else a full stop.
    """
    punctuated: list[Block] = []
    for block, following in zip(blocks, [*blocks[1:], None], strict=True):
        if isinstance(block, Display) and not block.boxed:
            goes_on = isinstance(following, Paragraph) and _starts_small(following.inlines)
            punctuated.append(replace(block, closing="," if goes_on else "."))
        else:
            punctuated.append(block)
    return tuple(punctuated)


def _starts_small(inlines: Inlines) -> bool:
    return bool(inlines) and isinstance(inlines[0], str) and inlines[0][:1].islower()
