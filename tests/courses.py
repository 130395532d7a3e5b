"""Courses over time found another way: the matrix exponential of mpmath, at a few instants."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import mpmath
import sympy

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

    from symobs.picture import TimeResponse

_ASKED = 7


def untrue_courses(picture: TimeResponse, matrix: Sequence[Sequence[Fraction]]) -> Iterator[str]:
    """Yield the points that lie a thousandth of the window or more from where they should."""
    (_, end), (bottom, top) = picture.window
    start = mpmath.matrix([_real(part) for start in picture.starts for part in start])
    table = mpmath.matrix([[_real(entry) for entry in row] for row in matrix])
    if picture.discrete:
        yield from _untrue_samples(picture, matrix)
        return
    for course in picture.courses:
        points = picture.points(course)
        assert points[0][0] == 0
        assert points[-1][0] == end
        assert all(b[0] - a[0] <= end / 100 for a, b in pairwise(points))
        for instant, height in points[:: len(points) // _ASKED]:
            state = mpmath.expm(table * _real(instant)) * start
            value = sum(_real(part) * state[k] for k, part in enumerate(course.row))
            if abs(value - _real(height)) > _real(top - bottom) / 1000:
                yield f"{course.signal} at {instant}"


def _untrue_samples(picture: TimeResponse, matrix: Sequence[Sequence[Fraction]]) -> Iterator[str]:
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
