"""Gains near the best conditioned placement, held to SciPy's of Tits and Yang, and to determinants of SymPy."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
import sympy
from scipy.signal import place_poles  # type: ignore[import-untyped]

import symobs
from symobs.ground.errors import InputError
from tests.kit import tabled, text_of

if TYPE_CHECKING:
    from collections.abc import Callable

s = sympy.Symbol("s")

TANKS = symobs.StateSpace("[-0.02 0 0.04; 0 -0.01 0; 0 0 -0.04]", "[0.08 0; 0 0.06; 0 0.05]")
OF_TANKS = "-0.1, -0.11, -0.12"
CHAINS = symobs.StateSpace("[0 1 0; 0 0 0; 0 0 0]", "[0 0; 1 0; 0 1]")


def best(A: Any, B: Any, poles: list[complex]) -> float:
    """Return the largest entry of SciPy's gain."""
    with warnings.catch_warnings(action="ignore"):
        placed = place_poles(np.array(A, dtype=float), np.array(B, dtype=float), poles, maxiter=200, rtol=1e-6)
    return float(np.abs(placed.gain_matrix).max())


def largest(gain: sympy.Matrix) -> sympy.Rational:
    """Return the largest absolute value of an entry."""
    return max(abs(entry) for entry in gain)


def places(closed: sympy.Matrix, polynomial: str) -> bool:
    """Return whether a matrix has a characteristic polynomial, by SymPy."""
    found = closed.charpoly(s).as_expr()
    return bool(sympy.expand(found - sympy.sympify(polynomial, rational=True)) == 0)  # noqa: TID251 - texts of this file


def test_a_large_gain_gives_way_to_a_small_one() -> None:
    """The simple gain leaves the first input unused."""
    A, B = [[-0.02, 0, 0.04], [0, -0.01, 0], [0, 0, -0.04]], [[0.08, 0], [0, 0.06], [0, 0.05]]
    found = symobs.state_feedback(TANKS, poles=OF_TANKS)
    simple = symobs.state_feedback(TANKS, poles=OF_TANKS, choose="simple")
    reference = best(A, B, [-0.1, -0.11, -0.12])
    assert largest(simple.K) == sympy.Rational(304, 5) > 3 * reference
    assert largest(found.K) <= 1.5 * reference
    assert found.K == symobs.state_feedback(TANKS, poles=OF_TANKS, choose="small").K
    for design in (found, simple):
        closed = sympy.Matrix(3, 3, [sympy.Rational(str(a)) for row in A for a in row])
        closed -= sympy.Matrix(3, 2, [sympy.Rational(str(b)) for row in B for b in row]) * design.K
        assert places(closed, "(s + 1/10)*(s + 11/100)*(s + 12/100)")
    page = text_of(found)
    assert "near the placement whose eigenvectors are best conditioned" in page
    assert "an entry whose absolute value is at least 60" in page
    assert "best conditioned" not in text_of(simple)


@tabled
def test_every_task_with_a_gain_can_be_asked_for_a_small_one(task: str, asked: dict[str, Any], key: str) -> None:
    """Each of these plants has a simple gain more than 1.5 times as large as the best conditioned."""
    asked = {name: value.replace("{poles}", OF_TANKS) for name, value in asked.items()}
    A, B, C, dt = (asked.pop(name, None) for name in ("A", "B", "C", "dt"))
    plant = symobs.StateSpace(A, B, C, dt=dt is not None)
    design: Callable[..., Any] = getattr(symobs, task)
    small, simple = (design(plant, **asked, choose=choose) for choose in ("small", "simple"))
    assert largest(getattr(small, key)) < largest(getattr(simple, key))
    assert getattr(small, "polynomial", None) == getattr(simple, "polynomial", None)
    assert "near the placement whose eigenvectors are best conditioned" in text_of(small)


def test_a_repeated_pole_has_as_many_eigenvectors_as_inputs() -> None:
    """With two inputs A − BK can be similar to diag(−2, −2, …), where the simple gain has a Jordan block."""
    A, B = [[0, 1, 0, 0], [0, 0, 1, 1], [0, 0, 0, 1], [1, 0, 0, 0]], [[0, 0], [1, 0], [0, 0], [0, 1]]
    found = symobs.state_feedback(symobs.StateSpace(A, B), poles="-2, -2, -3+i, -3-i", choose="small")
    closed = sympy.Matrix(A) - sympy.Matrix(B) * found.K
    assert places(closed, "(s + 2)**2*(s**2 + 6*s + 10)")
    assert (closed + 2 * sympy.eye(4)).rank() == 2
    assert largest(found.K) <= 1.5 * best(A, B, [-2, -2, -3 + 1j, -3 - 1j])
    assert "a solution of the following equation" in text_of(found)


def test_the_family_of_a_plant_with_numbers_is_not_written_out_in_thousands_of_terms() -> None:
    """Of order 6 with three inputs it has 12 parameters; G, X and F say as much."""
    found = symobs.state_feedback(
        symobs.StateSpace(
            "[0 1 0 0 0 0; 0 0 0 0 0 0; 0 0 0 1 0 0; 0 0 0 0 0 0; 0 0 0 0 0 1; 0 0 0 0 0 0]",
            "[0 0 0; 1 0 0; 0 0 0; 0 1 0; 0 0 0; 0 0 1]",
        ),
        poles="-1, -1, -1, -2, -2, -2",
    )
    assert (found.family["dimension"], found.family["K"]) == (12, None)
    assert found.family["G"].shape == (3, 6)
    assert "not decided" not in found.family["scope"]


def test_with_letters_the_simple_gain_stays_and_the_page_says_why() -> None:
    plant = symobs.StateSpace("[0 1 0; 0 0 0; 0 0 a]", "[0 0; 1 0; 0 1]")
    found = symobs.state_feedback(plant, poles="-1, -2, -3", choose="small")
    assert found.K == symobs.state_feedback(plant, poles="-1, -2, -3").K
    assert "Small entries are chosen for numerical data only" in text_of(found)


def test_a_pole_that_has_too_few_eigenvectors_keeps_the_simple_gain_and_says_why() -> None:
    found = symobs.state_feedback(CHAINS, poles="-2, -2, -2", choose="small")
    assert found.K == symobs.state_feedback(CHAINS, poles="-2, -2, -2", choose="simple").K
    assert "One is desired more often, so that no gain is distinguished" in text_of(found)
    assert "desired more often" not in text_of(symobs.state_feedback(CHAINS, poles="-2, -2, -2"))


def test_beside_a_fixed_mode_the_simple_gain_stays_and_the_page_says_why() -> None:
    plant = symobs.StateSpace("[0 1 0 0; 0 0 0 0; 0 0 0 0; 0 0 0 -3]", "[0 0; 1 0; 0 1; 0 0]")
    found = symobs.state_feedback(plant, poles="-1, -2, -3, -4", choose="small")
    assert "Small entries are chosen where no mode is fixed" in text_of(found)


def test_one_input_has_one_gain_whatever_is_chosen() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]")
    assert list(symobs.state_feedback(plant, poles="-1, -2", choose="small").K) == [2, 3]


@tabled
def test_what_cannot_be_chosen_is_refused(asked: dict[str, str], message: str) -> None:
    with pytest.raises(InputError, match=message):
        symobs.state_feedback(CHAINS, **asked)


def test_nothing_is_chosen_where_every_gain_is_given() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]")
    with pytest.raises(InputError, match="both K and choose are given"):
        symobs.feedforward(plant, K="[1 1]", choose="small")
    with pytest.raises(InputError, match="both K and choose are given"):
        symobs.compensator(plant, K="[1 1]", L="[1; 1]", choose="small")
    assert list(symobs.compensator(plant, K="[1 1]", observer_poles="-1, -2", choose="small").L) == [3, 2]
