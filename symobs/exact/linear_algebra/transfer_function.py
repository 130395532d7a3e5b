"""Transfer functions, without an inverse over the field."""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact.core import ring
from symobs.exact.core.field import Field
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator


def transfer(A: Matrix, b: Matrix, c: Matrix, d: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return (n, χ) with c (sI − A)⁻¹ b + d = n/χ and χ = det(sI − A); common factors are left in."""
    field = A.field | b.field | c.field
    if not field.names or A.shape[0] > ring.MINORS_UP_TO:
        characteristic = A.characteristic_polynomial(variable)
        moved = (A - b @ c).characteristic_polynomial(variable)
        return moved - characteristic + d * characteristic, characteristic
    numerator, characteristic = _bordered(A, b, c, field, variable)
    return numerator + d * characteristic, characteristic


def transfer_matrix(A: Matrix, B: Matrix, C: Matrix, D: Matrix, variable: str) -> tuple[Matrix, Scalar]:
    """Return (N, χ) with C (sI − A)⁻¹ B + D = N/χ and χ = det(sI − A); common factors are left in."""
    order, rows = A.shape[0], []
    for i in range(C.shape[0]):
        c = C.select([i], range(order))
        pairs = [transfer(A, B.select(range(order), [j]), c, D[i, j], variable) for j in range(B.shape[1])]
        rows.append([numerator for numerator, _ in pairs])
    return Matrix.of(rows), A.characteristic_polynomial(variable)


def controller(
    A: Matrix, b: Matrix, c: Matrix, d: Scalar, K: Matrix, L: Matrix, closed: Scalar, variable: str
) -> tuple[Scalar, Scalar]:
    """Return (n, δ) with K (sI − M)⁻¹ L = n/δ and δ = det(sI − M) for the compensator M = A − bK − Lc + LdK.

    `closed` must be det(sI − A + bK) det(sI − A + Lc).  No determinant of M, whose entries are large, is formed: adding
    a column times K, or L times a row, to sI − A leaves n = K adj(sI − A) L as it is; and where z/χ is the plant,
    χ δ + z n = closed.
    """
    field = A.field | b.field | c.field | K.field | L.field | d.field | closed.field
    if not field.names or field.roots or A.shape[0] > ring.MINORS_UP_TO:
        return transfer(A - b @ K - L @ c + L @ K * d, L, K, Scalar.of(0), variable)
    field = field | Field.of((variable,))
    n, chi = (value.within(field) for value in _bordered(A, L, K, field, variable))
    z = transfer(A, b, c, d, variable)[0].within(field)
    phi = closed.within(field)
    below = n.denominator_part * z.denominator_part
    product = phi.numerator_part * below - n.numerator_part * z.numerator_part * phi.denominator_part
    quotient = product * chi.denominator_part / chi.numerator_part  # exact: χ's numerator is primitive
    return n, Scalar.reduced(field, quotient, below * phi.denominator_part)


def _bordered(A: Matrix, b: Matrix, c: Matrix, field: Field, variable: str) -> tuple[Scalar, Scalar]:
    """Return c adj(sI − A) b = −det [sI − A, b; c, 0] and det(sI − A), both from the minors of [sI − A, b]."""
    field = field | Field.of((variable,))
    A, b, c = A.within(field), b.within(field), c.within(field)
    diagonal = field.context.gen(field.position[variable]) * A.denominator
    order = A.shape[0]
    rows = tuple(
        (*((diagonal - e) if i == j else -e for j, e in enumerate(row)), b.polynomials[i][0])
        for i, row in enumerate(A.polynomials)
    )
    shared, rows = ring.strip_row_contents(rows, field)
    minors = ring.maximal_minors(rows, field)
    total = field.zero
    for j, entry in enumerate(c.polynomials[0]):
        minor = minors.get((*range(j), *range(j + 1, order + 1)), field.zero)
        if entry and minor:
            total = total + entry * minor if (order - 1 - j) % 2 == 0 else total - entry * minor
    below = A.denominator ** (order - 1) * b.denominator * c.denominator
    characteristic = minors.get(tuple(range(order)), field.zero) * shared
    return Scalar.reduced(field, total * shared, below), Scalar.reduced(field, characteristic, A.denominator**order)


# Pole and zero polynomial of a matrix of rational functions, from its minors (Smith and McMillan).


def minors(matrix: Matrix, order: int) -> Iterator[Scalar]:
    """Yield the minors of an order that are not 0."""
    for rows in combinations(range(matrix.shape[0]), order):
        for columns in combinations(range(matrix.shape[1]), order):
            value = matrix.select(rows, columns).determinant()
            if not value.is_zero:
                yield value


def pole_and_zero_polynomial(matrix: Matrix, variable: str) -> tuple[Scalar, Scalar]:
    """Return (p, z): p the least common denominator of all minors, z the greatest common divisor of their numerators over p.

    For z the minors of the largest order that does not vanish are written over p.  Both are monic; z is 1 for the matrix 0.
    """
    listed = [list(minors(matrix, order)) for order in range(1, min(matrix.shape) + 1)]
    largest = next((found for found in reversed(listed) if found), [])
    poles = Scalar.of(1)
    for minor in (minor for found in listed for minor in found):
        poles = poles * minor.denominator / _common(poles, minor.denominator, variable)
    zeros = None
    for minor in largest:
        above = (minor * poles).numerator
        zeros = above if zeros is None else _common(zeros, above, variable)
    return _monic(poles, variable), _monic(Scalar.of(1) if zeros is None else zeros, variable)


def _common(left: Scalar, right: Scalar, variable: str) -> Scalar:
    """Return the common factor of two polynomials that contains the variable."""
    quotient = left / right
    shared = left / quotient.numerator
    return _monic(shared, variable) if shared.degree(variable) > 0 else Scalar.of(1)


def _monic(polynomial: Scalar, variable: str) -> Scalar:
    return polynomial / polynomial.coefficients(variable)[0]


# Systems in state space, and a system in the return path of another.


class Realisation(NamedTuple):
    """A system in state space."""

    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix

    def function(self, variable: str) -> Matrix:
        """Return C (sI − A)⁻¹ B + D."""
        numerators, characteristic = transfer_matrix(*self, variable)
        return Matrix.of([[entry / characteristic for entry in row] for row in numerators.rows])


def closed(plant: Realisation, returned: Realisation) -> Realisation:
    """Return the plant with another system in the return path, negative feedback: u = v − (C₂ x₂ + D₂ y)."""
    A, B, C, D = plant
    through = (Matrix.identity(B.shape[1]) + returned.D @ D).inverse()
    v, state, own = through, through @ returned.D @ C, through @ returned.C
    output, fed = C - D @ state, D @ own
    return Realisation(
        Matrix.block([[A - B @ state, -(B @ own)], [returned.B @ output, returned.A - returned.B @ fed]]).normal(),
        Matrix.block([[B @ v], [returned.B @ D @ v]]).normal(),
        Matrix.block([[output, -fed]]).normal(),
        (D @ v).normal(),
    )
