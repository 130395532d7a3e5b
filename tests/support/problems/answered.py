"""Problems that answers are checked against, and gains for them computed by SymPy alone."""

from __future__ import annotations

import random

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


def answers(count: int, seed: str = "a class") -> list[dict[str, str]]:
    """What a class hands in: a third all right, slips of the usual kinds, F from wrong gains, nonsense."""
    draw, made = random.Random(seed), []  # noqa: S311 - repeatable by design
    for number in range(count):
        gain, feedback = L.copy(), K.copy()
        match draw.randrange(9):
            case 0:
                gain = -gain
            case 1:
                gain[draw.randrange(3)] += draw.choice([-2, -1, 1, 3])
            case 2:
                feedback[draw.randrange(3)] += draw.choice([-1, 1])
            case 3:
                gain = sp.Matrix([draw.randrange(-50, 51) for _ in range(3)])
            case 4:
                feedback, gain = feedback * 2, gain / 2
            case _:
                pass
        follows = draw.random() < 0.7
        found = sp.cancel((feedback * (S * sp.eye(3) - A + B * feedback + gain * C).inv() * gain)[0]) if follows else F
        made.append({"student": f"s{number:03d}", "K": text(feedback), "L": text(gain), "F": str(found)})
    return made


def lines(answer: dict[str, str], number: int) -> str:
    """A derivation of twelve lines, with an error in some."""
    rank = "3" if number % 4 else "2"
    shift = "+ 1" if number % 3 == 0 else ""
    return "\n".join(
        [
            "C A = [1 1 3]",
            "C A^2 = [4 1 9]" if number % 5 else "C A^2 = [4 1 8]",
            f"rank([C; C*A; C*A^2]) = {rank}",
            f"det(s I - A) = {sp.expand(A.charpoly(S).as_expr())} {shift}",
            f"K = {answer['K']}",
            f"L = {answer['L']}",
            "det(s I - A + B K) = (s + 1)(s + 2)(s + 4)",
            "det(s I - A + L C) = (s + 5)(s + 6)(s + 7)",
            "A - B K = A - (B K)",
            "eigenvalues(A - B K) = [-1, -2, -4]",
            f"F = {answer['F']}",
            "det(s I - A + B K) = s^3 + 7 s^2 + 14 s + 8",
        ]
    )
