"""Integral action held to python-control: poles, DC gain from r to y, and the exact condition."""

from __future__ import annotations

import sympy

import symobs
from tests.kit import SERVO, tabled, text_of


@tabled
def test_outputs_that_cannot_follow_are_a_no_even_with_the_fixed_pole_desired(A: str, C: str, dt: int) -> None:
    """The plant has a zero at the origin (at 1): k_I would be 0 and ξ grow without bound for r ≠ 0."""
    found = symobs.integral_action(symobs.StateSpace(A, "[0; 1]", C, dt=dt), poles=f"{int(dt)}, -1/2, 0")
    assert (found.verdict, found.K, found.k_I, found.solvable) == ("no", None, None, False)
    page = text_of(found)
    assert "cannot follow arbitrary constant references" in page
    assert "as required" not in page


def test_a_zero_at_the_origin_is_a_case_with_its_proof() -> None:
    design = symobs.integral_action(symobs.StateSpace("[0 1; 0 -a]", "[0; 1]", "[c 1]"), poles="-1, -2, -3")
    c = sympy.Symbol("c")
    assert list(design.k_I) == [6 / c]
    ((conditions, there),) = design.cases
    assert conditions == (sympy.Eq(c, 0),) or str(conditions[0]) in {"c == 0", "Eq(c, 0)"}
    assert (there.verdict, there.solvable) == ("no", False)
    assert design.at(c=0).verdict == "no"
    assert list(design.at(c=2, a=1).k_I) == [3]


@tabled
def test_the_error_at_rest_is_no_matter_of_stability_that_was_shown(poles: str, said: str) -> None:
    found = symobs.integral_action(SERVO, poles=poles)
    assert said in found.to("latex")


def test_the_gain_of_several_inputs_follows_from_its_equations() -> None:
    """s² + 3s − 2k₃ = (s + 1)(s + 2) and s² + (k₁ + 2)s − k₂ = (s + 3)(s + 4), by hand."""
    plant = symobs.StateSpace("[-2 1; 1 -3]", "[1 0; 0 2]", "[1 0; 0 1]")
    page = text_of(symobs.integral_action(plant, poles="-1, -2, -3, -4"))
    assert "-2k₃ = 2, k₁ + 2 = 7, -k₂ = 12" in page
    assert "integrator together gives" not in page


def test_the_references_of_several_outputs_enter_through_a_unit_matrix() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[1 0; 0 1]", "[1 0; 0 1]")
    page = symobs.integral_action(plant, poles=[-1, -2, -3, -4]).to("text")
    assert "(-A_cl)⁻¹[0; I]" in page  # not the column of zeros and ones


def test_an_outline_has_words_before_the_gains() -> None:
    outline = " ".join(symobs.integral_action(SERVO, poles="-1, -2, -3").to("text", detail="outline").split())
    assert "Hence the gains of the state and of the integral are" in outline
