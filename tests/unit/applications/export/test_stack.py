"""The STACK export, run in Maxima: its variables, and its response trees walked node by node."""

from __future__ import annotations

import random
import re
import shutil
import subprocess
from fractions import Fraction
from typing import TYPE_CHECKING
from xml.etree.ElementTree import Element, fromstring

import pytest

from symobs.applications.export import exercises, export
from symobs.ground.errors import ProblemErrors
from tests.kit import tabled
from tests.support.tools.exported import checked, held, random_answer

if TYPE_CHECKING:
    from pathlib import Path

    from symobs.applications.export import ExerciseSet

pytestmark = pytest.mark.skipif(shutil.which("maxima") is None, reason="maxima is not installed")


def question_of(each: ExerciseSet) -> Element:
    """The question of an export."""
    quiz = fromstring(str(export("stack", [each])[""]))  # noqa: S314
    return next(found for found in quiz if found.get("type") == "stack")


def text_of(element: Element, path: str) -> str:
    found = element.find(path)
    assert found is not None
    return found.text or ""


def as_maxima(rows: list[list[str]], *, is_matrix: bool) -> str:
    return f"matrix({', '.join(f'[{inside}]' for inside in map(', '.join, rows))})" if is_matrix else f"({rows[0][0]})"


def run(question: Element, answers: list[dict[str, str]], seed: int = 1) -> list[list[int]]:
    """The verdict of every tree for every answer, in one Maxima."""
    trees = question.findall("prt")
    lines = [
        f"stack_seed: {seed}$",
        text_of(question, "questionvariables/text").replace(";\n", "$\n").rstrip(";") + "$",
    ]
    for answer in answers:
        lines += [f"{name}: {value}$" for name, value in answer.items()]
        for tree in trees:
            code = text_of(tree, "feedbackvariables/text").replace(";\n", "$\n").rstrip(";")
            lines += [code + "$", 'print("VERDICT", sy_k)$']
    done = subprocess.run(
        ["maxima", "--very-quiet"], input="\n".join(lines), capture_output=True, text=True, timeout=200, check=True
    )
    found = [int(number) for number in re.findall(r"VERDICT (\S+)", done.stdout)]
    assert len(found) == len(answers) * len(trees), done.stdout[-3000:]
    return [found[i : i + len(trees)] for i in range(0, len(found), len(trees))]


def walked(tree: Element, verdict: int) -> tuple[Fraction, str]:
    """Score and answer note at the end of a response tree."""
    nodes = {text_of(node, "name"): node for node in tree.findall("node")}
    place, score, note = "0", Fraction(0), ""
    while place != "-1":
        node = nodes[place]
        assert text_of(node, "answertest") == "AlgEquiv"
        side = "true" if int(text_of(node, "tans")) == verdict else "false"
        score, note = Fraction(text_of(node, f"{side}score")), text_of(node, f"{side}answernote")
        place = text_of(node, f"{side}nextnode")
    return score, note


def answered(each: ExerciseSet, given: dict[str, list[list[str]]]) -> dict[str, str]:
    found = {}
    for k, part in enumerate(each.first.parts, 1):
        is_matrix = part.kind == "gain" or part.shape != (1, 1)
        rows = given[part.name]
        found[f"ans{k}"] = f"sy_{rows[0][0]}" if part.kind == "word" else as_maxima(rows, is_matrix=is_matrix)
    return found


def agree(name: str, count: int) -> None:
    """Scores of the trees are the credits of `check`."""
    each, draw = held(name), random.Random(name)  # noqa: S311
    given = [random_answer(each.first, draw, exact=True) for _ in range(count)]
    question = question_of(each)
    trees = question.findall("prt")
    found = run(question, [answered(each, answer) for answer in given])
    for answer, verdicts in zip(given, found, strict=True):
        told = checked(each.first, answer)
        scores = [walked(tree, verdict)[0] for tree, verdict in zip(trees, verdicts, strict=True)]
        assert scores == [told[part.name][1] for part in each.first.parts], (answer, told, verdicts)


def test_the_trees_give_the_credits_of_check() -> None:
    agree("output_feedback_servo", 10)


@pytest.mark.slow
@tabled
def test_the_trees_give_the_credits_of_check_in_more_examples(name: str) -> None:
    agree(name, 25)


#: A double integrator with Q = I, R = 1: p12 = 1, p22² = 3; a plant of first order: p² = 2p + 1, p = 1 + √2; the double
#: integrator with Q = diag(q, 0): K = [√q  √(2√q)], where q = 2.
ROOTS = {
    "plain": ('A = "[0 1; 0 0]"\nB = "[0; 1]"', 'Q = "[1 0; 0 1]"'),
    "sum": ('A = "1"\nB = "1"', 'Q = "1"'),
    "nested": ('A = "[0 1; 0 0]"\nB = "[0; 1]"', 'Q = "[2 0; 0 0]"'),
}


@tabled
def test_square_roots_are_compared_in_every_form(name: str, answer: str, note: str, tmp_path: Path) -> None:
    plant, weight = ROOTS[name]
    problem = tmp_path / "p.toml"
    problem.write_text(
        f'task = "lqr"\n[plant]\n{plant}\n[specification]\n{weight}\nR = "1"\n[marking]\nasked = ["lqr.K"]\n'
    )
    (each,) = exercises([str(problem)])
    question = question_of(each)
    ((verdict,),) = run(question, [{"ans1": answer}])
    (tree,) = question.findall("prt")
    assert walked(tree, verdict)[1] == f"prt1-{note}"
    assert "sqrt(2)" in text_of(question, "questiontext/text")
    with pytest.raises(ProblemErrors, match="these are roots"):
        export("prairielearn", [each])


#: (s + 1)(s² + 2s + 2), s² − s − 1 and (s + 1)².
POLYNOMIALS = {"complex": "[0 1 0; 0 0 1; -2 -4 -3]", "golden": "[0 1; 1 1]", "twice": "[0 1; -1 -2]"}


@tabled
def test_poles_are_compared_as_sets_and_lists(name: str, answer: str, note: str, tmp_path: Path) -> None:
    problem = tmp_path / "p.toml"
    plant = f'[plant]\nA = "{POLYNOMIALS[name]}"\n[marking]\nasked = ["characteristic_polynomial.roots"]\n'
    problem.write_text(f'task = "characteristic_polynomial"\n{plant}')
    question = question_of(exercises([str(problem)])[0])
    ((verdict,),) = run(question, [{"ans1": answer}])
    assert walked(question.findall("prt")[0], verdict)[1] == f"prt1-{note}"
    ((verdict,),) = run(question, [{"ans1": "ta1"}])  # the right value that the question shows
    assert verdict == 0
