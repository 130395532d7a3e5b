"""What pages say in words is so for plants that are not the usual ones, and is said of them in whole sentences."""

from __future__ import annotations

from typing import Any

import pytest

import symobs
from symobs.formula import phrases
from tests.kit import tabled, text_of

# -- stability regions ------------------------------------------------------------------------------------------------


@tabled
def test_a_polynomial_that_is_stable_whatever_the_values(polynomial: str, parameters: list[str]) -> None:
    text = text_of(symobs.stability_region(polynomial, parameters=parameters))
    assert f"Hence all roots are stable for all values of {' and '.join(parameters)}." in text
    assert "connected" not in text


def test_where_a_single_value_is_left_out_not_all_are_stable() -> None:
    # s^2 + s + h^2 has the root 0 for h = 0 alone.
    assert "for all values" not in text_of(symobs.stability_region("s^2 + s + h^2", parameters=["h"]))
    assert "for all values" not in text_of(symobs.stability_region("s^2 + s + h^2 + k^2", parameters=["h", "k"]))


def test_one_point_has_two_sides() -> None:
    text = text_of(symobs.stability_region("s + h", parameters=["h"]))
    assert "The zero h = 0 of these leaves two intervals, on each of which the number of stable roots" in text


def test_stable_means_what_was_sought() -> None:
    # With the margin 1 the roots of s^2 + s + 1, which lie left of the axis, do not count as stable.
    text = text_of(symobs.stability_region("s^2 + h s + k", parameters=["h", "k"], margin=1))
    assert "has real part less than -1; such roots are called stable here." in text


def test_a_single_root_leaves_the_disc_alone() -> None:
    plant = symobs.StateSpace("[1/2]", C="[1]", dt=1)
    text = text_of(symobs.stability_region(plant, L="[h]", parameters=["h"]))
    assert "the root can leave the disc only at 1 or at −1, that is, where one of the following vanishes" in text


# -- functions of time ------------------------------------------------------------------------------------------------


def test_a_horizon_of_no_length_is_no_case() -> None:
    # W(T) = T: the variance is r/T + q T/3, and T = 0 no horizon.
    plant = symobs.StateSpace("[0]", "[1]", "[1]")
    design = symobs.initial_state_covariance(plant, Q="q", R="r", horizon="T")
    assert not design.cases
    assert "Case" not in text_of(design)


def test_no_estimate_where_the_rank_is_smaller_for_some_parameters_still() -> None:
    """The second state alone is measured, with a factor b: rank [0 b; 0 0] is 1, and 0 for b = 0."""
    for sign, words in (("real", "for no values is it larger"), ("positive", "Here rank")):
        plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[0 b]", symbols={"b": sign})
        assert words in text_of(symobs.initial_state_covariance(plant, Q="1", R="1", horizon="1"))


# -- gains ------------------------------------------------------------------------------------------------------------


def test_a_gain_is_found_chain_by_chain_where_its_entries_part_the_polynomial() -> None:
    """A triple integrator and a lag: (s + 1)(s + 2)(s + 3) = s³ + 6s² + 11s + 6 for the one, s + 4 for the other."""
    plant = symobs.StateSpace("[0 1 0 0; 0 0 1 0; 0 0 0 0; 0 0 0 -1]", "[0 0; 0 0; 1 0; 0 1]")
    found = symobs.state_feedback(plant, poles=[-1, -2, -3, -4])
    text = text_of(found)
    assert found.K.tolist() == [[6, 11, 6, 0], [0, 0, 0, 3]]
    assert "k₄ + 1 = 4, k₃ = 6, k₂ = 11, k₁ = 6" in text
    assert "a family of dimension 4" in text
    assert "Sylvester" not in text


def test_a_gain_of_many_is_not_called_the_only_one() -> None:
    # Two outputs see the modes -1, -2, c: for c = -2 one of two modes -2 is hidden.
    plant = symobs.StateSpace("[-1 0 0; 0 -2 0; 0 0 c]", C="[1 0 0; 0 1 c]")
    text = text_of(symobs.observer(plant, poles=[-1, -2, -3], method="sylvester"))
    assert "c = -2 │ -2 │ this L " in " ".join(text.split())
    assert "only one" not in text


def test_the_equation_is_solved_where_its_own_spectra_are_apart() -> None:
    # The plant has the poles -1 and -2 that are asked for; a gain taken out first moves them away.
    plant = symobs.StateSpace("[-1 0 0; 0 -2 0; 0 0 c]", C="[1 0 0; 0 1 c]")
    text = text_of(symobs.observer(plant, poles=[-1, -2, -3], method="sylvester"))
    assert "if and only if no desired pole is an eigenvalue of the plant" not in text
    assert "if and only if the two coefficient matrices have no common eigenvalue" in text


def test_gains_that_a_family_leaves_out_are_told() -> None:
    # L = [3 0] places -1 as well, and has no G with 1 in its second row.
    text = text_of(symobs.observer(symobs.StateSpace("[2]", C="[1; 3]"), poles=[-1], method="sylvester"))
    assert "and nongeneric ones for which that row cannot be fixed." in text


@pytest.mark.parametrize("outputs", ["[0 0]", "[0 0; 0 0]"])
def test_where_all_poles_are_fixed_there_are_no_others(outputs: str) -> None:
    text = text_of(symobs.observer(symobs.StateSpace("[-1 0; 0 -2]", C=outputs), poles=[-1, -2]))
    assert "No other poles remain to be placed, so any gain will do, for example" in text
    assert "that places the remaining poles is" not in text
    assert "Sylvester" not in text


def test_what_is_hidden_from_the_input_is_not_called_seen() -> None:
    plant = symobs.StateSpace("[-1 0; 0 -2]", "[1 2; 0 0]")
    text = text_of(symobs.state_feedback(plant, poles=[-2, -5]))
    assert (
        "one parameter is free on the controllable part; on the uncontrollable modes two entries are arbitrary" in text
    )


# -- cautions ---------------------------------------------------------------------------------------------------------


def test_a_single_pole_at_0_keeps_the_start() -> None:
    text = text_of(symobs.state_feedback(symobs.StateSpace("[2]", "[1]"), poles=[0]))
    assert "A desired pole is 0: the closed loop converges to an equilibrium" in text


@pytest.mark.parametrize(
    ("poles", "dt", "words"),
    [
        (
            [0, -1],
            None,
            "A desired pole is 0: the closed loop converges to an equilibrium that depends on the initial state.",
        ),
        (
            [1, "1/2"],
            1,
            "A desired pole is 1: the closed loop converges to an equilibrium that depends on the initial state.",
        ),
        (
            [-1, "1/2"],
            1,
            "lies on the unit circle: for almost every initial state the closed loop does not converge to an equilibrium.",
        ),
    ],
)
def test_a_loop_that_keeps_a_part_of_its_start_does_come_to_rest(poles: list[Any], dt: Any, words: str) -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", dt=dt)
    assert words in text_of(symobs.state_feedback(plant, poles=poles))


# -- compensators -----------------------------------------------------------------------------------------------------


@tabled
def test_a_loop_without_response_has_no_poles(B: str, C: str, control: str, observer: str) -> None:
    design = symobs.compensator(symobs.StateSpace("[-1 0; 0 -2]", B, C), control_poles=control, observer_poles=observer)
    assert "It has no poles: all control and observer poles, -" in text_of(design)


def test_a_single_pole_that_is_left_is_one() -> None:
    plant = symobs.StateSpace("[1 0; 0 -2]", "[1; 1]", "[0 1]")
    text = text_of(symobs.compensator(plant, control_poles=[-1, -2], observer_poles=[1, -4]))
    assert "The only pole, -2, is a control or observer pole, as expected" in text


def test_a_direct_term_that_is_zero_is_not_given_a_reason() -> None:
    # The control poles are those of the plant: K = 0, and so is the law.
    plant = symobs.StateSpace("[-1 0; 0 -2]", "[1; 1]", "[1 1]")
    text = text_of(symobs.compensator(plant, control_poles=[-1, -2], observer_poles=[-3], observer="minimal"))
    assert "has a direct term" not in text


# -- reduced-order observers ------------------------------------------------------------------------------------------


def test_what_no_gain_moves_is_not_compared() -> None:
    text = text_of(symobs.reduced_order_observer(symobs.StateSpace("[-1 0; 0 -2]", "[1; 1]", "[1 0]"), poles=[-2]))
    assert "No L moves the mode -2, and it is the desired pole: any gain will do, for example" in text
    assert "Equating coefficients gives" not in text
    assert "does not work here" not in text


def test_coordinates_under_a_condition_are_told_in_whole_sentences() -> None:
    # For c = 0 there is no output, which no row completes.
    text = text_of(symobs.reduced_order_observer(symobs.StateSpace("[0 0; 0 1]", C="[0 c]"), poles=[0]))
    assert "otherwise C must be completed by other rows." in text


# -- feedforward and tracking -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("A", "B", "C", "D", "poles", "words"),
    [
        ("[0 1; 0 0]", "[0; 1]", "[0 1]", None, "-1, -1; -2, 0", "the plant has a zero at zero frequency"),
        ("[-1 0; 0 -2]", "[0; 0]", "[1 1]", None, "-1, -2; -3, -4", "The transfer function of the plant is zero"),
        (
            "[0 1; 0 0]",
            "[1 0; 0 1]",
            "[1 0; 2 0]",
            None,
            "-1, -2; -3, 0",
            "= 1, which is less than the number of outputs",
        ),
        ("[0 1; 0 0]", "[0; 1]", "[1 0; 0 1]", None, "-1, -2; -3, -4", "= 1, which is less than the number of outputs"),
        (
            "[-1 0; 0 -2]",
            "[1 0; 0 1]",
            "[1 0; 0 1]",
            "[-1 0; 0 0]",
            "-1, -2; -3, -4",
            "the plant has a zero at zero frequency",
        ),
        (
            "[0 1; 0 0]",
            "[0; 1]",
            "[1 0]",
            None,
            "-1, 0; -3, -4",
            "The steady state, if there is one, therefore depends on the",
        ),
    ],
)
def test_why_the_output_at_rest_cannot_be_set(A: str, B: str, C: str, D: Any, poles: str, words: str) -> None:
    control, observer = poles.split(";")
    plant = symobs.StateSpace(A, B, C, D)
    text = text_of(symobs.feedforward(plant, control_poles=control, observer_poles=observer, observer="full"))
    assert words in text
    assert ("has a zero at zero frequency" in text) == ("has a zero at zero frequency" in words)


def test_a_reference_that_stays_in_0_is_refused() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    with pytest.raises(symobs.InputError, match="reference_start is 0"):
        symobs.tracking(plant, control_poles=[-1, -2], observer_poles=[-3], reference_start="[0; 0]")


# -- integrals over time ----------------------------------------------------------------------------------------------


def test_a_gramian_that_may_not_exist_is_not_said_to_have_no_kernel() -> None:
    # The integral over all time exists for a > 0 alone.
    text = text_of(symobs.gramian(symobs.StateSpace("[-a 0; 0 -2]", C="[1 1]"), horizon="inf"))
    assert "so its kernel is trivial." in text
    assert "and so is that of W" not in text


def test_without_input_noise_there_is_one_part() -> None:
    plant = symobs.StateSpace("[-1]", "[1]", "[1]")
    assert "sum of two terms" not in text_of(symobs.initial_state_covariance(plant, R="r", horizon="T"))
    assert "sum of two terms" in text_of(symobs.initial_state_covariance(plant, Q="q", R="r", horizon="T"))


@tabled
def test_input_noise_that_does_not_arrive_spoils_no_estimate(B: str, Q: str) -> None:
    text = text_of(symobs.initial_state_covariance(symobs.StateSpace("[-1]", B, "[1]"), Q=Q, R="r", horizon="T"))
    assert "is not the minimum-variance estimate" not in text


# -- time-varying plants ----------------------------------------------------------------------------------------------


def test_not_every_function_is_an_output() -> None:
    # x stays where it is, so y = x1 + t x2, and t^2 is no output.
    text = text_of(
        symobs.time_varying_observability(symobs.StateSpace("[0 0; 0 0]", C="[1 t]"), interval="0, 1", output="t^2")
    )
    assert "No initial state produces this output" in text
    assert "distinct initial states give distinct outputs" in text


def test_a_rank_that_drops_is_not_told_of_every_instant() -> None:
    # [C; CA] = [t t^2; 0 0] has the rank 1 but for t = 0.
    text = text_of(symobs.time_varying_observability(symobs.StateSpace("[0 0; 0 0]", C="[t t^2]"), interval="0, 1"))
    assert "= 1 at almost every instant, and never more, and yet the plant is observable" in text


def test_several_hidden_directions_may_be_combined() -> None:
    two = symobs.StateSpace("[0 0 0; 0 0 0; 0 0 -1]", C="[0 0 1]")
    text = text_of(symobs.initial_state(two, output="exp(-t)", horizon=1))
    assert (
        "the vectors in the further equations are unobservable, so any linear combination of them may be added" in text
    )
    one = symobs.StateSpace("[0 0; 0 -1]", C="[0 1]")
    assert "so any multiple of it may be added" in text_of(symobs.initial_state(one, output="exp(-t)", horizon=1))


# -- advice on poles --------------------------------------------------------------------------------------------------


def test_a_radius_is_said_to_be_positive() -> None:
    # For r < 0 the roots of s^2 + sqrt(2) r s + r^2 lie in the right half-plane.
    double = ("[0 1; 0 0]", "[0; 1]", "[1 0]")
    assert "Being a radius, r is positive." in text_of(symobs.pole_advice(symobs.StateSpace(*double), radius="r"))
    known = symobs.StateSpace(*double, symbols={"r": "positive"})
    assert "Being a radius" not in text_of(symobs.pole_advice(known, radius="r"))
    assert "Being a radius" not in text_of(symobs.pole_advice(symobs.StateSpace(*double), radius=10))


def test_a_zero_that_is_stable_and_slow_is_not_denied() -> None:
    plant = symobs.StateSpace("[0 1 0; 0 0 1; 0 0 0]", "[0; 0; 1]", "[1/10 1 0]")
    text = text_of(symobs.pole_advice(plant, settling_time=2, overshoot="1/20"))
    assert "The zero -1/10 is too slow for the settling time and is not used." in text
    assert "No stable zero" not in text


def test_what_is_demanded_of_phrases_is_demanded_of_phrases_that_exist() -> None:
    for listed in (
        phrases.ASSERTS,
        phrases.RESTS_ON,
        phrases.NAMING,
        phrases.OPENS,
        phrases.EXPLAINS,
        phrases.SPELLS_OUT,
    ):
        assert set(listed) <= phrases.PHRASES.keys()


def test_where_two_decays_are_equal_the_kernel_of_the_gramian_is_told() -> None:
    """With A = diag(−a, −b) and C = [1 1] the difference of the states is unseen at a = b, and (C; CA)(−1, 1)ᵀ = 0 there."""
    plant = symobs.StateSpace("[-a 0; 0 -b]", C="[1 1]", symbols={"a": "positive", "b": "positive"})
    _, _, sums = str(symobs.gramian(plant, horizon="inf").to("text")).partition("2. Finite sum")
    _, _, equal = sums.partition("Case a = b.")
    lines = "\n".join(line.strip() for line in equal.splitlines())
    assert "have the same kernel. For" in lines
    assert "v = ⎡-1⎤\n⎣ 1⎦" in lines
    assert "W v = ⎡0⎤,    M v = ⎡0⎤" in lines


def test_a_motion_from_rest_that_stands_still_solves_no_equation_of_zeros() -> None:
    plant = symobs.StateSpace("[-1/2 1/10; 0 -1/5]", "[1; 0]", "[0 1]")
    text = text_of(symobs.initial_state(plant, output="exp(-t/5)", input="0"))
    assert "which solves" not in text
    assert "The output is y = C exp(A t)x₀ plus the forced response" in text
    assert "the vector in the second equation is unobservable, so any multiple of it may be added" in text
