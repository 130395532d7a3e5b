"""Minimal sets of additional state measurements that make the pair observable.

With N a basis of the unobservable subspace and A N = N X, measuring the states of a set too, whose unit rows are E, makes
the pair observable exactly where (E N, X) is observable: N z is seen at no output and in no state of the set unless z = 0.
"""

from __future__ import annotations

import itertools
import math
from typing import TYPE_CHECKING

from symobs.exact import Matrix, TooLarge, rank, unit_rows
from symobs.proof.certificate.claims import Claim
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.proof.derivation.builder import relation

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.exact import Scalar
    from symobs.formula.tree import Environment

#: The most sets that are tried, and terms of the matrices; the minors of a set that are tried first, and the most.
_SETS, _TERMS = 200, 400
_MINORS = (60, 500)


def smallest_sets(N: Matrix, X: Matrix, e: Environment) -> tuple[tuple[int, ...], ...] | None:
    """Return the smallest sets of states whose measurement repairs every point where the relations of `e` hold.

    States are counted from 1.  None where there are too many sets, or too long entries, to try them all, and where
    whether one of them repairs every point is beyond the limits.
    """
    order, hidden = N.shape
    if not hidden:
        return ()
    if N.size + X.size > _TERMS:
        return None
    for count in range(1, order + 1):
        if math.comb(order, count) > _SETS:
            return None
        tried = {chosen: _repairs(chosen, N, X, e) for chosen in itertools.combinations(range(order), count)}
        if None in tried.values():
            return None
        found = tuple(tuple(i + 1 for i in chosen) for chosen, repairs in tried.items() if repairs)
        if found:
            return found
    return None


def _repairs(chosen: tuple[int, ...], N: Matrix, X: Matrix, e: Environment) -> bool | None:
    """Return whether measuring these states repairs every point, None where that is beyond the limits."""
    seen = seen_through(chosen, N, X)
    if rank(seen) < X.shape[0]:
        return False
    try:
        return _deciding_minors(seen, e) is not None
    except TooLarge:
        return None


def _deciding_minors(seen: Matrix, e: Environment) -> list[Scalar] | None:
    """Return minors that never vanish together, None where all do somewhere; raises `TooLarge` where others may not."""
    for most in _MINORS:
        minors = _minors(seen, most)
        if never_together_zero(minors, e.relations, e.signs):
            return minors
        if len(minors) < most:
            return None
    message = f"more than {_MINORS[-1]} minors decide whether these measurements are enough"
    raise TooLarge(message)


def seen_through(chosen: tuple[int, ...], N: Matrix, X: Matrix) -> Matrix:
    """Return [E N; E N X; …], as many blocks as X has rows."""
    rows = [unit_rows(N.shape[0], chosen) @ N]
    for _ in range(X.shape[0] - 1):
        rows.append(rows[-1] @ X)
    return Matrix.block([[row] for row in rows]).normal()


def _minors(matrix: Matrix, most: int) -> list[Scalar]:
    """Return minors that use all columns, the independent-looking ones first, up to so many."""
    count = matrix.shape[1]
    rows = [i for i in range(matrix.shape[0]) if any(matrix.rows[i])]
    chosen = itertools.islice(itertools.combinations(rows, count), most)
    return [matrix.select(minor, range(count)).determinant() for minor in chosen]


def repair_claims(
    sets: tuple[tuple[int, ...], ...], N: Matrix, X: Matrix, e: Environment, verb: str
) -> Iterator[Claim]:
    """Yield that each set repairs the plant at every point, and that of the smaller sets none does in general."""
    for numbers in sets:
        seen = seen_through(tuple(number - 1 for number in numbers), N, X)
        minors = Matrix.column(_deciding_minors(seen, e) or _minors(seen, 1))
        yield Claim(relation(minors, "!=", minors * 0), e, f"with states {numbers} {verb} too the rank is n")
    for chosen in itertools.combinations(range(N.shape[0]), len(sets[0]) - 1) if sets else ():
        most = rank(seen_through(chosen, N, X)) if chosen else 0
        if most < X.shape[0]:
            numbers = tuple(index + 1 for index in chosen)
            yield Claim(relation(most, "<", X.shape[0]), e, f"with states {numbers} {verb} too it is not")
