"""Block diagrams in characters of a terminal, with boxes of rules and signs at junctions."""

from __future__ import annotations

from math import floor, inf
from typing import TYPE_CHECKING

from symobs.formula import Conjunction
from symobs.render.diagrams.diagram_layout import Arrangement, Metrics, arranged
from symobs.render.printers.text_printer import text_width

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.figures.block_diagram import Label
    from symobs.render.diagrams.diagram_layout import DiagramBox, DiagramMark, Line, Point, SignMark
    from symobs.render.page.blocks import Drawing
    from symobs.render.printers.text_printer import TextPrinter

#: A wire's character by the sides of the cell that it goes to.
_RULES = {
    "LR": "─", "DU": "│", "DR": "┌", "DL": "┐", "RU": "└", "LU": "┘",
    "DRU": "├", "DLU": "┤", "DLR": "┬", "LRU": "┴", "DLRU": "┼", "L": "─", "R": "─", "U": "│", "D": "│",
}  # fmt: skip
_HEADS = {(1, 0): "▶", (-1, 0): "◀", (0, 1): "▼", (0, -1): "▲"}
_SIDES = {(1, 0): "R", (-1, 0): "L", (0, 1): "D", (0, -1): "U"}
_OPPOSITE = {"R": "L", "L": "R", "D": "U", "U": "D"}
#: Gaps between columns: the widest with which all labels can be drawn, else the widest with letters instead.
_GAPS = (4, 3, 2)


def sketch(drawing: Drawing, printer: TextPrinter, width: int) -> str:
    """Return a diagram, if possible at most `width` columns wide."""
    arrangements = (
        arranged(drawing, cells_of(printer, gap), room, discrete=printer.discrete)
        for room in (inf, float(width))
        for gap in _GAPS
    )
    fitting = (arrangement for arrangement in arrangements if arrangement.size[0] <= width)
    smallest = cells_of(printer, _GAPS[-1])
    chosen = next(fitting, None) or arranged(drawing, smallest, width, discrete=printer.discrete)
    return _Canvas(chosen, printer).text()


def _rows(label: Label, printer: TextPrinter) -> list[str]:
    if isinstance(label, Conjunction):
        return [printer.inline(relation) for relation in label.relations]
    return [printer.inline(label)]


def cells_of(printer: TextPrinter, gap: int) -> Metrics:
    """Return the measures of a terminal: odd widths and heights, so that every node has a middle cell."""

    def measure(label: Label) -> Point:
        rows = _rows(label, printer)
        return max(map(text_width, rows)) // 2 * 2 + 1, 2 * len(rows) - 1

    return Metrics(measure, inside=(2, 1), smallest=3, junction=1, gap=(gap, 1), beside=1, point=1, sign=4, rates=False)


class _Canvas:
    """A grid of characters; a cell of wires records their directions."""

    def __init__(self, arrangement: Arrangement, printer: TextPrinter) -> None:
        self.printer = printer
        self.cells: dict[tuple[int, int], str] = {}
        self.sides: dict[tuple[int, int], set[str]] = {}
        for line in arrangement.lines:
            self.draw(line)
        for cell, sides in self.sides.items():
            self.cells.setdefault(cell, _RULES["".join(sorted(sides))])
        for place in arrangement.branches:
            cell = _cell(place)
            self.cells[cell] = _RULES["".join(sorted(self.sides[cell]))].replace("┼", "●")
        for box in arrangement.boxes:
            self.draw_box(box)
        for place in arrangement.junctions:
            self.cells[_cell(place)] = "○"
        for mark in arrangement.marks:
            self.write_mark(mark)
        for sign in arrangement.signs:
            self.write_sign(sign)

    def text(self) -> str:
        """Return the lines, none with spaces at its end."""
        rows = [row for _, row in self.cells]
        right = max(column for column, _ in self.cells)
        lines = (
            "".join(
                self.cells.get((column, row), " ") for column in range(min(0, *(c for c, _ in self.cells)), right + 1)
            )
            for row in range(min(rows), max(rows) + 1)
        )
        return "\n".join(line.rstrip() for line in lines)

    def draw(self, line: Line) -> None:
        """Draw a wire with the head of its arrow."""
        last = len(line.points) - 2
        for index in range(last + 1):
            begin, end = line.points[index : index + 2]
            cells = list(_between(begin, end))
            if not cells:
                continue
            step = _direction(begin, end)
            ahead, back = _SIDES[step], _OPPOSITE[_SIDES[step]]
            for cell in cells:
                sides = self.sides.setdefault(cell, set())
                sides |= {ahead} if cell != cells[-1] or not _is_middle(end) else set()
                sides |= {back} if cell != cells[0] or not _is_middle(begin) else set()
            if index == last and line.is_arrow:
                self.cells[cells[-1]] = _HEADS[step]

    def draw_box(self, box: DiagramBox) -> None:
        """Draw a box with its lines in the middle."""
        (x, y), (width, height) = box.centre, box.size
        left, right = floor(x - width / 2), floor(x + width / 2) - 1
        top, bottom = floor(y - height / 2), floor(y + height / 2) - 1
        for column in range(left + 1, right):
            self.cells[column, top] = self.cells[column, bottom] = "─"
        for row in range(top + 1, bottom):
            self.cells[left, row] = self.cells[right, row] = "│"
        corners = ((left, top), (right, top), (left, bottom), (right, bottom))
        self.cells |= dict(zip(corners, "┌┐└┘", strict=True))
        self.write_rows(_rows(box.label, self.printer), box.centre)

    def write_rows(self, rows: list[str], centre: Point) -> None:
        """Write lines centred at a place, separated by empty ones."""
        column, row = _cell(centre)
        for index, text in enumerate(rows):
            self.write(text, column - (text_width(text) - 1) // 2, row - len(rows) + 1 + 2 * index)

    def write(self, text: str, column: int, row: int) -> None:
        """Write characters from a cell on, accents in the cells of their letters."""
        for character in text:
            if text_width(character):
                self.cells[column, row] = character
                column += 1
            else:
                self.cells[column - 1, row] += character

    def write_mark(self, mark: DiagramMark) -> None:
        """Write a signal at its wire."""
        column, row = _cell(mark.place)
        if mark.side == "right":
            self.write(_rows(mark.label, self.printer)[0], column + 2, row)
        else:
            self.write_rows(_rows(mark.label, self.printer), (mark.place[0], mark.place[1] - (mark.side == "above")))

    def write_sign(self, sign: SignMark) -> None:
        """Write a sign beside the head of an arrow."""
        (x, y), (across, down) = sign.place, sign.towards
        glyph = "−" if sign.is_negative else "+"
        column, row = floor(x - across / 2), floor(y - down / 2)
        if across:
            self.write(glyph, column - int(across), row - 1)
        else:
            is_taken = (column + 2, row) in self.cells  # by what is written over the wire that leaves the junction
            self.write(glyph, column + 2, row - is_taken)


def _cell(place: Point) -> tuple[int, int]:
    return floor(place[0]), floor(place[1])


def _is_middle(place: Point) -> bool:
    """Return whether a place is the middle of a cell and not the border of a box."""
    return place[0] % 1 == 0.5 and place[1] % 1 == 0.5


def _direction(begin: Point, end: Point) -> tuple[int, int]:
    across, down = end[0] - begin[0], end[1] - begin[1]
    return (across > 0) - (across < 0), (down > 0) - (down < 0)


def _between(begin: Point, end: Point) -> Iterator[tuple[int, int]]:
    """Yield the cells with their middles on a segment, in its direction."""
    axis = 0 if begin[1] == end[1] else 1
    low, high = sorted((begin[axis], end[axis]))
    indices = [index for index in range(floor(low), floor(high) + 1) if low <= index + 0.5 <= high]
    for index in indices if begin[axis] <= end[axis] else reversed(indices):
        yield (index, floor(begin[1])) if axis == 0 else (floor(begin[0]), index)
