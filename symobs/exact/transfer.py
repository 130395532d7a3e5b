"""Transfer functions of systems with one input and one output, without an inverse over the field."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import ring
from symobs.exact.field import Field
from symobs.exact.scalar import Scalar

if TYPE_CHECKING:
    from symobs.exact.matrix import Matrix


def transfer(A: Matrix, b: Matrix, c: Matrix, d: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return (n, χ) with c (sI − A)⁻¹ b + d = n/χ and χ = det(sI − A); common factors are left in."""
    field = A.field | b.field | c.field
    if not field.names or A.shape[0] > ring.MINORS_UP_TO:
        characteristic = A.characteristic_polynomial(variable)
        moved = (A - b @ c).characteristic_polynomial(variable)
        return moved - characteristic + d * characteristic, characteristic
    numerator, characteristic = _bordered(A, b, c, field, variable)
    return numerator + d * characteristic, characteristic


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
