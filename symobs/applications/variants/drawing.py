r"""What variants are drawn from: a stream of numbers that is the same for ever, parameters, and constructions.

The stream `variants/1`: words made by SHA-256 of seed, candidate, name and number, the same on every machine for ever.

Word k of the draw `name` for candidate c of seed S is the first eight bytes, as a big-endian number, of

    SHA-256("symobs-variants/1\n" + S + "\n" + c + "\n" + name + "\n" + k)

Nothing here may change: a variant is made again from its seed and its number.  Another stream needs another version.
"""

from __future__ import annotations

import hashlib
from functools import lru_cache, reduce
from itertools import product
from math import gcd
from operator import mul
from typing import TYPE_CHECKING, TypeAlias, TypeVar

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence


# Matrices and polynomials of whole numbers in Python's own arithmetic: the cheap tests need nothing else.
#
# A matrix is a tuple of rows. A polynomial is the tuple of its coefficients, the constant first.


Rows: TypeAlias = tuple[tuple[int, ...], ...]
Poly: TypeAlias = tuple[int, ...]


# -- matrices ---------------------------------------------------------------------------------------------------------


def rows_of(table: Iterable[Iterable[int]]) -> Rows:
    """Return a table as rows."""
    return tuple(tuple(row) for row in table)


def identity(order: int) -> Rows:
    """Return I."""
    return rows_of((int(i == j) for j in range(order)) for i in range(order))


def transposed(rows: Rows) -> Rows:
    """Return the transpose."""
    return tuple(zip(*rows, strict=True))


def times(left: Rows, right: Rows) -> Rows:
    """Return the product of two matrices."""
    columns = transposed(right)
    return tuple([tuple([sum(map(mul, row, column)) for column in columns]) for row in left])


def plus(left: Rows, right: Rows, factor: int = 1) -> Rows:
    """Return left + factor·right."""
    return tuple(
        [tuple([a + factor * b for a, b in zip(*rows, strict=True)]) for rows in zip(left, right, strict=True)]
    )


def block(blocks: Sequence[Sequence[Rows]]) -> Rows:
    """Return the matrix made of blocks."""
    return tuple(sum(parts, ()) for row in blocks for parts in zip(*row, strict=True))


def zeros(height: int, width: int) -> Rows:
    """Return a matrix of zeros."""
    return ((0,) * width,) * height


def determinant(rows: Rows) -> int:
    """Return the determinant without fractions (Bareiss)."""
    table, sign, before = [list(row) for row in rows], 1, 1
    order = len(table)
    for k in range(order - 1):
        pivot = next((i for i in range(k, order) if table[i][k]), None)
        if pivot is None:
            return 0
        if pivot != k:
            table[k], table[pivot], sign = table[pivot], table[k], -sign
        for i in range(k + 1, order):
            for j in range(k + 1, order):
                table[i][j] = (table[i][j] * table[k][k] - table[i][k] * table[k][j]) // before
        before = table[k][k]
    return sign * table[-1][-1] if order else 1


def adjugate(rows: Rows) -> tuple[Rows, int, Poly]:
    """Return adj M, det M and the characteristic polynomial of M, by Faddeev and LeVerrier."""
    order = len(rows)
    last, coefficients = identity(order), [1]
    for k in range(1, order + 1):
        moved = times(rows, last)
        coefficient = -sum(moved[i][i] for i in range(order)) // k
        coefficients.append(coefficient)
        if k < order:
            last = plus(moved, identity(order), coefficient)
    sign = (-1) ** (order + 1)
    constant = coefficients[-1]
    return plus(zeros(order, order), last, sign), (-1) ** order * constant, tuple(reversed(coefficients))


def characteristic(rows: Rows) -> Poly:
    """Return det(sI − M)."""
    return adjugate(rows)[2]


def inverse(rows: Rows) -> Rows:
    """Return the inverse of a matrix whose determinant is 1 or −1."""
    found, value, _ = adjugate(rows)
    assert value in {1, -1}  # noqa: S101 - by construction
    return plus(zeros(len(rows), len(rows)), found, value)


def companion(polynomial: Poly) -> Rows:
    """Return the companion matrix of a monic polynomial, its last row −a₀ … −a₍ₙ₋₁₎."""
    order = len(polynomial) - 1
    shifted = [[int(j == i + 1) for j in range(order)] for i in range(order - 1)]
    return rows_of([*shifted, [-entry for entry in polynomial[:-1]]])


def krylov(A: Rows, b: Rows) -> Rows:
    """Return [b, A b, …]."""
    columns, found = b, []
    for _ in A:
        found.append(columns)
        columns = times(A, columns)
    return block([found])


def evaluated(polynomial: Poly, A: Rows, vector: Rows) -> Rows:
    """Return p(A) v, by Horner's scheme."""
    value = plus(zeros(len(vector), 1), vector, polynomial[-1])
    for coefficient in reversed(polynomial[:-1]):
        value = plus(times(A, value), vector, coefficient)
    return value


def rank(rows: Rows) -> int:
    """Return the rank."""
    left, found = [list(row) for row in rows], 0
    for j in range(len(rows[0]) if rows else 0):
        pivot = next((row for row in left if row[j]), None)
        if pivot is None:
            continue
        left.remove(pivot)
        found += 1
        left = [[a * pivot[j] - b * row[j] for a, b in zip(row, pivot, strict=True)] for row in left]
    return found


# -- polynomials ------------------------------------------------------------------------------------------------------


def multiplied(*factors: Poly) -> Poly:
    """Return the product of polynomials."""
    found: Poly = (1,)
    for factor in factors:
        after = [0] * (len(found) + len(factor) - 1)
        for i, a in enumerate(found):
            for j, b in enumerate(factor):
                after[i + j] += a * b
        found = tuple(after)
    return found


def of_poles(poles: Iterable[tuple[int, int]]) -> Poly:
    """Return the polynomial of poles (σ, ω): s − σ for a real one, (s − σ)² + ω² for a pair."""
    return multiplied(*((s * s + w * w, -2 * s, 1) if w else (-s, 1) for s, w in poles))


def trimmed(polynomial: Poly) -> Poly:
    """Return a polynomial without leading zeros."""
    found = list(polynomial)
    while found and not found[-1]:
        found.pop()
    return tuple(found)


def primitive(*polynomials: Poly) -> tuple[Poly, ...]:
    """Return polynomials over the greatest common divisor of all their coefficients."""
    content = gcd(*(entry for each in polynomials for entry in each)) or 1
    return tuple(tuple(entry // content for entry in each) for each in polynomials)


def common_divisor(one: Poly, other: Poly) -> Poly:
    """Return the greatest common divisor of two polynomials, primitive."""
    one, other = trimmed(one), trimmed(other)
    while other:
        while len(one) >= len(other):
            shift = (0,) * (len(one) - len(other))
            one = trimmed(tuple(other[-1] * a - one[-1] * b for a, b in zip(one, (*shift, *other), strict=True)))
        one, other = other, primitive(one)[0]
    return primitive(one)[0]


def quotient(polynomial: Poly, divisor: Poly) -> Poly:
    """Return the quotient of a polynomial by a primitive one that divides it."""
    left, found = list(polynomial), []
    while len(left) >= len(divisor):
        factor = left[-1] // divisor[-1]
        found.append(factor)
        for i, entry in enumerate(divisor):
            left[len(left) - len(divisor) + i] -= factor * entry
        left.pop()
    return tuple(reversed(found))


def resultant(one: Poly, other: Poly) -> int:
    """Return the resultant, the determinant of Sylvester's matrix."""
    m, n = len(one) - 1, len(other) - 1
    width = m + n
    shifted = [((0,) * i + tuple(reversed(one)) + (0,) * (width - m - 1 - i)) for i in range(n)]
    shifted += [((0,) * i + tuple(reversed(other)) + (0,) * (width - n - 1 - i)) for i in range(m)]
    return determinant(rows_of(shifted))


# -- unimodular matrices ----------------------------------------------------------------------------------------------


def unimodular(draw: Draw, order: int, steps: int) -> Rows:
    """Return a matrix of determinant ±1: I, so many additions of ±one row to another, perhaps permuted, perhaps signed."""
    rows = [list(row) for row in identity(order)]
    for _ in range(steps if order > 1 else 0):
        i = draw.below(order)
        j = draw.below(order - 1)
        j += j >= i
        factor = draw.one_of((-1, 1))
        rows[i] = [a + factor * b for a, b in zip(rows[i], rows[j], strict=True)]
    if draw.is_heads():
        rows = draw.some_of(rows, order)
    if draw.is_heads():
        signs = [draw.one_of((-1, 1)) for _ in rows]
        rows = [[sign * entry for entry in row] for sign, row in zip(signs, rows, strict=True)]
    return rows_of(rows)


# -- numerators that keep all of it whole -----------------------------------------------------------------------------


@lru_cache(maxsize=1024)
def unit_numerators(chi: Poly, poles: tuple[tuple[int, int], ...]) -> list[Poly]:
    """Return polynomials b of lower degree with Res(χ, b) = ±1.

    Where the poles are distinct and real these are the ones with b(λ) = ±1 at each: all sign patterns are interpolated.
    Otherwise those with coefficients up to 2 are tried.  Then det 𝒪 det 𝒞 = ±1 for the controllable form of b/χ, so that
    both inverses, and with them all gains, are whole.
    """
    real = [pole for pole, imaginary in poles if not imaginary]
    if len(set(real)) == len(chi) - 1:
        found = [_interpolated(real, signs) for signs in product((1, -1), repeat=len(real))]
        return [each for each in found if each is not None]
    tried = product(range(-2, 3), repeat=len(chi) - 1)
    return [each for each in tried if any(each) and resultant(chi, trimmed(each)) in {1, -1}]


def _interpolated(points: Sequence[int], values: Sequence[int]) -> Poly | None:
    """Return the polynomial with these values there if its coefficients are whole (Newton's divided differences)."""
    found: Poly = (0,) * len(points)
    basis: Poly = (1,)
    for point, value in zip(points, values, strict=True):
        at = reduce(lambda total, entry: total * point + entry, reversed(basis), 0)
        now = reduce(lambda total, entry: total * point + entry, reversed(found), 0)
        factor, rest = divmod(value - now, at)
        if rest:
            return None
        padded = (*basis, *(0,) * (len(points) - len(basis)))
        found = tuple(a + factor * b for a, b in zip(found, padded, strict=True))
        basis = multiplied(basis, (-point, 1))
    return found


def each_signed_permutation(order: int) -> Iterator[tuple[tuple[int, ...], tuple[int, ...]]]:
    """Yield every permutation of so many places with every choice of signs."""
    from itertools import permutations  # noqa: PLC0415 - for the keys of what is distinct only

    for places in permutations(range(order)):
        for signs in product((1, -1), repeat=order):
            yield places, signs


VERSION = 1
#: Seeds are the whole numbers up to here.
LARGEST_SEED = 2**63 - 1
_WORDS = 2**64
Item = TypeVar("Item")


class Draw:
    """The words of one draw, in their order."""

    def __init__(self, seed: int, candidate: int, name: str) -> None:
        """Take what the words are made of."""
        self._text = f"symobs-variants/{VERSION}\n{seed}\n{candidate}\n{name}\n"
        self._next = 0

    def word(self) -> int:
        """Return the next word."""
        data = hashlib.sha256(f"{self._text}{self._next}".encode()).digest()
        self._next += 1
        return int.from_bytes(data[:8], "big")

    def below(self, bound: int) -> int:
        """Return a whole number from 0 to below the bound, each as likely: words above the last multiple are left out."""
        limit = bound * (_WORDS // bound)
        while (word := self.word()) >= limit:
            pass
        return word % bound

    def one_of(self, items: Sequence[Item]) -> Item:
        """Return one of the items."""
        return items[self.below(len(items))]

    def some_of(self, items: Sequence[Item], count: int) -> list[Item]:
        """Return so many of the items, none twice: those that Fisher and Yates put at the top first."""
        left = list(items)
        for last in range(len(left) - 1, len(left) - 1 - count, -1):
            other = self.below(last + 1)
            left[last], left[other] = left[other], left[last]
        return left[len(left) - count :]

    def is_heads(self) -> bool:
        """Return true as often as false."""
        return self.below(2) == 1


class Draws:
    """The draws of one candidate, each by its name."""

    def __init__(self, seed: int, candidate: int) -> None:
        """Take the seed and the number of the candidate."""
        self.seed, self.candidate = seed, candidate

    def __getitem__(self, name: str) -> Draw:
        """Return a draw from its first word on."""
        return Draw(self.seed, self.candidate, name)
