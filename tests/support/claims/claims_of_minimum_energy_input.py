"""What an input of minimum energy claims: u = Bᵀ e^{Aᵀ(T−t)} λ with W λ = d, with mpmath's exponential and Gramian."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.support.algebra import (
    CONTEXT,
    digits,
    identity,
    matrix_at,
    multiply,
    observability_rows,
    plus,
    subtract,
    transposed,
    value_at,
)
from tests.support.claims.claims_in_time import digits_of, gramian_of, near, table, world_at

if TYPE_CHECKING:
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold the input to the Gramian and to d; a refusal to the reachable states."""
    with CONTEXT.workdps(300):  # W has e^{2aT}, and what is left of it may be small
        _holds(result, at)


def _holds(result: Any, at: Setting) -> None:
    if result.verdict == "undecided":
        return
    if result.plant.is_discrete:
        _sequence_holds(result, at)
        return
    world, w = world_at(result, at), result.fields["unreachable"]
    end = digits_of(world, result.answer["horizon"])
    A, B = table(at.A), table(at.B)
    start, final = (table(world.value(result.answer[name])) for name in ("initial", "final"))
    d = final - CONTEXT.expm(A * end) * start
    if w is not None:
        row = [[world.value(entry) for entry in w]]
        assert not any(map(any, multiply(row, transposed(observability_rows(transposed(at.A), transposed(at.B))))))
        assert abs((table(row) * d)[0]) > 1e-12
        return
    W = gramian_of(A.T, B * B.T, end)
    lam = table(world.value(result.answer["multiplier"]))
    assert near(W * lam, d)
    t = digits(world.number("t"))
    assert near(table(world.value(result.answer["input"])), B.T * CONTEXT.expm(A.T * (end - t)) * lam)
    assert near(table([[world.value(result.fields["energy"])]]), d.T * lam)


def _sequence_holds(result: Any, at: Setting) -> None:
    """Hold u(k) = Bᵀ (Aᵀ)^{N−1−k} λ to the state that it leads to, and to its energy; a refusal to what is reached."""
    steps, answer = int(result.answer["horizon"].fraction()), result.answer
    moved = [identity(len(at.A))]
    for _ in range(steps):
        moved.insert(0, multiply(at.A, moved[0]))
    start, final = (matrix_at(answer[name], at.point) for name in ("initial", "final"))
    d = subtract(final, multiply(moved[0], start))
    enters = [multiply(power, at.B) for power in moved[1:]]
    if result.fields["unreachable"] is not None:
        w = transposed(matrix_at(answer["w"], at.point))
        assert not any(entry for part in enters for row in multiply(w, part) for entry in row)
        assert multiply(w, d) != [[0]]
        return
    lam, columns = matrix_at(answer["multiplier"], at.point), transposed(matrix_at(answer["input"], at.point))
    reached = subtract(d, d)
    for part, u in zip(enters, columns, strict=True):
        assert transposed([u]) == multiply(transposed(part), lam)
        reached = plus(reached, multiply(part, transposed([u])))
    assert reached == d
    assert value_at(answer["energy"], at.point) == sum(entry**2 for u in columns for entry in u)
