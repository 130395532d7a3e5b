"""Compensators for several inputs and outputs, with either observer: the loop's polynomial, F(s), refusals."""

from __future__ import annotations

from typing import Any

import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import SERVO, tabled, text_of


def test_the_ill_posed_loop_is_refused_with_its_reason() -> None:
    """S0, Example 4.4 with D = 1/31: the direct term of the control law meets that of the plant."""
    found = symobs.compensator(
        StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]", "1/31"),
        control_poles=[-2, -2],
        observer_poles=[-10],
        observer="minimal",
    )
    assert found.verdict == "no"
    assert found.answer["K"] is not None
    assert "cannot be solved for u" in found.to("text")
    with pytest.raises(
        CertificateRejected,
        match=r"the claim F = \(I \+ K_2",
    ):
        found.with_answer("F", symobs.compensator(SERVO, **ASKED).answer["F"])


ASKED: dict[str, Any] = {"control_poles": [-2, -2], "observer_poles": [-10], "observer": "minimal"}


def test_of_many_gains_one_that_leaves_the_law_unsolved_rules_out_no_other() -> None:
    """The law with the gains chosen cannot be solved for u; with another K of the same poles it can."""
    plant = StateSpace("[-2 -1 0; 1 1 -1; 1 2 -2]", "[0 0; 0 0; -2 -2]", "[1 1 1]", "[1 -1]")
    asked: dict[str, Any] = {"control_poles": [-1, -2, -3], "observer_poles": [-4, -5], "observer": "minimal"}
    found = symobs.compensator(plant, **asked)
    assert (found.verdict, found.answer["F"]) == ("undecided", None)
    assert "Other gains with the same poles were not tried" in text_of(found)
    zero = "[0 0 0; 0 0 0; 0 0 0]"
    assert symobs.feedforward(plant, **asked).verdict == "undecided"
    assert symobs.tracking(plant, **asked, reference_matrix=zero).verdict == "undecided"
    M = sympy.Matrix([[str(entry) for entry in row] for row in found.estimator.answer["M"].rows])  # x̂ = M [y − D u; z]
    D, K = sympy.Matrix([[1, -1]]), sympy.Matrix(found.K)
    other = K + sympy.Matrix([[1], [-1]]) * sympy.Matrix([[1, 0, 0]])  # B (1, -1) = 0, so this moves no pole
    ill, well = ((sympy.eye(2) - gain * M[:, :1] * D).det() for gain in (K, other))
    assert ill == 0
    assert well != 0


def test_a_well_posed_compensator_cannot_be_called_ill_posed() -> None:
    found = symobs.compensator(SERVO, **ASKED)
    with pytest.raises(CertificateRejected, match=r"the claim det\(I - N\*D\) = 0"):
        found.with_answer("F", None)


@tabled
def test_what_does_not_fit_together_is_refused_with_the_repair(keywords: Any, where: str, words: str) -> None:
    with pytest.raises(InputError) as caught:
        symobs.compensator(SERVO, **{**ASKED, **keywords})
    assert caught.value.where == where
    assert words in caught.value.repair


# -- what a reading of the whole found ------------------------------------------------------------------------------------


def test_what_uses_the_estimate_needs_a_law_that_can_be_solved() -> None:
    """With D = 1/31 the control law of S0, Example 4.4 cannot be solved for u, whatever is added to it."""
    ill_posed = ("[0 1; 0 -1]", "[0; 1]", "[1 0]", "1/31")
    asked: dict[str, Any] = {"control_poles": [-2, -2], "observer_poles": [-10]}
    for task in (symobs.feedforward, symobs.tracking):
        found = task(StateSpace(*ill_posed), observer="minimal", **asked)
        assert found.verdict == "no"
        assert "cannot be solved for u" in found.to("text")
    parametric = symobs.feedforward(StateSpace(*ill_posed[:3], "d"), observer="minimal", **asked)
    assert [str(condition) for condition in parametric.conditions] == ["Ne(31*d - 1, 0)"]
    assert [case.result.verdict for case in parametric.case_tree if case.result is not None] == ["no"]


@pytest.mark.slow
def test_a_compensator_whose_stability_is_undecided_has_a_page_that_is_silent_about_it() -> None:
    plant = symobs.StateSpace(
        "[1 -1 0; 0 0 1/2; -1 1/2 1]", "[2; 0; 0]", "[1 2 -1; 0 -1 1]", dt="1/10", symbols={"p": "nonzero"}
    )
    design = symobs.compensator(plant, control_poles="-p, -p, -p", observer_poles="-10, -6, -8", choose="simple")
    assert design.F_stable == "undecided"
    text = text_of(design)
    assert "It is strictly proper. 4." in text
    assert "if and only if ." not in text


def test_outputs_that_see_nothing_leave_the_modes_where_they_are() -> None:
    assert symobs.observer(StateSpace("3", C="[0; 0]"), poles=[3]).verdict == "yes"
    hidden = StateSpace("[1 0 0; 0 2 0; 0 0 3]", C="[1 1 0; 0 1 0]")
    assert symobs.reduced_order_observer(hidden, poles=[3]).fixed_modes == (3,)


def test_the_time_is_no_name_for_a_parameter_of_the_coordinates() -> None:
    with pytest.raises(InputError, match="another name"):
        symobs.reduced_order_observer(StateSpace("[0 1; 0 -1]", C="[1 0]"), poles=[-1], T="[1 0; 0 t]")


def test_where_an_impossible_reference_can_be_followed_is_said() -> None:
    plant = StateSpace("[0 1; 0 -1]", "[b; 1]", "[1 0]")
    found = symobs.tracking(plant, control_poles=[-2, -2], observer_poles=[-10], reference_matrix="[0 1; -1 0]")
    assert found.verdict == "no"
    (followed,) = [case for case in found.case_tree if case.result is not None and case.result.verdict == "yes"]
    assert [str(condition.expression) for condition in followed.when] == ["b"]
    assert followed.result is not None
    assert str(followed.result.answer["K_d"]) == "[1 -1]"


@tabled
def test_a_given_gain_is_not_also_chosen(keywords: Any) -> None:
    with pytest.raises(InputError, match="both L and"):
        symobs.observer(StateSpace("[0 1; -2 -3]", C="[1 0; 0 1]"), L="[1 2; 3 4]", **keywords)


def test_the_closed_loop_has_a_value_wherever_the_conditions_hold() -> None:
    """No factor is divided by a leading coefficient that a parameter can make vanish, here d (46 d − 1)."""
    plant = StateSpace("[0 1 0; 0 0 1; 1 2 3]", "[0 1; 0 0; 1 0]", "[1 0 0; 0 1 0]", "[1 0; d 0]")
    found = symobs.compensator(plant, control_poles=[-1, -2, -3], observer_poles=[-4], observer="minimal")
    assert [str(condition) for condition in found.conditions] == ["Ne(46*d - 1, 0)"]
    assert not found.closed_loop.subs("d", 0).has(sympy.nan, sympy.zoo)


@tabled
def test_the_unity_loop_divides_by_no_parameter_that_stands_in_front(A: str, B: str, C: str) -> None:
    """Its factored form is PF/(1 + PF), and no factor of it has a denominator."""
    plant = symobs.StateSpace(A, B, C)
    found = symobs.compensator(plant, control_poles=[-1, -2], observer_poles=[-3, -4])
    form = found.unity_loop
    s = sympy.Symbol("s")
    P = (plant.C * (s * sympy.eye(2) - plant.A).inv() * plant.B)[0]
    assert sympy.simplify(found.closed_loop_unity - P * found.F / (1 + P * found.F)) == 0
    assert all(factor.denominator.is_constant for factor, _ in form.factors)


def test_a_compensator_that_is_stable_for_some_parameters_says_for_which() -> None:
    """s² + (10 − a) s + a² − 10 a + 35, whose last coefficient is (a − 5)² + 10, has its roots in Re s < 0 for a < 10."""
    plant = symobs.StateSpace("[0 1; 0 -a]", "[0; 1]", "[1 0]")
    found = symobs.compensator(plant, control_poles="-1, -2", observer_poles="-3, -4")
    assert (found.F_stable, list(found.F_stable_if)) == ("conditional", ["a < 10"])
    assert found.at(a=1).F_stable_if is None


def test_the_feedforward_of_a_state_says_where_the_dc_gain_vanishes() -> None:
    """G = c/k for u = −[k 1] x + F v: F = k/c, none where c = 0, and no steady state where k = 0."""
    found = symobs.feedforward(StateSpace("[0 1; 0 -1]", "[0; 1]", "[c 1]"), K="[k 1]")
    c, k = sympy.symbols("c k")
    assert k / c == found.F
    assert {str(case.when[0]): case.result.verdict for case in found.cases} == {"Eq(c, 0)": "no", "Eq(k, 0)": "no"}
    text = found.to("text")
    assert "Observer" not in text
    assert "provided that" in text
    assert "Case c = 0" in text


def test_a_feedforward_has_control_poles_or_a_gain() -> None:
    plant = SERVO
    with pytest.raises(InputError, match="control_poles are missing"):
        symobs.feedforward(plant)
    with pytest.raises(InputError, match="both K and control_poles"):
        symobs.feedforward(plant, K="[1 1]", control_poles=[-1, -2])
    with pytest.raises(InputError, match="observer_poles are missing"):
        symobs.feedforward(plant, K="[1 1]", observer="minimal")
