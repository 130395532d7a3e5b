"""A section all of whose lines stand on the page already is not begun again."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

import symobs
from symobs.ground.errors import InputError
from symobs.problem import read
from symobs.tasks.result.writers import render
from tests.kit import tabled

TWO = """
    tasks = ["state_feedback", "tracking"]
    [plant]
    A = "[-1 0; 1 -2]"
    B = "[1 0; 0 1]"
    C = "[0 1]"
    [specification]
    control_poles = "-2, -3"
    observer_poles = "-5"
    reference_matrix = "[0 1; -1 0]"
"""


def test_state_feedback_is_told_once() -> None:
    problem = read(TWO)
    text = str(render(problem.document(problem.solve()), "text"))
    headings = re.findall(r"^(\d)\. (.*)$", text, re.MULTILINE)
    assert [int(number) for number, _ in headings] == list(range(1, len(headings) + 1))
    assert [title for _, title in headings].count("State feedback") == 1
    assert headings[-1][1] == "Tracking"


@pytest.mark.parametrize(
    ("observer", "poles", "other"), [("full", [-5], "minimal"), ("minimal", [-5, -6], "full"), ("full", [-5] * 3, "")]
)
def test_the_other_order_of_an_observer_is_named_where_its_poles_came(
    observer: str, poles: list[int], other: str
) -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    with pytest.raises(InputError) as caught:
        symobs.compensator(plant, control_poles=[-1, -2], observer_poles=poles, observer=observer)
    assert caught.value.where == "specification.observer_poles"
    assert (f'or write observer = "{other}"' in caught.value.repair) == bool(other)


KEY = """
    tasks = ["canonical_form", "observability", "controllability"]
    [plant]
    A = "[0 1; -2 -3]"
    B = "[0; 1]"
    C = "[1 0]"
    [specification]
    kind = "observable"
"""


@tabled
def test_a_part_that_is_answered_already_keeps_its_heading_and_says_where(detail: str) -> None:
    problem = read(KEY)
    text = str(render(replace(problem.document(problem.solve()), detail=detail), "text"))
    headings = re.findall(r"^(\d\. .*)$", text, re.MULTILINE)
    assert headings == ["1. Canonical form", "2. Observability", "3. Controllability"]
    (again,) = re.findall(r"2\. Observability\n-+\n(.*?)\n3\. ", text, re.DOTALL)
    assert "This has been shown in section 1." in again
    assert "det 𝒪 = 1 ≠ 0" in again
    assert "(C, A) is observable" in again


def test_the_signs_of_all_letters_are_assumed_once() -> None:
    """The poles of the second task bring in a letter that the plant of the first does not have."""
    problem = read("""
        tasks = ["controllability", "state_feedback"]
        [symbols]
        a = "positive"
        p = "positive"
        [plant]
        A = "[0 1; -a 0]"
        B = "[0; 1]"
        [specification]
        poles = "-p, -p"
    """)
    page = str(render(problem.document(problem.solve()), "text"))
    assert page.count("Throughout, we assume") == 1
    assert "Throughout, we assume a > 0, p > 0." in page
