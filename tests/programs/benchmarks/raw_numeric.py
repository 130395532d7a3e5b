"""L of a plant with numbers by FLINT's operations alone: no reading, no checks, nothing in lowest terms.

Denominators cleared once, the rows c, cT, … as products, one linear system, and Horner on the factors.
"""

from __future__ import annotations

import time
from math import lcm
from typing import TYPE_CHECKING

from flint import fmpq_mat, fmpz_mat

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction


def seconds(
    A: Sequence[Sequence[Fraction]], C: Sequence[Sequence[Fraction]], poles: Sequence[int]
) -> tuple[float, fmpq_mat]:
    """Return the processor time and L; the tables of integers are made before."""
    d, e = (lcm(*(entry.denominator for row in rows for entry in row)) for rows in (A, C))
    T, c = fmpz_mat([[int(entry * d) for entry in row] for row in A]), fmpz_mat([[int(x * e) for x in C[0]]])
    start = time.process_time()
    found = gain(T, c, d, e, poles)
    return time.process_time() - start, found


def gain(T: fmpz_mat, c: fmpz_mat, d: int, e: int, poles: Sequence[int]) -> fmpq_mat:
    """Return L with det(sI − T/d + L c/e) = Π (s − pole)."""
    n = T.nrows()
    rows = [c]
    for _ in range(n - 1):
        rows.append(rows[-1] * T)
    table = fmpz_mat(n, n, [entry for row in rows for entry in row.entries()])
    unit = fmpq_mat(n, 1, [int(i == n - 1) for i in range(n)])
    vector, below = fmpq_mat(table).solve(unit).numer_denom()
    for pole in poles:
        vector = T * vector - vector * (d * pole)
    return fmpq_mat(vector) * e / (below * d)
