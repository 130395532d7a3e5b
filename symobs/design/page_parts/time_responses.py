"""Courses over time on pages: how the estimate converges, where the plant has numbers and a picture can show it."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, lcm, log
from operator import mul
from typing import TYPE_CHECKING

from symobs.exact import Matrix
from symobs.figures.plot import PlottedResponse, TimeResponse
from symobs.formula import Letter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.derivation.builder import Builder
    from symobs.figures.plot import Interval
    from symobs.formula.term import Term

#: Modes that differ in speed by more cannot be seen in one picture; with more responses none can be told from another.
_SPREAD, _RESPONSES = 15.0, 6
#: The slowest mode has fallen to e⁻⁶, a quarter of a per cent, at the end.
_TIMES = 6.0
#: In discrete time: the radius below which all modes are dead at once, and how many instants are drawn.
_DEAD, _FEWEST, _SAMPLES = 1e-9, 5, 30
#: How many segments are drawn, more where a response changes fast at first: none passes by the values between its ends at
#: more than this part of the window.
_STEPS, _BETWEEN, _PARTS = (400, 800, 1600), Fraction(1, 110), 10**6
_ROUND = (Fraction(1), Fraction(3, 2), Fraction(2), Fraction(3), Fraction(4), Fraction(5), Fraction(6), Fraction(8))


def plot_error(page: Builder, name: str, matrix: Term) -> None:
    """Plot the estimation error from the start x = (1, …, 1), x̂ = 0, for ė = matrix e."""
    size = matrix.value.shape[0]
    _plot(page, (name,), matrix, [(name, Matrix.identity(size), False)], "plot_error")


def plot_estimate(page: Builder, error: str, matrix: Term, unseen: Matrix) -> None:
    """State and estimate of the closed loop from that start: x̂ = x − (unseen) · error."""
    order = page.plant.order
    state = Matrix.block([[Matrix.identity(order), Matrix.zeros(order, unseen.shape[1])]])
    estimate = Matrix.block([[Matrix.identity(order), -unseen]])
    _plot(page, ("x", error), matrix, [("x", state, False), ("x_hat", estimate, True)], "plot_estimate")


def _plot(
    page: Builder, states: tuple[str, ...], matrix: Term, signals: Sequence[tuple[str, Matrix, bool]], say: str
) -> None:
    """Plot, unless the page has parameters or a picture would show nothing."""
    value = matrix.value
    responses = sum(table.shape[0] for _, table, _ in signals)
    if value.names or page.plant.relations or responses > _RESPONSES:
        return
    if page.plant.is_discrete:
        _plot_samples(page, states, matrix, signals, say)
        return
    from symobs.derivation.figures.time_response_check import is_slow  # noqa: PLC0415 - only pages with responses pay for it
    from symobs.exact.time_functions.state_response import spectral_abscissae, state_response  # noqa: PLC0415

    slowest, fastest = spectral_abscissae(value)
    if slowest >= 0 or fastest < _SPREAD * slowest * (1 + 1e-9):
        return
    end = rounded_up(_TIMES / -slowest)
    if not is_slow(value, end / (2 * _STEPS[0])):  # a mode would turn unseen between two instants
        return
    for steps in _STEPS:
        try:
            between = state_response(value, (Fraction(1),) * value.shape[0], end / (2 * steps), 2 * steps + 1, _PARTS)
        except ArithmeticError:
            return
        made = tuple(
            PlottedResponse(name, index if table.shape[0] > 1 else 0, row, _course(row, between[::2]), dashed)
            for name, table, dashed in signals
            for index, row in enumerate(_rows(table), 1)
        )
        window = _window(end, made, _PARTS)
        if all(_is_smooth(_course(response.row, between), window[1]) for response in made):
            page.plot(TimeResponse(states, _starts(page, states), made, window, _PARTS), matrix, say=say)
            return


def _is_smooth(heights: Sequence[int], edges: Interval) -> bool:
    """Return whether segments from every other instant to the next pass close by the values between them."""
    allowed = 2 * _BETWEEN * (edges[1] - edges[0]) * _PARTS
    return all(
        abs(a - 2 * v + b) <= allowed for a, v, b in zip(heights[::2], heights[1::2], heights[2::2], strict=False)
    )


def _plot_samples(
    page: Builder, states: tuple[str, ...], matrix: Term, signals: Sequence[tuple[str, Matrix, bool]], say: str
) -> None:
    """Plot the exact values at 0, 1, 2, …, until they are small, unless that takes too many."""
    from symobs.exact.time_functions.state_response import spectral_radius  # noqa: PLC0415 - only pages with responses pay for it

    largest, size = spectral_radius(matrix.value), matrix.value.shape[0]
    last = size + 1 if largest < _DEAD else ceil(_TIMES / -log(largest)) if largest < 1 else _SAMPLES + 1
    if last > _SAMPLES:
        return
    table, state = _rows(matrix.value), (Fraction(1),) * size
    states_there = []
    for _ in range(max(last, _FEWEST) + 1):
        states_there.append(state)
        state = tuple(sum(map(mul, row, state), Fraction(0)) for row in table)
    found = [
        (
            name,
            index if part.shape[0] > 1 else 0,
            row,
            [sum(map(mul, row, s), Fraction(0)) for s in states_there],
            dashed,
        )
        for name, part, dashed in signals
        for index, row in enumerate(_rows(part), 1)
    ]
    parts = lcm(*(height.denominator for _, _, _, heights, _ in found for height in heights))
    made = tuple(
        PlottedResponse(name, index, row, tuple(int(height * parts) for height in heights), dashed)
        for name, index, row, heights, dashed in found
    )
    window = _window(Fraction(len(states_there) - 1), made, parts)
    page.plot(TimeResponse(states, _starts(page, states), made, window, parts, discrete=True), matrix, say=say)


def _starts(page: Builder, states: tuple[str, ...]) -> tuple[tuple[Fraction, ...], ...]:
    return tuple((Fraction(1),) * page.term(Letter(name)).value.size for name in states)


def _window(end: Fraction, responses: Sequence[PlottedResponse], parts: int) -> tuple[Interval, Interval]:
    """Return a window with a little room above and below."""
    low, high = min(min(each.heights) for each in responses), max(max(each.heights) for each in responses)
    edge = Fraction(high - low, 20)
    return (Fraction(0), end), ((low - edge) / parts, (high + edge) / parts)


def _rows(table: Matrix) -> list[tuple[Fraction, ...]]:
    return [tuple(entry.fraction() for entry in row) for row in table.rows]


def _course(row: Sequence[Fraction], states: Sequence[Sequence[int]]) -> tuple[int, ...]:
    """Return row · state, in whole parts."""
    common = lcm(*(part.denominator for part in row))
    whole = [int(part * common) for part in row]
    return tuple(sum(map(mul, whole, state)) // common for state in states)


def rounded_up(value: float) -> Fraction:
    """Return a round number that is not smaller."""
    power = Fraction(1)
    while power * 10 <= value:
        power *= 10
    while power > value:
        power /= 10
    return next((factor * power for factor in _ROUND if factor * power >= value), 10 * power)
