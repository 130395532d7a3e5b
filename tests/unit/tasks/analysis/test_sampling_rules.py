"""Sampling by Tustin's, the forward and the backward rule: against SciPy, python-control's convention, and by hand."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.signal import cont2discrete  # type: ignore[import-untyped]

import symobs
from symobs.ground.errors import InputError

RULES = {"forward": "euler", "backward": "backward_diff", "tustin": "bilinear"}


def numbers(matrix: Any) -> Any:
    """Return a matrix of exact numbers as floats."""
    rows, columns = matrix.shape
    return np.array([[float(matrix[i, j].fraction()) for j in range(columns)] for i in range(rows)])


@pytest.mark.parametrize("rule", RULES)
@pytest.mark.parametrize("seed", range(6))
def test_the_matrices_are_those_of_scipy(rule: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    n = 1 + seed % 4
    A, B, C = (rng.integers(-4, 5, shape) for shape in ((n, n), (n, 1 + seed % 2), (1 + seed % 3, n)))
    D = rng.integers(-2, 3, (C.shape[0], B.shape[1]))
    if abs(np.linalg.det(np.eye(n) - A / 8)) < 1e-9 or abs(np.linalg.det(np.eye(n) - A / 4)) < 1e-9:
        return
    plant = symobs.StateSpace(*(each.tolist() for each in (A, B, C, D)))
    found: Any = symobs.zero_order_hold(plant, rule=rule, sampling_period="1/4")
    expected = cont2discrete((A, B, C, D), 0.25, RULES[rule])
    for name, right in zip("ABCD", expected, strict=False):
        assert np.allclose(numbers(found.fields[name]), right, rtol=1e-12, atol=1e-12), name
    if rule == "forward":
        moved = np.linalg.eigvals(expected[0])
        assert (found.fields["stable_if"] == []) == bool(np.all(abs(moved) < 1))


@pytest.mark.parametrize(
    ("poles", "stable_if"),
    [
        ("[-2]", ["T < 1"]),  # |1 - 2T| < 1
        ("[0 1; -5 -2]", ["T < 2/5"]),  # |1 + T(-1 + 2i)|^2 = 1 - 2T + 5T^2
        ("[-1 0; 0 -10]", ["T < 1/5"]),  # the fastest pole decides
        ("[1]", ["False"]),
        ("[0 1; 0 -1]", ["False"]),  # a pole at 0 stays at 1
        ("[0 1; -1 0]", ["False"]),  # an undamped oscillation grows
    ],
)
def test_the_forward_rule_is_stable_for_small_periods(poles: str, stable_if: list[str]) -> None:
    order = 1 + poles.count(";")
    plant = symobs.StateSpace(poles, [[0]] * (order - 1) + [[1]], [[1] + [0] * (order - 1)])
    found: Any = symobs.zero_order_hold(plant, rule="forward", sampling_period="T")
    assert found.fields["stable_if"] == stable_if
    assert found.to("text")


@pytest.mark.parametrize("rule", RULES)
def test_a_sampled_plant_is_a_plant(rule: str) -> None:
    plant = symobs.StateSpace("[0 1; -2 -3]", "[0; 1]", "[1 0]")
    sampled: Any = symobs.zero_order_hold(plant, rule=rule, sampling_period="1/4")
    moved: Any = symobs.transfer_function(sampled)
    z = 0.4 + 1.1j
    s = {"forward": (z - 1) * 4, "backward": (z - 1) * 4 / z, "tustin": 8 * (z - 1) / (z + 1)}[rule]
    at = complex(moved.transfer_function.subs("z", z).evalf())
    assert abs(at - 1 / (s * s + 3 * s + 2)) < 1e-12


def test_a_pid_controller_has_the_coefficients_of_its_book() -> None:
    """Hold Tustin's PID: Kp + Ki T/2 (z + 1)/(z - 1) + (2 Kd/T)(z - 1)/(z + 1)."""
    plant = symobs.StateSpace.from_transfer_function("1/(s+1)")
    asked = {"rule": "tustin", "controller": "Kp + Ki/s + Kd*s", "sampling_period": "T"}
    found: Any = symobs.zero_order_hold(plant, **asked)
    at = {"Kp": 3, "Ki": 5, "Kd": 2, "T": 0.5, "z": 0.4 + 1.1j}
    z, T = at["z"], at["T"]
    expected = 3 + 5 * T / 2 * (z + 1) / (z - 1) + 2 * 2 / T * (z - 1) / (z + 1)
    assert abs(complex(found.transfer_function.subs(at).evalf()) - expected) < 1e-12


@pytest.mark.parametrize(
    ("asked", "match"),
    [
        ({"rule": "zoh"}, "no rule"),
        ({"controller": "1/s"}, "by a rule"),
        ({"rule": "forward", "controller": "2 + s"}, "not proper"),
        ({"rule": "backward", "sampling_period": "1/2"}, "divides by zero"),
        ({"rule": "tustin", "sampling_period": "1"}, "divides by zero"),
    ],
)
def test_what_is_refused(asked: dict[str, Any], match: str) -> None:
    with pytest.raises(InputError, match=match):
        symobs.zero_order_hold(symobs.StateSpace("[2]", "[1]", "[1]"), **asked)
