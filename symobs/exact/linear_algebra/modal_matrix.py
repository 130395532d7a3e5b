"""The real modal matrix: block diagonal, a block for each elementary divisor over Q(parameters)."""

from __future__ import annotations

from symobs.exact.algebraic.polynomial_roots import factored, roots_of
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar

#: The polynomial of a block: an irreducible factor and its power.
Blocks = tuple[tuple[Scalar, int], ...]


def rotation(factor: Scalar, length: int, variable: str) -> tuple[Scalar, Scalar] | None:
    """Return (σ, ω) of a single factor (s − σ)² + ω² with rational ω."""
    root = roots_of(factor, variable)[0]
    if length != 1 or factor.degree(variable) != 2 or not factor.names <= {variable}:
        return None
    exact = root.exact()
    return None if exact is None or exact.imaginary.is_zero else (exact.real, exact.imaginary)


def modal_matrix(blocks: Blocks, variable: str) -> Matrix:
    """Return the block diagonal matrix of these polynomials.

    A linear factor gives a Jordan block, (s − σ)² + ω² with rational ω the block [σ ω; −ω σ], and any other factor of degree
    d companion blocks (ones below the diagonal, the last column −a_d … −a₁), joined by a 1 where the power is above 1.
    """
    order = sum(factor.degree(variable) * length for factor, length in blocks)
    table = [[Scalar.of(0)] * order for _ in range(order)]
    start = 0
    for factor, length in blocks:
        degree = factor.degree(variable)
        for i, row in enumerate(_block(factor, length, variable)):
            for j, entry in enumerate(row):
                table[start + i][start + j] = entry
        start += degree * length
    return Matrix.of(table, order)


def _block(factor: Scalar, length: int, variable: str) -> list[list[Scalar]]:
    turn = rotation(factor, length, variable)
    if turn is not None:
        centre, speed = turn
        return [[centre, speed], [-speed, centre]]
    degree = factor.degree(variable)
    coefficients = list(reversed(factor.coefficients(variable)[1:]))
    order = degree * length
    table = [[Scalar.of(0)] * order for _ in range(order)]
    for k in range(length):
        first = k * degree
        for i in range(degree):
            if i:
                table[first + i][first + i - 1] = Scalar.of(1)
            table[first + i][first + degree - 1] = -coefficients[i]
        if k:  # A of the last vector of a block has a part in the block before it
            table[first - degree][first + degree - 1] = Scalar.of(1)
    return table


def cyclic_vector(blocks: Blocks, variable: str) -> Matrix:
    """Return b for which (A, b) is controllable, A the modal matrix of blocks of different factors: 1 once in each block."""
    entries: list[Scalar] = []
    for factor, length in blocks:
        degree = factor.degree(variable)
        first = degree * (length - 1) if rotation(factor, length, variable) is None else 1
        entries += [Scalar.of(int(k == first)) for k in range(degree * length)]
    return Matrix.column(entries)


def modal_realisation(A: Matrix, B: Matrix, C: Matrix, variable: str) -> tuple[Matrix, Matrix, Matrix]:
    """Return a controllable single-input system in modal form, B with a 1 in each block, so that C has the residues."""
    blocks = tuple(factored(A.characteristic_polynomial(variable), variable).factors)
    modal, b = modal_matrix(blocks, variable), cyclic_vector(blocks, variable)
    own, other = (_controllability_matrix(*pair) for pair in ((A, B), (modal, b)))
    return modal, b, (C @ own @ other.inverse()).normal()


def _controllability_matrix(A: Matrix, b: Matrix) -> Matrix:
    columns = [b]
    for _ in range(A.shape[0] - 1):
        columns.append((A @ columns[-1]).normal())
    return Matrix.block([columns])
