"""The worked examples of plants with disturbances a second time, by hand.

Nothing in this file asks symobs for anything.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import sympy
from sympy import Matrix

from tests.support.problems.problems_by_hand import (
    Hand,
    ackermann,
    characteristic,
    fixed,
    inverse,
    is_zero,
    observability_matrix,
    s,
)

if TYPE_CHECKING:
    from collections.abc import Mapping
    from typing import Self


@dataclass(frozen=True)
class Disturbed(Hand):
    """ẋ = A x + B u + E d without feedthrough, and the observer ż = F z + T B u + (L + F H) y, x̂ = z + H y."""

    E: Any = None

    def at(self, point: Mapping[Any, Any]) -> Self:
        """Return the problem at one point of its parameters."""
        return replace(super().at(point), E=self.E.subs(point))

    @property
    def decisive(self) -> Any:
        """Nothing: C E vanishes nowhere, or everywhere."""
        return sympy.Integer(1)

    @cached_property
    def H(self) -> Any:
        """E (CE)⁺, None where rank C E < rank E."""
        seen = self.C * self.E
        return self.E * inverse(seen.T * seen) * seen.T if seen.rank() == self.E.rank() else None

    def matrices(self) -> dict[str, Any]:
        """Return T, T A, F, and what multiplies y, where L places the poles."""
        T = sympy.eye(self.A.rows) - self.H * self.C
        F = T * self.A - self.L * self.C
        assert is_zero(characteristic(F, self.variable) - self.observer)
        found = {"T": T, "A_T": T * self.A, "F": F, "B_y": self.L + F * self.H}
        return {name: value.applyfunc(sympy.cancel) for name, value in found.items()}

    def letters(self) -> dict[str, Any]:
        """Return what the letters of the page must be worth."""
        rates = {"x": self.A, "d": self.E} | ({} if self.B is None else {"u": self.B})
        known = {"A": self.A, "C": self.C, "E_d": self.E, "phi_o": sympy.expand(self.observer), "x'": rates}
        known |= {"y": {"x": self.C}} | ({} if self.B is None else {"B": self.B, "D": self.feedthrough})
        if self.H is None:
            return known
        m, one = self.matrices(), sympy.eye(self.A.rows)
        known |= {"H_d": self.H, "T_d": m["T"], "A_T": m["A_T"], "F_d": m["F"], "L": self.L, "L_y": m["B_y"]}
        known["z_o'"] = {"z_o": m["F"], "x": m["B_y"] * self.C} | ({} if self.B is None else {"u": m["T"] * self.B})
        known["x_hat"] = {"z_o": one, "x": self.H * self.C}
        return known | {"e": {"x": m["T"], "z_o": -one}}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "unknown_input_observer"
        found: dict[str, Any] = dict.fromkeys(("H", "T", "L", "F", "B_u", "B_y"))
        found |= {"solvable": self.H is not None, "polynomial": sympy.expand(self.observer)}
        if self.H is None:
            return found
        m = self.matrices()
        zeros = sympy.roots(fixed(m["A_T"], self.C, self.variable), self.variable, multiple=True)
        found |= {"H": self.H, "L": self.L, "B_u": None if self.B is None else m["T"] * self.B}
        return found | {n: m[n] for n in ("T", "F", "B_y")} | {"poles": self.observer, "fixed_modes": tuple(zeros)}


@dataclass(frozen=True)
class Modelled(Hand):
    """ẋ = A x + B u + E d, d = V w, ẇ = S w for one output, without feedthrough."""

    E: Any = None
    S: Any = None

    def at(self, point: Mapping[Any, Any]) -> Self:
        """Return the problem at one point of its parameters."""
        return replace(super().at(point), E=self.E.subs(point), S=self.S.subs(point))

    @property
    def decisive(self) -> Any:
        """The determinant of the observability matrix of plant and exosystem."""
        A, C, _ = self.extended
        return observability_matrix(A, C).det()

    @cached_property
    def extended(self) -> tuple[Any, Any, Any]:
        """Return [A EV; 0 S], [C 0] and V."""
        V = sympy.eye(self.S.rows)[: self.E.cols, :]
        A = self.A.row_join(self.E * V).col_join(sympy.zeros(self.S.rows, self.A.rows).row_join(self.S))
        return A, self.C.row_join(sympy.zeros(self.C.rows, self.S.rows)), V

    @cached_property
    def gain(self) -> Any:
        """The gain of Ackermann's formula; None where plant and exosystem are not observable."""
        A, C, _ = self.extended
        return None if self.decisive == 0 else ackermann(A, C, self.observer, self.variable)

    def letters(self) -> dict[str, Any]:
        """Return what the letters of the page must be worth."""
        (A, C, V), n, order = self.extended, self.A.rows, self.S.rows
        known = {"A": self.A, "C": self.C, "E_d": self.E, "S_w": self.S, "V_w": V, "A_hat": A, "C_hat": C}
        known |= {"phi_o": sympy.expand(self.observer), "y": {"x": self.C}, "d": {"w_e": V}, "w_e'": {"w_e": self.S}}
        driven = {} if self.B is None else {"u": self.B}
        known["x'"] = {"x": self.A, "d": self.E} | driven
        if self.B is not None:
            known |= {"B": self.B, "D": self.feedthrough}
            known["B_hat"] = self.B.col_join(sympy.zeros(order, self.B.cols))
        if self.gain is None:
            return known
        L_x, L_w = self.gain[:n, :], self.gain[n:, :]
        known |= {"L": self.gain, "L_x": L_x, "L_w": L_w, "d_hat": {"w_hat": V}}
        known["x_hat'"] = {"x_hat": self.A - L_x * self.C, "w_hat": self.E * V, "x": L_x * self.C} | driven
        known["w_hat'"] = {"w_hat": self.S, "x_hat": -L_w * self.C, "x": L_w * self.C}
        known["e"] = {"x": sympy.eye(n), "x_hat": -sympy.eye(n)}
        return known | {"e_w": {"w_e": sympy.eye(order), "w_hat": -sympy.eye(order)}}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "disturbance_observer"
        A, C, _ = self.extended
        zeros = sympy.roots(fixed(A, C, self.variable), self.variable, multiple=True)
        found = dict.fromkeys(("L_x", "L_w", "A", "B_u", "B_y", "family")) | {"fixed_modes": tuple(zeros)}
        found |= {"polynomial": sympy.expand(self.observer), "poles": self.observer}
        if self.gain is None:
            return found
        n = self.A.rows
        driven = None if self.B is None else self.B.col_join(sympy.zeros(self.S.rows, self.B.cols))
        own = {"L_x": self.gain[:n, :], "L_w": self.gain[n:, :], "A": A - self.gain * C}
        return found | own | {"B_u": driven, "B_y": self.gain}


J, b, k, l, r, p = (sympy.Symbol(name) for name in "Jbklrp")
m, omega = sympy.symbols("m omega")

PROBLEMS_OF_DISTURBANCES = {
    "unknown_input_observer": Disturbed(
        Matrix([[-1, 1, 0], [-1, 0, 0], [0, -1, -1]]),
        Matrix([[1, 0, 0], [0, 0, 1]]),
        Matrix([0, 1, 0]),
        observer=(s + 2) * (s + 3) * (s + 4),
        L=Matrix([[2, 0], [0, -12], [0, 6]]),
        E=Matrix([-1, 0, 0]),
    ),
    "servo_load": Modelled(
        Matrix([[0, 1], [0, -b]]),
        Matrix([[1, 0]]),
        Matrix([0, 1]),
        observer=(s + 1) * (s + 2) * (s + 3),
        signs={"b": "positive"},
        E=Matrix([0, 1]),
        S=Matrix([[0]]),
    ),
    "sinusoidal_disturbance": Modelled(
        Matrix([[0, 1], [0, 0]]),
        Matrix([[1, 0]]),
        Matrix([0, 1]),
        observer=(s + 1) ** 4,
        signs={"omega": "real"},
        E=Matrix([0, 1]),
        S=Matrix([[0, omega], [-omega, 0]]),
    ),
    "disturbance_not_seen": Modelled(
        Matrix([[0, 1], [-2, -3]]),
        Matrix([[0, 1]]),
        observer=(s + 1) * (s + 2) * (s + 3),
        E=Matrix([0, 1]),
        S=Matrix([[0]]),
    ),
    "motor_unknown_load": Disturbed(
        Matrix([[-b / J, k / J], [-k / l, -r / l]]),
        Matrix([[1, 0]]),
        Matrix([0, 1 / l]),
        observer=(s + p) * (s + r / l),
        L=Matrix([p, 0]),
        signs=dict.fromkeys("Jbklrp", "positive"),
        E=Matrix([-1 / J, 0]),
    ),
    "unknown_input_not_decoupled": Disturbed(
        Matrix([[0, 1], [0, 0]]),
        Matrix([[1, 0]]),
        observer=(s + 1) * (s + 2),
        signs={"m": "positive"},
        E=Matrix([0, 1 / m]),
    ),
}
