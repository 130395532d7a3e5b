"""Exponentials whose roots have no closed form: sums over the roots of a polynomial, exact and against numbers."""

from __future__ import annotations

from typing import Any

import mpmath
import pytest
import sympy

import symobs
from symobs.exact import EIGENVALUE, Scalar
from symobs.exact.core.generators import derivative, substitute
from symobs.exact.time_functions.matrix_exponential import RootSum
from tests.kit import tabled

T = Scalar.symbol("t")
LAMBDA = Scalar.symbol(EIGENVALUE)
t = sympy.Symbol("t")


def numbers(matrix: Any, values: dict[str, Any], time: Any) -> mpmath.matrix:
    """Return a matrix of sums over roots at a time, the roots found by mpmath."""
    names = {sympy.Symbol(name): value for name, value in values.items()}
    return mpmath.matrix(
        [[mpmath.mpmathify(sympy.N(entry.subs(names).subs(t, time), 25)) for entry in row] for row in matrix.tolist()]
    )


def close(left: mpmath.matrix, right: mpmath.matrix) -> bool:
    return bool(mpmath.norm(left - right) < mpmath.mpf(10) ** -12)


@tabled
def test_the_exponential_is_that_of_the_numbers(A: str) -> None:
    result: Any = symobs.matrix_exponential(symobs.StateSpace(A))
    assert (result.verdict, result.conditions) == ("yes", ())
    found = numbers(result.matrix, {}, sympy.Rational(3, 4))
    assert close(found, mpmath.expm(mpmath.matrix(result.plant.A.tolist()) * mpmath.mpf(3) / 4))
    assert result.to("text")
    assert r"\sum_{" in result.to("fragment")


def test_a_cubic_with_letters_holds_where_no_two_roots_are_equal() -> None:
    """The condition is the discriminant of s³ + a s² + b s + c; on its zeros the case is left open."""
    result: Any = symobs.matrix_exponential(symobs.StateSpace("[0 1 0; 0 0 1; -c -b -a]"))
    a, b, c, x = sympy.symbols("a b c x")
    (condition,) = result.conditions
    assert sympy.expand(condition.lhs + sympy.discriminant(x**3 + a * x**2 + b * x + c, x)) == 0
    assert [case.result.verdict for case in result.cases] == ["undecided"]
    assert result.verdict == "conditional"
    values = {"a": sympy.Rational(1, 2), "b": 2, "c": 3}
    found = numbers(result.matrix, values, sympy.Rational(1, 2))
    A = mpmath.matrix([[0, 1, 0], [0, 0, 1], [-3, -2, -0.5]])
    assert close(found, mpmath.expm(A / 2))


def test_values_and_rates_of_the_sums() -> None:
    """Σ λʲ/q′(λ) is 0 for j < d − 1 and 1 for j = d − 1 (Euler); d/dt of the last sum follows from q(λ) = 0."""
    q = LAMBDA**3 + 2 * LAMBDA**2 + LAMBDA + 3
    sums = [RootSum.of(q, j, T) for j in range(3)]
    assert [substitute(value, {"t": Scalar.of(0)}) for value in sums] == [Scalar.of(k) for k in (0, 0, 1)]
    assert [derivative(value) for value in sums] == [sums[1], sums[2], -2 * sums[2] - sums[1] - 3 * sums[0]]


def test_two_equal_roots_have_no_such_sum() -> None:
    """At a = 0 the sum over the roots of λ³ + λ² + a loses its meaning: two of its roots meet."""
    value = RootSum.of(LAMBDA**3 + LAMBDA**2 + Scalar.symbol("a"), 0, T)
    with pytest.raises(ZeroDivisionError):
        substitute(value, {"a": Scalar.of(0)})
