"""Polynomials in one variable whose coefficients are scalars: building them, and applying them to a matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact.field import Field
from symobs.exact.matrix import Matrix
from symobs.exact.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence


def from_coefficients(coefficients: Sequence[Scalar], variable: str) -> Scalar:
    """Return Σ c_k variable^k, coefficients given highest power first."""
    generator, value = Scalar.symbol(variable), Scalar.of(0)
    for coefficient in coefficients:
        value = value * generator + coefficient
    return value


def product_of(factors: Iterable[Scalar]) -> Scalar:
    """Return the product."""
    value = Scalar.of(1)
    for factor in factors:
        value = value * factor
    return value


def apply_polynomial(factors: Iterable[Scalar], variable: str, matrix: Matrix, vector: Matrix) -> Matrix:
    """Return φ(matrix) · vector for φ the product of `factors`, by Horner's rule on one factor after the other.

    No power of the matrix is formed: a factor s + p costs one product of matrix and vector.
    """
    for factor in factors:
        leading, *rest = (c.within(matrix.field | _field_of(c)) for c in factor.coefficients(variable))
        image = vector if leading.is_one else vector * leading
        for coefficient in rest:
            image = matrix @ image
            if not coefficient.is_zero:
                image = image + vector * coefficient
        vector = image
    return vector


def _field_of(coefficient: Scalar) -> Field:
    """Return the field of what really occurs: a coefficient's own context still holds the variable."""
    return Field.of(coefficient.names)


def companion(coefficients: Sequence[Scalar]) -> Matrix:
    """Return the matrix of the controllable canonical form for sⁿ + c₁ sⁿ⁻¹ + … + cₙ, given c₁ … cₙ.

    Ones above the diagonal, the last row −cₙ … −c₁.
    """
    order = len(coefficients)
    rows: list[list[Scalar]] = [[Scalar.of(int(j == i + 1)) for j in range(order)] for i in range(order - 1)]
    return Matrix.of([*rows, [-c for c in reversed(coefficients)]])


def hankel_of(coefficients: Sequence[Scalar]) -> Matrix:
    """Return [c₁ … cₙ₋₁ 1; c₂ … 1 0; …; 1 0 … 0] read from cₙ₋₁ down: the matrix that carries 𝒞 to canonical form.

    For s² + c₁ s + c₂ it is [c₁ 1; 1 0].
    """
    order = len(coefficients)
    ascending = [*reversed(coefficients), Scalar.of(1)]
    return Matrix.of(
        [[ascending[i + j + 1] if i + j + 1 <= order else Scalar.of(0) for j in range(order)] for i in range(order)]
    )
