"""Algebraic numbers: the field Q(parameters)[λ]/(q) of a root λ of an irreducible polynomial q.

An element is a scalar that is a polynomial in λ; it is kept reduced, of lower degree than q.  Conjugate roots are not told
apart: what holds for λ holds for every root of q.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact.core.matrix import Matrix
from symobs.exact.core.polynomial import from_coefficients
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence


@dataclass
class AlgebraicExtension:
    """The field of a root `name` of an irreducible polynomial in `name`."""

    polynomial: Scalar
    name: str

    @cached_property
    def coefficients(self) -> tuple[Scalar, ...]:
        """The coefficients of q, made monic, highest power first."""
        found = self.polynomial.coefficients(self.name)
        return tuple(c / found[0] for c in found)

    @property
    def degree(self) -> int:
        """The degree of q."""
        return len(self.coefficients) - 1

    def reduce(self, value: Scalar) -> Scalar:
        """Return the remainder of a division by q; raises ZeroDivisionError where the denominator is divisible by q."""
        if self.name in value.denominator.names:
            return self.reduce(value.numerator * self.inverse(value.denominator))
        left = list(value.coefficients(self.name))
        while len(left) > self.degree:
            lead, left = left[0], left[1:]
            if not lead.is_zero:
                for k, c in enumerate(self.coefficients[1:]):
                    left[k] = left[k] - lead * c
        return from_coefficients(left, self.name)

    def inverse(self, value: Scalar) -> Scalar:
        """Return 1/value: the solution y of value · y = 1 among polynomials of lower degree than q."""
        solution = self._multiplication(value).solve(Matrix.unit(self.degree, 0))
        return from_coefficients(list(reversed(solution.entries)), self.name)

    def _multiplication(self, value: Scalar) -> Matrix:
        """Return the matrix of the multiplication by a value in the basis 1, λ, λ², …."""
        columns, image = [], self.reduce(value)
        for _ in range(self.degree):
            columns.append(self._ascending(image))
            image = self.reduce(image * Scalar.symbol(self.name))
        return Matrix.of([[column[i] for column in columns] for i in range(self.degree)])

    def trace(self, value: Scalar) -> Scalar:
        """Return the sum of a value over all roots: the trace of the multiplication by it."""
        table = self._multiplication(value)
        return sum((table[i, i] for i in range(self.degree)), Scalar.of(0))

    def norm(self, value: Scalar) -> Scalar:
        """Return the product of a value over all roots: the determinant of the multiplication by it."""
        return self._multiplication(value).determinant()

    def _ascending(self, value: Scalar) -> list[Scalar]:
        found = list(reversed(value.coefficients(self.name)))
        return found + [Scalar.of(0)] * (self.degree - len(found))

    def reduced(self, matrix: Matrix) -> Matrix:
        """Return a matrix with its entries reduced."""
        return Matrix.of([[self.reduce(entry) for entry in row] for row in matrix.rows], matrix.shape[1])

    def echelon(self, matrix: Matrix) -> tuple[tuple[int, ...], Matrix]:
        """Return (pivot columns, basis of the kernel as columns): Gauss and Jordan's elimination in the field."""
        work = [[self.reduce(entry) for entry in row] for row in matrix.rows]
        pivots: list[int] = []
        for column in range(matrix.shape[1]):
            top = len(pivots)
            candidates = [i for i in range(top, len(work)) if not work[i][column].is_zero]
            if not candidates:
                continue
            best = min(candidates, key=lambda i: (work[i][column].degree(self.name), work[i][column].size))
            work[top], work[best] = work[best], work[top]
            self._clear(work, top, column)
            pivots.append(column)
        return tuple(pivots), self._kernel(work, pivots, matrix.shape[1])

    def _clear(self, work: list[list[Scalar]], top: int, column: int) -> None:
        lead = self.inverse(work[top][column])
        work[top] = [self.reduce(entry * lead) for entry in work[top]]
        for i, line in enumerate(work):
            if i != top and not line[column].is_zero:
                work[i] = [self.reduce(a - line[column] * b) for a, b in zip(line, work[top], strict=True)]

    @staticmethod
    def _kernel(work: Sequence[Sequence[Scalar]], pivots: Sequence[int], columns: int) -> Matrix:
        """Return the vectors whose free component is a common denominator of the others."""
        free = [j for j in range(columns) if j not in pivots]
        vectors = []
        for j in free:
            vector = [Scalar.of(int(i == j)) for i in range(columns)]
            for row, pivot in zip(work, pivots, strict=False):
                vector[pivot] = -row[j]
            common = Matrix.column(vector).common_denominator()
            vectors.append([entry * common for entry in vector])
        return Matrix.of([[vector[i] for vector in vectors] for i in range(columns)], len(free))
