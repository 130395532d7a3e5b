"""The picture of a sweep: its columns over one name, or lines of equal values of a column over two names.

The values at the points are those of the table; between them the lines are straight.  A point without a value has none, nor
has one of a case of its own, whose value need not be near those of its neighbours.
"""

from __future__ import annotations

import math
from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.applications.batch.sweep.columns import nearest_of
from symobs.applications.batch.sweep.program import MARGINS_STATUS
from symobs.exact import Scalar
from symobs.formula.figures import SweepCurves, SweepMap
from symobs.formula.tree import Letter, Literal
from symobs.ground.errors import UsageError

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from symobs.applications.batch.sweep.plan import Plan, SweepTable
    from symobs.formula.figures import Run
    from symobs.formula.tree import Formula

    Point = tuple[float, float]
    #: The side of a cell of the grid that a line crosses: the place of its first point, and whether it goes up.
    Side = tuple[int, int, bool]

_WORDS = {
    "gain_down": "gain margin, lower",
    "gain_up": "gain margin, upper",
    "phase_deg": "phase margin in degrees",
    "modulus": "modulus margin",
    "slowest": "slowest pole",
}
MOST_POINTS, MOST_CURVES, _LEVELS = 250_000, 6, 7


def drawn_columns(plan: Plan) -> list[str]:
    """Return the columns that a picture shows.  Raises `UsageError`, before any work, for what it cannot show."""
    columns = [name for name in plan.columns if name != MARGINS_STATUS]
    names, most = plan.grid.names, {1: MOST_CURVES, 2: 1}
    if len(names) not in most or min(axis.count for axis in plan.grid.axes) < 2:
        message = f"a picture is over one or two names with two values each, not over {', '.join(names)}"
        raise UsageError(message, where="--plot", repair="sweep one name or two, or leave --plot out")
    if len(columns) > most[len(names)]:
        message = f"a picture over {' and '.join(names)} shows {most[len(names)]} columns, and there are {len(columns)}"
        raise UsageError(message, where="--plot", repair=f"name fewer, such as --columns {columns[0]}")
    if plan.grid.size > MOST_POINTS:
        message = f"a picture shows {MOST_POINTS} points, and there are {plan.grid.size}"
        raise UsageError(message, where="--plot", repair="take larger steps, or leave --plot out")
    return columns


def picture_of(table: SweepTable) -> SweepCurves | SweepMap:
    """Return the picture of a sweep over one or two names."""
    columns, grid = drawn_columns(table.plan), table.grid
    values: dict[str, list[float | None]] = {name: [] for name in columns}
    finite: set[str] = set()
    for _, result in table.blocks():
        for name in columns:
            numbers = nearest_of(name, result)
            finite |= set() if all(number == math.inf for number in numbers) else {name}
            found = zip(numbers, result["case"], strict=True)
            values[name] += [None if v is None or math.isinf(v) or case is not None else v for v, case in found]
    infinite = [name for name in columns if name not in finite]
    places = [sorted(float(axis.at(k)) for k in range(axis.count)) for axis in grid.axes]
    orders = [sorted(range(axis.count), key=axis.at) for axis in grid.axes]
    window = [(each[0], each[-1]) for each in places]
    if len(places) == 1:
        sorted_values = [[values[name][k] for k in orders[0]] for name in columns]
        curves = tuple(
            (_name(n), tuple(_runs(places[0], column)), tuple(_gaps(places[0], column)))
            for n, column in zip(columns, sorted_values, strict=True)
            if n not in infinite or len(infinite) == len(columns)
        )
        return SweepCurves(grid.names[0], curves, window[0], grid.size, tuple(map(_name, infinite)))
    (name,), (xs, ys) = columns, places
    rows = [[values[name][i * len(ys) + j] for j in orders[1]] for i in orders[0]]
    gaps_of_map = tuple(_rectangle(xs, ys, i, j) for i in range(len(xs)) for j in range(len(ys)) if rows[i][j] is None)
    known = sorted(value for row in rows for value in row if value is not None)
    levels = tuple((level, tuple(_level(xs, ys, rows, float(level)))) for level in _round_levels(known))
    axes = (grid.names[0], grid.names[1])
    return SweepMap(axes, _name(name), (window[0], window[1]), levels, grid.size, gaps_of_map)


def write_picture(table: SweepTable, out: Path) -> None:
    """Write the picture of a sweep: .svg, .png, .pdf or .tex."""
    from symobs.applications.batch.store import write_whole  # noqa: PLC0415
    from symobs.pages.drawings.plot_file import sweep_file  # noqa: PLC0415 - only with pictures

    write_whole(out, [sweep_file(picture_of(table), str(out))])


def _name(column: str) -> Formula | str:
    """Return the name of a column: an entry of a gain or a coefficient as a letter with its index, a margin in words."""
    if column in _WORDS:
        return _WORDS[column]
    letter, _, index = column.removesuffix("]").partition("[")
    numbers = index.split(",")
    if len(numbers) == 2 and all(len(number) == 1 for number in numbers):
        return Letter(f"{letter}[{''.join(numbers)}")
    return Literal(Scalar.symbol("_".join([letter.replace(".", "_"), *numbers]).rstrip("_")))


# -- one name ---------------------------------------------------------------------------------------------------------


def _runs(places: Sequence[float], values: Sequence[float | None]) -> Iterator[Run]:
    """Yield the lines through values that follow one another."""
    run: list[Point] = []
    for place, value in [*zip(places, values, strict=True), (0.0, None)]:
        if value is not None:
            run.append((place, value))
            continue
        if len(run) > 1:
            yield tuple(run)
        run = []


def _gaps(places: Sequence[float], values: Sequence[float | None]) -> Iterator[Point]:
    """Yield the intervals around places without a value, half-way to their neighbours."""
    for k, value in enumerate(values):
        if value is None:
            yield _around(places, k)


def _around(places: Sequence[float], k: int) -> Point:
    left, right = places[max(k - 1, 0)], places[min(k + 1, len(places) - 1)]
    return (places[k] + left) / 2, (places[k] + right) / 2


# -- two names --------------------------------------------------------------------------------------------------------


def _rectangle(xs: Sequence[float], ys: Sequence[float], i: int, j: int) -> Run:
    (left, right), (bottom, top) = _around(xs, i), _around(ys, j)
    return (left, bottom), (right, bottom), (right, top), (left, top)


def _round_levels(known: Sequence[float]) -> list[Fraction]:
    """Return values of two digits that part the known ones into shares of about the same size."""
    shares = [known[len(known) * k // (_LEVELS + 1)] for k in range(1, _LEVELS + 1)] if known else []
    return sorted({level for value in shares if known[0] < (level := Fraction(f"{value:.1e}")) < known[-1]})


def _level(
    xs: Sequence[float], ys: Sequence[float], rows: Sequence[Sequence[float | None]], level: float
) -> Iterator[Run]:
    """Yield the lines on which the values, linear along the sides of the cells, are `level`."""
    met: dict[Side, list[Side]] = {}
    for i in range(len(xs) - 1):
        for j in range(len(ys) - 1):
            for one, other in _crossed(rows, i, j, level):
                met.setdefault(one, []).append(other)
                met.setdefault(other, []).append(one)

    def place(side: Side) -> Point:
        i, j, up = side
        a, b = rows[i][j], rows[i + (not up)][j + up]
        part = (level - a) / (b - a)  # type: ignore[operator]  # what has no value is not crossed
        x = xs[i] if up else xs[i] + part * (xs[i + 1] - xs[i])
        return x, ys[j] + part * (ys[j + 1] - ys[j]) if up else ys[j]

    while met:
        side: Side | None = next((each for each, others in met.items() if len(others) == 1), next(iter(met)))
        run: list[Point] = []
        while side is not None:
            run.append(place(side))
            others = met.get(side, [])
            following = others.pop() if others else None
            if not others:
                met.pop(side, None)
            if following is not None and following in met:
                met[following].remove(side)
            side = following
        if len(run) > 1:
            yield tuple(run)


def _crossed(rows: Sequence[Sequence[float | None]], i: int, j: int, level: float) -> list[tuple[Side, Side]]:
    """Return the pairs of sides of a cell that a line joins; of two lines each cuts off a corner that lies above."""
    corners = [rows[i][j], rows[i + 1][j], rows[i + 1][j + 1], rows[i][j + 1]]
    if None in corners:
        return []
    above = [value >= level for value in corners if value is not None]
    sides: list[Side] = [(i, j, False), (i + 1, j, True), (i, j + 1, False), (i, j, True)]
    cut = [side for side, (a, b) in zip(sides, pairwise([*above, above[0]]), strict=True) if a != b]
    if len(cut) < 4:
        return [(cut[0], cut[1])] if cut else []
    first = 0 if above[1] else 1
    return [(cut[first], cut[first + 1]), (cut[first + 2], cut[(first + 3) % 4])]
