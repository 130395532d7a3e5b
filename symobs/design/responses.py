"""Courses over time on pages: how the estimate converges, where the plant has numbers and a picture can show it."""

from __future__ import annotations

from fractions import Fraction
from math import lcm
from operator import mul
from typing import TYPE_CHECKING

from symobs.exact import Matrix
from symobs.formula import Letter
from symobs.picture import Course, TimeResponse

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.formula.term import Term
    from symobs.page import Page

#: Modes that differ in speed by more cannot be seen in one picture; with more courses none can be told from another.
_SPREAD, _COURSES = 15.0, 6
#: The slowest mode has fallen to e⁻⁶, a quarter of a per cent, at the end.
_TIMES = 6.0
_STEPS, _PARTS = 400, 10**6
_ROUND = (Fraction(1), Fraction(3, 2), Fraction(2), Fraction(3), Fraction(4), Fraction(5), Fraction(6), Fraction(8))


def plot_error(page: Page, name: str, matrix: Term) -> None:
    """The estimation error from the start x = (1, …, 1), x̂ = 0, for ė = matrix e."""
    size = matrix.value.shape[0]
    _plot(page, (name,), matrix, [(name, Matrix.identity(size), False)], "plot_error")


def plot_estimate(page: Page, error: str, matrix: Term, unseen: Matrix) -> None:
    """State and estimate of the closed loop from that start: x̂ = x − (unseen) · error."""
    order = page.plant.order
    state = Matrix.block([[Matrix.identity(order), Matrix.zeros(order, unseen.shape[1])]])
    estimate = Matrix.block([[Matrix.identity(order), -unseen]])
    _plot(page, ("x", error), matrix, [("x", state, False), ("x_hat", estimate, True)], "plot_estimate")


def _plot(
    page: Page, states: tuple[str, ...], matrix: Term, signals: Sequence[tuple[str, Matrix, bool]], say: str
) -> None:
    """Plot, unless the page has parameters or a picture would show nothing."""
    value = matrix.value
    courses = sum(table.shape[0] for _, table, _ in signals)
    numeric = not value.names and not page.plant.relations and not page.plant.is_discrete
    if not numeric or courses > _COURSES:
        return
    from symobs.exact.response import rates, response  # noqa: PLC0415 - only pages with courses pay for it

    slowest, fastest = rates(value)
    if slowest >= 0 or fastest < _SPREAD * slowest * (1 + 1e-9):
        return
    end = _rounded(_TIMES / -slowest)
    try:
        states_there = response(value, (Fraction(1),) * value.shape[0], end / _STEPS, _STEPS + 1, _PARTS)
    except ArithmeticError:
        return
    made = tuple(
        Course(name, index if table.shape[0] > 1 else 0, row, _course(row, states_there), dashed)
        for name, table, dashed in signals
        for index, row in enumerate(_rows(table), 1)
    )
    low, high = min(min(course.heights) for course in made), max(max(course.heights) for course in made)
    edge = Fraction(high - low, 20)
    window = (Fraction(0), end), ((low - edge) / _PARTS, (high + edge) / _PARTS)
    starts = tuple((Fraction(1),) * page.term(Letter(name)).value.size for name in states)
    page.plot(TimeResponse(states, starts, made, window, _PARTS), matrix, say=say)


def _rows(table: Matrix) -> list[tuple[Fraction, ...]]:
    return [tuple(entry.fraction() for entry in row) for row in table.rows]


def _course(row: Sequence[Fraction], states: Sequence[Sequence[int]]) -> tuple[int, ...]:
    """Return row · state, in whole parts."""
    common = lcm(*(part.denominator for part in row))
    whole = [int(part * common) for part in row]
    return tuple(sum(map(mul, whole, state)) // common for state in states)


def _rounded(value: float) -> Fraction:
    """Return a round number that is not smaller."""
    power = Fraction(1)
    while power * 10 <= value:
        power *= 10
    while power > value:
        power /= 10
    return next((factor * power for factor in _ROUND if factor * power >= value), 10 * power)
