"""Courses over time found another way: powers of the matrix exponential of mpmath, at all instants."""

from __future__ import annotations

from functools import lru_cache
from operator import mul
from typing import TYPE_CHECKING, TypeAlias

import mpmath
import sympy

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from fractions import Fraction

    from symobs.formula.figures import Interval, PlottedResponse, TimeResponse

Rows: TypeAlias = "tuple[tuple[Fraction, ...], ...]"
#: Digits that are kept while one instant after the other is found.
_DIGITS = 60


def untrue_responses(picture: TimeResponse, matrix: Sequence[Sequence[Fraction]]) -> tuple[str, ...]:
    """Return the points that lie a thousandth of the window or more from where they should."""
    return _all_untrue(picture, tuple(map(tuple, matrix)))


@lru_cache(maxsize=8)
def _all_untrue(picture: TimeResponse, matrix: Rows) -> tuple[str, ...]:
    """Return them, the same at every random point."""
    if picture.discrete:
        return tuple(_untrue_samples(picture, matrix))
    start = tuple(part for start in picture.starts for part in start)
    found = (_untrue(response, picture.window, picture.parts, start, matrix) for response in picture.responses)
    return tuple(text for texts in found for text in texts)


@lru_cache(maxsize=64)
def _untrue(
    response: PlottedResponse, window: tuple[Interval, Interval], parts: int, start: tuple[Fraction, ...], matrix: Rows
) -> tuple[str, ...]:
    """Return the points of one response: pictures that differ in another response have the same."""
    (begin, end), (bottom, top) = window
    step = end / (len(response.heights) - 1)
    assert begin == 0
    assert step <= end / 100
    row, near = [float(part) for part in response.row], float(top - bottom) / 1000
    states = _states(matrix, start, step, len(response.heights))
    return tuple(
        f"{response.signal} at {k * step}"
        for k, (height, state) in enumerate(zip(response.heights, states, strict=True))
        if abs(sum(map(mul, row, state)) - height / parts) > near
    )


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
    for response in picture.responses:
        row = sympy.Matrix([[sympy.Rational(str(part)) for part in response.row]])
        for place, (instant, height) in enumerate(picture.points(response)):
            if instant != place or (row * table**place * start)[0] != sympy.Rational(str(height)):
                yield f"{response.signal} at {instant}"


def _real(value: Fraction) -> mpmath.mpf:
    return mpmath.mpf(value.numerator) / value.denominator
