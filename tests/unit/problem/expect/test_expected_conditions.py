"""Expected conditions are compared as mathematics: any conjunction that holds at the same parameters meets them."""

from __future__ import annotations

import json

from symobs.problem import read
from symobs.problem.expect import mismatches
from tests.kit import tabled

ROUTH = "s^3 + h1*s^2 + h2*s + 6"  # stable exactly where h1 > 0, h2 > 0 and h1 h2 > 6


def is_met(polynomial: str, *expected: str) -> bool:
    text = 'task = "stability_region"\n[symbols]\nh1 = "real"\nh2 = "real"\nc = "real"\n'
    parameters = "h1, h2" if polynomial == ROUTH else "c"
    text += f'[specification]\npolynomial = "{polynomial}"\nparameters = "{parameters}"\n'
    problem = read(f"{text}[expect]\nstable_if = {json.dumps(expected)}\n")
    return not mismatches(problem.solve(), problem.expect)


@tabled
def test_what_says_the_same_meets_a_condition(polynomial: str, expected: tuple[str, ...]) -> None:
    assert is_met(polynomial, *expected)


@tabled
def test_what_says_something_else_does_not(polynomial: str, expected: tuple[str, ...]) -> None:
    assert not is_met(polynomial, *expected)
