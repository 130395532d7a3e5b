"""Transfer functions, without an inverse over the field."""

from __future__ import annotations

from symobs.exact.core import ring
from symobs.exact.core.field import Field
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar


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
