"""Answers that are functions of time: their names, the lines that state them, and why one is wrong."""

from __future__ import annotations

import re

import pytest

from symobs.applications.checking import Checked
from symobs.ground.errors import ProblemErrors
from tests.kit import tabled

# x1' = x2, x2' = -a x2 + 1 from rest: x2 = (1 - e^(-a t))/a, and x1 is its integral; checked in both equations by hand.
STEP = Checked.of(
    'task = "response"\n[symbols]\na = "positive"\n[plant]\nA = "[0 1; 0 -a]"\nB = "[0; 1]"\nC = "[1 0]"\n'
    '[specification]\ninput = "1"\n[marking]\nasked = ["response.state", "response.output"]\n'
)
EXPONENTIAL = Checked.of('task = "matrix_exponential"\n[plant]\nA = "[0 1; 0 -1]"\n')
FIRST = "t/a - 1/a^2 + exp(-a t)/a^2"
STATE = f"[{FIRST}; 1/a - exp(-a*t)/a]"


@tabled
def test_the_letters_of_the_page_name_the_parts(x: str, y: str) -> None:
    report = STEP.report(f"{x} = {STATE}\n{y} = {FIRST}")
    assert (report.verdict, report.first_false) == ("right", None)
    assert STEP.report({x: STATE, y: FIRST}).verdict == "right"
    assert STEP.report({"response": {x: STATE, y: FIRST}}).verdict == "right"


@tabled
def test_the_matrix_exponential_is_called_as_on_the_page(name: str) -> None:
    report = EXPONENTIAL.report(f"{name} = [1 1 - exp(-t); 0 exp(-t)]")
    assert (report.verdict, report.first_false) == ("right", None)
    report = EXPONENTIAL.report(f"{name} = [1 1 + exp(-t); 0 exp(-t)]")
    assert (report.parts[0].verdict, report.parts[0].slip) == ("wrong", "entry")


@tabled
def test_lines_that_state_a_function_of_time(line: str, verdict: str) -> None:
    (found,) = STEP.report({"answer": {}, "step": [{"relation": line}]}).lines
    assert found.verdict == verdict


def test_a_function_of_time_that_is_wrong_is_not_given_away() -> None:
    report = STEP.report("output = t/a - 1/a^2\ny(t) = t/a - 1/a^2\nx(t) = [1; 2]", "solution")
    (part,) = [part for part in report.parts if part.part == "response.output"]
    assert (part.verdict, part.slip, part.reason) == ("wrong", None, "")
    assert "exp(-t*a)" in str(part.right)
    assert [line.reason for line in report.lines[-2:]] == [
        "its sides are not equal",
        "not right: entry (1, 1), entry (2, 1)",
    ]
    assert all("exp" in (line.right or "") for line in report.lines[-2:])


def test_powers_of_e_are_read_in_answers_and_told_how_they_are_written_in_problems() -> None:
    report = STEP.report("output = t/a - 1/a^2 + e^(-a t)/a^2\ny(t) = t/a - 1/a^2 + e^{-a t}/a^2")
    assert next(part.verdict for part in report.parts if part.part == "response.output") == "right"
    assert {line.verdict for line in report.lines} == {"true"}
    said = "write exp(-a*t) for e^(-a*t)"
    with pytest.raises(ProblemErrors, match=re.escape(said)):
        Checked.of('task = "response"\n[plant]\nA = "[-1]"\nB = "[1]"\n[specification]\ninput = "e^-t"\n')
