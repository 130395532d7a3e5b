"""Compensators that are given without gains: any F of no larger order whose closed loop has the poles asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar
from symobs.exact.linear_algebra.smith_mcmillan import pole_and_zero_polynomial
from symobs.tasks.design.compensator.output_feedback import OutputFeedback

if TYPE_CHECKING:
    from symobs.tasks.result import Result


def closes_the_loop(result: Result, F: Matrix | Scalar | None) -> bool:
    """Return whether det(sI − A) · (poles of F) · det(I + PF) = φ_c φ_o, F proper and of no larger order than the observer."""
    if not isinstance(result, OutputFeedback):
        return False
    variable = result.plant.variable
    matrix = Matrix.of([[F]]) if isinstance(F, Scalar) else F
    assert isinstance(matrix, Matrix)  # noqa: S101 - the right F exists, and is read like it
    P = result.plant_function
    plant = P if isinstance(P, Matrix) else Matrix.of([[P]])
    if matrix.shape != (result.plant.inputs, result.plant.outputs):
        return False
    if any(entry.numerator.degree(variable) > entry.denominator.degree(variable) for entry in matrix.entries):
        return False
    poles, _ = pole_and_zero_polynomial(matrix, variable)
    if poles.degree(variable) > result.own_matrix.shape[0]:
        return False
    chi = result.plant.matrices.A.characteristic_polynomial(variable)
    loop = (Matrix.identity(plant.shape[0]) + plant @ matrix).determinant()
    return bool(chi * poles * loop == result.loop_polynomial.value)
