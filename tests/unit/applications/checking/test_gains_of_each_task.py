"""Gains of every task that has some: other valid ones, wrong ones and what follows; and gains where there are none."""

from __future__ import annotations

from typing import Any

import pytest

import symobs
from symobs.applications.checking import Checked, check
from symobs.ground.errors import NotShown
from symobs.problem import read
from symobs.tasks.design.compensator.output_feedback import OutputFeedback
from symobs.tasks.design.reference.integral_action import IntegralAction
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.answered import SERVO

EXAMPLES = ROOT / "worked_examples"
UNKNOWN_INPUT = (EXAMPLES / "unknown_input_observer.toml").read_text(encoding="utf-8")
NOT_DECOUPLED = (EXAMPLES / "unknown_input_not_decoupled.toml").read_text(encoding="utf-8")
SERVO_FEEDFORWARD = (EXAMPLES / "servo_feedforward.toml").read_text(encoding="utf-8")
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
SIZE = "{} is {} here, yours is {}"
NONE = "there is no {} here"


def judged(problem: str, answer: Any, **options: Any) -> dict[str, Any]:
    return {part.letter: part for part in check(read(problem), answer, **options).parts if part.given}


@pytest.mark.parametrize(
    ("problem", "answer", "verdicts"),
    [
        (TWO_INPUTS, {"F": "[2; 0]"}, "right"),
        (TWO_INPUTS, {"F": "[1; 0]"}, "wrong"),
        (TWO_INPUTS, {"K": "[2; 0]", "F": "[-5; 7]"}, "right right"),
        (TWO_INPUTS, {"K": "[1; 0]", "F": "[2; 0]"}, "wrong right"),
        (TWO_INPUTS, {"K": "[1; 0]", "F": "[3; -2]"}, "wrong follows"),
        (TWO_INPUTS, {"K": "[1; 0]", "F": "[3; -1.5]"}, "wrong wrong"),
        (TWO_OF_EACH, {"K": "[1 5; 0 2]", "F": "[1 5; 0 2]"}, "right right"),
        (TWO_OF_EACH, {"K": "[1 5; 0 2]", "F": "[1 0; 0 2]"}, "right wrong"),
        (TWO_OF_EACH, {"L": "[3 1; 0 4]", "F": "[1 0; 0 2]"}, "right right"),
        (TWO_OF_EACH, {"L": "[3 1; 0 5]", "F": "[1 0; 0 2]"}, "wrong right"),
        (SERVO_FEEDFORWARD, {"K": "[0 3]", "F": "5"}, "wrong wrong"),  # nothing follows: there is no F then
        (SERVO_FEEDFORWARD, {"K": "[5 3]", "F": "5"}, "wrong follows"),
        # [A - BK, -BK e2; 0, -3] for A - BK = [-1 4; 0 -2]
        (TRACKING, {"K": "[1 -3; 0 2]", "error_matrix": "[-1 4 3; 0 -2 -2; 0 0 -3]"}, "right right"),
        (TRACKING, {"K": "[1 -3; 0 2]", "error_matrix": "[-1 0 -1; 0 -2 -2; 0 0 -3]"}, "right wrong"),
        (TRACKING, {"K": "[1 -3; 0 3]", "error_matrix": "[-1 4 3; 0 -3 -3; 0 0 -3]"}, "wrong follows"),
        (INTEGRAL, {"K": "[11 6]"}, "wrong"),
        (INTEGRAL, {"k_I": "5"}, "wrong"),
        (INTEGRAL, {"k_I": "6"}, "right"),
        (TWO_INTEGRALS, {"K": "[3 0; 0 3]", "k_I": "[2 1; 0 2]"}, "right right"),
        (TWO_INTEGRALS, {"K": "[3 1; 0 3]", "k_I": "[2 0]"}, "wrong wrong"),
        (TWO_INTEGRALS, {"K": "[3 0]", "k_I": "[2 0; 0 2]"}, "wrong wrong"),
        (TWO_INTEGRALS, {"k_I": "[2 0; 0 2]"}, "undecided"),
        # F = T A - L C with T A = [0 0 0; -1 0 0; 0 -1 -1]
        (UNKNOWN_INPUT, {"L": "[2 0; -1 -12; 0 6]", "F": "[-2 0 0; 0 0 12; 0 -1 -7]"}, "right right"),
        (UNKNOWN_INPUT, {"L": "[2 0; -1 -12; 0 6]", "F": "[-2 0 0; 0 0 12; 0 -1 -8]"}, "right wrong"),
        (UNKNOWN_INPUT, {"L": "[2 0; -1 -12; 0 7]", "F": "[-2 0 0; 0 0 12; 0 -1 -8]"}, "wrong follows"),
        (UNKNOWN_INPUT, {"L": "[2 0; -1 -12; 0 7]", "F": "[-2 0 0; 0 0 12; 0 -1 -9]"}, "wrong wrong"),
        (UNKNOWN_INPUT, {"L": "[2 0 1]", "F": "[-2 0 0; 0 0 12; 0 -1 -9]"}, "wrong wrong"),
    ],
    ids=str,
)
def test_other_gains_and_what_follows_from_them(problem: str, answer: dict[str, str], verdicts: str) -> None:
    for given in (answer, dict(reversed(answer.items()))):
        found = judged(problem, given)
        assert " ".join(found[letter].verdict for letter in answer) == verdicts
        for letter, part in found.items():
            wrong = tuple(part.part for part in found.values() if part.verdict == "wrong")
            assert part.origins == (wrong if part.verdict == "follows" else ())
            assert part.given == given[letter]


@pytest.mark.parametrize(
    ("problem", "answer", "reasons"),
    [
        (NOT_DECOUPLED, {"L": "[1]"}, (NONE.format("L"),)),
        (NOT_DECOUPLED, {"L": "[1 1; 1 1; 1 1]"}, (NONE.format("L"),)),
        (NO_INTEGRAL, {"K": "[11 5]", "k_I": "6"}, (NONE.format("K"), NONE.format("k_I"))),
        (NO_INTEGRAL, {"k_I": "[6 2]"}, (NONE.format("k_I"),)),
        (NO_FEEDBACK, {"K": "[1 2 3]"}, (SIZE.format("K", "1x2", "1x3"),)),
        (NO_FEEDBACK, {"K": "[1; 2]"}, (SIZE.format("K", "1x2", "2x1"),)),
        (NO_FEEDBACK, {"K": "[1 2]"}, ("with your K the polynomial is s**2 - 2*s, not the one asked for",)),
        (INTEGRAL, {"K": "[11 5]", "k_I": "[6 1]"}, ("", SIZE.format("k_I", "1x1", "1x2"))),
        (UNKNOWN_INPUT, {"L": "[2 0 1]"}, (SIZE.format("L", "3x2", "1x3"),)),
        (UNKNOWN_INPUT, {"L": "[2 0; -1 -12; 0 7]"}, ("entry (3,2) should be 6 with the others as they are",)),
        (SERVO, {"L": "[a; b]"}, ("; write numbers alone",)),
    ],
    ids=str,
)
def test_a_gain_that_is_none_is_wrong_with_the_reason(
    problem: str, answer: dict[str, str], reasons: tuple[str]
) -> None:
    found = judged(problem, answer)
    for part, reason in zip(found.values(), reasons, strict=True):
        assert part.reason.endswith(reason)
        assert (part.reason == "") is (reason == "")
        assert part.verdict == ("right" if not reason else "unreadable" if "write" in reason else "wrong")


def test_conditions_that_a_problem_has_anyway_are_no_hint() -> None:
    problem = 'task = "observer"\n[symbols]\nalpha = "real"\n[plant]\nA = "[0 0; 0 0]"\nC = "[alpha 0; 0 1]"\n'
    problem += '[specification]\npoles = "-1, -2"\n'
    part = judged(problem, {"L": "[1/alpha 5; 0 2]"})["L"]
    assert (part.verdict, part.hints) == ("right", ())
    part = judged(problem, {"L": "[1/alpha 5/(alpha - 1); 0 2]"})["L"]
    assert (part.verdict, part.hints) == ("right", ("not defined where alpha - 1 = 0",))


def test_a_gain_whose_claim_is_too_large_is_left_to_a_human(monkeypatch: pytest.MonkeyPatch) -> None:
    def raising(*_: object) -> None:
        raise NotShown("too large")

    monkeypatch.setattr(OutputFeedback, "with_gains", raising)
    part = judged(SERVO, {"L": "[19; 82]"})["L"]
    assert (part.verdict, part.credit, part.reason, part.given) == ("undecided", None, "too large", "[19; 82]")
    monkeypatch.setattr(IntegralAction, "with_gains", raising)
    assert judged(TWO_INTEGRALS, {"K": "[3 1; 0 3]", "k_I": "[2 0; 0 2]"})["K"].verdict == "undecided"


@pytest.mark.parametrize("error", [NotShown, symobs.SymobsError])
def test_where_nothing_follows_from_a_wrong_gain_the_rest_is_wrong(
    error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    def raising(*_: object) -> None:
        raise error("nothing follows")

    monkeypatch.setattr(OutputFeedback, "following_from", raising)
    found = judged(SERVO, {"L": "[19; 82]", "F": "1/s"})
    assert [part.verdict for part in found.values()] == ["wrong", "wrong"]


@tabled
def test_rows_and_commas_of_a_matrix(task: str, given: str, verdict: str) -> None:
    plant = '[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"\n'
    found = judged(f'task = "{task}"\n{plant}[marking]\nasked = ["{task}.matrix"]\n', {"matrix": given})["matrix"]
    assert found.verdict == verdict


def test_in_a_convention_that_exchanges_letters_each_value_is_that_of_its_own() -> None:
    """In S1 the matrix of y is G and that of u is H."""
    problem = (
        'task = "reduced_order_observer"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
        '[specification]\npoles = "-10"\n'
    )
    names = Checked.of(problem).report({"F": "[-10]"}, convention="S1").parts
    letters = {part.part.partition(".")[2]: part.letter for part in names}
    right = {letters["F"]: "[-10]", letters["G"]: "[1]", letters["H"]: "[-90]", letters["M"]: "[1 0; 9 1]"}
    found = judged(problem, right, convention="S1")
    assert {part.verdict for part in found.values()} == {"right"}
    assert [part.part.partition(".")[2] for part in found.values()] == ["F", "G", "H", "M"]
    broken = judged(problem, {**right, letters["H"]: "[-90"}, convention="S1")
    assert {part.part.partition(".")[2]: part.verdict for part in broken.values()} == {
        "F": "right",
        "G": "right",
        "H": "unreadable",
        "M": "right",
    }
    assert broken[letters["H"]].given == "[-90"


@tabled
def test_any_compensator_closes_the_loop_if_it_is_proper_and_of_no_larger_order(
    problem: str, F: str, verdict: str
) -> None:
    assert judged(problem, {"F": F})["F"].verdict == verdict


def test_a_list_in_place_of_a_row_or_a_column() -> None:
    initial = (EXAMPLES / "servo_initial_state.toml").read_text(encoding="utf-8")
    dual = 'task = "dual"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"\n'
    for problem, answer in (
        (initial, {"x0": ["x10", "x20"]}),
        (dual, {"B": ["1", "0"], "C": [0, 1]}),
        (SERVO, {"L": "L = array([19, 81])", "K": "K = [4, 3];"}),
        (SERVO, {"L": "L = np.array([[19], [81]]);"}),
    ):
        assert {part.verdict for part in judged(problem, answer).values()} == {"right"}


def test_lists_of_numbers_may_be_complex_and_those_of_conditions_are_none() -> None:
    problem = 'task = "observer"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\npoles = "-1+i, -1-i"\n'
    problem += '[marking]\nasked = ["observer.poles", "observer.stable_if"]\n'
    for poles, verdict in (("[-1+i; -1-i]", "right"), ("[-1-i, -1+i]", "right"), ("[-1-2i, -1+i]", "wrong")):
        assert judged(problem, {"poles": poles})["poles"].verdict == verdict
    assert judged(problem, {"stable_if": "none"})["stable_if"].verdict == "wrong"
    assert judged(problem, {"stable_if": []})["stable_if"].verdict == "right"
    advice = (EXAMPLES / "dominant_pair_pole_advice.toml").read_text(encoding="utf-8")
    assert judged(advice, {"poles": "[-10; -10; -12; -2 + 52/25 i; -2 - 52/25 i]"})["poles"].verdict == "right"
    assert judged(f'{SERVO}[marking]\nasked = ["compensator.conditions"]\n', {"conditions": "h"})


def test_another_right_gain_and_what_follows_from_it_alone() -> None:
    """A - L C of two integrators, both measured: with L = [l1 1; 0 l2] it is diag(-l1, -l2)."""
    plant = '[plant]\nA = "[0 1; 0 0]"\nB = "[0; 1]"\nC = "[1 0; 0 1]"\n[specification]\n'
    observer = f'task = "observer"\n{plant}poles = "-3, -4"\n[marking]\nasked = ["observer.A"]\n'
    tracking = f'task = "tracking"\n{plant}control_poles = "-1, -2"\nobserver_poles = "-3, -4"\n'
    tracking += 'observer = "full"\nreference_matrix = "[0 1; 0 0]"\n[marking]\nasked = ["tracking.L"]\n'
    for first, second, verdict in ((3, 4, "right"), (4, 3, "right"), (3, 3, "wrong")):
        matrix = {"A": f"[-{first} 0; 0 -{second}]"}
        assert [part.verdict for part in check(observer, matrix).parts] == [verdict]
        assert [part.verdict for part in check(tracking, {"L": f"[{first} 1; 0 {second}]"}).parts] == [verdict]


def test_any_gain_that_follows_the_one_reference_is_right() -> None:
    """The trajectory is (v t, 0, 0, v): the second and third entry of K_d multiply 0."""
    text = (EXAMPLES / "cart_tracking.toml").read_text(encoding="utf-8")
    for gain, verdict in (("[0 2 3 0]", "right"), ("[1 0 0 0]", "wrong"), ("[0 0 0 1]", "wrong")):
        assert [part.verdict for part in check(text, {"K_d": gain}).parts if part.given] == [verdict]
