"""The Routh array in LaTeX and on a terminal: powers, a rule, entries, and remarks beside the rows."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula.tree import Relation, Roots
from symobs.pages.printers import widths
from symobs.pages.printers.latex_printer import in_one_style, under_one_another
from symobs.pages.printers.text_printer import text_width
from symobs.pages.tables.fitted_table import fitted

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.pages.page.blocks import Inlines, TableBlock
    from symobs.pages.printers.latex_printer import LatexPrinter
    from symobs.pages.printers.mathml.mathml_printer import MathmlPrinter
    from symobs.pages.printers.text_printer import TextPrinter

    Words = Callable[[Inlines], str]

# -- LaTeX ---------------------------------------------------------------------------------------------------------------

#: In em: a letter of running text; what the powers, the rule and the space around the table take; a `\quad` and more.
_LETTER = 0.47
_HEADS = 3.3
_BEFORE_REMARK = 1.5
_OPEN = r"\renewcommand{\arraystretch}{1.15}"
_TIGHT = r"\scriptsize\arraycolsep=1.5pt"


def latex_table(block: TableBlock, printer: LatexPrinter, words: Words) -> str:
    """Return an array, and below it the definitions of its names; `words` sets a remark.

    A table that is too wide even with names is set small, without remarks.
    """
    found = fitted(block, printer, room_for(printer), widths.COLUMN_GAP, printer.width)
    rows = in_one_style(found.rows)
    columns, has_remarks = len(rows[0]), found.fits and any(found.remarks)
    lines: list[str] = []
    for head, row, remark in zip(found.heads, rows, found.remarks, strict=True):
        cells = [head.source, *(entry.source for entry in row), *[""] * (columns - len(row))]
        beside = rf"\text{{{words(remark)}}}" if remark else ""
        lines.append("&".join([*cells, beside] if has_remarks else cells))
    body = under_one_another(lines, [max(entry.height for entry in row) for row in rows])
    last = r"@{\quad}l" if has_remarks else ""
    array = f"\\begin{{array}}{{c|{'c' * columns}{last}}}\n{body}\n\\end{{array}}"
    table = f"\\[{_OPEN}\n{array}\n\\]" if found.fits else f"{{{_TIGHT}\n\\[\n{array}\n\\]}}"
    return f"{table}\n{words(block.where)}\n{printer.display(found.legend)}" if found.legend else table


def room_for(printer: LatexPrinter | MathmlPrinter) -> Callable[[Sequence[Inlines]], float]:
    """Return the width left for the entries by a choice of remarks."""

    def room(remarks: Sequence[Inlines]) -> float:
        widest = max(_em_width(remark, printer) for remark in remarks)
        return printer.width - _HEADS - (widest + _BEFORE_REMARK if widest else 0.0)

    return room


def _em_width(inlines: Inlines, printer: LatexPrinter | MathmlPrinter) -> float:
    formulas = [part for part in inlines if not isinstance(part, str | Relation | Roots)]
    letters = sum(len(part) for part in inlines if isinstance(part, str))
    return _LETTER * letters + sum(printer.typeset(formula).width for formula in formulas)


# -- terminals -----------------------------------------------------------------------------------------------------------

_GAP = 2
_RULE = " │ "


def text_table(block: TableBlock, printer: TextPrinter, words: Words) -> tuple[str, str]:
    """Return the rows in aligned columns, and the definitions of their names, if any; `words` writes a remark."""
    margin = 2 + len(str(block.table.rows[0].power)) + text_width(_RULE)

    def room(remarks: Sequence[Inlines]) -> float:
        widest = max(text_width(words(remark)) for remark in remarks)
        return printer.width - margin - (widest + 2 * _GAP if widest else 0)

    found = fitted(block, printer, room, _GAP, printer.width)
    heads = [head.line for head in found.heads]
    rows = [[entry.line for entry in row] for row in found.rows]
    columns = [[row[j] if j < len(row) else "" for row in rows] for j in range(len(rows[0]))]
    remarks = [words(remark) for remark in found.remarks]
    first, *others = (_padded(column) for column in (heads, *columns))
    lines = [
        f"{head}{_RULE}{(' ' * _GAP).join(row)}{' ' * 2 * _GAP}{remark}".rstrip()
        for head, row, remark in zip(first, zip(*others, strict=True), remarks, strict=True)
    ]
    return "\n".join(lines), printer.display(found.legend) if found.legend else ""


def _padded(column: Sequence[str]) -> list[str]:
    """Return texts padded to equal width."""
    widest = max(map(text_width, column))
    return [text + " " * (widest - text_width(text)) for text in column]
