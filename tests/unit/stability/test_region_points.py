"""Regions against the roots themselves, at points on the boundary, next to it and anywhere; and the judges judged.

By default some hundred points a problem; with SYMOBS_FULL=1 ten thousand.
"""

from __future__ import annotations

import random
import subprocess
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

import pytest

import symobs
from tests.kit import tabled
from tests.support.independent_algebra.region_algebra import Membership
from tests.support.independent_algebra.region_roots import UndefinedError, compare, count_real_roots, real_roots
from tests.support.regions import region_answers, region_checks
from tests.support.regions.region_answers import Answer, Cell
from tests.support.regions.region_points import Oracle, Points, on_boundary, stable_at
from tests.support.regions.region_problems import OBSERVERS, PROBLEMS, by_name
from tests.support.regions.region_texts import UnreadableError, expression, formula, polynomial
from tests.support.sampling import FULL, every

if TYPE_CHECKING:
    from collections.abc import Callable

    from tests.support.regions.region_problem import Problem

pytestmark = pytest.mark.slow

POINTS = 10_000 if FULL else 300

every_problem = pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
needs_regions = pytest.mark.skipif(not hasattr(symobs, "stability_region"), reason="stability_region is not there yet")


# -- the oracle -----------------------------------------------------------------------------------------------------


@tabled
def test_the_half_plane_is_told_exactly(text: str, stable: bool) -> None:  # noqa: FBT001
    coefficients = [int(c.constant or 0) for c in polynomial(text).integral().coefficients("s")]
    assert stable_at(coefficients, discrete=False) == stable


@tabled
def test_the_circle_is_told_exactly(text: str, stable: bool) -> None:  # noqa: FBT001
    coefficients = [int(c.constant or 0) for c in polynomial(text).integral().coefficients("z")]
    assert stable_at(coefficients, discrete=True) == stable


def test_a_lost_degree_is_not_stable() -> None:
    assert not stable_at([0, 1, 1], discrete=False)
    assert not stable_at([0, 2, 1], discrete=True)
    assert not Oracle(by_name("leading_one"))((Fraction(0),))


def test_roots_that_mirror_each_other_are_not_taken_for_roots_on_the_boundary() -> None:
    assert not on_boundary([1, 0, -1], discrete=False)
    assert not on_boundary([1, 0, 0, 0, 4], discrete=False)  # ±1 ± i
    assert not on_boundary([2, -5, 2], discrete=True)  # 2 and 1/2
    assert on_boundary([1, 0, 5, 0, 4], discrete=False)
    assert on_boundary([1, 1, 1, 1], discrete=True)


def test_pari_finds_the_roots_where_the_oracle_says(require_tool: Callable[[str], str]) -> None:
    generator = random.Random(5)  # noqa: S311 - the same polynomials in every run
    drawn = [[generator.randint(1, 9), *(generator.randint(-4, 30) for _ in range(k % 5 + 1))] for k in range(400)]
    lines = ["default(realprecision, 60);"]
    lines += [
        f"r = polroots(Pol({coefficients})); print([vecmax(real(r)) < -1e-30, vecmax(abs(r)) < 1 - 1e-30]);"
        for coefficients in drawn
    ]
    program = "\n".join(lines) + "\n"
    done = subprocess.run(
        [require_tool("gp"), "-q", "-f"], input=program, capture_output=True, text=True, check=True, timeout=120
    )
    expected = [f"[{stable_at(c, discrete=False):d}, {stable_at(c, discrete=True):d}]" for c in drawn]
    assert done.stdout.split("\n")[:-1] == expected
    assert {"[1, 0]", "[0, 0]"} <= {*expected}


def test_sturm_counts_and_separates() -> None:
    assert count_real_roots([1, 0, 1]) == 0
    assert count_real_roots([1, 0, -3, 0, 2]) == 4
    assert count_real_roots([1, -2, 1]) == 1
    roots = real_roots([4, 0, -9, 0, 2, 0])
    assert [root.compare(Fraction(0)) for root in roots] == [-1, -1, 0, 1, 1]
    assert [root.compare(Fraction(1, 2)) for root in roots] == [-1, -1, -1, 0, 1]


@tabled
def test_numbers_with_roots_are_compared_exactly(text: str, other: str, sign: int) -> None:
    assert compare(expression(text), Fraction(other), {}) == sign


def test_what_has_no_value_is_told() -> None:
    for text in ("sqrt(-1)", "1/(sqrt(4) - 2)", "CRootOf(x**2 + 1, 0)", "1/(sqrt(2)*sqrt(3) - sqrt(6))"):
        with pytest.raises(UndefinedError):
            compare(expression(text), Fraction(0), {})
    for text in ("h1 >", "h1 h2", "sin(h1)", "h1 > 2 \\/", "h1 ? 2"):
        with pytest.raises(UnreadableError):
            formula(text)


# -- the record -----------------------------------------------------------------------------------------------------


@every_problem
def test_hurwitz_and_hand_agree_with_the_roots(problem: Problem) -> None:
    oracle, points = Oracle(problem), Points(problem).take(POINTS)
    assert len(points) == len(set(points)) == POINTS
    sets = [problem.stable(form) for form in ("even", "odd", "all")]
    sets += [formula(problem.region)] if problem.region is not None else []
    inside = [Membership(found, problem.names) for found in sets]
    met = set()
    for point in points:
        stable = oracle(point)
        met.add(stable)
        assert [contains(point) for contains in inside] == [stable] * len(inside), point
    assert problem.empty or True in met
    assert problem.region == "TRUE" or False in met or problem.name == "irrational_value_left_out"


def test_points_lie_on_the_boundary_and_next_to_it() -> None:
    for name in ("cubic_hyper", "annulus", "jury4", "roots_given"):
        problem = by_name(name)
        points = Points(problem)
        curves = [Membership(formula(f"{curve} = 0"), problem.names) for curve in points.curves]
        drawn = points.take(1000)
        assert sum(any(curve(point) for curve in curves) for point in drawn) > 80
        assert points.take(1000) != drawn


def test_observers_are_of_third_and_fourth_order() -> None:
    third, fourth = by_name("observer_3"), by_name("observer_4_masses")
    assert polynomial(third.text).terms == polynomial("s^3 + (2 + h1) s^2 + (3 + 2 h1 + h2) s + 3 + 3 h1 + 2 h2").terms
    assert polynomial(fourth.text).degree("s") == 4
    assert all(problem.discrete == ("z" in problem.text) for problem in OBSERVERS)


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


@tabled
def test_intervals_are_held_against_the_roots(
    name: str,
    intervals: tuple[tuple[str, str], ...],
    right: bool,  # noqa: FBT001
) -> None:
    problem = by_name(name)
    assert problem.region is not None
    answer = Answer((), intervals=intervals)
    found = [line for line in region_checks.wrong_at_points(problem, answer, 400) if line.startswith("intervals")]
    assert (not found) == right


def test_cells_are_read_from_json_and_held_against_the_roots() -> None:
    text = """{"schema": "symobs/1", "results": [{"stable_if": ["h1**2 + h2**2 < 3"], "verdict": "conditional",
      "empty": false, "bounded": true, "components": [{"cells": [1], "bounded": true}], "excluded_points": [],
      "sample_points": [{"h1": "0", "h2": "1/2"}], "cells": [
      {"sample": {"h1": "-2", "h2": "0"}, "stable": false, "component": null, "h1": ["-oo", "-sqrt(3)"],
       "h2": ["-oo", "oo"]},
      {"sample": {"h1": "0", "h2": "0"}, "stable": true, "component": 0, "h1": ["-sqrt(3)", "sqrt(3)"],
       "h2": ["-sqrt(3 - h1**2)", "sqrt(3 - h1**2)"]},
      {"sample": {"h1": "0", "h2": "3"}, "stable": false, "component": null, "h1": ["-sqrt(3)", "sqrt(3)"],
       "h2": ["sqrt(3 - h1**2)", "oo"]}]}]}"""
    problem = by_name("disc")
    answer = region_answers.from_json(text, problem.parameters)
    assert list(region_checks.wrong_at_points(problem, answer, 500)) == []
    assert list(region_checks.wrong_by_record(problem, answer)) == []
    assert answer.cells is not None
    left, middle, right = answer.cells
    wider = replace(middle, bounds=(("h1", "-2", "sqrt(3)"), ("h2", "-2", "2")))
    for cells in ((left, wider, right), (left, replace(middle, stable=False), right), (replace(left, stable=True),)):
        wrong = replace(answer, cells=cells)
        with pytest.raises(AssertionError):
            assert list(region_checks.wrong_at_points(problem, wrong, 500)) == []
    assert list(region_checks.wrong_by_record(problem, replace(answer, cells=(replace(left, stable=True),))))


def test_a_cell_may_begin_with_the_second_parameter() -> None:
    cell = {"sample": {"h1": "5", "h2": "1"}, "stable": True, "h1": ["(h2**2 + 9)/(3*h2)", "oo"], "h2": ["0", "oo"]}
    read = region_answers._cell(cell, ("h1", "h2"))
    assert read == Cell(
        (("h2", "0", "oo"), ("h1", "(h2**2 + 9)/(3*h2)", "oo")),
        stable=True,
        sample={"h1": Fraction(5), "h2": Fraction(1)},
    )


def test_relations_and_cells_may_have_roots_in_them() -> None:
    inside = region_answers.holds(("h1 > -sqrt(3 - h2**2)", "h1 < sqrt(3 - h2**2)"), ("h1", "h2"))
    oracle = Oracle(by_name("disc"))
    assert all(inside(point) == oracle(point) for point in Points(by_name("disc")).take(300))
    words = Cell((("h1", "-oo", "oo"), ("h2", "-oo", "the second root")), stable=True, sample={})
    roots = ("CRootOf(h2**3 - 3*h2 + h1, 0)", "CRootOf(h2**3 - 3*h2 + h1, h2, 1)")
    between = Cell((("h1", "-2", "2"), ("h2", *roots)), stable=True, sample={})
    verdict = region_answers.in_cells([words, between])
    point = {"h1": Fraction(0), "h2": Fraction(-1)}
    assert verdict(point) is True
    assert verdict({**point, "h2": Fraction(1)}) is None
    assert verdict({**point, "h2": Fraction(0)}) is None
    assert verdict({**point, "h1": Fraction(3)}) is None


@pytest.mark.parametrize(
    "change",
    [
        {"empty": True},
        {"bounded": False},
        {"components": 2},
        {"verdict": "yes"},
        {"samples": ({"h1": Fraction(2), "h2": Fraction(0)},)},
    ],
)
def test_what_contradicts_the_record_is_noticed(change: dict[str, object]) -> None:
    good = Answer(
        ("h1**2 + h2**2 < 3",),
        components=1,
        empty=False,
        bounded=True,
        verdict="conditional",
        samples=({"h1": Fraction(0), "h2": Fraction(0)},),
    )
    assert list(region_checks.wrong_by_record(by_name("disc"), good)) == []
    assert list(region_checks.wrong_by_record(by_name("disc"), replace(good, **change)))  # type: ignore[arg-type]


# -- symobs ---------------------------------------------------------------------------------------------------------


@needs_regions
@pytest.mark.parametrize("problem", every(2, PROBLEMS), ids=lambda problem: problem.name)
def test_symobs_agrees_with_the_roots(problem: Problem) -> None:
    answer = region_answers.ask(problem)
    assert list(region_checks.wrong_by_record(problem, answer)) == []
    assert list(region_checks.wrong_at_points(problem, answer, POINTS)) == []
