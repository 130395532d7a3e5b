"""The matrix exponential as a sum of scalar functions times constant matrices.

The entries of e^{At} are sums of the functions tᵏ e^{λt}, and tᵏ e^{σt} cos νt, tᵏ e^{σt} sin(νt)/ν (cosh, sinh), that
the factors of the characteristic polynomial have.  With f the column of these n functions and f′ = D f, the matrices
M of e^{At} = Σ fᵢ Mᵢ follow from the derivatives at 0: Σᵢ (Dᵏ f(0))ᵢ Mᵢ = Aᵏ, k < n.  All of it is rational in the
parameters; square roots stand in the scalar functions only.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Literal

from flint import arb, arb_mat, fmpq, fmpq_mat, fmpz, fmpz_mat

from symobs.exact.algebraic.enclosure import near, polynomial_ball
from symobs.exact.algebraic.extension import AlgebraicExtension
from symobs.exact.algebraic.polynomial_roots import factored
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.field import EIGENVALUE
from symobs.exact.core.generators import ONE, ZERO, normal_form, square_root
from symobs.exact.core.matrix import Matrix, matrix_of_numbers
from symobs.exact.core.polynomial import companion
from symobs.exact.core.ring import Precision, number_of
from symobs.exact.core.scalar import Scalar
from symobs.exact.time_functions.quasipolynomial import Key, Quasipolynomial, matrix_at
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.exact.time_functions.quasipolynomial import Table


#: Orders up to which it is computed, without and with parameters.
MOST_STATES, MOST_STATES_WITH_PARAMETERS = 40, 8


class NoClosedForm(ArithmeticError):
    """A factor of the characteristic polynomial has degree 3 or more."""

    def __init__(self, factor: Scalar | None, most: int = MOST_STATES) -> None:
        """Keep the factor; None where there are more states than the given number."""
        super().__init__(str(factor))
        self.factor, self.most = factor, most


class OpenBranch(ArithmeticError):
    """The sign of a discriminant, which decides between real and complex roots, is not known."""

    def __init__(self, discriminant: Scalar) -> None:
        """Keep the discriminant δ of s² − 2σs + σ² − δ."""
        super().__init__(str(discriminant))
        self.discriminant = discriminant


@dataclass
class Mode:
    """The functions of one factor: e^{rate · t}, or the pair of a quadratic factor with its δ (0 for a real rate)."""

    rate: Scalar
    discriminant: Scalar
    oscillates: bool

    @property
    def rates(self) -> Matrix:
        """D with f′ = D f for the functions of power 0."""
        if self.discriminant.is_zero:
            return Matrix.of([[self.rate]])
        return Matrix.of([[self.rate, self.discriminant], [ONE, self.rate]])

    @property
    def start(self) -> tuple[Scalar, ...]:
        """Their values at 0."""
        return (ONE,) if self.discriminant.is_zero else (ONE, ZERO)

    def values(self, power: int, time: Scalar) -> tuple[Scalar, ...]:
        """Return the functions as scalars in functions of time."""
        return tuple(f.value_at(time) for f in self.functions(power))

    @property
    def root(self) -> Scalar:
        """√|δ|."""
        return square_root(-self.discriminant if self.oscillates else self.discriminant)

    def functions(self, power: int) -> tuple[Quasipolynomial, ...]:
        """Return tᵏ e^{σt}, or the pair tᵏ e^{σt} C and tᵏ e^{σt} S."""
        if self.discriminant.is_zero:
            return (Quasipolynomial({Key(power, self.rate, "", ZERO): ONE}),)
        root, half = self.root, Fraction(1, 2)
        if self.oscillates:
            return (
                Quasipolynomial({Key(power, self.rate, "cos", root): ONE}),
                Quasipolynomial.of([(Key(power, self.rate, "sin", root), 1 / root)]),
            )
        up, down = Key(power, self.rate + root, "", ZERO), Key(power, self.rate - root, "", ZERO)
        return (
            Quasipolynomial.of([(up, ONE * half), (down, ONE * half)]),
            Quasipolynomial.of([(up, half / root), (down, -half / root)]),
        )


@dataclass
class RootMode:
    """The functions Σ λʲ e^{λt}/q′(λ), j below the degree of q, a polynomial in λ whose roots have no closed form."""

    polynomial: Scalar

    @property
    def rates(self) -> Matrix:
        """D with φ′ = D φ: φⱼ′ = φⱼ₊₁, and the last one by q(λ) = 0."""
        return companion(AlgebraicExtension(self.polynomial, EIGENVALUE).coefficients[1:])

    @property
    def start(self) -> tuple[Scalar, ...]:
        """Their values at 0, traces of λʲ/q′(λ)."""
        return tuple(value.moved({"t": ZERO}) for value in self._sums(Scalar.symbol("t")))

    def _sums(self, time: Scalar) -> tuple[RootSum, ...]:
        degree = self.polynomial.degree(EIGENVALUE)
        return tuple(RootSum("RootSum", time, self.polynomial, power) for power in range(degree))

    def values(self, power: int, time: Scalar) -> tuple[Scalar, ...]:
        """Return tᵏ φⱼ."""
        return tuple(time**power * function.value for function in self._sums(time))


@dataclass
class Exponential:
    """e^{At} V = Σ function · matrix over the parts; a part is (mode, k, the matrices of its one or two functions)."""

    parts: tuple[tuple[Mode | RootMode, int, tuple[Matrix, ...]], ...]
    shape: tuple[int, int]

    @property
    def order(self) -> int:
        """The number of states."""
        return self.shape[0]

    @property
    def is_closed(self) -> bool:
        """Whether there is no sum over roots."""
        return all(isinstance(mode, Mode) for mode, _, _ in self.parts)

    def matrix(self, time: Scalar) -> Matrix:
        """Return the values, in functions of time and in sums over roots."""
        total = matrix_at(self.table(), time)
        for mode, power, matrices in self.parts:
            if isinstance(mode, RootMode):
                for value, matrix in zip(mode.values(power, time), matrices, strict=True):
                    total = total + matrix * value
        return total

    def table(self) -> Table:
        """Return the entries with closed forms."""
        height, width = self.shape
        rows = [[Quasipolynomial({})] * width for _ in range(height)]
        for mode, power, matrices in self.parts:
            if isinstance(mode, RootMode):
                continue
            for f, matrix in zip(mode.functions(power), matrices, strict=True):
                for i in range(height):
                    for j in range(width):
                        if not matrix[i, j].is_zero:
                            rows[i][j] = rows[i][j] + f.scaled(matrix[i, j])
        return tuple(tuple(row) for row in rows)


def modes_of(
    polynomial: Scalar, variable: str, sign: Callable[[Scalar], str], *, sums: bool = False
) -> tuple[tuple[Mode | RootMode, int], ...]:
    """Return the modes of a characteristic polynomial with multiplicities; with `sums`, sums over roots too.

    `sign` returns what is known of a discriminant's sign.  Raises `NoClosedForm`, `OpenBranch`.
    """
    found: list[tuple[Mode | RootMode, int]] = []
    for factor, multiplicity in factored(polynomial, variable).factors:
        coefficients = factor.coefficients(variable)
        if len(coefficients) == 2:
            found.append((Mode(-coefficients[1], ZERO, oscillates=False), multiplicity))
        elif len(coefficients) == 3:
            rate = -coefficients[1] / 2
            discriminant = normal_form(rate * rate - coefficients[2])
            known = sign(discriminant)
            if known == "zero":
                found.append((Mode(rate, ZERO, oscillates=False), 2 * multiplicity))
                continue
            if known not in {"positive", "negative"}:
                raise OpenBranch(discriminant)
            found.append((Mode(rate, discriminant, known == "negative"), multiplicity))
        elif sums:
            found.append((RootMode(factor.substitute({variable: Scalar.symbol(EIGENVALUE)})), multiplicity))
        else:
            raise NoClosedForm(factor)
    return tuple(found)


def exponential(
    A: Matrix,
    variable: str,
    sign: Callable[[Scalar], str],
    *,
    sums: bool = False,
    start: Matrix | None = None,
    simplified: Callable[[Scalar], Scalar] | None = None,
) -> Exponential:
    """Return e^{At}, or e^{At} V for a matrix `start`, with `sums` over roots if need be.

    Where parameters are related, `simplified` returns a value modulo their relations: so are the roots then.

    Raises `NoClosedForm` where it has none here, `OpenBranch` where a sign must be known first.
    """
    order = A.shape[0]
    most = MOST_STATES_WITH_PARAMETERS if A.names else MOST_STATES
    if order > most:
        raise NoClosedForm(None, most)
    A, start = _over_its_field(A), Matrix.identity(order) if start is None else _over_its_field(start)
    width = start.shape[1]
    polynomial = A.characteristic_polynomial(variable)
    found = modes_of(simplified(polynomial) if simplified else polynomial, variable, sign, sums=sums)
    places = [(mode, k) for mode, multiplicity in found for k in range(multiplicity)]
    D, begins = _rates(found)
    columns = [begins]
    for _ in range(order - 1):
        columns.append(D @ columns[-1])
    powers = [start]
    for _ in range(order - 1):
        powers.append((A @ powers[-1]).normal())
    W = Matrix.of([list(column.entries) for column in columns])
    right = Matrix.of([list(power.entries) for power in powers])
    solved = W.solve(right).rows
    matrices = [Matrix.of([row[i * width : (i + 1) * width] for i in range(order)], width) for row in solved]
    parts, at = [], 0
    for mode, k in places:
        count = len(mode.start)
        own = tuple(matrices[at : at + count])
        at += count
        if any(not matrix.is_zero for matrix in own):
            parts.append((mode, k, own))
    return Exponential(tuple(parts), start.shape)


def _rates(modes: Sequence[tuple[Mode | RootMode, int]]) -> tuple[Matrix, Matrix]:
    """Return D and f(0) with f′ = D f, f the column of all functions."""
    order = sum(multiplicity * len(mode.start) for mode, multiplicity in modes)
    rows = [[ZERO] * order for _ in range(order)]
    start, at = [ZERO] * order, 0
    for mode, multiplicity in modes:
        block, width = mode.rates, len(mode.start)
        start[at : at + width] = mode.start
        for k in range(multiplicity):
            for i in range(width):
                rows[at + i][at : at + width] = block.rows[i]
                if k:
                    rows[at + i][at + i - width] = Scalar.of(k)
            at += width
    return _over_its_field(Matrix.of(rows)), _over_its_field(Matrix.column(start))


def _over_its_field(matrix: Matrix) -> Matrix:
    """Return a matrix of numbers as one of the rationals, where equations are solved much faster; any other as it is."""
    if matrix.names or not matrix.shape[1]:
        return matrix
    return matrix_of_numbers([[entry.fraction() for entry in row] for row in matrix.rows])


# Responses of a numeric linear system from an initial state: enclosures of e^{Mt} v, and spectral bounds.


#: Bits that are tried in turn until all enclosures are narrow.
_BITS = (128, 256, 512, 1024, 2048, 4096)
#: So many columns are enclosed before they are doubled as whole numbers.
_ENCLOSED = 16
#: Bits of a rational number near to one that is none.
_NEAR = 240


def eigenvalues_near(matrix: Matrix) -> list[complex]:
    """Return the different eigenvalues of a numeric matrix, approximately."""
    rows = [[fmpq(f.numerator, f.denominator) for f in row] for row in fractions_near(matrix)]
    roots: Any = fmpq_mat(rows).charpoly().complex_roots()  # pairs (root, multiplicity), not what its stub says
    return [complex(float(root.real.mid()), float(root.imag.mid())) for root, _ in roots]


def spectral_abscissae(matrix: Matrix) -> tuple[float, float]:
    """Return the largest and smallest real part of the eigenvalues of a numeric matrix, approximately."""
    real = [root.real for root in eigenvalues_near(matrix)]
    return max(real), min(real)


def spectral_radius(matrix: Matrix) -> float:
    """Return the spectral radius of a numeric matrix, approximately."""
    return max(map(abs, eigenvalues_near(matrix)))


def fraction_near(value: Scalar) -> Fraction:
    """Return a rational number itself, and one near to any other number; raises `ArithmeticError` where none is known."""
    if value.is_constant:
        return value.fraction()
    found = near(value, _NEAR)
    if found is None:
        raise ArithmeticError(f"{value} is no number")
    return found


def fractions_near(matrix: Matrix) -> list[list[Fraction]]:
    """Return the rows of a matrix of numbers, those near to the irrational ones; raises `ArithmeticError` for letters."""
    if isinstance(matrix.table, fmpz_mat):
        below = int(number_of(matrix.denominator))
        return [[Fraction(int(entry), below) for entry in row] for row in matrix.table.tolist()]
    return [list(map(fraction_near, row)) for row in matrix.rows]


def state_response(
    matrix: Matrix,
    start: Sequence[Fraction | Scalar],
    step: Fraction,
    count: int,
    parts: int,
    signals: Sequence[Sequence[Fraction]] | None = None,
) -> list[list[int]]:
    """Return each component of e^{Mt} v at `count` instants from 0 on, in multiples of 1/parts, with errors of at most one.

    With `signals`, rows of numbers, it is each row times e^{Mt} v instead.  Raises `ArithmeticError` where the enclosures
    stay too wide.
    """
    for bits in _BITS:
        with Precision(bits + bits // 2):
            found = _doubled(matrix, start, step, count, parts, signals, bits)
        if found is not None:
            return found
    raise ArithmeticError("a response with too much to compute")


def _doubled(
    matrix: Matrix,
    start: Sequence[Fraction | Scalar],
    step: Fraction,
    count: int,
    parts: int,
    signals: Sequence[Sequence[Fraction]] | None,
    bits: int,
) -> list[list[int]] | None:
    """Return the same from fractions of so many bits; None where they are too few.

    The first columns are enclosed, then columns times e^{Mkh} are as many again.  A component at all instants is one long
    integer, a field of bits for each: Σ xᵢ 2^(width i), with xᵢ in parts of 2⁻ᵏᵉᵖᵗ.  Its error is at most `off` of these parts
    and it is not larger than `most`.
    """
    kept, order, width = bits // 2, len(start), 64 * (bits // 32 + 3)
    if isinstance(matrix.table, fmpz_mat):
        known = arb_mat(matrix.table) / arb(number_of(matrix.denominator))
    else:
        known = arb_mat([[_ball(entry) for entry in row] for row in matrix.rows])
    power = (known * arb(fmpq(step.numerator, step.denominator))).exp()
    block = arb_mat([[_ball(Scalar.of(part)) * parts] for part in start])
    while block.ncols() < min(_ENCLOSED, count):
        block = arb_mat([row + new for row, new in zip(block.tolist(), (power * block).tolist(), strict=True)])
        power = power * power
    first = _whole(block, kept)
    if first is None:
        return None
    lines, columns = [_packed(row, width) for row in first], len(first[0])
    ones, off, most = _packed([fmpz(1)] * columns, width), 2, max(abs(int(x)) for row in first for x in row) + 2
    while columns < count:
        table = _whole(power, bits)
        if table is None:
            return None
        norm = max(int(sum(map(abs, row))) for row in table)
        if norm * most >= 1 << (width - 2):
            return None
        more = min(columns, count - columns)
        fields = fmpz(1) << width * more
        ones_there = ones % fields
        news = _combined(table, lines, ones_there, fields, width, bits)
        lines = [line + (new << width * columns) for line, new in zip(lines, news, strict=True)]
        ones += ones_there << width * columns
        off = max(off, (((norm + 2 * order) * off + 2 * order * most) >> bits) + 1)
        most, columns, power = max(most, (norm * most >> bits) + 1), columns + more, power * power
    if signals is not None:
        table = [[fmpz((part.numerator << bits) // part.denominator) for part in row] for row in signals]
        norm = max(int(sum(map(abs, row))) for row in table)
        if norm * most >= 1 << (width - 2):
            return None
        lines = _combined(table, lines, ones, fmpz(1) << width * columns, width, bits)
        off, most = (((norm + order) * off + order * most) >> bits) + 2, (norm * most >> bits) + 1
    words = ((most + (1 << kept - 1)) >> kept).bit_length() // 64 + 1  # of what is rounded
    if off >= 1 << (kept - 1) or 64 * words >= width - kept:
        return None
    half, low, above = ones << (width - 1), ones << (kept + 62), (ones << width) - (ones << (kept + 63))
    rounded = [line + (ones << (kept - 1)) for line in lines]
    return [_fields(x + half, width, kept, columns, 1 if (x + low) & above == 0 else words)[:count] for x in rounded]


def _combined(table: list[list[Any]], lines: list[Any], ones: fmpz, fields: fmpz, width: int, bits: int) -> list[Any]:
    """Return sums of lines, field by field, times numbers in parts of 2⁻ᵇⁱᵗˢ; each field is rounded down."""
    high, mask = ones << (width - 1), (ones << (width - bits)) - ones
    products = fmpz_mat(table) * fmpz_mat([[line % fields] for line in lines])
    return [((((x + high) % fields) >> bits) & mask) - (high >> bits) for x in products.entries()]


def _fields(line: fmpz, width: int, kept: int, count: int, words: int) -> list[int]:
    """Return the first fields of a long integer, rounded down to whole numbers of so many words; `kept` bits are fractions.

    What is added to a field above these words does not matter.
    """
    size, native = width // 64, int(line >> kept).to_bytes(width // 8 * count, sys.byteorder)

    def word(k: int, kind: Literal["q", "Q"]) -> list[int]:
        whole = memoryview(native).cast(kind)
        return (whole[k::size] if sys.byteorder == "little" else whole[-1 - k :: -size]).tolist()

    values = word(words - 1, "q")
    for k in reversed(range(words - 1)):
        values = [(high << 64) + low for high, low in zip(values, word(k, "Q"), strict=True)]
    return values


def _whole(balls: arb_mat, bits: int) -> list[list[Any]] | None:
    """Return enclosures in parts of 2⁻ᵇⁱᵗˢ, off by at most two; None where they are wider."""
    scaled = balls * arb(2) ** bits
    near = scaled.mid()
    if not (near + _units(near.nrows(), near.ncols())).contains(scaled):
        return None
    return [[entry.floor().unique_fmpz() for entry in row] for row in near.tolist()]


@lru_cache(maxsize=64)
def _units(rows: int, columns: int) -> arb_mat:
    """Return a matrix of entries 0 ± 1."""
    return arb_mat(rows, columns, [arb(0, 1)] * (rows * columns))


def _packed(fields: Sequence[fmpz], width: int) -> fmpz:
    """Return Σ xᵢ 2^(width i)."""
    total = fmpz(0)
    for field in reversed(fields):
        total = (total << width) + field
    return total


def _ball(value: Scalar) -> arb:
    """Return an enclosure of a number."""
    if value.is_constant:
        return arb(fmpq(number_of(value.numerator_part), number_of(value.denominator_part)))
    return polynomial_ball(value.numerator, {}) / polynomial_ball(value.denominator, {})
