"""The stable factor of an even polynomial: p with p(s) p(−s) = c(s), where square roots write it.

Of s⁴ + c₂ s² + c₀ it is s² + p₁ s + p₀ with p₀ = √c₀ and p₁ = √(2 p₀ − c₂); other factors of c over its field of numbers are
even of degree two or come in pairs f(s), ± f(−s).  Roots are positive by meaning: `with_signs` says so of their generators.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact import Field, Scalar, derivative, from_coefficients, product_of, resultant
from symobs.exact.core.generators import (
    function_named,
    generator,
    normal_form,
    roots_in,
    square_divisor,
    square_root,
)
from symobs.stability.criteria.stability import monic, stability
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from symobs.exact import Matrix

#: Primes whose roots are tried where a factor has none over its own field, and how many of them at once.
_PRIMES, _MOST_PRIMES = (2, 3, 5, 7, 11, 13), 2
#: Roots in roots take the radicands in turn, the outermost last.
_NESTED = 3
#: A name that no parameter has, among the signs where roots are left whole.
_WHOLE = "whole roots"


class NoFactor(ArithmeticError):
    """No square roots that are looked for write the stable factor; the reason is the message."""


def with_signs(signs: Mapping[str, str], *values: Scalar | Matrix) -> dict[str, str]:
    """Return the signs of the parameters, and those of the square roots in values: a root is positive where it is not 0."""
    roots: dict[str, str] = {root.name: "positive" for value in values for root in roots_in(value)}
    inner = [root.argument for value in values for root in roots_in(value)]
    return {**(with_signs({}, *inner) if inner else {}), **roots, **signs}


def reduced(value: Scalar) -> Scalar:
    """Return the normal form of a value with roots in roots."""
    for _ in range(_NESTED):
        before, value = value, normal_form(value)
        if value == before:
            break
    return value


def stable_factors(even: Scalar, variable: str, signs: Mapping[str, str], *, whole: bool = False) -> tuple[Scalar, ...]:
    """Return monic stable factors, the product of which times its mirror image is the polynomial up to a number.

    With `whole` nothing is taken out of a root: then its sign is known, whatever those of the parameters.
    Raises `NoFactor`.
    """
    signs = {**signs, _WHOLE: "real"} if whole else signs
    found: list[Scalar] = []
    s = Scalar.symbol(variable)
    waiting = [(monic(f, variable), power) for f, power in even.numerator.factors()[1] if f.degree(variable)]
    while waiting:
        factor, power = waiting.pop(0)
        mirror = monic(factor.substitute({variable: -s}), variable)
        if mirror == factor:
            radicand = -factor.coefficients(variable)[-1]
            if power % 2 == 0 and sign_of(radicand, with_signs(signs, radicand)) != "positive":  # it may be on the axis
                raise NoFactor(f"whether roots of {factor} are on the boundary depends on the parameters")
            found += [_half(factor, variable, signs)] * power
            continue
        waiting = [(other, count) for other, count in waiting if other != mirror]
        found += list(_of_pair(factor, mirror, variable, signs)) * power
    return tuple(sorted(found, key=lambda each: (each.degree(variable), each.size)))


def _half(factor: Scalar, variable: str, signs: Mapping[str, str]) -> Scalar:
    """Return the stable half of an even factor without even factors."""
    coefficients = factor.coefficients(variable)
    if len(coefficients) == 3:
        return from_coefficients([Scalar.of(1), _root(-coefficients[2], signs)], variable)
    if len(coefficients) != 5:
        parts = _over_roots(factor, variable)
        if len(parts) < 2:
            raise NoFactor("the stable factor is not written with the square roots that are looked for")
        return product_of(_half(part, variable, signs) for part in parts)
    p_0 = _root(coefficients[4], signs)
    return from_coefficients([Scalar.of(1), _root(reduced(2 * p_0 - coefficients[2]), signs), p_0], variable)


def _of_pair(factor: Scalar, mirror: Scalar, variable: str, signs: Mapping[str, str]) -> Iterable[Scalar]:
    """Return the stable factors of f(s) f(−s)."""
    for one in (factor, mirror):
        if stability(one, variable, signs, discrete=False).verdict == "yes":
            return (one,)
    _, *rest = factor.coefficients(variable)
    if len(rest) == 1:  # of s + c and s − c one is stable, and it is s + √c²
        return (from_coefficients([Scalar.of(1), _root(rest[0] ** 2, signs)], variable),)
    if len(rest) == 2 and sign_of(rest[1], signs) == "negative":  # one root on either side
        half = _root(reduced(rest[0] ** 2 - 4 * rest[1]), signs)
        return (from_coefficients([Scalar.of(1), half, -rest[1]], variable),)
    if any(name != variable and function_named(name) is None for name in factor.names):
        raise NoFactor(f"on which side of the imaginary axis the roots of {factor} lie is not known")
    raise NoFactor("its stable factor is not written with square roots")


def _over_roots(factor: Scalar, variable: str) -> list[Scalar]:
    """Return the even factors of an even polynomial over the field with the roots of the primes of its discriminant."""
    if factor.names != {variable}:
        return []
    halved = from_coefficients(factor.coefficients(variable)[::2], variable)
    discriminant = abs(resultant(halved, derivative(halved, variable), variable).fraction())
    primes = [p for p in _PRIMES if discriminant.numerator % p == 0 or discriminant.denominator % p == 0][:_MOST_PRIMES]
    field = halved.field | Field.of([name for p in primes for name in square_root(Scalar.of(p)).names])
    square = {variable: Scalar.symbol(variable) ** 2}
    parts = halved.within(field).factors()[1]
    return [monic(f.substitute(square), variable) for f, power in parts for _ in range(power) if f.degree(variable)]


def _root(radicand: Scalar, signs: Mapping[str, str]) -> Scalar:
    """Return the square root that is not negative; raises `NoFactor` for a negative number."""
    known = with_signs(signs, radicand)
    if sign_of(radicand, known) == "negative":
        raise NoFactor(f"{radicand} has no real root")
    root = square_root(radicand, {name for name, sign in signs.items() if sign == "positive"})
    known = with_signs(signs, root)
    sign = sign_of(root, known)
    if _WHOLE in signs and not (sign in {"positive", "zero"} and root.size == 2):
        unit, _ = radicand.factors()
        outside = square_divisor(unit.fraction()) if unit.is_constant else Fraction(1)
        return generator("sqrt", radicand / outside**2) * outside
    if sign in {"negative", "nonpositive"}:
        return -root
    return root if sign in {"positive", "nonnegative", "zero"} else generator("sqrt", radicand)
