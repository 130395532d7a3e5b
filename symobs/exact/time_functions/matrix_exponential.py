"""The matrix exponential as a sum of scalar functions times constant matrices.

The entries of e^{At} are sums of the functions tᵏ e^{λt}, and tᵏ e^{σt} cos νt, tᵏ e^{σt} sin(νt)/ν (cosh, sinh), that
the factors of the characteristic polynomial have.  With f the column of these n functions and f′ = D f, the matrices
M of e^{At} = Σ fᵢ Mᵢ follow from the derivatives at 0: Σᵢ (Dᵏ f(0))ᵢ Mᵢ = Aᵏ, k < n.  All of it is rational in the
parameters; square roots stand in the scalar functions only.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact.algebraic.extension import AlgebraicExtension
from symobs.exact.algebraic.polynomial_roots import factored
from symobs.exact.core.field import EIGENVALUE
from symobs.exact.core.generators import ONE, ZERO, square_root
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.polynomial import companion
from symobs.exact.core.scalar import Scalar
from symobs.exact.time_functions.quasipolynomial import Key, Quasipolynomial, matrix_at
from symobs.exact.time_functions.root_sum import RootSum
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.exact.time_functions.quasipolynomial import Table

#: Orders up to which it is computed, without and with parameters.
MOST_STATES, MOST_STATES_WITH_PARAMETERS = 24, 8


class NoClosedForm(ArithmeticError):
    """A factor of the characteristic polynomial has degree 3 or more."""

    def __init__(self, factor: Scalar | None) -> None:
        """Keep the factor; None where the order is too large."""
        super().__init__(str(factor))
        self.factor = factor


class OpenBranch(ArithmeticError):
    """The sign of a discriminant, which decides between real and complex roots, is not known."""

    def __init__(self, discriminant: Scalar) -> None:
        """Keep the discriminant δ of s² − 2σs + σ² − δ."""
        super().__init__(str(discriminant))
        self.discriminant = discriminant


@dataclass(frozen=True)
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


@dataclass(frozen=True)
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


@dataclass(frozen=True)
class Exponential:
    """e^{At} = Σ function · matrix over the parts; a part is (mode, k, the matrices of its one or two functions)."""

    parts: tuple[tuple[Mode | RootMode, int, tuple[Matrix, ...]], ...]
    order: int

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
        zero = Quasipolynomial({})
        rows = [[zero] * self.order for _ in range(self.order)]
        for mode, power, matrices in self.parts:
            if isinstance(mode, RootMode):
                continue
            for f, matrix in zip(mode.functions(power), matrices, strict=True):
                for i in range(self.order):
                    for j in range(self.order):
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
            discriminant = rate * rate - coefficients[2]
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


def exponential(A: Matrix, variable: str, sign: Callable[[Scalar], str], *, sums: bool = False) -> Exponential:
    """Return e^{At}, with `sums` over roots if need be.

    Raises `NoClosedForm` where it has none here, `OpenBranch` where a sign must be known first.
    """
    order = A.shape[0]
    if order > (MOST_STATES_WITH_PARAMETERS if A.names else MOST_STATES):
        raise NoClosedForm(None)
    found = modes_of(A.characteristic_polynomial(variable), variable, sign, sums=sums)
    places = [(mode, k) for mode, multiplicity in found for k in range(multiplicity)]
    D, start = _rates(found)
    columns = [start]
    for _ in range(order - 1):
        columns.append(D @ columns[-1])
    powers = [Matrix.identity(order)]
    for _ in range(order - 1):
        powers.append((powers[-1] @ A).normal())
    W = Matrix.of([list(column.entries) for column in columns])
    right = Matrix.of([list(power.entries) for power in powers])
    solved = W.solve(right).rows
    matrices = [Matrix.of([row[i * order : (i + 1) * order] for i in range(order)]) for row in solved]
    parts, at = [], 0
    for mode, k in places:
        width = len(mode.start)
        own = tuple(matrices[at : at + width])
        at += width
        if any(not matrix.is_zero for matrix in own):
            parts.append((mode, k, own))
    return Exponential(tuple(parts), order)


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
    return Matrix.of(rows), Matrix.column(start)
