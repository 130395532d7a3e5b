"""The poles of a compensator's halves, read by tasks that are one of them."""

from __future__ import annotations

import pytest

from symobs.ground.errors import ProblemErrors
from symobs.problem import read

HALVES = """
    tasks = ["state_feedback", "observer", "compensator"]
    [plant]
    A = "[0 1; 0 -1]"
    B = "[0; 1]"
    C = "[1 0]"
    [specification]
    control_poles = "-2, -2"
    observer_polynomial = "(s + 10)^2"
"""


def test_what_is_wrong_with_poles_of_a_half_is_said_where_they_stand() -> None:
    text = HALVES.replace("-2, -2", "-2, -2+i").replace("^2", "^3").replace(', "compensator"', "")
    with pytest.raises(ProblemErrors) as caught:
        read(text, "problem.toml").solve()
    assert [error.where for error in caught.value.errors] == [
        "specification.control_poles",
        "specification.observer_polynomial",
    ]


def test_poles_of_the_other_half_are_no_key_of_a_task() -> None:
    text = HALVES.replace('tasks = ["state_feedback", "observer", "compensator"]', 'task = "observer"')
    with pytest.raises(ProblemErrors) as caught:
        read(text, "problem.toml")
    assert [error.where for error in caught.value.errors] == ["specification.control_poles"]
