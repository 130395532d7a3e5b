"""The Routh array as a table, fitted to the line, in every format."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Generic

from symobs.exact import Scalar
from symobs.formula.notation import symbol_latex
from symobs.formula.tree import Formula, Literal, Negative, Product, Quotient, Relation, Roots, Sum
from symobs.ground.dataclass import dataclass
from symobs.pages.printers import line_breaking as widths
from symobs.pages.printers.glyphs import B
from symobs.pages.printers.latex_printer import in_one_style, under_one_another
from symobs.pages.printers.latex_to_mathml import LARGE
from symobs.pages.printers.mathml import is_large
from symobs.pages.printers.rational_formula import is_leaf
from symobs.pages.printers.text_printer import text_width

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.pages.page.blocks import Inlines, TableBlock
    from symobs.pages.printers.latex_printer import LatexPrinter
    from symobs.pages.printers.mathml import MathmlPrinter
    from symobs.pages.printers.printer import Printer
    from symobs.pages.printers.text_printer import TextPrinter
    from symobs.stability.criteria.routh_table import RouthTable

    Names = dict[Scalar, str]
    Words = Callable[[Inlines], str]


# The Routh array fitted to the line: entries too wide for it are named, and defined below.
#
# The coefficients are a₀, a₁, …, the entries of the rows below them b₁, b₂, …, c₁, c₂, …. What a name stands for is
# written out where that fits the line, else by the rule that makes it of the two rows above.


#: Letters for the rows below the coefficients; e, i, j, o, s, t, w, x, y, z mean other things too often.
_ROWS = "bcdfghklmnpqruv"
#: Each time the table does not fit, entries wider than a bound smaller by this factor get names.
_NARROWER = 1.4
_NARROWEST = 1.0


@dataclass
class Fitted(Generic[B]):
    """A fitted table: powers, entries, the remark of each row, and the definitions below."""

    heads: list[B]
    rows: list[list[B]]
    remarks: list[Inlines]
    legend: tuple[Relation, ...]
    fits: bool


def fitted(
    block: TableBlock, printer: Printer[B], room: Callable[[Sequence[Inlines]], float], gap: float, line: float
) -> Fitted[B]:
    """Return the table with as few names as make it fit.

    `room` says what a choice of remarks leaves for the columns of entries, between which `gap` is left; what names stand
    for is told in lines of width `line`.
    """
    heads = [printer.raised(printer.leaf(Scalar.symbol(block.variable)), row.power) for row in block.table.rows]
    longest, shortest = ([choice[k] if choice else () for choice in block.remarks] for k in (0, -1))

    def width(rows: list[list[B]]) -> float:
        columns = len(rows[0])
        widest = (max(row[j].width for row in rows if j < len(row)) for j in range(columns))
        return sum(widest) + (columns - 1) * gap

    plain = _written(block.table, {}, printer)
    if width(plain) <= room(longest):
        return Fitted(heads, plain, longest, (), fits=True)
    bound = room(shortest)
    names = _named(block.table, bound, printer)
    while bound > _NARROWEST and width(_written(block.table, names, printer)) > room(shortest):
        bound /= _NARROWER
        names = _named(block.table, bound, printer)
    if any(_is_wide(value, name, printer, line) for value, name in names.items()):
        names = _named(block.table, bound, printer, below=True)
    rows = _written(block.table, names, printer)
    legend = tuple(_definition(value, name, block.table, names, printer, line) for value, name in names.items())
    return Fitted(heads, rows, shortest, legend, fits=width(rows) <= room(shortest))


def _written(table: RouthTable, names: Names, printer: Printer[B]) -> list[list[B]]:
    return [
        [
            printer.leaf(Scalar.symbol(names[entry])) if entry in names else printer.scalar(entry)
            for entry in row.entries
        ]
        for row in table.rows
    ]


# -- names ---------------------------------------------------------------------------------------------------------------


def _named(table: RouthTable, bound: float, printer: Printer[B], *, below: bool = False) -> Names:
    """Name the entries wider than a bound, equal ones alike.

    With `below` all that are not one glyph get names below the coefficients, so that a rule can speak of them.
    """
    names: Names = {}
    letters = _letters(table, printer)
    for i, row in enumerate(table.rows):
        for j, entry in enumerate(row.entries):
            is_named = printer.scalar(entry).width > bound or (below and i > 1 and not is_leaf(entry))
            if entry not in names and is_named:
                names[entry] = _name(i, j, letters)
    return names


def _letters(table: RouthTable, printer: Printer[B]) -> list[str]:
    """Return a letter for the coefficients and one for each row below, different from the parameters."""
    used = set().union(*(entry.names for row in table.rows for entry in row.entries))
    forms = [symbol_latex(name, printer.symbols.get(name)) for name in used]
    taken = {form[0] for form in forms if re.match(r"[A-Za-z](?![A-Za-z])", form)}
    return [letter for letter in f"a{_ROWS}" if letter not in taken]


def _name(i: int, j: int, letters: Sequence[str]) -> str:
    """Return the name of an entry: a₂ⱼ₊ᵢ in the first two rows, below them a letter of its own for each row."""
    if letters[0] == "a" and i < 2:
        return f"a_{2 * j + i}"
    below = letters[1:] if letters[0] == "a" else letters
    place = i - 2 if letters[0] == "a" else i
    return f"{below[place]}_{j + 1}" if place < len(below) else f"r_{i + 1}_{j + 1}"


def _definition(
    value: Scalar, name: str, table: RouthTable, names: Names, printer: Printer[B], line: float
) -> Relation:
    """Return name = value, or the definition by the two rows above if the value is too wide."""
    meaning = _made(value, table, names) if _is_wide(value, name, printer, line) else Literal(value)
    return Relation((Literal(Scalar.symbol(name)), meaning), ("=",))


def _is_wide(value: Scalar, name: str, printer: Printer[B], line: float) -> bool:
    """Return whether name = value is wider than a line."""
    return printer.relation(Relation((Literal(Scalar.symbol(name)), Literal(value)), ("=",))).width > line


def _made(value: Scalar, table: RouthTable, names: Names) -> Formula:
    """Return the origin of the first entry with this value; a coefficient has none but its value."""

    def short(entry: Scalar) -> Formula:
        return Literal(Scalar.symbol(names[entry]) if entry in names else entry)

    i, j = next((i, row.entries.index(value)) for i, row in enumerate(table.rows) if value in row.entries)
    row, above = table.rows[i], table.rows[i - 1].entries
    if row.origin == "auxiliary":
        return Product((Literal(Scalar.of(table.rows[i - 1].power - 2 * j)), short(above[j])))
    if row.origin == "coefficients":
        return Literal(value)
    before = table.rows[i - 2].entries
    crossed = Negative(Product((short(before[0]), short(above[j + 1]))))
    return Quotient(Sum((Product((short(above[0]), short(before[j + 1]))), crossed)), short(above[0]))


# The Routh array in LaTeX and on a terminal: powers, a rule, entries, and remarks beside the rows.


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


# The Routh array as a table of HTML and Markdown.


_GAP_IN_EM = 1.4  # em


def html_table(block: TableBlock, printer: MathmlPrinter, words: Words) -> tuple[str, str]:
    """Return a table, and the display of the definitions of its names, if any."""
    found = fitted(block, printer, room_for(printer), _GAP_IN_EM, printer.width)
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
    found = fitted(block, printer, room_for(printer), _GAP_IN_EM, printer.width)
    columns, has_remarks = len(found.rows[0]), any(found.remarks)
    lines = [[""] * (1 + columns + has_remarks), ["---:", *[":---:"] * columns, *[":---"] * has_remarks]]
    for head, row, remark in zip(found.heads, found.rows, found.remarks, strict=True):
        cells = [mathematics(head.source), *(mathematics(entry.source) for entry in row), *[""] * (columns - len(row))]
        lines.append([*cells, *[words(remark)] * has_remarks])
    return "\n".join(f"| {' | '.join(cells)} |" for cells in lines), found.legend
