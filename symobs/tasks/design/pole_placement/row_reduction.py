"""Pole placement by null vectors of [λI − Aᵀ : Cᵀ] for each pole, put together to Lᵀ = f Ψ⁻¹.

A null vector ξ = [ψ; f] has (λI − Aᵀ)ψ + Cᵀf = 0, so Lᵀψ = f makes ψ an eigenvector of (A − LC)ᵀ.  A pole asked for
again, where no further null vector is independent, takes a generalised vector: the right side is −ψ of the one before.
A conjugate pair a ± bi is kept real: with J = [a b; −b a] and Ψ of two columns, ΨJ − AᵀΨ + Cᵀf = 0 is one system of
twice the size; a factor of φ without such roots has its companion matrix for J.
"""

from __future__ import annotations

from itertools import combinations
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, companion, rank, reduced_echelon, roots_of
from symobs.exact.core.generators import roots_in
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.single_output import ObserverPair


@dataclass
class Reduction:
    """One pole, pair or factor: the matrix, its row-reduced echelon form, and the vectors chosen.

    `before` is the Ψ that a generalised vector goes on from; then both matrices have its negative as a last column.
    """

    J: Matrix
    matrix: Matrix
    reduced: Matrix
    pivots: tuple[int, ...]
    vector: Matrix
    before: Matrix | None
    order: int

    @property
    def size(self) -> int:
        """How many columns belong to it."""
        return self.J.shape[0]

    @property
    def psi(self) -> Matrix:
        """Ψ, of `size` columns."""
        return self._columns(0, self.order)

    @property
    def f(self) -> Matrix:
        """LᵀΨ."""
        return self._columns(self.order * self.size, self.vector.shape[0] // self.size - self.order)

    def _columns(self, start: int, height: int) -> Matrix:
        entries = self.vector.entries
        return Matrix.of(
            [[entries[start + k * height + i] for k in range(self.size)] for i in range(height)], self.size
        )


def row_reduction(pair: ObserverPair, desired: DesiredPolynomial) -> tuple[Reduction, ...] | None:
    """Return one reduction for each factor of φ with independent columns Ψ; the pair must be observable."""
    blocks = [J for factor, power in desired.grouped() for J in [block_of(factor, desired)] * power]
    return _search(pair, blocks, ())


def gain_of(reductions: Sequence[Reduction]) -> Matrix:
    """Return L = (f Ψ⁻¹)ᵀ."""
    psi = Matrix.block([[part.psi for part in reductions]])
    return psi.T.solve(Matrix.block([[part.f for part in reductions]]).T).normal()


def block_of(factor: Scalar, desired: DesiredPolynomial) -> Matrix:
    """Return the real matrix J of a factor."""
    variable = desired.variable
    coefficients = factor.coefficients(variable)[1:]
    if len(coefficients) == 1:
        return Matrix.of([[-coefficients[0]]])
    s = Scalar.symbol(variable)
    rational = (pole for pole in desired.poles if not roots_in(pole.real) and not roots_in(pole.imaginary))
    given = (pole for pole in rational if (s - pole.real) ** 2 + pole.imaginary**2 == factor)
    pair = next(given, None)
    if pair is None and len(coefficients) == 2:
        pair = roots_of(factor, variable)[0].exact()
    if pair is None or pair.is_real:
        return companion(coefficients)
    return Matrix.of([[pair.real, pair.imaginary], [-pair.imaginary, pair.real]])


def _search(pair: ObserverPair, blocks: Sequence[Matrix], found: tuple[Reduction, ...]) -> tuple[Reduction, ...] | None:
    """Take the first vectors that are independent of those before; go back where that leads nowhere."""
    if len(found) == len(blocks):
        return found
    count = sum(part.size for part in found) + blocks[len(found)].shape[0]
    for candidate in _candidates(pair, blocks[len(found)], found):
        if rank(Matrix.block([[part.psi for part in (*found, candidate)]])) == count:
            rest = _search(pair, blocks, (*found, candidate))
            if rest is not None:
                return rest
    return None


def _candidates(pair: ObserverPair, J: Matrix, found: tuple[Reduction, ...]) -> Iterator[Reduction]:
    """Yield null vectors, sums of two of them, then generalised vectors; the free component is 1 and −1 in turn."""
    order, sign = pair.A.shape[0], -1 if len(found) % 2 else 1
    matrix = null_matrix(pair, J)
    pivots, reduced = reduced_echelon(matrix)
    basis = [null_vector(free, pivots, reduced) for free in range(matrix.shape[1]) if free not in pivots]
    for vector in (*basis, *(a + b for a, b in combinations(basis, 2))):
        yield Reduction(J, matrix, reduced, pivots, vector * sign, None, order)
    for before in reversed(found):
        if before.J != J:
            continue
        right = Matrix.column([-entry for entry in before.psi.T.entries])
        wide = Matrix.block([[matrix, right]])
        places, echelon = reduced_echelon(wide)
        entries = [Scalar.of(0)] * matrix.shape[1]
        for row, place in enumerate(places):
            entries[place] = echelon[row, matrix.shape[1]]
        particular = Matrix.column(entries)
        for vector in (particular, *(particular + b for b in basis)):
            yield Reduction(J, wide, echelon, places, vector, before.psi, order)


def null_matrix(pair: ObserverPair, J: Matrix) -> Matrix:
    """Return [λI − Aᵀ : Cᵀ], of a block J the matrix of ΨJ − AᵀΨ + Cᵀf in the columns of Ψ and f."""
    order, outputs, size = pair.A.shape[0], pair.c.shape[0], J.shape[0]
    empty, identity = Matrix.zeros(order, outputs), Matrix.identity(order)
    rows = []
    for j in range(size):
        left = [identity * J[k, j] - pair.A.T if k == j else identity * J[k, j] for k in range(size)]
        rows.append([*left, *(pair.c.T if k == j else empty for k in range(size))])
    return Matrix.block(rows)


def null_vector(free: int, pivots: tuple[int, ...], reduced: Matrix) -> Matrix:
    """Return the null vector whose free component is 1."""
    entries = [Scalar.of(int(i == free)) for i in range(reduced.shape[1])]
    for row, pivot in enumerate(pivots):
        entries[pivot] = -reduced[row, free]
    return Matrix.column(entries)


def reduced_gain(pair: ObserverPair, desired: DesiredPolynomial) -> Matrix | None:
    """Return L of Lᵀ = f Ψ⁻¹, None where no vectors were found."""
    found = row_reduction(pair, desired)
    return None if found is None else gain_of(found)
