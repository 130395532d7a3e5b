"""Inputs of minimum energy against SciPy: least squares in discrete time, the numerical Gramian in continuous time."""

from __future__ import annotations

from typing import Any

import pytest
import sympy

import symobs
from symobs.ground.errors import InputError
from tests.kit import tabled


def test_a_parameter_says_where_the_state_is_not_reached() -> None:
    result: Any = symobs.minimum_energy_input(symobs.StateSpace("[0 1; 0 0]", "[0; b]"), final="[1; 0]", horizon=1)
    assert [str(condition) for condition in result.conditions] == ["Ne(b, 0)"]
    (case,) = result.cases
    assert (str(case.when[0]), case.result.verdict) == ("Eq(b, 0)", "no")
    hidden: Any = symobs.minimum_energy_input(symobs.StateSpace("[0 0; 0 1]", "[1; 0]"), final="[1; f]", horizon=1)
    (case,) = hidden.cases
    assert (hidden.verdict, str(case.when[0]), case.result.input) == ("no", "Eq(f, 0)", 1)


def test_two_states_and_a_finite_horizon_are_needed() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]")
    with pytest.raises(InputError, match="neither an initial nor a final state"):
        symobs.minimum_energy_input(plant)
    with pytest.raises(InputError, match="at a finite time"):
        symobs.minimum_energy_input(plant, final="[1; 0]", horizon="inf")


@tabled
def test_exponentials_far_from_each_other_meet_at_the_end_of_the_horizon(rate: tuple[int, int]) -> None:
    """The exponents of e^{AT} e^{T} cancel those of e^{−A(T−t)} at t = T only in a base of both."""
    r, T = sympy.Rational(*rate), sympy.Symbol("T", positive=True)
    result: Any = symobs.minimum_energy_input(symobs.StateSpace([[r, 0], [0, 1]], [[1], [1]]), final=[1, 0])
    rates = (r, 1)
    W = sympy.Matrix(2, 2, lambda i, j: (sympy.exp((rates[i] + rates[j]) * T) - 1) / (rates[i] + rates[j]))
    at = {T: sympy.Rational(1, 20)}
    expected = (W.subs(at).evalf(60)).inv()[0, 0]
    assert abs(result.energy.xreplace({sympy.Symbol("T"): at[T]}).evalf(60) / expected - 1) < 1e-30
    result.derivation.check()


def test_what_is_a_sum_over_roots_is_undecided_with_its_reason() -> None:
    """λ³ − λ − 1 is irreducible: e^{AT} has no closed form, and the Gramian is a sum over its roots."""
    result: Any = symobs.minimum_energy_input(
        symobs.StateSpace("[0 1 0; 0 0 1; 1 1 0]", "[0; 0; 1]"), final=[1, 0, 0], horizon=1
    )
    assert (result.verdict, result.input) == ("undecided", None)
    assert "sums over roots" in result.question
    assert "too long" in str(result.to("text"))
