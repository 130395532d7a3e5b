"""Line breaking of long formulas.

A formula that fits is one piece.  One that does not is opened: a sum at its terms, a product at its factors, a wide
fraction as 1/denominator before its numerator in parentheses, a number between digits; a matrix keeps its shape, and
entries too wide for it get a name, to be told below.
"""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, Generic

from symobs.exact import Matrix, Scalar
from symobs.formula.tree import (
    Apply,
    At,
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
    is_rounded,
)
from symobs.ground.dataclass import dataclass
from symobs.pages.printers.glyphs import B, Level
from symobs.pages.printers.printer import shifted, signed_terms, with_zero
from symobs.pages.printers.rational_formula import digits_of, is_leaf
from symobs.pages.printers.scalar_formula import factors, formula_of, formula_of_matrix, is_number, partitioned

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.tree import Relation
    from symobs.pages.printers.printer import Printer


_DIGITS_TOGETHER = 30
_ROWS_TOGETHER = 30
#: Lines evened out where the last would be shorter than this part of the width.
_FEW_LINES = (2, 3, 4)
_SHORT_END = 0.3
#: A denominator that takes more of the line than this is not set under a fraction bar.
_WIDEST_DENOMINATOR = 0.7


@dataclass
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
            case At():
                return self._evaluated(formula, room)
        return [LinePiece(self.printer.typeset(formula))]

    def _evaluated(self, formula: Formula, room: float) -> list[LinePiece[B]]:
        """Return the pieces of a value at an instant, the bar behind the last one."""
        printer, instants, operand = self.printer, dict[str, Scalar](), formula
        while isinstance(operand, At):
            instants = {operand.name: operand.instant, **instants}
            operand = operand.operand
        if isinstance(operand, Letter):
            return [LinePiece(printer.typeset(formula))]
        equations = printer.equations(instants)
        nothing = printer.identity()
        bar = printer.evaluated(nothing, equations).width - nothing.width
        pieces = self._operand(operand, Level.POWER, room - bar)
        *body, last = pieces if len(pieces) == 1 else self._between_parentheses(pieces)
        return [*body, replace(last, box=printer.evaluated(last.box, equations))]

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
        return all(is_number(entry) or isinstance(entry, Quotient) or contains(entry, (Numeral,)) for entry in entries)
    return isinstance(formula, Literal) and isinstance(formula.value, Matrix)


# Layout of displays: relations on one line, packed on several, or aligned at their first sign.
#
# The result is rows; a format only writes them down.


#: A left member wider than this part of the line stands on a line of its own.
_WIDEST_LEFT = 0.4
#: An answer of more lines than this is not framed; its name is.
_LONGEST_FRAME = 12
#: Entries are named after a matrix whose own name is not wider than this (in em, or columns).
_WIDEST_HEAD = 8


@dataclass
class DisplayRow(Generic[B]):
    """A line of a display, aligned where `right` begins; a centred line has no `left`."""

    left: B | None
    right: B


class Layout(Generic[B]):
    """The rows of one display of width `width`."""

    def __init__(self, printer: Printer[B], width: float, *, boxed: int, end: str) -> None:
        """Frame the last members of so many relations at the end; close with the punctuation `end`."""
        self.printer = printer
        self.width = width
        self.boxed = boxed
        self.end = end
        self.breaker = Breaker(printer)
        self._members: dict[int, B] = {}

    def _typeset(self, member: Formula) -> B:
        """Return a member of a relation of this display, printed once: on one line, and then among several."""
        box = self._members.get(id(member))
        if box is None:
            box = self._members[id(member)] = self.printer.typeset(member)
        return box

    def rows(self, relations: Sequence[Relation]) -> tuple[list[DisplayRow[B]], bool]:
        """Return the rows, and whether they are aligned (else each is centred)."""
        relations = [self._without_repetition(with_zero(relation)) for relation in relations]
        if self.boxed and all("=" not in each.operators and {*each.operators} != {"≈"} for each in relations):
            return self._inequalities(relations)
        last = len(relations) - 1
        framed = [index > last - self.boxed for index in range(len(relations))]
        whole = [self._on_one_line(each, is_last=i == last, framed=framed[i]) for i, each in enumerate(relations)]
        packed = self._packed(whole, self.width)
        if all(row.width <= self.width for row in packed) and (len(packed) == 1 or 2 * len(packed) <= len(whole)):
            return [DisplayRow(None, row) for row in packed], False
        lefts = [self._typeset(relation.members[0]).width for relation in relations]
        margin = max((left for left in lefts if left <= _WIDEST_LEFT * self.width), default=0.0)
        rows: list[DisplayRow[B]] = []
        for index, relation in enumerate(relations):
            rows += self._aligned(relation, margin, is_last=index == last, framed=framed[index])
        self.breaker.settle()
        return rows, True

    def _without_repetition(self, relation: Relation) -> Relation:
        """Return a relation without members that are printed as the one before them: 3 · 1 beside 3."""
        members, operators = relation.members, relation.operators
        if len(members) == 2:
            return relation
        boxes = [replace(self._typeset(member), level=Level.SUM) for member in members]
        kept = [i for i in range(len(members)) if i < 2 or operators[i - 1] != "=" or boxes[i] != boxes[i - 1]]
        return replace(
            relation,
            members=tuple(members[i] for i in kept),
            operators=tuple(operators[i - 1] for i in kept[1:]),
        )

    def _inequalities(self, relations: Sequence[Relation]) -> tuple[list[DisplayRow[B]], bool]:
        """Return the rows of an answer that is inequalities: one frame around all of them where they fit."""
        plain = Layout(self.printer, self.width - self._frame(), boxed=0, end="")
        last = len(relations) - 1
        whole = [plain._on_one_line(each, is_last=i == last, framed=False) for i, each in enumerate(relations)]
        lines = self._packed(whole, plain.width)
        if all(line.width <= plain.width for line in lines):
            box = lines[0] if len(lines) == 1 else self.printer.stacked(lines)
            return [DisplayRow(None, self.printer.framed(box))], False
        return plain.rows(relations)

    # -- one line -------------------------------------------------------------------------------------------------

    def _on_one_line(self, relation: Relation, *, is_last: bool, framed: bool) -> B:
        printer = self.printer
        *front, last = relation.members
        boxes = [self._typeset(member) for member in front]
        answer = self._typeset(last)
        boxes.append(printer.framed(answer) if framed else answer)
        signs = [printer.comparison(operator) for operator in relation.operators]
        parts = [boxes[0], *(part for pair in zip(signs, boxes[1:], strict=True) for part in pair)]
        return printer.joined([*parts, *self._mark(is_last=is_last, framed=framed)], Level.SUM)

    def _mark(self, *, is_last: bool, framed: bool) -> list[B]:
        """Return the punctuation after a relation; none after a frame."""
        mark = "" if framed else self.end if is_last else ","
        return [self.printer.punctuation(mark)] if mark else []

    def _packed(self, whole: Sequence[B], width: float) -> list[B]:
        """Return rows, each filled with as many boxes as fit."""
        lines: list[list[B]] = []
        for box in whole:
            longer = [*lines[-1], self.printer.gap(), box] if lines else [box]
            if lines and sum(part.width for part in longer) <= width:
                lines[-1] = longer
            else:
                lines.append([box])
        return [self.printer.joined(parts, Level.SUM) for parts in lines]

    # -- aligned --------------------------------------------------------------------------------------------------

    def _aligned(self, relation: Relation, margin: float, *, is_last: bool, framed: bool) -> list[DisplayRow[B]]:
        """Return the rows of one relation, then the definitions of the entries left out."""
        printer, defined = self.printer, len(self.breaker.named)
        left = self._typeset(relation.members[0])
        head = left if left.width <= _WIDEST_HEAD else None
        room = self.width - margin - printer.punctuation(",").width - (self._frame() if framed else 0.0)
        links = list(zip(relation.operators, relation.members[1:], strict=True))
        if left.width <= margin:
            rights, has_frame = self._links(links, room, head, framed=framed)
            left = left if has_frame or not framed else printer.framed(left)
            rows = [DisplayRow(left, rights[0]), *(DisplayRow(None, right) for right in rights[1:])]
        else:
            indent = printer.indent()
            space = room - indent.width
            lines = self.breaker.lines(self.breaker.pieces(relation.members[0], space), room, space)
            rights, _ = self._links(links, space, head, framed=framed)
            followers = [printer.joined([indent, line], Level.SUM) for line in [*lines[1:], *rights]]
            rows = [DisplayRow(None, line) for line in [lines[0], *followers]]
        return self._with_definitions(rows, defined, room, is_last=is_last, is_framed=framed)

    def _frame(self) -> float:
        """Return the width a frame adds."""
        indent = self.printer.indent()
        return self.printer.framed(indent).width - indent.width

    def _links(
        self, links: Sequence[tuple[str, Formula]], room: float, head: B | None, *, framed: bool
    ) -> tuple[list[B], bool]:
        """Return the lines of = b = c …, filled link by link, and whether the answer is framed."""
        printer = self.printer
        finished: list[B] = []
        line: list[B] = []
        has_frame = framed
        for index, (operator, member) in enumerate(links):
            is_answer = framed and index + 1 == len(links)
            sign, box = printer.comparison(operator), self._typeset(member)
            if is_answer:
                box = printer.framed(box)
            if line and sum(part.width for part in line) + sign.width + box.width > room:
                finished.append(printer.joined(line, Level.SUM))
                line = []
            if sign.width + box.width <= room:
                line += [sign, box]
            else:
                lines = self._broken(sign, member, room, head, framed=is_answer)
                has_frame = len(lines) == 1 if is_answer else has_frame
                finished += lines[:-1]
                line = [lines[-1]]
        return [*finished, printer.joined(line, Level.SUM)], has_frame

    def _broken(self, sign: B, member: Formula, room: float, head: B | None, *, framed: bool) -> list[B]:
        """Return the lines of one link; a frame makes one box of them while they are few."""
        printer, indent = self.printer, self.printer.indent()
        around = printer.framed(printer.stacked([indent])).width if framed else 0.0
        space = room - max(sign.width, indent.width) - around
        lines = self.breaker.lines(self.breaker.pieces(member, space, head), space, space)
        if framed and len(lines) <= _LONGEST_FRAME:
            answer = lines[0] if len(lines) == 1 else printer.stacked(lines)
            return [printer.joined([sign, printer.framed(answer)], Level.SUM)]
        first, *rest = lines
        return [printer.joined(pair, Level.SUM) for pair in [(sign, first), *((indent, line) for line in rest)]]

    def _with_definitions(
        self, rows: list[DisplayRow[B]], defined: int, room: float, *, is_last: bool, is_framed: bool
    ) -> list[DisplayRow[B]]:
        """Add the definitions of the new names, short ones side by side, and the punctuation."""
        mark = self.end if is_last else ","
        if defined == len(self.breaker.named):
            return [*rows[:-1], rows[-1] if is_framed else self._marked(rows[-1], mark)]
        groups: list[list[B]] = []
        while defined + len(groups) < len(self.breaker.named):
            entry, name = list(self.breaker.named.items())[defined + len(groups)]
            groups.append(self._definition(name, entry, room))
        comma, closing = (self.printer.punctuation(sign) if sign else None for sign in (",", mark))
        for index, group in enumerate(groups):
            after = comma if index + 1 < len(groups) else closing
            group[-1] = group[-1] if after is None else self.printer.joined([group[-1], after], Level.SUM)
        added: list[B] = []
        for are_short, run in groupby(groups, key=lambda group: len(group) == 1):
            lines = [line for group in run for line in group]
            added += self._packed(lines, room + self.printer.punctuation(",").width) if are_short else lines
        first = rows[-1] if is_framed else self._marked(rows[-1], ",")
        return [*rows[:-1], first, *(DisplayRow(None, line) for line in added)]

    def _definition(self, name: B, entry: Formula, room: float) -> list[B]:
        """Return the lines of name = entry."""
        printer, indent = self.printer, self.printer.indent()
        sign = printer.joined([name, printer.comparison("≈" if is_rounded(entry) else "=")], Level.SUM)
        space = room - max(sign.width, indent.width)
        first, *rest = self.breaker.lines(self.breaker.pieces(entry, space), space, space)
        return [printer.joined(pair, Level.SUM) for pair in [(sign, first), *((indent, line) for line in rest)]]

    def _marked(self, row: DisplayRow[B], mark: str) -> DisplayRow[B]:
        """Return a row with a punctuation mark at its end."""
        if not mark:
            return row
        return replace(row, right=self.printer.joined([row.right, self.printer.punctuation(mark)], Level.SUM))


# Widths of LaTeX mathematics in Computer Modern, in em, for line breaking.


TEXT_WIDTH = 40.0  # the line of the template is 41.5 em
SCRIPT = 0.74
DIGIT = 0.5
OPERATOR = 1.23
SIGN = 0.78
RELATION = 1.34
COLUMN_GAP = 0.92
BRACKETS = 1.2
FRACTION_BAR = 0.25
FRAME = 0.75


_MATH_ITALIC = {
    **dict(zip("abcdefghi", (0.53, 0.43, 0.44, 0.53, 0.47, 0.57, 0.5, 0.58, 0.35), strict=True)),
    **dict(zip("jklmnopqr", (0.44, 0.54, 0.31, 0.88, 0.6, 0.49, 0.51, 0.47, 0.47), strict=True)),
    **dict(zip("stuvwxyz", (0.47, 0.37, 0.58, 0.5, 0.73, 0.58, 0.51, 0.48), strict=True)),
    **dict(zip("ABCDEFGHI", (0.75, 0.78, 0.76, 0.83, 0.77, 0.76, 0.79, 0.9, 0.49), strict=True)),
    **dict(zip("JKLMNOPQR", (0.63, 0.9, 0.69, 1.06, 0.9, 0.77, 0.74, 0.8, 0.77), strict=True)),
    **dict(zip("STUVWXYZ", (0.65, 0.7, 0.77, 0.77, 1.07, 0.89, 0.76, 0.73), strict=True)),
}


_PUNCTUATION = {"(": 0.39, ")": 0.39, "[": 0.28, "]": 0.28, ",": 0.45, ".": 0.28, " ": 0.0, "-": 1.0, "+": 1.0}


_WIDTHLESS = frozenset(
    (
        *("hat", "dot", "ddot", "bar", "tilde", "vec", "check", "acute", "grave", "breve", "mathstrut"),
        *("mathcal", "mathrm", "mathit", "mathbf", "mathsf", "mathbb", "boldsymbol", "text", "operatorname"),
        *("left", "right", "big", "bigl", "bigr", "displaystyle", "textstyle"),
    )
)


_FUNCTIONS = {"sin": 1.23, "cos": 1.34, "sinh": 1.79, "cosh": 1.9}  # the space after them is the argument's


_COMMANDS = {
    **_FUNCTIONS,
    "iota": 0.36,
    "det": 1.4,
    "quad": 1.0,
    "qquad": 2.0,
    "psi": 0.69,
    "Omega": 0.73,
    "prime": 0.28,
}


_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[\^_{}]|.", re.DOTALL)


def source_width(source: str) -> float:
    """Return the width of a symbol's LaTeX: letters, commands, accents, sub- and superscripts."""
    width, scales, scale = 0.0, [1.0], 1.0
    for part in _TOKEN.findall(source):
        if part in "^_":
            scale = scales[-1] * SCRIPT
        elif part == "{":
            scales.append(scale)
        elif part == "}":
            scales = scales[:-1] or [1.0]
            scale = scales[-1]
        elif part[1:] not in _WIDTHLESS:
            width += scale * _token_width(part)
            scale = scales[-1]
    return width


def _token_width(token: str) -> float:
    if token.startswith("\\"):
        return _COMMANDS.get(token[1:], 0.66) if len(token) > 2 else 0.3
    if token.isdigit():
        return DIGIT
    return _MATH_ITALIC.get(token, _PUNCTUATION.get(token, 0.8))
