"""Regions proved equal to those QEPCAD finds: by z3, and where z3 does not decide, by QEPCAD itself.

By default every sixth problem; with SYMOBS_FULL=1 all of them, and longer time for the questions about roots.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest
import z3  # type: ignore[import-untyped, unused-ignore]

import symobs
from tests.kit import tabled
from tests.programs.benchmarks import other_systems
from tests.support.regions import qepcad, region_answers, region_checks
from tests.support.regions.region_algebra import (
    FALSE,
    TRUE,
    All,
    Atom,
    Some,
    difference,
)
from tests.support.regions.region_answers import Answer, Cell
from tests.support.regions.region_problems import PROBLEMS, by_name
from tests.support.regions.region_proofs import nothing_in, same_intervals, same_relations
from tests.support.regions.region_texts import expression, formula, polynomial
from tests.support.regions.region_translation import Translation, conjunction
from tests.support.sampling import FULL

if TYPE_CHECKING:
    from tests.support.regions.region_problem import Problem

pytestmark = pytest.mark.slow

SLICE = PROBLEMS if FULL else PROBLEMS[::6]
SECONDS_FOR_ROOTS = 20 if FULL else 2

needs_qepcad = pytest.mark.skipif(not other_systems.available("qepcad"), reason="qepcad is not installed")
needs_regions = pytest.mark.skipif(not hasattr(symobs, "stability_region"), reason="stability_region is not there yet")
some_problems = pytest.mark.parametrize("problem", SLICE, ids=lambda problem: problem.name)

#: QEPCAD answers the questions about their roots in well under a second.
BY_ROOTS = ["pend_hang", "cubic_hyper", "shift_a1", "annulus", "jury2", "ring_hole", "margin_symbols", "six_lags"]


# -- QEPCAD as it is asked and read -----------------------------------------------------------------------------------


def test_a_question_is_written_in_integers_without_negations() -> None:
    matrix = formula("~[ h1/2 >= 1/3 \\/ [h1 h2 = 0 /\\ 1 > 0] ] /\\ 0 < 1")
    question = qepcad.Question(("h1", "h2"), ("x",), matrix)
    assert question.text() == "[ region ]\n(h1,h2,x)\n2\n(E x)[ [ 3 h1 - 2 < 0 ] /\\ [ h1 h2 /= 0 ] ].\n"


def test_constants_are_folded() -> None:
    for text, whole in [
        ("1 >= 1 /\\ 0 != 0", FALSE),
        ("~[ 2 <= 1 ] \\/ h1 > 0", TRUE),
        ("FALSE", FALSE),
    ]:
        assert qepcad.folded(formula(text)) == whole
    assert qepcad.folded(formula("-1 <= 0 /\\ 0 = 0 /\\ 2 != 1")) == TRUE
    assert qepcad.folded(formula("1 < 0 \\/ 0 > 0 \\/ 1 = 0")) == FALSE


@needs_qepcad
def test_answers_are_read() -> None:
    for text, same in [
        ("x^2 - h1 = 0 /\\ x - h2 > 0", "h1 >= 0 /\\ [h2 < 0 \\/ h2^2 < h1]"),
        ("x^2 + 1 = 0 /\\ h1 + h2 > 0", "FALSE"),
        ("x - h1 h2 > 0", "TRUE"),
    ]:
        reply = qepcad.ask(qepcad.Question(("h1", "h2"), ("x",), formula(text)))
        assert reply is not None
        assert nothing_in(difference(reply.formula, formula(same))).verdict == "same", reply.text


@needs_qepcad
def test_a_question_without_an_answer_has_none() -> None:
    fifth = by_name("quintic_bilin")
    assert qepcad.region_by_roots(fifth, 0.5) is None
    unreadable = qepcad.Question(("h1",), (), Atom(polynomial("h2"), ">"))
    assert qepcad.ask(unreadable) is None


@needs_qepcad
def test_emptiness_is_decided_by_qepcad_alone() -> None:
    translation = Translation()
    between = conjunction(translation, ["h1 > sqrt(2)", "h1**2 < 2", "h1 < CRootOf(x**3 - x - 1, 0)"])
    assert qepcad.is_empty(All((*translation.definitions, between))) is True
    translation = Translation()
    between = conjunction(translation, ["h1 < sqrt(2)", "h1 > CRootOf(x**3 - x - 1, 0)"])
    assert qepcad.is_empty(All((*translation.definitions, between))) is False


@needs_qepcad
def test_z3_that_gives_up_leaves_it_to_qepcad(monkeypatch: pytest.MonkeyPatch) -> None:
    class Idle:
        def __getattr__(self, name: str) -> object:
            return lambda *_: None

    monkeypatch.setattr(z3.Tactic, "solver", lambda _: Idle())
    assert str(nothing_in(formula("h1^2 + h2^2 < 0"))) == "same (QEPCAD)"
    assert str(nothing_in(formula("h1^2 + h2^2 < 1"))) == "different (QEPCAD)"


# -- roots as variables -----------------------------------------------------------------------------------------------


@tabled
def test_roots_are_translated_exactly(relation: str, same: str) -> None:
    translation = Translation()
    unequal = difference(conjunction(translation, [relation]), formula(same))
    assert nothing_in(unequal, translation.definitions).verdict == "same"


def test_definitions_leave_one_value_for_every_point() -> None:
    translation = Translation()
    translation.fraction(expression("sqrt(h1) + sqrt(1/(h2 - 1))"), [])
    again = Translation([Some(tuple(translation.definitions))])
    assert len(translation.definitions) == 4
    assert len(again.definitions) == 1
    outside = formula("h1 < 0 /\\ h2 < 1 /\\ [t1 != 0 \\/ t2 != 0]")
    assert nothing_in(outside, translation.definitions).verdict == "same"
    inside = formula("h1 < 0 /\\ h2 < 1 /\\ t1 = 0 /\\ t2 = 0")
    assert nothing_in(inside, translation.definitions).verdict == "different"


# -- the record ---------------------------------------------------------------------------------------------------------


@needs_qepcad
@some_problems
def test_qepcad_finds_what_was_worked_out_by_hand(problem: Problem) -> None:
    truth = region_checks.truth_of(problem)
    assert truth is not None
    same = [problem.stable("all")] + ([formula(problem.region)] if problem.region is not None else [])
    for region in same:
        given = qepcad.assumptions(problem)
        proof = nothing_in(All((given, difference(truth, region))))
        assert proof.verdict == "same", proof


@needs_qepcad
@pytest.mark.parametrize("name", [problem.name for problem in PROBLEMS] if FULL else BY_ROOTS)
def test_where_roots_lie_is_what_liénard_and_chipart_say(name: str) -> None:  # noqa: PLC2401
    problem = by_name(name)
    by_roots = qepcad.region_by_roots(problem, SECONDS_FOR_ROOTS)
    if by_roots is None:
        assert name not in BY_ROOTS
        return
    proof = nothing_in(All((qepcad.assumptions(problem), difference(by_roots, problem.stable()))))
    assert proof.verdict == "same" or (proof.verdict == "not decided" and name not in BY_ROOTS), proof


# -- right and wrong answers --------------------------------------------------------------------------------------------


@tabled
def test_relations_are_held_against_a_set(name: str, relations: list[str], verdict: str) -> None:
    problem = by_name(name)
    proof = same_relations(problem, relations, problem.stable())
    assert proof.verdict == verdict
    assert (proof.point is not None) == (verdict == "different")


TWO = (("0", "CRootOf(3*x**3 + 3*x**2 + x - 3, 0)"), ("1", "CRootOf(x**3 - x - 1, 0)"))


@pytest.mark.parametrize(
    ("name", "intervals", "verdict"),
    [
        ("three_lags", (("-6", "60"),), "same"),
        ("three_lags", (("-6", "oo"),), "different"),
        ("algebraic_ends", (("sqrt(2)", "CRootOf(x**2 - 3*x - 2, 1)"),), "same"),
        ("algebraic_ends", (("sqrt(2)", "3/2 + sqrt(17)/2"),), "same"),
        ("algebraic_ends", (("sqrt(2)", "356155281280883/100000000000000"),), "different"),
        ("two_intervals", TWO, "same"),
        ("two_intervals", (("0", TWO[1][1]),), "different"),
        ("value_left_out", (("-2", "1"), ("1", "oo")), "same"),
        ("value_left_out", (("-2", "oo"),), "different"),
        ("empty_one", (), "same"),
    ],
)
def test_intervals_are_held_against_a_set(name: str, intervals: tuple[tuple[str, str], ...], verdict: str) -> None:
    problem = by_name(name)
    assert same_intervals(problem, Answer((), intervals), problem.stable()).verdict == verdict


def test_every_part_of_an_answer_is_proved() -> None:
    problem = by_name("hole_elsewhere")
    everything = Cell((("h1", "-oo", "oo"), ("h2", "-oo", "oo")), stable=True, sample={})
    answer = Answer(
        ("(h1 - 1)**2 + (h2 + 2)**2 > 0",),
        cells=(everything,),
        excluded_points=({"h1": "1", "h2": "-2"},),
        empty=False,
        bounded=False,
    )
    truth = problem.stable()
    found = {part: proof.verdict for part, proof in region_checks.proofs(problem, answer, truth)}
    assert found == {"stable_if": "same", "cells": "same", "bounded": "same"}
    filled = dict(region_checks.proofs(problem, replace(answer, excluded_points=(), bounded=True), truth))
    assert filled["cells"].point == {"h1": "1", "h2": "-2"}
    assert filled["bounded"].verdict == "different"


def test_cells_bounded_by_square_roots_are_proved() -> None:
    problem = by_name("sextic_lin")
    root = "(2*h1 + 9)*sqrt((h1 + 5)*(h1 + 9))/(h1 + 5)"
    bounds = (("h1", "-9/2", "oo"), ("h2", f"2*h1 + 9 - {root}", f"2*h1 + 9 + {root}"))
    inside = Cell(bounds, stable=True, sample={})
    above = Cell((bounds[0], ("h2", bounds[1][2], "oo")), stable=False, sample={})
    truth = problem.stable()
    for cells, verdict in [
        ((inside, above), "same"),
        ((replace(inside, stable=False), above), "different"),
        ((replace(inside, bounds=(bounds[0], ("h2", "0", f"1 + {bounds[1][2]}"))),), "different"),
    ]:
        assert region_checks._all_cells(Answer((), cells=cells), truth, 20).verdict == verdict


# -- symobs -------------------------------------------------------------------------------------------------------------


@needs_regions
@needs_qepcad
@some_problems
def test_symobs_finds_what_qepcad_finds(problem: Problem) -> None:
    truth = region_checks.truth_of(problem)
    assert truth is not None
    found = dict(region_checks.proofs(problem, region_answers.ask(problem), truth))
    assert {part: str(proof.point) for part, proof in found.items() if proof.verdict == "different"} == {}
    assert found["stable_if"].verdict == "same"
