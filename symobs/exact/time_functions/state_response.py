"""Responses of a numeric linear system from an initial state: enclosures of e^{Mt} v, and spectral bounds."""

from __future__ import annotations

from itertools import islice
from typing import TYPE_CHECKING, Any

from flint import arb, arb_mat, fmpq, fmpq_mat

from symobs.exact.core.precision import Precision

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact.core.matrix import Matrix

#: Bits that are tried in turn until all enclosures are narrow.
_BITS = (128, 256, 512, 1024, 2048, 4096)
_HALF = arb(0.5)


def spectral_abscissae(matrix: Matrix) -> tuple[float, float]:
    """Return the largest and smallest real part of the eigenvalues of a numeric matrix, approximately."""
    roots: Any = _rational(matrix).charpoly().complex_roots()  # pairs (root, multiplicity), not what its stub says
    real = [float(root.real.mid()) for root, _ in roots]
    return max(real), min(real)


def spectral_radius(matrix: Matrix) -> float:
    """Return the spectral radius of a numeric matrix, approximately."""
    roots: Any = _rational(matrix).charpoly().complex_roots()
    return max(abs(complex(float(root.real.mid()), float(root.imag.mid()))) for root, _ in roots)


def state_response(
    matrix: Matrix, start: Sequence[Fraction], step: Fraction, count: int, parts: int
) -> list[list[int]]:
    """Return e^{Mt} v at `count` instants from 0 on, in integer multiples of 1/parts, with errors of at most one.

    The columns that are known times e^{Mh}, e^{2Mh}, e^{4Mh}, … are as many again: an enclosure goes through few products.
    Raises `ArithmeticError` where the enclosures stay too wide.
    """
    known = _rational(matrix)
    for bits in _BITS:
        with Precision(bits):
            power = (arb_mat(known) * arb(fmpq(step.numerator, step.denominator))).exp()
            columns = [[arb(fmpq(part.numerator, part.denominator)) * parts] for part in start]
            while len(columns[0]) < count:
                more = (power * arb_mat(columns)).tolist()
                columns = [[*row, *new] for row, new in zip(columns, more, strict=True)]
                power = power * power
            if all(entry.rad() < _HALF for row in columns for entry in row[:count]):
                return [[_nearest(entry) for entry in state] for state in islice(zip(*columns, strict=True), count)]
    raise ArithmeticError("a response with too much to compute")


def _rational(matrix: Matrix) -> fmpq_mat:
    values = [[entry.fraction() for entry in row] for row in matrix.rows]
    return fmpq_mat([[fmpq(value.numerator, value.denominator) for value in row] for row in values])


def _nearest(ball: arb) -> int:
    """Return a whole number that is nearest to the middle of an interval."""
    whole: Any = (ball.mid() + _HALF).floor().unique_fmpz()  # never None for what has no radius
    return int(whole)
