"""Plain arithmetic of fractions, by which results are judged: written without symobs, without FLINT, without SymPy.

Matrices are lists of rows of `Fraction`, polynomials are lists of coefficients with the highest power first.  Only
`value_at` and what stands on it read values of the kernel, term by term.
"""

from __future__ import annotations

import random
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from math import lcm, prod
from operator import mul
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from symobs.exact import Matrix, Scalar

Rows: TypeAlias = list[list[Fraction]]
Polynomial: TypeAlias = list[Fraction]
Point: TypeAlias = Mapping[str, Fraction]

# -- kernel values at a point ------------------------------------------------------------------------------------------


Term: TypeAlias = tuple[int, tuple[tuple[str, int], ...], int]


@lru_cache(maxsize=4096)
def _terms(scalar: Scalar) -> tuple[list[Term], list[Term], int]:
    """Return the terms of numerator and denominator, each filled up to one degree, and that degree."""
    parts = [part.terms() for part in (scalar.numerator, scalar.denominator)]
    degree = max((sum(power for _, power in powers) for part in parts for _, powers in part), default=0)
    above, below = ([(c, powers, degree - sum(power for _, power in powers)) for c, powers in part] for part in parts)
    return above, below, degree


def value_at(scalar: Scalar, point: Point) -> Fraction:
    """Evaluate a kernel scalar term by term; raises ZeroDivisionError where its denominator vanishes.

    In integers over one denominator q: Σ c Π (xᵢ/q)^eᵢ = Σ c Π xᵢ^eᵢ q^(d − Σ eᵢ) / q^d.
    """
    if scalar.is_constant:
        return scalar.fraction()
    above, below, degree = _terms(scalar)
    common = lcm(*(value.denominator for value in point.values()))
    bases = {name: value.numerator * (common // value.denominator) for name, value in point.items()}
    powers = {name: [base**k for k in range(degree + 1)] for name, base in bases.items() if name in scalar.names}
    filling = [common**k for k in range(degree + 1)]
    top, bottom = (
        sum(
            prod([powers[name][k] for name, k in names], start=coefficient * filling[rest])
            for coefficient, names, rest in part
        )
        for part in (above, below)
    )
    return Fraction(top, bottom)


def matrix_at(matrix: Matrix, point: Point) -> Rows:
    return [[value_at(entry, point) for entry in row] for row in matrix.rows]


def coefficients_at(scalar: Scalar, variable: str, point: Point) -> Polynomial:
    """Evaluate the coefficients of a polynomial in one variable, highest power first."""
    return [value_at(coefficient, point) for coefficient in scalar.coefficients(variable)]


def seeded(seed: object) -> random.Random:
    """A generator that draws the same in every run."""
    return random.Random(str(seed))  # noqa: S311 - test points, no secrets


def random_fraction(generator: random.Random, sign: str = "real") -> Fraction:
    """Draw a small rational number that has the declared sign."""
    value = Fraction(generator.randint(-40, 40), generator.randint(1, 9))
    if sign in {"positive", "negative", "nonzero"} and not value:
        value = Fraction(1, generator.randint(1, 9))
    if sign in {"positive", "nonnegative"}:
        return abs(value)
    return -abs(value) if sign in {"negative", "nonpositive"} else value


def has_sign(value: Fraction, sign: str) -> bool:
    """Tell whether a number has a declared sign."""
    return {
        "positive": value > 0,
        "negative": value < 0,
        "nonnegative": value >= 0,
        "nonpositive": value <= 0,
        "nonzero": value != 0,
        "zero": value == 0,
        "real": True,
    }[sign]


# -- plain arithmetic --------------------------------------------------------------------------------------------------


def multiply(left: Sequence[Sequence[Fraction]], right: Sequence[Sequence[Fraction]]) -> Rows:
    columns = list(zip(*right, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in left]


def subtract(left: Rows, right: Rows) -> Rows:
    return [[a - b for a, b in zip(p, q, strict=True)] for p, q in zip(left, right, strict=True)]


def faddeev_leverrier(A: Rows) -> tuple[Polynomial, list[Rows]]:
    """Return the coefficients of det(sI − A) and of adj(sI − A), highest power first, found in integers."""
    order, below = len(A), lcm(*(entry.denominator for row in A for entry in row))
    whole = [[int(entry * below) for entry in row] for row in A]
    coefficients, parts = [1], []
    M = [[0] * order for _ in range(order)]
    for k in range(1, order + 1):
        M = [[e + (coefficients[-1] if i == j else 0) for j, e in enumerate(row)] for i, row in enumerate(M)]
        parts.append(M)
        columns = list(zip(*M, strict=True))
        M = [[sum(map(mul, row, column)) for column in columns] for row in whole]
        coefficients.append(-sum(M[i][i] for i in range(order)) // k)
    chi = [Fraction(c, below**k) for k, c in enumerate(coefficients)]
    return chi, [[[Fraction(e, below**k) for e in row] for row in part] for k, part in enumerate(parts)]


def characteristic(A: Rows) -> Polynomial:
    return faddeev_leverrier(A)[0]


def eliminated(rows: Sequence[Sequence[Fraction]]) -> tuple[list[int], Rows]:
    """Return the pivot columns and the reduced rows."""
    work = [list(row) for row in rows]
    pivots: list[int] = []
    for column in range(len(work[0]) if work else 0):
        found = next((i for i in range(len(pivots), len(work)) if work[i][column]), None)
        if found is None:
            continue
        rank = len(pivots)
        work[rank], work[found] = work[found], work[rank]
        work[rank] = [entry / work[rank][column] for entry in work[rank]]
        for i, row in enumerate(work):
            if i != rank and row[column]:
                work[i] = [x - row[column] * y for x, y in zip(row, work[rank], strict=True)]
        pivots.append(column)
    return pivots, work[: len(pivots)]


def rank_of(rows: Sequence[Sequence[Fraction]]) -> int:
    return len(eliminated(rows)[0])


def observability_rows(A: Rows, C: Rows) -> Rows:
    rows, block = list(C), C
    for _ in range(len(A) - 1):
        block = multiply(block, A)
        rows += block
    return rows


def transposed(rows: Rows) -> Rows:
    return [list(column) for column in zip(*rows, strict=True)]


def hidden(A: Rows, C: Rows) -> Polynomial:
    """Return the characteristic polynomial of A on the kernel of 𝒪, by a basis that is the identity on the free rows."""
    pivots, reduced = eliminated(observability_rows(A, C))
    free = [j for j in range(len(A)) if j not in pivots]
    N = [[Fraction(int(i == j)) for j in free] for i in range(len(A))]
    for pivot, row in zip(pivots, reduced, strict=True):
        N[pivot] = [-row[j] for j in free]
    moved = multiply(A, N)
    return characteristic([moved[i] for i in free]) if free else [Fraction(1)]


def divides(divisor: Polynomial, polynomial: Polynomial) -> bool:
    """Tell whether a monic polynomial divides another."""
    rest = list(polynomial)
    while len(rest) >= len(divisor):
        shifted = [rest[0] * c for c in divisor] + [Fraction(0)] * (len(rest) - len(divisor))
        rest = [x - y for x, y in zip(rest, shifted, strict=True)][1:]
    return not any(rest)


def assignable(A: Rows, C: Rows, phi: Polynomial) -> bool:
    """Tell whether some L has det(sI − A + L C) = φ(s).

    For one output det(sI − A + l c) = χ(s) + c adj(sI − A) l, so this is a linear system: φ − χ among the combinations
    of the n polynomials c adj(sI − A).  For several, the polynomial of what the outputs do not show must divide φ.
    """
    if len(C) > 1:
        return divides(hidden(A, C), phi)
    chi, adjugates = faddeev_leverrier(A)
    spanned = transposed([multiply(C, part)[0] for part in adjugates])
    wanted = [x - y for x, y in zip(phi, chi, strict=True)][1:]
    return rank_of(spanned) == rank_of([*spanned, wanted])


def is_hurwitz(polynomial: Polynomial) -> bool:
    """Tell whether every root lies in Re s < 0, by the first column of Routh's scheme."""
    positive = [c / polynomial[0] for c in polynomial]
    above, below = positive[0::2], positive[1::2]
    while below:
        if below[0] <= 0:
            return False
        padded = below + [Fraction(0)] * (len(above) - len(below))
        above, below = (
            below,
            [
                above[k + 1] - above[0] / below[0] * (padded[k + 1] if k + 1 < len(padded) else 0)
                for k in range(len(above) - 1)
            ],
        )
    return True


def is_schur(polynomial: Polynomial) -> bool:
    """Tell whether every root lies in |z| < 1, by the recursion of Schur and Cohn."""
    while len(polynomial) > 1:
        first, last = polynomial[0], polynomial[-1]
        if abs(last) >= abs(first):
            return False
        polynomial = [first * x - last * y for x, y in zip(polynomial, reversed(polynomial), strict=True)][:-1]
    return True


def product(factors: Sequence[Polynomial]) -> Polynomial:
    total = [Fraction(1)]
    for factor in factors:
        longer = [Fraction(0)] * (len(total) + len(factor) - 1)
        for i, x in enumerate(total):
            for j, y in enumerate(factor):
                longer[i + j] += x * y
        total = longer
    return total


def at_number(polynomial: Polynomial, s: Fraction) -> Fraction:
    value = Fraction(0)
    for coefficient in polynomial:
        value = value * s + coefficient
    return value
