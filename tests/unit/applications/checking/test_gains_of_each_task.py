"""Gains of every task that has some: other valid ones, wrong ones and what follows; and gains where there are none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.applications.checking import check
from symobs.ground.errors import NotShown
from symobs.problem import read
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.design.reference.integral_action import IntegralAction
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.answered import SERVO

if TYPE_CHECKING:
    import pytest

EXAMPLES = ROOT / "worked_examples"
UNKNOWN_INPUT = (EXAMPLES / "unknown_input_observer.toml").read_text("utf-8")
NOT_DECOUPLED = (EXAMPLES / "unknown_input_not_decoupled.toml").read_text("utf-8")
SERVO_FEEDFORWARD = (EXAMPLES / "servo_feedforward.toml").read_text("utf-8")
#: ẋ = u₁ + u₂, y = x: K = [k₁; k₂] with k₁ + k₂ = 2, and F = [f₁; f₂] with f₁ + f₂ = k₁ + k₂.
TWO_INPUTS = (
    'task = "feedforward"\n[plant]\nA = "[0]"\nB = "[1 1]"\nC = "[1]"\n'
    '[specification]\ncontrol_poles = "-2"\nobserver_poles = "-3"\n'
)
#: ẋ = u, y = x: K with the eigenvalues 1 and 2, and F = K.
TWO_OF_EACH = (
    'task = "feedforward"\n[plant]\nA = "[0 0; 0 0]"\nB = "[1 0; 0 1]"\nC = "[1 0; 0 1]"\n'
    '[specification]\ncontrol_poles = "-1, -2"\nobserver_poles = "-3, -4"\n'
)
#: ẋ₁ = x₂ + u₁, ẋ₂ = u₂ and y = x₁; what is to be followed is constant.
TRACKING = (
    'task = "tracking"\n[plant]\nA = "[0 1; 0 0]"\nB = "[1 0; 0 1]"\nC = "[1 0]"\n'
    '[specification]\ncontrol_poles = "-1, -2"\nobserver_poles = "-3"\nreference_matrix = "[0 0; 0 0]"\n'
)
INTEGRAL = (
    'task = "integral_action"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
    '[specification]\npoles = "-1, -2, -3"\n'
)
#: The integral of x₁' is x₁: the sum of both integrals cannot be moved.
NO_INTEGRAL = INTEGRAL.replace('C = "[1 0]"', 'C = "[0 1]"')
TWO_INTEGRALS = (
    'task = "integral_action"\n[plant]\nA = "[0 0; 0 0]"\nB = "[1 0; 0 1]"\nC = "[1 0; 0 1]"\n'
    '[specification]\npoles = "-1, -1, -2, -2"\n'
)
NO_FEEDBACK = 'task = "state_feedback"\n[plant]\nA = "[1 0; 0 2]"\nB = "[1; 0]"\n[specification]\npoles = "-1, -2"\n'
PROBLEMS = {name: text for name, text in vars().items() if name.isupper()}


def judged(problem: str, answer: Any, **options: Any) -> dict[str, Any]:
    return {part.letter: part for part in check(read(problem), answer, **options).parts if part.given}


@tabled
def test_other_gains_and_what_follows_from_them(problem: str, answer: dict[str, str], verdicts: str) -> None:
    for given in (answer, dict(reversed(answer.items()))):
        found = judged(PROBLEMS[problem], given)
        assert " ".join(found[letter].verdict for letter in answer) == verdicts
        for letter, part in found.items():
            wrong = tuple(part.part for part in found.values() if part.verdict == "wrong")
            assert part.origins == (wrong if part.verdict == "follows" else ())
            assert part.given == given[letter]


@tabled
def test_a_gain_that_is_none_is_wrong_with_the_reason(problem: str, answer: dict[str, str], reasons: list[str]) -> None:
    found = judged(PROBLEMS[problem], answer)
    for part, reason in zip(found.values(), reasons, strict=True):
        assert part.reason.endswith(reason)
        assert (part.reason == "") is (reason == "")
        assert part.verdict == ("right" if not reason else "unreadable" if "write" in reason else "wrong")


def test_a_gain_whose_claim_is_too_large_is_left_to_a_human(monkeypatch: pytest.MonkeyPatch) -> None:
    def raising(*_: object) -> None:
        raise NotShown("too large")

    monkeypatch.setattr(OutputFeedback, "with_gains", raising)
    part = judged(SERVO, {"L": "[19; 82]"})["L"]
    assert (part.verdict, part.credit, part.reason, part.given) == ("undecided", None, "too large", "[19; 82]")
    monkeypatch.setattr(IntegralAction, "with_gains", raising)
    assert judged(TWO_INTEGRALS, {"K": "[3 1; 0 3]", "k_I": "[2 0; 0 2]"})["K"].verdict == "undecided"


@tabled
def test_rows_and_commas_of_a_matrix(task: str, given: str, verdict: str) -> None:
    plant = '[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'
    found = judged(f'task = "{task}"\n{plant}[marking]\nasked = ["{task}.matrix"]\n', {"matrix": given})["matrix"]
    assert found.verdict == verdict


@tabled
def test_any_compensator_closes_the_loop_if_it_is_proper_and_of_no_larger_order(
    problem: str, F: str, verdict: str
) -> None:
    assert judged(problem, {"F": F})["F"].verdict == verdict


def test_any_gain_that_follows_the_one_reference_is_right() -> None:
    """The trajectory is (v t, 0, 0, v): the second and third entry of K_d multiply 0."""
    text = (EXAMPLES / "cart_tracking.toml").read_text("utf-8")
    for gain, verdict in (("[0 2 3 0]", "right"), ("[1 0 0 0]", "wrong"), ("[0 0 0 1]", "wrong")):
        assert [part.verdict for part in check(text, {"K_d": gain}).parts if part.given] == [verdict]
