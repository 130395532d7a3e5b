"""The worked examples with an observer of minimal order, or with several inputs and outputs, a second time, by hand.

Of gains that are not unique one is given, and all else follows from it.

Nothing in this file asks symobs for anything.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy
from sympy import Matrix, Rational

from tests.support.problems.problems_by_hand import (
    Hand,
    ackermann,
    canonical_transformation,
    cart,
    characteristic,
    d,
    hanging,
    inverse,
    observability_matrix,
    p,
    pendulum,
    response,
    return_path,
    s,
    servo,
    single,
    sylvester_letters,
    tanks,
    third_order,
)


def entries(stem: str, gain: Any) -> dict[str, Any]:
    return {f"{stem}_{k}": value for k, value in enumerate(gain, 1)}


@dataclass(frozen=True, kw_only=True)
class MinimalOrder(Hand):
    """An observer of order n − p in the coordinates T = [C; R], and with control poles the compensator with it.

    `observer` has degree n − p.  With `is_open` the page makes the estimate of z and of open matrices F, G, H.
    """

    R: Any
    is_open: bool = False

    @cached_property
    def T(self) -> Any:
        return self.C.col_join(self.R)

    @cached_property
    def blocks(self) -> dict[str, Any]:
        """Return the blocks of T A T⁻¹ and T B."""
        k, A = self.C.rows, self.T * self.A * self.T.inv()
        found = {"A_11": A[:k, :k], "A_12": A[:k, k:], "A_21": A[k:, :k], "A_22": A[k:, k:]}
        if self.B is not None:
            B = self.T * self.B
            found |= {"B_1": B[:k, :], "B_2": B[k:, :]}
        return found

    # -- the observer --------------------------------------------------------------------------------------------------

    @cached_property
    def observer_gain(self) -> Any:
        parts = self.blocks
        return ackermann(parts["A_22"], parts["A_12"], self.observer, self.variable) if self.L is None else self.L

    @cached_property
    def F(self) -> Any:
        return self.blocks["A_22"] - self.observer_gain * self.blocks["A_12"]

    @cached_property
    def H(self) -> Any:
        return self.F * self.observer_gain + self.blocks["A_21"] - self.observer_gain * self.blocks["A_11"]

    @cached_property
    def G(self) -> Any:
        """B₂ − L B₁, less what y − D u takes with it."""
        if self.B is None:
            return None
        return self.blocks["B_2"] - self.observer_gain * self.blocks["B_1"] - self.H * self.feedthrough

    @cached_property
    def M(self) -> Any:
        L = self.observer_gain
        lift = Matrix([[sympy.eye(L.cols), sympy.zeros(L.cols, L.rows)], [L, sympy.eye(L.rows)]])
        return self.T.inv() * lift

    # -- the compensator -----------------------------------------------------------------------------------------------

    @cached_property
    def parts_of_gain(self) -> tuple[Any, Any]:
        """Return K₁ and K₂."""
        moved = self.feedback_gain * self.T.inv()
        return moved[:, : self.C.rows], moved[:, self.C.rows :]

    @cached_property
    def N(self) -> Any:
        K_1, K_2 = self.parts_of_gain
        return K_1 + K_2 * self.observer_gain

    @cached_property
    def unsolved(self) -> Any:
        """I − N D, which the input is multiplied by in the control law."""
        return sympy.eye(self.B.cols) - self.N * self.feedthrough

    @cached_property
    def W(self) -> Any:
        return inverse(self.unsolved)

    @cached_property
    def compensator_matrix(self) -> Any:
        return self.F - self.G * self.W * self.parts_of_gain[1]

    @cached_property
    def compensator_input(self) -> Any:
        return self.H - self.G * self.W * self.N

    @cached_property
    def compensator(self) -> Any:
        state, direct = self.W * self.parts_of_gain[1], self.W * self.N
        return response(self.compensator_matrix, self.compensator_input, state, self.variable, direct)

    @cached_property
    def loop(self) -> Any:
        return return_path(self.plant_transfer, self.compensator)

    @cached_property
    def loop_matrix(self) -> Any:
        """(x, e₂), from u = −K x + K₂ e₂."""
        B, K, K_2 = self.B, self.feedback_gain, self.parts_of_gain[1]
        return Matrix([[self.A - B * K, B * K_2], [sympy.zeros(self.F.rows, self.A.rows), self.F]])

    @cached_property
    def loop_matrix_estimate(self) -> Any:
        """(x, z), from u = −N C x − K₂ z, put into ẋ = A x + B u and ż = F z + G u + H (C x + D u)."""
        A, B, C, D, K_2 = self.A, self.B, self.C, self.feedthrough, self.parts_of_gain[1]
        u_x, u_z, driven = -self.N * C, -K_2, self.G + self.H * D
        return Matrix([[A + B * u_x, B * u_z], [self.H * C + driven * u_x, self.F + driven * u_z]])

    @property
    def families(self) -> dict[str, Any] | None:
        """Return (A, B, polynomial) of each gain that is not unique, (A₂₂ᵀ, A₁₂ᵀ, φ) of L."""
        found = {"K": (self.A, self.B, self.control)} if self.B.cols > 1 else {}
        pair = (self.blocks["A_22"].T, self.blocks["A_12"].T, self.observer)
        return (found | ({"L": pair} if self.C.rows > 1 else {})) or None

    # -- what is compared ----------------------------------------------------------------------------------------------

    @property
    def decisive(self) -> Any:
        """What must not vanish."""
        found = super().decisive
        return found if self.control is None else found * self.unsolved.det()

    def letters(self) -> dict[str, Any]:
        """Return what the letters of a page must be worth."""
        A, B, C, R, L, parts = self.A, self.B, self.C, self.R, self.observer_gain, self.blocks
        one, size = sympy.eye(L.rows), L.cols
        known = {"A": A, "C": C, "D": self.feedthrough, "chi": characteristic(A, self.variable)}
        known |= {"O": observability_matrix(A, C), "R": R, "T": self.T, "L": L, "phi_o": self.observer, **parts}
        known |= {"F_z": self.F, "H_z": self.H, "M_z": self.M, "x_1": {"x": C}, "x_2": {"x": R}, **entries("l", L)}
        known |= {"e_2": {"x": R, "x_2_hat": -one}, "z_o": {"x_2_hat": one, "x": -L * C}}
        known["x_hat"] = {"x": self.M[:, :size] * C - self.M[:, size:] * L * C, "x_2_hat": self.M[:, size:]}
        # x̂₂' = A₂₁x₁ + A₂₂x̂₂ + B₂u + L(ẋ₁ − A₁₁x₁ − B₁u − A₁₂x̂₂), with ẋ₁ = C(Ax + Bu) and so ẋ₁ − B₁u = CAx
        known["x_2_hat'"] = {"x": parts["A_21"] * C + L * (C * A - parts["A_11"] * C), "x_2_hat": self.F}
        known |= {"x'": {"x": A}, "y": {"x": C}}
        if B is None:
            return known
        known |= {"B": B, "G_z": self.G, "x'": {"x": A, "u": B}, "P": self.plant_transfer}
        known["x_2_hat'"]["u"] = parts["B_2"]
        known["y"]["u"] = self.feedthrough
        if self.is_open:
            known |= self.letters_of_open_matrices()
        return known if self.control is None else known | self.letters_of_compensator()

    def letters_of_open_matrices(self) -> dict[str, Any]:
        """x̂₂ = z + L x₁ and ż = F z + G u + H y, the entries of F, G, H still letters; no feedthrough."""
        L, C, (first, second) = self.observer_gain, self.C, (slice(None, self.C.rows), slice(self.C.rows, None))
        one = sympy.eye(L.rows)
        known: dict[str, Any] = {"x_2_hat": {"z_o": one, "x": L * C}, "e_2": {"x": self.R - L * C, "z_o": -one}}
        known["z_o'"] = {"z_o": self.F, "u": self.G, "x": self.H * C}
        known["x_hat"] = {"x": self.M[:, first] * C, "z_o": self.M[:, second]}
        return known | entries("f", self.F) | entries("g", self.G) | entries("h", self.H)

    def letters_of_compensator(self) -> dict[str, Any]:
        K, (K_1, K_2), phi = self.feedback_gain, self.parts_of_gain, self.control
        known = {"K": K, "phi_c": phi, "Ctr": observability_matrix(self.A.T, self.B.T).T, "K_1": K_1, "K_2": K_2}
        known |= {"u": {"x": -K_1 * self.C, "x_2_hat": -K_2}, "K_y": self.N, "W_u": single(self.W)}
        known |= {"A_c": self.compensator_matrix, "B_c": self.compensator_input, "F": self.compensator}
        known |= {"A_cl": self.loop_matrix, "G_cl": self.loop, "G_r": self.unity_loop}
        if self.B.cols > 1:
            known |= sylvester_letters(self.A, self.B, K, phi, self.variable, "c")
        else:
            known["V_c"] = canonical_transformation(self.A, known["Ctr"], self.variable)
        return known

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of a task's answer by the textbook's formula."""
        if task == "reduced_order_observer":
            polynomial = characteristic(self.F, self.variable)
            own = {"L": self.observer_gain, "T": self.T, "F": self.F, "G": self.G, "H": self.H, "M": self.M}
            return own | {"polynomial": polynomial, "poles": polynomial, "fixed_modes": (), "family": None}
        assert task == "compensator"
        return {
            "K": self.feedback_gain,
            "L": self.observer_gain,
            "F": self.compensator,
            "T": self.T,
            "direct_term": self.W * self.N,
            "compensator_matrix": self.compensator_matrix,
            "closed_loop": self.loop,
            "closed_loop_unity": self.unity_loop,
            "closed_loop_polynomial": characteristic(self.loop_matrix, self.variable),
            "closed_loop_matrix": self.loop_matrix,
            "closed_loop_matrix_estimate": self.loop_matrix_estimate,
            "family": self.families,
        }


second_state, two_rest = Matrix([[0, 1]]), Matrix([[0, 1, 0], [0, 0, 1]])
two_masses = {
    "A": Matrix([[0, 1, 0, 0], [2, 0, 1, 0], [0, 0, 0, 1], [1, 0, -1, 0]]),
    "B": Matrix([[0, 0], [1, 0], [0, 0], [0, 1]]),
    "C": Matrix([[1, 0, 0, 0], [0, 0, 1, 0]]),
}

accelerometer = two_masses | {"C": Matrix([[1, 0, 0, 0], [1, 0, -1, 0]]), "D": Matrix([[0, 0], [0, 1]])}
feedback = {"control": (s + 1) * (s + 2) ** 2 * (s + 3), "K": Matrix([[8, 5, 0, 0], [1, 0, 1, 3]])}
rates = Matrix([[0, 1, 0, 0], [0, 0, 0, 1]])

PROBLEMS_OF_MINIMAL_ORDER = {
    "servo_minimal_order": MinimalOrder(**servo, R=second_state, control=(s + 2) ** 2, observer=s + 10),
    "servo_minimal_order_feedthrough": MinimalOrder(
        **servo,
        D=Matrix([[d]]),
        R=second_state,
        control=(s + 2) ** 2,
        observer=s + 10,
        signs={"d": "real"},
        shrunk=40,  # F is stable left of 1/31 and right of 13/40
    ),
    "third_order_minimal_observer": MinimalOrder(
        A=Matrix([[0, -1, 0], [1, 0, 1], [0, 0, 0]]), C=Matrix([[1, 0, 0]]), R=two_rest, observer=(s + 1) ** 2
    ),
    "sum_measured_minimal_observer": MinimalOrder(**third_order, R=two_rest, observer=(s + 5) * (s + 6)),
    "zeros_minimal_observer": MinimalOrder(**third_order, R=two_rest, observer=(s + 2) * (s + 3)),
    "tanks_minimal_observer": MinimalOrder(**tanks, R=Matrix([[1, 0]]), observer=s + Rational(1, 5)),
    "pendulum_minimal_observer": MinimalOrder(
        **hanging, R=Matrix([[1, 0]]), observer=s + p, signs=pendulum | {"p": "positive"}
    ),
    "scaled_output_minimal_observer": MinimalOrder(
        A=servo["A"], B=servo["B"], C=Matrix([[2, 0]]), R=second_state, observer=s + 10, is_open=True
    ),
    "cart_minimal_observer": MinimalOrder(
        **cart, C=Matrix([[1, 0, 0, 0]]), R=sympy.eye(4)[1:, :], observer=(s + 20) * ((s + 20) ** 2 + 400)
    ),
    "two_masses_minimal_order": MinimalOrder(
        **two_masses, **feedback, R=rates, observer=(s + 5) * (s + 6), L=Matrix([[5, 0], [0, 6]])
    ),
    "two_masses_minimal_order_feedthrough": MinimalOrder(
        **accelerometer, **feedback, R=rates, observer=(s + 5) * (s + 6), L=Matrix([[5, 0], [5, -6]])
    ),
}

#: Observers of full order for the same plants.
PROBLEMS_OF_SEVERAL = {
    "two_masses_output_feedback": Hand(
        **two_masses,
        **feedback,
        observer=(s + 5) ** 2 * (s + 6) ** 2,
        L=Matrix([[10, 0], [27, 1], [0, 12], [0, 35]]),
    ),
    "two_masses_feedthrough": Hand(
        **accelerometer,
        **feedback,
        observer=(s + 5) ** 2 * (s + 6) ** 2,
        L=Matrix([[11, 0], [33, 0], [11, -11], [30, -28]]),
    ),
}
