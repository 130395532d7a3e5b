"""Answers with roots of letters: one normal form in `check`, `[expect]` and `audit`; what is open is never wrong."""

from __future__ import annotations

from collections import Counter
from functools import cache
from typing import TYPE_CHECKING

import pytest

from symobs.applications.audit import audit
from symobs.applications.checking import Checked
from symobs.ground.errors import OpenEquality, ProblemErrors
from symobs.problem import read
from symobs.problem.expect import held_against
from tests.kit import tabled
from tests.support.problems.answers_with_roots import PROBLEMS, Problem, forms
from tests.support.sampling import FULL
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

SEED = "roots of letters"
#: Of forms that are right so many in a hundred may be undecided.
OPEN = 2


@cache
def checked(text: str) -> Checked:
    return Checked.of(text)


def verdict(text: str, answer: str) -> str:
    (part,) = checked(text).report(answer).parts
    return part.verdict


def expected(problem: Problem, text: str) -> str:
    solved = checked(problem.text)
    try:
        unmet, is_open = held_against(solved.problem.viewed(solved.results), {problem.field: text})
    except ProblemErrors:
        return "unreadable"
    return "undecided" if is_open else "wrong" if unmet else "right"


def audited(problem: Problem, text: str) -> str:
    """What the audit says of the printed answer; a matrix of functions of time has no letter there."""
    if problem.field == "matrix":
        return expected(problem, text)
    try:
        found = audit(read(f'{problem.text}\n[[printed]]\nrelation = "{problem.field} = {text}"'))
    except ProblemErrors as error:
        return "undecided" if {*map(type, error.errors)} == {OpenEquality} else str(error)
    return "wrong" if any(not finding.holds for finding in found.findings) else "right"


def judged(problem: Problem, text: str) -> tuple[str, str]:
    return verdict(problem.text, f"{problem.field} = {text}"), expected(problem, text)


def hold_forms(count: int) -> None:
    found = [(problem.name, text, *judged(problem, text)) for problem, text in forms(count, SEED, right=True)]
    assert [each for each in found if not {*each[2:]} <= {"right", "undecided"}] == []
    assert sum(each[2] == "undecided" for each in found) <= max(1, count * OPEN // 100)


def hold_misses(count: int) -> None:
    found = Counter[str]()
    for problem, text in forms(count, f"{SEED}, missed", right=False):
        verdicts = judged(problem, text)
        assert "right" not in verdicts, (problem.name, text)
        found[verdicts[0]] += 1
    assert found["wrong"] > count * 9 // 10


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
def test_the_answer_worked_out_by_hand_is_right(problem: Problem) -> None:
    text = "[" + "; ".join(", ".join(map(str, row)) for row in problem.rows) + "]"
    assert {*judged(problem, text), audited(problem, text)} == {"right"}


def test_some_forms_are_right_and_some_near_misses_wrong() -> None:
    hold_forms(12)
    hold_misses(12)


@pytest.mark.slow
@pytest.mark.parametrize("hold", [hold_forms, hold_misses], ids=["forms", "near misses"])
def test_many_forms_are_right_and_as_many_near_misses_wrong(hold: Callable[[int], None]) -> None:
    hold(200 if FULL else 60)


@pytest.mark.slow
def test_the_audit_says_the_same() -> None:
    for right, wanted in ((True, {"right", "undecided"}), (False, {"wrong", "undecided"})):
        for problem, text in forms(60 if FULL else 20, f"{SEED}, printed", right=right):
            assert audited(problem, text) in wanted, (problem.name, text)


DOUBLE = """
task = "lqr"
[symbols]
r = "positive"
q = "positive"
[plant]
A = "[0 1; 0 0]"
B = "[0; 1]"
[specification]
Q = "[q 0; 0 0]"
R = "r"
"""


@tabled
def test_answers_as_they_are_typed(text: str, told: str) -> None:
    """By hand K = [√(q/r), √2 (q/r)^(1/4)] for the double integrator that weighs the position."""
    assert verdict(DOUBLE, text) == told


def test_only_the_wrong_entry_is_named() -> None:
    report = checked(DOUBLE.replace("q 0; 0 0", "1 0; 0 1")).report("K = [1/sqrt(r) 5]")
    assert report.parts[0].verdict == "wrong"
    assert "(1, 2)" in report.parts[0].reason
    assert not any("(1, 1)" in line.reason for line in report.lines)
    assert "(1, 1)" not in report.parts[0].reason


#: √(e^{2x}) has an exponential below a root, of which nothing is decided.
OPEN_ANSWER = """
task = "matrix_exponential"
[symbols]
a = "positive"
[plant]
A = "[a]"
"""


def test_what_is_open_is_marked_by_hand(tmp_path: Path) -> None:
    report = checked(OPEN_ANSWER).report({"matrix": "sqrt(exp(2*a*t))"})
    assert (report.verdict, report.exit_code, report.score) == ("undecided", 5, None)
    file = tmp_path / "open.toml"
    file.write_text(f'{OPEN_ANSWER}[expect]\nmatrix = "sqrt(exp(2*a*t))"', "utf-8")
    done = inside("solve", str(file))
    assert done.code == 5
    assert "not decided" in done.err
    assert "begin{document}" in done.out or "exp" in done.out or "e^" in done.out
