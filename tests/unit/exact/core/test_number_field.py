"""Fields with roots of primes: normal forms, factors and lowest terms, held against SymPy and against pairs of fractions."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

import pytest
import sympy
from hypothesis import example, given, settings
from hypothesis import strategies as st

from symobs.exact import Ideal, Scalar, product_of
from symobs.exact.algebraic.rounded_decimals import root_in_field
from symobs.exact.core.generators import square_root
from symobs.exact.core.modular import Point, VanishingDenominator
from symobs.exact.core.number_field import common_divisor
from symobs.exact.sympy_bridge.conversion import scalar_to_sympy

if TYPE_CHECKING:
    from fractions import Fraction

R2, R3 = square_root(Scalar.of(2)), square_root(Scalar.of(3))
k, x = (Scalar.symbol(name) for name in "kx")

_FRACTIONS = st.fractions(min_value=-9, max_value=9, max_denominator=9)
_PAIRS = st.tuples(_FRACTIONS, _FRACTIONS)


def _number(pair: tuple[Fraction, Fraction]) -> Scalar:
    return pair[0] + pair[1] * R2


@given(_PAIRS, _PAIRS)
def test_the_field_of_pairs(a: tuple[Fraction, Fraction], b: tuple[Fraction, Fraction]) -> None:
    """a + b √2 as a pair of fractions: (a, b)(c, d) = (ac + 2bd, ad + bc), 1/(a, b) = (a, −b)/(a² − 2b²)."""
    one, other = _number(a), _number(b)
    assert one * other == _number((a[0] * b[0] + 2 * a[1] * b[1], a[0] * b[1] + a[1] * b[0]))
    assert one + other == _number((a[0] + b[0], a[1] + b[1]))
    assert one.is_zero == (not any(a))
    if not one.is_zero:
        norm = a[0] ** 2 - 2 * a[1] ** 2
        assert other / one == other * _number((a[0] / norm, -a[1] / norm))
        assert hash(1 / (1 / one)) == hash(one)


def test_common_factors_with_roots_are_divided_out_as_often_as_they_occur() -> None:
    """(x + √2)³ (y + √2) c / ((x² − 2)² (y² − 2) (x + 1)) = (x + √2) c / ((x − √2)² (y − √2) (x + 1))."""
    x, y, c = map(Scalar.symbol, "xyc")
    root = square_root(Scalar.of(2))
    value = (x + root) ** 3 * (y + root) * c / ((x**2 - 2) ** 2 * (y**2 - 2) * (x + 1))
    below = (x - root) ** 2 * (y - root) * (x + 1)
    assert value.numerator * below == value.denominator * (x + root) * c
    assert [value.denominator.degree(name) for name in "xyc"] == [3, 1, 0]
    assert [value.numerator.degree(name) for name in "xyc"] == [1, 0, 1]


def test_lowest_terms_show_where_a_denominator_vanishes() -> None:
    """(k + √2)/(k² − 2) has no value at √2 alone: its denominator is k − √2."""
    value = (k + R2) / (k**2 - 2)
    assert value.numerator.is_one
    assert value.denominator == k - R2
    assert str(value) == "1/(k - sqrt(2))"
    assert ((k**2 - 2) * value).denominator.is_one
    assert value.substitute({"k": -R2}) == -R2 / 4  # 1/(−2 √2), though k² − 2 vanishes there
    with pytest.raises(ZeroDivisionError):
        value.substitute({"k": R2})
    assert value not in Ideal.of([k + R2])
    assert value - 1 / (-2 * R2) in Ideal.of([k + R2])
    assert [c for c, _ in value.terms()] == [1]


_POLYNOMIALS = [
    x**2 - 2,
    x**4 + 1,
    x**2 + R2 * x + 1,
    x**4 - 10 * x**2 + 1,
    (x - R2 * R3) * (x + 1 + R2) ** 2,
    3 * x**3 - 6 * R2,
]


@pytest.mark.parametrize("polynomial", _POLYNOMIALS, ids=str)
def test_factors_over_the_roots(polynomial: Scalar) -> None:
    """The degrees of the factors are those that SymPy finds over Q(√2, √3)."""
    inside = polynomial.within((polynomial * R2 * R3 * x).field)
    unit, factors = inside.factors()
    assert unit * product_of(factor**power for factor, power in factors) == polynomial
    extension = [sympy.sqrt(2), sympy.sqrt(3)]
    theirs = sympy.Poly(scalar_to_sympy(polynomial), sympy.Symbol("x"), extension=extension).factor_list()[1]
    ours = sorted((factor.degree("x"), power) for factor, power in factors)
    assert ours == sorted((int(factor.degree()), power) for factor, power in theirs)


@settings(max_examples=30)
@given(st.lists(st.tuples(st.integers(-3, 3), st.integers(-3, 3), st.booleans()), min_size=1, max_size=3))
def test_a_product_of_linear_factors_comes_apart(parts: list[tuple[int, int, bool]]) -> None:
    """Π (x − a − b √2) or Π (x − a − b √2 k): as many linear factors, whatever the product looks like."""
    given_factors = [x - a - b * R2 * (k if moves else 1) for a, b, moves in parts]
    product = product_of(given_factors)
    found = product.within((product * R2).field).factors()[1]
    monic = {(factor / factor.coefficients("x")[0], power) for factor, power in found}
    assert monic == {(factor, given_factors.count(factor)) for factor in given_factors}


def test_roots_of_numbers_with_roots() -> None:
    assert root_in_field(3 + 2 * R2) == 1 + R2
    assert root_in_field(5 - 2 * R2 * R3) == R3 - R2
    assert root_in_field(2 + R3) == (R2 + R2 * R3) / 2
    assert root_in_field(2 - R3) == (R2 * R3 - R2) / 2
    assert root_in_field(2 + R2) is None  # no square in Q(√2)
    assert root_in_field(1 - R2) is None  # negative


def test_a_point_keeps_the_squares() -> None:
    """At a point modulo a prime a root has a root for its value; where there is none there is no point."""
    generator, seen = random.Random(3), 0  # noqa: S311 - repeatable
    for _ in range(40):
        try:
            point = Point({*R2.field.names, *R3.field.names}, generator)
        except VanishingDenominator:
            continue
        seen += 1
        two, three = point.scalar(R2), point.scalar(R3)
        assert (two * two % point.prime, three * three % point.prime) == (2, 3)
        assert point.scalar((1 + R2) * (R3 - 1)) == (1 + two) * (three - 1) % point.prime
    assert 0 < seen < 40


_SMALL = st.integers(-3, 3)
_TERMS = st.lists(st.tuples(_SMALL, _SMALL, _SMALL, st.integers(0, 2), st.integers(0, 1)), min_size=1, max_size=2)


@settings(max_examples=40)
@example(([(1, 0, 0, 1, 0)], [(2, 0, 0, 0, 1)], [(1, 0, 0, 1, 0), (2, 0, 0, 0, 0)]))
@given(st.tuples(_TERMS, _TERMS, _TERMS))
def test_the_greatest_common_divisor_is_that_of_sympy(drawn: tuple[list[tuple[int, int, int, int, int]], ...]) -> None:
    field = (R2 * R3 * x * k).field
    factors = [sum(((a + b * R2 + c * R3) * x**i * k**j for a, b, c, i, j in terms), Scalar.of(0)) for terms in drawn]
    values = [factor * factors[2] for factor in factors[:2]]
    if all(values):
        ours = Scalar(
            field, common_divisor(field, *(value.within(field).numerator_part for value in values)), field.one
        )
        extension = [sympy.sqrt(2), sympy.sqrt(3)]
        one, other, found = (
            sympy.Poly(scalar_to_sympy(value), *sympy.symbols("x k"), extension=extension) for value in (*values, ours)
        )
        assert found.monic() == sympy.gcd(one, other).monic()
