"""Sums over roots mode by mode: against the roots by mpmath, what is exactly 0, and lies that are told from the truth."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import mpmath
import pytest

import symobs
from symobs.exact import EIGENVALUE, Scalar
from symobs.exact.algebraic.enclosure import near
from symobs.exact.algebraic.root_parts import RootPart, in_modes, vanishes
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import function_named, substitute
from symobs.formula.expression import parse_scalar
from tests.kit import text_of
from tests.support.algebra import seeded

LAMBDA, TIME = Scalar.symbol(EIGENVALUE), Scalar.symbol("t")
DIGITS = 5
#: q with roots that are real, in general position, on the imaginary axis, or all on one line parallel to it.
POLYNOMIALS = [
    [1, 3, 2, 1],
    [1, 0, -3, 1],
    [1, 0, 3, 0, 1],
    [1, 2, 4, 3, 1],
    [1, 0, 0, 0, -1, 1],
    [1, -2, 0, 0, 0, 0, 2],
    [2, 3, 1, 5],
]


def of(coefficients: list[int]) -> Scalar:
    order = len(coefficients) - 1
    return sum((Scalar.of(c) * LAMBDA ** (order - k) for k, c in enumerate(coefficients)), Scalar.of(0))


def by_roots(coefficients: list[int], weights: list[Fraction], time: Fraction) -> mpmath.mpf:
    """Σ g(λ) e^{λt}/q′(λ), the roots by mpmath."""
    with mpmath.workdps(40):
        order = len(coefficients) - 1
        slope = [c * (order - k) for k, c in enumerate(coefficients[:-1])]
        roots = mpmath.polyroots(coefficients, maxsteps=500, extraprec=400)
        above = [
            sum(mpmath.mpf(w.numerator) / w.denominator * root**p for p, w in enumerate(weights)) for root in roots
        ]
        rate = mpmath.mpf(time.numerator) / time.denominator
        terms = (a * mpmath.exp(r * rate) / mpmath.polyval(slope, r) for a, r in zip(above, roots, strict=True))
        return mpmath.re(mpmath.fsum(terms))


@pytest.mark.parametrize("coefficients", POLYNOMIALS, ids=str)
def test_the_modes_are_those_of_the_sum(coefficients: list[int]) -> None:
    draw, q = seeded(str(coefficients)), of(coefficients)
    for _ in range(4):
        weights = [Fraction(draw.randint(-5, 5), draw.choice([1, 2, 3])) for _ in coefficients[1:]]
        sums = (Scalar.of(w) * RootSum.of(q, p, TIME) for p, w in enumerate(weights))
        modes = in_modes(sum(sums, Scalar.of(1)), DIGITS)
        if not any(weights):
            continue
        assert modes is not None
        assert not any(isinstance(function_named(name), RootSum) for name in modes.names)
        time = Fraction(draw.randint(-4, 8), 4)
        found = near(substitute(modes, {"t": Scalar.of(time)}), 80)
        assert found is not None
        expected = by_roots(coefficients, weights, time) + 1
        assert abs(mpmath.mpf(found.numerator) / found.denominator - expected) < 1e-14 * (1 + abs(expected))


def test_what_is_zero_is_seen() -> None:
    """λ⁴ + 2λ³ + 4λ² + 3λ + 1 = (λ² + λ)² + 3(λ² + λ) + 1: all roots have the real part −1/2, and 1/q′(λ) is imaginary."""
    modes = in_modes(RootSum.of(of([1, 2, 4, 3, 1]), 0, TIME), DIGITS)
    assert modes is not None
    assert {f.kind for name in modes.names if (f := function_named(name))} == {"exp", "sin", "RootPart"}
    undamped = in_modes(RootSum.of(of([1, 0, 3, 0, 1]), 1, TIME), DIGITS)
    assert undamped is not None
    assert {f.kind for name in undamped.names if (f := function_named(name))} == {"cos", "RootPart"}


def test_what_is_not_zero_does_not_vanish() -> None:
    q = of([1, 3, 2, 1])
    first, second = (in_modes(RootSum.of(q, power, TIME), DIGITS) for power in (0, 1))
    assert first is not None
    assert second is not None
    assert vanishes(first - first)
    for lie in (first - second, first + first, first - Scalar.of(1), first * TIME - first):
        assert not vanishes(lie)


@pytest.mark.parametrize("digits", [4, 8])
def test_a_page_has_the_response_of_simulation(digits: int) -> None:
    """y(2) read from the printed line, against the matrix exponential of mpmath."""
    A, n = [[0, 1, 0], [0, 0, 1], [-1, -3, -2]], 3
    result: Any = symobs.response(symobs.StateSpace(A, [[0], [0], [1]], [[1, 0, 0]]), input="1")
    page = "".join(result.to("text", digits=digits).split())
    line = page[page.index("y(t)=Cx(t)") :].partition("✓")[0]
    for mark in "┌─┐│└┘·≈":
        line = line.replace(mark, "")
    tidy = line.removeprefix("y(t)=Cx(t)").replace("t)cos", "t)*cos").replace("t)sin", "t)*sin").replace("t)(", "t)*(")
    tidy = tidy.replace("t)", "*t)").replace("cos", "*cos").replace("sin", "*sin").replace("exp", "*exp")
    for doubled in ("**", "+*", "-*", "(*"):
        tidy = tidy.replace(doubled, doubled[:-1])
    read = near(substitute(parse_scalar(tidy, {"t": "real"}, functions=True), {"t": Scalar.of(2)}))
    assert read is not None
    with mpmath.workdps(30):
        whole = mpmath.zeros(n + 1)
        for i in range(n):
            for j in range(n):
                whole[i, j] = A[i][j]
        whole[n - 1, n] = 1
        expected = mpmath.expm(whole * 2)[0, n]
    assert abs(float(read) - float(expected)) < 3 * 10.0**-digits


def test_a_page_shows_no_sum_where_the_modes_have_decimals() -> None:
    result = symobs.response(symobs.StateSpace("[0 1 0; 0 0 1; -1.5 -2.2 -3.1]", "[0; 0; 1]", "[1.5 0 0]"), input="1")
    assert "Σ" not in text_of(result).partition("The output is")[2]
    assert "Σ" in result.to("text", exact=True).partition("The output is")[2]


def test_a_part_is_printed_with_its_digits() -> None:
    modes = in_modes(RootSum.of(of([1, 3, 2, 1]), 0, TIME), DIGITS)
    assert modes is not None
    rates = {name for name in modes.names if (f := function_named(name)) and f.kind == "exp"}
    parts = {part for name in rates for part in function_named(name).argument.names if function_named(part)}  # type: ignore[union-attr]
    assert all(isinstance(function_named(part), RootPart) for part in parts)
    assert len(parts) == 2
