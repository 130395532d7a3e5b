"""Derivations: the first false line, what follows from it, and letters that stand for unknowns."""

from __future__ import annotations

from fractions import Fraction

import pytest

from symobs.applications.checking import Checked
from tests.kit import tabled
from tests.support.problems.answered import SERVO, TWO_OUTPUTS

# Of the servo A = [0 1; 0 -1], B = [0; 1], C = [1 0], worked out by hand: K = [4 3], L = [19; 81],
# A - L C = [-19 1; -81 -1], A - B K = [0 1; -4 -4], det(s I - A) = s^2 + s, O = I.
SERVO_CHECKED = Checked.of(SERVO)


def lines(
    text: str, convention: str | None = None, checked: Checked = SERVO_CHECKED
) -> list[tuple[str, tuple[str, ...]]]:
    """The verdicts on lines, with the lines that they follow from."""
    return [(line.verdict, line.origins) for line in checked.report(text, "reason", convention).lines]


@pytest.mark.parametrize("place", range(1, 4))
def test_the_first_false_line_is_named(place: int) -> None:
    before = ["K = [4 3]", "rank(O) = 2"][: place - 1]
    report = SERVO_CHECKED.report("\n".join([*before, "A L = [81; 81]", "A B = [1; -1]"]))
    assert report.first_false == f"line {place}"
    assert [each.verdict for each in report.lines] == ["true"] * (place - 1) + ["false", "true"]


def test_a_root_of_a_square_is_not_what_is_squared() -> None:
    checked = Checked.of(SERVO.replace("[plant]", '[symbols]\nb = "real"\n[plant]'))
    assert lines("sqrt(b^2) = b\nsqrt(b^2) sqrt(2) = b sqrt(2)", checked=checked) == [("false", ())] * 2
    assert lines("sqrt(b^2) = b where b >= 0", checked=checked) == [("true", ())]


@tabled
def test_lines_in_the_letters_of_a_convention(convention: str, right: str, wrong: str) -> None:
    observer = SERVO.replace('task = "compensator"', 'task = "observer"').replace('control_poles = "-2, -2"\n', "")
    checked = SERVO_CHECKED if convention != "S4" else Checked.of(observer)
    assert [verdict for verdict, _ in lines(f"{right}\n{wrong}", convention, checked)] == ["true", "false"]


@tabled
def test_what_follows_from_a_false_line_is_no_error(text: str, expected: list[str]) -> None:
    found = lines(text)
    assert [verdict for verdict, _ in found] == expected
    assert all((origins != ()) is (verdict == "follows") for verdict, origins in found)


@tabled
def test_letters_that_stand_for_unknowns(let: str, text: str, expected: str) -> None:
    answer = {
        "symbols": ["l1", "l2"],
        "let": {"X": let},
        "answer": {"L": "[19; 81]"},
        "step": [{"relation": text}],
    }
    (line,) = SERVO_CHECKED.report(answer).lines
    assert line.verdict == expected


def test_a_member_of_the_family_takes_the_place_of_the_right_gain() -> None:
    checked = Checked.of(TWO_OUTPUTS)
    text = "L = [0 1; 0 2; 0 6]\nA - L C = [0 1 -1; 0 0 -1; 1 2 -3]\nL = [0 1; 0 2; 0 5]\nA - L C = [0 1 -1; 0 0 -1; 1 2 -2]"
    assert [verdict for verdict, _ in lines(text, None, checked)] == ["true", "true", "false", "follows"]


def test_a_false_line_beside_a_right_answer_is_said_so() -> None:
    report = SERVO_CHECKED.report("K = [4 3]\nL = [19; 81]\ndet(s I - A) = s^2\nF = (319 s + 400)/(s^2 + 23 s + 161)")
    assert (report.verdict, report.first_false) == ("right", "line 3")
    assert report.hints == ("line 3 does not lead to your (right) result",)


@tabled
def test_no_renaming_is_offered_under_which_any_gain_would_be_right(text: str, said: list[str]) -> None:
    # With y = C x the correction of A x + B u vanishes; and K x' = x_2 - x_2 + u = u is true of the plant alone.
    line = SERVO_CHECKED.report(text).lines[-1]
    assert line.verdict == "false"
    assert "is printed for" not in line.reason
    assert all(place in line.reason for place in said)


@tabled
def test_an_answer_that_cannot_be_read_is_no_false_line(text: str, verdicts: list[str]) -> None:
    report = SERVO_CHECKED.report(text)
    assert report.parts[0].verdict == "unreadable"
    assert [line.verdict for line in report.lines] == verdicts


def test_what_cannot_be_read_does_not_stop_the_rest() -> None:
    report = SERVO_CHECKED.report("A + = 3\nQ L = [1; 2]\nK = [4 3]\nh1 > 3")
    assert [line.verdict for line in report.lines] == ["unreadable", "unreadable", "true", "unreadable"]
    assert 'the letter "Q" means nothing' in report.lines[1].reason


def test_a_false_line_without_a_cause_is_false_all_the_same() -> None:
    """The search for a slip meets products of signals here, which have no value."""
    checked = Checked.of(TWO_OUTPUTS)
    assert lines("det(s I - A - + + C) = (s L 1)^3", None, checked) == [("false", ())]


def test_milestones() -> None:
    problem = f'{SERVO}[[marking.milestone]]\nrelation = "rank(O) = 2"\npoints = 1\n'
    problem += '[[marking.milestone]]\nrelation = "K = [4 3]"\npoints = 2\n'
    checked = Checked.of(problem)
    report = checked.report("K = [4 3]\nrank(O) = 2")
    assert [met for _, _, met in report.milestones] == [True, True]
    assert (report.score, report.total) == (Fraction(4), Fraction(6))
    assert [met for _, _, met in checked.report("rank(O) = 1").milestones] == [False, False]


# A = [0 1; -2 -3], B = [0; 1], C = [1 0] has in T = [2 1; 1 1] its modal form diag(-1, -2), [1; 1], [1 -1] (by hand).
MODAL = (
    'task = "canonical_form"\n[plant]\nA = "[0 1; -2 -3]"\nB = "[0; 1]"\nC = "[1 0]"\n[specification]\nkind = "modal"\n'
)


@tabled
def test_a_part_of_the_answer_that_has_a_letter_of_the_plant_is_no_line(problem: str, answer: str) -> None:
    report = Checked.of(problem).report(answer)
    assert (report.first_false, report.hints) == (None, ())
    assert "false" not in {line.verdict for line in report.lines}
    said = {"answer": {"A": "[9 9; 9 9]"}, "step": [{"relation": "A = [9 9; 9 9]"}, {"relation": "A = [0 0; 0 0]"}]}
    assert [line.where for line in Checked.of(problem).report(said).lines] == ["line 2"]


def test_a_line_on_the_matrix_of_the_plant_is_judged_beside_a_part_of_that_name() -> None:
    report = Checked.of(MODAL).report("A = [0 1; -2 -4]\nA = [-1 0; 0 -2]\nT = [2 1; 1 1]")
    assert report.first_false == "line 1"


def test_a_false_line_has_a_reason_and_a_long_one_is_shown_by_its_beginning() -> None:
    report = SERVO_CHECKED.report("K = [4 3]\nF = 319 (s + 1.254)/(s^2 + 23 s + 161)")
    assert report.lines[1].verdict == "false"
    assert report.lines[1].reason
    long = SERVO_CHECKED.report(f"K = [4 3]\nrank(O) = {'+'.join(['1'] * 500)}\nL = [{'q ' * 500}]")
    for page in (long.to_text(), long.to_html().rpartition("</style>")[2]):
        assert "…" in page
        assert len(page) < 3_500
