"""The coordinates of a reduced-order observer: the outputs first, rows that complete them after."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Ideal, Matrix, unit_rows
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from symobs.system import StateSpace


class Partition(NamedTuple):
    """The plant in the coordinates x̄ = T x, the measured states first."""

    T: Matrix
    A11: Matrix
    A12: Matrix
    A21: Matrix
    A22: Matrix
    B1: Matrix | None
    B2: Matrix | None


def partition(plant: StateSpace, T: Matrix) -> Partition:
    """Return T A T⁻¹ and T B in blocks; raises ZeroDivisionError where T is singular."""
    m, measured = plant.matrices, plant.outputs
    first, second = range(measured), range(measured, plant.order)
    A = (T @ m.A @ T.inverse()).normal()
    B = (T @ m.B).normal() if m.has_input else None
    A11, A12, A21, A22 = (A.select(rows, columns) for rows in (first, second) for columns in (first, second))
    B1, B2 = (
        (None, None) if B is None else (B.select(first, range(plant.inputs)), B.select(second, range(plant.inputs)))
    )
    return Partition(T, A11, A12, A21, A22, B1, B2)


def completed(C: Matrix, ideal: Ideal | None = None) -> Matrix:
    """Return T = [C; R], R the unit rows of the columns without a pivot; constant pivots are preferred.

    What lies in `ideal` is 0.  Raises `InputError` where the rows of C depend on each other.
    """
    pivots = _pivots(C, ideal)
    if len(pivots) < C.shape[0]:
        message = "the rows of C depend on each other: one output is a combination of the others"
        raise InputError(message, where="plant.C", repair="leave that output out")
    others = tuple(j for j in range(C.shape[1]) if j not in pivots)
    return Matrix.block([[C], [unit_rows(C.shape[1], others)]]) if others else C


def _pivots(C: Matrix, ideal: Ideal | None) -> list[int]:
    """Return the pivot columns of C, row by row: the first with a constant entry, else the first with an entry."""
    rows = [list(row) for row in C.rows]
    found: list[int] = []
    for index, row in enumerate(rows):
        candidates = [j for j, entry in enumerate(row) if not entry.is_zero and (ideal is None or entry not in ideal)]
        if not candidates:
            continue
        pivot = next((j for j in candidates if row[j].is_constant), candidates[0])
        found.append(pivot)
        for other in rows[index + 1 :]:
            factor = other[pivot] / row[pivot]
            other[:] = [a - factor * b for a, b in zip(other, row, strict=True)]
    return found
