"""Stability verdicts against polynomials with known roots, against NumPy away from the boundary, and on it by Sturm."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from symobs.exact import Scalar, product_of
from symobs.formula.expression import parse_scalar
from symobs.stability.criteria.stability import (
    StabilityVerdict,
    monic,
    no_stable_compensator,
    stability,
    stable_somewhere,
)
from symobs.stability.inequalities.simplify import as_inequality
from tests.kit import scalar, tabled
from tests.support.algebra import (
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


# -- parameters --------------------------------------------------------------------------------------------------------


#: The leading coefficient may be of either sign, or its sign may hang on the parameters.


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


@tabled
def test_conditions_with_parameters_are_exact(polynomial: str, signs: dict[str, str]) -> None:
    compare(scalar(polynomial), signs)


@tabled
def test_the_leading_coefficient_may_have_any_sign(text: str, signs: dict[str, str]) -> None:
    polynomial = scalar(text)
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


# -- compensators that cannot be stable --------------------------------------------------------------------------------


@tabled
def test_a_stable_compensator_is_ruled_out_by_the_parity_of_poles_beyond_a_zero(
    above: str, below: str, *, forbidden: bool
) -> None:
    assert no_stable_compensator(scalar(above) / scalar(below), "s", {}) is forbidden


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
