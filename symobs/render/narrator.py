"""The narrator: from the steps of checked derivations to the blocks of a page.

Every sentence comes from `phrases`; the narrator only decides what follows what: a sentence before its display,
displays without a sentence between them on one line, what is given said once, sections numbered through the page.
"""

from __future__ import annotations

import string
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

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
    from collections.abc import Mapping, Sequence

    from symobs.derivation import Sentence, Step
    from symobs.formula import Formula, Relation
    from symobs.method import Document
    from symobs.render.printer import Printer

P = TypeVar("P", bound="Printer[Any]")

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
        page.tell(derivation.steps)
    return _punctuated(page.blocks)


def printer_for(document: Document, kind: type[P]) -> P:
    """Return a printer of some format for a document's mathematics: its variable, its symbols, its kind of time."""
    if not document.derivations:
        return kind()
    first = document.derivations[0]
    symbols = {name: form for derivation in document.derivations for name, form in derivation.symbols.items()}
    return kind(first.variable, symbols, discrete=first.discrete)


class _Page:
    """The blocks written so far, and what the next ones depend on."""

    def __init__(self, *, given: Mapping[Formula, Relation] | None = None, numbered: bool = True) -> None:
        self.blocks: list[Block] = []
        self.given = dict(given or {})
        self.stated: set[Sentence] = set()
        self.numbers = [0]
        self.numbered = numbered

    def tell(self, steps: Sequence[Step]) -> None:
        """Tell a derivation: what is given first."""
        statement, rest = _statement(steps)
        self.tell_given(statement)
        for step in rest:
            self.tell_step(step)

    def tell_given(self, statement: Sequence[Given | Note]) -> None:
        """Show what is given and not on the page already, then the sentences about it."""
        relations = [relation for step in statement if isinstance(step, Given) for relation in step.relations]
        news = tuple(relation for relation in relations if self.given.get(relation.members[0]) != relation)
        sentences = [step.sentence for step in statement if step.sentence and step.sentence not in self.stated]
        self.given.update((relation.members[0], relation) for relation in news)
        self.stated.update(sentences)
        if news or sentences:
            self.blocks.append(Heading("", (PHRASES["given"],)))
            self.show(news)
            for sentence in sentences:
                self.say(sentence)

    def tell_step(self, step: Step) -> None:  # noqa: C901 - one case a kind of step
        match step:
            case Given(relations=relations, sentence=sentence, silent=silent):
                self.say(sentence)
                self.show(() if silent or sentence else relations)
            case Define(relation=relation, sentence=sentence, answer=answer, silent=silent):
                self.say(sentence)
                self.show(() if silent else (relation,), boxed=answer)
            case Equal(relations=relations, sentence=sentence, answer=answer):
                self.say(sentence)
                self.show(relations, boxed=answer)
            case Solve(equation=equation, solution=solution, sentence=sentence):
                self.say(sentence)
                self.show((equation, solution))
            case Conclude(sentence=sentence, verified=True):
                self.blocks.append(Verified(_filled(sentence)))
            case Note(sentence=sentence, caution=True):
                self.blocks.append(Caution(LABELS["caution"], _filled(sentence)))
            case Conclude(sentence=sentence) | Note(sentence=sentence):
                self.say(sentence)
            case Diagram(name=name, labels=labels):
                self.blocks.append(Drawing(name, labels))
            case Case(when=when, steps=steps, sentence=sentence):
                self.tell_case(when, steps, sentence)
            case Section(title=title, steps=steps):
                self.tell_section(title, steps)

    def tell_section(self, title: Sentence, steps: Sequence[Step]) -> None:
        self.numbers[-1] += 1
        number = ".".join(str(part) for part in self.numbers) + "." if self.numbered else ""
        self.blocks.append(Heading(number, _filled(title)))
        self.numbers.append(0)
        for step in steps:
            self.tell_step(step)
        self.numbers.pop()

    def tell_case(self, when: Relation, steps: Sequence[Step], sentence: Sentence | None) -> None:
        """Tell the steps of a case on a page of their own: what is given there is given nowhere else."""
        inner = _Page(given=self.given, numbered=False)
        inner.say(sentence)
        inner.tell(steps)
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


def _statement(steps: Sequence[Step]) -> tuple[list[Given | Note], list[Step]]:
    """Split off the data shown and the remarks that directly follow them; a condition assumed keeps its place."""
    statement: list[Given | Note] = []
    rest: list[Step] = []
    for before, step in zip([None, *steps], steps, strict=False):
        is_datum = isinstance(step, Given) and not step.silent and not _is_condition(step)
        is_remark_on_it = isinstance(step, Note) and not step.caution and statement[-1:] == [before]
        if isinstance(step, Given | Note) and (is_datum or is_remark_on_it):
            statement.append(step)
        else:
            rest.append(step)
    return statement, rest


def _is_condition(step: Given) -> bool:
    return all(relation.operators[0] == "!=" for relation in step.relations)


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
