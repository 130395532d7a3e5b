"""Real zeros by ball arithmetic are those that SciPy finds from thousands of starts, and all of them where that is said."""

from __future__ import annotations

from fractions import Fraction
from math import isclose
from random import Random
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from scipy.optimize import brentq  # type: ignore[import-untyped]

from symobs.exact.algebraic.isolation import digits_on, isolated, sign_on
from symobs.formula.expression import parse_scalar

if TYPE_CHECKING:
    from collections.abc import Callable

#: A function as it is typed and in NumPy, where it is looked at, and whether the zeros are known to be all.
FUNCTIONS: list[tuple[str, Callable[[Any], Any], str | None, str | None, bool]] = [
    ("cos(x) - x", lambda x: np.cos(x) - x, None, None, True),
    ("sin(x) - x/3", lambda x: np.sin(x) - x / 3, None, None, True),
    ("exp(x) - 2*x - 2", lambda x: np.exp(x) - 2 * x - 2, None, None, False),
    ("x*exp(x) - 1", lambda x: x * np.exp(x) - 1, None, None, False),
    ("exp(x) + x^3 - 5", lambda x: np.exp(x) + x**3 - 5, None, None, False),
    ("x^2*exp(-1/x) - 1", lambda x: x**2 * np.exp(-1 / x) - 1, "0", None, True),
    (
        "(350 - x)*(1 + 9e8*exp(-7000/x)) + 150*9e8*exp(-7000/x) + 2*(300 - x)*(1 + 9e8*exp(-7000/x))",
        lambda x: (950 - 3 * x) * (1 + 9e8 * np.exp(-7000 / x)) + 150 * 9e8 * np.exp(-7000 / x),
        "0",
        None,
        True,
    ),
    ("log(x) + x - 3", lambda x: np.log(x) + x - 3, "1/2", "10", True),
    ("atan(x) - x/2", lambda x: np.arctan(x) - x / 2, "-5", "5", True),
    ("x^2 + 1 - cos(x)/2", lambda x: x**2 + 1 - np.cos(x) / 2, None, None, True),
]


@pytest.mark.parametrize(("text", "function", "low", "high", "complete"), FUNCTIONS)
def test_zeros_are_those_of_a_numeric_search(
    text: str,
    function: Callable[[Any], Any],
    low: str | None,
    high: str | None,
    complete: bool,  # noqa: FBT001
) -> None:
    value = parse_scalar(text, {"x": "real"}, functions=True, nonlinear=True)
    ends = [None if end is None else Fraction(end) for end in (low, high)]
    found, is_complete = isolated(value, "x", *ends)
    assert is_complete is complete
    begin, stop = (float(end) if end is not None else side * 600.0 for end, side in zip(ends, (-1, 1), strict=True))
    grid = np.linspace(begin + 1e-3 * (low == "0"), stop, 40_001) + 1e-7 * np.sqrt(2)
    with np.errstate(all="ignore"):
        heights = function(grid)
    changes = [
        k for k in range(len(grid) - 1) if np.isfinite(heights[k]) and np.sign(heights[k]) * np.sign(heights[k + 1]) < 0
    ]
    expected = [brentq(function, grid[k], grid[k + 1], xtol=1e-13) for k in changes]
    assert len(found) == len(expected), (found, expected)
    assert all(isclose(float(a), b, rel_tol=1e-9, abs_tol=1e-9) for (a, _), b in zip(found, expected, strict=True))
    assert all(0 <= b - a < Fraction(1, 10**12) * (1 + abs(a)) for a, b in found)


def test_a_double_zero_is_left_open() -> None:
    value = parse_scalar("1 - cos(x)", {"x": "real"}, functions=True, nonlinear=True)
    found, is_complete = isolated(value, "x", Fraction(-1), Fraction(1))
    assert not found
    assert not is_complete


@pytest.mark.parametrize("seed", range(40))
def test_a_sign_on_an_interval_is_that_of_every_point(seed: int) -> None:
    draw = Random(seed)  # noqa: S311 - repeatable
    text, function, *_ = draw.choice(FUNCTIONS)
    value = parse_scalar(text, {"x": "real"}, functions=True, nonlinear=True)
    low = Fraction(draw.randint(1, 400), draw.randint(1, 40))
    interval = low, low + Fraction(draw.randint(1, 60), draw.randint(1, 40))
    sign = sign_on(value, "x", interval)
    points = [float(interval[0] + (interval[1] - interval[0]) * k / 50) for k in range(51)]
    assert not sign or all(sign * function(point) > 0 for point in points)


def test_digits_are_certain() -> None:
    value = parse_scalar("cos(x)", {"x": "real"}, functions=True, nonlinear=True)
    assert digits_on(value, "x", (Fraction(1), Fraction(1)), 10) == "0.5403023059"
    assert len(digits_on(value, "x", (Fraction(1), Fraction(1001, 1000)), 10)) < 7
