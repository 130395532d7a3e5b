"""The writer of text: diagrams in boxes of rules, and plots sampled at the characters of a terminal."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import floor, inf
from typing import TYPE_CHECKING, assert_never

from symobs.formula.figures import (
    BodePicture,
    BranchPicture,
    LinePicture,
    NyquistPicture,
    PoleMap,
    RegionPicture,
    TimeResponse,
)
from symobs.formula.tree import Conjunction, Formula, Literal
from symobs.pages.drawings.curve_labels import contains
from symobs.pages.drawings.diagram_layout import Metrics, diagram_scene
from symobs.pages.drawings.plot_layout import decade_ticks, ticks
from symobs.pages.drawings.scene import STYLES
from symobs.pages.page.blocks import Drawing
from symobs.pages.page.plot_captions import name_of, part, radius_of, symbol, time_axis
from symobs.pages.printers.text_printer import text_width

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from symobs.formula.figures import Interval, Label, Picture, Place
    from symobs.pages.drawings.scene import Box, Content, Point, Scene, Sign, Stroke, TextLabel
    from symobs.pages.printers.text_printer import TextPrinter

_COLUMNS, _ROWS, _LINE = 41, 17, 61
#: Areas end close to the lines at which the plane was cut.  Where two stand this part of the window on either side of a
#: place, and no curve is drawn between them, the place belongs to the region as they do.
_SEAM = 1 / 800
#: What responses are drawn with, one by one.
_CHARACTERS = "*o+x#@"
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


def sketch(item: Drawing | Picture, printer: TextPrinter, width: int) -> str:
    """Return a diagram or a plot in characters of a terminal, if possible at most `width` columns wide."""
    match item:
        case Drawing():
            return _diagram(item, printer, width)
        case RegionPicture():
            return _region(item, printer)
        case LinePicture():
            return _line(item, printer, min(_LINE, width - 4))
        case PoleMap():
            return _poles(item, printer)
        case TimeResponse():
            return _responses(item, printer)
        case NyquistPicture():
            return _nyquist(item, printer)
        case BodePicture():
            return _bode(item, printer)
        case BranchPicture():
            return _branches(item, printer)
        case _:
            assert_never(item)


# -- the plane --------------------------------------------------------------------------------------------------------


def _region(picture: RegionPicture, printer: TextPrinter) -> str:
    """Return the grid of a region: `#` where stable, `.` elsewhere."""
    areas = [[(float(x), float(y)) for x, y in area] for area in picture.areas]

    curves = [[(float(x), float(y)) for x, y in curve.points] for curve in picture.curves]
    across, upwards = (float(high - low) * _SEAM for low, high in picture.window)

    def filled(x: float, y: float) -> bool:
        return any(contains(area, (x, y)) for area in areas)

    def on_seam(x: float, y: float) -> bool:
        ways = ((x - across, y), (x + across, y)), ((x, y - upwards), (x, y + upwards))
        return any(filled(*a) and filled(*b) and not any(_crosses(c, a, b) for c in curves) for a, b in ways)

    def character(x: float, y: float) -> str:
        return "#" if filled(x, y) or on_seam(x, y) else "."

    grid = _grid(picture.window, character)
    for mark in picture.marks:
        if mark.kind == "excluded":
            _put(grid, picture.window, mark.place, "o")
    return _framed(grid, picture.window, [symbol(name) for name in picture.axes], printer)


def _crosses(line: Sequence[Point], a: Point, b: Point) -> bool:
    """Return whether a line that is drawn meets the segment from a to b, or touches it."""

    def side(p: Point, q: Point, place: Point) -> float:
        return (q[0] - p[0]) * (place[1] - p[1]) - (q[1] - p[1]) * (place[0] - p[0])

    return any(side(a, b, p) * side(a, b, q) <= 0 and side(p, q, a) * side(p, q, b) <= 0 for p, q in pairwise(line))


def _poles(picture: PoleMap, printer: TextPrinter) -> str:
    """Return the grid of a pole map: `*` for paths, `x` and `o` for begin and end, `:` where poles are stable."""
    edge = float(picture.margin or 0)

    def character(x: float, y: float) -> str:
        is_stable = x * x + y * y < float(radius_of(picture)) ** 2 if picture.discrete else x < -edge
        return ":" if is_stable else " "

    grid = _grid(picture.window, character)
    for path in picture.paths:
        for place in path:
            _put(grid, picture.window, place, "*")
    for path in picture.paths:
        _put(grid, picture.window, path[0], "x")
    for place in [path[-1] for path in picture.paths] if picture.zeros is None else picture.zeros:
        _put(grid, picture.window, place, "o")
    return _framed(grid, picture.window, [part("Re"), part("Im")], printer)


def _nyquist(picture: NyquistPicture, printer: TextPrinter) -> str:
    """Return the grid of a frequency response: `*` for positive, `.` for negative frequencies, `x` for −1."""
    grid = _grid(picture.window, lambda _x, _y: " ")
    for (x, y), (u, v) in pairwise(picture.values):
        for k in range(9):
            place = x + (u - x) * k / 8, y + (v - y) * k / 8
            _put(grid, picture.window, (place[0], -place[1]), ".")
            _put(grid, picture.window, place, "*")
    _put(grid, picture.window, (Fraction(-1), Fraction(0)), "x")
    return _framed(grid, picture.window, [symbol("Re"), symbol("Im")], printer)


def _branches(picture: BranchPicture, printer: TextPrinter) -> str:
    """Return the grid of equilibria over a parameter: `*` where they are stable, `.` where not, `o` at branch points."""
    grid = _grid(picture.window, lambda _x, _y: " ")
    for branch in picture.branches:
        for (x, y), (u, v) in pairwise(branch.points):
            for k in range(9):
                _put(grid, picture.window, (x + (u - x) * k / 8, y + (v - y) * k / 8), "*" if branch.stable else ".")
    for place, _ in picture.marks:
        _put(grid, picture.window, place, "o")
    return _framed(grid, picture.window, [*map(symbol, picture.axes)], printer)


def _bode(picture: BodePicture, printer: TextPrinter) -> str:
    """Return the grids of modulus and phase over the logarithm of the frequency."""
    drawn, across = [], picture.window[0]
    phases = min(picture.phases), max(*picture.phases, min(picture.phases) + 1)
    for name, heights, ends in (("dB", picture.levels, picture.window[1]), ("deg", picture.phases, phases)):
        grid = _grid((across, ends), lambda _x, _y: " ")
        for (x, y), (u, v) in pairwise(picture.asymptotes) if name == "dB" else ():
            for k in range(_COLUMNS):
                _put(grid, (across, ends), (x + (u - x) * k / _COLUMNS, y + (v - y) * k / _COLUMNS), ".")
        for place in zip(picture.across, heights, strict=True):
            _put(grid, (across, ends), place, "*")
        axis = "theta" if picture.discrete else "omega"
        drawn.append(f"{name}\n{_framed(grid, (across, ends), [symbol(axis)], printer, decades=True)}")
    return "\n\n".join(drawn)


def _responses(picture: TimeResponse, printer: TextPrinter) -> str:
    """Return the grid of responses, a character for each with a legend above."""
    grid = _grid(picture.window, lambda _x, _y: " ")
    if picture.window[1][0] < 0 < picture.window[1][1]:
        grid[_row(picture.window[1], Fraction(0))] = ["┈"] * _COLUMNS
    marks = list(zip(picture.responses, _CHARACTERS, strict=False))
    for response, mark in reversed(marks):
        for place in picture.points(response):
            _put(grid, picture.window, place, mark)
    legend = "   ".join(f"{mark} {printer.inline(name_of(response))}" for response, mark in marks)
    return f"{legend}\n{_framed(grid, picture.window, [symbol(time_axis(picture))], printer)}"


def _grid(window: tuple[Interval, Interval], character: Callable[[float, float], str]) -> list[list[str]]:
    """Return the character of every cell by its middle, the top row first."""
    (left, right), (bottom, top) = (tuple(map(float, interval)) for interval in window)
    xs = [left + (right - left) * (column + 0.5) / _COLUMNS for column in range(_COLUMNS)]
    ys = [top - (top - bottom) * (row + 0.5) / _ROWS for row in range(_ROWS)]
    return [[character(x, y) for x in xs] for y in ys]


def _put(grid: list[list[str]], window: tuple[Interval, Interval], place: Place, character: str) -> None:
    across, upwards = window
    if across[0] <= place[0] <= across[1] and upwards[0] <= place[1] <= upwards[1]:
        grid[_row(upwards, place[1])][_column(across, place[0])] = character


def _column(across: Interval, place: Fraction) -> int:
    return min(int((place - across[0]) / (across[1] - across[0]) * _COLUMNS), _COLUMNS - 1)


def _row(upwards: Interval, place: Fraction) -> int:
    return min(int((upwards[1] - place) / (upwards[1] - upwards[0]) * _ROWS), _ROWS - 1)


def _framed(
    grid: list[list[str]],
    window: tuple[Interval, Interval],
    names: Sequence[Formula],
    printer: TextPrinter,
    *,
    decades: bool = False,
) -> str:
    """Return the rows with axes, their names and round numbers, those below of logarithms with `decades`."""
    marked = (decade_ticks if decades else ticks, ticks)
    first, second = ([printer.inline(name) for name in names] + [""])[:2]
    below, beside = (
        {
            find(ends, Fraction(value)): printer.language.decimal(text)
            for value, text in numbers_of(float(ends[0]), float(ends[1]))
        }
        for find, ends, numbers_of in zip((_column, _row), window, marked, strict=True)
    )
    margin = max(map(len, beside.values()))
    lines = [f"{' ' * margin} {second}"] if second else []
    for row, characters in enumerate(grid):
        lines.append(f"{beside.get(row, ''):>{margin}} {'┤' if row in beside else '│'}{''.join(characters)}")
    bottom = "".join("┬" if column in below else "─" for column in range(_COLUMNS))
    numbers = (f"{' ' * margin}  {row}" for row in _rows(below, _COLUMNS))
    return "\n".join([*lines, f"{' ' * margin} └{bottom} {first}", *numbers])


# -- the line ---------------------------------------------------------------------------------------------------------


def _line(picture: LinePicture, printer: TextPrinter, width: int) -> str:
    """Return a line of intervals: `━` where stable, `○` at the excluded ends, with rows of labels below."""
    low, high = picture.window

    def column(value: Fraction) -> int:
        return min(max(round((value - low) / (high - low) * (width - 1)), 0), width - 1)

    drawn = ["─"] * width
    for begin, end in picture.pieces:
        for cell in range(column(begin.place if begin else low), column(end.place if end else high) + 1):
            drawn[cell] = "━"
    ends = {found.place: found.label for piece in picture.pieces for found in piece if found is not None}
    for place in ends:
        drawn[column(place)] = "○"
    labels = {
        column(place): printer.language.decimal(label) if isinstance(label, str) else printer.inline(Literal(label))
        for place, label in ends.items()
    }
    if not labels:
        labels = {
            column(Fraction(value)): printer.language.decimal(text) for value, text in ticks(float(low), float(high))
        }
    return "\n".join([f"{''.join(drawn)} {printer.inline(symbol(picture.axis))}", *_rows(labels, width)])


def _rows(labels: dict[int, str], width: int) -> list[str]:
    """Return the rows of labels, each centred under its place on the first row with room."""
    rows: list[str] = []
    for place, label in sorted(labels.items()):
        start = min(max(place - len(label) // 2, 0), max(width - len(label), 0))
        fitting = (index for index, row in enumerate(rows) if not row or len(row) < start)
        index = next(fitting, len(rows))
        if index == len(rows):
            rows.append("")
        rows[index] = f"{rows[index]:<{start}}{label}"
    return rows


# -- diagrams ------------------------------------------------------------------------------------------------------


def _diagram(drawing: Drawing, printer: TextPrinter, width: int) -> str:
    scenes = (
        diagram_scene(drawing, cells_of(printer, gap), room, discrete=printer.discrete)
        for room in (inf, float(width))
        for gap in _GAPS
    )
    smallest = cells_of(printer, _GAPS[-1])
    chosen = next((scene for scene in scenes if scene.whole.right <= width), None)
    return _Canvas(chosen or diagram_scene(drawing, smallest, width, discrete=printer.discrete), printer).text()


def _lines(label: Content, printer: TextPrinter) -> list[str]:
    if isinstance(label, Conjunction):
        return [printer.inline(relation) for relation in label.relations]
    return [printer.inline(label)]  # type: ignore[arg-type]  # a diagram has no plain text


def cells_of(printer: TextPrinter, gap: int) -> Metrics:
    """Return the measures of a terminal: odd widths and heights, so that every node has a middle cell."""

    def measure(label: Label) -> Point:
        rows = _lines(label, printer)
        return max(map(text_width, rows)) // 2 * 2 + 1, 2 * len(rows) - 1

    return Metrics(measure, inside=(2, 1), smallest=3, junction=1, gap=(gap, 1), beside=1, point=1, sign=4, rates=False)


class _Canvas:
    """A grid of characters; a cell of wires records their directions."""

    def __init__(self, scene: Scene, printer: TextPrinter) -> None:
        self.printer = printer
        self.cells: dict[tuple[int, int], str] = {}
        self.sides: dict[tuple[int, int], set[str]] = {}
        for stroke in scene.strokes:
            self.draw(stroke)
        for cell, sides in self.sides.items():
            self.cells.setdefault(cell, _RULES["".join(sorted(sides))])
        for box in scene.boxes:
            self.draw_box(box)
        for sign in scene.signs:
            cell = _cell(sign.place)
            if sign.kind == "branch":
                self.cells[cell] = _RULES["".join(sorted(self.sides[cell]))].replace("┼", "●")
            elif sign.kind == "junction":
                self.cells[cell] = "○"
        for text in scene.texts:
            self.write_label(text)
        for sign in scene.signs:
            if sign.kind in {"+", "-"}:
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

    def draw(self, stroke: Stroke) -> None:
        """Draw a wire with the head of its arrow."""
        last = len(stroke.points) - 2
        for index in range(last + 1):
            begin, end = stroke.points[index : index + 2]
            cells = list(_between(begin, end))
            if not cells:
                continue
            step = _direction(begin, end)
            ahead, back = _SIDES[step], _OPPOSITE[_SIDES[step]]
            for cell in cells:
                sides = self.sides.setdefault(cell, set())
                sides |= {ahead} if cell != cells[-1] or not _is_middle(end) else set()
                sides |= {back} if cell != cells[0] or not _is_middle(begin) else set()
            if index == last and STYLES[stroke.style].has_head:
                self.cells[cells[-1]] = _HEADS[step]

    def draw_box(self, box: Box) -> None:
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
        self.write_rows(_lines(box.content, self.printer), box.centre)

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

    def write_label(self, text: TextLabel) -> None:
        """Write a signal at its wire."""
        column, row = _cell(text.place)
        lines = _lines(text.content, self.printer)
        if text.anchor == "right":
            self.write(lines[0], column + 2, row)
        else:
            self.write_rows(lines, (text.place[0], text.place[1] - (text.anchor == "above")))

    def write_sign(self, sign: Sign) -> None:
        """Write a sign beside the head of an arrow."""
        (x, y), (across, down) = sign.place, sign.direction
        glyph = sign.kind.replace("-", "−")
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
