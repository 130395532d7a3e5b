"""Faults of F(s): the compensator with one term left out, or with one sign turned."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, transfer_matrix
from symobs.tasks.design.compensator.compensator import CompensatorDesign

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.tasks.result import Result


def other_values(result: Result) -> list[tuple[str, Matrix | Scalar, str]]:
    """Return what F is with each of the known slips: the slip, F, and the reason."""
    if not isinstance(result, CompensatorDesign) or not result.exists:
        return []
    return [(slip, _function(result, matrix), reason) for slip, matrix, reason in _matrices(result)]


def _matrices(result: CompensatorDesign) -> Iterator[tuple[str, Matrix, str]]:
    """Yield the matrix of the compensator's state with each of the slips."""
    m, K, L = result.plant.matrices, result.answer["K"], result.answer["L"]
    BK, LC, LDK = m.B @ K, L @ m.C, L @ m.D @ K
    yield "no_observer", m.A - BK, "the observer's own term L C is missing"
    yield "no_feedback", m.A - LC, "the term B K of the feedback is missing"
    yield "positive_feedback", m.A + BK - LC + LDK, "the feedback stands with the other sign"
    yield "sign_of_one", m.A - BK + LC + LDK, "the sign of L C is wrong"
    if K.shape == m.B.shape:
        yield "order_of_products", m.A - K @ m.B - LC + LDK, "K B stands for B K"
    if L.shape == m.C.shape:
        yield "order_of_products", m.A - BK - m.C @ L + LDK, "C L stands for L C"
    if m.has_feedthrough:
        yield "forgot_D", m.A - BK - LC, "D is taken as 0"


def _function(result: CompensatorDesign, matrix: Matrix) -> Matrix | Scalar:
    K, L, s = result.answer["K"], result.answer["L"], result.plant.variable
    zero = Matrix.zeros(K.shape[0], L.shape[1])
    above, below = transfer_matrix(matrix.normal(), L, K, zero, s)
    found = Matrix.of([[entry / below for entry in row] for row in above.rows])
    return found[0, 0] if found.shape == (1, 1) else found
