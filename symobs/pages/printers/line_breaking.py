"""Line breaking of long formulas.

A formula that fits is one piece.  One that does not is opened: a sum at its terms, a product at its factors, a wide
fraction as 1/denominator before its numerator in parentheses, a number between digits; a matrix keeps its shape, and
entries too wide for it get a name, to be told below.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Generic

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Apply,
    Block,
    Derivative,
    Formula,
    Letter,
    Literal,
    Negative,
    Numeral,
    Power,
    Product,
    Quotient,
    Sum,
    Transpose,
    contains,
)
from symobs.ground.dataclass import dataclass
from symobs.pages.printers.glyphs import B, Level
from symobs.pages.printers.printer import shifted, signed_terms
from symobs.pages.printers.rational_formula import digits_of, is_leaf
from symobs.pages.printers.scalar_formula import factors, formula_of, formula_of_matrix, partitioned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.pages.printers.printer import Printer

_DIGITS_TOGETHER = 30
_ROWS_TOGETHER = 30
#: Lines evened out where the last would be shorter than this part of the width.
_FEW_LINES = (2, 3, 4)
_SHORT_END = 0.3
#: A denominator that takes more of the line than this is not set under a fraction bar.
_WIDEST_DENOMINATOR = 0.7


@dataclass(frozen=True)
class LinePiece(Generic[B]):
    """An unbreakable piece, with its prefix inside a line (`within`) and at the start of one (`at_start`)."""

    box: B
    within: B | None = None
    at_start: B | None = None


class Breaker(Generic[B]):
    """Line breaker of the formulas of one display; `named` collects entries of matrices to be defined below."""

    def __init__(self, printer: Printer[B]) -> None:
        """Break with the boxes of `printer`."""
        self.printer = printer
        self.named: dict[Formula, B] = {}
        self.stars: dict[Formula, int] = {}

    def lines(self, pieces: Sequence[LinePiece[B]], first: float, rest: float) -> list[B]:
        """Fill lines, the first of width `first`, the others of width `rest`, without a short last line."""
        filled = self._filled(pieces, first, rest)
        for part in (1.0, 0.9, 0.8, 0.7, 0.6) if len(filled) in _FEW_LINES else ():
            narrower = self._filled(pieces, part * first, part * rest)
            if len(narrower) == len(filled) and narrower[-1].width > _SHORT_END * rest:
                return narrower
        return filled

    def _filled(self, pieces: Sequence[LinePiece[B]], first: float, rest: float) -> list[B]:
        finished: list[list[B]] = []
        line: list[B] = []
        for piece in pieces:
            room = rest if finished else first
            added = [piece.within, piece.box] if piece.within else [piece.box]
            if line and sum(box.width for box in line + added) > room:
                finished.append(line)
                line = []
                added = [piece.at_start, piece.box] if piece.at_start else [piece.box]
            line = line + added if line else added
        return [self.printer.joined(boxes, Level.SUM) for boxes in [*finished, line]]

    # -- pieces ---------------------------------------------------------------------------------------------------

    def pieces(self, formula: Formula, room: float, head: B | None = None) -> list[LinePiece[B]]:
        """Return the pieces of a formula for lines of width `room`.

        Where it is a matrix, its entries are named after `head`.
        """
        box = self.printer.typeset(formula)
        if box.width <= room:
            return [LinePiece(box)]
        written = self._written(formula)
        return self._matrix(written, room, head) if _is_table(written) else self._opened(formula, room)

    def _opened(self, formula: Formula, room: float) -> list[LinePiece[B]]:
        match self._written(formula):
            case Literal(Scalar() as value):
                return self._digits(value)
            case Sum() | Negative() as written:
                return self._sum(written, room)
            case Product() as written:
                return self._product(written, room)
            case Quotient() as written:
                return self._quotient(written, room)
            case Literal() | Block() as written:
                return self._matrix(written, room)
            case Power(base, exponent) if exponent != 1:
                *body, last = self._operand(base, Level.ATOM, room - 1)
                return [*body, replace(last, box=self.printer.raised(last.box, exponent))]
            case Transpose(operand):
                *body, last = self._operand(operand, Level.ATOM, room - 1)
                return [*body, replace(last, box=self.printer.transposed(last.box))]
            case Apply(function, argument):
                name = self.printer.applied(function, self.printer.identity())
                first, *body = self._argument(argument, room - name.width)
                return [replace(first, box=self.printer.applied(function, first.box)), *body]
            case Derivative(operand, name):
                first, *body = self._operand(operand, Level.FRACTION, room - 2)
                return [replace(first, box=self.printer.rate(first.box, name)), *body]
        return [LinePiece(self.printer.typeset(formula))]

    def _written(self, formula: Formula) -> Formula:
        """Return the formula, an exact value spelled out."""
        match formula:
            case Power(base, 1):
                return self._written(base)
            case Derivative(operand) if self.printer.discrete and not isinstance(operand, Letter):
                return self._written(shifted(operand))
            case Literal(Scalar() as value):
                return formula if is_leaf(value) else formula_of(value, self.printer.variable)
            case Literal(Matrix() as table):
                return formula_of_matrix(table, self.printer.variable)
        return formula

    def _operand(self, formula: Formula, level: Level, room: float) -> list[LinePiece[B]]:
        """Return the pieces of an operand, between parentheses where it binds too loosely."""
        if isinstance(formula, Literal) and isinstance(formula.value, Matrix) and level == Level.ATOM:
            box = self.printer.base(formula)
            return [LinePiece(box)] if box.width <= room else self._matrix(formula, room)
        inner = self.printer.typeset(formula)
        box = self.printer.at_least(level, inner)
        if box.width <= room:
            return [LinePiece(box)]
        if inner.level >= level:
            return self._opened(formula, room)
        return self._between_parentheses(self._opened(formula, room - 2))

    def _argument(self, formula: Formula, room: float) -> list[LinePiece[B]]:
        if isinstance(formula, Block) or (isinstance(formula, Literal) and isinstance(formula.value, Matrix)):
            return self._operand(formula, Level.ATOM, room)
        return self._between_parentheses(self.pieces(formula, room - 2))

    def _between_parentheses(self, pieces: list[LinePiece[B]]) -> list[LinePiece[B]]:
        opening, closing = self.printer.parentheses([piece.box for piece in pieces])
        return self._enclosed(pieces, opening, closing)

    def _enclosed(self, pieces: list[LinePiece[B]], opening: B, closing: B) -> list[LinePiece[B]]:
        first, *rest = pieces
        *body, last = [replace(first, box=self.printer.joined([opening, first.box], Level.ATOM)), *rest]
        return [*body, replace(last, box=self.printer.joined([last.box, closing], Level.ATOM))]

    # -- sums, products, fractions, numbers -----------------------------------------------------------------------

    def _sum(self, formula: Formula, room: float) -> list[LinePiece[B]]:
        pieces: list[LinePiece[B]] = []
        for negative, term in signed_terms(formula, self.printer.variable):
            first, *rest = self._operand(term, Level.PRODUCT, room - 2)
            if pieces:
                sign = self.printer.sign(negative=negative, leading=False)
                first = replace(first, within=sign, at_start=sign)
            pieces += [self._negated(first) if negative and not pieces else first, *rest]
        return pieces

    def _product(self, formula: Formula, room: float) -> list[LinePiece[B]]:
        ((negative, body),) = signed_terms(formula, self.printer.variable, flat=False)
        pieces: list[LinePiece[B]] = []
        is_after_fraction = False
        parts = factors(body, self.printer.variable)
        for index, factor in enumerate(parts):
            whole = self.printer.factor(factor, parts[index + 1] if index + 1 < len(parts) else None)
            fits = whole.width <= room - 2
            first, *rest = [LinePiece(whole)] if fits else self._operand(factor, Level.FRACTION, room - 2)
            first = self._following(pieces, first)
            joined = self._together(pieces[-1], first) if is_after_fraction else None
            if joined is not None and joined.box.width <= room - 2:
                pieces = [*pieces[:-1], joined, *rest]
            else:
                pieces += [first, *rest]
            is_after_fraction = isinstance(self._written(factor), Quotient) and not rest
        return [self._negated(pieces[0]), *pieces[1:]] if negative else pieces

    def _together(self, front: LinePiece[B], piece: LinePiece[B]) -> LinePiece[B]:
        """Return two pieces joined: 1/d stays on the line of its factor."""
        boxes = [front.box, piece.within, piece.box] if piece.within else [front.box, piece.box]
        return replace(front, box=self.printer.joined(boxes, Level.PRODUCT))

    def _quotient(self, formula: Quotient, room: float) -> list[LinePiece[B]]:
        """Return 1/denominator · (numerator), with a name for a wide denominator."""
        printer = self.printer
        ((negative, body),) = signed_terms(formula, self.printer.variable, flat=False)
        if not isinstance(body, Quotient):
            return self._opened(body, room)
        below = printer.typeset(body.denominator)
        if below.width > _WIDEST_DENOMINATOR * room:
            above = printer.typeset(body.numerator)
            if printer.fraction(above, printer.star(1)).width > room - 2:
                above = self._name(self.named, body.numerator)
            pieces = [LinePiece(printer.fraction(above, self._name(self.named, body.denominator)))]
        elif printer.slashes:
            pieces = self._operand(body.numerator, Level.PRODUCT, room - 2)
            slash = printer.slash()
            pieces.append(LinePiece(printer.at_least(Level.POWER, below), slash, slash))
        else:
            pieces = [LinePiece(printer.fraction(printer.leaf(Scalar.of(1)), below))]
            first, *rest = self._operand(body.numerator, Level.FRACTION, room - 2)
            pieces += [self._following(pieces, first), *rest]
        return [self._negated(pieces[0]), *pieces[1:]] if negative else pieces

    def _digits(self, value: Scalar) -> list[LinePiece[B]]:
        """Return a number in runs of digits, with a sign of continuation on each further line."""
        if not value.is_constant:
            return [LinePiece(self.printer.scalar(value))]
        digits = digits_of(value)
        runs = [digits[start : start + _DIGITS_TOGETHER] for start in range(0, len(digits), _DIGITS_TOGETHER)]
        first, *rest = [LinePiece(self.printer.digits(run)) for run in runs]
        return [first, *(replace(piece, at_start=self.printer.continued()) for piece in rest)]

    def _negated(self, piece: LinePiece[B]) -> LinePiece[B]:
        minus = self.printer.sign(negative=True, leading=True)
        return replace(piece, box=self.printer.joined([minus, piece.box], Level.SUM))

    def _following(self, pieces: Sequence[LinePiece[B]], piece: LinePiece[B]) -> LinePiece[B]:
        """Return a factor after those before it."""
        if not pieces:
            return piece
        return replace(piece, within=self.printer.between(pieces[-1].box, piece.box), at_start=self.printer.dot())

    # -- matrices -------------------------------------------------------------------------------------------------

    def _matrix(self, formula: Formula, room: float, head: B | None = None) -> list[LinePiece[B]]:
        """Return the matrix with its widest entries named, or listed row by row if it still does not fit."""
        if isinstance(formula, Block):
            table = partitioned(formula.rows)
            rows = formula.rows if table is None else tuple(map(tuple, table[0]))
        elif isinstance(formula, Literal) and isinstance(formula.value, Matrix):
            rows = tuple(tuple(Literal(entry) for entry in row) for row in formula.value.rows)
        else:
            raise TypeError(formula)
        if len(rows) <= _ROWS_TOGETHER:
            narrow = self._narrowed(rows, room, head)
            if narrow is not None:
                return [LinePiece(narrow)]
        return self._listed(rows, room)

    def _narrowed(self, rows: Sequence[Sequence[Formula]], room: float, head: B | None) -> B | None:
        """Return the table with all entries wider than some bound named, the largest bound that makes it fit."""
        boxes = [[self.printer.block_entry(entry) for entry in row] for row in rows]
        bound = room
        while bound > 1:
            named, stars = dict(self.named), dict(self.stars)
            table = [
                [
                    box if box.width <= bound else self._name(named, entry, self._place(head, i, j, rows))
                    for j, (entry, box) in enumerate(zip(row, line, strict=True))
                ]
                for i, (row, line) in enumerate(zip(rows, boxes, strict=True))
            ]
            whole = self.printer.matrix(table)
            if whole.width <= room:
                self.named = named
                return whole
            self.stars = stars
            bound /= 1.4
        return None

    def _place(self, head: B | None, i: int, j: int, rows: Sequence[Sequence[Formula]]) -> B | None:
        """Return the name of the entry at row i and column j of `head`, counted from 0."""
        if head is None:
            return None
        is_vector = len(rows) == 1 or len(rows[0]) == 1
        return self.printer.entry_of(head, (i + j + 1,) if is_vector else (i + 1, j + 1))

    def _name(self, named: dict[Formula, B], entry: Formula, place: B | None = None) -> B:
        """Return the name of an entry, the same for equal entries: its place, or a star."""
        if entry not in named:
            named[entry] = place or self.printer.star(self._number(entry))
        return named[entry]

    def _number(self, entry: Formula) -> int:
        """Return the number of the star of an entry: its own on this page, or the next."""
        stars = self.printer.stars
        return stars.get(entry) or self.stars.setdefault(entry, len(stars) + len(self.stars) + 1)

    def settle(self) -> None:
        """Keep the stars of this display for the page."""
        self.printer.stars.update(self.stars)

    def _listed(self, rows: Sequence[Sequence[Formula]], room: float) -> list[LinePiece[B]]:
        """Return [a, b; c, d], its entries broken where they must be."""
        comma, semicolon = self.printer.separators()
        pieces: list[LinePiece[B]] = []
        for i, row in enumerate(rows):
            for j, entry in enumerate(row):
                *body, last = self.pieces(entry, room - 2)
                is_end_of_row = j + 1 == len(row)
                if not (is_end_of_row and i + 1 == len(rows)):
                    mark = semicolon if is_end_of_row else comma
                    last = replace(last, box=self.printer.joined([last.box, mark], Level.ATOM))
                pieces += [*body, last]
        return self._enclosed(pieces, *self.printer.brackets())


def _is_table(formula: Formula) -> bool:
    """Return whether a formula is a matrix with its entries written out."""
    if isinstance(formula, Block):
        entries = [entry for row in formula.rows for entry in row]
        return all(
            isinstance(entry.value if isinstance(entry, Literal) else entry, (Quotient, Scalar))
            or contains(entry, (Numeral,))
            for entry in entries
        )
    return isinstance(formula, Literal) and isinstance(formula.value, Matrix)
