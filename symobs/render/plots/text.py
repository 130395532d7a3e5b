"""Plots for terminals: regions, intervals and pole maps in characters."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, assert_never

from symobs.figures.plot import LinePicture, PoleMap, RegionPicture, TimeResponse
from symobs.formula import Formula, Literal
from symobs.render.page.plot_captions import part, radius_of, symbol
from symobs.render.plots.curve_labels import contains
from symobs.render.plots.plot_layout import ticks
from symobs.render.plots.time_axis import CHARACTERS, axis_of, name_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.figures.plot import Interval, Picture, Place
    from symobs.render.plots.scene import Point
    from symobs.render.printers.text_printer import TextPrinter

_COLUMNS, _ROWS, _LINE = 41, 17, 61
#: Areas end close to the lines at which the plane was cut.  Where two stand this part of the window on either side of a
#: place, and no curve is drawn between them, the place belongs to the region as they do.
_SEAM = 1 / 800


def character_plot(picture: Picture, printer: TextPrinter, width: int) -> str:
    """Return a plot in characters of a terminal, if possible at most `width` columns wide."""
    match picture:
        case RegionPicture():
            return _region(picture, printer)
        case LinePicture():
            return _line(picture, printer, min(_LINE, width - 4))
        case PoleMap():
            return _poles(picture, printer)
        case TimeResponse():
            return _responses(picture, printer)
        case _:
            assert_never(picture)


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
    """Whether a line that is drawn meets the segment from a to b, or touches it."""

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
        _put(grid, picture.window, path[-1], "o")
    return _framed(grid, picture.window, [part("Re"), part("Im")], printer)


def _responses(picture: TimeResponse, printer: TextPrinter) -> str:
    """Return the grid of responses, a character for each with a legend above."""
    grid = _grid(picture.window, lambda _x, _y: " ")
    zero = int(picture.window[1][1] / (picture.window[1][1] - picture.window[1][0]) * _ROWS)
    if picture.window[1][0] < 0 < picture.window[1][1]:
        grid[min(zero, _ROWS - 1)] = ["┈"] * _COLUMNS
    marks = list(zip(picture.responses, CHARACTERS, strict=False))
    for response, mark in reversed(marks):
        for place in picture.points(response):
            _put(grid, picture.window, place, mark)
    told = "   ".join(f"{mark} {printer.inline(name_of(response))}" for response, mark in marks)
    return f"{told}\n{_framed(grid, picture.window, [symbol(axis_of(picture))], printer)}"


def _grid(window: tuple[Interval, Interval], character: Callable[[float, float], str]) -> list[list[str]]:
    """Return the character of every cell by its middle, the top row first."""
    (left, right), (bottom, top) = (tuple(map(float, interval)) for interval in window)
    xs = [left + (right - left) * (column + 0.5) / _COLUMNS for column in range(_COLUMNS)]
    ys = [top - (top - bottom) * (row + 0.5) / _ROWS for row in range(_ROWS)]
    return [[character(x, y) for x in xs] for y in ys]


def _put(grid: list[list[str]], window: tuple[Interval, Interval], place: Place, character: str) -> None:
    (left, right), (bottom, top) = window
    column = int((place[0] - left) / (right - left) * _COLUMNS)
    row = int((top - place[1]) / (top - bottom) * _ROWS)
    if left <= place[0] <= right and bottom <= place[1] <= top:
        grid[min(row, _ROWS - 1)][min(column, _COLUMNS - 1)] = character


def _framed(
    grid: list[list[str]], window: tuple[Interval, Interval], names: Sequence[Formula], printer: TextPrinter
) -> str:
    """Return the rows with axes, their names and the ends of the window."""
    (left, right), (bottom, top) = window
    first, second = ([printer.inline(name) for name in names] + [""])[:2]
    low, high = _short(bottom), _short(top)
    margin = max(len(low), len(high))
    lines = [f"{' ' * margin} {second}"] if second else []
    for row, characters in enumerate(grid):
        label = {0: high, _ROWS - 1: low}.get(row, "")
        lines.append(f"{label:>{margin}} │{''.join(characters)}")
    ends = f"{_short(left)}{_short(right):>{_COLUMNS - len(_short(left))}}"
    return "\n".join([*lines, f"{' ' * margin} └{'─' * _COLUMNS} {first}", f"{' ' * margin}  {ends}"])


def _short(value: Fraction) -> str:
    """Return a number in few characters."""
    return f"{float(value):.4g}"


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
        column(place): label if isinstance(label, str) else printer.inline(Literal(label))
        for place, label in ends.items()
    }
    if not labels:
        labels = {column(Fraction(value)): text for value, text in ticks(float(low), float(high))}
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
