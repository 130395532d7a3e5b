"""Poles are called defective, and loops stable, where they are, and only there."""

from __future__ import annotations

import pytest

import symobs
from tests.kit import tabled, text_of


def page(A: str, B: str, C: str, control: str, observer: str) -> str:
    design = symobs.compensator(symobs.StateSpace(A, B, C), control_poles=control, observer_poles=observer)
    return text_of(design)


def test_one_chain_of_eigenvectors() -> None:
    # 1/(s(s+1)(s+5)) with -1, -1, -2: one input leaves one eigenvector for -1.
    text = page("[0 1 0; 0 0 1; 0 -5 -6]", "[0; 0; 1]", "[1 0 0]", "-1, -1, -2", "-5, -6, -7")
    assert "Since rank(A - B K + I) = 2, the repeated pole -1 gives transients with t exp(-t) beside exp(-t)." in text


@tabled
def test_a_mode_that_stays_may_have_an_eigenvector_of_its_own(
    A: str, B: str, C: str, control: str, observer: str
) -> None:
    # The input reaches one of two states with the eigenvalue -2; the other keeps its eigenvector.
    assert "gives transients" not in page(A, B, C, control, observer)


@pytest.mark.parametrize(
    ("control", "observer", "words"),
    [
        # For 1/s^2 the law has the polynomial s^2 + (k2 + l1) s + k1 + k2 l1 + l2 with k = (2, -3), l = (1, -12) and
        # k = (1, 2), l = (-4, -5).
        ("1, 2", "3, -4", "It is strictly proper, but the compensator itself is not stable, since"),
        ("-1, -1", "-1, 5", "It is strictly proper, but the compensator itself is not stable, since"),
    ],
)
def test_a_loop_that_was_asked_to_be_unstable_is_not_called_stable(control: str, observer: str, words: str) -> None:
    text = page("[0 1; 0 0]", "[0; 1]", "[1 0]", control, observer)
    assert words in text
    assert "although the closed loop is" not in text


def test_a_stable_loop_around_an_unstable_law_is_called_so() -> None:
    # P = (s - 1)/(s (s - 2)): no stable law stabilises it, between the zeros 1 and infinity lies one pole.
    text = page("[0 1; 0 2]", "[0; 1]", "[-1 1]", "-1, -2", "-3, -4")
    assert "The compensator itself is not stable" in text
    assert "although the closed loop is stable." in text


def test_poles_that_cancel_in_the_loop_are_told() -> None:
    # The output does not see -2, so G_cl = (s^2 + 11 s + 12)/((s + 3)(s + 4)(s + 5)).
    text = page("[-1 0; 0 -2]", "[1; 1]", "[1 0]", "-3, -4", "-2, -5")
    assert "The poles -3, -4, -5 are control or observer poles" in text
    assert "cancellation removes -2." in text


def test_a_denominator_that_is_reduced_is_no_product() -> None:
    # As above, with poles of the feedback that no sentence can tell: s^2 + p s + q.
    plant = symobs.StateSpace("[-1 0; 0 -2]", "[1; 1]", "[1 0]")
    design = symobs.compensator(plant, control_polynomial="s^2 + p*s + q", observer_poles=[-2, -5])
    text = text_of(design)
    assert "The denominator divides the product of the two desired polynomials" in text
    assert "The denominator is the product" not in text
