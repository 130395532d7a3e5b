"""The numbers of an answer as NumPy arrays: the format `numpy`."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from symobs.pages.formats.code.program import number_rows
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from symobs.tasks.result import Document


@output_format
class Numpy:
    """Every answer that is a number or a matrix as a NumPy array, NAME = np.array(...)."""

    name: ClassVar[str] = "numpy"
    suffix: ClassVar[str] = ".numpy"

    def render(self, document: Document) -> str:
        """Return assignments that Python runs."""
        rows = number_rows(document, "a NumPy array")
        arrays = (f"{name} = np.array([{_rows(table)}])\n" for name, table in rows.items())
        return "import numpy as np\n\n" + "".join(arrays)

    def answers(self, document: Document) -> str:
        """Return the requested answers."""
        return self.render(document)


def _rows(table: list[list[str]]) -> str:
    return ", ".join(f"[{', '.join(row)}]" for row in table)
