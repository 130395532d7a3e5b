"""Exact values at a random point modulo a prime: the arithmetic in which large claims are checked.

A polynomial identity of total degree d that is false survives a random point of {0, …, 2⁶¹−1}ᵏ with probability at most
d / 2⁶¹ (Schwartz and Zippel); an integer identity of height h survives a random 62-bit prime with probability at
most h / (61 · 4·10¹⁶), there being more than 4·10¹⁶ such primes.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from flint import fmpz, fmpz_mat, nmod, nmod_mat

if TYPE_CHECKING:
    import random
    from collections.abc import Iterable

    from symobs.exact.matrix import Matrix
    from symobs.exact.scalar import Scalar

POINT_BITS = 61
PRIME_BITS = 62
PRIMES_BELOW = 4 * 10**16


class VanishingDenominator(Exception):
    """A denominator is zero at this point."""


class Point:
    """A value for every name, modulo one prime."""

    __slots__ = ("bits", "prime", "values")

    def __init__(self, names: Iterable[str], generator: random.Random) -> None:
        """Draw a prime of 62 bits and a residue for each name."""
        self.prime = random_prime(generator)
        self.values = {name: generator.getrandbits(POINT_BITS) for name in sorted(names)}
        self.bits: dict[int, tuple[int, int]] = {}

    def scalar(self, value: Scalar) -> int:
        """Return the residue of a scalar; the sizes of the integers it comes from are kept in `bits`."""
        arguments = [self.values[name] for name in value.field.names]
        above, below = value.numerator_part(*arguments), value.denominator_part(*arguments)
        self.bits[id(value)] = above.bit_length(), below.bit_length()
        return int(above % self.prime) * self._inverse(below) % self.prime

    def matrix(self, value: Matrix) -> nmod_mat:
        """Return the matrix of residues; the sizes of the integers it comes from are kept in `bits`."""
        arguments = [self.values[name] for name in value.field.names]
        below = value.denominator(*arguments)
        if isinstance(value.table, fmpz_mat):
            entries = value.table.entries()
            table = nmod_mat(value.table, self.prime)
        else:
            entries = [entry(*arguments) for row in value.table for entry in row]
            table = nmod_mat(*value.shape, [int(entry % self.prime) for entry in entries], self.prime)
        self.bits[id(value)] = max((entry.bit_length() for entry in entries), default=0), below.bit_length()
        return table * nmod(self._inverse(below), self.prime)

    def _inverse(self, number: fmpz) -> int:
        residue = int(number % self.prime)
        if not residue:
            raise VanishingDenominator
        return pow(residue, -1, self.prime)


def random_prime(generator: random.Random) -> int:
    """Return a random prime of 62 bits."""
    while True:
        candidate = generator.getrandbits(PRIME_BITS) | 1 << (PRIME_BITS - 1) | 1
        if fmpz(candidate).is_prime():
            return candidate


def scaled(matrix: nmod_mat, factor: int, prime: int) -> nmod_mat:
    """Return the matrix times a residue."""
    return matrix * nmod(factor, prime)


def block(rows: list[list[nmod_mat | int]], prime: int) -> nmod_mat:
    """Return the matrix of blocks; integers are 1×1 blocks."""
    lines: list[list[int]] = []
    for parts in rows:
        tables = [
            [[part]] if isinstance(part, int) else [list(map(int, row)) for row in part.tolist()] for part in parts
        ]
        lines += [[entry for table in tables for entry in table[i]] for i in range(len(tables[0]))]
    return nmod_mat(len(lines), len(lines[0]), [entry for line in lines for entry in line], prime)
