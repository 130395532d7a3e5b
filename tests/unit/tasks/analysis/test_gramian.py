"""Gramians: over fewer steps than states rank and kernel are those of the sum; cases do not contradict each other."""

from __future__ import annotations

import random

import pytest
import sympy

import symobs


def total(A: sympy.Matrix, C: sympy.Matrix, steps: int) -> sympy.Matrix:
    """The sum Σ (Aᵀ)ᵏ Cᵀ C Aᵏ, k < steps, by SymPy."""
    return sum(((C * A**k).T * (C * A**k) for k in range(steps)), sympy.zeros(*A.shape))


@pytest.mark.parametrize("seed", range(8))
def test_rank_and_kernel_are_those_of_the_sum(seed: int) -> None:
    draw = random.Random(seed)  # noqa: S311
    order, rows = draw.choice([2, 3]), draw.choice([1, 1, 2])
    b = sympy.Symbol("b")
    entries = [-1, 0, 0, 1, 2, b] if seed % 2 else [-1, 0, 0, 1, 2]
    A = sympy.Matrix(order, order, lambda *_: draw.choice(entries))
    C = sympy.Matrix(rows, order, lambda *_: draw.choice(entries))
    plant = symobs.StateSpace(A, C=C, dt=True)
    for steps in range(1, order + 2):
        found = symobs.gramian(plant, horizon=steps)
        assert sympy.simplify(found.matrix - total(A, C, steps)) == sympy.zeros(order)
        for value in (None, -1, 0, 1, sympy.Rational(1, 2), 3) if b in (A.free_symbols | C.free_symbols) else (None,):
            there = found if value is None else found.at(b=value)
            W = there.matrix
            assert there.rank == W.rank()
            assert len(there.kernel) == order - there.rank
            assert all(sympy.simplify(W * sympy.Matrix(v)) == sympy.zeros(order, 1) for v in there.kernel)
        assert "Gramian" in found.to("text")


@pytest.mark.parametrize(
    ("A", "C", "verdict"),
    [
        ("[cos(th) sin(th); -sin(th) cos(th)]", "[1 0]", "no"),  # a rotation: nothing decays
        ("[cos(th)/2 sin(th)/2; -sin(th)/2 cos(th)/2]", "[1 0]", "conditional"),
        ("[1/2 0; a 1/3]", "[1 1]", "yes"),  # W is told in cases, the finite sum for all of them
    ],
)
def test_infinite_sums_with_parameters_have_their_page(A: str, C: str, verdict: str) -> None:
    result = symobs.gramian(symobs.StateSpace(A, C=C, dt=True), horizon="inf")
    assert result.verdict == verdict
    assert result.to("text")


def test_a_discriminant_is_a_number_where_the_parameters_are_related() -> None:
    """a²b − ab² = 2 makes the roots 2 and −1, by hand: there is no square root there, and no case that oscillates."""
    found = symobs.gramian(symobs.StateSpace("[0 a*b; a-b 1]", C="[1 a*b]"), horizon=1)
    a, b, t = sympy.symbols("a b t")
    (there,) = [case for case in found.cases if case.when == (sympy.Eq(a**2 * b - a * b**2 - 2, 0),)]
    assert not there.result.matrix.atoms(sympy.cos, sympy.cosh)
    assert not there.result.cases
    A, C = sympy.Matrix([[0, 2], [1, 1]]), sympy.Matrix([[1, 2]])
    y = C * (A * t).exp()
    wanted = (y.T * y).applyfunc(lambda entry: sympy.integrate(sympy.expand(entry), (t, 0, 1)))
    assert (there.result.matrix.subs({a: 2, b: 1}) - wanted).evalf().norm() < 1e-12
    assert "is not decided" not in found.to("text")
