"""How a linear system with numbers runs from a state: enclosures of e^{Mt} v, and how fast its modes are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import arb, arb_mat, fmpq, fmpq_mat

from symobs.exact.precision import Precision

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact.matrix import Matrix

_BITS, _MOST_BITS = 128, 20_000
_HALF = arb(0.5)
#: Bits that an error can gain where it grows by a factor e.
_BITS_OF_E = 1.45


def rates(matrix: Matrix) -> tuple[float, float]:
    """Return the largest and the smallest real part among the eigenvalues of a matrix of numbers, nearly."""
    roots: Any = _rational(matrix).charpoly().complex_roots()  # pairs (root, multiplicity), not what its stub says
    real = [float(root.real.mid()) for root, _ in roots]
    return max(real), min(real)


def radius(matrix: Matrix) -> float:
    """Return the largest absolute value among the eigenvalues of a matrix of numbers, nearly."""
    roots: Any = _rational(matrix).charpoly().complex_roots()
    return max(abs(complex(float(root.real.mid()), float(root.imag.mid()))) for root, _ in roots)


def response(matrix: Matrix, start: Sequence[Fraction], step: Fraction, count: int, parts: int) -> list[list[int]]:
    """Return e^{Mt} v at `count` instants from 0 on, in whole numbers of 1/parts, each off by at most one.

    One exponential, then one product a step: an enclosure grows by e^‖Mh‖ at most, so as many bits are kept for it.
    Raises `ArithmeticError` where that takes too many.
    """
    rate = float(max(sum(abs(entry.fraction()) for entry in row) for row in matrix.rows))
    bits = _BITS + int(_BITS_OF_E * rate * float(step) * count) + parts.bit_length()
    if bits > _MOST_BITS:
        raise ArithmeticError("a course with too much to compute")
    with Precision(bits):
        once = (arb_mat(_rational(matrix)) * arb(fmpq(step.numerator, step.denominator))).exp()
        column = arb_mat([[arb(fmpq(part.numerator, part.denominator)) * parts] for part in start])
        states = []
        for _ in range(count):
            states.append([_nearest(entry) for entry in column.entries()])
            column = once * column
        return states


def _rational(matrix: Matrix) -> fmpq_mat:
    values = [[entry.fraction() for entry in row] for row in matrix.rows]
    return fmpq_mat([[fmpq(value.numerator, value.denominator) for value in row] for row in values])


def _nearest(ball: arb) -> int:
    """Return a whole number that is nearest to an interval, or next to the nearest."""
    if not ball.rad() < _HALF:
        raise ArithmeticError("the enclosure is too wide")
    whole: Any = (ball.mid() + _HALF).floor().unique_fmpz()  # never None for what has no radius
    return int(whole)
