"""The recipe of S0, Example 4.1: differences of coefficients carried back from controllable canonical form."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, hankel_of

if TYPE_CHECKING:
    from symobs.design.assignment import Pair
    from symobs.specification import DesiredPolynomial


def canonical_gain(pair: Pair, desired: DesiredPolynomial) -> Matrix:
    """Return l with lᵀ = [αₙ − aₙ, …, α₁ − a₁] V⁻¹, V = 𝒪ᵀ · Hankel(a); needs det 𝒪 ≠ 0."""
    found = pair.A.characteristic_polynomial(pair.variable).coefficients(pair.variable)[1:]
    V = pair.krylov.matrix.T @ hankel_of(found)
    differences = [alpha - a for alpha, a in zip(desired.coefficients, found, strict=True)]
    return V.T.solve(Matrix.column(list(reversed(differences)))).normal()
