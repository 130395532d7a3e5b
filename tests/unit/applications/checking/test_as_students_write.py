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

# 0 is not seen.
SEEN, DETECTED = (
    problem(task, 'A = "[0 1; 0 -1]"\nC = "[0 1]"', "verdict") for task in ("observability", "detectability")
)
PROBLEMS = {name: value for name, value in vars().items() if isinstance(value, Checked)}


def verdicts(checked: Checked, answer: Any) -> dict[str, str]:
    """The verdicts on what was given, by letter."""
    report = checked.report(answer)
    return {part.letter: part.verdict for part in report.parts if part.verdict != "missing"}


@tabled
def test_an_answer_has_its_verdicts(checked: str, answer: Any, expected: dict[str, str]) -> None:
    assert verdicts(PROBLEMS[checked], answer) == expected


@tabled
def test_a_decimal_comma_is_refused_and_never_wrong(checked: str, answer: Any) -> None:
    part = next(part for part in PROBLEMS[checked].report(answer).parts if part.verdict != "missing")
    assert part.verdict == "unreadable"
    assert "with a decimal point" in part.reason


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


@pytest.mark.parametrize("letter", ["chi", "chi_A(s)", "p(s)", "P"])
def test_an_answer_under_a_letter_of_its_own_is_no_unreadable_line(letter: str) -> None:
    checked = Checked.of('task = "characteristic_polynomial"\n[plant]\nA = "[1 2; 3 4]"\n')
    for value, verdict in (("s^2 - 5 s - 2", "right"), ("s^2 - 5 s - 3", "wrong")):
        report = checked.report(f"{letter} = {value}\nq = 3")
        assert report.parts[0].verdict == verdict
        assert [line.relation for line in report.lines] == ["q = 3"]
