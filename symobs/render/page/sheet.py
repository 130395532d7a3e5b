"""A sheet of several problems, with every part already rendered.

A format that has sheets offers two functions besides `render`: `part(document)` returns whatever it will want of one
question or solution, and `sheet(sheet)` returns the whole.  Parts are made one by one, so one that fails loses no other.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs._dataclass import dataclass

if TYPE_CHECKING:
    from pathlib import Path

#: A sheet of more problems than this begins with a table of contents.
WITHOUT_CONTENTS = 6


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
    #: The code of the language of its parts.
    language: str = ""


@dataclass(frozen=True)
class Sheet:
    """Problems under one title: first all questions, then all solutions."""

    title: str
    entries: tuple[SheetEntry, ...]
    has_questions: bool = True
    has_solutions: bool = True
    templates: Path | None = None

    @property
    def language(self) -> str:
        """The language of the sheet's own words: that of all its problems, English where they differ."""
        found = {entry.language for entry in self.entries if entry.language}
        return found.pop() if len(found) == 1 else "en"

    @property
    def is_long(self) -> bool:
        """Whether the sheet has a table of contents."""
        return len(self.entries) > WITHOUT_CONTENTS

    def chapters(self) -> tuple[tuple[str, tuple[tuple[SheetEntry, Any], ...]], ...]:
        """Return the chapters, `questions` and `solutions`, each with its entries and their parts."""
        asked = ("questions", tuple((entry, entry.question) for entry in self.entries))
        solved = ("solutions", tuple((entry, entry.solution) for entry in self.entries))
        return (*((asked,) if self.has_questions else ()), *((solved,) if self.has_solutions else ()))
