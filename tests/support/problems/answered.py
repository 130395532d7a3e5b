"""Problems that answers are checked against, and gains for them computed by SymPy alone."""

from __future__ import annotations

import sympy as sp

S = sp.Symbol("s")
A = sp.Matrix([[1, 2, 0], [0, -1, 3], [1, 0, 2]])
B = sp.Matrix([1, 0, 2])
C = sp.Matrix([[1, 1, 0]])
CONTROL, OBSERVER = (-1, -2, -4), (-5, -6, -7)

THIRD_ORDER = """
title = "A plant of order 3"
task = "compensator"
[plant]
A = "[1 2 0; 0 -1 3; 1 0 2]"
B = "[1; 0; 2]"
C = "[1 1 0]"
[specification]
control_poles = "-1, -2, -4"
observer_poles = "-5, -6, -7"
"""
SERVO = """
title = "A servo"
task = "compensator"
[plant]
A = "[0 1; 0 -1]"
B = "[0; 1]"
C = "[1 0]"
[specification]
control_poles = "-2, -2"
observer_poles = "-10, -10"
"""
TWO_OUTPUTS = """
title = "Two outputs"
task = "observer"
[plant]
A = "[0 1 0; 0 0 1; 1 2 3]"
C = "[1 0 0; 0 0 1]"
[specification]
poles = "-1, -1, -1"
"""


def polynomial(poles: tuple[object, ...]) -> sp.Poly:
    """The monic polynomial with these roots."""
    return sp.Poly(sp.prod([S - pole for pole in poles]), S)


def observer_gain(A: sp.Matrix, C: sp.Matrix, phi: sp.Poly) -> sp.Matrix:
    """Ackermann's formula: φ(A) 𝒪⁻¹ eₙ."""
    n = A.shape[0]
    seen = sp.Matrix.vstack(*[C * A**k for k in range(n)])
    value = sp.zeros(n, n)
    for coefficient in phi.all_coeffs():
        value = value * A + coefficient * sp.eye(n)
    return value * seen.inv() * sp.eye(n)[:, n - 1]


def feedback_gain(A: sp.Matrix, B: sp.Matrix, phi: sp.Poly) -> sp.Matrix:
    """The dual one."""
    return observer_gain(A.T, B.T, phi).T


def text(matrix: sp.Matrix) -> str:
    """A matrix as a student writes it."""
    return "[" + "; ".join(" ".join(str(entry) for entry in matrix.row(i)) for i in range(matrix.shape[0])) + "]"


K = feedback_gain(A, B, polynomial(CONTROL))
L = observer_gain(A, C, polynomial(OBSERVER))
F = sp.cancel((K * (S * sp.eye(3) - A + B * K + L * C).inv() * L)[0])
