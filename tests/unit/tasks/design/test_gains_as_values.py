"""Gains that no square roots write, and irrational data, where other tasks use them: against SciPy and python-control."""

from __future__ import annotations

import json
from typing import Any

import control  # type: ignore[import-untyped]
import numpy as np
import pytest
from scipy.linalg import solve_continuous_are, solve_discrete_are  # type: ignore[import-untyped]

import symobs
from symobs.problem.validation import validate

PLANTS = {
    "third": ("[0 1 0; 0 0 1; -1 -2 -3]", "[0; 0; 1]", "[1 0 0]", 0),
    "fourth": ("[0 1 0 0; 0 0 1 0; 0 0 0 1; 1 -2 3 -4]", "[0; 0; 1; 1]", "[1 0 1 0]", 0),
    "sampled": ("[0.9 0.1 0; 0 0.8 0.1; 0.1 0 0.7]", "[0; 0; 1]", "[1 0 0]", True),
}


def arrays(name: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    texts = (str(text) for text in PLANTS[name][:3])
    A, B, C = (np.array([[float(e) for e in row.split()] for row in text.strip("[]").split(";")]) for text in texts)
    return A, B, C


def best(name: str) -> tuple[np.ndarray, np.ndarray]:
    """K and L for unit weights and intensities by SciPy."""
    A, B, C = arrays(name)
    one, single = np.eye(len(A)), np.eye(1)
    if PLANTS[name][3]:
        P, S = solve_discrete_are(A, B, one, single), solve_discrete_are(A.T, C.T, one, single)
        K = np.linalg.solve(single + B.T @ P @ B, B.T @ P @ A)
        return K, np.linalg.solve(single + C @ S @ C.T, C @ S @ A.T).T
    return B.T @ solve_continuous_are(A, B, one, single), (C @ solve_continuous_are(A.T, C.T, one, single)).T


def numbers(matrix: Any) -> np.ndarray:
    return np.array(matrix.tolist(), dtype=float)


@pytest.mark.parametrize("name", PLANTS)
def test_the_tasks_of_a_file_go_on_with_the_gains_found(name: str) -> None:
    A, B, C, dt = PLANTS[name]
    tasks = ["lqr", "kalman", "compensator", "margins", "feedforward"]
    asked = dict.fromkeys(("Q", "R", "W", "V"), "1")
    problem = validate(
        {"title": name, "task": tasks, "plant": {"A": A, "B": B, "C": C, "dt": dt}, "specification": asked}
    )
    _, _, compensator, margins, feedforward = problem.solve()
    a, b, c = arrays(name)
    K, L = best(name)
    assert np.allclose(numbers(compensator.K), K)
    assert np.allclose(numbers(compensator.L), L)
    step = True if dt else 0
    law, plant = control.ss(a - b @ K - L @ c, L, K, 0, step), control.ss(a, b, c, 0, step)
    loop = np.sort_complex(np.linalg.eigvals(numbers(compensator.closed_loop_matrix)))
    assert np.allclose(loop, np.sort_complex(control.feedback(plant, law).poles()))
    angles = np.linspace(1e-4, np.pi, 50_000)
    boundary = np.exp(1j * angles) if dt else 1j * np.tan(angles / 2)
    distance = np.abs(1 + (law * plant)(boundary)).min()
    assert float(margins.modulus) == pytest.approx(distance, abs=1e-5)
    closed = a - b @ K if not dt else a - b @ K - np.eye(len(a))
    assert float(feedforward.F[0] if hasattr(feedforward.F, "shape") else feedforward.F) == pytest.approx(
        1 / (-c @ np.linalg.solve(closed, b))[0, 0]
    )
    assert "rounded to 15 significant digits" in margins.to("text")


def test_a_gain_of_digits_stands_wherever_a_gain_may() -> None:
    plant = symobs.StateSpace(*PLANTS["third"])
    K, L = best("third")
    law, estimate = symobs.lqr(plant, Q="1", R="1"), symobs.kalman(plant, W="1", V="1")
    assert np.allclose(numbers(law.K), K)
    assert np.allclose(law.evaluate({})["K"], K)
    assert str(K[0, 0])[:8] in law.to("numpy")
    assert "0.4142135" in repr(law)
    a, b, c = arrays("third")
    assert np.allclose(numbers(law.closed_loop_matrix), a - b @ K)
    assert np.allclose(numbers(estimate.A), a - L @ c)
    assert np.allclose(estimate.to_control()["observer"].A, a - L @ c)
    assert estimate.to("c", period="1/100")
    assert symobs.compensator(plant, K=law.K, observer_poles="-5, -6, -7").verdict == "yes"
    answer = json.loads(law.to_json())["results"][0]
    assert answer["K"] is None  # not exact
    assert float(answer["decimals"]["K"][0][0]) == pytest.approx(K[0, 0], abs=1e-14)


def test_margins_of_a_gain_with_roots() -> None:
    # K = [1 √2] of the double integrator: the loop is (√2 s + 1)/s²
    found = symobs.margins(symobs.StateSpace("[0 1; 0 0]", "[0; 1]"), K="[1 sqrt(2)]")
    _, phase, *_ = control.stability_margins(control.tf([2**0.5, 1], [1, 0, 0]))
    assert float(found.phase_deg) == pytest.approx(phase, abs=1e-5)
    assert "rounded to 15 significant digits" in found.to("text")


def test_a_sampled_plant_is_numeric_in_margins_and_regions() -> None:
    # 1/(s + 1) with T = 1/10: z − e^{−T} + 2 (1 − e^{−T}); stable for −1 < k < (1 + e^{−T})/(1 − e^{−T})
    held = symobs.zero_order_hold(symobs.StateSpace("[-1]", "[1]", "[1]"), sampling_period="0.1")
    decay = float(np.exp(-0.1))
    found = symobs.margins(held, controller="2")
    assert float(found.gain_up) == pytest.approx((1 + decay) / (1 - decay) / 2)
    (ends,) = json.loads(symobs.stability_region(held, K="[k]").to_json())["results"][0]["intervals_decimal"]
    assert [float(end) for end in ends] == pytest.approx([-1, (1 + decay) / (1 - decay)], abs=1e-4)


def test_a_discrete_regulator_in_decimals_has_its_digits() -> None:
    A, B = np.array([[1.02, 0.11], [0.35, 1.02]]), np.array([[0.006], [0.11]])
    P = solve_discrete_are(A, B, np.diag([10, 1]), [[0.1]])
    K = np.linalg.solve(0.1 + B.T @ P @ B, B.T @ P @ A)
    plant = symobs.StateSpace("[1.02 0.11; 0.35 1.02]", "[0.006; 0.11]", dt=True)
    assert np.allclose(numbers(symobs.lqr(plant, Q="[10 0; 0 1]", R="0.1").K), K)


@pytest.mark.parametrize("shared", [None, "[1/4; 1/3]"])
def test_the_filter_before_and_after_the_measurement(shared: str | None) -> None:
    A, C = np.array([[1, 0.1], [0, 0.9]]), np.array([[1.0, 0]])
    S = np.zeros((2, 1)) if shared is None else np.array([[1 / 4], [1 / 3]])
    P = solve_discrete_are(A.T, C.T, np.eye(2), np.eye(1), s=S)
    after = P @ C.T / (C @ P @ C.T + 1)
    found = symobs.kalman(symobs.StateSpace("[1 0.1; 0 0.9]", None, "[1 0]", dt=True), W="1", V="1", N=shared)
    assert np.allclose(numbers(found.L), (A @ P @ C.T + S) / (C @ P @ C.T + 1))
    assert np.allclose(np.array(found.decimals["P"], dtype=float), P)
    assert np.allclose(np.array(found.decimals["L_filter"], dtype=float), after)
    assert np.allclose(np.array(found.decimals["P_filter"], dtype=float), P - after @ C @ P)
    assert "before" in found.to("text") or found.answer["P"] is None


def test_correlated_noise_in_continuous_time() -> None:
    A, C = np.array([[0, 1], [0, -1.0]]), np.array([[1.0, 0]])
    P = solve_continuous_are(A.T, C.T, np.diag([0, 1.0]), np.eye(1), s=np.array([[0], [0.5]]))
    plant = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")
    found = symobs.kalman(plant, G="[0; 1]", W="1", V="1", N="1/2")
    assert np.allclose(numbers(found.L), P @ C.T + np.array([[0], [0.5]]))
    assert "correlated" in found.to("text")


def test_a_task_has_a_specification_of_its_own() -> None:
    problem = validate(
        {
            "title": "two designs",
            "tasks": ["observer", "reduced_order_observer"],
            "plant": {"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"},
            "specification": {"observer": {"poles": "-10, -10"}, "reduced_order_observer": {"poles": "-3"}},
        }
    )
    full, reduced = problem.solve()
    assert numbers(full.L).ravel().tolist() == [19, 81]  # s² + 20 s + 100 = s² + (l1 + 1) s + l1 + l2
    assert float(reduced.L[0]) == 2  # −1 − l = −3
