"""The worked examples of tracking a second time, by hand.

Nothing in this file asks symobs for anything.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy
from sympy import Matrix, Rational

from tests.support.problems.problems_by_hand import cart, characteristic, mass, omega, s, servo
from tests.support.problems.problems_of_minimal_order import MinimalOrder, second_state

v = sympy.Symbol("v")


@dataclass(frozen=True, kw_only=True)
class Tracking(MinimalOrder):
    """u = K (x_d − x̂) − K_d x_d for ẋ_d = A_d x_d; `passed` is what one trajectory passes through."""

    reference: Any
    passed: Any = None
    row: Any = None

    @cached_property
    def K_d(self) -> Any:
        """B⁺ (A − A_d), None where that does not solve B K_d = A − A_d; 0 where A and A_d agree on the trajectory."""
        if self.passed is not None:
            assert (self.A - self.reference) * self.passed == sympy.zeros(*self.passed.shape)
            return sympy.zeros(self.B.cols, self.A.rows)
        found = (self.B.T * self.B).inv() * self.B.T * (self.A - self.reference)
        return found if self.B * found == self.A - self.reference else None

    @cached_property
    def errors(self) -> Any:
        """[A − BK, −BK₂; 0, F]."""
        B, K_2 = self.B, self.parts_of_gain[1]
        return Matrix([[self.A - B * self.feedback_gain, -B * K_2], [sympy.zeros(self.F.rows, self.A.rows), self.F]])

    def letters(self) -> dict[str, Any]:
        known = super().letters()
        one, (K_1, K_2) = sympy.eye(self.A.rows), self.parts_of_gain
        known |= {"A_ref": self.reference, "x_d'": {"x_d": self.reference}, "A_e": self.errors, "K_d": self.K_d}
        known |= {"e_d": {"x_d": one, "x": -one}, "V_d": self.passed, "w_d": self.row}
        known["x_d0"] = None if self.passed is None else self.passed[:, 0]
        if self.K_d is not None:
            known["u"] = {"x_d": self.feedback_gain - self.K_d, "x": -K_1 * self.C, "x_2_hat": -K_2}
        return {name: value for name, value in known.items() if value is not None}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "tracking"
        return {
            "K": self.feedback_gain,
            "L": self.observer_gain,
            "K_d": self.K_d,
            "solvable": self.K_d is not None,
            "error_matrix": self.errors,
            "polynomial": characteristic(self.errors, self.variable),
        }


wagon = {
    **cart,
    "C": Matrix([[1, 0, 0, 0]]),
    "R": sympy.eye(4)[1:, :],
    "control": (s + 1) * (s + 2) * (s + 3) * (s + 4),
    "observer": (s + 20) * ((s + 20) ** 2 + 400),
}


def reference(angle: Any, cart_speed: Any) -> Any:
    """ẍ_d and θ̈_d as multiples of θ_d."""
    return Matrix([[0, 0, 0, 1], [0, 0, 1, 0], [0, angle, 0, 0], [0, cart_speed, 0, 0]])


PROBLEMS_OF_TRACKING = {
    "servo_tracking": Tracking(
        **servo,
        R=second_state,
        control=(s + 2) ** 2,
        observer=s + 10,
        reference=Matrix([[0, 1], [-(omega**2), 0]]),
        signs={"omega": "positive"},
    ),
    "double_integrator_tracking": Tracking(
        **mass,
        R=second_state,
        control=(s + 2) ** 2,
        observer=s + 10,
        reference=Matrix([[0, 1], [-(omega**2), 0]]),
        signs={"omega": "positive"},
    ),
    "cart_tracking_angle": Tracking(**wagon, reference=reference(0, Rational(49, 5))),
    "cart_tracking": Tracking(
        **wagon,
        reference=Matrix(4, 4, lambda i, j: int((i, j) == (0, 3))),
        passed=Matrix([[0, v], [0, 0], [0, 0], [v, 0]]),
        signs={"v": "nonzero"},
    ),
    "cart_tracking_pendulum": Tracking(**wagon, reference=reference(Rational(49, 5), 0)),
    "cart_tracking_impossible": Tracking(
        **wagon, reference=reference(1, Rational(-49, 50)), row=Matrix([[0, 0, -1, -1]])
    ),
}
