"""The Routh array as a table of HTML and Markdown."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.pages.printers.mathml.mathml_elements import LARGE
from symobs.pages.printers.mathml.mathml_printer import is_large
from symobs.pages.tables.fitted_table import fitted
from symobs.pages.tables.text_and_latex import room_for

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.formula.tree import Relation
    from symobs.pages.page.blocks import Inlines, TableBlock
    from symobs.pages.printers.latex_printer import LatexPrinter
    from symobs.pages.printers.mathml.mathml_printer import MathmlPrinter

    Words = Callable[[Inlines], str]

_GAP = 1.4  # em


def html_table(block: TableBlock, printer: MathmlPrinter, words: Words) -> tuple[str, str]:
    """Return a table, and the display of the definitions of its names, if any."""
    found = fitted(block, printer, room_for(printer), _GAP, printer.width)
    columns, has_remarks = len(found.rows[0]), any(found.remarks)
    lines: list[str] = []
    for head, row, remark in zip(found.heads, found.rows, found.remarks, strict=True):
        entries = [f"<math{LARGE * is_large(entry)}>{entry.source}</math>" for entry in row]
        beside = f'<td class="remark">{words(remark)}</td>' if has_remarks else ""
        cells = "".join(f"<td>{cell}</td>" for cell in [*entries, *[""] * (columns - len(row))])
        lines.append(f'<tr><th scope="row"><math>{head.source}</math></th>{cells}{beside}</tr>')
    table = "\n".join(["<table>", *lines, "</table>"])
    return table, printer.display(found.legend) if found.legend else ""


def markdown_table(
    block: TableBlock, printer: LatexPrinter, words: Words, mathematics: Callable[[str], str]
) -> tuple[str, Sequence[Relation]]:
    """Return a table without a head, with a column for remarks if any, and the definitions of its names."""
    found = fitted(block, printer, room_for(printer), _GAP, printer.width)
    columns, has_remarks = len(found.rows[0]), any(found.remarks)
    lines = [[""] * (1 + columns + has_remarks), ["---:", *[":---:"] * columns, *[":---"] * has_remarks]]
    for head, row, remark in zip(found.heads, found.rows, found.remarks, strict=True):
        cells = [mathematics(head.source), *(mathematics(entry.source) for entry in row), *[""] * (columns - len(row))]
        lines.append([*cells, *[words(remark)] * has_remarks])
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines), found.legend
