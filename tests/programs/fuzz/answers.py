"""Hostile answers to problems: each must end in a verdict, whatever it holds."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from symobs.applications.checking.classes.row import DAMAGED, report_of
from symobs.applications.checking.classes.submissions import Submission
from tests.programs.fuzz import mutate, texts
from tests.support.problems.answered import SERVO, TWO_OUTPUTS

if TYPE_CHECKING:
    from random import Random

_PLANT = '[plant]\nA = "[0 1; -2 -3]"\nB = "[0; 1]"\nC = "[1 0]"\n'
_PROBLEMS = {
    SERVO: ("K = [4 3]", "L = [19; 81]", "F = (319 s + 400)/(s^2 + 23 s + 161)", "A - L C = [-19 1; -81 -1]"),
    TWO_OUTPUTS: ("L = [0 1; 0 2; 0 6]", "det(s I - A + L C) = (s + 1)^3"),
    f'task = "canonical_form"\n{_PLANT}[specification]\nkind = "modal"\n': ("T = [2 1; -1 -1]", "A = [-1 0; 0 -2]"),
    'task = "stability_region"\n[specification]\npolynomial = "s^3 + 4 s^2 + h1 s + h2"\nparameters = "h1, h2"\n': (
        "stable_if = 0 < h2 < 4 h1",
        "h2 > 0 and 4 h1 > h2",
    ),
    f'tasks = ["observability", "transfer_function", "matrix_exponential"]\n{_PLANT}': (
        "rank = 2",
        "transfer_function = 1/((s + 1)(s + 2))",
        "matrix = [2 exp(-t)-exp(-2 t) exp(-t)-exp(-2 t); 0 0]",
    ),
}


def submission(source: Random) -> tuple[str, Submission]:
    """Return a problem and an answer: mended lines, tables of anything, or a text that is no answer."""
    problem = source.choice(list(_PROBLEMS))
    lines = list(_PROBLEMS[problem])
    names = [line.partition("=")[0].strip() for line in lines]
    match source.randrange(6):
        case 0 | 1:
            chosen = [mutate.text(source, line, lines) if source.random() < 0.6 else line for line in lines]
            return problem, Submission("s", text="\n".join(chosen))
        case 2:
            values = {name: texts.anything(source) for name in source.choices(names, k=2)}
            return problem, Submission("s", values=values, steps=texts.relation(source))
        case 3:
            values = {name: mutate.value(source, lines) for name in source.choices([*names, "verdict", "x"], k=2)}
            return problem, Submission(
                "s", values=values, convention=source.choice(("", "S1", "S2", "nowhere", "../x"))
            )
        case 4:
            return problem, Submission("s", text=json.dumps({"answer": {names[0]: texts.anything(source)}}))
        case _:
            return problem, Submission("s", text=texts.anything(source))


def checked(case: Any) -> str:
    """Return the verdict; raises AssertionError where there is none, or where the check itself broke."""
    problem, handed_in = case
    report = report_of(problem, "", handed_in, "reason")
    assert not any(part.reason == DAMAGED for part in report.parts), "the check broke"
    report.to_text()
    json.loads(report.to_json())
    return report.verdict
