"""Courses of errors and estimates over time: true, shown only where they can be read, and refused where spoiled."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from functools import cache, partial
from pathlib import Path
from time import process_time
from timeit import repeat
from typing import TYPE_CHECKING, Any

import mpmath
import pytest

import symobs
from symobs.exact import Matrix
from symobs.exact.time_functions.matrix_exponential import state_response
from symobs.formula.figures import TimeResponse
from symobs.formula.tree import Exact, evaluate
from symobs.ground.errors import DerivationRejected
from symobs.proof.derivation import Plot, plot_check
from symobs.system import StateSpace
from tests.kit import tabled, tables, text_of
from tests.support.derivations import untrue_responses
from tests.support.tampering.mutations import lines_of

if TYPE_CHECKING:
    from symobs.tasks.result import Result
    from tests.support.tampering.mutations import Line

PAGES = tables(Path(__file__))["pages"]


@cache
def page(name: str) -> Result:
    task, plant, asked = PAGES[name]
    found: Result = getattr(symobs, task)(StateSpace(**plant), **asked)
    return found


def courses(result: Result) -> list[Line]:
    """Return the lines of a page that are pictures of courses over time."""
    lines = (line for line in lines_of(result.derivation) if isinstance(line.step, Plot))
    return [line for line in lines if isinstance(line.step.picture, TimeResponse)]  # type: ignore[union-attr]


def plots(result: Result) -> list[tuple[Plot, TimeResponse]]:
    return [(line.step, line.step.picture) for line in courses(result)]  # type: ignore[union-attr, misc]


@pytest.mark.parametrize("name", PAGES)
def test_courses_are_those_of_another_matrix_exponential(name: str) -> None:
    result = page(name)
    known = result.derivation.check()
    ((step, picture),) = plots(result)
    value = evaluate(step.subject, known, Exact(known))
    assert list(untrue_responses(picture, [[entry.fraction() for entry in row] for row in value.rows])) == []


def test_a_deadbeat_observer_is_dead_after_as_many_instants_as_states() -> None:
    """A - LC = [-1 1; -1 1]: e(0) = (1, 1) is in its kernel, and the square is 0."""
    ((_, picture),) = plots(page("deadbeat"))
    assert picture.discrete
    assert [[y for _, y in picture.points(course)] for course in picture.responses] == [[1, 0, 0, 0, 0, 0]] * 2
    assert "instants 0, 1, 2" in text_of(page("deadbeat"))


def test_a_spoiled_value_of_discrete_time_is_refused_however_near() -> None:
    (line,) = courses(page("sampled"))
    ((step, picture),) = plots(page("sampled"))
    (course,) = picture.responses
    finer = picture.parts * 10**30
    exact = [height * 10**30 for height in course.heights]
    exact[2] += 1
    near = replace(course, heights=tuple(exact))
    with pytest.raises(DerivationRejected, match="the line the response of e_2, in a picture,"):
        line.told(replace(step, picture=replace(picture, responses=(near,), parts=finer))).check()
    with pytest.raises(DerivationRejected, match="the line another time, in a picture,"):
        line.told(replace(step, picture=replace(picture, discrete=False))).check()


@tabled
def test_a_picture_is_left_out_where_it_would_show_nothing(
    plant: dict[str, Any], poles: str, *, is_drawn: bool
) -> None:
    """With parameters, too slow, too fast beside the others, or where nothing converges."""
    assert bool(plots(symobs.observer(StateSpace(**plant), poles=poles))) is is_drawn


# -- what is refused --------------------------------------------------------------------------------------------------


# -- the kernel -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("bits", [16, 32, 48, 64, 96, 128])
@pytest.mark.parametrize("rate", [-2, 6, 30])
def test_a_response_is_found_to_one_part_whatever_bits_it_begins_with(
    bits: int, rate: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """(M + I)² = 0 with entries of a thousand, e^{Mt} = e^{-t} (I + (M + I) t), beside what falls, or grows to e^{180}."""
    from symobs.exact.time_functions import matrix_exponential as writer  # noqa: PLC0415 - the only test that sets its bits

    monkeypatch.setattr(writer, "_BITS", (bits, 1024))
    table = Matrix.of([[999, -1000, 0], [1000, -1001, 0], [0, 0, rate]])
    start = Fraction(1), Fraction(0), Fraction(1, 3)
    found = state_response(table, start, Fraction(1, 100), 601, 10**15)
    rows = [[Fraction(10**6), Fraction(-(10**6), 3), Fraction(0)], [Fraction(-2), Fraction(1, 7), Fraction(5)]]
    seen = state_response(table, start, Fraction(1, 100), 601, 10**15, rows)
    with mpmath.workdps(120):
        for k in range(0, 601, 25):
            t = mpmath.mpf(k) / 100
            true = mpmath.exp(-t) * (1 + 1000 * t), mpmath.exp(-t) * 1000 * t, mpmath.exp(rate * t) / 3
            assert all(abs(line[k] - 10**15 * value) <= 1 for line, value in zip(found, true, strict=True))
            for row, line in zip(rows, seen, strict=True):
                value = sum(
                    mpmath.mpf(part.numerator) / part.denominator * x for part, x in zip(row, true, strict=True)
                )
                assert abs(line[k] - 10**15 * value) <= 1


@pytest.mark.parametrize("power", [63, 127])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_value_that_is_rounded_to_a_power_of_two_keeps_its_sign(power: int, sign: int) -> None:
    start = sign * (2**power - Fraction(1, 4)) / 10**15
    (found,) = state_response(Matrix.of([[0]]), (start,), Fraction(1), 5, 10**15)
    assert all(abs(value - start * 10**15) <= 1 for value in found)


def test_errors_add_up_side_by_side_and_the_larger_counts_one_above_the_other() -> None:
    one, other = plot_check._Enclosed.of([[1, 2]], 5), plot_check._Enclosed.of([[3, 4]], 7)
    assert one.beside(other) == ([[1, 2, 3, 4]], 10, 12)
    assert one.above(other) == ([[1, 2], [3, 4]], 7, 7)


def test_sixteen_times_as_many_instants_take_little_longer() -> None:
    """In one process: 3 to 5 times as long, and 11 where each instant is rounded by itself."""
    table = Matrix.of([[-1, 2, 0, 1], [0, -3, 1, 0], [1, 0, -2, 5], [0, 1, -5, -2]])
    start = (Fraction(1),) * 4

    def seconds(count: int) -> float:
        work = partial(state_response, table, start, Fraction(6, count), count, 10**15)
        return min(repeat(work, timer=process_time, number=2, repeat=7))

    assert min(seconds(1025) / seconds(65) for _ in range(3)) < 7
