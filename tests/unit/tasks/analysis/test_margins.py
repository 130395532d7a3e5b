"""Margins of designs as python-control finds them, what has none, and the peak of the sensitivity."""

from __future__ import annotations

import random
from typing import Any

import control  # type: ignore[import-untyped]
import numpy as np
import pytest

import symobs
from symobs import StateSpace
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import SERVO


@pytest.mark.parametrize("observer", ["full", "minimal"])
@pytest.mark.parametrize("dt", [0, 1])
def test_margins_of_compensators_are_those_of_python_control(observer: str, dt: int) -> None:
    chance, seen = random.Random(f"{observer} {dt}"), 0  # noqa: S311 - repeats
    while seen < 2:
        A = [[chance.randint(-3, 3) for _ in range(2)] for _ in range(2)]
        plant = StateSpace(A, [[1], [chance.randint(-2, 2)]], [[1, chance.randint(-2, 2)]], dt=dt)
        poles, others = (["1/2", "1/4"], ["1/5", "0"]) if dt else ([-1, -2], [-3, -4])
        asked: dict[str, Any] = {
            "control_poles": poles,
            "observer_poles": others[: 2 - (observer == "minimal")],
            "observer": observer,
        }
        design = symobs.compensator(plant, **asked)
        if design.verdict != "yes":
            continue
        seen += 1
        found = {name: float(value) for name, value in symobs.margins(design).items()}
        systems = design.to_control()
        loop = systems["compensator"] * systems["plant"]
        gain, phase, _, *_ = control.stability_margins(loop)
        low, high = found["gain_down"], found["gain_up"]
        if not dt:  # in discrete time python-control leaves out z = -1
            assert min(1 / low if low else np.inf, high) == pytest.approx(max(gain, 1 / gain), rel=1e-5)
        assert found["phase_deg"] == pytest.approx(abs(phase), abs=1e-4)
        at = np.exp(1j * np.linspace(1e-6, np.pi, 1_501)) if dt else 1j * np.logspace(-5, 5, 1_501)
        sensitivity = abs(1 / (1 + loop(at)))
        assert found["peak"] == pytest.approx(max(*sensitivity, 0.0 if dt else 1.0), rel=1e-2)
        assert found["peak"] * found["modulus"] == pytest.approx(1, abs=1e-6 * (1 + found["peak"]))
        assert found["slowest"] == (0.5 if dt else -1)


@pytest.mark.parametrize(
    ("design", "said"),
    [
        (lambda: symobs.observability(SERVO), "a state feedback, an observer or a compensator"),
        (lambda: symobs.state_feedback(SERVO, poles="-2, 1"), "the closed loop is not stable"),
        (lambda: symobs.observer(StateSpace("[0 1; 0 -1]", C="[1 0; 0 1]"), poles="-2, -3"), "one input or output"),
        (lambda: symobs.observer(StateSpace("[0 1; 0 -k]", C="[1 0]"), poles="-2, -3"), "loops with rational numbers"),
        (
            lambda: symobs.compensator(
                StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]", "[1]"),
                control_poles="-2, -2",
                observer_poles="-5",
                observer="minimal",
            ),
            "neither the plant nor the compensator is strictly proper",
        ),
    ],
)
def test_what_has_no_margins_is_refused(design: Any, said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.margins(design())


@pytest.mark.parametrize("name", ["closed", "opened"])
def test_no_margins_stand_without_their_loop(name: str) -> None:
    found = symobs.margins(StateSpace("[0 1; 0 0]", "[0; 1]", "[1 0]"), poles="-1, -2")
    with pytest.raises(CertificateRejected, match="without a loop"):
        found.with_answer(name, None)
