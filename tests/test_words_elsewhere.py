"""What pages say in words is so for plants that are not the usual ones, and is said of them in whole sentences."""

from __future__ import annotations

from typing import Any

import pytest

import symobs


def text_of(result: Any) -> str:
    return " ".join(str(result.to("text")).split())


# -- stability regions ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("polynomial", "parameters"),
    [
        ("s^2 + 2 s + 1 + (h - 1)^2", ["h"]),
        ("s^2 + 2 s + 1 + h^2", ["h"]),
        ("s^2 + 2 s + 1 + h^2 + k^2", ["h", "k"]),
        ("s^2 + 2 s + 1 + h^2 + (h - k)^2", ["h", "k"]),
    ],
)
def test_a_polynomial_that_is_stable_whatever_the_values(polynomial: str, parameters: list[str]) -> None:
    text = text_of(symobs.stability_region(polynomial, parameters=parameters))
    assert f"So all roots are stable for all values of {' and '.join(parameters)}." in text
    assert "connected" not in text


def test_where_a_single_value_is_left_out_not_all_are_stable() -> None:
    # s^2 + s + h^2 has the root 0 for h = 0 alone.
    assert "for all values" not in text_of(symobs.stability_region("s^2 + s + h^2", parameters=["h"]))
    assert "for all values" not in text_of(symobs.stability_region("s^2 + s + h^2 + k^2", parameters=["h", "k"]))


def test_one_point_has_two_sides() -> None:
    text = text_of(symobs.stability_region("s + h", parameters=["h"]))
    assert "On either side of this point nothing changes" in text
    assert "Between one point" not in text


def test_stable_means_what_was_sought() -> None:
    # With the margin 1 the roots of s^2 + s + 1, which lie left of the axis, do not count as stable.
    text = text_of(symobs.stability_region("s^2 + h s + k", parameters=["h", "k"], margin=1))
    assert "has a real part below -1; a root that has is called stable here." in text


def test_a_single_root_leaves_the_disc_alone() -> None:
    plant = symobs.StateSpace("[1/2]", C="[1]", dt=1)
    text = text_of(symobs.stability_region(plant, L="[h]", parameters=["h"]))
    assert "the root leaves the disc only at 1 or at −1: where one of these vanishes" in text


# -- functions of time ------------------------------------------------------------------------------------------------


def test_a_horizon_of_no_length_is_no_case() -> None:
    # W(T) = T: the variance is r/T + q T/3, and T = 0 no horizon.
    plant = symobs.StateSpace("[0]", "[1]", "[1]")
    design = symobs.initial_state_covariance(plant, Q="q", R="r", horizon="T")
    assert not design.cases
    assert "Case" not in text_of(design)


# -- gains ------------------------------------------------------------------------------------------------------------


def test_a_gain_of_many_is_not_called_the_only_one() -> None:
    # Two outputs see the modes -1, -2, c: for c = -2 one of two modes -2 is hidden.
    plant = symobs.StateSpace("[-1 0 0; 0 -2 0; 0 0 c]", C="[1 0 0; 0 1 c]")
    text = text_of(symobs.observer(plant, poles=[-1, -2, -3]))
    assert "is among the poles asked for, so this L still works." in text
    assert "only one" not in text


def test_the_equation_is_solved_where_its_own_spectra_are_apart() -> None:
    # The plant has the poles -1 and -2 that are asked for; a gain taken out first moves them away.
    plant = symobs.StateSpace("[-1 0 0; 0 -2 0; 0 0 c]", C="[1 0 0; 0 1 c]")
    text = text_of(symobs.observer(plant, poles=[-1, -2, -3]))
    assert "where no pole asked for is an eigenvalue of the plant" not in text
    assert "where the two square matrices beside the unknown one have no eigenvalue in common" in text


def test_gains_that_a_family_leaves_out_are_told() -> None:
    # L = [3 0] places -1 as well, and has no G with 1 in its second row.
    text = text_of(symobs.observer(symobs.StateSpace("[2]", C="[1; 3]"), poles=[-1]))
    assert "and special ones for which that row cannot be held. All the others are" in text


@pytest.mark.parametrize("outputs", ["[0 0]", "[0 0; 0 0]"])
def test_where_all_poles_are_fixed_there_are_no_others(outputs: str) -> None:
    text = text_of(symobs.observer(symobs.StateSpace("[-1 0; 0 -2]", C=outputs), poles=[-1, -2]))
    assert "There are no others to place, so every gain serves, for example" in text
    assert "places the others" not in text
    assert "Sylvester" not in text


def test_what_is_hidden_from_the_input_is_not_called_seen() -> None:
    plant = symobs.StateSpace("[-1 0; 0 -2]", "[1 2; 0 0]")
    text = text_of(symobs.state_feedback(plant, poles=[-2, -5]))
    assert "the part that the input moves has the freedom of Sylvester's equation" in text


def test_the_smallest_feedback_speaks_of_a_controllable_pair() -> None:
    plant = symobs.StateSpace("[0 1 0; 0 0 1; 0 0 0]", "[1 0; 0 1; 1 1]")
    text = text_of(symobs.state_feedback(plant, poles=[-1, -2, -3], member="smallest"))
    assert "The pair is controllable and the polynomial asked for has no multiple root" in text
