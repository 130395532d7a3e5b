"""Questions: what is asked, said of every task and of everything its specification may contain."""

from __future__ import annotations

import string

import pytest

from symobs.applications.checking import check
from symobs.formula.phrases import QUESTIONS
from symobs.ground.errors import InputError
from symobs.problem import read
from symobs.problem.question import question_of
from symobs.tasks.result import render, tasks
from tests.kit import tabled
from tests.support.tools.command_line import EXAMPLES


@pytest.mark.parametrize("key", QUESTIONS)
def test_a_sentence_names_what_exists_and_speaks_english(key: str) -> None:
    kind, *words = key.split()
    if kind not in {"ask", "also"}:
        return
    named = [words.pop(0)] if words[0] in tasks() else []
    keywords = {name for task in tasks().values() for name in task.keywords if named in ([], [task.name])}
    assert {word.partition("=")[0] for word in words} <= {*keywords, "discrete"}
    slots = {name for _, name, _, _ in string.Formatter().parse(QUESTIONS[key]) if name}
    assert slots <= {*(word.partition("=")[0] for word in words), "horizon", "start", "end"}
    assert QUESTIONS[key][0].isupper()
    assert QUESTIONS[key][-1] in ".?" or QUESTIONS[key].endswith("}.")


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_worked_example_asks(path) -> None:  # type: ignore[no-untyped-def]  # noqa: ANN001
    question = question_of(read(path.read_text("utf-8"), path.name))
    text = str(render(question, "text"))
    assert "Given\n-----\n" in text
    assert "\nTask" in text
    assert text == str(render(question, "text"))


def asked(
    specification: str, task: str = "observer", plant: str = 'A = "[0 1; 0 -1]"\nB = "[0; 1]"\nC = "[1 0]"'
) -> str:
    problem = read(f'task = "{task}"\n[symbols]\np = "positive"\n[plant]\n{plant}\n[specification]\n{specification}\n')
    return " ".join(str(render(question_of(problem), "text")).split("----")[-1].split())


@tabled
def test_the_question_states_what_was_asked(task: str, specification: str, said: str) -> None:
    assert said in asked(specification, task)


@tabled
def test_a_gain_of_a_flat_list_is_asked_as_a_row(gain: str) -> None:
    assert asked(f"K = {gain}", "state_feedback") == asked('K = "[2, 3]"', "state_feedback")


def test_several_tasks_have_letters_and_given_gains_stand_among_the_data() -> None:
    text = 'tasks = ["observability", "observer"]\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\nL = "[19; 81]"\n'
    said = " ".join(str(render(question_of(read(text)), "latex")).split())
    assert r"L=\begin{bmatrix}19\\81\end{bmatrix}" in said.partition("Tasks.")[0]
    assert r"\textbf{Tasks.} (a) Is the pair ($C$, $A$) observable?" in said
    assert "(b) Find the characteristic polynomial of the observer with the gain $L$" in said


@pytest.mark.parametrize(
    ("marked", "said"),
    [
        ('"observer.L"', "Give L."),
        ('"observer.polynomial", "observer.L"', "Give χ_(A-LC)(s) and L."),
        ('"observer.verdict"', "-2."),
    ],
)
def test_the_question_asks_for_what_is_marked(marked: str, said: str) -> None:
    assert asked(f"poles = [-1, -2]\n[marking]\nasked = [{marked}]").endswith(said)


def test_what_is_marked_of_a_given_gain_is_not_the_gain() -> None:
    problem = 'task = "observer"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\nL = "[19; 81]"\n'
    assert check(problem, "s^2 + 20*s + 100").verdict == "right"  # s² + (1 + l₁)s + l₁ + l₂ by hand


def test_a_specification_that_cannot_be_read_is_an_error() -> None:
    with pytest.raises(InputError, match="closed under conjugation"):
        asked('poles = ["-1 + i", "-2"]')


@tabled
def test_integral_action_asks_for_a_pole_of_each_integrator_too(poles: str, polynomial: str) -> None:
    assert f"the characteristic polynomial {polynomial}." in asked(f"poles = {{ {poles} }}", "integral_action")


@pytest.mark.parametrize(
    "letter", ["χ_(A-LC)(s)", "\\chi_{A-LC}(s)", "det(sI - A + L C)", "det(sI - (A - LC))", "chi_L(s)", "p(s)"]
)
def test_the_polynomial_of_a_given_gain_is_read_under_its_letter(letter: str) -> None:
    problem = 'task = "observer"\n[plant]\nA = "[0 1; 0 -1]"\nC = "[1 0]"\n[specification]\nL = "[19; 81]"\n'
    assert check(problem, f"{letter} = s^2 + 20 s + 100\n").verdict == "right"
    assert check(problem, f"{letter} = s^2 + 21 s + 100\n").verdict == "wrong"
