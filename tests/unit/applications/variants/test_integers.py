"""Whole numbers held against SymPy."""

from __future__ import annotations

import random

import sympy as sp

from symobs.applications.variants import drawing as whole
from symobs.applications.variants.acceptance import controller

s = sp.Symbol("s")


def matrix(dice: random.Random, height: int, width: int) -> whole.Rows:
    return whole.rows_of((dice.randint(-4, 4) for _ in range(width)) for _ in range(height))


def poly(coefficients: whole.Poly) -> sp.Expr:
    return sp.expand(sum(c * s**k for k, c in enumerate(coefficients)))


def test_matrices_are_those_of_sympy() -> None:
    dice = random.Random(1)  # noqa: S311 - test matrices, no secrets
    for _ in range(15):
        order = dice.randint(1, 4)
        rows = matrix(dice, order, order)
        same = sp.Matrix(rows)
        found, determinant, chi = whole.adjugate(rows)
        assert sp.Matrix(found) == same.adjugate()
        assert determinant == whole.determinant(rows) == same.det()
        assert sp.expand(same.charpoly(s).as_expr() - poly(chi)) == 0
        assert whole.rank(rows) == same.rank()
        wide = matrix(dice, 2, 4)
        assert whole.rank(wide) == sp.Matrix(wide).rank()


def test_polynomials_are_those_of_sympy() -> None:
    dice = random.Random(2)  # noqa: S311 - test matrices, no secrets
    for _ in range(15):
        one, other, shared = ((*(dice.randint(-3, 3) for _ in range(n)), dice.choice((1, 2))) for n in (2, 1, 1))
        left, right = whole.multiplied(one, shared), whole.multiplied(other, shared)
        divisor = whole.common_divisor(left, right)
        expected = sp.Poly(sp.gcd(poly(left), poly(right)), s).primitive()[1]
        assert sp.Poly(poly(divisor), s) in (expected, -expected)
        assert sp.expand(poly(whole.quotient(left, divisor)) * poly(divisor) - poly(left)) == 0
        assert whole.resultant(one, other) == sp.resultant(poly(one), poly(other), s)


def test_compensators_are_those_of_sympy() -> None:
    dice = random.Random(3)  # noqa: S311 - test matrices, no secrets
    for _ in range(6):
        A, B, C, D = matrix(dice, 2, 2), matrix(dice, 2, 1), matrix(dice, 1, 2), matrix(dice, 1, 1)
        K, L = matrix(dice, 1, 2), matrix(dice, 2, 1)
        a, b, c, d, k, gain = (sp.Matrix(each) for each in (A, B, C, D, K, L))
        expected = (k * (s * sp.eye(2) - a + b * k + gain * c - gain * d * k).inv() * gain)[0, 0]
        top, bottom = controller({"A": A, "B": B, "C": C, "D": D}, K, L)
        assert sp.cancel(expected - poly(top) / poly(bottom)) == 0
        assert sp.Poly(poly(bottom), s).degree() == sp.Poly(sp.fraction(sp.cancel(expected))[1], s).degree() or not any(
            top
        )
