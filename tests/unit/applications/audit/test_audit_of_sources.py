"""The audit of the five sources: every erratum that concerns a value, a size or an equation, and no false alarm.

What is right, and why, was written down by hand from the list of errata; the audit has to say the same.
"""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

import pytest

from symobs.applications.audit import audit
from symobs.problem import read
from tests.support.tools.command_line import EXAMPLES

if TYPE_CHECKING:
    from symobs.applications.audit import Audited, Finding

PRINTED = [path for path in EXAMPLES if "[[printed]]" in path.read_text(encoding="utf-8")]

# Erratum → (right equations, one word of the reason for each).  An empty equation: nothing of these sizes is right.
MATHEMATICAL = {
    "E0.3": [("x_2' - A_22 x_2 = A_21 x_1 + B_2 u", "B_1 is printed for B_2")],
    "E0.4": [("z' = [-2 1; -1 0] (z - [2; 1] y) + [1; 0] y", "y' is printed for y")],
    "E0.5": [("z' = [-2 1; -1 0] z + [4; 2] y", "y' is printed for y")],
    "E1.1": [("size(M) = [n q]", "exchanged")],
    "E1.4": [("x_hat' = A x_hat + B u - M y + M C x_hat", "M C x_hat is missing")],
    "E1.5": [("eigenvalues(A' + C' M') = [-1 -2]", "A is printed for A'")],
    "E1.6": [
        ("T A T^-1 = [0 0; 1 0]", "entry (1, 2) is 0, not 1"),
        ("T A' T^-1 = [0 1; 0 0]", "A is printed for A'"),
        ("T A' T^-1 = [0 1; -alpha_2 -alpha_1]", "A is printed for A'"),
    ],
    "E1.9": [("M' = [gamma_2 gamma_1] T", "T^-1 is printed for T")],
    "E1.10": [("det(s I - A - M C) = s^2 + 3*s + 2", "coefficient of s is 3, not 1")],
    "E1.12": [("x_hat_2' = -2 x_hat_1 + u + 2 x_1", "index 2 is printed for 1")],
    "E1.13": [("x_hat' = [-3 1; -2 0] x_hat + [0; 1] u + [3; 2] y", "entries (2, 1) and (2, 2) are exchanged")],
    "E1.16": [("[A B*K; A+M*C -A-M*C] [I 0; I -I] = [A+B*K -B*K; 0 A+M*C]", "factor")],
    "E1.17": [("[x'; x_bar'] = [A+B*K -B*K; 0 A+M*C] [x; x_bar]", "x is printed for x_bar'")],
    "E2.1": [("x_2 = [theta; theta'; position']", "position'' is printed for position'")],
    "E2.2": [
        ("size(C) = [1 1]", "entry (1, 2) is 1, not 4"),
        ("y = C x_1", "sizes do not fit"),
        ("", "C is 1x1 and x_0 has 4 components"),
    ],
    "E2.4": [("L = [-1.644e+003; -1.699e+004; 6.000e+001]", "truncated")],
    "E2.5": [("F = [0 1 1.644e+003; 1.078e+001 0 1.699e+004; -9.8e-001 0 -6e+001]", "decimal point is 2 places off")],
    "E2.6": [("L = place(A_22', A_12' C, dp)'", "transpose")],
    "E2.8": [("(A_d - A + B K_d) x_d = 0", "K_2 is printed for K_d")],
    "E4.1": [("y - integral(C Phi(t, sigma) B u, sigma, t0, t) = C Phi(t, t0) x_0", "t1 is printed for t")],
    "E4.2": [
        ("W = integral(Phi(t0, sigma)^-1' C' C Phi(t0, sigma)^-1, sigma, t0, t1)", "W^-1 is printed for W"),
    ],
    "E4.4": [("A - H C = [0 -h1+1; -omega^2 -b-h2]", "entry (2, 1) is -omega^2, not omega^2: the sign is wrong")],
    "E4.6": [("[x'; e'] = [A+B*K -B*K; 0 A-H*C] [x; e]", "the rows x and e are too many")],
}
# Slips of notation and caveats that show as a wrong equation too.
OTHERS = {
    "E1.3": [("x_hat' = A x_hat + B u - M (y - C x_hat)", "x is printed for x_hat")],
    "E1.7": [("T A T^-1 = [0 0; 1 0]", "2x4"), ("T^-1 B = [1; 0]", "1x2")],
    "E1.8": [("k_1 = -3", "k_1 is -3, not 0"), ("B_1 = 0", "B_1 is 0, not 3")],
    "E1.11": [("M = [-3; -2]", "the left side is 2x1, the right side is 1x2")],
    "E1.15": [("u = K x_hat", "C is printed for K")],
    "E1.18": [("[x'; x_bar'] = [A+B*K -B*K; 0 A+M*C] [x; x_bar]", "x_hat is printed for x_bar")],
    "E2.7": [("K = [K_1 K_2]", "[K_1; K_2] is printed for [K_1 K_2]")],
    "E3.1": [("[1 -1 1] Psi^-1 = [431 -105 208]", "too few")],
    "E4.5": [("det(s I - A + H C) = s^2 + s (b + h2) + omega^2 (h1 - 1)", "lam is printed for s")],
}
EXPECTED = MATHEMATICAL | OTHERS


@cache
def audited() -> tuple[Audited, ...]:
    return tuple(audit(read(path.read_text(encoding="utf-8"))) for path in PRINTED)


def found(erratum: str) -> list[Finding]:
    return [each for one in audited() for each in one.findings if each.erratum == erratum]


@pytest.mark.slow
@pytest.mark.parametrize("erratum", EXPECTED)
def test_an_erratum_is_found_with_what_is_right_and_why(erratum: str) -> None:
    assert {each.right for each in found(erratum)} == {right for right, _ in EXPECTED[erratum]}
    for right, reason in EXPECTED[erratum]:
        assert [each for each in found(erratum) if each.right == right and reason in each.reason]


@pytest.mark.slow
def test_what_is_printed_right_is_not_reported() -> None:
    assert {each.erratum for one in audited() for each in one.findings} == set(EXPECTED)


def test_there_is_much_that_is_printed_right() -> None:
    wrong = sum(len(one.findings) for one in audited())
    assert wrong == sum(map(len, EXPECTED.values()))
    assert sum(one.checked for one in audited()) - wrong >= 100


def test_the_truncated_gain_is_told_entry_by_entry() -> None:
    (gain,), (matrix,) = found("E2.4"), found("E2.5")
    assert gain.reason.count("truncated") == 2  # -80539/49 = -1643.65..., -832340/49 = -16986.5...
    assert "entry (1, 1) is -1.644e+003, not -1.643e+003" in gain.reason
    assert "entry (3, 3) is -6e+001, not -600e+001" in matrix.reason


def test_the_last_equation_of_the_unit_mass_lacks_the_measurement() -> None:
    (equation,) = found("E1.13")
    assert "the term [3; 2] y is missing" in equation.reason
    assert "in the coefficient of u entry (1, 1) is 0, not 3" in equation.reason
