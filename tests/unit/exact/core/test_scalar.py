"""Scalars, complex numbers, roots and factored forms of the kernel, held against SymPy and `Fraction`."""

from __future__ import annotations

import itertools
import operator
import pickle
from math import gcd, prod
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import sympy
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from symobs.exact import (
    RATIONALS,
    Complex,
    Factored,
    Field,
    Root,
    Scalar,
    factored,
    from_coefficients,
    product_of,
    root_of_pole,
    roots_of,
)
from symobs.exact.algebraic.polynomial_roots import polynomial_of_roots
from symobs.exact.sympy_bridge.conversion import (
    complex_from_sympy,
    complex_to_sympy,
    factored_to_sympy,
    root_to_sympy,
    scalar_from_sympy,
    scalar_to_sympy,
)
from tests.kit import scalar, tables
from tests.support.problems.strategies import (
    Twin,
    combined,
    large_integers,
    numeric_entries,
    polynomials,
    rational_functions,
    small_fractions,
)

if TYPE_CHECKING:
    from fractions import Fraction

a, b, c, s = (Scalar.symbol(name) for name in "abcs")
LOCALS = {name: sympy.Symbol(name) for name in ("a", "b", "s", "x")}


def read_back(text: str) -> Any:
    """Read our own text with SymPy's parser, the other party of this test."""
    return sympy.sympify(text, locals=LOCALS)  # noqa: TID251 - text the kernel wrote, never a user's


def same(scalar: Scalar, expression: Any) -> bool:
    """Compare by SymPy, from the scalar's terms."""
    symbols = {name: sympy.Symbol(name) for name in scalar.field.names}
    above, below = (
        sympy.Add(
            *(k * prod((symbols[n] ** e for n, e in powers), start=sympy.Integer(1)) for k, powers in part.terms())
        )
        for part in (scalar.numerator, scalar.denominator)
    )
    return bool(sympy.cancel(above / below - expression) == 0)


#: Examples a test: SymPy is the slow party here.
few = settings(max_examples=15)


class TestField:
    def test_generators_stand_in_one_order_whatever_order_they_came_in(self) -> None:
        assert Field.of("bsa").names == Field.of("abs").names == ("s", "a", "b")
        assert Field.of(("t", "omega", "z")).names == ("z", "t", "omega")
        assert Field.of(("a", "a")) is Field.of("a")

    def test_joining_is_the_smallest_field_of_both(self) -> None:
        joined = Field.of("ab") | Field.of("bs")
        assert joined is Field.of("abs")
        assert Field.of("ab") <= joined
        assert not joined <= Field.of("ab")
        assert (RATIONALS | joined) is joined
        assert (joined | RATIONALS) is joined


class TestScalars:
    @given(rational_functions(), rational_functions())
    @few
    def test_arithmetic_is_that_of_sympy(self, x: Twin, y: Twin) -> None:
        for operation in (operator.add, operator.sub, operator.mul):
            pair = combined(operation, x, y)
            assert same(pair.scalar, pair.expression)
        if y.scalar.is_zero:
            with pytest.raises(ZeroDivisionError):
                x.scalar / y.scalar
        else:
            pair = combined(operator.truediv, x, y)
            assert same(pair.scalar, pair.expression)

    @given(rational_functions(), rational_functions())
    @few
    @example(Twin(a / (a - b), None), Twin(-a / (b - a), None))
    def test_values_are_equal_exactly_when_their_difference_is_zero(self, x: Twin, y: Twin) -> None:
        assert (x.scalar == y.scalar) == (x.scalar - y.scalar).is_zero

    @given(rational_functions(("a", "b")))
    @few
    def test_equality_hash_and_text_do_not_depend_on_the_field_around(self, x: Twin) -> None:
        wide = x.scalar.within(x.scalar.field | Field.of(("A", "aa", "s", "z", "zeta")))
        detour = x.scalar + s - s
        fresh = x.scalar.within(Field.of(x.scalar.names))
        for other in (wide, detour, fresh):
            assert other == x.scalar
            assert x.scalar == other
            assert hash(other) == hash(x.scalar)
            assert str(other) == str(x.scalar)
            assert other.names == x.scalar.names
            assert other.fingerprint() == x.scalar.fingerprint()

    def test_a_scalar_equals_no_text_and_no_float_is_taken(self) -> None:
        assert a != "a"
        for inexact in (0.5, 1j, None):
            with pytest.raises(TypeError, match="not an exact number"):
                Scalar.of(inexact)

    @given(rational_functions())
    @few
    def test_the_text_is_read_by_sympy_as_the_same_value(self, x: Twin) -> None:
        assert same(x.scalar, read_back(str(x.scalar)))
        assert scalar_from_sympy(scalar_to_sympy(x.scalar), "here") == x.scalar

    @given(rational_functions(), rational_functions(("b", "c")), small_fractions)
    @few
    def test_substitution_is_that_of_sympy(self, x: Twin, image: Twin, number: Fraction) -> None:
        symbols = sympy.symbols("a s b")
        values = {"a": image.scalar, "s": Scalar.of(number), "unused": b}
        images = {symbols[0]: image.expression, symbols[1]: sympy.Rational(number.numerator, number.denominator)}
        below = same_time(scalar_to_sympy(x.scalar.denominator), images)
        if sympy.cancel(below) == 0:
            with pytest.raises(ZeroDivisionError):
                x.scalar.substitute(values)
        else:
            assert same(x.scalar.substitute(values), same_time(scalar_to_sympy(x.scalar), images))

    def test_substitution_is_simultaneous(self) -> None:
        assert (a / b + s).substitute({"a": b, "b": a}) == b / a + s

    @given(polynomials(("a", "b", "s"), degree=3))
    @few
    def test_coefficients_and_degree_put_the_polynomial_together_again(self, x: Twin) -> None:
        value = x.scalar / (a + 7)
        coefficients = value.coefficients("s")
        assert from_coefficients(coefficients, "s") == value
        assert all("s" not in coefficient.names for coefficient in coefficients)
        if x.scalar:
            assert value.degree("s") == len(coefficients) - 1 == sympy.Poly(x.expression, sympy.Symbol("s")).degree()
        else:
            assert value.degree("s") == -1
        assert value.is_polynomial_in("s")
        assert not (1 / (s + a)).is_polynomial_in("s")


def same_time(expression: Any, images: dict[Any, Any]) -> Any:
    return expression.subs(images, simultaneous=True)


class TestFactors:
    @given(polynomials(degree=2), polynomials(degree=1), st.integers(1, 3))
    @few
    def test_factors_multiply_back_and_sympy_finds_as_many(self, x: Twin, y: Twin, power: int) -> None:
        value = x.scalar**power * y.scalar / (a + 2 * b)
        unit, factors = value.factors()
        assert product_of([unit, *(factor**k for factor, k in factors)]) == value
        assume(bool(value))
        expected = sympy.factor_list(scalar_to_sympy(value.numerator))[1]
        assert sorted(k for _, k in factors if k > 0) == sorted(k for _, k in expected)
        assert all(factor.numerator.terms()[0][0] > 0 for factor, _ in factors)

    @given(large_integers, large_integers, large_integers, st.integers(1, 3))
    @few
    def test_coefficients_beyond_two_to_the_31_factor_too(self, p: int, q: int, r: int, power: int) -> None:
        assume(p != -q)
        value = (p * a + q * b) ** power * (s**2 + r) * (a - b) / (q * s + 1)
        unit, factors = value.factors()
        assert product_of([unit, *(factor**k for factor, k in factors)]) == value
        content = gcd(p, q) if p > 0 else -gcd(p, q)
        found = dict(factors)
        assert found[a - b] == 1
        assert found[(p * a + q * b) / content] == power
        assert found[(q * s + 1) if q > 0 else (-q * s - 1)] == -1

    def test_zero_and_constants_have_no_factors(self) -> None:
        assert Scalar.of(0).factors() == (Scalar.of(0), ())
        assert (a - a).factors()[1] == ()
        assert Scalar.rational(-6, 4).factors() == (Scalar.rational(-3, 2), ())

    @given(polynomials(("a", "s"), degree=2), polynomials(("b", "s"), degree=1))
    @few
    def test_the_factored_form_is_monic_and_keeps_value_and_text(self, x: Twin, y: Twin) -> None:
        assume(bool(x.scalar) and bool(y.scalar))
        value = x.scalar**2 * (s + a) / y.scalar
        form = factored(value, "s")
        assert form.value == value
        assert all(factor.coefficients("s")[0].is_one for factor, _ in form.factors)
        assert same(value, read_back(str(form)))
        assert sympy.cancel(factored_to_sympy(form, {}) - scalar_to_sympy(value)) == 0
        assert pickle.loads(pickle.dumps(form)) == form  # noqa: S301 - our own bytes

    def test_factors_that_are_not_monic_are_whole(self) -> None:
        form = factored((scalar("3/2") * s + 1) / (s + scalar("1/2")) ** 2, "s", monic=False)
        assert set(form.factors) == {(3 * s + 2, 1), (2 * s + 1, -2)}
        assert form.unit == Scalar.of(2)  # (3s + 2)/2 · 4/(2s + 1)²

    @pytest.mark.parametrize(("unit", "factors"), tables(Path(__file__))["awkward_forms"])
    def test_awkward_forms_are_read_back(self, unit: str, factors: list[tuple[str, int]]) -> None:
        form = Factored(scalar(unit), tuple((scalar(factor), power) for factor, power in factors))
        assert same(form.value, read_back(str(form)))


class TestRoots:
    @given(st.lists(polynomials(("s",), degree=2, most=3), min_size=1, max_size=3))
    @few
    def test_roots_of_numeric_polynomials_are_those_sympy_finds(self, parts: list[Twin]) -> None:
        value = product_of(part.scalar for part in parts)
        assume(value.degree("s") > 0)
        poly = sympy.Poly(scalar_to_sympy(value), sympy.Symbol("s"))
        found = [read_back(str(root)) for root in roots_of(value, "s")]
        expected = [root for root, count in sympy.roots(poly).items() for _ in range(count)]
        assert len(found) == poly.degree()
        assume(len(expected) == len(found))
        left = list(expected)
        for root in found:
            match = next(other for other in left if sympy.expand(root - other).equals(0))
            left.remove(match)
        assert polynomial_of_roots("s", roots_of(value, "s")) == value / value.coefficients("s")[0]

    @given(polynomials(("a", "b"), degree=1), polynomials(("a", "b"), degree=1), polynomials(("b",), degree=2))
    @few
    def test_parametric_roots_are_zeros_and_multiply_back(self, p: Twin, q: Twin, r: Twin) -> None:
        value = (s**2 + p.scalar * s + q.scalar) * (s - r.scalar)
        roots = roots_of(value, "s")
        assert polynomial_of_roots("s", roots) == value
        assert polynomial_of_roots("s", roots[1:]) != value
        symbol = sympy.Symbol("s")
        for root in roots:
            expression = root_to_sympy(root, {})
            assert sympy.simplify(read_back(str(root)) - expression) == 0
            assert sympy.expand(scalar_to_sympy(value).subs(symbol, expression)).equals(0)

    @given(small_fractions, small_fractions)
    @few
    def test_a_pole_is_a_root_of_its_real_factor(self, real: Fraction, imaginary: Fraction) -> None:
        pole = Complex(Scalar.of(real), Scalar.of(imaginary))
        root = root_of_pole(pole, "s")
        assert root.exact() == pole
        assert pickle.loads(pickle.dumps(root)) == root  # noqa: S301 - our own bytes
        assert isinstance(root, Root)
        assert same(root.factor, sympy.expand(prod_over({pole, pole.conjugate()})))


def prod_over(poles: set[Complex]) -> Any:
    return sympy.prod(sympy.Symbol("s") - complex_to_sympy(pole, {}) for pole in poles)


parts = numeric_entries | polynomials(("a",), degree=1, most=2)


class TestComplex:
    @given(parts, parts, parts, parts)
    @few
    def test_arithmetic_is_that_of_sympy(self, p: Twin, q: Twin, u: Twin, v: Twin) -> None:
        first, second = Complex(p.scalar, q.scalar), Complex(u.scalar, v.scalar)
        one, two = p.expression + sympy.I * q.expression, u.expression + sympy.I * v.expression
        for ours, theirs in (
            (first + second, one + two),
            (first - second, one - two),
            (first * second, one * two),
            (first**3, one**3),
            (first.conjugate(), p.expression - sympy.I * q.expression),
        ):
            assert sympy.expand(complex_to_sympy(ours, {}) - theirs) == 0
            assert sympy.expand(read_back(str(ours)) - theirs) == 0
            assert complex_from_sympy(complex_to_sympy(ours, {}), "here") == ours
        if (second.real**2 + second.imaginary**2).is_zero:
            with pytest.raises(ZeroDivisionError):
                first / second
        else:
            quotient = first / second
            assert quotient * second == first
            assert same(quotient.real * u.scalar - quotient.imaginary * v.scalar, p.expression)
            assert second**-2 * second * second == Complex.of(1)
            assert complex_from_sympy(read_back(str(quotient)), "here") == quotient
        assert hash(first - second + second) == hash(first)


@given(st.integers(0, 3), st.integers(0, 2))
def test_a_long_numerator_is_reduced_by_what_it_shares(shared: int, own: int) -> None:
    # The leading coefficient shares q with the denominator, the whole does not: held against FLINT's common divisor.
    p, q, r = a + 2 * b * c + 3, a * b - c + 1, 2 * a - 5 * b
    above = p**shared * (1 + a + b * s + q * s**2) ** 9 * (s + a) ** own
    below = p ** (shared // 2) * q * r**own
    assert len(above.numerator_part) > 150
    field = above.field | below.field
    numerator, denominator = (value.within(field).numerator_part for value in (above, below))
    found, common = Scalar.reduced(field, numerator, denominator), numerator.gcd(denominator)
    assert len(found.numerator_part) == len(numerator / common)
    assert found.numerator_part * denominator == numerator * found.denominator_part
    assert found.numerator_part.gcd(found.denominator_part).is_one()


def test_polynomials_alike_in_length_and_leading_term_have_different_hashes() -> None:
    a, b, c, d = (Scalar.symbol(name) for name in "abcd")
    permuted = [a**3 + p * b + q * c + r * d for p, q, r in itertools.permutations((2, 3, 5))]
    paired = [1 + a * b + c * d, 1 + a * c + b * d, 1 + a * d + b * c]
    for values in (permuted, paired, [1 / value for value in permuted + paired]):
        assert len({hash(value) for value in values}) == len(values)
    for value in permuted + paired:
        elsewhere = value + Scalar.symbol("z") - Scalar.symbol("z")
        assert elsewhere.field is not value.field
        assert elsewhere == value
        assert hash(elsewhere) == hash(value)
