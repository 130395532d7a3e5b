"""The defining equations of a task as lines: true ones are true, with one sign changed they are false."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from symobs.applications.checking import Checked

EQUATIONS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))


@pytest.mark.parametrize("name", EQUATIONS)
def test_equations_are_true_and_false(name: str) -> None:
    checked, wrong = Checked.of(EQUATIONS[name]["problem"]), []
    for expected in ("true", "false"):
        for line in EQUATIONS[name][expected]:
            found = [(each.verdict, each.reason) for each in checked.report(line).lines]
            if [verdict for verdict, _ in found] != [expected]:
                wrong.append((line, expected, found))
    assert not wrong


def test_a_formula_gives_no_value() -> None:
    checked = Checked.of(EQUATIONS["lqr"]["problem"])
    (part,) = (part for part in checked.report("K = [2 3]\nK = R^-1 B' P").parts if part.weight)
    assert (part.verdict, part.given) == ("right", "[2 3]")
    (part,) = (part for part in checked.report("K = R^-1 B' P").parts if part.weight)
    assert part.verdict == "missing"


#: A double integrator: p12² = 1, p22² = 2 p12 + 2 and p11 = p12 p22 of the regulator; p12² = 4, p11² = 2 p12, p22 = p11 p12.
TWO_RICCATI = """
tasks = ["lqr", "kalman"]
[plant]
A = "[0 1; 0 0]"
B = "[0; 1]"
C = "[1 0]"
[specification.lqr]
Q = "[1 0; 0 2]"
R = "1"
[specification.kalman]
W = "[0 0; 0 4]"
V = "1"
[marking]
asked = ["lqr.K", "lqr.P", "kalman.L", "kalman.P"]
"""


@pytest.mark.parametrize("wrong", [False, True])
@pytest.mark.parametrize(
    "text",
    [
        "K = [1 2]\nP = [2 1; 1 2]\nL = [2; 2]\nP = [2 2; 2 4]",
        "(a) K = [1 2], P = [2 1; 1 2]\n(b) L = [2; 2], P = [2 2; 2 4]",
        "K = [1 2]\nP_lqr = [2 1; 1 2]\nL = [2; 2]\nP_kalman = [2 2; 2 4]",
        "K = [1 2]\nlqr_P = [2 1; 1 2]\nL = [2; 2]\nkalman_P = [2 2; 2 4]",
        "kalman.P = [2 2; 2 4]\nlqr.P = [2 1; 1 2]\nK = [1 2]\nL = [2; 2]",
    ],
)
def test_two_tasks_of_one_letter_are_told_apart(text: str, wrong: bool) -> None:  # noqa: FBT001 - of parametrize
    report = Checked.of(TWO_RICCATI).report(text.replace("4]", "5]") if wrong else text)
    verdicts = {part.part: part.verdict for part in report.parts}
    assert verdicts == dict.fromkeys(verdicts, "right") | {"kalman.P": "wrong" if wrong else "right"}
    assert not any(line.verdict in {"false", "unreadable"} for line in report.lines)
