"""Matrices of numbers, in integers over one common denominator."""

from __future__ import annotations

from math import lcm
from typing import TYPE_CHECKING

from flint import fmpz, fmpz_mat

from symobs.exact.core.field import RATIONALS
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.ring import number_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact.core.scalar import Scalar


def matrix_of_numbers(rows: Sequence[Sequence[int | Fraction]]) -> Matrix:
    """Return the matrix with these rows, all of one length and none empty, over their least common denominator."""
    common = lcm(*(entry.denominator for row in rows for entry in row))
    numbers = [entry.numerator * (common // entry.denominator) for row in rows for entry in row]
    shape = (len(rows), len(rows[0]))
    return Matrix(RATIONALS, fmpz_mat(*shape, numbers), RATIONALS.context.constant(common), shape)


def horner(coefficients: Sequence[Scalar], matrix: Matrix, vector: Matrix) -> Matrix:
    """Return Σ cₖ Mⁿ⁻ᵏ v, nothing cancelled: with M = N/d and cₖ = nₖ/b the step is w ← N w + nₖ dᵏ v."""
    table, column = matrix.table, vector.table
    assert isinstance(table, fmpz_mat)  # noqa: S101 - an invariant of the rationals
    assert isinstance(column, fmpz_mat)  # noqa: S101 - the same
    fractions = [coefficient.fraction() for coefficient in coefficients]
    common = lcm(*(fraction.denominator for fraction in fractions))
    first, *others = (fraction.numerator * (common // fraction.denominator) for fraction in fractions)
    image, power, scale = column * first, fmpz(1), number_of(matrix.denominator)
    for number in others:
        power *= scale
        image = table * image
        if number:
            image += column * (number * power)
    below = number_of(vector.denominator) * common * power
    return Matrix(RATIONALS, image, RATIONALS.context.constant(below), vector.shape)


def whole_product(left: Sequence[Sequence[int]], right: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the product of two matrices of whole numbers, given by their rows."""
    return [list(map(int, row)) for row in (fmpz_mat(left) * fmpz_mat(right)).tolist()]
