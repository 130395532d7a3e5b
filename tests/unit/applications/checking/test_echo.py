"""How an answer was read: said before it costs marks, in the student's own text, and without a word on what is right."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from symobs.applications.checking import Checked
from tests.support.problems.answered import SERVO
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path


@pytest.mark.parametrize(
    ("answer", "given", "read"),
    [
        ({"K": "K = [10 32]"}, "K = [10 32]", "K = [10 32], one row"),
        ({"K": "(10, 32)"}, "(10, 32)", "K = [10 32], one row"),
        ({"K": "[10; 32]"}, "[10; 32]", "K = [10; 32], one column"),
        ({"K": "=SUM(A1)"}, "=SUM(A1)", "K = =S*U*M(A1)"),
        (
            "$K = \\begin{bmatrix} 10 & 32 \\end{bmatrix}$",
            "$K = \\begin{bmatrix} 10 & 32 \\end{bmatrix}$",
            "K = [10 32], one row",
        ),
        ("K = 2 [5 16]", "2 [5 16]", "K = [10 32], one row"),
    ],
)
def test_a_part_has_the_own_text_and_how_it_was_read(answer: object, given: str, read: str) -> None:
    part = Checked.of(SERVO).report(answer).parts[0]
    assert (part.given, part.read) == (given, read)


def test_the_page_shows_both() -> None:
    page = Checked.of(SERVO).report({"K": "=SUM(A1)", "L": "(10, 32)"}).to_html()
    assert "<code>=SUM(A1)</code>" in page
    assert "<code>(10, 32)</code>" in page
    assert "This was read as <math>" in page


def test_echo_says_nothing_on_what_is_right(tmp_path: Path) -> None:
    (tmp_path / "problem.toml").write_text(SERVO, "utf-8")
    answers = {"K = [4 3]\nL = (19, 81)": 0, "K = [4 2]\nL = (19, 81)": 0, "K = [4 3": 3}
    told = {}
    for answer, code in answers.items():
        found = inside("check", "problem.toml", "-", "--echo", folder=tmp_path, stdin=answer.encode())
        assert found.code == code
        told[answer] = found.out
    right, wrong, unreadable = told.values()
    assert right == "K = [4 3], one row\nL = [19; 81], one column\nno value for F\n"
    assert wrong == right.replace("[4 3]", "[4 2]")
    assert unreadable.startswith("K cannot be read: [4 3: ")


def test_examples_are_of_this_question_and_not_its_solution() -> None:
    problem = 'task = "state_feedback"\n[plant]\nA = "[0 1; -2 -3]"\nB = "[0; 1]"\n[specification]\npoles = "-4, -5"\n'
    with pytest.raises(ValueError, match=r"write for example K = \[1 2\]"):
        Checked.of(problem).report_of_file(b"I do not know that\nnor this one here", "answer.txt", "reason")
    other = problem.replace("-4, -5", "-1, -3")  # K = [1 1]
    other = other.replace("[0 1; -2 -3]", "[0 1; -2 -2]")  # K = [1 2]
    with pytest.raises(ValueError, match=r"write for example K = \[2 3\]"):
        Checked.of(other).report_of_file(b"I do not know that\nnor this one here", "answer.txt", "reason")
