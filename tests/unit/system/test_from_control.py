"""Plants that come from python-control: floats as their shortest decimals, and the page says so."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import control  # type: ignore[import-untyped]
import numpy as np
import pytest
import sympy

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError


def test_floats_are_read_as_their_shortest_decimals() -> None:
    plant = StateSpace.from_control(control.ss([[0, 1], [0.1, -10.78]], [[0], [1e-3]], [[1, 0]], [[0]]))
    assert sympy.ImmutableMatrix([[0, 1], [sympy.Rational(1, 10), sympy.Rational(-539, 50)]]) == plant.A
    assert sympy.ImmutableMatrix([[0], [sympy.Rational(1, 1000)]]) == plant.B
    assert plant.dt == 0


def test_the_page_says_what_was_read() -> None:
    plant = StateSpace.from_control(control.ss([[0, 1], [0, -1]], [[0], [1]], [[1, 0]], [[0]]))
    sentence = "shortest decimals that represent them"
    assert sentence in " ".join(symobs.observer(plant, poles=[-10, -10]).to("text").split())
    exact = StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")
    assert sentence not in " ".join(symobs.observer(exact, poles=[-10, -10]).to("text").split())


@pytest.mark.parametrize(("dt", "expected"), [(0, 0), (True, True), (0.1, sympy.Rational(1, 10)), (None, 0)])
def test_time_is_carried_over(dt: Any, expected: Any) -> None:
    plant = StateSpace.from_control(control.ss([[0.5]], [[1]], [[1]], [[0]], dt))
    assert plant.dt == expected
    assert plant.is_discrete == (expected != 0)


def test_gains_agree_with_the_numbers_of_python_control() -> None:
    system = control.ss([[0, 1, 0], [0, 0, 1], [-0.5, -1.25, 2]], [[0], [0], [1]], [[1, 0.5, 0]], [[0]])
    ours = symobs.state_feedback(StateSpace.from_control(system), poles=[-1, -2, "-5/2"]).K
    theirs = control.acker(system.A, system.B, [-1, -2, -2.5])
    assert np.allclose(np.array(ours, dtype=float), theirs, rtol=1e-9)


@pytest.mark.parametrize(
    "system",
    [
        SimpleNamespace(A=np.array([[np.nan]]), B=np.array([[1.0]]), C=np.array([[1.0]]), D=np.array([[0.0]]), dt=0),
        SimpleNamespace(A=np.array([[1j]]), B=np.array([[1.0]]), C=np.array([[1.0]]), D=np.array([[0.0]]), dt=0),
    ],
)
def test_what_is_no_system_of_finite_numbers_is_refused(system: Any) -> None:
    with pytest.raises(InputError) as caught:
        StateSpace.from_control(system)
    assert caught.value.where == "plant.A"
    assert caught.value.repair


@pytest.mark.parametrize(
    ("plant", "poles"),
    [
        (("[0 1; 0 -1]", "[0; 1]", "[1 0]"), [-10]),
        (("[-7 1 15; -2 0 5; -2 0 4]", "[65; -5; 30]", "[1 0 -2]"), [-5, -6]),
        (("[0 0 0 1; 0 0 1 0; 0 10.78 0 0; 0 -0.98 0 0]", "[0; 0; -1; 1]", "[1 0 0 0]"), [-20, "-20+20i", "-20-20i"]),
    ],
    ids=["S0-Ex4.4", "S0-MIN-GENC", "S2-EX-PEND"],
)
def test_the_gain_of_a_reduced_order_observer_is_the_one_that_place_finds(plant: Any, poles: Any) -> None:
    """As S2 does it: `place` on the transposed pair (A22, A12) of T A T⁻¹."""
    found = symobs.reduced_order_observer(symobs.StateSpace(*plant), poles=poles)
    moved = np.array(found.T * found.plant.A * found.T.inv(), dtype=float)
    numbers = [complex(str(pole).replace("i", "j")) for pole in poles]
    gain = control.place(moved[1:, 1:].T, moved[:1, 1:].T, numbers).T
    assert np.allclose(gain, np.array(found.L, dtype=float), rtol=1e-9)
    closed = moved[1:, 1:] - np.array(found.L, dtype=float) @ moved[:1, 1:]
    assert np.allclose(np.poly(closed), np.poly(numbers), rtol=1e-9)
