"""Responses of a numeric linear system from an initial state: enclosures of e^{Mt} v, and spectral bounds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import arb, arb_mat, fmpq, fmpq_mat

from symobs.exact.core.precision import Precision
from symobs.exact.core.ring import number_of

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact.core.matrix import Matrix

#: Bits that are tried in turn until all enclosures are narrow.
_BITS = (128, 256, 512, 1024, 2048, 4096)
_HALF = arb(0.5)
#: Columns are doubled until so many blocks of them are all.
_BLOCKS = 8


def eigenvalues_near(matrix: Matrix) -> list[complex]:
    """Return the different eigenvalues of a numeric matrix, approximately."""
    roots: Any = _rational(matrix).charpoly().complex_roots()  # pairs (root, multiplicity), not what its stub says
    return [complex(float(root.real.mid()), float(root.imag.mid())) for root, _ in roots]


def spectral_abscissae(matrix: Matrix) -> tuple[float, float]:
    """Return the largest and smallest real part of the eigenvalues of a numeric matrix, approximately."""
    real = [root.real for root in eigenvalues_near(matrix)]
    return max(real), min(real)


def spectral_radius(matrix: Matrix) -> float:
    """Return the spectral radius of a numeric matrix, approximately."""
    return max(map(abs, eigenvalues_near(matrix)))


def state_response(
    matrix: Matrix, start: Sequence[Fraction], step: Fraction, count: int, parts: int
) -> list[list[int]]:
    """Return e^{Mt} v at `count` instants from 0 on, in integer multiples of 1/parts, with errors of at most one.

    The columns that are known times e^{Mh}, e^{2Mh}, e^{4Mh}, … are as many again, until a few blocks of them are all: an
    enclosure goes through few products.  Raises `ArithmeticError` where the enclosures stay too wide.
    """
    known = _rational(matrix)
    for bits in _BITS:
        with Precision(bits):
            power = (arb_mat(known) * arb(fmpq(step.numerator, step.denominator))).exp()
            columns = [[arb(fmpq(part.numerator, part.denominator)) * parts] for part in start]
            while _BLOCKS * len(columns[0]) < count:
                more = (power * arb_mat(columns)).tolist()
                columns = [[*row, *new] for row, new in zip(columns, more, strict=True)]
                power = power * power
            block, found = arb_mat(columns), list[tuple[int, ...]]()
            while (states := _nearest(block)) and len(found) + len(states) < count:
                found += states
                block = power * block
            if states:
                return [list(state) for state in [*found, *states][:count]]
    raise ArithmeticError("a response with too much to compute")


def _rational(matrix: Matrix) -> fmpq_mat:
    """Return a numeric matrix as FLINT's."""
    return fmpq_mat(
        [[fmpq(number_of(e.numerator_part), number_of(e.denominator_part)) for e in row] for row in matrix.rows]
    )


def _nearest(columns: arb_mat) -> list[tuple[int, ...]]:
    """Return the columns as whole numbers nearest to the middles of intervals; none where one of these is too wide."""
    halves = arb_mat(columns.nrows(), columns.ncols(), [_HALF] * (columns.nrows() * columns.ncols()))
    rows = [[_below(ball) for ball in row] for row in (columns + halves).tolist()]
    return [] if any(None in row for row in rows) else list(zip(*rows, strict=True))


def _below(ball: arb) -> int | None:
    """Return the whole number below an interval, below its middle where it is narrow; None for one that is wide."""
    whole: Any = ball.floor().unique_fmpz()
    if whole is None and ball.rad() < _HALF:
        whole = ball.mid().floor().unique_fmpz()  # never None for what has no radius
    return None if whole is None else int(whole)
