"""What an optimal gain claims: Riccati's equation of its data, the gain that belongs to P, and a stable loop, with mpmath."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from tests.support.algebra import CONTEXT, matrix_at
from tests.support.claims.claims_in_time import table, world_at

if TYPE_CHECKING:
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold K and P to Riccati's equation, or the obstacle to the modes of the Hamiltonian matrix."""
    Q, R, N = (matrix_at(result.weights[name], at.point) for name in "QRN")
    riccati_holds(result, at, (at.A, at.B, Q, R, N), "K")


def riccati_holds(result: Any, at: Setting, data: tuple[Any, ...], letter: str) -> None:
    """Hold P and the gain, of the regulator that the problem is or is dual to."""
    with CONTEXT.workdps(60):
        A, B, Q, R, N = map(table, data)
        if result.verdict == "undecided":
            return
        if result.verdict == "no":
            assert not has_solution(A, B, Q, R, N, discrete=at.discrete)
            return
        world = world_at(result, at)
        if result.answer["P"] is not None:
            P, gain = (table(world.value(result.answer[name])) for name in ("P", letter))
            small = CONTEXT.mpf(10) ** -30
        else:
            P, gain = (
                table([[CONTEXT.mpf(e) for e in row] for row in result.decimals[name]]) for name in ("P", letter)
            )
            small = CONTEXT.mpf(10) ** -6
        K = gain if letter == "K" else gain.T
        inner = R + B.T * P * B if at.discrete else R
        left = A.T * P * A - P + Q if at.discrete else A.T * P + P * A + Q
        coupled = B.T * P * A if at.discrete else B.T * P
        scale = 1 + CONTEXT.mnorm(P, 1) ** 2
        assert CONTEXT.mnorm(left - K.T * inner * K, 1) < small * scale
        assert CONTEXT.mnorm(inner * K - coupled - N.T, 1) < small * scale
        poles = eigenvalues(A - B * K)
        assert all(abs(pole) < 1 if at.discrete else CONTEXT.re(pole) < 0 for pole in poles)


def has_solution(A: Any, B: Any, Q: Any, R: Any, N: Any, *, discrete: bool) -> bool:
    """Return whether no unstable mode is free of the inputs, and none on the boundary free of the cost."""
    order = A.rows
    moved, weight = A - B * CONTEXT.inverse(R) * N.T, Q - N * CONTEXT.inverse(R) * N.T
    for matrix, beside, hidden in ((A.T, B.T, -1), (moved, weight, 0)):
        for mode in eigenvalues(matrix):
            side = abs(mode) - 1 if discrete else CONTEXT.re(mode)
            tall = CONTEXT.matrix(order + beside.rows, order)
            tall[:order, :] = matrix - mode * CONTEXT.eye(order)
            tall[order:, :] = beside
            is_hidden = CONTEXT.svd_c(tall, compute_uv=False)[order - 1] < 1e-12
            if is_hidden and (side > -1e-12 if hidden else abs(side) < 1e-12):
                return False
    return True


def eigenvalues(matrix: Any) -> Any:
    return CONTEXT.eig(matrix, left=False, right=False) if matrix.rows > 1 else [matrix[0, 0]]
