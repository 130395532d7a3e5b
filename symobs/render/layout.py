"""How relations share a display: on one line, packed on several, or aligned at their first sign.

The result is rows; a format only writes them down.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Generic

from symobs.render.breaking import Breaker
from symobs.render.glyphs import B, Level

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula import Formula, Relation
    from symobs.render.printer import Printer

#: A left member wider than this part of the line stands on a line of its own.
_WIDEST_LEFT = 0.4
#: An answer of more lines than this is not framed; its name is.
_LONGEST_FRAME = 12
#: Entries are named after a matrix whose own name is not wider than this (in em, or columns).
_WIDEST_HEAD = 8


@dataclass(frozen=True)
class Row(Generic[B]):
    """A line of a display, aligned where `right` begins; a centred line has no `left`."""

    left: B | None
    right: B


class Layout(Generic[B]):
    """The rows of one display of width `width`."""

    def __init__(self, printer: Printer[B], width: float, *, boxed: bool, end: str) -> None:
        """Frame the last member of the last relation if `boxed`; close with the punctuation `end`."""
        self.printer = printer
        self.width = width
        self.boxed = boxed
        self.end = end

    def rows(self, relations: Sequence[Relation]) -> tuple[list[Row[B]], bool]:
        """Return the rows, and whether they are aligned (else each is centred)."""
        whole = [self._on_one_line(relation, is_last=relation is relations[-1]) for relation in relations]
        packed = self._packed(whole)
        if all(row.width <= self.width for row in packed) and (len(packed) == 1 or 2 * len(packed) <= len(whole)):
            return [Row(None, row) for row in packed], False
        lefts = [self.printer.typeset(relation.members[0]).width for relation in relations]
        margin = max((left for left in lefts if left <= _WIDEST_LEFT * self.width), default=0.0)
        rows: list[Row[B]] = []
        for relation in relations:
            rows += self._aligned(relation, margin, is_last=relation is relations[-1])
        return rows, True

    # -- one line -------------------------------------------------------------------------------------------------

    def _on_one_line(self, relation: Relation, *, is_last: bool) -> B:
        printer = self.printer
        *front, last = relation.members
        boxes = [printer.typeset(member) for member in front]
        answer = printer.typeset(last)
        boxes.append(printer.framed(answer) if self.boxed and is_last else answer)
        signs = [printer.comparison(operator) for operator in relation.operators]
        parts = [boxes[0], *(part for pair in zip(signs, boxes[1:], strict=True) for part in pair)]
        return printer.joined([*parts, *self._mark(is_last=is_last)], Level.SUM)

    def _mark(self, *, is_last: bool) -> list[B]:
        """The punctuation after a relation; none after a frame."""
        mark = ("" if self.boxed else self.end) if is_last else ","
        return [self.printer.punctuation(mark)] if mark else []

    def _packed(self, whole: Sequence[B]) -> list[B]:
        """As many relations on a line as fit."""
        lines: list[list[B]] = []
        for box in whole:
            longer = [*lines[-1], self.printer.gap(), box] if lines else [box]
            if lines and sum(part.width for part in longer) <= self.width:
                lines[-1] = longer
            else:
                lines.append([box])
        return [self.printer.joined(parts, Level.SUM) for parts in lines]

    # -- aligned --------------------------------------------------------------------------------------------------

    def _aligned(self, relation: Relation, margin: float, *, is_last: bool) -> list[Row[B]]:
        """The rows of one relation, then those of what its matrices left out."""
        printer, breaker = self.printer, Breaker(self.printer)
        left = printer.typeset(relation.members[0])
        room = self.width - margin
        rows: list[Row[B]] = []
        links = list(zip(relation.operators, relation.members[1:], strict=True))
        head = left if left.width <= _WIDEST_HEAD else None
        if left.width <= margin:
            rights = self._links(breaker, links, room, head, framed=self.boxed and is_last)
            rows.append(Row(left, rights[0]))
            rows += [Row(None, right) for right in rights[1:]]
        else:
            indent = printer.indent()
            lines = breaker.lines(breaker.pieces(relation.members[0], room - indent.width), room, room - indent.width)
            rights = self._links(breaker, links, room - indent.width, head, framed=self.boxed and is_last)
            rows.append(Row(None, lines[0]))
            rows += [Row(None, printer.joined([indent, line], Level.SUM)) for line in [*lines[1:], *rights]]
        return self._told(rows, breaker, room, is_last=is_last)

    def _links(
        self, breaker: Breaker[B], links: Sequence[tuple[str, Formula]], room: float, head: B | None, *, framed: bool
    ) -> list[B]:
        """= b = c …: as many links on a line as fit, a link that fits on none broken."""
        printer = self.printer
        finished: list[B] = []
        line: list[B] = []
        for index, (operator, member) in enumerate(links):
            sign, box = printer.comparison(operator), printer.typeset(member)
            is_answer = framed and index + 1 == len(links)
            if is_answer:
                box = printer.framed(box)
            if line and sum(part.width for part in line) + sign.width + box.width <= room:
                line += [sign, box]
                continue
            if line:
                finished.append(printer.joined(line, Level.SUM))
            line = [sign, box]
            if sign.width + box.width > room:
                *broken, last = self._broken(breaker, sign, member, room, head, framed=is_answer)
                finished += broken
                line = [last]
        return [*finished, printer.joined(line, Level.SUM)]

    def _broken(
        self, breaker: Breaker[B], sign: B, member: Formula, room: float, head: B | None, *, framed: bool
    ) -> list[B]:
        """The lines of one link; a frame goes round all of them while they are few."""
        printer, indent = self.printer, self.printer.indent()
        frame = printer.framed(printer.indent()).width - indent.width if framed else 0.0
        space = room - max(sign.width, indent.width) - frame - (indent.width if framed else 0.0)
        lines = breaker.lines(breaker.pieces(member, space, head), space, space)
        if framed and len(lines) <= _LONGEST_FRAME:
            answer = lines[0] if len(lines) == 1 else printer.stacked(lines)
            return [printer.joined([sign, printer.framed(answer)], Level.SUM)]
        first, *rest = lines
        return [printer.joined(pair, Level.SUM) for pair in [(sign, first), *((indent, line) for line in rest)]]

    def _told(self, rows: list[Row[B]], breaker: Breaker[B], room: float, *, is_last: bool) -> list[Row[B]]:
        """Add what the names in matrices stand for, and the punctuation."""
        printer, indent = self.printer, self.printer.indent()
        told = 0
        while told < len(breaker.named):
            name, entry = breaker.named[told]
            rows[-1] = self._with(rows[-1], ",")
            sign = printer.joined([name, printer.comparison("=")], Level.SUM)
            space = room - max(sign.width, indent.width)
            first, *rest = breaker.lines(breaker.pieces(entry, space), space, room - indent.width)
            rows.append(Row(None, printer.joined([sign, first], Level.SUM)))
            rows += [Row(None, printer.joined([indent, line], Level.SUM)) for line in rest]
            told += 1
        is_framed = self.boxed and is_last and not told
        return [*rows[:-1], rows[-1] if is_framed else self._with(rows[-1], self.end if is_last else ",")]

    def _with(self, row: Row[B], mark: str) -> Row[B]:
        """A row closed by a punctuation mark."""
        if not mark:
            return row
        return replace(row, right=self.printer.joined([row.right, self.printer.punctuation(mark)], Level.SUM))
