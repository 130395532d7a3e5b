"""What a claim leaves open and what it does not: each test here fails if one comparison of the judgement is left out."""

from __future__ import annotations

from typing import Any

from symobs.applications.checking import Checked, check
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.answered import SERVO

EXAMPLES = ROOT / "worked_examples"


def verdicts(problem: str, answer: dict[str, Any]) -> dict[str, str]:
    return {part.letter: part.verdict for part in check(problem, answer).parts if part.letter in answer}


REGION = (
    'task = "stability_region"\n[specification]\npolynomial = "s^3 + s^2 + 3 s + h"\nparameters = "h"\n'  # 0 < h < 3
)


@tabled
def test_what_conditions_say_at_their_boundary(conditions: str, verdict: str) -> None:
    assert verdicts(REGION, {"stable_if": conditions})["stable_if"] == verdict


@tabled
def test_a_declared_sign_leaves_out_its_boundary(conditions: str, verdict: str) -> None:
    positive = REGION.replace("[specification]", '[symbols]\nh = "positive"\n[specification]')
    assert verdicts(positive, {"stable_if": conditions})["stable_if"] == verdict


def test_columns_of_a_block_may_be_permuted_and_others_not() -> None:
    problem = 'task = "controllability"\n[plant]\nA = "[0 1; 0 0]"\nB = "[0 1; 1 2]"\n'
    problem += '[marking]\nasked = ["controllability.matrix"]\n'
    # [B AB] = [0 1 1 2; 1 2 0 0]
    for matrix, verdict in (
        ("[0 1 1 2; 1 2 0 0]", "right"),
        ("[1 0 2 1; 2 1 0 0]", "right"),
        ("[1 2 0 1; 0 0 1 2]", "wrong"),
        ("[1 0 2 1; 2 1 0 1]", "wrong"),
    ):
        assert verdicts(problem, {"matrix": matrix}) == {"matrix": verdict}


@tabled
def test_a_verdict_is_a_word(given: object, verdict: str) -> None:
    problem = 'task = "detectability"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'
    assert verdicts(problem, {"verdict": given}) == {"verdict": verdict}


@tabled
def test_a_text_writes_a_list_in_brackets(given: str, verdict: str) -> None:
    problem = (EXAMPLES / "servo_initial_state.toml").read_text("utf-8")
    report = Checked.of(problem).report(f"x0 = {given}\n")
    assert [part.verdict for part in report.parts] == [verdict]
    assert {line.verdict for line in report.lines} <= {"true" if verdict == "right" else "false"}


def test_what_follows_in_the_other_coordinates_says_so() -> None:
    """[A, -BK; LC, A - BK - LC] of the servo with K = [4 3] and the wrong L = [19; 80]."""
    asked = Checked.of(SERVO + '[marking]\nasked = ["compensator.closed_loop_matrix_estimate"]\n')
    estimate = "[0 1 0 0; 0 -1 -4 -3; 19 0 -19 1; 80 0 -84 -4]"
    error = "[0 1 0 0; -4 -4 4 3; 0 0 -19 1; 0 0 -80 -1]"
    for matrix, hints in ((estimate, ()), (error, ("in the state and the error",))):
        part = asked.report({"K": "[4 3]", "L": "[19; 80]", "closed_loop_matrix_estimate": matrix}).parts[0]
        assert (part.verdict, part.hints, part.origins) == ("follows", hints, ("compensator.L",))


def test_what_does_not_exist_is_wrong_in_any_form() -> None:
    problem = 'task = "compensator"\n[plant]\nA = "[1 0; 0 2]"\nB = "[1; 1]"\nC = "[1 0]"\n'
    problem += '[specification]\ncontrol_poles = "-1, -2"\nobserver_poles = "-1, -2"\n'
    parts = {part.letter: part for part in check(problem, {"F": "1/s", "L": ["3", "0"]}).parts}
    assert (parts["F"].verdict, parts["F"].reason) == ("wrong", "there is no F here")
    assert (parts["L"].verdict, "yours is" in parts["L"].reason) == ("wrong", False)


def test_tracking_does_not_depend_on_a_wrong_gain() -> None:
    problem = Checked.of((EXAMPLES / "servo_tracking.toml").read_text("utf-8"))
    for K_d, verdict in (("[omega^2 -1]", "right"), ("[omega^2 1]", "wrong")):
        parts = {part.letter: part for part in problem.report({"K": "[5 3]", "L": "[-9]", "K_d": K_d}).parts}
        assert (parts["K_d"].verdict, parts["K"].verdict, parts["L"].slip) == (verdict, "wrong", "sign")
    given = {"K": "[5 3]", "error_matrix": "[0 1 0; -5 -4 -3; 0 0 -10]"}
    assert {part.letter: part.verdict for part in problem.report(given).parts}["error_matrix"] == "follows"


@tabled
def test_whether_a_polynomial_is_stable_is_answered_by_a_word(polynomial: str, given: str, verdict: str) -> None:
    problem = f'task = "stability_region"\n[specification]\npolynomial = "{polynomial}"\nparameters = []\n'
    assert verdicts(problem, {"stable_if": given}) == {"stable_if": verdict}
