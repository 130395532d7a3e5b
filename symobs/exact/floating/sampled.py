"""A system ẋ = A x + B w, v = C x + D w as the difference equation that a program runs, enclosed to any precision.

zoh      Φ = e^{Ah},  Γ = ∫₀ʰ e^{As} ds B,  C,  D: exact for inputs that are held over each period h
tustin   s = 2(z − 1)/(h(z + 1)):  Φ = (I − Ah/2)⁻¹(I + Ah/2),  Γ = (I − Ah/2)⁻¹Bh,  C(I − Ah/2)⁻¹,  D + C(I − Ah/2)⁻¹Bh/2
"""

from __future__ import annotations

from fractions import Fraction
from typing import NamedTuple

from flint import arb, arb_mat

from symobs.exact.algebraic.enclosure import _ball
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.precision import Precision
from symobs.exact.core.scalar import Scalar
from symobs.exact.linear_algebra.realisation import Realisation
from symobs.ground.errors import InputError

HOLDS = ("zoh", "tustin")
#: Bits of the enclosures that are tried in turn until both ends round to one double.
_BITS = (128, 512, 2048)
#: Below this a number is 0 in double precision: half of the smallest double.
_SMALLEST = Fraction(1, 2**1075)


class Sampled(NamedTuple):
    """A system and how its difference equation is made: with a period in a `hold`, or as it is where there is none."""

    system: Realisation
    period: Fraction | None = None
    hold: str = "zoh"

    def enclosed(self, bits: int) -> tuple[arb_mat, arb_mat, arb_mat, arb_mat]:
        """Return enclosures of Φ, Γ and of the matrices of the output."""
        with Precision(bits):
            A, B, C, D = (balls(matrix) for matrix in self.system)
            if self.period is None:
                return A, B, C, D
            h = arb(self.period.numerator) / self.period.denominator
            return (*held(A, B, h), C, D) if self.hold == "zoh" else bilinear(A, B, C, D, h)

    def rounded(self) -> Realisation:
        """Return the nearest doubles of Φ, Γ and of the matrices of the output, as exact numbers."""
        tried = [self.enclosed(bits) for bits in _BITS[:1]]
        for bits in _BITS[1:]:
            if all(_double(entry) is not None for matrix in tried[-1] for entry in matrix.entries()):
                break
            tried.append(self.enclosed(bits))
        return Realisation(*(_doubles(matrix) for matrix in tried[-1]))


def balls(matrix: Matrix) -> arb_mat:
    """Return the entries of a matrix of numbers as enclosures, at the precision in use."""
    rows, columns = matrix.shape
    return arb_mat(rows, columns, [_ball(entry) for entry in matrix.entries])


def held(A: arb_mat, B: arb_mat, h: arb) -> tuple[arb_mat, arb_mat]:
    """Return e^{Ah} and ∫₀ʰ e^{As} ds B from the exponential of [A B; 0 0] h."""
    order, width = A.nrows(), B.ncols()
    whole = arb_mat(order + width, order + width)
    for i in range(order):
        for j in range(order):
            whole[i, j] = A[i, j] * h
        for j in range(width):
            whole[i, order + j] = B[i, j] * h
    power = whole.exp()
    return part(power, (0, order), (0, order)), part(power, (0, order), (order, order + width))


def bilinear(A: arb_mat, B: arb_mat, C: arb_mat, D: arb_mat, h: arb) -> tuple[arb_mat, arb_mat, arb_mat, arb_mat]:
    """Return the matrices under s = 2(z − 1)/(h(z + 1)); raises `InputError` where 2/h is a pole."""
    order = A.nrows()
    one = arb_mat(order, order, [int(i == j) for i in range(order) for j in range(order)])
    half = A * (h / 2)
    try:
        inverse = (one - half).inv()
    except ZeroDivisionError:
        message = "the bilinear map has no value here: 2 divided by the period is a pole"
        raise InputError(message, where="period", repair="choose another period, or hold zoh") from None
    return inverse * (one + half), inverse * B * h, C * inverse, D + C * inverse * B * (h / 2)


def part(matrix: arb_mat, rows: tuple[int, int], columns: tuple[int, int]) -> arb_mat:
    """Return the rows and columns between these bounds."""
    entries = [matrix[i, j] for i in range(*rows) for j in range(*columns)]
    return arb_mat(rows[1] - rows[0], columns[1] - columns[0], entries)


def joined(blocks: list[list[arb_mat]]) -> arb_mat:
    """Return a matrix of blocks."""
    rows = [[entry for block in line for entry in block.tolist()[i]] for line in blocks for i in range(line[0].nrows())]
    return arb_mat(rows)


def _ends(ball: arb) -> tuple[Fraction, Fraction]:
    middle, radius = (Fraction(int(q.p), int(q.q)) for q in (ball.mid().fmpq(), ball.rad().fmpq()))
    return middle - radius, middle + radius


def _double(ball: arb) -> float | None:
    """Return the double that every number of a ball rounds to, None where they round to several."""
    lower, upper = _ends(ball)
    if max(abs(lower), abs(upper)) < _SMALLEST:
        return 0.0
    try:
        return float(lower) if float(lower) == float(upper) else None
    except OverflowError:
        message = "an entry is larger than any floating-point number"
        raise InputError(message, where="period", repair="choose a shorter period, or other units") from None


def _doubles(matrix: arb_mat) -> Matrix:
    """Return doubles of the entries; between two doubles, to the accuracy of the last enclosure."""
    rows = [[_double(entry) for entry in row] for row in matrix.tolist()]
    exact = [
        [Scalar.of(Fraction(float(sum(_ends(entry)) / 2) if number is None else number)) for entry, number in line]
        for line in (zip(own, found, strict=True) for own, found in zip(matrix.tolist(), rows, strict=True))
    ]
    return Matrix.of(exact, matrix.ncols())
