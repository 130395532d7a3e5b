"""What a steady-state Kalman filter claims: Riccati's equation of the dual regulator."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.algebra import matrix_at, multiply, transposed
from tests.support.claims.claims_of_lqr import riccati_holds

if TYPE_CHECKING:
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold L and P to Riccati's equation."""
    W, V, G = (matrix_at(result.weights[name], at.point) for name in "WVG")
    nothing = [[Fraction(0)] * len(at.C) for _ in at.A]
    noise = multiply(multiply(G, W), transposed(G))
    riccati_holds(result, at, (transposed(at.A), transposed(at.C), noise, V, nothing), "L")
