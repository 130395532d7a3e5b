"""What a page says of a desired polynomial that is given by what its roots are to do."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.core.generators import function
from symobs.formula.tree import Evaluated, Literal
from symobs.formula.tree.term import product
from symobs.proof.derivation.builder import relation
from symobs.system.specification.pole_patterns import TIME_CONSTANTS, bessel, overshoot_of, pair_ratio

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.formula.tree import Relation
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder
    from symobs.system.specification import DesiredPolynomial, PolePattern


def say_pattern(page: Builder, phi: Term, desired: DesiredPolynomial) -> None:
    """Say why φ is the polynomial that is meant."""
    pattern = desired.pattern
    assert pattern is not None  # noqa: S101 - asked only where there is one
    others = [page.value(factor) for factor in desired.factors[len(pattern.factors) :]]
    values, beside = dict(pattern.values), "_beside" if others else ""

    def written(own: Term) -> Relation:
        return relation(phi, product([own, *others]))

    match pattern.kind:
        case "butterworth":
            page.conclude(f"pattern_butterworth{beside}", identity=_mirrored(page, pattern))
        case "bessel":
            page.conclude(f"pattern_bessel{beside}", recursion=written(_recursion(page, pattern)))
        case "itae":
            stated = written(page.value(pattern.polynomial))
            if others:
                page.conclude("pattern_itae_beside", polynomial=stated)
            else:
                page.conclude("pattern_itae", stated)
        case _:
            _say_pair(page, pattern, values, written)


def _say_pair(
    page: Builder, pattern: PolePattern, values: dict[str, Scalar], written: Callable[[Term], Relation]
) -> None:
    """Write s² + 2 ζ ω₀ s + ω₀² where ζ is given, (s + σ)² + ω² where σ follows from the settling time."""
    _, twice, square = pattern.polynomial.coefficients(pattern.variable)
    sigma = twice / 2
    if "damping" in values:
        damping = page.value(values["damping"])
        frequency = page.value(values.get("natural_frequency", sigma / values["damping"]))
        pair = page("s^2 + 2 {damping} {frequency} s", damping=damping, frequency=frequency) + frequency**2
        if "natural_frequency" in values:
            page.conclude("pattern_damping", damping=damping, frequency=frequency, pair=written(pair))
        else:
            page.conclude("pattern_damped", pair=written(pair))
    if "settling_time" in values:
        pair = page("(s + {sigma})^2", sigma=sigma) + page.value(square - sigma**2)
        decayed = relation(function("exp", Scalar.of(-TIME_CONSTANTS)), "<=", Scalar.of(1) / 50)
        complex_and_stable = relation(sigma, ">", Scalar.of(0)), relation(square - sigma**2, ">", Scalar.of(0))
        time = Evaluated(
            page("{count} / {sigma}", count=TIME_CONSTANTS, sigma=sigma).formula,
            Literal(values["settling_time"]),
        )
        page.conclude("pattern_settling", *complex_and_stable, time=time, pair=written(pair), bound=decayed)
    if "overshoot" in values:
        bound = relation(overshoot_of(pair_ratio(values["overshoot"])), "<=", values["overshoot"])
        page.conclude("pattern_overshoot", bound=bound)


def _mirrored(page: Builder, pattern: PolePattern) -> Relation:
    """Return p(s) p(−s) = ω₀²ⁿ + (−1)ⁿ s²ⁿ, with its factors."""
    ((_, radius),), variable = pattern.values, pattern.variable
    degree, away = pattern.polynomial.degree(variable), {variable: -Scalar.symbol(variable)}
    factors = [*pattern.factors, *(factor.substitute(away) for factor in pattern.factors)]
    powers = page.value(radius ** (2 * degree)), page.s ** (2 * degree)
    circle = powers[0] - powers[1] if degree % 2 else powers[0] + powers[1]
    return relation(product([page.value(factor) for factor in factors]), circle)


def _recursion(page: Builder, pattern: PolePattern) -> Term:
    """Return Θₙ as (2n − 1) ω₀ Θₙ₋₁ + s² Θₙ₋₂; s + ω₀ where n = 1."""
    ((_, frequency),), variable = pattern.values, pattern.variable
    degree = pattern.polynomial.degree(variable)
    if degree == 1:
        return page.value(pattern.polynomial)
    before = [page.value(bessel(degree - k, frequency, variable)) for k in (1, 2)]
    second = page["s^2"] if degree == 2 else page["s^2"] @ before[1]
    return page.value((2 * degree - 1) * frequency) @ before[0] + second
