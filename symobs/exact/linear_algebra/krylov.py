"""Krylov rows c, cA, …, cAⁿ⁻¹: the observability matrix, its determinant and Ackermann's gain, fraction-free.

Row k is kept as an integral row over its own denominator dₖ, so 𝒪 = diag(1/dₖ) N, det 𝒪 = det N / Π dₖ and 𝒪⁻¹ eₙ =
dₙ₋₁ N⁻¹ eₙ.
"""

from __future__ import annotations

from functools import cached_property
from math import lcm
from typing import TYPE_CHECKING, Any

from flint import fmpq_mat, fmpz, fmpz_mat, nmod_mat

from symobs.exact.core import ring
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.modular import LARGEST_PRIME
from symobs.exact.core.ring import number_of
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from flint import fmpz_mpoly

    from symobs.exact.core.field import Field


@dataclass
class Krylov:
    """The observability matrix of a pair (A, c) with one output row."""

    A: Matrix
    rows: tuple[Matrix, ...]

    @staticmethod
    def of(A: Matrix, c: Matrix) -> Krylov:
        """Form the rows by products of row and matrix."""
        field = A.field | c.field
        A, row = A.within(field), c.within(field)
        rows = [row]
        for _ in range(A.shape[0] - 1):
            rows.append(_times(rows[-1], A))
        return Krylov(A, tuple(rows))

    def __reduce__(self) -> tuple[object, ...]:
        return (Krylov, (self.A, self.rows))  # without what is cached: FLINT's polynomials do not pickle

    @property
    def field(self) -> Field:
        """The field of the entries."""
        return self.A.field

    @property
    def is_singular(self) -> bool:
        """Whether det 𝒪 is 0 identically: a determinant that is not 0 modulo a prime is not 0."""
        if self.field.names:
            return not self._integral_determinant
        return int(nmod_mat(self._numbers, LARGEST_PRIME).det()) == 0 and self._numbers.det() == 0

    @cached_property
    def _numbers(self) -> fmpz_mat:
        """N where there is no parameter."""
        order = len(self.rows)
        return fmpz_mat(order, order, [entry for row in self.rows for entry in row.table.entries()])  # type: ignore[union-attr]

    @cached_property
    def matrix(self) -> Matrix:
        """𝒪."""
        return Matrix.block([[row] for row in self.rows])

    @cached_property
    def _last_cofactors(self) -> tuple[fmpz_mpoly, ...]:
        """The cofactors of N's last row."""
        return ring.cofactors(tuple(row.polynomials[0] for row in self.rows), len(self.rows) - 1, self.field)

    @cached_property
    def determinant(self) -> Scalar:
        """The determinant of 𝒪."""
        bottom = self.field.one
        for row in self.rows:
            bottom = bottom * row.denominator
        return Scalar.reduced(self.field, self._integral_determinant, bottom)

    @cached_property
    def _integral_determinant(self) -> fmpz_mpoly:
        """The determinant of N."""
        if not self.field.names:
            return self.field.context.constant(self._numbers.det())
        found = ring.dot(self.rows[-1].polynomials[0], self._last_cofactors, self.field.zero)
        return self.field.normal(found)

    def placing(self, coefficients: Sequence[Fraction]) -> Matrix:
        """Return φ(A) 𝒪⁻¹ eₙ for a plant with numbers, φ given by its coefficients, highest power first.

        It solves 𝒪 l = b with bₖ = c Aᵏ φ(A) 𝒪⁻¹ eₙ.  The numbers c Aᵏ 𝒪⁻¹ eₙ are 0, …, 0, 1 and go on as the power
        series of 1/χ, coefficients reversed, so b is that of φ/χ: one system with short numbers on the right, and no
        product with the long ones of its solution.  Raises ZeroDivisionError where det 𝒪 = 0.
        """
        order, table = len(self.rows), self.A.table
        assert isinstance(table, fmpz_mat)  # noqa: S101 - an invariant of the rationals
        scale = number_of(self.A.denominator)
        above, below = _scaled(coefficients, scale), table.charpoly().coeffs()[::-1]
        series = [above[0]]
        for k in range(1, order + 1):
            known = sum((below[i] * series[k - i] for i in range(1, k + 1)), fmpz(0))
            series.append(above[k] - known)
        common = lcm(*(coefficient.denominator for coefficient in coefficients))
        found: Any = self._numbers.solve(fmpz_mat(order, 1, series[1:]))  # `fmpq_mat`, which its stub does not say
        solution, number = found.numer_denom()
        factor = number_of(self.rows[0].denominator)
        bottom = self.field.context.constant(number * scale * common)
        return Matrix(self.field, solution * factor, bottom, (order, 1)).normal()

    def solve_last(self) -> Matrix:
        """Return 𝒪⁻¹ eₙ; raises ZeroDivisionError where det 𝒪 = 0 identically."""
        order = len(self.rows)
        scale = self.rows[-1].denominator
        if not self.field.names:
            unit = fmpz_mat(order, 1, [int(i == order - 1) for i in range(order)])
            table, number = fmpq_mat(self._numbers).solve(fmpq_mat(unit)).numer_denom()
            solution = Matrix(self.field, table, self.field.context.constant(number), (order, 1))
            return solution.scaled(scale).normal()
        below = self._integral_determinant
        if not below:
            raise ZeroDivisionError("not observable")
        column = tuple((cofactor * scale,) for cofactor in self._last_cofactors)
        return Matrix(self.field, column, below, (order, 1))


def _times(row: Matrix, A: Matrix) -> Matrix:
    """Return row · A; numeric rows are not reduced and stay integral over known denominators."""
    if isinstance(row.table, fmpz_mat) and isinstance(A.table, fmpz_mat):
        return Matrix(A.field, row.table * A.table, row.denominator * A.denominator, row.shape)
    return row @ A


def _scaled(coefficients: Sequence[Fraction], scale: fmpz) -> list[fmpz]:
    """Return the integral coefficients of a multiple of dⁿ φ(s/d), the polynomial of d · A where φ is that of A."""
    common = lcm(*(coefficient.denominator for coefficient in coefficients))
    power, found = fmpz(1), []
    for coefficient in coefficients:
        found.append(coefficient.numerator * (common // coefficient.denominator) * power)
        power *= scale
    return found
