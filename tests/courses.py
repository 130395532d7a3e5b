"""Courses over time found another way: powers of the matrix exponential of mpmath, at all instants."""

from __future__ import annotations

from functools import lru_cache
from itertools import pairwise
from operator import mul
from typing import TYPE_CHECKING, TypeAlias

import mpmath
import sympy

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

    from symobs.picture import TimeResponse

Rows: TypeAlias = "tuple[tuple[Fraction, ...], ...]"
#: Digits that are kept while one instant after the other is found.
_DIGITS = 60


def untrue_courses(picture: TimeResponse, matrix: Sequence[Sequence[Fraction]]) -> tuple[str, ...]:
    """Return the points that lie a thousandth of the window or more from where they should."""
    return _all_untrue(picture, tuple(map(tuple, matrix)))


@lru_cache(maxsize=8)
def _all_untrue(picture: TimeResponse, matrix: Rows) -> tuple[str, ...]:
    """Return them, the same at every random point."""
    return tuple(_untrue(picture, matrix))


def _untrue(picture: TimeResponse, matrix: Rows) -> Iterator[str]:
    (_, end), (bottom, top) = picture.window
    if picture.discrete:
        yield from _untrue_samples(picture, matrix)
        return
    start = tuple(part for start in picture.starts for part in start)
    for course in picture.courses:
        points = picture.points(course)
        assert points[0][0] == 0
        assert points[-1][0] == end
        assert all(b[0] - a[0] <= end / 100 for a, b in pairwise(points))
        states = _states(matrix, start, end / (len(points) - 1), len(points))
        row, near = [float(part) for part in course.row], float(top - bottom) / 1000
        for (instant, height), state in zip(points, states, strict=True):
            if abs(sum(map(mul, row, state)) - float(height)) > near:
                yield f"{course.signal} at {instant}"


@lru_cache(maxsize=8)
def _states(matrix: Rows, start: tuple[Fraction, ...], step: Fraction, count: int) -> list[list[float]]:
    """Return the state at 0, h, 2 h, …: e^{Mh} times the one before."""
    with mpmath.workdps(_DIGITS):
        once = mpmath.expm(mpmath.matrix([[_real(entry * step) for entry in row] for row in matrix]))
        states = [mpmath.matrix([_real(part) for part in start])]
        for _ in range(count - 1):
            states.append(once * states[-1])
    return [[float(part) for part in state] for state in states]


def _untrue_samples(picture: TimeResponse, matrix: Rows) -> Iterator[str]:
    """Yield the values that are not row · Mᵏ · start, exactly."""
    start = sympy.Matrix([sympy.Rational(str(part)) for start in picture.starts for part in start])
    table = sympy.Matrix([[sympy.Rational(str(entry)) for entry in row] for row in matrix])
    for course in picture.courses:
        row = sympy.Matrix([[sympy.Rational(str(part)) for part in course.row]])
        for place, (instant, height) in enumerate(picture.points(course)):
            if instant != place or (row * table**place * start)[0] != sympy.Rational(str(height)):
                yield f"{course.signal} at {instant}"


def _real(value: Fraction) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator
