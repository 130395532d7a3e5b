"""Gramians: over fewer steps than states rank and kernel are those of the sum; cases do not contradict each other."""

from __future__ import annotations

import random
from typing import Any

import pytest
import sympy

import symobs
from tests.kit import text_of

FEW = symobs.StateSpace("[-2 1 0; 0 1 2; 0 0 0]", "[0; 1; -1]", "[0 -1 2]", dt=True)


def total(A: sympy.Matrix, C: sympy.Matrix, steps: int) -> sympy.Matrix:
    """The sum Σ (Aᵀ)ᵏ Cᵀ C Aᵏ, k < steps, by SymPy."""
    return sum(((C * A**k).T * (C * A**k) for k in range(steps)), sympy.zeros(*A.shape))


def test_two_steps_do_not_reach_three_states() -> None:
    found = symobs.gramian(FEW, of="controllability", horizon="2")
    assert (found.rank, found.determinant) == (2, 0)
    assert [tuple(v) for v in found.kernel] == [(1, 1, 1)]
    page = text_of(found)
    assert "orthogonal to its kernel" in page
    assert "every state is reachable" not in page
    assert "every state is reachable in these steps" in " ".join(
        symobs.gramian(FEW, of="controllability", horizon="3").to("text").split()
    )


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


def test_cases_that_hold_at_one_point_agree_there() -> None:
    """At b = 1/2, 2a³ + a² = 1 the rank of [B AB] is 1, whatever the sign of a discriminant says."""
    plant = symobs.StateSpace("[a*b a*b; 1 0]", "[b 1/2; a a]", symbols={"a": "nonnegative", "b": "real"})
    found = symobs.gramian(plant, of="controllability", horizon="1")
    a, b = sympy.symbols("a b")
    point = {a: sympy.nsolve(2 * a**3 + a**2 - 1, 0.66), b: sympy.Rational(1, 2)}

    def ranks(result: Any) -> list[int]:
        there = [case for case in result.cases if all(holds(relation) for relation in case.when)]
        return [rank for case in there for rank in ranks(case.result)] or [result.rank]

    def holds(relation: Any) -> bool:
        value = relation.lhs.subs(point).evalf()
        if relation.rel_op in {"==", "!="}:
            return bool(abs(value) < 1e-9) is (relation.rel_op == "==")
        return bool(relation.func(value, 0))

    assert set(ranks(found)) == {1}


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
