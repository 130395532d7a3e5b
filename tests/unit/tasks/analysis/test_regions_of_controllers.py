"""Stability regions of loops with a controller, improper ones too: against textbooks, and against the roots of NumPy."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np
import pytest

import symobs
from symobs.ground.errors import InputError

plant = symobs.StateSpace.from_transfer_function


@pytest.mark.parametrize(
    ("transfer_function", "controller", "printed"),
    [
        ("1/(s*(s+1)*(s+2))", "k", ["k > 0", "k < 6"]),  # Ogata, Modern Control Engineering, 5th ed., Example 6-1
        (
            "1/(s+1)^3",
            "k",
            ["k > -1", "k < 8"],
        ),  # Astrom and Hagglund, Advanced PID Control, ch. 4: the ultimate gain 8
        ("(s+1)/(s*(s-1)*(s+6))", "k", ["k > 15/2"]),  # Franklin, Powell and Emami-Naeini, 7th ed., Example 3.33
        # the same, Example 3.34: K_I > 0 and K > K_I/3 - 2, solved for K_I
        ("1/((s+1)*(s+2))", "K + K_I/s", ["K_I > 0", "K_I < 3*K + 6"]),
    ],
)
def test_regions_of_textbooks(transfer_function: str, controller: str, printed: list[str]) -> None:
    found: Any = symobs.stability_region(plant(transfer_function), controller=controller)
    assert {str(each).replace(" ", "") for each in found.stable_if} == {each.replace(" ", "") for each in printed}


@pytest.mark.parametrize("dt", [0, 1])
def test_a_region_of_pid_gains_is_that_of_the_roots(dt: int) -> None:
    """Hold the conditions of Kp and Ki at a grid of gains against the roots of the closed loop."""
    if dt:
        above, below, controller = [1.0, 0.0], [1.0, -1.2, 0.32], "Kp + Ki*z/(z-1) + (z-1)/(2*z)"
        found: Any = symobs.stability_region(plant("z/((z-2/5)*(z-4/5))", dt=1), controller=controller)
        lower, upper = [1.0, -1.0, 0.0], [[0.5, -1.0, 0.5], [1.0, -1.0, 0.0], [1.0, 0.0, 0.0]]
    else:
        above, below, controller = [2.0, 1.0], [1.0, 3.0, 3.0, 1.0], "Kp + Ki/s + s/2"
        found = symobs.stability_region(plant("(2*s+1)/(s+1)^3"), controller=controller)
        lower, upper = [1.0, 0.0], [[0.5, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]
    seen = set()
    for kp, ki in product(np.linspace(-3.03, 9.07, 23), np.linspace(-2.01, 8.03, 21)):
        moved = np.convolve(above, np.asarray(upper).T @ [1.0, kp, ki])
        closed = np.convolve(below, lower)
        closed[len(closed) - len(moved) :] += moved
        roots = np.roots(closed)
        is_stable = bool(np.all(abs(roots) < 1)) if dt else bool(np.all(roots.real < 0))
        told = all(eval(each, {}, {"Kp": kp, "Ki": ki}) for each in found.stable_if)  # noqa: S307 - our own texts
        assert told == is_stable, (kp, ki)
        seen.add(is_stable)
    assert seen == {True, False}


def test_the_lead_may_vanish_where_the_loop_has_a_gain_at_infinity() -> None:
    found: Any = symobs.stability_region(plant("(s+2)/((s+1)*(s+3))"), controller="k*s", parameters="k")
    # (1 + k) s^2 + (4 + 2k) s + 3: both leads of one sign, so k > -1 (for k < -2 the last one is of the other sign)
    assert found.stable_if == ["k > -1"]


@pytest.mark.parametrize(
    ("asked", "match"),
    [
        ({"controller": "k", "K": "[k1 k2 k3]"}, "both controller and K"),
        ({"controller": "k*s^4"}, "not proper"),
        ({"controller": "k", "parameters": "q"}, "q does not occur"),
    ],
)
def test_what_is_no_loop_is_refused(asked: dict[str, Any], match: str) -> None:
    with pytest.raises(InputError, match=match):
        symobs.stability_region(plant("1/(s+1)^3"), **asked)


def test_a_polynomial_has_no_controller() -> None:
    with pytest.raises(InputError, match="both a polynomial and a controller"):
        symobs.stability_region("s^2 + k s + 1", controller="k")


def test_margins_take_a_pid_controller() -> None:
    found: Any = symobs.margins(plant("1/(s+1)^3"), controller="2 + 1/s + s")
    omega = np.geomspace(1e-3, 1e3, 400_001)
    loop = (2 + 1 / (1j * omega) + 1j * omega) / (1j * omega + 1) ** 3
    crossing = np.flatnonzero(np.diff(np.sign(abs(loop) - 1)))
    assert abs(float(found.phase_deg) - min(180 + np.degrees(np.angle(loop[crossing])))) < 1e-2
