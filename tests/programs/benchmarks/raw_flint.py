"""L of the generic plant by FLINT's operations alone: no reading, no checks, no types.

Rows of the observability matrix, cofactors of its last row, Horner on the factors A + p I, one gcd for each entry.
The reference for what symobs adds to FLINT.
"""

from __future__ import annotations

import itertools
import time
from typing import TYPE_CHECKING

from flint import Ordering, fmpz_mpoly_ctx

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from flint import fmpz_mpoly

    from tests.programs.benchmarks.models import Model


def seconds(model: Model, order: int) -> tuple[float, list[tuple[fmpz_mpoly, fmpz_mpoly]]]:
    """Return the processor time and the entries of L as (numerator, denominator)."""
    context = fmpz_mpoly_ctx.get(tuple(model.plain), Ordering.lex)
    generators = dict(zip(model.plain.values(), context.gens(), strict=True))
    indices = range(1, order + 1)
    A = [[generators[f"a{i}{j}"] for j in indices] for i in indices]
    C = [generators[f"c{j}"] for j in indices]
    poles = [generators[f"p{k}"] for k in indices]
    start = time.process_time()
    entries = gain(A, C, poles)
    return time.process_time() - start, entries


def gain(
    A: Sequence[Sequence[fmpz_mpoly]], C: Sequence[fmpz_mpoly], poles: Sequence[fmpz_mpoly]
) -> list[tuple[fmpz_mpoly, fmpz_mpoly]]:
    """Return L with det(sI − A + LC) = Π (s + p), each entry reduced."""
    order = len(C)
    rows = [list(C)]
    for _ in range(order - 1):
        rows.append([_dot(rows[-1], [line[j] for line in A]) for j in range(order)])
    minors = _minors(rows[:-1])
    everything = tuple(range(order))
    vector = []
    for j in range(order):
        minor = minors[everything[:j] + everything[j + 1 :]]
        vector.append(-minor if (order - 1 + j) % 2 else minor)
    determinant = _dot(rows[-1], vector)
    for p in poles:
        vector = [
            _dot([entry + p if i == j else entry for j, entry in enumerate(line)], vector) for i, line in enumerate(A)
        ]
    reduced = []
    for entry in vector:
        common = entry.gcd(determinant)
        reduced.append((entry, determinant) if common.is_one() else (entry / common, determinant / common))
    return reduced


def _dot(left: Sequence[fmpz_mpoly], right: Sequence[fmpz_mpoly]) -> fmpz_mpoly:
    total = left[0] * right[0]
    for a, b in zip(left[1:], right[1:], strict=True):
        total = total + a * b
    return total


def _minors(rows: Sequence[Sequence[fmpz_mpoly]]) -> Mapping[tuple[int, ...], fmpz_mpoly]:
    """Return the minors of all these rows by their columns, each row expanded in the minors of those above."""
    width = len(rows[0])
    minors: dict[tuple[int, ...], fmpz_mpoly] = {(j,): rows[0][j] for j in range(width)}
    for height, row in enumerate(rows[1:], start=1):
        larger: dict[tuple[int, ...], fmpz_mpoly] = {}
        for columns in itertools.combinations(range(width), height + 1):
            terms = [row[column] * minors[columns[:k] + columns[k + 1 :]] for k, column in enumerate(columns)]
            total = -terms[0] if height % 2 else terms[0]
            for k, term in enumerate(terms[1:], start=1):
                total = total - term if (height + k) % 2 else total + term
            larger[columns] = total
        minors = larger
    return minors
