"""Courses over time on the pages of designs: how the estimate converges, where the plant has numbers and shows it."""

from __future__ import annotations

from fractions import Fraction
from math import ceil, lcm, log
from operator import mul
from typing import TYPE_CHECKING

from symobs.exact import Matrix
from symobs.formula.figures import PlottedResponse, TimeResponse
from symobs.formula.tree import Letter
from symobs.tasks.analysis.time_response.courses import TIMES, Signals, plot_courses, rounded_up, rows_of, window_of

if TYPE_CHECKING:
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder

#: Modes that differ in speed by more cannot be seen in one picture; with more responses none can be told from another.
_SPREAD, _RESPONSES = 15.0, 6
#: In discrete time: the radius below which all modes are dead at once, and how many instants are drawn.
_DEAD, _FEWEST, _SAMPLES = 1e-9, 5, 30


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


def _plot(page: Builder, states: tuple[str, ...], matrix: Term, signals: Signals, say: str) -> None:
    """Plot, unless the page has parameters or a picture would show nothing."""
    value = matrix.value
    responses = sum(table.shape[0] for _, table, _ in signals)
    if value.names or page.plant.relations or responses > _RESPONSES:
        return
    if page.plant.is_discrete:
        _plot_samples(page, states, matrix, signals, say)
        return
    from symobs.exact.time_functions.matrix_exponential import spectral_abscissae  # noqa: PLC0415 - only pages with responses pay for it

    slowest, fastest = spectral_abscissae(value)
    if slowest >= 0 or fastest < _SPREAD * slowest * (1 + 1e-9):
        return
    end = rounded_up(TIMES / -slowest)
    plot_courses(page, states, _starts(page, states), matrix, signals, end, say)


def _plot_samples(page: Builder, states: tuple[str, ...], matrix: Term, signals: Signals, say: str) -> None:
    """Plot the exact values at 0, 1, 2, …, until they are small, unless that takes too many."""
    from symobs.exact.time_functions.matrix_exponential import spectral_radius  # noqa: PLC0415 - only pages with responses pay for it

    largest, size = spectral_radius(matrix.value), matrix.value.shape[0]
    last = size + 1 if largest < _DEAD else ceil(TIMES / -log(largest)) if largest < 1 else _SAMPLES + 1
    if last > _SAMPLES:
        return
    table, state = rows_of(matrix.value), (Fraction(1),) * size
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
        for index, row in enumerate(rows_of(part), 1)
    ]
    parts = lcm(*(height.denominator for _, _, _, heights, _ in found for height in heights))
    made = tuple(
        PlottedResponse(name, index, row, tuple(int(height * parts) for height in heights), dashed)
        for name, index, row, heights, dashed in found
    )
    window = window_of(Fraction(len(states_there) - 1), made, parts)
    page.plot(TimeResponse(states, _starts(page, states), made, window, parts, discrete=True), matrix, say=say)


def _starts(page: Builder, states: tuple[str, ...]) -> tuple[tuple[Fraction, ...], ...]:
    return tuple((Fraction(1),) * page.term(Letter(name)).value.size for name in states)
