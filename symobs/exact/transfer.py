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
    characteristic = A.characteristic_polynomial(variable)
    field = A.field | b.field | c.field
    if not field.names:
        moved = (A - b @ c).characteristic_polynomial(variable)
        return moved - characteristic + d * characteristic, characteristic
    return _bordered(A, b, c, field, variable) + d * characteristic, characteristic


def _bordered(A: Matrix, b: Matrix, c: Matrix, field: Field, variable: str) -> Scalar:
    """Return c adj(sI − A) b = −det [sI − A, b; c, 0], each block over its own denominator."""
    field = field | Field.of((variable,))
    A, b, c = A.within(field), b.within(field), c.within(field)
    diagonal = field.context.gen(field.position[variable]) * A.denominator
    order = A.shape[0]
    rows = [
        (*((diagonal - e) if i == j else -e for j, e in enumerate(row)), b.table[i][0])  # type: ignore[index]
        for i, row in enumerate(A.table)  # type: ignore[arg-type]
    ]
    border = (*c.table[0], field.zero)  # type: ignore[index]
    value = -ring.determinant((*rows, border), field)
    return Scalar.reduced(field, value, A.denominator ** (order - 1) * b.denominator * c.denominator)
