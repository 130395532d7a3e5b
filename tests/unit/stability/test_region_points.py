"""Regions against the roots themselves, at points on the boundary, next to it and anywhere; and the judges judged.

By default a hundred points a problem; with SYMOBS_FULL=1 ten thousand.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

import pytest

import symobs
from tests.kit import tabled
from tests.support.regions import region_answers, region_checks
from tests.support.regions.region_answers import Answer
from tests.support.regions.region_problems import PROBLEMS, by_name
from tests.support.regions.region_roots import count_real_roots, real_roots
from tests.support.sampling import FULL, every

if TYPE_CHECKING:
    from tests.support.regions.region_problem import Problem

pytestmark = pytest.mark.slow

POINTS = 10_000 if FULL else 100

needs_regions = pytest.mark.skipif(not hasattr(symobs, "stability_region"), reason="stability_region is not there yet")


# -- the oracle -----------------------------------------------------------------------------------------------------


def test_sturm_counts_and_separates() -> None:
    assert count_real_roots([1, 0, 1]) == 0
    assert count_real_roots([1, 0, -3, 0, 2]) == 4
    assert count_real_roots([1, -2, 1]) == 1
    roots = real_roots([4, 0, -9, 0, 2, 0])
    assert [root.compare(Fraction(0)) for root in roots] == [-1, -1, 0, 1, 1]
    assert [root.compare(Fraction(1, 2)) for root in roots] == [-1, -1, -1, 0, 1]


# -- wrong answers --------------------------------------------------------------------------------------------------


def hand_made(name: str, *stable_if: str) -> tuple[Problem, Answer]:
    return by_name(name), Answer(tuple(stable_if))


@tabled
def test_a_right_answer_passes(row: tuple[str, ...]) -> None:
    problem, answer = hand_made(*row)
    assert list(region_checks.wrong_at_points(problem, answer, 300)) == []


@tabled
def test_a_wrong_answer_is_noticed(row: tuple[str, ...]) -> None:
    problem, answer = hand_made(*row)
    assert next(region_checks.wrong_at_points(problem, answer, 300)).startswith("stable_if at ")


# -- symobs ---------------------------------------------------------------------------------------------------------


@needs_regions
@pytest.mark.parametrize("problem", every(3, PROBLEMS), ids=lambda problem: problem.name)
def test_symobs_agrees_with_the_roots(problem: Problem) -> None:
    answer = region_answers.ask(problem)
    assert list(region_checks.wrong_by_record(problem, answer)) == []
    assert list(region_checks.wrong_at_points(problem, answer, POINTS)) == []
