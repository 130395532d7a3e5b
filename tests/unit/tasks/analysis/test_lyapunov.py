"""Lyapunov's equation against SciPy, and against the eigenvalues, on random plants."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import symobs
from symobs.ground.errors import InputError


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


def test_a_given_p_has_its_q_as_numpy_finds_it() -> None:
    """−(AᵀP + PA), in discrete time P − AᵀPA, and its eigenvalues, which say whether it is positive definite."""
    chance = np.random.default_rng(5)
    for dt in (0, 1):
        for _ in range(12):
            A, half = (chance.integers(-4, 5, (3, 3)) for _ in range(2))
            P = half + half.T
            result: Any = symobs.lyapunov(symobs.StateSpace(A.tolist(), dt=dt), P=P.tolist())
            Q = P - A.T @ P @ A if dt else -(A.T @ P + P @ A)
            assert np.array(result.Q.tolist(), dtype=int).tolist() == Q.tolist()
            assert (result.positive_definite == "yes") == bool(np.linalg.eigvalsh(Q)[0] > 1e-9)
            assert result.verdict == "yes"
            assert "Q" in result.to("text")


def test_a_given_p_says_what_its_q_means_for_the_plant() -> None:
    """P = [5 1; 1 1] has Q = 4 I with A = [0 1; −2 −3]; [2 1; 1 2] has Q = [2k 2k−1; 2k−1 2] with [0 1; −k −1]."""
    said = " ".join(symobs.lyapunov(symobs.StateSpace("[0 1; -2 -3]"), P="[5 1; 1 1]").to("text").split())
    assert "P is positive definite if and only if A is asymptotically stable" in said
    found: Any = symobs.lyapunov(symobs.StateSpace("[0 1; -k -1]"), P="[2 1; 1 2]")
    assert (found.positive_definite, [str(each) for each in found.positive_if]) == (
        "conditional",
        ["-4*k**2 + 8*k - 1 > 0"],
    )
    assert found.at(k=1).positive_definite == "yes"
    with pytest.raises(InputError, match="both Q and P are given"):
        symobs.lyapunov(symobs.StateSpace("[0 1; -2 -3]"), Q=1, P=1)
