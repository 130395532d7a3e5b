"""The Routh array fitted to the line: entries too wide for it are named, and defined below.

The coefficients are a₀, a₁, …, the entries of the rows below them b₁, b₂, …, c₁, c₂, ….  What a name stands for is
written out where that fits the line, else by the rule that makes it of the two rows above.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Generic

from symobs.exact import Scalar
from symobs.formula.notation import symbol_latex
from symobs.formula.tree import Formula, Literal, Negative, Product, Quotient, Relation, Sum
from symobs.ground.dataclass import dataclass
from symobs.pages.printers.glyphs import B
from symobs.pages.printers.rational_formula import is_leaf

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.pages.page.blocks import Inlines, TableBlock
    from symobs.pages.printers.printer import Printer
    from symobs.stability.criteria.routh_table import RouthTable

    Names = dict[Scalar, str]

#: Letters for the rows below the coefficients; e, i, j, o, s, t, w, x, y, z mean other things too often.
_ROWS = "bcdfghklmnpqruv"
#: Each time the table does not fit, entries wider than a bound smaller by this factor get names.
_NARROWER = 1.4
_NARROWEST = 1.0


@dataclass(frozen=True)
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
