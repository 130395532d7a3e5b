"""Equilibria as students write them: any order and form; what is missing, too much or wrong is told; open is undecided."""

from __future__ import annotations

from symobs.applications.checking import check
from tests.kit import tabled
from tests.support.paths import ROOT

HEAD = 'task = "equilibria"\n[plant]\n'
PROBLEMS = {
    "hoop": str(ROOT / "worked_examples" / "hoop_equilibria.toml"),
    "beam": str(ROOT / "worked_examples" / "duffing_equilibria.toml"),
    "softening": HEAD + 'states = "x1, x2"\ninputs = "u"\nf = "[x2; -x1 + x1^3 + u]"\nequilibrium = { u = 0 }\n',
    "rounded": f'{HEAD}states = "x"\nf = "[2*x - x^3]"\n[marking]\ndecimals = "accept"\n',
    "none": f'{HEAD}states = "x"\nf = "[1 + x^2]"\n',
    "free": HEAD
    + 'coordinates = ["x", "theta"]\n'
    + "equations = [\"x'' = sin(theta)\", \"theta'' = -sin(theta) - theta'\"]\n",
    "open": f'{HEAD}states = "x"\nf = "[x*(exp(x) + x - a)]"\n[symbols]\na = "positive"\n',
}


@tabled
def test_points_are_held_against_those_there_are(
    problem: str, answer: str, points: str, stable: str, slip: str
) -> None:
    report = check(PROBLEMS[problem], answer)
    found = {part.part: part for part in report.parts}
    assert found["equilibria.points"].verdict == points, found["equilibria.points"].reason
    assert found["equilibria.stable"].verdict == stable, found["equilibria.stable"].reason
    assert (found["equilibria.points"].slip or "") == slip


@tabled
def test_what_is_wrong_is_named_and_the_solution_is_not(problem: str, answer: str, reason: str) -> None:
    (part,) = (part for part in check(PROBLEMS[problem], answer).parts if part.part == "equilibria.points")
    assert part.reason == reason


@tabled
def test_lines_that_are_no_points_stay_lines(answer: str, count: int) -> None:
    report = check(PROBLEMS["softening"], answer)
    assert {part.verdict for part in report.parts} == {"missing"}
    assert len(report.lines) == count
