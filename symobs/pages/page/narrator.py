"""The narrator: from the steps of checked derivations to the blocks of a page.

Every sentence comes from `phrases`; the narrator only decides what follows what: a sentence before its display,
displays without a sentence between them on one line, what is given said once, sections numbered through the page.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import count, groupby, takewhile, zip_longest
from typing import TYPE_CHECKING, Any, TypeAlias, TypeVar

from symobs.formula.convention import OF_REDUCED_ORDER, STANDARD
from symobs.formula.phrases import BESIDE, CONTINUES, OPENS, RESTS_ON, ROWS, slots_of
from symobs.formula.phrases.languages import ENGLISH, language_named
from symobs.formula.tree import Conjunction, Evaluated, Letter, Literal, Roots, letters
from symobs.pages.page.blocks import (
    Block,
    CaseBlock,
    Caution,
    Columns,
    Display,
    Drawing,
    Heading,
    Inline,
    Inlines,
    Paragraph,
    PictureBlock,
    References,
    TableBlock,
    Title,
    Verified,
    in_rows,
    with_few_boxes,
)
from symobs.pages.page.convention_notes import letters_used, title_of
from symobs.pages.page.detail_level import FINAL, at_detail
from symobs.pages.page.prose import cited_literature, filled, joined, referred_to, shown, with_reference
from symobs.pages.page.roots_of_letters import of_derivation
from symobs.pages.page.sheet import handed_out
from symobs.proof.derivation import (
    CaseStep,
    Conclude,
    Define,
    Diagram,
    Equal,
    Given,
    Inequalities,
    Note,
    Plot,
    RegionSummary,
    Section,
    Sentence,
    Tabulate,
)
from symobs.tasks.result.output_methods import shown_digits

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.formula.convention import Convention
    from symobs.formula.notation import LetterForm
    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Formula, Relation
    from symobs.pages.printers.printer import Printer
    from symobs.proof.derivation import Step
    from symobs.stability.criteria.routh_table import RouthTable
    from symobs.tasks.result import Document


P = TypeVar("P", bound="Printer[Any]")

#: The conditions of a case, its fixed modes, and the answer there.
Row: TypeAlias = "tuple[tuple[Relation, ...], Inlines, Inlines]"
#: The sections of a question.
_UNNUMBERED = {"task", "tasks"}


def narrate(document: Document) -> tuple[Block, ...]:
    """Return the blocks of a document; raises `DerivationRejected` for a false line, before any output."""
    for derivation in document.derivations:
        derivation.check()
    parts = [at_detail(derivation.steps, document.detail) for derivation in document.derivations]
    if digits := shown_digits(document):
        from symobs.pages.decimals.steps import in_decimals  # noqa: PLC0415 - only pages in decimals pay for it

        parts = [in_decimals(*pair, digits) for pair in zip(document.derivations, parts, strict=True)]
    parts = [of_derivation(*pair) for pair in zip(parts, document.derivations, strict=True)]
    is_final = document.detail == FINAL
    language = language_named(document.language)
    is_cited = not is_final and document.references != "none"
    works, citations = cited_literature((step for steps in parts for step in steps) if is_cited else (), language)
    page = _PageBlocks(document.convention, language, citations=citations)
    page.has_decimals = bool(digits)
    page.referred = dict.fromkeys((each for steps in parts for each in referred_to(steps)), 0)
    page.blocks.append(title_of(document, language))
    page.blocks += [Paragraph((" ".join(part.split()),)) for part in document.text.split("\n\n") if part.strip()]
    together, apart = _statements(parts)
    page.emit_given(together)
    if is_final:  # the question has said what is given, and where it comes from
        page.blocks[:] = [replace(title_of(document, language), source="")]
    elif document.is_below and any(map(_derives, together)):  # what the question has not said
        page.blocks[0] = Title(document.title, "", ())
    elif document.is_below:
        page.blocks[:] = [Title(document.title, "", ())]
        page.emit_steps([each for step in together for each in _roundings(step)])
    for index, steps in enumerate(parts):
        page.time = document.derivations[index].variable, document.derivations[index].discrete
        if index in apart:
            page.printed.clear()
            page.emit_given(apart[index])
        start = len(page.blocks)
        told = [step for step in steps if not _is_statement(step)]
        page.emit_steps(told)
        is_silent = not any(isinstance(block, Heading) for block in page.blocks[start:])
        if is_silent and told and isinstance(told[-1], Section):
            page.emit_again(told[-1])
        page.printed |= _inside(steps)
    if works:
        short = document.references == "short"
        entries = tuple(f"{language.reference(key, short=short)}." for key in works)
        page.blocks.append(References(language.words["sources"], entries))
    return handed_out(_punctuated(page.blocks), document.handout)


def _statements(parts: Sequence[Sequence[Step]]) -> tuple[list[Step], dict[int, list[Step]]]:
    """Return the data stated at the top, and the statements from the first contradicting one on."""
    seen: dict[Formula, Relation] = {}
    together: list[Step] = []
    apart: dict[int, list[Step]] = {}
    for index, steps in enumerate(parts):
        statement = [step for step in steps if _is_statement(step)]
        relations = [relation for step in statement for relation in _given_relations(step)]
        if apart or any(seen.get(relation.members[0], relation) != relation for relation in relations):
            apart[index] = statement
        else:
            together += statement
            seen.update((relation.members[0], relation) for relation in relations)
    return together, apart


#: What a page derives before its first section, and a question does not show.
_DERIVED = {"lagrange", "equations_of_motion", "linearised"}


def _derives(step: Step) -> bool:
    """Return whether a statement of data goes on to what follows from them."""
    inner = step.steps if isinstance(step, Section) else (step,)
    return any(
        isinstance(each, Equal) and each.sentence is not None and each.sentence.key in _DERIVED for each in inner
    )


def _roundings(step: Step) -> Iterator[Step]:
    """Yield what a page of decimals says of its digits."""
    inner = step.steps if isinstance(step, Section) else (step,)
    yield from (each for each in inner if isinstance(each, Note) and each.sentence.key == "rounded_digits")


def _signs_at_once(steps: Sequence[Step]) -> list[Step]:
    """Return steps with the declared signs of all letters in the first sentence that says any."""
    declared = [
        step for step in steps if isinstance(step, Conclude) and step.sentence and step.sentence.key == "declared"
    ]
    slots = [slot for step in declared if step.sentence for _, slot in step.sentence.slots]
    signs = dict.fromkeys(fact for slot in slots if isinstance(slot, Conjunction) for fact in slot.relations)
    if len(declared) < 2 or not signs:
        return list(steps)
    joined = replace(declared[0], sentence=Sentence("declared", (("signs", Conjunction(tuple(signs))),)))
    return [joined if step is declared[0] else step for step in steps if step not in declared[1:]]


def _given_relations(step: Step) -> Iterator[Relation]:
    match step:
        case Given(relations=relations, silent=False):
            yield from relations
        case Section(steps=steps):
            for inner in steps:
                yield from _given_relations(inner)


def _inside(steps: Sequence[Step]) -> set[Step]:
    """Return the steps of the sections, which later derivations need not repeat."""
    printed = [inner for step in steps if isinstance(step, Section) for inner in step.steps]
    return {*printed, *map(_unboxed, printed)}


def _unboxed(step: Step) -> Step:
    return replace(step, answer=False) if isinstance(step, (Define, Equal, Inequalities)) else step


def printer_for(document: Document, kind: type[P]) -> P:
    """Return a printer for the mathematics of a document: variable, symbols, letters, time domain."""
    printer = kind()
    if document.derivations:
        first = document.derivations[0]
        symbols = {name: form for derivation in document.derivations for name, form in derivation.symbols.items()}
        printer = kind(first.variable, symbols, discrete=first.discrete)
        printer.letters = {**printer.letters, **_letters(document)}
    printer.language = language_named(document.language)
    return printer


def _letters(document: Document) -> Mapping[str, LetterForm]:
    """Return the forms of the letters that differ from the standard."""
    if document.convention.is_standard:
        return {}
    steps = [step for derivation in document.derivations for step in derivation.steps]
    used = letters_used(steps) | document.letters_asked
    return document.convention.forms(reduced=not used.isdisjoint(OF_REDUCED_ORDER))


class _PageBlocks:
    """The blocks emitted so far, and the state for the next ones."""

    def __init__(
        self,
        convention: Convention,
        language: Language = ENGLISH,
        *,
        given: Mapping[Formula, Relation] | None = None,
        citations: Mapping[str, str] | None = None,
        figures: Iterator[int] | None = None,
    ) -> None:
        self.convention = convention
        self.figures = count(1) if figures is None else figures
        self.language = language
        self.blocks: list[Block] = []
        self.citations = dict(citations or {})
        #: The equations to which sentences refer, with their numbers once they are displayed.
        self.referred: dict[Relation, int] = {}
        self.given = dict(given or {})
        self.stated: set[Sentence | Step] = set()
        self.printed: set[Step] = set()
        self.places: dict[Step, str] = {}  # the numbers of the sections in which steps are printed first
        self.numbers = [0]
        self.numbered = True
        self.time: tuple[str, bool] | None = None
        #: Whether the page is one of decimals.
        self.has_decimals = False

    def inside(self, *, numbered: bool = True) -> _PageBlocks:
        """Return the blocks of a part set apart from the page: its data hold there only, its figures are counted on."""
        known = self.given, self.citations
        found = _PageBlocks(self.convention, self.language, given=known[0], citations=known[1], figures=self.figures)
        found.numbered, found.referred, found.has_decimals = numbered, self.referred, self.has_decimals
        return found

    def emit(self, steps: Sequence[Step]) -> None:
        """Emit a derivation, the given data first."""
        self.emit_given([step for step in steps if _is_statement(step)])
        self.emit_steps([step for step in steps if not _is_statement(step)])

    def emit_given(self, statement: Sequence[Step]) -> None:
        """Emit the given data that are not printed yet."""
        news = _signs_at_once([new for step in statement for new in self.unprinted_steps(step)])
        if news:
            self.blocks.append(Heading("", (self.language.phrases["given"],), self.time))
            for step in news:
                self.emit_step(step)

    def unprinted_steps(self, step: Step) -> Iterator[Step]:
        """Yield the parts of a step of the statement that are not printed yet."""
        match step:
            case Section(steps=steps):
                for inner in steps:
                    yield from self.unprinted_steps(inner)
            case Given(silent=True):
                pass
            case Given(relations=relations):
                new = tuple(relation for relation in relations if self.given.get(relation.members[0]) != relation)
                self.given.update((relation.members[0], relation) for relation in new)
                if new:
                    yield replace(step, relations=new)
            case Conclude(sentence=said) | Note(sentence=said) | (Equal() as said):
                if said and said not in self.stated:
                    self.stated.add(said)
                    yield step
            case _:
                yield step

    def emit_steps(self, steps: Sequence[Step]) -> None:
        """Emit steps, special cases that follow one another in a table where each is a row of the same."""
        for opening, run in groupby(steps, self.opening_of_rows):
            cases = list(run)
            rows = [row for case in cases if isinstance(case, CaseStep) for row in self.rows(case)] if opening else []
            if len(rows) > 1:
                self.emit_sentence(Sentence(opening))
                self.blocks.append(self.table(rows))
            else:
                for step in cases:
                    self.emit_step(step)

    def opening_of_rows(self, step: Step) -> str:
        """Return the key of what goes before the table in which a case is a row; nothing for other steps."""
        if not isinstance(step, CaseStep) or step.sentence is not None:
            return ""
        found = set()
        for inner in step.steps:
            said = getattr(inner, "sentence", None)
            if isinstance(inner, CaseStep):
                found.add(self.opening_of_rows(inner))
            elif said is not None and not (isinstance(inner, Given) and _is_condition(inner)):
                found.add(ROWS.get(said.key, "").partition(" ")[0])
        return found.pop() if len(found) == 1 else ""

    def rows(self, case: CaseStep, around: tuple[Relation, ...] = ()) -> Iterator[Row]:
        """Yield the conditions, the fixed modes and the answer of a case, or of those within it."""
        own = case.when.relations if isinstance(case.when, Conjunction) else (case.when,)
        around = (*(relation for relation in around if not _follows(relation, own)), *own)
        where = around
        modes: Inlines = ("–",)
        answer: list[Inline] = []
        for step in case.steps:
            said = getattr(step, "sentence", None)
            if isinstance(step, Given) and said:
                where = (*where, *step.relations)
            elif said:
                key, slots = ROWS[said.key].partition(" ")[2], dict(said.slots)
                found = [slot for slot in slots.values() if isinstance(slot, Roots | Evaluated)]
                modes = tuple(shown(found[0], self.language)) if found else modes
                answer += [" ", *self.filled(Sentence(key, tuple((name, slots[name]) for name in slots_of(key))))]
            if isinstance(step, Define | Equal) and not getattr(step, "silent", False):
                relations = (step.relation,) if isinstance(step, Define) else step.relations
                answer += [part for relation in relations for part in (" ", relation)]
        if answer:
            yield where, modes, joined(answer[1:])
        for step in case.steps:
            if isinstance(step, CaseStep):
                yield from self.rows(step, around)

    def table(self, rows: Sequence[Row]) -> Columns:
        """Return the table of cases; those with the same modes and answer share a row."""
        places: dict[tuple[Inlines, Inlines], list[Inline]] = {}
        alike = {(frozenset(where), modes, answer): where for where, modes, answer in reversed(rows)}
        for (_, modes, answer), where in reversed(alike.items()):
            place = places.setdefault((modes, answer), [])
            place += ["; "] if place else []
            for index, relation in enumerate(dict.fromkeys(where)):
                place += [", ", relation] if index else [relation]
        heads = tuple((self.language.phrases[key],) for key in ("row_where", "row_modes", "row_answer"))
        cells = [(tuple(place), *row) for row, place in places.items()]
        return Columns(heads, tuple(tuple((Paragraph(cell),) for cell in row) for row in cells))

    def emit_step(self, step: Step) -> None:
        match step:
            case Given(relations=relations, sentence=sentence, silent=silent):
                self.emit_sentence(sentence)
                self.emit_display(() if silent or (sentence and _is_condition(step)) else relations)
            case Define(relation=relation, sentence=sentence, answer=answer, silent=silent):
                self.emit_sentence(sentence)
                self.emit_display(() if silent else (relation,), boxed=answer)
            case Equal(relations=relations, sentence=sentence, answer=answer):
                self.emit_sentence(sentence)
                self.emit_display(relations, boxed=answer)
            case Conclude(sentence=Sentence() as sentence, verified=True):
                self.blocks.append(Verified(self.filled(sentence)))
            case Note(sentence=sentence, caution=True):
                self.blocks.append(Caution(self.language.words["caution"], self.filled(sentence)))
            case Conclude(sentence=sentence) | Note(sentence=sentence):
                self.emit_sentence(sentence)
            case Diagram(name=name, labels=labels, sentence=sentence):
                self.blocks.append(Drawing(name, labels, self.figure_title(sentence)))
            case Tabulate(table=table, variable=variable, sentence=sentence, findings=findings):
                self.emit_sentence(sentence)

                self.blocks.append(
                    TableBlock(
                        table, variable, remarks(table, variable, self.language), self.filled(Sentence("routh_where"))
                    )
                )
                for finding in findings:
                    self.emit_sentence(finding)
            case Inequalities(fact=fact, sentence=sentence, answer=answer):
                self.emit_sentence(sentence)
                self.emit_display(fact.where, boxed=answer)
            case RegionSummary():
                self.emit_survey(step)
            case Plot(picture=picture, sentence=sentence):
                from symobs.pages.page.plot_captions import caption  # noqa: PLC0415 - only pages with pictures

                title = (*self.figure_title(sentence), " ")
                captions = (
                    caption(picture, self.language, sketched=sketched, decimals=self.has_decimals)
                    for sketched in (False, True)
                )
                self.blocks.append(PictureBlock(picture, *(joined((*title, *words)) for words in captions)))
            case CaseStep(when=when, steps=steps, sentence=sentence):
                self.emit_case(when, steps, sentence)
            case Section() if _is_statement(step):
                self.emit_given((step,))
            case Section(title=title, steps=steps):
                self.emit_section(title, steps)

    def emit_section(self, title: Sentence, steps: Sequence[Step]) -> None:
        is_numbered = self.numbered and title.key not in _UNNUMBERED
        self.numbers[-1] += is_numbered
        number = ".".join(str(part) for part in self.numbers) + "." if is_numbered else ""
        heading = Heading(number, self.filled(title))
        self.blocks.append(heading)
        start = len(self.blocks)
        self.numbers.append(0)
        columns = [step for step in steps if isinstance(step, Section)] if title.key in BESIDE else []
        self.blocks += self.side_by_side(columns)
        self.emit_steps(
            [step for step in steps if step not in columns and (isinstance(step, Section) or step not in self.printed)]
        )
        self.numbers.pop()
        self.blocks[start:] = with_few_boxes(self.blocks[start:])
        if self.blocks[-1] is heading and not self.printed.isdisjoint(steps):  # all of it is printed already
            self.blocks.pop()
            self.numbers[-1] -= is_numbered
            return
        for step in steps:
            self.places.setdefault(_unboxed(step), number.rstrip("."))

    def emit_again(self, section: Section) -> None:
        """Emit a section that stands on the page already, the whole of a part: its heading, where it is, its findings."""
        places = [place for step in section.steps if (place := self.places.get(_unboxed(step)))]
        where = [Note(Sentence("shown_in_section", (("number", place),))) for place in places[:1]]
        printed, self.printed = self.printed, set()
        self.emit_section(section.title, (*where, *at_detail(section.steps, "answer")))
        self.printed = printed

    def side_by_side(self, columns: Sequence[Section]) -> Iterator[Block]:
        """Emit sections in columns."""
        rows: list[tuple[tuple[Block, ...], ...]] = []
        for row in in_rows([column.steps for column in columns]):
            cells = [self.inside() for _ in row]
            for cell, steps in zip(cells, row, strict=True):
                for step in steps:
                    cell.emit_step(step)
            rows.append(tuple(_punctuated(cell.blocks) for cell in cells))
        if rows:
            yield Columns(tuple(self.filled(column.title) for column in columns), tuple(rows))

    def figure_title(self, sentence: Sentence | None) -> Inlines:
        """Return the number of the next figure, and what it shows."""
        numbered = f"{self.language.phrases['figure']}\N{NO-BREAK SPACE}{next(self.figures)}."
        return (numbered,) if sentence is None else joined((f"{numbered} ", *self.filled(sentence)))

    def emit_survey(self, step: RegionSummary) -> None:
        """Emit the summary of a region, its parts one below the other."""
        for finding in step.findings:
            self.emit_sentence(finding)
        self.emit_sentence(step.sentence)
        for part in step.parts:
            self.blocks.append(Display(part))

    def emit_case(self, when: Relation | Conjunction, steps: Sequence[Step], sentence: Sentence | None) -> None:
        """Emit the steps of a case, whose data hold only there."""
        inner = self.inside(numbered=False)
        inner.emit_sentence(sentence)
        inner.emit(steps)
        label: list[Inline] = [f"{self.language.words['case']} "]
        for place, relation in enumerate(when.relations if isinstance(when, Conjunction) else (when,)):
            label += [", ", relation] if place else [relation]
        self.blocks.append(CaseBlock((*label, "."), _punctuated(with_few_boxes(inner.blocks))))

    def emit_sentence(self, sentence: Sentence | None) -> None:
        """Emit a sentence, appended to a paragraph before it."""
        if sentence is None:
            return
        inlines = with_reference(self.filled(sentence), self.citations.get(RESTS_ON.get(sentence.key, "")))
        goes_on = sentence.key not in OPENS
        if goes_on and self.blocks and isinstance(last := self.blocks[-1], Paragraph):
            self.blocks[-1] = replace(last, inlines=joined((*last.inlines, " ", *inlines)))
        else:
            self.blocks.append(Paragraph(inlines, sentence.key in CONTINUES))

    def filled(self, sentence: Sentence) -> Inlines:
        """Return a sentence in the language and the convention of the page."""
        numbers = {relation: number for relation, number in self.referred.items() if number}
        return filled(sentence, self.convention, self.language, numbers)

    def emit_display(self, relations: tuple[Relation, ...], *, boxed: bool = False) -> None:
        """Emit a display, appended to an unfinished display before it; a box ends a display."""
        if not relations:
            return
        boxes = _answers(relations) if boxed else 0
        if len(relations) == 1 and self.referred.get(relations[0]) == 0:
            self.referred[relations[0]] = number = max(self.referred.values()) + 1
            self.blocks.append(Display(relations, boxes, number=number))
        elif self.blocks and isinstance(last := self.blocks[-1], Display) and not (last.boxed or last.number):
            self.blocks[-1] = Display((*last.relations, *relations), boxes)
        else:
            self.blocks.append(Display(relations, boxes))


def _answers(relations: Sequence[Relation]) -> int:
    """Return how many relations at the end are answers: the last one, and those before it that are a letter and its value."""
    values = (
        isinstance(each.members[0], Letter) and not any(map(letters, each.members[1:])) for each in reversed(relations)
    )
    return max(sum(1 for _ in takewhile(bool, values)), 1)


def _is_statement(step: Step) -> bool:
    """Return whether a step states the problem: a section of given data, or data alone."""
    if isinstance(step, Section):
        return step.title.key == "given"
    return isinstance(step, Given) and not _is_condition(step)


def _follows(condition: Relation, equations: Sequence[Relation]) -> bool:
    """Return whether a condition says only that a parameter differs from a number while an equation gives it another."""
    return condition.operators == ("!=",) and any(
        equation.operators == ("=",)
        and equation.members[0] == condition.members[0]
        and _are_numbers(condition, equation)
        for equation in equations
    )


def _are_numbers(*relations: Relation) -> bool:
    ends = [relation.members[-1] for relation in relations]
    return ends[0] != ends[1] and all(isinstance(end, Literal) and not end.value.names for end in ends)


def _is_condition(step: Given) -> bool:
    return all(relation.operators[0] == "!=" for relation in step.relations)


def _punctuated(blocks: Sequence[Block]) -> tuple[Block, ...]:
    """Return the blocks with punctuation after every display without a box.

    A comma where the sentence goes on after it, else a full stop.
    """
    punctuated: list[Block] = []
    for block, following in zip_longest(blocks, blocks[1:]):
        if isinstance(block, Display) and not block.boxed:
            goes_on = isinstance(following, Paragraph) and following.continues
            punctuated.append(replace(block, closing="," if goes_on else "."))
        else:
            punctuated.append(block)
    return tuple(punctuated)


# Remarks beside the rows of the Routh array.


def remarks(table: RouthTable, variable: str, language: Language = ENGLISH) -> tuple[tuple[Inlines, ...], ...]:
    """Return the remarks beside each row of an array: none, or the replacement of zeros, in full and shorter."""
    found: list[tuple[Inlines, ...]] = []
    for row in table.rows:
        if row.origin == "epsilon":
            small = Literal(row.entries[0])
            found.append((filled(Sentence("routh_row_epsilon", (("epsilon", small),)), STANDARD, language),))
        elif row.origin == "auxiliary":
            polynomial = Literal(table.auxiliary(row, variable))
            full = filled(Sentence("routh_row_auxiliary", (("auxiliary", polynomial),)), STANDARD, language)
            found.append((full, filled(Sentence("routh_row_derivative"), STANDARD, language)))
        else:
            found.append(())
    return tuple(found)
