"""What a solution of Lyapunov's equation claims, in plain fractions: against the n²×n² system of all entries of P."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.support.algebra import (
    determinant,
    identity,
    matrix_at,
    multiply,
    plus,
    rank_of,
    subtract,
    transposed,
    value_at,
)

if TYPE_CHECKING:
    from tests.support.algebra import Rows
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold P, uniqueness, existence and definiteness to the equations of the entries at the point."""
    Q = matrix_at(result.weight, at.point)
    table, right = system(at.A, discrete=at.discrete), [[-entry] for row in Q for entry in row]
    regular = rank_of(table) == len(table)
    solvable = rank_of([[*row, *end] for row, end in zip(table, right, strict=True)]) == rank_of(table)
    if result.answer["P"] is None:
        assert not solvable
        assert (result.verdict, result.fields["positive_definite"]) == ("no", None)
        return
    P = matrix_at(result.answer["P"], at.point)
    assert multiply(table, [[entry] for row in P for entry in row]) == right
    assert transposed(P) == P
    if "Q" in result.answer:  # P was given, and what is told of definiteness is told of Q
        positive = all(determinant([row[:k] for row in Q[:k]]) > 0 for k in range(1, len(Q) + 1))
        assert result.fields["positive_definite"] in {"conditional", "yes" if positive else "no"}
        return
    assert regular == (result.answer["N"] is None)
    if not regular:
        N = matrix_at(result.answer["N"], at.point)
        assert not any(map(any, multiply(table, [[entry] for row in N for entry in row])))
        return
    positive = all(determinant([row[:k] for row in P[:k]]) > 0 for k in range(1, len(P) + 1))
    if result.fields["positive_definite"] == "conditional":
        assert positive == all(value_at(value, at.point) > 0 for value in result.definite.positive)
    else:
        assert positive == (result.fields["positive_definite"] == "yes")


def system(A: Rows, *, discrete: bool) -> Rows:
    """Return the matrix of P ↦ AᵀP + PA (AᵀPA − P) on the entries of P, row by row."""
    n, left = len(A), transposed(A)
    if discrete:
        return subtract(kron(left, left), identity(n * n))
    return plus(kron(left, identity(n)), kron(identity(n), left))


def kron(left: Rows, right: Rows) -> Rows:
    """Return the Kronecker product."""
    return [[a * b for a in row for b in other] for row in left for other in right]
