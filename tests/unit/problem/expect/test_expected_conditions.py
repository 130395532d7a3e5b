"""Expected conditions are compared as mathematics: any conjunction that holds at the same parameters meets them."""

from __future__ import annotations

import json

import pytest

from symobs.problem import read
from symobs.problem.expect import mismatches

ROUTH = "s^3 + h1*s^2 + h2*s + 6"  # stable exactly where h1 > 0, h2 > 0 and h1 h2 > 6
SQUARE = "s^2 + s + (2*c - 1)^2"  # stable exactly where c is not 1/2


def is_met(polynomial: str, *expected: str) -> bool:
    text = 'task = "stability_region"\n[symbols]\nh1 = "real"\nh2 = "real"\nc = "real"\n'
    parameters = "h1, h2" if polynomial == ROUTH else "c"
    text += f'[specification]\npolynomial = "{polynomial}"\nparameters = "{parameters}"\n'
    problem = read(f"{text}[expect]\nstable_if = {json.dumps(expected)}\n")
    return not mismatches(problem.solve(), problem.expect)


@pytest.mark.parametrize(
    ("polynomial", "expected"),
    [
        (ROUTH, ("h1 > 0", "h1*h2 > 6")),
        (ROUTH, ("h1 > 0", "h2 > 0", "h1*h2 > 6")),
        (ROUTH, ("h2 > 0", "h1*h2 - 6 > 0")),
        (ROUTH, ("h1 > 0", "h2 > 6/h1")),
        (ROUTH, ("6 < h1*h2", "h1 + h2 > 0")),
        (SQUARE, ("c != 1/2",)),
        (SQUARE, ("(2*c - 1)^2 != 0",)),
        (SQUARE, ("(2*c - 1)^2 > 0",)),
        (SQUARE, ("(1 - 2*c)^3 != 0",)),
    ],
)
def test_what_says_the_same_meets_a_condition(polynomial: str, expected: tuple[str, ...]) -> None:
    assert is_met(polynomial, *expected)


@pytest.mark.parametrize(
    ("polynomial", "expected"),
    [
        (ROUTH, ("h1*h2 > 6",)),  # holds at h1 = h2 = -3
        (ROUTH, ("h2 > 6/h1",)),  # holds at h1 = -1, h2 = 0
        (ROUTH, ("h1 > 0", "h2 > 0")),
        (ROUTH, ("h1 > 0", "h1*h2 >= 6")),
        (ROUTH, ("h1 > 0", "h1*h2 > 7")),
        (ROUTH, ("h1 > 0", "h1*h2 > 6", "h2 > 1")),
        (ROUTH, ("False",)),
        (SQUARE, ("c > 1/2",)),
        (SQUARE, ("c*(2*c - 1) != 0",)),
        (SQUARE, ("c != 1/3",)),
    ],
)
def test_what_says_something_else_does_not(polynomial: str, expected: tuple[str, ...]) -> None:
    assert not is_met(polynomial, *expected)
