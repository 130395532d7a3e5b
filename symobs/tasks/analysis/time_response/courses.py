"""Courses over time in a picture: responses of a system with numbers from its initial state, by segments that fit."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from symobs.formula.figures import PlottedResponse, TimeResponse
from symobs.proof.derivation.builder import Builder

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact import Matrix
    from symobs.formula.figures import Interval
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder, Slot


#: The slowest mode has fallen to e⁻⁶, a quarter of a per cent, at the end.
TIMES = 6.0
#: How many segments are drawn, more where a response changes fast at first: none passes by the values between its ends at
#: more than this part of the window.
_STEPS, _BETWEEN, _PARTS = (400, 800, 1600), Fraction(1, 110), 10**6
_ROUND = (Fraction(1), Fraction(3, 2), Fraction(2), Fraction(3), Fraction(4), Fraction(5), Fraction(6), Fraction(8))
#: Signals, each with its rows as a matrix times the state, and whether it is dashed.
Signals: TypeAlias = "Sequence[tuple[str, Matrix, bool]]"


def plot_courses(
    page: Builder,
    states: tuple[str, ...],
    starts: tuple[tuple[Fraction, ...], ...],
    matrix: Term,
    signals: Signals,
    end: Fraction,
    say: str,
    **slots: Slot,
) -> None:
    """Plot signals of a system with these states and their starts up to an end, unless no segments fit or all is at rest."""
    from symobs.exact.time_functions.matrix_exponential import state_response  # noqa: PLC0415
    from symobs.proof.derivation.plot_check import is_slow  # noqa: PLC0415 - only pages with responses pay for it

    if not is_slow(matrix.value, end / (2 * _STEPS[0])):  # a mode would turn unseen between two instants
        return
    start = tuple(part for parts in starts for part in parts)
    drawn = [
        (name, index if table.shape[0] > 1 else 0, row, dashed)
        for name, table, dashed in signals
        for index, row in enumerate(rows_of(table), 1)
    ]
    rows = [row for _, _, row, _ in drawn]
    for steps in _STEPS:
        try:
            between = state_response(matrix.value, start, end / (2 * steps), 2 * steps + 1, _PARTS, rows)
        except ArithmeticError:
            return
        made = tuple(
            PlottedResponse(name, index, row, tuple(heights[::2]), dashed)
            for (name, index, row, dashed), heights in zip(drawn, between, strict=True)
        )
        window = window_of(end, made, _PARTS)
        if window[1][0] == window[1][1]:
            return
        if all(_is_smooth(heights, window[1]) for heights in between):
            page.plot(TimeResponse(states, starts, made, window, _PARTS), matrix, say=say, **slots)
            return


def _is_smooth(heights: Sequence[int], edges: Interval) -> bool:
    """Return whether segments from every other instant to the next pass close by the values between them."""
    allowed = int(2 * _BETWEEN * (edges[1] - edges[0]) * _PARTS)
    triples = zip(heights[::2], heights[1::2], heights[2::2], strict=False)
    return all(abs(a - 2 * v + b) <= allowed for a, v, b in triples)


def window_of(end: Fraction, responses: Sequence[PlottedResponse], parts: int) -> tuple[Interval, Interval]:
    """Return a window with a little room above and below."""
    low, high = min(min(each.heights) for each in responses), max(max(each.heights) for each in responses)
    edge = Fraction(high - low, 20)
    return (Fraction(0), end), ((low - edge) / parts, (high + edge) / parts)


def rows_of(table: Matrix) -> list[tuple[Fraction, ...]]:
    """Return the rows of a matrix of numbers."""
    return [tuple(entry.fraction() for entry in row) for row in table.rows]


def rounded_up(value: float) -> Fraction:
    """Return a round number that is not smaller."""
    power = Fraction(1)
    while power * 10 <= value:
        power *= 10
    while power > value:
        power /= 10
    return next((factor * power for factor in _ROUND if factor * power >= value), 10 * power)
