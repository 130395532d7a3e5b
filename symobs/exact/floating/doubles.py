"""The double nearest to an exact number, and exact matrices of doubles."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact.algebraic.enclosure import near
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable

#: Bits beyond the binary point to which an irrational number is enclosed, in turn, until both ends round alike.
_BITS = (200, 800, 2000)


def nearest_double(value: Scalar) -> float:
    """Return the double nearest to a number; raises `InputError` where it has none, `ValueError` for no number."""
    try:
        if value.is_constant:
            return float(value.fraction())
        for bits in _BITS:
            middle = near(value, bits)
            if middle is None:
                break
            lower, upper = float(middle - Fraction(1, 2**bits)), float(middle + Fraction(1, 2**bits))
            if lower == upper:
                return lower
    except OverflowError:
        message = f"{str(value)[:40]} is larger than any floating-point number"
        raise InputError(message, repair="write the data in other units") from None
    message = f"{str(value)[:80]} is no number that can be rounded"
    raise ValueError(message)


def rounded_matrix(matrix: Matrix, rounding: Callable[[Scalar], float] = nearest_double) -> Matrix:
    """Return the matrix of the nearest doubles, as exact numbers."""
    rows = [[Scalar.of(Fraction(rounding(entry))) for entry in row] for row in matrix.rows]
    return Matrix.of(rows, matrix.shape[1])
