"""Disturbance observers held to simulations in plain arithmetic, and to the zeros of the plant; lies are rejected."""

from __future__ import annotations

import pytest
import sympy

import symobs
from symobs.ground.errors import InputError
from tests.kit import tabled, text_of


def test_a_zero_at_an_eigenvalue_of_the_exosystem_is_a_case_and_a_reason() -> None:
    """From d to y the plant has the transfer function (s + c)/((s + 1) (s + 2)), which at s = 0 is c/2."""
    plant = symobs.StateSpace("[0 1; -2 -3]", C="[c 1]")
    found = symobs.disturbance_observer(plant, E="[0; 1]", poles="-3, -4, -5")
    c = sympy.Symbol("c")
    assert sympy.Ne(c, 0) in found.conditions
    verdicts = {case.when: case.result.verdict for case in found.cases}
    assert verdicts == {(sympy.Eq(c, 0),): "no", (sympy.Eq(c - 1, 0),): "no", (sympy.Eq(c - 2, 0),): "no"}
    text = text_of(found)
    assert "The plant has a zero at the origin from the disturbance to the output" in text
    assert found.at(c=0).verdict == "no"
    assert found.at(c=3).fixed_modes == ()


def test_modes_that_cannot_be_moved_may_be_desired() -> None:
    plant = symobs.StateSpace("[0 1; -2 -3]", C="[1 1]")  # the mode -1 is not observable
    found = symobs.disturbance_observer(plant, E="[0; 1]", poles="-1, -4, -5")
    assert (found.verdict, found.fixed_modes) == ("yes", (-1,))
    assert "but it is among the desired poles" in text_of(found)


@tabled
def test_what_does_not_fit_is_refused(given: dict[str, str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.disturbance_observer(symobs.StateSpace("[0 1; 0 0]", C="[1 0]"), **{"E": "[0; 1]", **given})


def test_a_page_says_observable_where_the_gain_has_no_need_of_it() -> None:
    """Where a**3*b + … = 0 a mode is fixed, and desired: the gain is the same there, and the pair is not observable."""
    plant = symobs.StateSpace("[1+a -a 1+a; 0 -1 2; 1 0 0]", "[a; 0; 0]", "[a*b b a]", dt=True)
    result = symobs.disturbance_observer(plant, E="[0; 1; a]", S="[0]", V="[1]", poles="0, 1/2, -1/2, 1/3")
    a, b = sympy.symbols("a b")
    A = sympy.Matrix([[1 + a, -a, 1 + a, 0], [0, -1, 2, 1], [1, 0, 0, a], [0, 0, 0, 0]])
    rows = [sympy.Matrix([[a * b, b, a, 0]]) * A**k for k in range(4)]
    assert sympy.rem(sympy.Matrix.vstack(*rows).det(), a**3 * b + a**3 + a**2 * b + 2 * a**2 + 3 * a * b + b, b) == 0
    assert "a³ b + a³ + a² b + 2a² + 3a b + b ≠ 0" in text_of(result)


def test_more_disturbances_than_outputs_are_told_without_a_zero() -> None:
    plant = symobs.StateSpace("[0 1; -1 -1]", C="[1 0]")
    found = symobs.disturbance_observer(plant, E="[1 0; 0 1]", poles="-1, -2, -3, -4")
    assert found.verdict == "no"
    assert "zero at the origin" not in found.to("text")


def test_a_case_keeps_the_gain_of_the_main_line_where_that_serves() -> None:
    """At a = 0 the constant disturbance has another kernel, and the gain, a polynomial in a, still places the poles."""
    plant = symobs.StateSpace("[1 -2; 1 1]", "[-1; 1]", "[0 -2; -2 2]", dt=True, symbols={"a": "real"})
    found = symobs.disturbance_observer(plant, E="[1; 0]", S="[0 a; -a 0]", poles="0, 1/2, -1/2, 1/3")
    (case,) = found.case_tree
    assert case.result is not None
    assert case.result.fields["L_x"] == found.fields["L_x"].substitute(case.substitution)
