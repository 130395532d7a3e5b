"""Changes of coordinates x̄ = T x: bases of the controllable and unobservable subspaces, and their page parts."""

from __future__ import annotations

from symobs.exact import Ideal, Matrix, Scalar, echelon, independent_rows, kernel, modulo, transfer
from symobs.tasks.analysis.rank.observability import power_rows

#: The four parts in the order of the blocks: controllable and observable, controllable and not observable, and so on.
BLOCKS = ("co", "c_no", "nc_o", "nc_no")


def basis(A: Matrix, B: Matrix, C: Matrix, ideal: Ideal | None = None) -> tuple[Matrix, tuple[int, ...]]:
    """Return S, whose columns are bases of the four parts in the order of `BLOCKS`, and their dimensions."""
    order = A.shape[0]
    reach = modulo(power_rows(A.T, B.T).T, ideal)
    R = reach.select(range(order), echelon(reach, ideal)[0])
    O = modulo(power_rows(A, C), ideal)
    hidden = kernel(O, ideal)
    both = (R @ kernel(O @ R, ideal)).normal() if R.shape[1] else Matrix.zeros(order, 0)
    both = _primitive(modulo(both, ideal))
    seen = _extension(both, _unit_first(R, ideal), ideal)
    rest_hidden = _extension(_beside(both, seen), hidden, ideal)
    others = _extension(_beside(both, seen, rest_hidden), Matrix.identity(order), ideal)
    parts = (seen, both, others, rest_hidden)
    return _beside(*parts).normal(), tuple(part.shape[1] for part in parts)


def _beside(*parts: Matrix) -> Matrix:
    return Matrix.block([list(parts)])


def _unit_first(R: Matrix, ideal: Ideal | None) -> Matrix:
    """Return other generators of the image of R, unit vectors of it first."""
    order = R.shape[0]
    units = []
    for i in range(order):
        unit = Matrix.unit(order, i)
        if R.shape[1] and len(echelon(_beside(R, unit), ideal)[0]) == R.shape[1]:
            units.append(unit)
    return _beside(*units, R) if units else R


def _primitive(vectors: Matrix) -> Matrix:
    """Return each column without its common denominator."""
    columns = [vectors.select(range(vectors.shape[0]), [j]) for j in range(vectors.shape[1])]
    if not columns:
        return vectors
    return _beside(*((column * column.common_denominator()).normal() for column in columns))


def _extension(given: Matrix, candidates: Matrix, ideal: Ideal | None) -> Matrix:
    """Return the candidates that extend given independent columns to a basis of what all of them span."""
    count, rows = given.shape[1], range(given.shape[0])
    pivots, _ = echelon(_beside(given, candidates), ideal)
    return candidates.select(rows, [j - count for j in pivots if j >= count])


def minor_of(matrix: Matrix, rank: int, ideal: Ideal | None = None) -> Matrix | None:
    """Return a square submatrix of full rank, which must have as many columns as the rank; None where that is 0."""
    if not rank:
        return None
    return matrix.select(independent_rows(matrix, ideal), range(rank))


def transfer_matrix(A: Matrix, B: Matrix, C: Matrix, D: Matrix, variable: str) -> Matrix:
    """Return C (sI − A)⁻¹ B + D, each entry in lowest terms."""
    order, (outputs, inputs) = A.shape[0], D.shape

    def entry(i: int, j: int) -> Scalar:
        if not order:
            return D[i, j]
        numerator, denominator = transfer(
            A, B.select(range(order), [j]), C.select([i], range(order)), D[i, j], variable
        )
        return numerator / denominator

    return Matrix.of([[entry(i, j) for j in range(inputs)] for i in range(outputs)], inputs)
