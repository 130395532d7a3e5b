"""Answers to observers with disturbances: gains that are right together, and every H that decouples."""

from __future__ import annotations

from typing import Any

from symobs.applications.checking import check

#: The error of (x, w) has the matrix [-l11, 1 - l12, 0; -l21, -l22, 1; -l31, -l32, 0].
CONSTANT = """task = "disturbance_observer"
[plant]
A = "[0 1; 0 0]"
C = "[1 0; 0 1]"
[specification]
E = "[0; 1]"
poles = "-1, -2, -3"
"""
UNKNOWN = """task = "unknown_input_observer"
[plant]
A = "[0 1 0; 0 0 1; -1 -2 -3]"
C = "[1 0 0; 0 0 1]"
[specification]
E = "[1; 0; 0]"
poles = "-2, -3, -4"
"""
HIDDEN = """task = "unknown_input_observer"
[plant]
A = "[0 1; 0 0]"
C = "[1 0]"
[specification]
E = "[0; 1]"
poles = "-1, -2"
"""


def verdicts(problem: str, answer: Any) -> dict[str, str]:
    return {part.letter: part.verdict for part in check(problem, answer).parts}


def test_one_gain_of_two_is_not_judged_alone() -> None:
    half = check(CONSTANT, {"L_w": "[0 6]"}).parts[1]
    assert (half.verdict, half.reason) == ("undecided", "L_x and L_w are right together: give both")


def test_what_is_asked_for_and_what_is_said_where_nothing_exists() -> None:
    assert list(verdicts(UNKNOWN, {})) == ["H", "L"]
    assert verdicts(UNKNOWN, {"H": "[2 1; 0 2; 0 3]"})["H"] == "wrong"
    for said, verdict in (("yes", "wrong"), ("false", "right"), (False, "right"), ("perhaps", "unreadable")):
        assert verdicts(HIDDEN, {"solvable": said})["solvable"] == verdict
    report = check(HIDDEN, {"verdict": "no", "L": "[1; 2]", "H": "[1; 0]"})
    assert [(part.letter, part.verdict) for part in report.parts] == [
        ("verdict", "right"),
        ("L", "wrong"),
        ("H", "wrong"),
    ]


def test_a_right_answer_that_is_not_unique_is_no_false_line() -> None:
    feedforward = """task = "feedforward"
[plant]
A = "[0 1; 0 0]"
B = "[1 0; 0 1]"
C = "[1 0]"
[specification]
control_poles = "-1, -2"
observer_poles = "-3, -4"
"""
    report = check(feedforward, "F = [1; 0]")
    assert report.verdict == "right"
    assert [line.verdict for line in report.lines] == ["true"]
    assert not report.hints
