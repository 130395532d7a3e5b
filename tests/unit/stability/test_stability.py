"""Stability verdicts against polynomials with known roots, against NumPy away from the boundary, and on it by Sturm."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

import numpy as np
import pytest
import sympy
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st

from symobs.exact import Matrix, Scalar, from_coefficients, product_of
from symobs.formula.expression import parse_scalar
from symobs.stability.criteria.stability import (
    StabilityVerdict,
    hurwitz_matrix,
    lienard_chipart,
    monic,
    no_stable_compensator,
    stability,
    stable_somewhere,
)
from symobs.stability.inequalities.written_form import as_inequality
from tests.kit import tabled
from tests.support.independent_algebra.plain import (
    at_number,
    coefficients_at,
    is_hurwitz,
    random_fraction,
    seeded,
    value_at,
)

s, z = Scalar.symbol("s"), Scalar.symbol("z")
a, b, c, k = (Scalar.symbol(name) for name in ("a", "b", "c", "k"))
FAR = 1e-4  # numeric roots nearer to the boundary than this decide nothing


def verdict(polynomial: Scalar, *, discrete: bool = False, **signs: str) -> str:
    return stability(polynomial, "z" if discrete else "s", signs, discrete=discrete).verdict


def numeric(coefficients: list[int], variable: str = "s") -> Scalar:
    return from_coefficients([Scalar.of(x) for x in coefficients], variable)


integer_polynomials = st.lists(st.integers(-6, 6), min_size=2, max_size=7).filter(lambda found: found[0] != 0)
positive_polynomials = st.lists(st.integers(1, 12), min_size=3, max_size=7)

# -- known roots: exact, on the boundary too ---------------------------------------------------------------------------

tenths = st.integers(-12, 4).map(lambda n: Fraction(n, 3))


@st.composite
def known_roots(draw: st.DrawFn, variable: str) -> tuple[Scalar, list[tuple[Fraction, Fraction]]]:
    """A polynomial multiplied together from rational roots and pairs x ± iy, and these; any leading coefficient."""
    x = Scalar.symbol(variable)
    factors: list[Scalar] = [Scalar.of(draw(st.sampled_from([-3, -1, 1, 2])))]
    roots: list[tuple[Fraction, Fraction]] = []
    for _ in range(draw(st.integers(1, 4))):
        if variable == "z":  # points in, on and outside the circle, (3 + 4i)/5 among those on it
            real, imaginary = draw(st.sampled_from([(-3, 4), (0, 5), (5, 0), (-5, 0), (1, 2), (0, 0), (4, -1), (6, 1)]))
            found = Fraction(real, 5), Fraction(imaginary, 5)
        else:
            found = draw(tenths), draw(st.sampled_from([Fraction(0), Fraction(1), Fraction(3, 2)]))
        square = (x - Scalar.of(found[0])) ** 2 + Scalar.of(found[1] ** 2)
        factors.append(square if found[1] else x - Scalar.of(found[0]))
        roots.append(found)
    return product_of(factors), roots


@given(known_roots("s"))
@example((s**2 + 1, [(Fraction(0), Fraction(1))]))
@example((s, [(Fraction(0), Fraction(0))]))
@example(((s**2 + 1) ** 2 * (s + 1), [(Fraction(0), Fraction(1)), (Fraction(-1), Fraction(0))]))
def test_known_roots_in_continuous_time(drawn: tuple[Scalar, list[tuple[Fraction, Fraction]]]) -> None:
    polynomial, roots = drawn
    assert verdict(polynomial) == ("yes" if all(real < 0 for real, _ in roots) else "no")


@given(known_roots("z"))
@example((z - 1, [(Fraction(1), Fraction(0))]))
@example((z + 1, [(Fraction(-1), Fraction(0))]))
@example((z**3, [(Fraction(0), Fraction(0))]))
@example((z**2 + 1, [(Fraction(0), Fraction(1))]))
def test_known_roots_in_discrete_time(drawn: tuple[Scalar, list[tuple[Fraction, Fraction]]]) -> None:
    polynomial, roots = drawn
    inside = all(real**2 + imaginary**2 < 1 for real, imaginary in roots)
    assert verdict(polynomial, discrete=True) == ("yes" if inside else "no")


# -- any integer polynomial --------------------------------------------------------------------------------------------


def on_the_imaginary_axis(coefficients: list[int]) -> bool:
    """Whether a root has real part 0: whether real and imaginary part of p(iω) have a common real root, by Sturm."""
    w = sympy.Symbol("w", real=True)
    value = sympy.expand(sympy.Poly(coefficients, sympy.Symbol("x")).as_expr().subs("x", sympy.I * w))
    real, imaginary = (sympy.Poly(part, w) for part in value.as_real_imag())
    return bool(sympy.gcd(real, imaginary).count_roots())


@given(integer_polynomials | positive_polynomials)
@example([1, 1, 1, 1])
@example([1, 1, 4, 2, 3])
@example([1, 2, 3, 4, 2])
@settings(max_examples=80)
def test_integer_polynomials_in_continuous_time(coefficients: list[int]) -> None:
    largest = float(max(np.roots(coefficients).real))
    expected = "yes" if largest < 0 else "no"
    if abs(largest) < FAR:
        assume(on_the_imaginary_axis(coefficients))
        expected = "no"
    assert verdict(numeric(coefficients)) == expected
    assert is_hurwitz([Fraction(x) for x in coefficients]) == (expected == "yes")


@given(st.tuples(st.just(12), st.integers(-9, 9), st.integers(-9, 9), st.integers(-5, 5)).map(list))
@example([12, 0, 0, 12])
@example([2, 1, 1])
@settings(max_examples=80)
def test_integer_polynomials_in_discrete_time(coefficients: list[int]) -> None:
    largest = float(max(abs(np.roots(coefficients))))
    assume(
        abs(largest - 1) > FAR or any(at_number([Fraction(x) for x in coefficients], Fraction(t)) == 0 for t in (1, -1))
    )
    expected = "yes" if largest < 1 - FAR else "no"
    assert verdict(numeric(coefficients, "z"), discrete=True) == expected


# -- parameters --------------------------------------------------------------------------------------------------------

PARAMETRIC = [
    (s**2 + (b + k) * s + a**2 * (1 - c), {"a": "positive", "b": "positive"}),
    (s**2 + (b + k) * s + a**2 * (c - 1), {"a": "nonzero", "b": "positive"}),
    (s**3 + a * s**2 + b * s + c, {}),
    (s**3 + a * s**2 + b * s + c, {"a": "positive", "b": "positive", "c": "positive"}),
    (s**4 + a * s**3 + 3 * s**2 + b * s + 1, {"a": "nonnegative"}),
    (s**5 + 3 * s**4 + a * s**3 + 7 * s**2 + b * s + 1, {}),
    ((s + a) * (s + b), {"a": "positive", "b": "positive"}),
    ((s + a) * (s + b), {"a": "positive", "b": "negative"}),
    ((s + a) * (s + b), {"a": "positive", "b": "nonpositive"}),
    (s**2 + a**2 * s + b**2, {}),
    (s + a**2, {}),
    (s + a * b**2, {"a": "positive"}),
    (s - a**2 - 1, {}),
    ((s + a) ** 2 + b**2, {"a": "nonnegative"}),
    (s**2 + s + (a - b) ** 2 * (a + 1), {"a": "positive"}),
    (s**2 + a * s - b, {"a": "positive", "b": "negative"}),
]
#: The leading coefficient may be of either sign, or its sign may hang on the parameters.
NOT_MONIC = [
    (-s - 1, {}),
    (a * s + 1, {"a": "positive"}),
    (-a * s - b, {"a": "positive", "b": "positive"}),
    (a * s - 1, {}),
    (a * s - 1, {"a": "nonzero"}),
    (-b * s - 1, {"b": "nonnegative"}),
    (a * s + a + 1, {}),
    (a * s**2 + s + b, {}),
    (a * s**3 - s**2 + b * s - 1, {}),
    (a * s**2 - s - 1, {"a": "negative"}),
]


def compare(polynomial: Scalar, signs: dict[str, str]) -> None:
    """Hold the verdict against Routh's scheme at 200 points; where the degree drops there is nothing to compare."""
    found = stability(polynomial, "s", signs, discrete=False)
    assert (found.verdict == "conditional") == bool(found.positive)
    generator, names = seeded((polynomial, signs)), sorted(polynomial.names - {"s"})
    outcomes = set()
    for _ in range(200):
        point = {name: random_fraction(generator, signs.get(name, "real")) / 5 for name in names}
        coefficients = coefficients_at(polynomial, "s", point)
        if coefficients[0] == 0:
            continue
        stable = is_hurwitz(coefficients)
        outcomes.add(stable)
        if found.verdict == "conditional":
            assert stable == all(value_at(value, point) > 0 for value in found.positive), point
        else:
            assert stable == (found.verdict == "yes"), point
    if found.verdict == "conditional" and names:
        assert True in outcomes


@pytest.mark.parametrize(("polynomial", "signs"), PARAMETRIC, ids=str)
def test_conditions_with_parameters_are_exact(polynomial: Scalar, signs: dict[str, str]) -> None:
    compare(polynomial, signs)


@pytest.mark.parametrize(("polynomial", "signs"), NOT_MONIC, ids=str)
def test_the_leading_coefficient_may_have_any_sign(polynomial: Scalar, signs: dict[str, str]) -> None:
    compare(polynomial, signs)
    for discrete in (False, True):  # a page may say it of either form
        assert stability(polynomial, "s", signs, discrete=discrete) == stability(
            monic(polynomial, "s"), "s", signs, discrete=discrete
        )


@pytest.mark.parametrize(
    "polynomial",
    [z**2 + a * z + b, z - a, z**2 + a * z, (z - a) * (z - b), z**3 + a * z + Scalar.rational(1, 8)],
    ids=str,
)
def test_conditions_in_discrete_time_are_exact(polynomial: Scalar) -> None:
    found = stability(polynomial, "z", {}, discrete=True)
    generator, both = seeded(polynomial), set()
    for _ in range(200):
        point = {name: random_fraction(generator) / 20 for name in ("a", "b")}
        largest = max(abs(np.roots([float(x) for x in coefficients_at(polynomial, "z", point)])))
        if abs(largest - 1) > FAR:
            both.add(largest < 1)
            assert (largest < 1) == all(value_at(value, point) > 0 for value in found.positive), point
    assert both == {True, False}


@pytest.mark.parametrize(
    ("polynomial", "signs", "expected"),
    [
        # S4-PEND-DOWN and S4-PEND-UP: h1 < 1, h2 > −b and h1 > 1, h2 > −b
        ("down", {"omega": "positive", "b": "positive"}, {"h1 < 1", "h2 > -b"}),
        ("up", {"omega": "positive", "b": "positive"}, {"h1 > 1", "h2 > -b"}),
    ],
)
def test_the_pendulum_of_the_catalogue(polynomial: str, signs: dict[str, str], expected: set[str]) -> None:
    h1, h2, omega = (Scalar.symbol(name) for name in ("h1", "h2", "omega"))
    constant = omega**2 * (1 - h1)
    chi = s**2 + (b + h2) * s + (constant if polynomial == "down" else -constant)
    assert set(stability(chi, "s", signs, discrete=False).inequalities(signs)) == expected


@tabled
def test_one_unstable_factor_settles_what_the_coefficients_leave_open(polynomial: str, discrete: bool) -> None:  # noqa: FBT001
    value = parse_scalar(polynomial, variable="s")
    assert stability(value, "s", {}, discrete=discrete) == StabilityVerdict("no")


def test_inequalities_of_settled_verdicts() -> None:
    assert StabilityVerdict("yes").inequalities({}) == []
    assert StabilityVerdict("no").inequalities({}) == ["False"]
    assert StabilityVerdict("conditional", (a * b - c,)).inequalities({"c": "positive"}) == ["c < a*b"]


@pytest.mark.parametrize(
    "positive", [1 - a, a + b, -a - b, a * b - c, 2 * a - 1, a**2 - b, c - a * b, a * b - a], ids=str
)
@pytest.mark.parametrize("signs", [{}, {"a": "positive"}, {"b": "negative", "c": "positive"}], ids=str)
def test_a_solved_inequality_says_the_same(positive: Scalar, signs: dict[str, str]) -> None:
    left, operator, right = as_inequality(positive, signs)
    generator = seeded(positive)
    for _ in range(100):
        point = {name: random_fraction(generator, signs.get(name, "real")) for name in ("a", "b", "c")}
        l, r = value_at(left, point), value_at(right, point)
        assert operator in {"<", ">"}
        assert (l < r if operator == "<" else l > r) == (value_at(positive, point) > 0)


@pytest.mark.parametrize(
    ("positive", "signs", "parameters", "beside", "expected"),
    [
        (b * k - c, {"b": "positive"}, (), (), "c < b*k"),  # a coefficient ±1 before any other
        (b * k - c, {"b": "positive"}, ("k",), (), "k > c/b"),
        (b * k - c, {"b": "negative", "c": "positive"}, (), (), "k < c/b"),
        (2 * a - 1, {}, (), (), "a > 1/2"),
        (3 * a * c - c**2 - 9, {}, ("a",), (), "3*a*c - c**2 - 9 > 0"),
        (3 * a * c - c**2 - 9, {}, ("a",), (c,), "a > (c**2 + 9)/(3*c)"),
        ((a + b) ** 2, {"b": "positive"}, (), (), "a != -b"),
        (a**2 * b**2, {}, (), (), "a*b != 0"),
        (a**2 + b**2, {}, (), (), "a**2 + b**2 > 0"),
    ],
    ids=str,
)
def test_what_an_inequality_is_solved_for(
    positive: Scalar, signs: dict[str, str], parameters: tuple[str, ...], beside: tuple[Scalar, ...], expected: str
) -> None:
    left, operator, right = as_inequality(positive, signs, parameters, beside)
    assert f"{left} {operator} {right}" == expected


def test_the_other_list_of_lienard_and_chipart() -> None:
    for about, _ in PARAMETRIC:
        coefficients = monic(about, "s").coefficients("s")
        for point in ({name: random_fraction(seeded((about, n))) for name in "abck"} for n in range(40)):
            lists = [lienard_chipart(coefficients, others=others) for others in (False, True)]
            stable = is_hurwitz(coefficients_at(about, "s", point))
            assert [all(value_at(v, point) > 0 for v in found) for found in lists] == [stable, stable]


def test_the_hurwitz_matrix_is_the_one_of_the_books() -> None:
    coefficients = [Scalar.symbol(f"a{i}") for i in range(5)]
    a0, a1, a2, a3, a4 = coefficients
    zero = Scalar.of(0)
    expected: list[list[Any]] = [[a1, a3, zero, zero], [a0, a2, a4, zero], [zero, a1, a3, zero], [zero, a0, a2, a4]]
    assert hurwitz_matrix(coefficients) == Matrix.of(expected)


def test_monic() -> None:
    assert monic(3 * s**2 + a * s - 6, "s") == s**2 + a / 3 * s - 2
    assert monic(a * s + 1, "s") == s + 1 / a


# -- compensators that cannot be stable --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("above", "below", "forbidden"),
    [
        (s - 1, (s - 2) * (s - 3), False),  # two poles beyond the zero: parity is even
        (s - 1, s * (s - 2), True),  # one pole beyond it
        (s - 3, s * (s - 2), False),  # the pole lies before it
        (s + 1, s * (s - 2), False),  # no zero in the right half-plane
        ((s - 1) * (s - 3), (s - 2) * (s - 4) * (s + 1), True),  # 1 has two poles beyond it, 3 has one
        (s**2 - 2, s**2 * (s**2 - 9), True),  # zeros ±√2, poles 0, 0, ±3
        (s**2 + 2, s**2 * (s**2 - 9), False),  # zeros on the axis
        (
            -(s**2) - 4 * s + 2,
            s**2 - 3 * s - 1,
            False,
        ),  # u = -8/7 y: what enters y at once may change the sign at infinity
        (-(s - 1) * (s + 4), (s - 2) * (s + 3), False),  # u = -8/7 y stabilises it, as the polynomial of the loop shows
    ],
)
def test_a_stable_compensator_is_ruled_out_by_the_parity_of_poles_beyond_a_zero(
    above: Scalar, below: Scalar, *, forbidden: bool
) -> None:
    assert no_stable_compensator(above / below, "s", {}) is forbidden


def test_signs_decide_about_zeros_with_parameters() -> None:
    plant = (s - a) / (s**2 - b)
    assert not no_stable_compensator(plant, "s", {"a": "positive", "b": "positive"})
    assert no_stable_compensator((s - a) / (s * (s - a - b)), "s", {"a": "positive", "b": "positive"})
    assert not no_stable_compensator((s - a) / (s * (s - a - b)), "s", {"a": "positive"})


def test_points_prove_that_both_outcomes_occur() -> None:
    assert stable_somewhere(s + a, "s", {}, discrete=False) == {True, False}
    assert stable_somewhere(s + a, "s", {"a": "positive"}, discrete=False) == {True}
    assert stable_somewhere(s**2 + a**2 * s + b**2 + 1, "s", {"a": "nonzero"}, discrete=False) == {True}
    assert stable_somewhere(z - a, "z", {"a": "positive"}, discrete=True) == {True, False}


def test_a_parameter_that_nobody_declared_is_real() -> None:
    """Of s³ − (a + 1) s² + a s + 1 the second Hurwitz determinant is −a² − a − 1, which is negative for every real a."""
    polynomial = s**3 - (a + 1) * s**2 + a * s + 1
    verdicts = {stability(polynomial, "s", signs, discrete=False).verdict for signs in ({}, {"a": "real"})}
    assert verdicts == {"no"}
