"""Margins at the points of a sweep: held to python-control, and to the roots of numpy on both sides of every end."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import pytest

from symobs.exact.algebraic.loop_distances import slowest_root

np = pytest.importorskip("numpy")
pytestmark = pytest.mark.slow


def test_slowest_roots_of_any_polynomial_are_exact() -> None:
    """Real parts and moduli of roots without a closed form: x³ + x + 1 has one pair, of real part −r/2 for its root r."""
    cases: list[tuple[list[int], bool, str]] = [
        ([1, 0, 1, 1], False, "CRootOf(8*x**3 + 2*x - 1, 0)"),
        ([1, 3, 3, 2], False, "-1/2"),
        ([1, 2, 2], True, "sqrt(2)"),
        ([1, 0, 0, 0, 4], False, "1"),
        ([1, 1, 0], True, "1"),
    ]
    for coefficients, discrete, wanted in cases:
        assert slowest_root([Fraction(c) for c in coefficients], discrete=discrete).text() == wanted
        roots = np.roots(coefficients)
        size = max(abs(roots)) if discrete else max(roots.real)
        assert value_near(slowest_root([Fraction(c) for c in coefficients], discrete=discrete)) == pytest.approx(size)


def value_near(number: Any) -> float:
    low, high = number.interval()
    return float((low + high) / 2)
