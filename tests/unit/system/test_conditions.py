"""What declared signs imply: every verdict of the sign rules held against values that have those signs."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from symobs.exact import Scalar
from symobs.formula.expression import parse_scalar
from symobs.system.conditions import (
    SIGNS,
    Condition,
    _power_sign,
    _product_sign,
    _sum_sign,
    never_zero,
    of_open_sign,
    opposite,
    sign_of,
    vanishing_factors,
)
from tests.kit import tables
from tests.support.algebra import has_sign, random_fraction, seeded, value_at
from tests.support.problems.strategies import Twin, polynomials, rational_functions

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

a, b, c = (Scalar.symbol(name) for name in "abc")

ALL = [*SIGNS, "zero"]
#: Values of each sign, enough to tell the signs apart in sums and products.
VALUES = {sign: [x for x in (-3, -2, -1, 0, 1, 2, 3) if has_sign(Fraction(x), sign)] for sign in ALL}


def tightest(values: Iterable[int]) -> str:
    """Return the strongest sign that all values have."""
    found = list(values)
    order = ["zero", "positive", "negative", "nonnegative", "nonpositive", "nonzero", "real"]
    return next(sign for sign in order if all(has_sign(Fraction(x), sign) for x in found))


class TestRules:
    @pytest.mark.parametrize(("left", "right"), list(product(ALL, ALL)))
    def test_a_product_has_the_strongest_sign_that_is_certain(self, left: str, right: str) -> None:
        assert _product_sign(left, right) == tightest(x * y for x in VALUES[left] for y in VALUES[right])

    @pytest.mark.parametrize(("left", "right"), list(product(ALL, ALL)))
    def test_a_sum_has_the_strongest_sign_that_is_certain(self, left: str, right: str) -> None:
        assert _sum_sign(left, right) == tightest(x + y for x in VALUES[left] for y in VALUES[right])

    @pytest.mark.parametrize(("sign", "exponent"), list(product(SIGNS, [-3, -2, -1, 1, 2, 3, 4])))
    def test_a_power_has_the_strongest_sign_that_is_certain(self, sign: str, exponent: int) -> None:
        values = [Fraction(x) ** exponent for x in VALUES[sign] if x or exponent > 0]
        found = _power_sign(sign, exponent)
        assert all(has_sign(Fraction(value), found) for value in values)
        if exponent > 0:
            assert found == tightest(int(value) for value in values)

    @pytest.mark.parametrize("sign", SIGNS)
    def test_the_opposite_is_the_sign_of_the_negative(self, sign: str) -> None:
        assert opposite(sign) == tightest(-x for x in VALUES[sign])


signs_of_names = st.fixed_dictionaries({name: st.sampled_from(SIGNS) for name in "abs"})


def points(signs: Mapping[str, str], seed: object, count: int = 25) -> list[dict[str, Fraction]]:
    """Random points with the declared signs; the first has 0 and ±1 wherever the signs allow."""
    generator = seeded(seed)
    simple = {
        name: Fraction(0 if has_sign(Fraction(0), sign) else 1 if has_sign(Fraction(1), sign) else -1)
        for name, sign in signs.items()
    }
    return [simple, *({n: random_fraction(generator, sign) for n, sign in signs.items()} for _ in range(count))]


def values_at(scalar: Scalar, signs: Mapping[str, str]) -> list[tuple[dict[str, Fraction], Fraction]]:
    """Return the values where the scalar is defined."""
    return [(p, value_at(scalar, p)) for p in points(signs, scalar) if value_at(scalar.denominator, p)]


class TestValues:
    @given(rational_functions(), signs_of_names)
    @settings(max_examples=60)
    def test_what_is_certain_is_true_at_every_point(self, x: Twin, signs: dict[str, str]) -> None:
        found = sign_of(x.scalar, signs)
        for point, value in values_at(x.scalar, signs):
            assert has_sign(Fraction(value), found), (x.scalar, signs, point)
            assert not never_zero(x.scalar, signs) or value != 0

    @given(polynomials(degree=2, most=2), polynomials(degree=1, most=2), signs_of_names)
    @settings(max_examples=60)
    def test_what_is_certain_of_a_product_of_factors_is_true(self, x: Twin, y: Twin, signs: dict[str, str]) -> None:
        value = x.scalar**2 * y.scalar * (a - b)
        found = sign_of(value, signs)
        for point, number in values_at(value, signs):
            assert has_sign(Fraction(number), found), (value, signs, point)

    @given(polynomials(degree=1, most=2), polynomials(degree=2, most=2), signs_of_names)
    @settings(max_examples=60)
    def test_where_a_value_vanishes_one_of_its_vanishing_factors_does(
        self, x: Twin, y: Twin, signs: dict[str, str]
    ) -> None:
        value = x.scalar * y.scalar * a / (b + 7)
        factors = vanishing_factors([value, Scalar.of(3)], signs)
        assert len(set(factors)) == len(factors)
        for factor in factors:
            assert not (value / factor).denominator.names & (factor.names - {"b"})
        for point, number in values_at(value, signs):
            if number == 0 and not value.is_zero:
                assert any(value_at(factor, point) == 0 for factor in factors), (value, signs, point)

    @given(polynomials(degree=1, most=2), polynomials(degree=2, most=2), signs_of_names)
    @settings(max_examples=60)
    def test_what_is_left_has_the_sign_of_the_value(self, x: Twin, y: Twin, signs: dict[str, str]) -> None:
        value = x.scalar**2 * y.scalar * a / (b + 7)
        for point, number in values_at(value, signs):
            left = value_at(of_open_sign(value, signs), point)
            assert (left > 0) - (left < 0) == (number > 0) - (number < 0), (value, signs, point)

    def test_factors_of_known_sign_are_left_out(self) -> None:
        positive = {"a": "positive", "b": "positive"}
        assert of_open_sign(a**2 * b**2 - a**2, positive) == b - 1
        assert of_open_sign((1 - b) * -a, positive) == b - 1
        assert of_open_sign((a**2 - b**2) / (2 * a), positive) == a - b
        assert of_open_sign(a**2 - b**2, {}) == a**2 - b**2
        assert of_open_sign(-a, positive) == -a

    @pytest.mark.parametrize(("text", "signs", "expected"), tables(Path(__file__))["known_signs"])
    def test_known_signs(self, text: str, signs: dict[str, str], expected: str) -> None:
        value = parse_scalar(text, functions=True)
        assert sign_of(value, signs) == expected
        assert never_zero(value, signs) == (expected in {"positive", "negative", "nonzero"})

    @pytest.mark.parametrize("word", ["positiv", "complex"])
    def test_a_word_that_is_no_sign_says_nothing(self, word: str) -> None:
        signs = {"a": word, "b": "positive"}
        assert {sign_of(value, signs) for value in (a, a * b, -a, a + b, 1 / a, a**3)} == {"real"}
        assert not never_zero(a, signs)
        assert vanishing_factors([a * b], signs) == (a,)

    def test_vanishing_factors_leave_out_what_the_signs_exclude(self) -> None:
        value = a**2 * (a - b) ** 3 * (b**2 + 1) / (c + 1)
        assert set(vanishing_factors([value], {})) == {a, a - b}
        assert vanishing_factors([value], {"a": "positive"}) == (a - b,)
        assert vanishing_factors([value], {"a": "positive", "b": "nonpositive"}) == ()
        assert vanishing_factors([Scalar.of(5), 1 / a], {}) == ()
        assert vanishing_factors([a * b, b * c], {"a": "nonzero"}) == (b, c)

    def test_a_condition_is_printed_as_a_relation_with_zero(self) -> None:
        assert str(Condition("claim", 2 * c - 1)) == "2*c - 1 != 0"
        assert str(Condition("existence", c, "==")) == "c == 0"
