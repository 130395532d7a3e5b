"""Encirclements against a fine count, crossovers and delay margins against their formulas in floating point."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import symobs


@pytest.mark.parametrize("seed", range(16))
def test_counts_and_delay_are_those_of_a_fine_grid(seed: int) -> None:
    rng = np.random.default_rng(seed)
    n, m = 2 + seed % 3, seed % 2
    p, q = [1, *map(int, rng.integers(-5, 9, n))], [int(rng.integers(1, 9)), *map(int, rng.integers(-5, 9, m))]
    found: Any = symobs.margins(symobs.StateSpace.from_transfer_function([q, p]), controller="1").fields
    if np.abs(np.roots(np.polyadd(p, q)).real).min() < 1e-9:
        assert found["encirclements"] is None  # the curve runs through −1
        return
    omega = np.concatenate([-np.geomspace(1e5, 1e-5, 200_000), np.geomspace(1e-5, 1e5, 200_000)])
    loop = np.polyval(q, 1j * omega) / np.polyval(p, 1j * omega)
    if np.abs(np.roots(p).real).min() > 1e-9 and len(np.roots(p)) == n:
        turned = np.unwrap(np.angle(1 + loop))
        assert found["encirclements"] == round((turned[-1] - turned[0]) / (2 * math.pi))
    assert found["open_loop_unstable"] == sum(np.roots(p).real > 1e-9)
    size = np.polysub(np.polymul(q, _mirrored(q)), np.polymul(p, _mirrored(p)))
    crossed = sorted(s.imag for s in np.roots(size) if abs(s.real) < 1e-9 and s.imag > 0)
    assert len(found["gain_crossover"]) == len(crossed)
    delays = []
    for w in crossed:
        phase = np.angle(-np.polyval(q, 1j * w) / np.polyval(p, 1j * w)) % (2 * math.pi)
        delays.append(phase / w)
    if delays:
        assert float(found["delay_margin"]) == pytest.approx(min(delays), abs=2e-6)
    else:
        assert found["delay_margin"] == "oo"


def _mirrored(polynomial: list[int]) -> list[int]:
    order = len(polynomial) - 1
    return [c * (-1) ** (order - k) for k, c in enumerate(polynomial)]


def test_a_loop_with_an_integrator_is_known() -> None:
    """Hold 10/(s(s + 1)(s + 2)): the axis is crossed at ω = √2 with −10/6, and the loop encircles −1 twice, clockwise."""
    plant = symobs.StateSpace.from_transfer_function("10/(s*(s+1)*(s+2))")
    found: Any = symobs.margins(plant, controller="1").fields
    assert [(str(c["omega"]), str(c["value"])) for c in found["axis_crossings"]] == [("sqrt(2)", "-5/3")]
    assert (found["open_loop_unstable"], found["closed_loop_unstable"], found["encirclements"]) == (0, 2, -2)


@pytest.mark.parametrize(
    ("controller", "said"),
    [
        # Ogata, Modern Control Engineering, 5th ed., Example 6-1: stable for k < 6, crossing at sqrt(2)
        ("2", "0 without feedback and 0 with it|meets the real axis at -0.333333 for the frequency 1.414214"),
        ("12", "0 without feedback and 2 with it|counterclockwise -2 times|meets the real axis at -2 for"),
        ("6", "others lie on the boundary of stability|meets the real axis at -1 for"),
    ],
)
def test_the_page_tells_the_numbers_of_the_criterion(controller: str, said: str) -> None:
    plant = symobs.StateSpace.from_transfer_function("1/(s*(s+1)*(s+2))")
    page = " ".join(str(symobs.margins(plant, controller=controller).to("text")).split())
    for words in said.split("|"):
        assert words in page
