"""Lyapunov's equation against SciPy, and against the eigenvalues, on random plants."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
from scipy.linalg import (  # type: ignore[import-untyped]
    solve_continuous_lyapunov,
    solve_discrete_lyapunov,
)

import symobs
from symobs.ground.errors import InputError
from tests.support.algebra import seeded
from tests.support.sampling import seeds


@pytest.mark.parametrize("seed", seeds(12))
def test_solutions_are_those_of_scipy(seed: int) -> None:
    """Hold P to SciPy where it is unique; where not, to the residual of the least-squares solution of all n² equations."""
    draw = seeded(seed)
    n, dt = draw.randint(1, 4), draw.choice([0, 1])
    A = [[Fraction(draw.randint(-3, 3), draw.choice([1, 2])) for _ in range(n)] for _ in range(n)]
    if draw.random() < 0.4:  # triangular with eigenvalues of which two often have the sum 0 or the product 1
        A = [
            [A[i][j] if j > i else Fraction(draw.choice([-2, -1, 1, 2, 0])) * (i == j) for j in range(n)]
            for i in range(n)
        ]
    Q = [[Fraction(0)] * n for _ in range(n)]
    for i in range(n):
        for j in range(i, n):
            Q[i][j] = Q[j][i] = Fraction(draw.randint(-2, 4))
    given = ("[" + "; ".join(" ".join(map(str, row)) for row in M) + "]" for M in (A, Q))
    rows, weight = given
    result: Any = symobs.lyapunov(symobs.StateSpace(rows, dt=dt), Q=weight)
    M, R = (np.array(part, dtype=float) for part in (A, Q))
    poles = np.linalg.eigvals(M)
    gaps = [abs(a * b - 1) if dt else abs(a + b) for a in poles for b in poles]
    assert (result.solvable == "yes") == (min(gaps) > 1e-6), (rows, dt)
    if result.solvable == "no":
        table = np.kron(M.T, M.T) - np.eye(n * n) if dt else np.kron(M.T, np.eye(n)) + np.kron(np.eye(n), M.T)
        best = np.linalg.lstsq(table, -R.flatten(), rcond=1e-9)[0]
        assert (result.P is not None) == np.allclose(table @ best, -R.flatten(), atol=1e-7), (rows, weight)
        return
    expected = solve_discrete_lyapunov(M.T, R) if dt else solve_continuous_lyapunov(M.T, -R)
    found = np.array(result.P.tolist(), dtype=float)
    assert np.allclose(found, expected, rtol=1e-6, atol=1e-6 * abs(expected).max())
    smallest = min(np.linalg.eigvalsh(expected))
    if abs(smallest) > 1e-6:
        assert result.positive_definite == ("yes" if smallest > 0 else "no")


def test_a_parameter_says_where_there_is_a_solution_and_where_it_is_positive_definite() -> None:
    result: Any = symobs.lyapunov(symobs.StateSpace("[a 0; 0 -1]"), Q="[1 0; 0 q]")
    assert (result.verdict, result.solvable) == ("conditional", "conditional")
    assert {str(condition) for condition in result.conditions} == {"Ne(a, 0)", "Ne(a - 1, 0)"}
    for a, q in ((-1, 1), (-1, -1), (2, 1), (2, -1)):  # P = diag(-1/(2 a), q/2)
        at = result.at(a=a, q=q)
        assert at.positive_definite == ("yes" if a < 0 < q else "no")
    there = {str(case.when[0]): case.result for case in result.cases}
    assert there["Eq(a, 0)"].P is None  # 2 a p11 = -1
    assert there["Eq(a - 1, 0)"].P is not None  # p12 is free
    assert there["Eq(a - 1, 0)"].verdict == "no"


def test_a_determinant_keeps_its_factors_beside_cosines() -> None:
    """With u = c − cos y: det χ(−A) = 4 (tr A)² det A, tr A = u + 2 and det A = 2u − 1, by hand."""
    result: Any = symobs.lyapunov(symobs.StateSpace("[c-cos(y) -1; -1 2]"))
    assert {str(case.when[0].lhs) for case in result.cases} == {"c - cos(y) + 2", "2*c - 2*cos(y) - 1"}
    assert "not decided" not in result.to("text")


def test_a_right_hand_side_without_symmetry_is_refused() -> None:
    with pytest.raises(InputError, match=r"not symmetric: its entries \(1, 2\) and \(2, 1\) differ"):
        symobs.lyapunov(symobs.StateSpace("[0 1; -1 -1]"), Q="[1 1; 0 1]")
