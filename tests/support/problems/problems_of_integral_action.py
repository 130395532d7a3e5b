"""The worked examples of integral action a second time, by hand.

Nothing in this file asks symobs for anything.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import sympy
from sympy import Matrix, Rational

from tests.support.problems.problems_by_hand import Hand, a, ackermann, b, characteristic, observability_matrix, s


@dataclass(frozen=True)
class Integral(Hand):
    """u = −K x + k_I ξ with ξ' = r − y, for plants without feedthrough."""

    @cached_property
    def extended(self) -> tuple[Any, Any]:
        """Return [A 0; −C 0] and [B; 0]."""
        A, B, C = self.A, self.B, self.C
        n, p = A.rows, C.rows
        wide = sympy.BlockMatrix([[A, sympy.zeros(n, p)], [-C, sympy.zeros(p, p)]]).as_explicit()
        return wide, B.col_join(sympy.zeros(p, B.cols))

    @property
    def decisive(self) -> Any:
        """det [A B; C D], which is what must not vanish where that is square and (A, B) is controllable elsewhere."""
        return self.whole.det()

    @cached_property
    def whole(self) -> Any:
        """[A B; C D]."""
        return sympy.BlockMatrix([[self.A, self.B], [self.C, self.feedthrough]]).as_explicit()

    @cached_property
    def gains(self) -> tuple[Any, Any]:
        """Return K and k_I."""
        A_hat, B_hat = self.extended
        both = ackermann(A_hat.T, B_hat.T, self.control, self.variable).T
        return both[:, : self.A.rows], -both[:, self.A.rows :]

    @cached_property
    def closed(self) -> Any:
        """Return [A − BK, B k_I; −C, 0]."""
        A_hat, B_hat = self.extended
        K, k_I = self.gains
        return A_hat - B_hat * K.row_join(-k_I)

    def letters(self) -> dict[str, Any]:
        """Return what the letters of the page must be worth."""
        A_hat, B_hat = self.extended
        known = {"A": self.A, "B": self.B, "C": self.C, "D": self.feedthrough, "phi_c": self.control}
        known |= {"A_hat": A_hat, "B_hat": B_hat, "x'": {"x": self.A, "u": self.B}, "y": {"x": self.C}}
        known["xi_I'"] = {"r_in": sympy.eye(self.C.rows), "x": -self.C}
        if observability_matrix(A_hat.T, B_hat.T).det() == 0:
            return known
        K, k_I = self.gains
        return known | {"K": K, "k_I": k_I, "A_cl": self.closed, "u": {"x": -K, "xi_I": k_I}}

    def answers(self, task: str) -> dict[str, Any]:
        """Return every field of the answer."""
        assert task == "integral_action"
        K, k_I = self.gains
        found = characteristic(self.closed, self.variable)
        lost = sympy.factor_list(self.decisive)[1]
        return {
            "K": K,
            "k_I": k_I,
            "solvable": self.whole.rank() == self.A.rows + self.C.rows,
            "solvable_if": tuple(f"{factor} != 0" for factor, _ in lost),
            "polynomial": found,
            "poles": found,
            "closed_loop_matrix": self.closed,
            "fixed_modes": (),
            "family": None,
        }


PROBLEMS_OF_INTEGRAL_ACTION = {
    "inverted_pendulum_integral_action": Integral(
        Matrix([[0, 1, 0, 0], [Rational(20601, 1000), 0, 0, 0], [0, 0, 0, 1], [Rational(-981, 2000), 0, 0, 0]]),
        Matrix([[0, 0, 1, 0]]),
        Matrix([0, -1, 0, Rational(1, 2)]),
        control=((s + 1) ** 2 + 3) * (s + 5) ** 3,
    ),
    "cruise_control_integral_action": Integral(
        Matrix([[a]]),
        Matrix([[1]]),
        Matrix([b]),
        control=s**2 + s + Rational(1, 4),
        signs={"a": "real", "b": "real"},
    ),
}
