"""What an unknown-input observer claims, in plain fractions: ė = F e whatever x, u and d are, or why there is none."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.support.algebra import (
    assignable,
    characteristic,
    identity,
    independent,
    inverse,
    matrix_at,
    multiply,
    plus,
    rank_of,
    subtract,
    transposed,
)

if TYPE_CHECKING:
    from tests.support.algebra import Rows
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold the signals to e = x − x̂ = T x − z, and existence to the ranks of C E and E and to the zeros."""
    E, n = matrix_at(result.disturbance_input, at.point), len(at.A)
    seen = multiply(at.C, E)
    assert result.fields["solvable"] == (rank_of(seen) == rank_of(E))
    if result.answer["L"] is None:
        if result.fields["solvable"]:
            assert not assignable(without_disturbance(at, E), at.C, at.wanted[""])
        else:
            w = matrix_at(result.answer["w"], at.point)
            assert not any(any(row) for row in multiply(seen, w))
            assert any(any(row) for row in multiply(E, w))
        return
    H, T, F, B_y = (matrix_at(result.fields[name], at.point) for name in ("H", "T", "F", "B_y"))
    # e = x − z − H C x = T x − z, so ė = T (A x + B u + E d) − F z − B_u u − B_y (C x + D u) with z = T x − e.
    of_x = subtract(subtract(multiply(T, at.A), multiply(F, T)), multiply(B_y, at.C))
    parts = [of_x, multiply(T, E), subtract(identity(n), plus(T, multiply(H, at.C)))]
    if result.plant.matrices.has_input:
        B_u = matrix_at(result.fields["B_u"], at.point)
        parts.append(subtract(subtract(multiply(T, at.B), B_u), multiply(B_y, at.D)))
    assert not any(entry for part in parts for row in part for entry in row)
    assert characteristic(F) == at.wanted[""]


def without_disturbance(at: Setting, E: Rows) -> Rows:
    """Return T A with T = I − E (S C E)⁻¹ S C, where S selects rows of C E: not the H of the answer, but the same zeros."""
    E = transposed(independent(transposed(E)))
    if not E:
        return at.A
    seen = multiply(at.C, E)
    chosen = [seen.index(row) for row in independent(seen)]
    through = multiply(inverse([seen[i] for i in chosen]), [at.C[i] for i in chosen])
    return subtract(at.A, multiply(multiply(E, through), at.A))
