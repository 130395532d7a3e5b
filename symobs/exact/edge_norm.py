"""Shortest vectors under quadratic equations where the Lagrangian is convex, but not strictly: its multipliers, exactly.

The vector is not the only one of its length there, and Newton's method has a singular matrix; the least squares step
leads to one of them, and its multipliers, which are the same for all, are recognised.
"""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING

from flint import arb, arb_mat, ctx, fmpz_poly

from symobs.exact.field import EIGENVALUE
from symobs.exact.least_norm import Problem, powers_of, short_relation
from symobs.exact.polynomial import from_coefficients
from symobs.exact.real import real_roots
from symobs.exact.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact.least_norm import Quadratic
    from symobs.exact.real import RealNumber

#: The bits of the multipliers, the greatest degree of their field, the steps, and what makes a singular matrix regular.
_BITS, _DEGREES, _STEPS, _REGULAR = 3_600, (1, 2, 4, 8, 12), 80, 600


def multipliers_at_edge(equations: Sequence[Quadratic]) -> tuple[RealNumber, tuple[Scalar, ...]] | None:
    """Return a root and the multipliers as polynomials in λ for it; None where they are not recognised."""
    before = ctx.prec
    try:
        problem = Problem(equations)
        near = problem.within()
        edge = None if near is None else problem.edge(near)
        if near is None or edge is None:
            return None
        ctx.prec = 2 * _BITS + 2 * _REGULAR
        point = _settled(problem, _started(problem, *edge, near))
        return None if point is None else _recognised(point[problem.size :])
    except (OverflowError, ZeroDivisionError):
        return None
    finally:
        ctx.prec = before


def _started(problem: Problem, x: list[float], way: list[float], multipliers: list[float]) -> list[arb]:
    """Return x moved along the way as far as the equations ask for on the whole, and the multipliers."""
    point = [arb(value) for value in (*x, *multipliers)]
    off = problem.linearised(point)[1]
    missed = sum((2 * off[problem.size + k, 0] * m for k, m in enumerate(multipliers)), arb(0))
    length = float(missed.mid()) if missed > 0 else 0.0
    return [arb(a + length**0.5 * b) for a, b in zip(x, way, strict=True)] + point[problem.size :]


def _settled(problem: Problem, point: list[arb]) -> list[arb] | None:
    """Return the point that steps of least squares lead to, None where they do not settle."""
    small = arb(2) ** -_REGULAR
    for _ in range(_STEPS):
        table, off = problem.linearised(point)
        count = table.nrows()
        regular = table * table + arb_mat([[small if i == j else 0 for j in range(count)] for i in range(count)])
        step = regular.solve(table * off)
        point = [(value - step[i, 0]).mid() for i, value in enumerate(point)]
        if all(abs(off[i, 0]) < arb(2) ** -_BITS for i in range(count)):
            return point
    return None


def _recognised(multipliers: Sequence[arb]) -> tuple[RealNumber, tuple[Scalar, ...]] | None:
    bits = _BITS - 100
    for theta, degree in itertools.product(multipliers, _DEGREES):
        powers = list(itertools.islice(powers_of(theta, bits), degree + 1))
        short = short_relation(powers, bits)
        if short is None:
            continue
        roots = real_roots(fmpz_poly(short))
        root = next((root for root in roots if abs(root.ball(bits) - theta) < arb(2) ** (-bits // 2)), None)
        if root is None:
            continue
        found = [short_relation([*powers[: root.degree], value], bits) for value in multipliers]
        if all(relation is not None and relation[-1] for relation in found):
            return root, tuple(_scalar(relation) for relation in found if relation is not None)
    return None


def _scalar(relation: Sequence[int]) -> Scalar:
    """Return the last number of a relation as a polynomial in λ."""
    *others, own = relation
    return from_coefficients([Scalar.of(c) for c in reversed(others)], EIGENVALUE) / Scalar.of(-own)
