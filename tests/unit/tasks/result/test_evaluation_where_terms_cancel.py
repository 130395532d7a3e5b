"""Fields at points where terms cancel in double precision: the values of mpmath with 50 digits."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import mpmath as mp
import numpy as np
import pytest

import symobs

if TYPE_CHECKING:
    from collections.abc import Callable

S = symobs.StateSpace
MOTOR = S("[0 1; 0 -k]", "[0; 1]")
ONE = mp.mpf(1)


def held_position(k: Any, period: Any) -> Any:
    """(e^(−kT) − 1 + kT)/k², the first entry of the held input matrix of the motor."""
    return (mp.exp(-k * period) - 1 + k * period) / k**2


def optimal_gain(b: Any) -> Any:
    """(√(1 + b²) − 1)/b: the gain of x' = −x + b u and of its dual filter for weights 1."""
    return (mp.sqrt(1 + b * b) - 1) / b


#: The result, its field, the index of the entry, the parameter, its values, and the value by mpmath.
CASES: dict[str, tuple[Callable[[], Any], str, tuple[int, ...], str, list[str], Callable[[Any], Any]]] = {
    "motor held for 1/100": (
        lambda: symobs.zero_order_hold(MOTOR, sampling_period="1/100"),
        "B",
        (0, 0),
        "k",
        ["1e-4", "0.3", "1e-7", "1e-12"],
        lambda k: held_position(k, ONE / 100),
    ),
    "motor held for 1": (
        lambda: symobs.zero_order_hold(MOTOR, sampling_period="1"),
        "B",
        (0, 0),
        "k",
        ["1e-9", "2.5", "-1e-6", "1e-320", "1e300"],
        lambda k: held_position(k, ONE),
    ),
    "gramian": (
        lambda: symobs.gramian(S("[a]", None, "[1]"), horizon="1"),
        "matrix",
        (0, 0),
        "a",
        ["1e-9", "-1e-12", "0.7", "1e-300"],
        lambda a: mp.expm1(2 * a) / (2 * a),
    ),
    "lqr": (
        lambda: symobs.lqr(S("[-1]", "[b]"), Q="1", R="1"),
        "K",
        (0, 0),
        "b",
        ["1e-8", "-1e-11", "3.5"],
        optimal_gain,
    ),
    "kalman": (
        lambda: symobs.kalman(S("[-1]", None, "[c]"), W="1", V="1"),
        "L",
        (0, 0),
        "c",
        ["1e-8", "1e-11", "3.5"],
        optimal_gain,
    ),
    "minimum_energy_input": (
        lambda: symobs.minimum_energy_input(S("[a]", "[1]"), final="[1]", horizon="1"),
        "energy",
        (),
        "a",
        ["1e-9", "-1e-12", "0.7"],
        lambda a: 2 * a / mp.expm1(2 * a),
    ),
    "lyapunov in steps": (
        lambda: symobs.lyapunov(S("[a]", dt=True), Q="1"),
        "P",
        (0, 0),
        "a",
        ["0.99999999999999", "0.5"],
        lambda a: 1 / (1 - a * a),
    ),
    "lyapunov in steps, a double eigenvalue": (
        lambda: symobs.lyapunov(S("[a 1; 0 a]", dt=True), Q="1"),
        "P",
        (1, 1),
        "a",
        ["0.999999", "0.9999999", "-0.99999", "0.5"],
        lambda a: (1 + a * a) / (1 - a * a) ** 3 + 1 / (1 - a * a),
    ),
    "a sum with many terms": (
        lambda: symobs.lyapunov(S("[a 1; 0 -1]"), Q="1"),
        "P",
        (1, 1),
        "a",
        ["-0.3", "-1e-9"],
        lambda a: (1 + 2 * (-1 / (2 * a)) / (1 - a)) / 2,
    ),
}


@pytest.mark.parametrize("name", CASES)
def test_no_digits_are_lost(name: str) -> None:
    result, field, index, parameter, values, expected = CASES[name]
    found = result().evaluate({parameter: np.array([float(value) for value in values])})[field]
    with mp.workdps(700):
        numbers = [float(expected(mp.mpf(value))) for value in values]
    np.testing.assert_allclose(found[(slice(None), *index)], numbers, rtol=2e-11)


def test_a_grid_has_the_digits_of_its_points() -> None:
    """Most points are certain at once, those beside 0 are not: together they are one smooth curve."""
    k = np.linspace(-0.01, 0.01, 2000)
    found = symobs.zero_order_hold(MOTOR, sampling_period="1").evaluate({"k": k})["B"][:, 0, 0]
    with mp.workdps(50):
        numbers = [float(held_position(mp.mpf(repr(float(value))), ONE)) for value in k]
    np.testing.assert_allclose(found, numbers, rtol=2e-11)


def test_values_beyond_all_doubles_are_infinite_as_before() -> None:
    found = symobs.lyapunov(S("[-a]"), Q="1").evaluate({"a": [1e-308, 1e-320, 1.0]})["P"]
    np.testing.assert_allclose(found.reshape(-1), [5e307, np.inf, 0.5])
