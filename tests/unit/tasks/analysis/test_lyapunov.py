"""Lyapunov's equation against SciPy, and against the eigenvalues, on random plants."""

from __future__ import annotations

from typing import Any

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
