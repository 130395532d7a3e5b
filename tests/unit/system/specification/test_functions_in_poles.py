"""Functions of parameters in poles, polynomials and transfer functions, held to NumPy at values of the parameters."""

from __future__ import annotations

from pathlib import Path
from random import Random

import numpy as np
import pytest
import sympy

import symobs
from symobs.ground.errors import InputError
from tests.kit import tabled, tables

SERVO = ("[0 1; 0 -1]", "[0; 1]", "[1 0]")
#: What is asked for, and the coefficients that it means, at values of T, a and theta.
ASKED = tables(Path(__file__))["asked"]


@pytest.mark.slow
@pytest.mark.parametrize("name", ASKED)
def test_both_gains_place_the_poles_at_values_of_the_parameters(name: str) -> None:
    plant, asked, wanted = ASKED[name]
    system = symobs.StateSpace(**plant)
    polynomial = sympy.Matrix([sympy.sympify(text) for text in wanted])  # noqa: TID251 - texts of this file
    observer, feedback = symobs.observer(system, **asked), symobs.state_feedback(system, **asked)
    random = Random(name)  # noqa: S311 - test data
    for _ in range(3):
        point = {letter: random.uniform(0.2, 1.2) for letter in ("T", "a", "theta")}
        values = (part.subs(point).evalf() for part in (system.A, system.B, system.C, feedback.K, observer.L))
        A, B, C, K, L = (np.array(value, dtype=float) for value in values)
        expected = pytest.approx(np.array(polynomial.subs(point).evalf(), dtype=float)[:, 0], rel=1e-8)
        assert np.poly(A - B @ K) == expected
        assert np.poly(A - L @ C) == expected
    if name != "spiral":
        assert "as required" in feedback.to("text")


@tabled
def test_what_no_algebra_decides_is_refused_with_the_reason(keyword: str, value: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason) as raised:
        symobs.observer(symobs.StateSpace(*SERVO), **{keyword: value})
    assert raised.value.where == f"specification.{keyword}"


@tabled
def test_a_transfer_function_that_is_no_plant_is_refused(given: str, reason: str) -> None:
    with pytest.raises(InputError, match=reason):
        symobs.StateSpace.from_transfer_function(given)


#: Divisors that vanish for all values of T and θ.
ZEROS = ["exp(-2*T) - exp(-T)^2", "sin(2*theta) - 2*sin(theta)*cos(theta)", "cos(theta)^2 + sin(theta)^2 - 1"]


@pytest.mark.parametrize("zero", ZEROS)
def test_a_coefficient_that_divides_by_what_vanishes_is_refused(zero: str) -> None:
    for asked in ({"poles": f"-exp(-T)/({zero}), -1"}, {"polynomial": f"s^2 + s/({zero}) + 1"}):
        with pytest.raises(InputError, match="a coefficient divides by 0") as raised:
            symobs.state_feedback(symobs.StateSpace(*SERVO), **asked)
        assert raised.value.where == "specification"
    for function in (f"1/(s^2 + s/({zero}) + 1)", f"(s + 1/({zero}))/(s^2 + 1)", f"[1/(s + 1/({zero})) 1/s]"):
        with pytest.raises(InputError, match="a coefficient divides by 0"):
            symobs.StateSpace.from_transfer_function(function)
