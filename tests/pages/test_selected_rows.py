"""A page that says yes with several outputs or inputs shows n rows of the test matrix, and they are independent."""

from __future__ import annotations

from typing import Any

import pytest
import sympy

import symobs
from symobs.exact import Matrix
from symobs.exact.sympy_bridge.conversion import scalar_to_sympy
from symobs.formula.tree import Letter, Literal
from symobs.proof.derivation.steps import relations
from tests.support.algebra import seeded
from tests.support.sampling import seeds

MASSES = dict.fromkeys(("k", "l", "m", "d"), "positive")
POSITIVE = {sympy.Symbol(name): sympy.Symbol(name, positive=True) for name in MASSES}
#: Three masses in a row, the first of them and the last one measured.
CHAIN = (
    "[0 1 0 0 0 0; -(k+l)/m -d/m l/m 0 0 0; 0 0 0 1 0 0; l/m 0 -(l+k)/m -d/m k/m 0; 0 0 0 0 0 1; 0 0 k/m 0 -k/m -d/m]"
)


def shown(result: Any) -> list[Matrix]:
    """Return the values that the page prints of 𝒪 or 𝒞, and of their rows and columns."""
    letters = {Letter(name) for name in ("O", "O_n", "Ctr", "Ctr_n")}
    lines = [each for each in relations(result.derivation.steps) if each.members[0] in letters]
    printed = [line for line in lines if len(line.members) > 2]
    return [
        part.value
        for line in printed
        for part in line.members
        if isinstance(part, Literal) and isinstance(part.value, Matrix)
    ]


def held(result: Any, whole: sympy.Matrix) -> None:
    """Hold that n rows of the whole matrix are shown, and that their determinant vanishes nowhere."""
    (table,) = shown(result)
    entries = sympy.Matrix([[scalar_to_sympy(entry).subs(POSITIVE) for entry in row] for row in table.rows])
    n = whole.shape[1]
    assert entries.shape == (n, n)
    lines = entries if result.task == "observability" else entries.T
    rows = [list(map(sympy.simplify, whole.row(i))) for i in range(whole.rows)]
    assert all(list(map(sympy.simplify, lines.row(i))) in rows for i in range(n))
    assert sympy.factor(entries.det()).is_nonzero


def stack(A: sympy.Matrix, C: sympy.Matrix) -> sympy.Matrix:
    return sympy.Matrix.vstack(*[C * A**k for k in range(A.rows)])


@pytest.mark.parametrize("seed", seeds(8, 60))
def test_numbers(seed: int) -> None:
    draw = seeded(seed)
    n, p = draw.randint(4, 6), draw.randint(2, 3)
    A = sympy.Matrix(n, n, lambda *_: draw.choice([0, 0, 1, -1, 2]))
    C = sympy.Matrix(p, n, lambda *_: draw.choice([0, 0, 0, 1]))
    whole = stack(A, C)
    if whole.rank() < n:
        return
    held(symobs.observability(symobs.StateSpace(A, C=C)), whole)
    held(symobs.controllability(symobs.StateSpace(A.T, C.T)), whole)


def test_letters() -> None:
    result = symobs.observability(symobs.StateSpace(CHAIN, C="[1 0 0 0 0 0; 0 0 0 0 1 0]", symbols=MASSES))
    k, l, m, d = POSITIVE.values()
    A = sympy.zeros(6)
    A[0, 1] = A[2, 3] = A[4, 5] = 1
    A[1, :] = sympy.Matrix([[-(k + l) / m, -d / m, l / m, 0, 0, 0]])
    A[3, :] = sympy.Matrix([[l / m, 0, -(l + k) / m, -d / m, k / m, 0]])
    A[5, :] = sympy.Matrix([[0, 0, k / m, 0, -k / m, -d / m]])
    held(result, stack(A, sympy.Matrix([[1, 0, 0, 0, 0, 0], [0, 0, 0, 0, 1, 0]])))


def test_a_determinant_that_may_vanish_is_not_taken() -> None:
    """The rows of C are dependent at a = 0; c₁ and c₁A never are."""
    result = symobs.observability(symobs.StateSpace("[0 1; 0 0]", C="[1 0; 0 a]", symbols={"a": "real"}))
    assert result.verdict == "yes"
    (table,) = shown(result)
    assert table == Matrix.identity(2)
