"""What the verdict on a linearisation says of the plant itself: a sentence each way on every page, and `scope` in JSON."""

from __future__ import annotations

import json

import pytest

from symobs.problem import read
from symobs.problem.question import question_of
from symobs.tasks.result import render

#: ẋ = −x + u, y = x³ at 0: C = 0, so that the linearised plant is not observable; y determines x all the same.
CUBE = """
tasks = [{tasks}]
language = "{language}"
[plant]
f = "[-x1 + u]"
h = "[x1^3]"
states = "x1"
inputs = "u"
equilibrium = {{ x1 = 0, u = 0 }}
[specification]
{specification}
"""
#: The pendulum at its upper rest, of which both are controllable and observable.
PENDULUM = """
tasks = [{tasks}]
language = "{language}"
[plant]
f = "[x2; sin(x1) + u]"
h = "[x1]"
states = "x1, x2"
inputs = "u"
equilibrium = {{ x1 = 0, x2 = 0, u = 0 }}
[specification]
{specification}
"""
SAID = {
    "en": ("is true of the plant itself near the equilibrium", "proves nothing of the plant itself"),
    "de": ("gilt nahe der Ruhelage auch für die Strecke selbst", "beweist nichts über die Strecke selbst"),
}
CASES = [
    (CUBE, ["observability", "controllability", "detectability", "stabilizability", "pbh", "transfer_function"], ""),
    (PENDULUM, ["observer"], 'poles = "-2, -3"'),
    (PENDULUM, ["state_feedback"], 'poles = "-2, -3"'),
    (PENDULUM, ["compensator"], 'control_poles = "-1, -2"\nobserver_poles = "-3, -4"'),
    (PENDULUM, ["lqr"], 'Q = "[1 0; 0 1]"\nR = "1"'),
    (PENDULUM, ["matrix_exponential", "characteristic_polynomial", "decomposition", "dual"], ""),
]


@pytest.mark.parametrize("language", ["en", "de"])
@pytest.mark.parametrize(("text", "tasks", "specification"), CASES, ids=lambda case: str(case)[:20])
def test_a_page_says_what_a_linearisation_proves(
    text: str, tasks: list[str], specification: str, language: str
) -> None:
    for task in tasks:
        problem = read(text.format(tasks=f'"{task}"', language=language, specification=specification))
        results = problem.solve()
        page = " ".join(str(render(problem.document(results), "text")).split())
        assert [page.count(said) for said in SAID[language]] == [1, 1], task
        (found,) = json.loads(str(render(problem.document(results), "json")))["results"]
        assert set(found["scope"]) == {"of", "proves", "does_not_prove"}
        assert results[0].scope == found["scope"]
        question = " ".join(str(render(question_of(problem), "text")).split())
        assert not any(said in question for said in SAID[language])


def test_the_plant_itself_may_be_observable() -> None:
    problem = read(CUBE.format(tasks='"observability"', language="en", specification=""))
    (result,) = problem.solve()
    assert result.verdict == "no"
    assert "may be observable" in result.scope["does_not_prove"]


def test_a_linear_plant_has_no_scope() -> None:
    problem = read('task = "observability"\n[plant]\nA = "[0 1; 0 0]"\nC = "[1 0]"')
    results = problem.solve()
    assert "scope" not in str(render(problem.document(results), "json"))
    assert results[0].scope == {}
