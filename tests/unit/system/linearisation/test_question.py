"""The question of a nonlinear plant: what was given, and the linearisation as what is asked for first."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from symobs.applications.export import exercises, export
from symobs.problem import read
from symobs.problem.question import question_of
from symobs.tasks.result import render
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.tasks.result import Document

PENDULUM = """
task = "observer"
language = "{language}"
[plant]
{plant}
inputs = "u"
h = "[theta]"
equilibrium = {{ theta = 0, u = 0 }}
[specification]
poles = "-2, -3"
"""
#: θ″ = 7 sin θ + u in three ways, what a question shows of it, and what only the solution tells.
OF_STATES = 'states = "theta, w"\nf = "[w; 7*sin(theta) + u]"'
OF_MOTION = """coordinates = ["theta"]\nequations = ["3*theta'' - 21*sin(theta) = 3*u"]"""
OF_ENERGIES = """coordinates = ["theta"]
kinetic = "3/2*theta'^2"\npotential = "21*cos(theta)"\nforces = { theta = "3*u" }"""
GIVEN = [
    (OF_STATES, "7 sin(θ)", ""),
    (OF_MOTION, "21 sin(θ)", "7 sin(θ)"),
    (OF_ENERGIES, "V = 21 cos(θ)", "7 sin(θ)"),
]
ASKED = {"en": "Linearise the plant about the equilibrium", "de": "Linearisieren Sie die Strecke um die Ruhelage"}


def _text(document: Document, kind: str = "text") -> str:
    return " ".join(str(render(document, kind)).split())


@pytest.mark.parametrize("language", ASKED)
@pytest.mark.parametrize(("plant", "shown", "hidden"), GIVEN, ids=["f", "motion", "energies"])
def test_a_question_shows_what_was_given_and_no_linearisation(
    plant: str, shown: str, hidden: str, language: str
) -> None:
    problem = read(PENDULUM.format(plant=plant, language=language))
    question = _text(question_of(problem))
    assert shown in question
    assert not hidden or hidden not in question
    assert ASKED[language] in question
    assert "∂" not in question
    assert "ẋ = ⎡" not in question
    page = _text(problem.document(problem.solve()))
    assert "7 sin(θ)" in page
    assert "A = [∂f/∂θ" in page
    assert "ẋ = ⎡" in page


def test_what_is_asked_first_names_the_point_and_the_letters() -> None:
    question = _text(question_of(read(PENDULUM.format(plant=OF_STATES, language="en"))))
    assert "= [0 0 0]: for small deviations, ẋ = A x + B u, y = C x." in question


def test_what_an_equilibrium_leaves_free_has_no_value_in_the_question() -> None:
    plant = 'states = "r, v"\ninputs = "a"\nf = "[v; a - v^3]"\nh = "[r]"\nequilibrium = { v = 0 }'
    text = f'task = "controllability"\n[plant]\n{plant}'
    assert "about the equilibrium (v, a) = [0 0]" in _text(question_of(read(text)))


@pytest.mark.parametrize("platform", ["stack", "moodle", "prairielearn"])
def test_an_exported_question_asks_to_linearise(platform: str, tmp_path: Path) -> None:
    file = tmp_path / "pendulum.toml"
    file.write_text(PENDULUM.format(plant=OF_MOTION, language="en"), "utf-8")
    written = " ".join(map(str, export(platform, exercises([str(file)])).values()))
    assert "Linearise the plant about the equilibrium" in written
    given = written.partition("Linearise")[0]
    assert "sin" in given
    assert r"\partial" not in given
    assert "∂" not in given


def test_the_solution_below_an_exam_question_derives_the_linearisation(tmp_path: Path) -> None:
    (tmp_path / "pendulum.toml").write_text(PENDULUM.format(plant=OF_MOTION, language="en"), "utf-8")
    (tmp_path / "exam.toml").write_text('style = "exam"\n[[problem]]\nfile = "pendulum.toml"\n', "utf-8")
    said = " ".join(inside("sheet", "exam.toml", "--format", "text", folder=tmp_path).out.split())
    question, _, solution = said.partition("Solution 1")
    assert "A = [∂f/∂θ" not in question
    assert "A = [∂f/∂θ" in solution
