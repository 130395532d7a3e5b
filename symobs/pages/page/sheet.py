"""A sheet of several problems, with every part already rendered.

A format that has sheets offers two functions besides `render`: `part(document)` returns whatever it will want of one
question or solution, and `sheet(sheet)` returns the whole.  Parts are made one by one, so one that fails loses no other.
"""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from fractions import Fraction
from functools import cached_property
from pathlib import PurePath
from typing import TYPE_CHECKING, Any

from symobs.formula.phrases.languages import Language, language_named
from symobs.ground.dataclass import dataclass
from symobs.pages.page.blocks import AnswerSpace, Columns, Paragraph
from symobs.pages.page.prose import joined
from symobs.tasks.result.output_methods import PLAIN, WebPage

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from symobs.pages.page.blocks import Block

    Part = tuple[str, AnswerSpace | None]


#: A sheet of more problems than this begins with a table of contents.
WITHOUT_CONTENTS = 6
#: So many columns of a table of points stand beside each other.
_COLUMNS = 10
_PREFIX = "sheet_"


def sheet_words(language: Language) -> dict[str, str]:
    """Return the fixed words of a sheet, by the keys of their phrases without the prefix: all come from here."""
    return {key.removeprefix(_PREFIX): words for key, words in language.phrases.items() if key.startswith(_PREFIX)}


def decimal_of(points: Fraction) -> str:
    """Return points as a decimal: 10, 2.5."""
    whole, rest = divmod(points.numerator * 100 // points.denominator, 100)
    return f"{whole}.{rest:02}".rstrip("0").rstrip(".")


def points_in_words(points: Sequence[Fraction], language: Language) -> str:
    """Return the sum of some points, `1 point` or `7.5 points`; nothing where there are none."""
    total, words = sum(points, Fraction(0)), sheet_words(language)
    return f"{language.decimal(decimal_of(total))} {words['point' if total == 1 else 'points']}" if points else ""


@dataclass
class Logo:
    """A picture at the head of a sheet: its kind (png, jpg or pdf), its bytes, and where LaTeX finds it."""

    kind: str
    content: bytes
    path: str


@dataclass
class Header:
    """The head of a sheet."""

    course: str = ""
    term: str = ""
    number: str = ""
    due: str | date = ""
    instructor: str = ""
    text: str = ""
    logo: Logo | None = None
    #: Whether there is a line for name and student number.
    has_name: bool = False
    #: As in an examination: every problem on a page of its own, its solution right after it.
    is_exam: bool = False


@dataclass
class SheetEntry:
    """One problem of a sheet; a part that failed is None."""

    number: int
    file: str
    title: str
    question: Any = None
    solution: Any = None
    #: What the sheet says in place of a part that could not be made.
    failure: str = ""
    #: One value for the whole problem, or one for each of its parts.
    points: tuple[Fraction, ...] = ()
    hint: str = ""
    #: The answers alone, for the end of the sheet.
    answer: Any = None
    #: The code of the language of its parts.
    language: str = ""
    #: The letter of the version that it belongs to, where a sheet has versions.
    version: str = ""
    #: The id of the variant that it is: each student has one.
    variant: str = ""


@dataclass
class Item:
    """One piece of a chapter: what it begins with, and a part of a problem or a text in its place."""

    kind: str
    entry: SheetEntry
    label: str
    title: str
    part: Any = None
    text: str = ""
    points: str = ""

    @property
    def place(self) -> str:
        """The name of its place on the sheet."""
        return f"{self.kind}-{self.entry.version}{self.entry.number}"


@dataclass
class Chapter:
    """A chapter of a sheet; that of an examination has no title."""

    name: str
    title: str
    items: tuple[Item, ...]


@dataclass
class Sheet:
    """Problems under one title: first all questions, then all solutions; in an examination one after the other."""

    title: str
    entries: tuple[SheetEntry, ...]
    has_questions: bool = True
    has_solutions: bool = True
    templates: Path | None = None
    header: Header = Header()
    #: For a page of HTML: what it offers besides its text, and the level of detail that is shown first.
    web: WebPage = PLAIN
    detail: str = "full"

    @property
    def language(self) -> str:
        """The language of the sheet's own words: that of all its problems, English where they differ."""
        found = {entry.language for entry in self.entries if entry.language}
        return found.pop() if len(found) == 1 else "en"

    @property
    def is_long(self) -> bool:
        """Whether the sheet has a table of contents."""
        return len(self.entries) > WITHOUT_CONTENTS and not self.header.is_exam and not self.entries[0].version

    @cached_property
    def words(self) -> dict[str, str]:
        """The fixed words of the sheet."""
        return sheet_words(self._language)

    @property
    def _language(self) -> Language:
        return language_named(self.language)

    @property
    def apart(self) -> tuple[Sheet, ...]:
        """The sheets that it consists of: itself, or the questions of each version and the key to all of them.

        An examination of the variants of one problem, which lie in one folder, is one for each student.
        """
        versions = tuple(dict.fromkeys(entry.version for entry in self.entries))
        folders = {PurePath(entry.file).parent for entry in self.entries if entry.variant and not entry.version}
        if (
            self.header.is_exam
            and not self.has_solutions
            and len(folders) == 1
            and all(e.variant for e in self.entries)
        ):
            return tuple(replace(self, entries=(entry,)) for entry in self.entries)
        if len(versions) < 2:
            return (self,)
        found = []
        for version in versions if self.has_questions else ():
            own = tuple(entry for entry in self.entries if entry.version == version)
            found.append(replace(self, title=self._titled(version), entries=own, has_solutions=False))
        title = ", ".join(filter(None, (self.title, self.words["solutions"])))
        return (*found, *((replace(self, title=title, has_questions=False),) if self.has_solutions else ()))

    def _titled(self, version: str) -> str:
        return ", ".join(filter(None, (self.title, f"{self.words['version']} {version}")))

    @property
    def heading(self) -> str:
        """The number of the sheet and its title."""
        number = f"{self.words['number']} {self.header.number}" if self.header.number else ""
        return ": ".join(filter(None, (number, self.title)))

    @property
    def course(self) -> str:
        """The course and its term."""
        return ", ".join(filter(None, (self.header.course, self.header.term)))

    @property
    def facts(self) -> tuple[tuple[str, str], ...]:
        """Who gives the sheet out and when it is due, each after its word."""
        due = self._language.day(self.header.due) if isinstance(self.header.due, date) else self.header.due
        told = ((self.words["instructor"], self.header.instructor), (self.words["due"], due))
        return tuple((word, value) for word, value in told if value)

    @property
    def fields(self) -> tuple[str, ...]:
        """What is to be filled in at the head, on a sheet that is handed out."""
        is_handed_out = self.header.has_name and not self.has_solutions
        return (self.words["name"], self.words["student_number"]) if is_handed_out else ()

    @property
    def totals(self) -> tuple[tuple[tuple[str, ...], ...], ...]:
        """The tables of points, each as its rows: numbers, points, and on a sheet that is handed out empty scores."""
        if not self.has_questions or not any(entry.points for entry in self.entries):
            return ()
        cells = [
            (str(entry.number), self._language.decimal(decimal_of(sum(entry.points, Fraction(0)))))
            for entry in self.entries
        ]
        total = sum((point for entry in self.entries for point in entry.points), Fraction(0))
        cells.append((self.words["total"], self._language.decimal(decimal_of(total))))
        tables = []
        for some in (cells[start : start + _COLUMNS] for start in range(0, len(cells), _COLUMNS)):
            numbers, points = zip(*some, strict=True)
            rows = [(self.words["problem"], *numbers), (self.words["points_row"], *points)]
            rows += [] if self.has_solutions else [(self.words["score_row"], *("" for _ in some))]
            tables.append(tuple(rows))
        return tuple(tables)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of part that every problem has on this sheet."""
        return (*(("questions",) if self.has_questions else ()), *(("solutions",) if self.has_solutions else ()))

    def chapters(self) -> tuple[Chapter, ...]:
        """Return the chapters: questions, hints and final answers where there are any, and solutions."""
        is_paper = self.header.is_exam and not self.has_solutions  # what students of an exam get
        ends = {"hints": self._hints(), "answers": self._answers()} if self.has_questions and not is_paper else {}
        if self.entries[0].version and not self.has_questions:
            items: dict[str, list[Item]] = {
                version: [] for version in dict.fromkeys(entry.version for entry in self.entries)
            }
            for item in self._items("solutions"):
                items[item.entry.version].append(item)
            titles = {version: f"{self.words['version']} {version}" for version in items}
            return tuple(Chapter(f"solutions-{name}", titles[name], tuple(items[name])) for name in items)
        if self.header.is_exam:
            both = [self._items(kind) for kind in self.kinds]
            named = {"problems": tuple(item for items in zip(*both, strict=True) for item in items), **ends}
        else:
            named = {kind: tuple(self._items(kind)) for kind in self.kinds[:1]} | ends
            named |= {kind: tuple(self._items(kind)) for kind in self.kinds[1:]}
        return tuple(Chapter(name, self.words.get(name, ""), items) for name, items in named.items() if items)

    def _items(self, kind: str) -> Iterator[Item]:
        """Yield the questions or the solutions; one below its question needs neither title nor points."""
        is_below = self.header.is_exam and kind == "solutions" and self.has_questions
        for entry in self.entries:
            part = entry.question if kind == "questions" else entry.solution
            label = f"{self.words['one_solution']} {entry.number}" if is_below else f"{entry.number}."
            points = "" if is_below else points_in_words(entry.points, self._language)
            yield Item(kind, entry, label, "" if is_below else entry.title, part, "" if part else entry.failure, points)

    def _hints(self) -> tuple[Item, ...]:
        hinted = (entry for entry in self.entries if entry.hint)
        return tuple(Item("hints", entry, f"{entry.number}.", entry.title, None, entry.hint) for entry in hinted)

    def _answers(self) -> tuple[Item, ...]:
        """Return the final answers, none where there are none at all."""
        if not any(entry.answer for entry in self.entries):
            return ()
        return tuple(
            Item("answers", entry, f"{entry.number}.", entry.title, entry.answer, "" if entry.answer else entry.failure)
            for entry in self.entries
        )


# Points and room for answers, added to the parts of a question on a sheet.


def handed_out(blocks: Sequence[Block], parts: Sequence[Part | Columns]) -> tuple[Block, ...]:
    """Return a question with points and room for each of its parts, its last paragraphs; a solution below its points."""
    if parts and isinstance(parts[0], Columns):
        title, *below = blocks
        return (title, parts[0], *below)
    paragraphs = [place for place, block in enumerate(blocks) if isinstance(block, Paragraph)]
    added: dict[int, Any] = dict(zip(paragraphs[-len(parts) :], parts, strict=True)) if parts else {}
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
