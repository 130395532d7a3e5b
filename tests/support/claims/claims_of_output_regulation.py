"""What output regulation claims, in plain fractions: the regulator equations, or that their linear system has no solution."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.algebra import (
    assignable,
    characteristic,
    matrix_at,
    multiply,
    plus,
    product,
    rank_of,
    subtract,
    transposed,
)

if TYPE_CHECKING:
    from tests.support.algebra import Rows
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold Π, Γ, F and the closed loop to their equations at a point, and a refusal to ranks."""
    S, Q, E = (matrix_at(part, at.point) for part in result.exogenous)
    fields = result.fields
    Pi, Gamma, K, F = (
        None if fields[name] is None else matrix_at(fields[name], at.point) for name in ("Pi", "Gamma", "K", "F")
    )
    if Pi is None or Gamma is None:
        table, right = system(at, S), [[entry] for row in [*E, *Q] for entry in row]
        assert rank_of([[*row, *end] for row, end in zip(table, right, strict=True)]) > rank_of(table)
        assert result.verdict == "no"
    else:
        driven = plus(plus(multiply(at.A, Pi), multiply(at.B, Gamma)), E)
        assert driven == multiply(Pi, S)
        assert plus(multiply(at.C, Pi), multiply(at.D, Gamma)) == Q
    if K is None:
        assert not assignable(transposed(at.A), transposed(at.B), at.wanted[""])
    elif Pi is not None and Gamma is not None:
        assert plus(Gamma, multiply(K, Pi)) == F
    wide = extended(at, S, E)
    if "observer_" in at.wanted and fields.get("L") is None:
        assert not assignable(*wide, at.wanted["observer_"])
    if K is None or fields["closed_loop_matrix"] is None:
        assert result.verdict == "no"
        return
    closed = matrix_at(fields["closed_loop_matrix"], at.point)
    polynomial = characteristic(subtract(at.A, multiply(at.B, K)))
    if "" in at.wanted:
        assert polynomial == at.wanted[""]
    if fields.get("L") is not None:
        L = matrix_at(fields["L"], at.point)
        error = characteristic(subtract(wide[0], multiply(L, wide[1])))
        assert error == at.wanted.get("observer_", error)
        polynomial = product([polynomial, error])
    assert characteristic(closed) == polynomial


def extended(at: Setting, S: Rows, E: Rows) -> tuple[Rows, Rows]:
    """Return [A E; 0 S] and [C 0]."""
    A = [[*row, *more] for row, more in zip(at.A, E, strict=True)]
    A += [[*([Fraction(0)] * len(at.A)), *row] for row in S]
    return A, [[*row, *([Fraction(0)] * len(S))] for row in at.C]


def system(at: Setting, S: Rows) -> Rows:
    """Return the matrix of (Π, Γ) ↦ (ΠS − AΠ − BΓ, CΠ + DΓ) on entries, row by row."""
    n, m, q = len(at.A), len(at.B[0]), len(S)
    columns = []
    for k in range((n + m) * q):
        unit = [[Fraction(int(i * q + j == k)) for j in range(q)] for i in range(n + m)]
        Pi, Gamma = unit[:n], unit[n:]
        above = subtract(subtract(multiply(Pi, S), multiply(at.A, Pi)), multiply(at.B, Gamma))
        below = plus(multiply(at.C, Pi), multiply(at.D, Gamma))
        columns.append([entry for row in [*above, *below] for entry in row])
    return transposed(columns)
