"""Layout of displays: relations on one line, packed on several, or aligned at their first sign.

The result is rows; a format only writes them down.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import groupby
from typing import TYPE_CHECKING, Generic

from symobs.formula.tree import is_rounded
from symobs.ground.dataclass import dataclass
from symobs.pages.printers.glyphs import B, Level
from symobs.pages.printers.line_breaking import Breaker

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.tree import Formula, Relation
    from symobs.pages.printers.printer import Printer

#: A left member wider than this part of the line stands on a line of its own.
_WIDEST_LEFT = 0.4
#: An answer of more lines than this is not framed; its name is.
_LONGEST_FRAME = 12
#: Entries are named after a matrix whose own name is not wider than this (in em, or columns).
_WIDEST_HEAD = 8


@dataclass(frozen=True)
class DisplayRow(Generic[B]):
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
        if self.boxed and all({"=", "≈"}.isdisjoint(relation.operators) for relation in relations):
            return self._inequalities(relations)
        last = len(relations) - 1
        whole = [self._on_one_line(relation, is_last=index == last) for index, relation in enumerate(relations)]
        packed = self._packed(whole, self.width)
        if all(row.width <= self.width for row in packed) and (len(packed) == 1 or 2 * len(packed) <= len(whole)):
            return [DisplayRow(None, row) for row in packed], False
        lefts = [self._typeset(relation.members[0]).width for relation in relations]
        margin = max((left for left in lefts if left <= _WIDEST_LEFT * self.width), default=0.0)
        rows: list[DisplayRow[B]] = []
        for index, relation in enumerate(relations):
            rows += self._aligned(relation, margin, is_last=index == last)
        self.breaker.settle()
        return rows, True

    def _inequalities(self, relations: Sequence[Relation]) -> tuple[list[DisplayRow[B]], bool]:
        """Return the rows of an answer that is inequalities: one frame around all of them where they fit."""
        plain = Layout(self.printer, self.width - self._frame(), boxed=False, end="")
        last = len(relations) - 1
        whole = [plain._on_one_line(relation, is_last=index == last) for index, relation in enumerate(relations)]
        lines = self._packed(whole, plain.width)
        if all(line.width <= plain.width for line in lines):
            box = lines[0] if len(lines) == 1 else self.printer.stacked(lines)
            return [DisplayRow(None, self.printer.framed(box))], False
        return plain.rows(relations)

    # -- one line -------------------------------------------------------------------------------------------------

    def _on_one_line(self, relation: Relation, *, is_last: bool) -> B:
        printer = self.printer
        *front, last = relation.members
        boxes = [self._typeset(member) for member in front]
        answer = self._typeset(last)
        boxes.append(printer.framed(answer) if self.boxed and is_last else answer)
        signs = [printer.comparison(operator) for operator in relation.operators]
        parts = [boxes[0], *(part for pair in zip(signs, boxes[1:], strict=True) for part in pair)]
        return printer.joined([*parts, *self._mark(is_last=is_last)], Level.SUM)

    def _mark(self, *, is_last: bool) -> list[B]:
        """Return the punctuation after a relation; none after a frame."""
        mark = ("" if self.boxed else self.end) if is_last else ","
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

    def _aligned(self, relation: Relation, margin: float, *, is_last: bool) -> list[DisplayRow[B]]:
        """Return the rows of one relation, then the definitions of the entries left out."""
        printer, defined = self.printer, len(self.breaker.named)
        framed = self.boxed and is_last
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
        return self._with_definitions(rows, defined, room, is_last=is_last)

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
        self, rows: list[DisplayRow[B]], defined: int, room: float, *, is_last: bool
    ) -> list[DisplayRow[B]]:
        """Add the definitions of the new names, short ones side by side, and the punctuation."""
        is_framed = self.boxed and is_last
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
