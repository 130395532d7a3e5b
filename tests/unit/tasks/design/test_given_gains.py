"""Compensators with given gains: the loop is the one they make, and its poles are found."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError
from tests.kit import SERVO, tabled, text_of
from tests.support.claims.claims import HOLDS, Setting

s = sympy.Symbol("s")


@tabled
def test_the_loop_of_given_gains(given: dict[str, Any], K: list[Any], L: list[Any]) -> None:
    plant = StateSpace(**given)
    found = symobs.compensator(plant, K=K, L=L)
    for value in (Fraction(-2), Fraction(3, 5)):
        HOLDS["compensator"](found, Setting.of(plant, {}, {"k": value}))
    assert "asked for" not in str(found.to("text")).split("Compensator\n")[1]
    assert found.verdict == "yes"


@tabled
def test_an_unstable_loop_is_said(time: int, said: str) -> None:
    plant = StateSpace(SERVO.A, SERVO.B, SERVO.C, dt=time)
    found = symobs.compensator(plant, K=[-5, 2], L=[3, 4])
    assert found.stable == "no"
    assert f"{said}: with these gains the closed loop is unstable" in text_of(found)
    stable = symobs.compensator(SERVO, K=[1, 2], L=[3, 4])
    assert "it is unstable" not in stable.to("text")


def test_where_a_loop_with_a_parameter_is_stable() -> None:
    """(s² + 3 s + k)(s² + 4 s + 7) is stable for k > 0 alone."""
    found = symobs.compensator(SERVO, K=["k", 2], L=[3, 4])
    assert found.stable == "conditional"
    for value in (-20, -1, 5, 100):
        holds = [eval(condition, {"k": value}) for condition in found.stable_if]  # noqa: S307 - of our own making
        assert all(holds) == (value > 0), value


@tabled
def test_gains_that_have_no_place_are_refused(specification: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.compensator(SERVO, **specification)
