"""Compensators with given gains: the loop is the one they make, and its poles are found."""

from __future__ import annotations

from typing import Any

import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import SERVO, tabled, text_of

s = sympy.Symbol("s")
SEVERAL = StateSpace("[0 1 0; 0 0 1; 1 -2 3]", "[1 0; 0 0; 0 1]", "[1 0 0; 0 1 0]")
THROUGH = StateSpace("[0 1; -2 k]", "[0; 1]", "[1 0]", "[3]")


def loop_of(plant: StateSpace, K: sympy.Matrix, L: sympy.Matrix) -> sympy.Matrix:
    """Plant and observer with u = -K x_hat, put together by hand in (x, x_hat)."""
    A, B, C = plant.A, plant.B, plant.C
    return sympy.Matrix(sympy.BlockMatrix([[A, -B * K], [L * C, A - B * K - L * C]]))


@pytest.mark.parametrize(
    ("plant", "K", "L"),
    [
        (SERVO, [1, 2], [3, 4]),
        (SERVO, ["k", 2], [3, "k^2"]),
        (SEVERAL, [[1, 2, 3], [4, 5, 6]], [[1, 2], [3, 4], [5, 6]]),
        (THROUGH, ["1/2", 2], [3, 4]),
    ],
    ids=["servo", "parametric", "several", "feedthrough"],
)
def test_the_loop_of_given_gains(plant: StateSpace, K: object, L: object) -> None:
    found = symobs.compensator(plant, K=K, L=L)
    own = plant.A - plant.B * found.K - found.L * plant.C + found.L * plant.D * found.K
    F = found.K * (s * sympy.eye(plant.order) - own).inv() * found.L
    assert (
        (sympy.Matrix([[found.F]]) - F if F.shape == (1, 1) else found.F - F).applyfunc(sympy.simplify).is_zero_matrix
    )
    wanted = loop_of(plant, found.K, found.L).charpoly(s).as_expr()
    assert sympy.expand(found.closed_loop_polynomial - wanted) == 0
    assert found.closed_loop_matrix_estimate == loop_of(plant, found.K, found.L)
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


def test_a_wrong_answer_for_given_gains_does_not_exist() -> None:
    found = symobs.compensator(SERVO, K=[1, 2], L=[3, 4])
    with pytest.raises(CertificateRejected, match=r"the claim F\(s\) = K\*\(s\*I - A \+ B\*K \+ L\*C\)\*\*\(-1\)\*L"):
        type(found)(
            found.plant, "separation", {**found.answer, "F": found.answer["F"] * 2}, found.feedback, found.estimator
        )


@tabled
def test_gains_that_have_no_place_are_refused(specification: dict[str, Any], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.compensator(SERVO, **specification)
