"""Placing the poles of A − l c for one output row c: what observers use, and state feedback through the dual pair.

Where (c, A) is observable the gain is unique, l = φ(A) 𝒪⁻¹ eₙ.  Where it is not, the unobservable modes stay
whatever l is; φ can
be assigned exactly when their polynomial divides it, and then every gain differs by a vector of ker 𝒪.
"""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Self

from symobs.exact import (
    Field,
    Ideal,
    Matrix,
    Scalar,
    apply_polynomial,
    echelon,
    hankel_of,
    independent_rows,
    modulo,
    primitive_kernel,
    remainder,
    unit_rows,
)
from symobs.exact.linear_algebra.krylov import Krylov
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.system.specification import DesiredPolynomial


@dataclass
class ObserverPair:
    """A matrix A and one output row c."""

    A: Matrix
    c: Matrix
    variable: str
    equations: tuple[Scalar, ...] = ()

    @property
    def ideal(self) -> Ideal | None:
        """What is known to be 0, None where nothing is."""
        return Ideal.of(self.equations) if self.equations else None

    @cached_property
    def krylov(self) -> Krylov:
        """The rows c, cA, … of 𝒪."""
        return Krylov.of(self.A, self.c)

    @cached_property
    def determinant(self) -> Scalar:
        """Det 𝒪."""
        return self.krylov.determinant

    @property
    def decisive(self) -> tuple[Scalar, ...]:
        """What vanishes exactly where an observable pair ceases to be."""
        return (self.determinant,)

    @property
    def is_observable(self) -> bool:
        """Whether det 𝒪 is not 0 identically."""
        if self.krylov.is_singular:
            return False
        return self.ideal is None or self.krylov.determinant not in self.ideal

    @cached_property
    def kernel(self) -> Matrix:
        """A basis of ker 𝒪 as columns; no columns where the pair is observable."""
        return primitive_kernel(self.krylov.matrix, self.ideal)

    @cached_property
    def restricted(self) -> Matrix:
        """X with A N = N X for the kernel basis N: the plant on its unobservable subspace."""
        N = self.kernel
        free = independent_rows(N, self.ideal)
        return modulo(N.select(free, range(N.shape[1])).solve((self.A @ N).select(free, range(N.shape[1]))), self.ideal)

    @cached_property
    def fixed_polynomial(self) -> Scalar:
        """The characteristic polynomial of the unobservable modes; 1 where there is none."""
        if not self.kernel.shape[1]:
            return Scalar.of(1)
        found = self.restricted.characteristic_polynomial(self.variable)
        return found if self.ideal is None else self.ideal.simplified(found)

    def gain(self, desired: DesiredPolynomial) -> Matrix | None:
        """Return l with det(sI − A + l c) = φ(s), or None where φ cannot be assigned."""
        if self.is_observable:
            if not self.krylov.field.names and desired.is_numeric:
                coefficients = desired.polynomial.coefficients(self.variable)
                return self.krylov.placing([coefficient.fraction() for coefficient in coefficients])
            vector = self.krylov.solve_last()
            found = apply_polynomial(desired.factors, desired.variable, self.A, vector)
            return modulo(Matrix.of(found.rows), self.ideal)
        quotient, rest = self.divided(desired.polynomial)
        return self._gain_of_observable_part(quotient) if rest.is_zero else None

    def divided(self, polynomial: Scalar) -> tuple[Scalar, Scalar]:
        """Return quotient and remainder of a division by the polynomial of the fixed modes."""
        quotient, rest = remainder(polynomial, self.fixed_polynomial, self.variable)
        return quotient, rest if self.ideal is None else self.ideal.simplified(rest)

    def can_assign(self, polynomial: Scalar) -> bool:
        """Return whether the polynomial of the fixed modes divides φ."""
        return self.is_observable or self.divided(polynomial)[1].is_zero

    def over_field_of(self, desired: DesiredPolynomial) -> Self:
        """Return the pair over one field with the parameters of φ."""
        names = {name for factor in desired.factors for name in factor.field.names} - {desired.variable}
        field = Field.of((*self.A.field.names, *self.c.field.names, *names))
        return type(self)(self.A.within(field), self.c.within(field), self.variable, self.equations)

    def _gain_of_observable_part(self, polynomial: Scalar) -> Matrix:
        """Place the observable modes; the gain has no component along the free rows of ker 𝒪."""
        order, N = self.A.shape[0], self.kernel
        pivots, _ = echelon(self.krylov.matrix, self.ideal)
        rank = len(pivots)
        if rank == 0:
            return Matrix.zeros(order, 1)
        T = Matrix.block(
            [
                [self.krylov.matrix.select(range(rank), range(order))],
                [unit_rows(order, independent_rows(N, self.ideal))],
            ]
        )
        inverse = T.inverse()
        A, c = modulo(T @ self.A @ inverse, self.ideal), modulo(self.c @ inverse, self.ideal)
        part = ObserverPair(A.select(range(rank), range(rank)), c.select([0], range(rank)), self.variable)
        gain = apply_polynomial([polynomial], self.variable, part.A, part.krylov.solve_last())
        return modulo((inverse @ Matrix.block([[gain], [Matrix.zeros(order - rank, 1)]])).normal(), self.ideal)


# Differences of coefficients carried back from controllable canonical form.


def canonical_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return l with lᵀ = [αₙ − aₙ, …, α₁ − a₁] V⁻¹, V = 𝒪ᵀ · Hankel(a); needs det 𝒪 ≠ 0."""
    found = pair.A.characteristic_polynomial(pair.variable).coefficients(pair.variable)[1:]
    V = pair.krylov.matrix.T @ hankel_of(found)
    differences = [alpha - a for alpha, a in zip(desired.coefficients, found, strict=True)]
    return V.T.solve(Matrix.column(list(reversed(differences)))).normal()


def companion_rows(pair: ObserverPair) -> Matrix:
    """Return T with rows q, qAᵀ, …, q the last row of 𝒞(Aᵀ, Cᵀ)⁻¹: T Aᵀ T⁻¹ is a companion matrix and T Cᵀ = eₙ."""
    rows = [pair.krylov.solve_last().normal().T]
    for _ in range(pair.A.shape[0] - 1):
        rows.append((rows[-1] @ pair.A.T).normal())
    return Matrix.block([[row] for row in rows])


def companion_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return l with lᵀ = [αₙ − aₙ, …, α₁ − a₁] T; needs det 𝒪 ≠ 0."""
    found = pair.A.characteristic_polynomial(pair.variable).coefficients(pair.variable)[1:]
    row = Matrix.row([alpha - a for alpha, a in zip(desired.coefficients, found, strict=True)][::-1])
    return (row @ companion_rows(pair)).T.normal()


# Matching coefficients: det(sI − A + l c) is affine in the entries of l, so l solves a linear system.


class Matching(NamedTuple):
    """The system M l = r: row k compares the coefficients of sⁿ⁻ᵏ."""

    M: Matrix
    r: Matrix

    @property
    def solution(self) -> Matrix:
        """Return l; raises ZeroDivisionError where the pair is not observable."""
        return self.M.solve(self.r).normal()


def matching(pair: ObserverPair, desired: DesiredPolynomial) -> Matching:
    """Return the system; column i is the change of the polynomial of A by a one in row i of l."""
    order, variable = pair.A.shape[0], pair.variable
    own = pair.A.characteristic_polynomial(variable).coefficients(variable)[1:]
    columns = []
    for i in range(order):
        moved = (pair.A - Matrix.unit(order, i) @ pair.c).characteristic_polynomial(variable)
        found = moved.coefficients(variable)[1:]
        columns.append([new - old for new, old in zip(found, own, strict=True)])
    M = Matrix.of([list(row) for row in zip(*columns, strict=True)])
    r = Matrix.column([coefficient - old for coefficient, old in zip(desired.coefficients, own, strict=True)])
    return Matching(M, r)


def matched_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix:
    """Return l."""
    return matching(pair, desired).solution
