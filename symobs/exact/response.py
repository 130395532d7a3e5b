"""How a linear system with numbers runs from a state: enclosures of e^{Mt} v, and how fast its modes are."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import arb, arb_mat, ctx, fmpq, fmpq_mat

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence
    from fractions import Fraction

    from symobs.exact.matrix import Matrix

_BITS, _HALF = 128, 0.5


def rates(matrix: Matrix) -> tuple[float, float]:
    """Return the largest and the smallest real part among the eigenvalues of a matrix of numbers, nearly."""
    roots: Any = _rational(matrix).charpoly().complex_roots()  # pairs (root, multiplicity), not what its stub says
    real = [float(root.real.mid()) for root, _ in roots]
    return max(real), min(real)


def response(
    matrix: Matrix, start: Sequence[Fraction], instants: Iterable[Fraction], parts: int
) -> Iterator[tuple[int, ...]]:
    """Yield e^{Mt} v at some instants in whole numbers of 1/parts, each off by at most one; else `ArithmeticError`."""
    before, ctx.prec = ctx.prec, _BITS
    try:
        table = arb_mat(_rational(matrix))
        column = arb_mat([[arb(fmpq(part.numerator, part.denominator))] for part in start])
        for instant in instants:
            moved = (table * arb(fmpq(instant.numerator, instant.denominator))).exp() * column
            yield tuple(_nearest(moved[index, 0], parts) for index in range(len(start)))
    finally:
        ctx.prec = before


def _rational(matrix: Matrix) -> fmpq_mat:
    values = [[entry.fraction() for entry in row] for row in matrix.rows]
    return fmpq_mat([[fmpq(value.numerator, value.denominator) for value in row] for row in values])


def _nearest(ball: arb, parts: int) -> int:
    """Return the whole number of parts that is nearest to an interval's middle."""
    if float(ball.rad()) * parts > _HALF:
        raise ArithmeticError("the enclosure is too wide")
    mantissa, exponent = (int(part) for part in ball.mid().man_exp())
    scaled = mantissa * parts
    return scaled << exponent if exponent >= 0 else (scaled + (1 << -exponent >> 1)) >> -exponent
