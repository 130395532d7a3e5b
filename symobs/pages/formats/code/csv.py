"""The numbers of an answer, separated by commas: the format `csv`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from symobs.pages.formats.code.program import number_rows
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from symobs.tasks.result import Document


@output_format
class Csv:
    """Every answer that is a number or a matrix as rows of numbers; of several each begins with the line # NAME."""

    name: ClassVar[str] = "csv"
    suffix: ClassVar[str] = ".csv"

    def render(self, document: Document) -> str:
        """Return the rows."""
        rows = number_rows(document, "a table of numbers")
        heads = {name: f"# {name}\n" if len(rows) > 1 else "" for name in rows}
        return "".join(heads[name] + "".join(",".join(row) + "\n" for row in table) for name, table in rows.items())

    def answers(self, document: Document) -> str:
        """Return the requested answers."""
        return self.render(document)
