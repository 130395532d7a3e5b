"""Differences of coefficients carried back from controllable canonical form."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, hankel_of

if TYPE_CHECKING:
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


def canonical_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return l with lᵀ = [αₙ − aₙ, …, α₁ − a₁] V⁻¹, V = 𝒪ᵀ · Hankel(a); needs det 𝒪 ≠ 0."""
    found = pair.A.characteristic_polynomial(pair.variable).coefficients(pair.variable)[1:]
    V = pair.krylov.matrix.T @ hankel_of(found)
    differences = [alpha - a for alpha, a in zip(desired.coefficients, found, strict=True)]
    return V.T.solve(Matrix.column(list(reversed(differences)))).normal()


def companion_rows(pair: ObserverPair) -> Matrix:
    """Return T with rows q, qAᵀ, …, q the last row of 𝒞(Aᵀ, Cᵀ)⁻¹: T Aᵀ T⁻¹ is a companion matrix and T Cᵀ = eₙ."""
    rows = [pair.krylov.solve_last().normal().T]
    for _ in range(pair.A.shape[0] - 1):
        rows.append((rows[-1] @ pair.A.T).normal())
    return Matrix.block([[row] for row in rows])


def companion_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return l with lᵀ = [αₙ − aₙ, …, α₁ − a₁] T; needs det 𝒪 ≠ 0."""
    found = pair.A.characteristic_polynomial(pair.variable).coefficients(pair.variable)[1:]
    row = Matrix.row([alpha - a for alpha, a in zip(desired.coefficients, found, strict=True)][::-1])
    return (row @ companion_rows(pair)).T.normal()
