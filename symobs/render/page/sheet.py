"""A sheet of several problems, with every part already rendered.

A format that has sheets offers two functions besides `render`: `part(document)` returns whatever it will want of one
question or solution, and `sheet(sheet)` returns the whole.  Parts are made one by one, so one that fails loses no other.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs._dataclass import dataclass
from symobs.phrases import PHRASES

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

#: A sheet of more problems than this begins with a table of contents.
WITHOUT_CONTENTS = 6
#: So many columns of a table of points stand beside each other.
_COLUMNS = 10
_PREFIX = "sheet_"


def sheet_words() -> dict[str, str]:
    """Return the fixed words of a sheet, by the keys of their phrases without the prefix."""
    return {key.removeprefix(_PREFIX): words for key, words in PHRASES.items() if key.startswith(_PREFIX)}


def decimal_of(points: Fraction) -> str:
    """Return points as a decimal: 10, 2.5."""
    whole, rest = divmod(points.numerator * 100 // points.denominator, 100)
    return f"{whole}.{rest:02}".rstrip("0").rstrip(".")


def points_in_words(points: Sequence[Fraction]) -> str:
    """Return the sum of some points, `1 point` or `7.5 points`; nothing where there are none."""
    total = sum(points, Fraction(0))
    return f"{decimal_of(total)} {PHRASES['sheet_point' if total == 1 else 'sheet_points']}" if points else ""


@dataclass(frozen=True)
class Logo:
    """A picture at the head of a sheet: its kind (png, jpg or pdf), its bytes, and where LaTeX finds it."""

    kind: str
    content: bytes
    path: str


@dataclass(frozen=True)
class Header:
    """What stands at the head of a sheet."""

    course: str = ""
    term: str = ""
    number: str = ""
    due: str = ""
    instructor: str = ""
    text: str = ""
    logo: Logo | None = None
    #: Whether there is a line for name and student number.
    has_name: bool = False
    #: As in an examination: every problem on a page of its own, its solution right after it.
    is_exam: bool = False


@dataclass(frozen=True)
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


@dataclass(frozen=True)
class Item:
    """One piece of a chapter: a part of a problem, or a text in its place."""

    kind: str
    entry: SheetEntry
    part: Any
    text: str
    #: Whether it is a solution in a chapter of solutions.
    is_alone: bool = False

    @property
    def place(self) -> str:
        """The name of its place on the sheet."""
        return f"{self.kind}-{self.entry.number}"

    @property
    def points(self) -> str:
        """The points of the problem, in words."""
        return points_in_words(self.entry.points) if self.kind == "questions" or self.is_alone else ""


@dataclass(frozen=True)
class Chapter:
    """A chapter of a sheet; without a title it is the only one of its kind."""

    name: str
    title: str
    items: tuple[Item, ...]

    def heading(self, item: Item) -> tuple[str, str]:
        """Return what a problem begins with, its number and its title; a solution below its question has no title."""
        if not self.title and item.kind == "solutions":
            return f"{PHRASES['sheet_one_solution']} {item.entry.number}", ""
        return f"{item.entry.number}.", item.entry.title


@dataclass(frozen=True)
class Sheet:
    """Problems under one title: first all questions, then all solutions; in an examination one after the other."""

    title: str
    entries: tuple[SheetEntry, ...]
    has_questions: bool = True
    has_solutions: bool = True
    templates: Path | None = None
    header: Header = Header()

    @property
    def is_long(self) -> bool:
        """Whether the sheet has a table of contents."""
        return len(self.entries) > WITHOUT_CONTENTS and not self.header.is_exam

    @property
    def heading(self) -> str:
        """The number of the sheet and its title."""
        number = f"{PHRASES['sheet_number']} {self.header.number}" if self.header.number else ""
        return ": ".join(filter(None, (number, self.title)))

    @property
    def course(self) -> str:
        """The course and its term."""
        return ", ".join(filter(None, (self.header.course, self.header.term)))

    @property
    def facts(self) -> tuple[tuple[str, str], ...]:
        """Who gives the sheet out and when it is due, each after its word."""
        told = (
            (PHRASES["sheet_instructor"], self.header.instructor),
            (PHRASES["sheet_due"], self.header.due),
        )
        return tuple((word, value) for word, value in told if value)

    @property
    def fields(self) -> tuple[str, ...]:
        """What is to be filled in at the head, on a sheet that is handed out."""
        is_handed_out = self.header.has_name and not self.has_solutions
        return (PHRASES["sheet_name"], PHRASES["sheet_student_number"]) if is_handed_out else ()

    @property
    def totals(self) -> tuple[tuple[tuple[str, ...], ...], ...]:
        """The tables of points, each as its rows: numbers, points, and on a sheet that is handed out empty scores."""
        if not self.has_questions or not any(entry.points for entry in self.entries):
            return ()
        cells = [(str(entry.number), decimal_of(sum(entry.points, Fraction(0)))) for entry in self.entries]
        total = sum((point for entry in self.entries for point in entry.points), Fraction(0))
        cells.append((PHRASES["sheet_total"], decimal_of(total)))
        tables = []
        for some in (cells[start : start + _COLUMNS] for start in range(0, len(cells), _COLUMNS)):
            numbers, points = zip(*some, strict=True)
            rows = [(PHRASES["sheet_problem"], *numbers), (PHRASES["sheet_points_row"], *points)]
            rows += [] if self.has_solutions else [(PHRASES["sheet_score_row"], *("" for _ in some))]
            tables.append(tuple(rows))
        return tuple(tables)

    @property
    def kinds(self) -> tuple[str, ...]:
        """The kinds of part that every problem has on this sheet."""
        return (*(("questions",) if self.has_questions else ()), *(("solutions",) if self.has_solutions else ()))

    def chapters(self) -> tuple[Chapter, ...]:
        """Return the chapters: questions, hints and final answers where there are any, and solutions."""
        hints = tuple(Item("hints", entry, None, entry.hint) for entry in self.entries if entry.hint)
        answers = tuple(self._items("answers")) if any(entry.answer for entry in self.entries) else ()
        ends = {"hints": hints, "answers": answers} if self.has_questions else {}
        if self.header.is_exam:
            both = [self._items(kind) for kind in self.kinds]
            named = {"problems": tuple(item for items in zip(*both, strict=True) for item in items), **ends}
        else:
            named = {kind: tuple(self._items(kind)) for kind in self.kinds[:1]} | ends
            named |= {kind: tuple(self._items(kind)) for kind in self.kinds[1:]}
        return tuple(
            Chapter(name, PHRASES.get(f"{_PREFIX}{name}", ""), items) for name, items in named.items() if items
        )

    def _items(self, kind: str) -> Iterator[Item]:
        for entry in self.entries:
            part = {"questions": entry.question, "answers": entry.answer, "solutions": entry.solution}[kind]
            is_alone = kind == "solutions" and not self.header.is_exam
            yield Item(kind, entry, part, "" if part else entry.failure, is_alone)
