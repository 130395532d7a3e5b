"""The real modal form: a basis in which A is block diagonal, a block for each elementary divisor over Q(parameters).

For an irreducible factor q of χ with N = q(A), vectors w are chosen in ker Nᵏ, k falling, that with their images under A
are independent of ker Nᵏ⁻¹ and of what is there already: each gives one block of the polynomial qᵏ, with the basis
Nⁱ Aʲ w (i < k, j < deg q).  For deg q = 1 that is a Jordan block.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, echelon, factored, kernel
from symobs.exact.linear_algebra.modal_matrix import Blocks, rotation
from symobs.tasks.analysis.modes.modes import polynomial_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence


def modal_basis(A: Matrix, chi: Scalar, variable: str) -> tuple[Matrix, Blocks]:
    """Return S, whose columns are the basis block by block, and the polynomials of the blocks."""
    columns: list[Matrix] = []
    blocks: list[tuple[Scalar, int]] = []
    for factor, power in factored(chi, variable).factors:
        N = polynomial_of(factor, variable, A)
        for w, length in _generators(A, N, factor.degree(variable), power):
            columns += _chain(A, N, w, factor, length, variable)
            blocks.append((factor, length))
    return Matrix.block([columns]).normal(), tuple(blocks)


def _generators(A: Matrix, N: Matrix, degree: int, power: int) -> Iterator[tuple[Matrix, int]]:
    """Yield generators of the blocks of one factor, the longest first, each with the length of its chain."""
    kernels = [Matrix.zeros(A.shape[0], 0)]
    for _ in range(power):
        kernels.append(kernel(N if len(kernels) == 1 else _power(N, len(kernels))))
        if kernels[-1].shape[1] == degree * power:
            break
    found: list[tuple[Matrix, int]] = []
    for k in range(len(kernels) - 1, 0, -1):
        span = [kernels[k - 1], *(v for w, length in found for v in _images(A, _apply(N, w, length - k), degree))]
        for j in range(kernels[k].shape[1]):
            w = kernels[k].select(range(A.shape[0]), [j])
            if _rank([*span, w]) == _rank(span):
                continue
            span += _images(A, w, degree)
            found.append((w, k))
            yield w, k


def _power(N: Matrix, exponent: int) -> Matrix:
    power = N
    for _ in range(exponent - 1):
        power = (power @ N).normal()
    return power


def _apply(N: Matrix, w: Matrix, times: int) -> Matrix:
    for _ in range(times):
        w = (N @ w).normal()
    return w


def _images(A: Matrix, w: Matrix, count: int) -> list[Matrix]:
    images = [w]
    for _ in range(count - 1):
        images.append((A @ images[-1]).normal())
    return images


def _rank(vectors: Sequence[Matrix]) -> int:
    return len(echelon(Matrix.block([list(vectors)]))[0])


def _chain(A: Matrix, N: Matrix, w: Matrix, factor: Scalar, length: int, variable: str) -> list[Matrix]:
    """Return the basis of one block: for which `modal_matrix` is A."""
    turn = rotation(factor, length, variable)
    if turn is not None:
        centre, speed = turn
        return [((A @ w - w * centre) * (1 / speed)).normal(), w]
    degree = factor.degree(variable)
    return [v for i in reversed(range(length)) for v in _images(A, _apply(N, w, i), degree)]
