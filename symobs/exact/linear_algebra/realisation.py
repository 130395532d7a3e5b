"""Systems in state space, and a system in the return path of another."""

from __future__ import annotations

from typing import NamedTuple

from symobs.exact.core.matrix import Matrix
from symobs.exact.linear_algebra.transfer_function import transfer_matrix


class Realisation(NamedTuple):
    """A system in state space."""

    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix

    def function(self, variable: str) -> Matrix:
        """Return C (sI − A)⁻¹ B + D."""
        numerators, characteristic = transfer_matrix(*self, variable)
        return Matrix.of([[entry / characteristic for entry in row] for row in numerators.rows])


def closed(plant: Realisation, returned: Realisation) -> Realisation:
    """Return the plant with another system in the return path, negative feedback: u = v − (C₂ x₂ + D₂ y)."""
    A, B, C, D = plant
    through = (Matrix.identity(B.shape[1]) + returned.D @ D).inverse()
    v, state, own = through, through @ returned.D @ C, through @ returned.C
    output, fed = C - D @ state, D @ own
    return Realisation(
        Matrix.block([[A - B @ state, -(B @ own)], [returned.B @ output, returned.A - returned.B @ fed]]).normal(),
        Matrix.block([[B @ v], [returned.B @ D @ v]]).normal(),
        Matrix.block([[output, -fed]]).normal(),
        (D @ v).normal(),
    )
