"""Exponentials whose roots have no closed form: sums over the roots of a polynomial, exact and against numbers."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
import scipy.integrate  # type: ignore[import-untyped]
import scipy.linalg  # type: ignore[import-untyped]
import sympy

import symobs
from symobs.exact import EIGENVALUE, Scalar
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import derivative, substitute
from symobs.exact.sympy_bridge.conversion import scalar_to_sympy
from symobs.ground.errors import CertificateRejected
from tests.kit import tabled, tables

PLANTS = tables(Path(__file__))["test_the_exponential_is_that_of_the_numbers"]["rows"]
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


def test_a_sum_is_sympy_text() -> None:
    value = RootSum.of(LAMBDA**3 + LAMBDA + 1, 1, T)
    lam = sympy.Symbol("lam")
    assert scalar_to_sympy(value, {}) == sympy.RootSum(
        lam**3 + lam + 1, sympy.Lambda(lam, lam * sympy.exp(lam * t) / (3 * lam**2 + 1))
    )
    assert str(value) == "RootSum(lam**3 + lam + 1, Lambda(lam, lam*exp(t*lam)/(3*lam**2 + 1)))"


DECIMALS = "[-0.12 1.4 0.3 0; 0.77 -2.1 0.4 1.2; 0.21 0.5 -1.3 0.7; 0.1 0.3 -0.9 -0.55]"
CART = "[0 1 0 0; 0 -0.1818 2.6727 0; 0 0 0 1; 0 -0.4545 31.1818 0]"


@pytest.mark.parametrize("A", [*PLANTS, CART, DECIMALS])
def test_answers_at_a_time_have_sums_over_roots_and_certified_decimals(A: str) -> None:
    """Held against SciPy: A_d and B_d of a hold, both Gramians by C. Van Loan's exponential (1978), a response."""
    n = A.count(";") + 1
    plant = symobs.StateSpace(A, [0] * (n - 1) + [1], [1] + [0] * (n - 1))
    a, b, c = (np.array(part.tolist(), float) for part in (plant.A, plant.B, plant.C))
    held = symobs.zero_order_hold(plant, sampling_period="1/2")
    whole = scipy.linalg.expm(np.block([[a, b], [np.zeros((1, n + 1))]]) / 2)
    assert held.verdict == "yes"
    assert np.allclose(held.decimals["A"], whole[:n, :n], rtol=1e-9, atol=1e-12)
    assert np.allclose(held.decimals["B"], whole[:n, n:], rtol=1e-9, atol=1e-12)
    for of, f, h in (("observability", a, c), ("controllability", a.T, b.T)):
        found = symobs.gramian(plant, horizon="1", of=of)
        loan = scipy.linalg.expm(np.block([[-f.T, h.T @ h], [np.zeros((n, n)), f]]))
        assert found.verdict == "yes"
        assert np.allclose(found.decimals["matrix"], loan[n:, n:].T @ loan[:n, n:], rtol=1e-6, atol=1e-9)
        assert of == "controllability" or "RootSum" in str(found.matrix)
    moved = symobs.response(plant, input="t*exp(-t)")
    end = scipy.integrate.solve_ivp(
        lambda t, x: a @ x + b[:, 0] * t * np.exp(-t), (0, 0.5), np.zeros(n), rtol=1e-10, atol=1e-12
    ).y[:, -1]
    there = [complex(sympy.N(entry.subs(t, sympy.Rational(1, 2)), 20)).real for entry in moved.state]
    assert np.allclose(there, end, rtol=1e-6, atol=1e-8)


@pytest.mark.parametrize("A", [PLANTS[0], CART])
def test_pages_have_the_decimals_of_such_answers_and_the_sums_where_exact_ones_are_asked_for(A: str) -> None:
    n = A.count(";") + 1
    plant = symobs.StateSpace(A, [0] * (n - 1) + [1], [1] + [0] * (n - 1))
    held, gramian = symobs.zero_order_hold(plant, sampling_period="1/2"), symobs.gramian(plant, horizon="1")
    for found, value in ((held, held.decimals["A"][0][1]), (gramian, gramian.decimals["matrix"][0][1])):
        assert f"{value:#.5g}" in found.to("text")
        assert found.to("text", language="de")
    assert "exp(λ/2)" in held.to("text", exact=True)
    assert symobs.response(plant, input="1").to("text")


def test_a_wrong_sum_is_rejected() -> None:
    plant = symobs.StateSpace(PLANTS[0], "[0; 0; 1]", "[1 0 0]")
    for found, name, field in (
        (symobs.zero_order_hold(plant, sampling_period=1), "B_d", "B"),
        (symobs.gramian(plant, horizon=1), "matrix", "matrix"),
    ):
        with pytest.raises(CertificateRejected):
            found.with_answer(name, found.fields[field] * 2)
