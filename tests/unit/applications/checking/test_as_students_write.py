"""Answers as students write them: the last value counts, a decimal comma is never a wrong answer, nothing is a value."""

from __future__ import annotations

import time
from typing import Any

import pytest

from symobs.applications.checking import Checked
from tests.kit import tabled
from tests.support.problems.answered import SERVO


def problem(task: str, plant: str, asked: str, more: str = "") -> Checked:
    text = f'task = "{task}"\n[plant]\n{plant}\n{more}[marking]\nasked = ["{task}.{asked}"]\n'
    return Checked.of(text)


LOOP = Checked.of(SERVO)
OBSERVABLE = problem("observability", 'A = "[0 1; 0 -1]"\nC = "[1 0]"', "kernel")
UNOBSERVABLE = problem("observability", 'A = "[0 1; 0 -1]"\nC = "[0 1]"', "kernel")
NO_ZEROS = problem("transfer_function", 'A = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"', "zeros")
# (s + 5/2)/(s^2 + s): the zero is -5/2.
ONE_ZERO = problem("transfer_function", 'A = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[5/2 1]"', "zeros")
# s^2 + 4 s + 15/4 = (s + 3/2) (s + 5/2).
POLES = problem("transfer_function", 'A = "[0 1; -15/4 -4]"\nB = "[0; 1]"\nC = "[1 0]"', "poles")
MODAL = problem(
    "canonical_form", 'A = "[0 1; -2 -3]"\nB = "[0; 1]"\nC = "[1 0]"', "B", '[specification]\nkind = "modal"\n'
)
# s^2 + 3 s + 2 = (s + 1) (s + 2).
POLYNOMIAL = problem("characteristic_polynomial", 'A = "[0 1; -2 -3]"', "polynomial")
# s^2 + (h1 + 1) s + h2: h1 > -1 and h2 > 0.
REGION = Checked.of(
    'task = "stability_region"\n[specification]\npolynomial = "s^2 + (h1 + 1) s + h2"\nparameters = ["h1", "h2"]\n'
)


def verdicts(checked: Checked, answer: Any) -> dict[str, str]:
    """The verdicts on what was given, by letter."""
    report = checked.report(answer)
    return {part.letter: part.verdict for part in report.parts if part.verdict != "missing"}


@pytest.mark.parametrize(
    ("checked", "answer", "expected"),
    [
        (LOOP, "K = [5 3]\nK = [4 - 0, 4 - 1] = [4 3]\n", {"K": "right"}),
        (LOOP, "K = [4 3]\nK = [4, 4 - 1] = [5 3]\n", {"K": "wrong"}),
        (LOOP, "K = [5 3]\nK = [4 - 0, 4 - 1]\n  = [4 3]\n", {"K": "right"}),
        (LOOP, "L = [20 - 1; 100 - 19] = [19; 81]\n", {"L": "right"}),
        (LOOP, "F(s) = 1 = (319 s + 400)/(s^2 + 23 s + 161)\n", {"F": "right"}),
        (LOOP, "K := [4 3]\n", {"K": "right"}),
        (LOOP, "K = [4 3]\nK = [5 3] = ?\n", {"K": "unreadable"}),
        (LOOP, "K = [4 3]\nK = [5 3] =\n", {"K": "unreadable"}),
        (LOOP, "K = [4 3]\nK = [5 3] < 0\n", {"K": "unreadable"}),
        (POLYNOMIAL, "polynomial = s^2 + 3 s + 2 = (s + 1) (s + 2)\n", {"polynomial": "right"}),
        (POLYNOMIAL, "polynomial = s^2 + 2 s\npolynomial = s^2 + 3 s + 2 = 0\n", {"polynomial": "right"}),
        (POLYNOMIAL, "polynomial = 0\n", {"polynomial": "wrong"}),
    ],
)
def test_the_last_member_of_the_last_definition_is_the_answer(
    checked: Checked, answer: str, expected: dict[str, str]
) -> None:
    assert verdicts(checked, answer) == expected


@pytest.mark.parametrize(
    ("checked", "answer"),
    [
        (POLES, "poles = [-1,5; -2,5]\n"),
        (POLES, "poles = [-1,5, -2,5]\n"),
        (POLES, "poles = [-1,5 -2,5]\n"),
        (POLES, "poles = {-1,0; -1,0+2,0i}\n"),
        (POLES, "poles = -1,5; -2,5\n"),
        (POLES, {"poles": ["-1,5", "-2,5"]}),
        (ONE_ZERO, "zeros = {-2,5}\n"),
        (ONE_ZERO, "zeros = -2,5\n"),
        (MODAL, "B = [1,0; 1,0]\n"),
        (LOOP, "K = [3,75; 4,0]\n"),
        (LOOP, "K = [3,75 4,0]\n"),
    ],
)
def test_a_decimal_comma_is_refused_and_never_wrong(checked: Checked, answer: Any) -> None:
    part = next(part for part in checked.report(answer).parts if part.verdict != "missing")
    assert part.verdict == "unreadable"
    assert "with a decimal point" in part.reason


@pytest.mark.parametrize(
    ("checked", "answer", "verdict"),
    [
        (POLES, "poles = [-3/2,-5/2]\n", "right"),
        (POLES, "poles = -3/2; -5/2\n", "right"),
        (POLES, "poles = -1; -5\n", "wrong"),
        (POLES, "poles = {-1,-5}\n", "wrong"),
        (POLES, "poles = {1,2,3}\n", "wrong"),
        (ONE_ZERO, "zeros = {-2.5}\n", "right"),
        (ONE_ZERO, "zeros = {2,5,7}\n", "wrong"),
        (LOOP, "K = [4,3]\n", "right"),
        (LOOP, "K = [4,4]\n", "wrong"),
    ],
)
def test_a_comma_that_sets_entries_apart_is_read_as_one(checked: Checked, answer: str, verdict: str) -> None:
    assert set(verdicts(checked, answer).values()) == {verdict}


NOTHING = ["[]", "{}", "none", "None"]
ZERO = ["{0}", "0", "[0; 0]", "[0 0]", "{[0; 0]}"]


@pytest.mark.parametrize("written", [*NOTHING, *ZERO])
def test_no_kernel_but_zero(written: str) -> None:
    assert verdicts(OBSERVABLE, f"kernel = {written}\n") == {"kernel": "right"}
    assert verdicts(OBSERVABLE, {"kernel": written}) == {"kernel": "right"}
    assert verdicts(UNOBSERVABLE, f"kernel = {written}\n") == {"kernel": "wrong"}


@tabled
def test_no_kernel_but_zero_in_a_table(written: Any) -> None:
    assert verdicts(OBSERVABLE, {"kernel": written}) == {"kernel": "right"}


@tabled
def test_a_kernel_is_right_in_any_notation(written: Any) -> None:
    assert verdicts(UNOBSERVABLE, {"kernel": written}) == {"kernel": "right"}
    assert verdicts(OBSERVABLE, {"kernel": written}) == {"kernel": "wrong"}


@pytest.mark.parametrize("written", NOTHING)
def test_no_zeros(written: str) -> None:
    assert verdicts(NO_ZEROS, f"zeros = {written}\n") == {"zeros": "right"}
    assert verdicts(ONE_ZERO, f"zeros = {written}\n") == {"zeros": "wrong"}


@tabled
def test_a_region_in_lines(answer: Any, verdict: str) -> None:
    assert verdicts(REGION, answer) == {"stable_if": verdict}


@tabled
def test_the_same_value_in_cells_tables_and_programs(answer: Any, expected: dict[str, str]) -> None:
    assert verdicts(LOOP, answer) == expected


def test_a_long_line_of_definitions_is_refused_at_once() -> None:
    with pytest.raises(ValueError, match="lines, more than 200"):
        LOOP.report("a=1;" * 16000)


@tabled
def test_a_long_text_of_one_character_is_read_soon(again: str) -> None:
    """The bound is ten times what the slowest takes on a slow machine: it says "not quadratic", and measures nothing."""
    start = time.process_time()
    assert LOOP.report(("L = [19; 81]" + again * 60_000)[:60_000]).verdict in {"unreadable", "incomplete", "wrong"}
    assert time.process_time() - start < 10.0


def test_conditions_with_roots_are_undecided() -> None:
    (part,) = REGION.report({"stable_if": "h1 > -1, h2 > sqrt(2)"}).parts
    assert (part.verdict, part.given) == ("undecided", "h1 > -1, h2 > sqrt(2)")
    assert part.reason == "conditions with roots or functions are not compared"


def test_a_line_of_primes_is_read_soon() -> None:
    found = LOOP.report(f"K = [4 3]\ndet(s {chr(39) * 98} + L C) = (s + 1)^3").lines[-1]
    assert (found.verdict, "98 primes stand behind each other" in found.reason) == ("false", True)


def test_a_line_with_the_inverse_of_zero_is_no_fault_of_ours() -> None:
    line = (
        "integral((1), (integral((A), (C), (obsv((O), (K))), (obsv((B), (x_hat))))), (B), (-(2.5))) = [((0)^-1); (1)]"
    )
    found = LOOP.report(f"K = [4 3]\n{line}").lines[-1]
    assert (found.verdict, "is no time to integrate over" in found.reason) == ("false", True)
