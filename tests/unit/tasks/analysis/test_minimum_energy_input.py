"""Inputs of minimum energy against SciPy: least squares in discrete time, the numerical Gramian in continuous time."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy
from scipy.linalg import expm  # type: ignore[import-untyped]

import symobs
from symobs.ground.errors import InputError
from tests.kit import tabled
from tests.support.algebra import seeded
from tests.support.sampling import seeds


def text(rows: list[list[int]]) -> str:
    return "[" + "; ".join(" ".join(map(str, row)) for row in rows) + "]"


@pytest.mark.parametrize("seed", seeds(4))
def test_inputs_steer_and_spend_no_more_than_needed(seed: int) -> None:
    draw = seeded(seed)
    n, m, dt, end = draw.randint(1, 3), draw.randint(1, 2), draw.choice([0, 1]), draw.randint(1, 3)
    A = [[draw.randint(-1, 1) if j > i else draw.choice([-1, 0, 1, -2]) * (i == j) for j in range(n)] for i in range(n)]
    B = [[draw.choice([0, 0, 1, -1, 2]) for _ in range(m)] for _ in range(n)]
    start, final = ([draw.randint(-2, 2) for _ in range(n)] for _ in range(2))
    plant = symobs.StateSpace(text(A), text(B), dt=dt)
    states = {"initial": text([[v] for v in start]), "final": text([[v] for v in final])}
    result: Any = symobs.minimum_energy_input(plant, **states, horizon=end)
    M, N = np.array(A, float), np.array(B, float)
    powers = [np.linalg.matrix_power(M, k) for k in range(max(n, end) + 1)]
    moved = (powers[end] if dt else expm(M * end)) @ np.array(start, float)
    reach = np.hstack([powers[k] @ N for k in range(min(n, end) if dt else n)])
    d = np.array(final, float) - moved
    possible = np.linalg.norm(reach @ np.linalg.lstsq(reach, d, rcond=1e-10)[0] - d) < 1e-8 * (1 + np.linalg.norm(d))
    assert (result.verdict == "yes") == possible, (A, B, states, end, dt)
    if not possible:
        w = np.array([float(entry) for entry in result.unreachable])
        assert np.allclose(w @ reach, 0)
        assert abs(w @ d) > 1e-9
        return
    if dt:
        whole = np.hstack([powers[end - 1 - k] @ N for k in range(end)])
        best = np.linalg.lstsq(whole, d, rcond=1e-10)[0].reshape(end, m)
        found = result.input.T.tolist() if isinstance(result.input, sympy.MatrixBase) else [*result.input]
        assert np.allclose(np.array(found, dtype=float).flatten(), best.flatten(), atol=1e-8)
        assert abs(float(result.energy) - (best**2).sum()) < 1e-8
        return
    t = sympy.Symbol("t")
    given = result.input if isinstance(result.input, tuple) else (result.input,)
    nodes, weights = np.polynomial.legendre.leggauss(30)
    times = (nodes + 1) * end / 2
    values = [np.array([float(entry.subs(t, time)) for entry in given]) for time in times]
    reached = sum(
        w * end / 2 * expm(M * (end - time)) @ N @ v for w, time, v in zip(weights, times, values, strict=True)
    )
    assert np.allclose(reached, d, atol=1e-7 * (1 + abs(d).max()))
    energy = sum(w * end / 2 * float(v @ v) for w, v in zip(weights, values, strict=True))
    assert abs(energy - float(result.energy)) < 1e-7 * (1 + energy)
    gramian = sum(
        w * end / 2 * expm(M * time) @ N @ N.T @ expm(M * time).T for w, time in zip(weights, times, strict=True)
    )
    least = d @ np.linalg.lstsq(gramian, d, rcond=1e-11)[0]
    assert abs(energy - least) < 1e-5 * (1 + energy)


def test_a_parameter_says_where_the_state_is_not_reached() -> None:
    result: Any = symobs.minimum_energy_input(symobs.StateSpace("[0 1; 0 0]", "[0; b]"), final="[1; 0]", horizon=1)
    assert [str(condition) for condition in result.conditions] == ["Ne(b, 0)"]
    (case,) = result.cases
    assert (str(case.when[0]), case.result.verdict) == ("Eq(b, 0)", "no")
    hidden: Any = symobs.minimum_energy_input(symobs.StateSpace("[0 0; 0 1]", "[1; 0]"), final="[1; f]", horizon=1)
    (case,) = hidden.cases
    assert (hidden.verdict, str(case.when[0]), case.result.input) == ("no", "Eq(f, 0)", 1)


def test_two_states_and_a_finite_horizon_are_needed() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", "[0; 1]")
    with pytest.raises(InputError, match="neither an initial nor a final state"):
        symobs.minimum_energy_input(plant)
    with pytest.raises(InputError, match="at a finite time"):
        symobs.minimum_energy_input(plant, final="[1; 0]", horizon="inf")


@tabled
def test_exponentials_far_from_each_other_meet_at_the_end_of_the_horizon(rate: tuple[int, int]) -> None:
    """The exponents of e^{AT} e^{T} cancel those of e^{−A(T−t)} at t = T only in a base of both."""
    r, T = sympy.Rational(*rate), sympy.Symbol("T", positive=True)
    result: Any = symobs.minimum_energy_input(symobs.StateSpace([[r, 0], [0, 1]], [[1], [1]]), final=[1, 0])
    rates = (r, 1)
    W = sympy.Matrix(2, 2, lambda i, j: (sympy.exp((rates[i] + rates[j]) * T) - 1) / (rates[i] + rates[j]))
    at = {T: sympy.Rational(1, 20)}
    expected = (W.subs(at).evalf(60)).inv()[0, 0]
    assert abs(result.energy.xreplace({sympy.Symbol("T"): at[T]}).evalf(60) / expected - 1) < 1e-30
    result.derivation.check()


def test_what_is_a_sum_over_roots_is_undecided_with_its_reason() -> None:
    """λ³ − λ − 1 is irreducible: e^{AT} has no closed form, and the Gramian is a sum over its roots."""
    result: Any = symobs.minimum_energy_input(
        symobs.StateSpace("[0 1 0; 0 0 1; 1 1 0]", "[0; 0; 1]"), final=[1, 0, 0], horizon=1
    )
    assert (result.verdict, result.input) == ("undecided", None)
    assert "sums over roots" in result.question
    assert "too long" in str(result.to("text"))
