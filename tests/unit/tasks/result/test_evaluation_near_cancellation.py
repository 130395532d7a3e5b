"""Arrays of values where terms cancel, against mpmath with 50 digits."""

from __future__ import annotations

from typing import Any

import mpmath
import numpy as np
import pytest

import symobs

mpmath.mp.dps = 50


@pytest.mark.parametrize(("k", "T"), [("1e-4", "0.01"), ("1e-9", "1"), ("0.5", "2")])
def test_a_held_motor_keeps_its_digits(k: str, T: str) -> None:
    """B = [(kT − 1 + e^{−kT})/k²; (1 − e^{−kT})/k] of ẋ = [0 1; 0 −k] x + [0; 1] u."""
    plant = symobs.StateSpace("[0 1; 0 -k]", "[0; 1]", symbols={"k": "positive", "T": "positive"})
    held = symobs.zero_order_hold(plant, sampling_period="T")
    rate, period = mpmath.mpf(k), mpmath.mpf(T)
    decay = mpmath.exp(-rate * period)
    wanted = [(rate * period - 1 + decay) / rate**2, (1 - decay) / rate]
    found = held.evaluate({"k": float(k), "T": float(T)})["B"]
    assert found.ravel() == pytest.approx([float(value) for value in wanted], rel=1e-8)


def test_a_gramian_near_a_plant_at_rest_keeps_its_digits() -> None:
    rates = ["1e-12", "1e-7", "0.5"]
    found = symobs.gramian(symobs.StateSpace("[a]", None, "[1]", symbols={"a": "real"}), horizon="1")
    wanted = [float(mpmath.expm1(2 * mpmath.mpf(a)) / (2 * mpmath.mpf(a))) for a in rates]
    values: Any = found.evaluate({"a": np.array([float(a) for a in rates])})["matrix"]
    assert values.ravel() == pytest.approx(wanted, rel=1e-8)


def test_an_optimal_gain_of_a_small_input_is_not_0() -> None:
    """K = (√(1 + b²) − 1)/b of ẋ = −x + b u with Q = R = 1."""
    small = mpmath.mpf("1e-8")
    law = symobs.lqr(symobs.StateSpace("[-1]", "[b]", symbols={"b": "positive"}), Q="1", R="1")
    wanted = float((mpmath.sqrt(1 + small**2) - 1) / small)
    assert law.evaluate({"b": 1e-8})["K"].ravel() == pytest.approx([wanted], rel=1e-8)
