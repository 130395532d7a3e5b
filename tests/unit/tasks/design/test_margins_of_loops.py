"""Margins as a task: loops of designs and controllers against roots and minima in floating point."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scipy.optimize import minimize_scalar  # type: ignore[import-untyped]

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError
from tests.kit import SERVO
from tests.support.algebra import seeded
from tests.support.sampling import seeds


def drawn(seed: int) -> tuple[Any, Any, Any, bool]:
    """Return P + N and P in floating point of a random loop, its margins, and whether time is discrete."""
    draw = seeded(seed)
    n, discrete = draw.randint(1, 3), draw.random() < 0.4

    def matrix(rows: int, columns: int) -> list[list[Any]]:
        size = 4 if discrete else 1
        return [[f"{draw.randint(-3, 3)}/{size}" for _ in range(columns)] for _ in range(rows)]

    A, B, C = matrix(n, n), matrix(n, 1), matrix(1, n)
    plant, s = StateSpace(A, B, C, dt=int(discrete)), "z" if discrete else "s"
    above = f"{draw.randint(-4, 4)}*{s} + {draw.randint(1, 9)}"
    below = f"{s} + {draw.randint(-1, 6)}{'/8' if discrete else ''}"
    result = symobs.margins(plant, controller=f"({above})/({below})")
    matrices = [np.array([[eval_fraction(entry) for entry in row] for row in part]) for part in (A, B, C)]
    characteristic = np.poly(matrices[0])
    numerator = np.poly(matrices[0] - matrices[1] @ matrices[2]) - characteristic
    over, under = (np.array([float(c) for c in _linear(text)]) for text in (above, below))
    opened = np.polymul(characteristic, under)
    return np.polyadd(opened, np.polymul(numerator, over)), opened, result, discrete


def eval_fraction(text: str) -> float:
    above, _, below = text.partition("/")
    return float(above) / float(below or 1)


def _linear(text: str) -> tuple[float, float]:
    head, _, tail = text.partition(" + ")
    return (eval_fraction(head.partition("*")[0]) if "*" in head else 1.0), eval_fraction(tail)


@pytest.mark.parametrize("seed", seeds(6))
def test_margins_are_those_on_the_boundary(seed: int) -> None:
    """Hold verdict, gains, distance and angle to roots and minima on the boundary."""
    closed, opened, found, discrete = drawn(seed)

    def edge(polynomial: Any) -> float:
        roots = np.roots(polynomial)
        return float(max(abs(roots) - 1)) if discrete else float(max(roots.real))

    worst = edge(closed)
    if abs(worst) < 1e-5:
        return
    assert found.verdict == ("yes" if worst < 0 else "no")
    assert float(found.slowest) == pytest.approx(worst + discrete, abs=1e-4)
    if found.verdict == "no":
        assert found.gain_up is None
        return
    low, high = float(found.gain_down), float(found.gain_up)
    for k in np.linspace(low, min(high, 40.0), 23)[1:-1]:
        assert edge(opened + k * (closed - opened)) < 1e-6
    for end, outwards in ((low, 1 - 1e-3), (high, 1 + 1e-3)):
        if 0 < end < np.inf:
            assert edge(opened + end * outwards * (closed - opened)) > -1e-7
    places = np.linspace(0, np.pi, 4001) if discrete else np.logspace(-4, 4, 8001)

    def apart(w: float) -> float:
        s = np.exp(1j * w) if discrete else 1j * w
        return float(abs(np.polyval(closed, s) / np.polyval(opened, s)))

    values = [apart(w) for w in places]
    at = int(np.argmin(values))
    bounds = places[max(at - 1, 0)], places[min(at + 1, len(places) - 1)]
    best = min(values[at], minimize_scalar(apart, bounds=bounds, method="bounded", options={"xatol": 1e-12}).fun)
    best = best if discrete else min(best, 1.0)
    assert float(found.modulus) == pytest.approx(best, abs=1e-4)
    assert float(found.peak) == pytest.approx(1 / best, rel=1e-4, abs=1e-5)
    if found.fields["phase_deg"] != "oo":
        turn = np.exp(1j * np.radians(float(found.phase_deg)))
        s = np.exp(1j * places) if discrete else 1j * places
        loop = np.polyval(closed, s) / np.polyval(opened, s) - 1
        near = min(np.min(abs(1 + loop * turn)), np.min(abs(1 + loop / turn)))
        assert near < 0.05  # the turned loop meets -1


def test_the_task_finds_what_the_function_does() -> None:
    for design, asked in (
        (symobs.state_feedback(SERVO, poles="-2, -3"), {"poles": "-2, -3"}),
        (symobs.observer(SERVO, poles="-2, -3"), {"observer_poles": "-2, -3"}),
        (
            symobs.compensator(SERVO, control_poles="-1, -2", observer_poles="-3", observer="minimal"),
            {"control_poles": "-1, -2", "observer_poles": "-3", "observer": "minimal"},
        ),
    ):
        found: Any = symobs.margins(SERVO, **asked)
        known = symobs.margins(design)
        assert {name: getattr(found, name) for name in known} == dict(known)
        assert found.verdict == "yes"


def test_what_is_no_single_loop_of_numbers_is_told() -> None:
    assert symobs.margins(SERVO, poles="-2, 1").verdict == "no"
    found: Any = symobs.margins(StateSpace("[0 1; 0 -b]", "[0; 1]", "[1 0]"), poles="-2, -3")
    assert found.verdict == "undecided"
    assert "The margins are not found here" in found.to("text")
    assert symobs.margins(StateSpace("[1 0; 0 2]", "[1; 0]"), poles="-2, -3").verdict == "no"  # unassignable
    with pytest.raises(InputError, match="nothing says which loop"):
        symobs.margins(SERVO, observer="full")
    with pytest.raises(InputError, match="gain at infinity"):
        symobs.margins(StateSpace("[0]", "[1]", "[1]", "[1]"), controller="2")
    with pytest.raises(InputError, match="one input and one output"):
        symobs.margins(StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0; 0 1]"), controller="2")
    with pytest.raises(InputError, match="controller"):
        symobs.margins(SERVO, controller="2", poles="-1, -2")


def test_margins_have_values_a_page_with_any_observer_and_answers_in_digits() -> None:
    plant = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]", symbols={"k": "positive"})
    there: Any = symobs.margins(plant, K="[k 1]")
    assert there.at(k=2).gain_down == 0  # 1 + g (2 + s)/(s (s + 1)) has no roots on the right for g > 0
    minimal: Any = symobs.margins(plant, control_poles="-1, -2", observer_poles="-3", observer="minimal")
    assert "Margins" in minimal.to("text")
    problem = 'task = "margins"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\n[specification]\nK = "[1 1]"\n'
    angle = float(there.at(k=1).phase_deg)
    for answer, verdict in ((f"{angle:.3f}", "right"), (f"{angle + 1:.3f}", "wrong")):
        report = symobs.check(problem, {"gain_down": "0", "gain_up": "oo", "phase_deg": answer})
        assert [part.verdict for part in report.parts if part.letter == "phase_deg"] == [verdict]
