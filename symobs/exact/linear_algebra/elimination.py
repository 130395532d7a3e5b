"""Rank, kernel and bases by fraction-free elimination."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flint import fmpz_mat, fmpz_mpoly

from symobs.exact.core import ring
from symobs.exact.core.matrix import Matrix, build
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals.ideal import Ideal, TooLarge

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from symobs.exact.core.field import Field

#: The most terms of an entry that an elimination modulo relations may meet.
TERMS = 400


def echelon(matrix: Matrix, relations: Ideal | Scalar | None = None) -> tuple[tuple[int, ...], tuple[Matrix, ...]]:
    """Return (pivot columns, basis of the kernel), where `relations` = 0 hold if any are given.

    The kernel vectors are columns with polynomial entries without common factor.  What lies in the ideal of the
    relations counts as zero; both answers are sure where no pivot vanishes, and everywhere in general where the ideal
    is prime (of a single relation: where it is irreducible).  Raises `TooLarge` where relations are given and an entry
    grows beyond `TERMS`.
    """
    if isinstance(relations, Scalar):
        relations = Ideal.of([relations])
    field = matrix.field if relations is None else matrix.field | relations.field
    rows = matrix.within(field).polynomials

    def vanishes(entry: fmpz_mpoly) -> bool:
        if not entry or relations is None:
            return not entry
        if len(entry) > TERMS:
            message = "an entry is too long to be decided"
            raise TooLarge(message)
        return Scalar(field, entry, field.one) in relations

    pivots, reduced = ring.echelon(rows, vanishes, field)
    columns = range(matrix.shape[1])
    kernel = [_kernel_vector(j, pivots, reduced, field, vanishes, len(columns)) for j in columns if j not in pivots]
    return tuple(pivots), tuple(kernel)


def _kernel_vector(
    free: int,
    pivots: list[int],
    reduced: list[list[fmpz_mpoly]],
    field: Field,
    vanishes: Callable[[fmpz_mpoly], bool],
    columns: int,
) -> Matrix:
    """Solve for the pivot components, the free component being the common multiple of the pivots."""
    bound = [(row, pivot) for row, pivot in zip(reduced, pivots, strict=True) if not vanishes(row[free])]
    common = field.one
    for row, pivot in bound:
        common = ring.common_multiple(common, row[pivot])
    vector = [field.zero] * columns
    vector[free] = common
    for row, pivot in bound:
        vector[pivot] = -row[free] * (common / row[pivot])
    shared = field.zero
    for entry in vector:
        shared = shared.gcd(entry)
    return build(field, tuple((entry / shared,) for entry in vector), field.one, (columns, 1))


def rank(matrix: Matrix, relations: Ideal | None = None) -> int:
    """Return the rank over the field: for parameters, the generic rank (where the relations hold)."""
    if isinstance(matrix.table, fmpz_mat):
        return int(matrix.table.rank())
    return len(echelon(matrix, relations)[0])


def modulo(matrix: Matrix, relations: Ideal | None) -> Matrix:
    """Return a matrix with its entries simplified by relations."""
    if relations is None or not matrix.names:
        return matrix
    return Matrix.of([[relations.simplified(entry) for entry in row] for row in matrix.rows], matrix.shape[1])


def kernel(matrix: Matrix, relations: Ideal | None = None) -> Matrix:
    """Return a basis of {v : M v = 0} as columns (where the relations hold); no columns where it is trivial."""
    vectors = echelon(matrix, relations)[1]
    return Matrix.of([[v[i, 0] for v in vectors] for i in range(matrix.shape[1])], len(vectors))


def primitive_kernel(matrix: Matrix, relations: Ideal | None, order: Sequence[int] = ()) -> Matrix:
    """Return the basis of `kernel` in the normal form of the relations, eliminated with the columns in some order.

    The columns are polynomials without common factor.
    """
    order = order or range(matrix.shape[1])
    columns = []
    for vector in echelon(matrix.select(range(matrix.shape[0]), order), relations)[1]:
        entries = [vector[order.index(i), 0] for i in range(len(order))]
        columns.append(primitive(entries if relations is None else relations.reduced_column(entries)))
    return Matrix.of([[column[i] for column in columns] for i in range(len(order))], len(columns))


def primitive(entries: Iterable[Scalar]) -> list[Scalar]:
    """Return a vector of rational functions as polynomials without common factor, the first coefficient positive."""
    entries = list(entries)
    whole = Matrix.column(entries)
    entries = [(entry * whole.common_denominator()) for entry in entries]
    field = Matrix.column(entries).field
    shared = field.zero
    for entry in entries:
        shared = shared.gcd(entry.within(field).numerator_part)
    return entries if not shared else [entry / Scalar(field, shared, field.one) for entry in entries]


def independent_rows(matrix: Matrix, relations: Ideal | None = None) -> tuple[int, ...]:
    """Return as many rows as the rank, chosen so that they are independent (where the relations hold)."""
    return echelon(matrix.T, relations)[0] if matrix.shape[1] else ()


def unit_rows(order: int, rows: tuple[int, ...]) -> Matrix:
    """Return the rows eᵢᵀ of the identity."""
    return Matrix.of([[int(j == i) for j in range(order)] for i in rows], order)


def reduced_echelon(matrix: Matrix) -> tuple[tuple[int, ...], Matrix]:
    """Return (pivot columns, row-reduced echelon form without its zero rows)."""
    pivots, reduced = ring.echelon(matrix.polynomials, lambda entry: not entry, matrix.field)
    field, one = matrix.field, matrix.field.one
    rows = [
        [Scalar(field, entry, one) / Scalar(field, row[pivot], one) for entry in row]
        for row, pivot in zip(reduced, pivots, strict=True)
    ]
    return tuple(pivots), Matrix.of(rows, matrix.shape[1])
