"""Stability verdicts against polynomials with known roots, against NumPy away from the boundary, and on it by Sturm."""

from __future__ import annotations

from fractions import Fraction

from hypothesis import example, given
from hypothesis import strategies as st

from symobs.exact import Scalar, product_of
from symobs.formula.expression import parse_scalar
from symobs.stability.criteria.stability import (
    StabilityVerdict,
    no_stable_compensator,
    stability,
)
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
def test_one_unstable_factor_settles_what_the_coefficients_leave_open(polynomial: str, discrete: bool) -> None:  # noqa: FBT001
    value = parse_scalar(polynomial, variable="s")
    assert stability(value, "s", {}, discrete=discrete) == StabilityVerdict("no")


# -- compensators that cannot be stable --------------------------------------------------------------------------------


@tabled
def test_a_stable_compensator_is_ruled_out_by_the_parity_of_poles_beyond_a_zero(
    above: str, below: str, *, forbidden: bool
) -> None:
    assert no_stable_compensator(scalar(above) / scalar(below), "s", {}) is forbidden


def test_a_parameter_that_nobody_declared_is_real() -> None:
    """Of s³ − (a + 1) s² + a s + 1 the second Hurwitz determinant is −a² − a − 1, which is negative for every real a."""
    polynomial = s**3 - (a + 1) * s**2 + a * s + 1
    verdicts = {stability(polynomial, "s", signs, discrete=False).verdict for signs in ({}, {"a": "real"})}
    assert verdicts == {"no"}
