"""Stability of a polynomial, exactly: Liénard and Chipart in continuous time, the bilinear map in discrete time.

A polynomial a₀ sⁿ + … + aₙ with a₀ > 0 has all its roots in Re s < 0 exactly when aₙ, aₙ₋₂, … and the Hurwitz
determinants Δₙ₋₁, Δₙ₋₃, … are positive.  For |z| < 1 the same is asked of (w − 1)ⁿ a((w + 1)/(w − 1)).
"""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

from symobs.exact import Matrix, Scalar, from_coefficients, resultant
from symobs.exact.core.generators import function_named
from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.simplify import as_inequality
from symobs.system.conditions import FACTORED_UP_TO, sign_of, vanishing_factors

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Mapping, Sequence

#: How many points are tried before it is left open whether a polynomial can be stable, and can be unstable.
_POINTS = 60


@dataclass
class StabilityVerdict:
    """`verdict` yes, no or conditional; `positive` are the polynomials that must be > 0 where it is conditional."""

    verdict: str
    positive: tuple[Scalar, ...] = ()

    def inequalities(self, signs: Mapping[str, str]) -> list[str]:
        """Return the conditions as texts: none if always stable, `False` if never."""
        if self.verdict == "no":
            return ["False"]
        solved = (as_inequality(value, signs) for value in self.positive)
        return [f"{left} {operator} {right}" for left, operator, right in solved]


def stability(polynomial: Scalar, variable: str, signs: Mapping[str, str], *, discrete: bool) -> StabilityVerdict:
    """Return whether every root lies in Re s < 0 (|z| < 1), or the conditions under which it does.

    Parameters that nobody declared are real.
    """
    signs = {
        **dict.fromkeys((name for name in polynomial.names - {variable} if not function_named(name)), "real"),
        **signs,
    }
    found = polynomial.coefficients(variable)
    if len(found) == 1:
        return StabilityVerdict("yes")
    coefficients = [c / found[0] for c in found]  # the leading coefficient may be of any sign
    if discrete:
        coefficients = bilinear(coefficients)
    whole = _decide([*coefficients[:discrete], *lienard_chipart(coefficients)], signs)
    if whole.verdict == "conditional" and polynomial.size <= FACTORED_UP_TO:
        parts = [factor for factor, _ in polynomial.numerator.factors()[1] if factor.degree(variable)]
        if len(parts) > 1 and any(
            stability(part, variable, signs, discrete=discrete).verdict == "no" for part in parts
        ):
            return StabilityVerdict("no")
    return whole


def bilinear(coefficients: Sequence[Scalar]) -> list[Scalar]:
    """Return the coefficients of Σ aₖ (w + 1)ⁿ⁻ᵏ (w − 1)ᵏ."""
    order = len(coefficients) - 1
    found = [Scalar.of(0)] * (order + 1)
    for k, coefficient in enumerate(coefficients):
        powers = [1]
        for factor in [1] * (order - k) + [-1] * k:
            powers = [a + factor * b for a, b in zip([*powers, 0], [0, *powers], strict=True)]
        found = [total + coefficient * power for total, power in zip(found, powers, strict=True)]
    return found


def hurwitz_matrix(coefficients: Sequence[Scalar]) -> Matrix:
    """Return the n×n Hurwitz matrix of a₀ sⁿ + … + aₙ: row i holds a₂ⱼ₋ᵢ (columns j from 1)."""
    order = len(coefficients) - 1

    def entry(i: int, j: int) -> Scalar:
        index = 2 * (j + 1) - (i + 1)
        return coefficients[index] if 0 <= index <= order else Scalar.of(0)

    return Matrix.of([[entry(i, j) for j in range(order)] for i in range(order)])


def lienard_chipart(coefficients: Sequence[Scalar], *, others: bool = False) -> list[Scalar]:
    """Return the conditions for a₀ > 0: aₙ, aₙ₋₂, … with Δₙ₋₁, Δₙ₋₃, …; or aₙ, aₙ₋₁, aₙ₋₃, …, all positive."""
    order = len(coefficients) - 1
    conditions = [coefficients[k] for k in ([order, *range(order - 1, 0, -2)] if others else range(order, 0, -2))]
    hurwitz = hurwitz_matrix(coefficients)
    conditions += [hurwitz.select(range(k), range(k)).determinant() for k in range(order - 1, 1, -2)]
    if order % 2 == 0 and coefficients[1] not in conditions:
        conditions.append(coefficients[1])
    return conditions


def _decide(conditions: Sequence[Scalar], signs: Mapping[str, str]) -> StabilityVerdict:
    """Drop conditions implied by the declared signs; one that is never positive decides `no`."""
    needed: dict[Scalar, None] = {}
    for condition in conditions:
        sign = sign_of(condition, signs)
        if sign == "positive":
            continue
        if sign in {"negative", "nonpositive", "zero"}:
            return StabilityVerdict("no")
        needed[essential(condition, signs)] = None
    return StabilityVerdict("conditional", _independent(needed, signs)) if needed else StabilityVerdict("yes")


def _independent(conditions: Iterable[Scalar], signs: Mapping[str, str]) -> tuple[Scalar, ...]:
    """Return the conditions without those that another one implies: a < 2 says nothing beside a < 0."""
    kept = list(conditions)
    for condition in tuple(kept):
        others = [other for other in kept if other is not condition]
        if any(_implies(other, condition, signs) for other in others):
            kept = others
    return tuple(kept)


def _implies(given: Scalar, condition: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether condition = k given + something never negative, for a number k > 0: `given` > 0 is then enough."""
    names = sorted(given.names & condition.names)
    if not names or not (given.denominator.is_constant and condition.denominator.is_constant):
        return False
    ratio = condition.coefficients(names[0])[0] / given.coefficients(names[0])[0]
    if not ratio.is_constant or sign_of(ratio, {}) != "positive":
        return False
    return sign_of(condition - ratio * given, signs) in {"positive", "nonnegative", "zero"}


def essential(condition: Scalar, signs: Mapping[str, str]) -> Scalar:
    """Return a condition without factors of known sign and even powers.

    An even power is kept as the factor's square where the factor may vanish, since the inequality is strict.
    """
    unit, factors = condition.factors()
    kept = Scalar.of(1 if sign_of(unit, {}) == "positive" else -1)
    for factor, power in factors:
        sign = sign_of(factor, signs)
        if sign == "positive" or (power % 2 == 0 and sign in {"negative", "nonzero"}):
            continue
        kept = -kept if sign == "negative" else kept * (factor if power % 2 else factor**2)
    return kept


def on_boundary(factor: Scalar, variable: str, signs: Mapping[str, str], *, discrete: bool) -> bool:
    """Return whether all roots of an irreducible factor are simple and certainly on the imaginary axis (unit circle).

    q(s) = p(s²) has only simple imaginary roots exactly when q + q′ is stable (Hermite and Biehler): the roots of p are
    then real, negative and distinct.
    """
    coefficients = monic(factor, variable).coefficients(variable)
    if len(coefficients) == 2:
        size = coefficients[1] ** 2 if discrete else coefficients[1] ** 2 + 1
        return size.is_one
    if discrete:
        coefficients = tuple(bilinear(coefficients))
    if coefficients[0].is_zero or any(not c.is_zero for c in coefficients[1::2]):
        return False
    order = len(coefficients) - 1
    widened = list(coefficients)
    for k, c in enumerate(coefficients[:-1]):
        widened[k + 1] = widened[k + 1] + c * (order - k)
    return stability(from_coefficients(widened, variable), variable, signs, discrete=False).verdict == "yes"


def is_marginal(
    polynomial: Scalar,
    variable: str,
    signs: Mapping[str, str],
    *,
    discrete: bool,
    apart: Collection[Scalar] = (),
) -> bool:
    """Return whether all roots certainly lie in Re s ≤ 0 (|z| ≤ 1), those on the boundary simple.

    Two factors with roots on the boundary must not meet: `apart` holds irreducible polynomials known not to vanish.
    """
    boundary = []
    for factor, power in polynomial.numerator.factors()[1]:
        if stability(factor, variable, signs, discrete=discrete).verdict == "yes":
            continue
        if power > 1 or not on_boundary(factor, variable, signs, discrete=discrete):
            return False
        boundary.append(factor)
    return set(apart).issuperset(meetings(boundary, variable, signs))


def meetings(factors: Iterable[Scalar], variable: str, signs: Mapping[str, str]) -> tuple[Scalar, ...]:
    """Return the irreducible factors of the pairwise resultants of some polynomials."""
    pairs = (resultant(left, right, variable) for left, right in combinations(factors, 2))
    return vanishing_factors(pairs, signs)


def marginal_where(
    polynomial: Scalar, variable: str, signs: Mapping[str, str], *, discrete: bool
) -> tuple[Scalar, ...]:
    """Return the conditions, each ≥ 0, for the root of a linear polynomial to lie in Re s ≤ 0 (|z| ≤ 1)."""
    coefficients = monic(polynomial, variable).coefficients(variable)
    if len(coefficients) != 2:
        return ()
    c = coefficients[1]
    bounds = (1 - c, 1 + c) if discrete else (c,)
    return tuple(b for b in bounds if sign_of(b, signs) not in {"positive", "nonnegative", "zero"})


def is_beyond(polynomial: Scalar, variable: str, signs: Mapping[str, str], *, discrete: bool) -> bool:
    """Return whether some root certainly lies in Re s > 0 (|z| > 1).

    A factor with numbers for coefficients has one there where it is neither stable nor wholly on the boundary, since its
    roots on the boundary would bring a mirror image of every other.  With parameters two coefficients of surely opposite
    sign show it.
    """
    for factor, _ in polynomial.numerator.factors()[1]:
        if factor.degree(variable) < 1:
            continue
        coefficients: Sequence[Scalar] = monic(factor, variable).coefficients(variable)
        if factor.names == {variable}:
            stable = stability(factor, variable, signs, discrete=discrete).verdict == "yes"
            if not stable and not on_boundary(factor, variable, signs, discrete=discrete):
                return True
        if {"positive", "negative"} <= {
            sign_of(c, signs) for c in (bilinear(coefficients) if discrete else coefficients)
        }:
            return True
    return False


def monic(polynomial: Scalar, variable: str) -> Scalar:
    """Return the polynomial divided by its leading coefficient."""
    coefficients = polynomial.coefficients(variable)
    return from_coefficients([c / coefficients[0] for c in coefficients], variable)


def stable_somewhere(polynomial: Scalar, variable: str, signs: Mapping[str, str], *, discrete: bool) -> set[bool]:
    """Return the outcomes at sample points with the declared signs, which prove that both occur."""
    generator, met = random.Random(0), set[bool]()  # noqa: S311 - the same points in every run
    names = sorted(set(polynomial.names) - {variable})
    for _ in range(_POINTS):
        point = {name: Scalar.of(_number(generator, signs.get(name, "real"))) for name in names}
        try:
            value = polynomial.substitute(point)
        except ZeroDivisionError:
            continue
        if value.degree(variable) == polynomial.degree(variable):
            met.add(stability(value, variable, {}, discrete=discrete).verdict == "yes")
        if len(met) == 2:
            break
    return met


def _number(generator: random.Random, sign: str) -> Fraction:
    size = Fraction(generator.randint(1, 40), generator.choice((1, 4, 20, 100)))
    negative = sign in {"negative", "nonpositive"} or (sign in {"real", "nonzero"} and generator.random() < 0.5)
    return -size if negative else size


def no_stable_compensator(transfer_function: Scalar, variable: str, signs: Mapping[str, str]) -> bool:
    """Return whether a strictly proper P = N/χ has a zero z > 0 with χ(z) < 0, χ monic: then nothing stable stabilises it.

    With F = n/δ the loop's polynomial is χδ + Nn, which is monic as χδ is.  It is positive at z, being stable, so
    δ(z) < 0, although δ(s) tends to +∞: δ has a root beyond z.  (Half of the parity interlacing property of Youla,
    Bongiorno and Lu, 1974.)  Zeros are seen where a factor of N is s − z, or s² − z².
    """
    if transfer_function.numerator.degree(variable) >= transfer_function.denominator.degree(variable):
        return False
    characteristic = monic(transfer_function.denominator, variable)
    for factor, _ in transfer_function.numerator.factors()[1]:
        lead, *rest = factor.coefficients(variable)
        if len(rest) not in {1, 2} or any(not c.is_zero for c in rest[:-1]):
            continue
        if sign_of(rest[-1] / lead, signs) == "negative":
            signs_at_zero = {
                sign_of(c, signs) for c in _remainder(characteristic, -rest[-1] / lead, len(rest), variable)
            }
            if "negative" in signs_at_zero and signs_at_zero <= {"negative", "nonpositive", "zero"}:
                return True
    return False


def _remainder(polynomial: Scalar, power: Scalar, order: int, variable: str) -> list[Scalar]:
    """Return the coefficients that are left, lowest first, where sᵒʳᵈᵉʳ is put equal to `power`."""
    left = [Scalar.of(0)] * order
    for k, coefficient in enumerate(reversed(polynomial.coefficients(variable))):
        left[k % order] = left[k % order] + coefficient * power ** (k // order)
    return left
