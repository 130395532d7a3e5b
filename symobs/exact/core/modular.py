"""Exact values at a random point modulo a prime, for the randomised check of large claims.

A polynomial identity of total degree d that is false survives a random point of {0, …, 2⁶¹−1}ᵏ with probability at most
d / 2⁶¹ (Schwartz and Zippel); an integer identity of height h survives a random prime of w bits with probability at
most h / ((w − 1) N), N a lower bound for their number: 2·10¹⁷ for w = 64.  FLINT's word has 32 bits on some platforms, and
so have the primes there: π(2³²) − π(2³¹) = 98,182,656 of them, and more points are drawn for the same bound.
"""

from __future__ import annotations

import sys
from math import gcd
from typing import TYPE_CHECKING

from flint import fmpz, fmpz_mat, nmod, nmod_mat

from symobs.exact.core.field import Generator

if TYPE_CHECKING:
    import random
    from collections.abc import Iterable

    from flint import fmpz_mpoly

    from symobs.exact.core.matrix import Matrix
    from symobs.exact.core.scalar import Scalar

POINT_BITS = 61
PRIME_BITS = 64 if sys.maxsize > 2**32 else 32
PRIMES_BELOW = 2 * 10**17 if PRIME_BITS == 64 else 9 * 10**7
#: The largest prime of a word.
LARGEST_PRIME = 2**64 - 59 if PRIME_BITS == 64 else 2**32 - 5
_ZERO = fmpz(0)
#: The product of the odd primes below 50: most candidates share one, which is sooner seen than that they are composite.
_SMALL_PRIMES = 3 * 5 * 7 * 11 * 13 * 17 * 19 * 23 * 29 * 31 * 37 * 41 * 43 * 47


class VanishingDenominator(Exception):
    """A denominator is zero at this point, or a number has no square root modulo its prime."""


class Point:
    """A value for every name, modulo one prime; a root of a number has a root modulo the prime for its value.

    An element of Q(√2, …) with k roots that is not 0 has a norm over Q that is not 0, of at most 2ᵏ times the bits that
    bound its conjugates; a prime at which the element vanishes divides the norm.
    """

    __slots__ = ("bits", "prime", "values")

    def __init__(self, names: Iterable[str], generator: random.Random) -> None:
        """Draw a prime of one word and a residue for each name."""
        self.prime = random_prime(generator)
        self.values = {name: generator.getrandbits(POINT_BITS) for name in sorted(names)}
        self.values |= {name: root_modulo(square, self.prime) for name, square in squares_of(self.values).items()}
        self.bits: dict[int, tuple[int, int]] = {}

    def scalar(self, value: Scalar) -> int:
        """Return the residue of a scalar, recording the bit lengths of its integers in `bits`."""
        arguments = [self.values[name] for name in value.field.names]
        above = value.numerator_part(*arguments)
        over, below_bits = self._denominator(value.denominator_part, arguments)
        self.bits[id(value)] = above.bit_length(), below_bits
        return int(above % self.prime) * over % self.prime

    def matrix(self, value: Matrix) -> nmod_mat:
        """Return the matrix of residues, recording the bit lengths of its integers in `bits`."""
        arguments = [self.values[name] for name in value.field.names]
        table = value.table
        if not isinstance(table, fmpz_mat):
            numbers = [entry(*arguments) if entry else _ZERO for row in table for entry in row]
            table = fmpz_mat(*value.shape, numbers)
        over, below_bits = self._denominator(value.denominator, arguments)
        self.bits[id(value)] = max((entry.bit_length() for entry in table.entries()), default=0), below_bits
        residues = nmod_mat(table, self.prime)
        return residues if over == 1 else residues * nmod(over, self.prime)

    def _denominator(self, polynomial: fmpz_mpoly, arguments: list[int]) -> tuple[int, int]:
        """Return the inverse of the residue of a denominator, and the bit length of its value."""
        if polynomial.is_one():
            return 1, 1
        number = polynomial(*arguments)
        residue = int(number % self.prime)
        if not residue:
            raise VanishingDenominator
        return pow(residue, -1, self.prime), number.bit_length()


def squares_of(names: Iterable[str]) -> dict[str, int]:
    """Return the numbers under those of the names that are roots of numbers."""
    return {name: name.function.square for name in names if isinstance(name, Generator) and name.function.square}


def root_modulo(square: int, prime: int) -> int:
    """Return a square root modulo a prime; raises `VanishingDenominator` where there is none."""
    if pow(square, (prime - 1) // 2, prime) != 1:  # Euler's criterion
        raise VanishingDenominator
    return int(fmpz(square).sqrtmod(prime))


def random_prime(generator: random.Random) -> int:
    """Return a random prime of one word, its highest bit set."""
    while True:
        candidate = generator.getrandbits(PRIME_BITS) | 1 << (PRIME_BITS - 1) | 1
        if gcd(candidate, _SMALL_PRIMES) == 1 and fmpz(candidate).is_prime():
            return candidate


def scaled(matrix: nmod_mat, factor: int, prime: int) -> nmod_mat:
    """Return the matrix times a residue."""
    return matrix * nmod(factor, prime)


def block(rows: list[list[nmod_mat | int]], prime: int) -> nmod_mat:
    """Return the matrix of blocks; integers are 1×1 blocks.  Raises ValueError where their sizes do not match."""
    lines: list[list[int]] = []
    for parts in rows:
        tables = [
            [[part]] if isinstance(part, int) else [list(map(int, row)) for row in part.tolist()] for part in parts
        ]
        lines += [[entry for part in line for entry in part] for line in zip(*tables, strict=True)]
    if len({len(line) for line in lines}) > 1:
        message = "rows of blocks differ in width"
        raise ValueError(message)
    return nmod_mat(len(lines), len(lines[0]), [entry for line in lines for entry in line], prime)
