"""Matrices of numbers, in integers over one common denominator, and numbers as multiples of common measures."""

from __future__ import annotations

from fractions import Fraction
from math import gcd, lcm
from typing import TYPE_CHECKING

from flint import fmpz, fmpz_mat

from symobs.exact.core.field import RATIONALS
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.ring import number_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact.core.scalar import Scalar

#: Euclid's algorithm on a few numbers takes as many steps as their quotients have in sum.
_EUCLIDEAN_STEPS = 1000


def matrix_of_numbers(rows: Sequence[Sequence[int | Fraction]]) -> Matrix:
    """Return the matrix with these rows, all of one length and none empty, over their least common denominator."""
    common = lcm(*(entry.denominator for row in rows for entry in row))
    numbers = [entry.numerator * (common // entry.denominator) for row in rows for entry in row]
    shape = (len(rows), len(rows[0]))
    return Matrix(RATIONALS, fmpz_mat(*shape, numbers), RATIONALS.context.constant(common), shape)


def horner(coefficients: Sequence[Scalar], matrix: Matrix, vector: Matrix) -> Matrix:
    """Return Σ cₖ Mⁿ⁻ᵏ v, nothing cancelled: with M = N/d and cₖ = nₖ/b the step is w ← N w + nₖ dᵏ v."""
    table, column = matrix.table, vector.table
    assert isinstance(table, fmpz_mat)  # noqa: S101 - an invariant of the rationals
    assert isinstance(column, fmpz_mat)  # noqa: S101 - the same
    fractions = [coefficient.fraction() for coefficient in coefficients]
    common = lcm(*(fraction.denominator for fraction in fractions))
    first, *others = (fraction.numerator * (common // fraction.denominator) for fraction in fractions)
    image, power, scale = column * first, fmpz(1), number_of(matrix.denominator)
    for number in others:
        power *= scale
        image = table * image
        if number:
            image += column * (number * power)
    below = number_of(vector.denominator) * common * power
    return Matrix(RATIONALS, image, RATIONALS.context.constant(below), vector.shape)


def whole_product(left: Sequence[Sequence[int]], right: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the product of two matrices of whole numbers, given by their rows."""
    return [list(map(int, row)) for row in (fmpz_mat(left) * fmpz_mat(right)).tolist()]


def measures(numbers: Sequence[Fraction], bound: int) -> dict[Fraction, list[tuple[Fraction, int]]]:
    """Return positive numbers as sums of whole multiples of a few positive ones: (measure, multiple) for each.

    One measure is enough, but where it is small the multiples are large.  The relations Σ nᵢ cᵢ = 0 of the numbers that
    are kept have |nᵢ| ≤ `bound`; the others would need a polynomial of such a degree, and count as none.
    """
    below = lcm(*(number.denominator for number in numbers))
    whole = [int(number * below) for number in numbers]
    common = gcd(*whole)
    if whole[-1] // common <= bound:
        return {c: [(Fraction(common, below), count // common)] for c, count in zip(numbers, whole, strict=True)}
    kept = [row for row in _kernel([whole], len(whole)) if max(map(abs, row)) <= bound]
    basis = _kernel(kept, len(whole))
    gram = fmpz_mat([[sum(x * y for x, y in zip(p, q, strict=True)) for p in basis] for q in basis])
    solved = gram.solve(fmpz_mat([[sum(x * y for x, y in zip(p, whole, strict=True))] for p in basis]))
    sizes = [Fraction(int(entry.p), int(entry.q)) / below for entry in solved.entries()]
    basis = [row if size > 0 else [-x for x in row] for row, size in zip(basis, sizes, strict=True)]
    sizes = [abs(size) for size in sizes]
    _turn_positive(basis, sizes)
    return {
        c: [(size, row[i]) for row, size in zip(basis, sizes, strict=True) if row[i] and size]
        for i, c in enumerate(numbers)
    }


def _kernel(rows: Sequence[Sequence[int]], length: int) -> list[list[int]]:
    """Return short vectors that are a basis of the whole-numbered vectors orthogonal to linearly independent rows."""
    weight = (1 << length) * length * max((abs(x) for row in rows for x in row), default=1) ** max(2 * len(rows), 1)
    lattice = [[int(i == j) for j in range(length)] + [weight * row[i] for row in rows] for i in range(length)]
    reduced = [[int(x) for x in row] for row in fmpz_mat(lattice).lll().tolist()]
    return [row[:length] for row in reduced if not any(row[length:])]


def _turn_positive(basis: list[list[int]], sizes: list[Fraction]) -> None:
    """Change a basis by Euclid's algorithm, c = Σ sizeⱼ basisⱼ the same, until no multiple is negative."""
    for _ in range(_EUCLIDEAN_STEPS):
        negative = [(j, i) for j, row in enumerate(basis) if sizes[j] for i, x in enumerate(row) if x < 0]
        if not negative:
            return
        j, i = negative[0]
        other = max(range(len(basis)), key=lambda row: basis[row][i] * sizes[row])
        less, more = sorted((j, other), key=lambda row: sizes[row])
        sizes[more] -= sizes[less]
        basis[less] = [x + y for x, y in zip(basis[less], basis[more], strict=True)]
