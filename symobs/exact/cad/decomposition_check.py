"""Check of a cylindrical decomposition by independent means (trusted).

Discriminants and resultants are held against Sylvester's determinants at random points modulo random primes of one word, the
numbers of critical lines and of branches against Sturm's theorem.  Where these hold, no curve turns back, runs off to infinity
or meets another between two critical lines, so that every stack stands over its whole cylinder.
"""

from __future__ import annotations

import hashlib
import random
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, TypeAlias

from flint import fmpz_poly, nmod, nmod_mat, nmod_poly

from symobs.exact.algebraic.real_algebraic import RealNumber, root_counter
from symobs.exact.core.modular import PRIME_BITS, random_prime

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from fractions import Fraction

    from symobs.exact.cad.decomposition import Cylinder, Plane

#: How many roots of a polynomial lie in an open interval.
Count: TypeAlias = "Callable[[Fraction | None, Fraction | None], int]"

#: Points at which each determinant is compared: one of 64 bits lets a false value pass with a probability below 10⁻¹⁵.
_POINTS = 2 * 64 // PRIME_BITS


def holds(plane: Plane) -> bool:
    """Return whether the projection is complete and every critical line and branch correctly isolated."""
    return _projection_is_whole(plane) and _walls_are_all(plane) and all(_is_stack(plane, s) for s in plane.cylinders)


def is_line(points: Sequence[RealNumber], factors: Iterable[fmpz_poly]) -> bool:
    """Return whether these are all real roots of irreducible polynomials, in ascending order, by Sturm's theorem."""
    counters = {_key(factor): root_counter(factor) for factor in factors}
    listed: dict[tuple[int, ...], list[int]] = {key: [] for key in counters}
    for point in points:
        key = _key(point.polynomial)
        if key not in counters or not _is_isolated(point, counters[key]):
            return False
        listed[key].append(point.index)
    ascending = all(_before(one, other) for one, other in pairwise(points))
    return ascending and all(listed[key] == list(range(count(None, None))) for key, count in counters.items())


def _key(polynomial: fmpz_poly) -> tuple[int, ...]:
    return tuple(int(c) for c in polynomial.coeffs())


def _is_isolated(point: RealNumber, count: Count) -> bool:
    """Return whether the enclosure of a number contains the root of its index, and no other."""
    if point.is_rational:
        return point.index == 0
    low, high = point.interval()
    return count(low, high) == 1 and count(None, low) == point.index


def _before(one: RealNumber, other: RealNumber) -> bool:
    """Return whether the isolating intervals are disjoint, refining until decided."""
    bits = 64
    while bits <= 1 << 14:
        if one.interval(bits)[1] < other.interval(bits)[0]:
            return True
        bits *= 2
    return False


def _projection_is_whole(plane: Plane) -> bool:
    """Return whether all leading coefficients, discriminants and resultants are products of the factors listed."""
    claimed = {event.curves: event.polynomial for event in plane.events if event.kind != "lead"}
    values = [curve.by_second[-1] for curve in plane.curves]
    risen = [(index, curve.by_second) for index, curve in enumerate(plane.curves) if curve.degree]
    generator = random.Random(_seed(plane))  # noqa: S311 - repeatable by design
    for index, rows in risen:
        if len(rows) > 2:
            # Res(f, f′) = ± lc(f) disc(f)
            found = claimed.get((index,), fmpz_poly())
            slope = [c * k for k, c in enumerate(rows)][1:]
            if not _is_resultant(found * rows[-1], rows, slope, generator):
                return False
            values.append(found)
    for (i, one), (j, other) in combinations(risen, 2):
        found = claimed.get((i, j), fmpz_poly())
        if not _is_resultant(found, one, other, generator):
            return False
        values.append(found)
    return all(value and _is_product(value, plane.projection) for value in values)


def _is_product(value: fmpz_poly, factors: Iterable[fmpz_poly]) -> bool:
    """Return whether a polynomial is a product of powers of these, up to a number."""
    for factor in factors:
        while value.degree() >= factor.degree() and not value % factor:
            value = value // factor
    return bool(value.degree() == 0)


def _is_resultant(
    claimed: fmpz_poly, one: Sequence[fmpz_poly], other: Sequence[fmpz_poly], generator: random.Random
) -> bool:
    """Compare a resultant, up to its sign, with Sylvester's determinant at random points modulo random primes."""
    signs = set()
    for _ in range(_POINTS):
        prime = random_prime(generator)
        point = generator.getrandbits(61)
        at = [[_residue(c, point, prime) for c in reversed(polynomial)] for polynomial in (one, other)]
        found = int(nmod_mat(*_sylvester(at[0], at[1]), prime).det())
        wanted = _residue(claimed, point, prime)
        signs.add(1 if found == wanted else -1 if found == (prime - wanted) % prime else 0)
    return len(signs) == 1 and 0 not in signs


def _residue(polynomial: fmpz_poly, point: int, prime: int) -> int:
    return int(nmod_poly(polynomial, prime)(nmod(point, prime)))


def _sylvester(one: Sequence[int], other: Sequence[int]) -> tuple[int, int, list[int]]:
    """Return Sylvester's matrix of two polynomials, highest coefficient first, as rows, columns and entries."""
    m, n = len(one) - 1, len(other) - 1
    rows = [[0] * k + list(one) + [0] * (n - 1 - k) for k in range(n)]
    rows += [[0] * k + list(other) + [0] * (m - 1 - k) for k in range(m)]
    return m + n, m + n, [entry for row in rows for entry in row]


def _walls_are_all(plane: Plane) -> bool:
    """Return whether the critical lines are the real roots of the projection, each sample point between its two."""
    inside = all(
        (cylinder.left is None or _before(cylinder.left, RealNumber.of(cylinder.x)))
        and (cylinder.right is None or _before(RealNumber.of(cylinder.x), cylinder.right))
        for cylinder in plane.cylinders
    )
    ends = [(cylinder.left, cylinder.right) for cylinder in plane.cylinders]
    critical_lines = [line.x for line in plane.critical_lines]
    return (
        inside and ends == list(pairwise([None, *critical_lines, None])) and is_line(critical_lines, plane.projection)
    )


def _is_stack(plane: Plane, cylinder: Cylinder) -> bool:
    """Return whether over the cylinder's point every branch lies alone between the two samples around it."""
    if list(cylinder.samples) != sorted(cylinder.samples) or len(cylinder.samples) != len(cylinder.branches) + 1:
        return False
    cuts = [curve.on_vertical(cylinder.x) for curve in plane.curves]
    counters = [
        root_counter(cut) if curve.degree and cut.degree() > 0 else None
        for curve, cut in zip(plane.curves, cuts, strict=True)
    ]
    numbers = [0] * len(cuts)
    for branch, (low, high) in zip(cylinder.branches, pairwise(cylinder.samples), strict=True):
        count = counters[branch.curve]
        if count is None or branch.number != numbers[branch.curve] or count(low, high) != 1:
            return False
        numbers[branch.curve] += 1
    return all(n == (0 if count is None else count(None, None)) for count, n in zip(counters, numbers, strict=True))


def _seed(plane: Plane) -> int:
    digest = hashlib.sha256(repr(plane.names).encode())
    for curve in plane.curves:
        digest.update(curve.scalar.fingerprint().encode())
    return int.from_bytes(digest.digest(), "big")
