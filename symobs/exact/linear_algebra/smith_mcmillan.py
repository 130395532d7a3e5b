"""Pole and zero polynomial of a matrix of rational functions, from its minors (Smith and McMillan)."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.exact.core.matrix import Matrix


def minors(matrix: Matrix, order: int) -> Iterator[Scalar]:
    """Yield the minors of an order that are not 0."""
    for rows in combinations(range(matrix.shape[0]), order):
        for columns in combinations(range(matrix.shape[1]), order):
            value = matrix.select(rows, columns).determinant()
            if not value.is_zero:
                yield value


def pole_and_zero_polynomial(matrix: Matrix, variable: str) -> tuple[Scalar, Scalar]:
    """Return (p, z): p the least common denominator of all minors, z the greatest common divisor of their numerators over p.

    For z the minors of the largest order that does not vanish are written over p.  Both are monic; z is 1 for the matrix 0.
    """
    listed = [list(minors(matrix, order)) for order in range(1, min(matrix.shape) + 1)]
    largest = next((found for found in reversed(listed) if found), [])
    poles = Scalar.of(1)
    for minor in (minor for found in listed for minor in found):
        poles = poles * minor.denominator / _common(poles, minor.denominator, variable)
    zeros = None
    for minor in largest:
        above = (minor * poles).numerator
        zeros = above if zeros is None else _common(zeros, above, variable)
    return _monic(poles, variable), _monic(Scalar.of(1) if zeros is None else zeros, variable)


def _common(left: Scalar, right: Scalar, variable: str) -> Scalar:
    """Return the common factor of two polynomials that contains the variable."""
    quotient = left / right
    shared = left / quotient.numerator
    return _monic(shared, variable) if shared.degree(variable) > 0 else Scalar.of(1)


def _monic(polynomial: Scalar, variable: str) -> Scalar:
    return polynomial / polynomial.coefficients(variable)[0]
