"""Finitely many points by one coordinate: a polynomial p(x) that is 0, and every other name as a polynomial in x.

Over Q[x]/(p) such a system needs no Buchberger: what is univariate is divided by p, what is linear in a new name with a unit
as its coefficient is solved for that name, and of several equations in one new name Euclid finds the common divisor.  Each step
keeps the ideal, and the result is its reduced Gröbner basis in every lexicographic order in which x comes last.
"""

from __future__ import annotations

from fractions import Fraction
from functools import reduce
from typing import TYPE_CHECKING

from flint import fmpq, fmpq_poly

from symobs.exact.core.polynomial import from_coefficients
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping


def conjugate_points(equations: Iterable[Scalar]) -> tuple[str, tuple[Scalar, ...]] | None:
    """Return x and other generators of the same ideal: p(x), and y − g(x) for every other name y; None for other systems.

    Where the equations have no common zero the only generator is 1.  Equations are polynomials without roots of numbers.
    """
    for x, basis in _divided(equations):
        if all(each.degree(name) == 1 for each in basis for name in each.names - {x}):
            return x, basis
    return None


def shortened(equations: Iterable[Scalar]) -> tuple[Scalar, ...] | None:
    """Return two other generators of an ideal in two names: p(x), and a polynomial in y over Q[x]/(p); None if not found."""
    return next((basis for _, basis in _divided(equations)), None)


def _divided(equations: Iterable[Scalar]) -> Iterator[tuple[str, tuple[Scalar, ...]]]:
    """Yield for the name x of each equation in one name what is left when the others are divided."""
    given = [equation.numerator for equation in equations if not equation.is_zero]
    if not any(equation.field.roots for equation in given):
        alone = (equation for equation in given if len(equation.names) == 1)
        yield from filter(None, (_by_coordinate(each, given) for each in alone))


def _by_coordinate(first: Scalar, equations: list[Scalar]) -> tuple[str, tuple[Scalar, ...]] | None:
    """Return x, p(x) and the others by Euclid's algorithm; None where an equation holds several names that are not known."""
    (x,) = first.names
    modulus, known, left = _univariate(first, x), {x: fmpq_poly([0, 1])}, equations
    divisors: dict[str, list[fmpq_poly]] = {}
    while left:
        rest = []
        by_name: dict[str, list[list[fmpq_poly]]] = {}
        for equation in left:
            unknown = equation.names - known.keys()
            if len(unknown) > 1:
                rest.append(equation)
                continue
            coefficients = _at(equation, known, unknown, modulus)
            if len(coefficients) > 1:
                rest.append(equation)
                by_name.setdefault(next(iter(unknown)), []).append(coefficients)
                continue
            modulus = modulus.gcd(coefficients[0])
            known = {name: value % modulus for name, value in known.items()}
        divisors = {name: _divisor(polynomials, modulus) for name, polynomials in by_name.items()}
        if modulus.degree() == 0 or any(len(each) == 1 for each in divisors.values()):
            return x, (Scalar.of(1),)
        solved = {name: -each[0] for name, each in divisors.items() if len(each) == 2}
        if len(rest) == len(left) and not solved:
            if (
                len(divisors) != 1
                or not all(divisors.values())
                or any(len(each.names - known.keys()) > 1 for each in rest)
            ):
                return None
            break
        known, left = known | solved, rest
    values = (_polynomial([-value, fmpq_poly([1])], name, x) for name, value in known.items() if name != x)
    others = (_polynomial(divisor, name, x) for name, divisor in divisors.items() if left)
    return x, (_scalar(modulus, x).numerator, *values, *others)


def _divisor(polynomials: list[list[fmpq_poly]], modulus: fmpq_poly) -> list[fmpq_poly]:
    """Return the monic common divisor of polynomials over Q[x]/(p); nothing where a lead is no unit.

    One that is linear is taken alone: the others are looked at when its name is known.
    """
    found, *others = sorted(polynomials, key=len)
    if len(found) > 2 or _inverse(found[1], modulus) is None:
        found = reduce(lambda one, other: _common_divisor(one, other, modulus), others, found)
    inverse = _inverse(found[-1], modulus) if found else None
    return [] if inverse is None else [coefficient * inverse % modulus for coefficient in found]


def _common_divisor(one: list[fmpq_poly], other: list[fmpq_poly], modulus: fmpq_poly) -> list[fmpq_poly]:
    """Return the greatest common divisor over Q[x]/(p), lowest coefficient first; nothing where a lead is no unit."""
    while other and one:
        inverse = _inverse(other[-1], modulus)
        if inverse is None:
            return []
        below = [coefficient * inverse % modulus for coefficient in other]
        rest = list(one)
        while len(rest) >= len(below):
            lead, shift = rest.pop(), len(rest) + 1 - len(below)
            for place, coefficient in enumerate(below[:-1]):
                rest[shift + place] = (rest[shift + place] - lead * coefficient) % modulus
        while rest and not rest[-1]:
            rest.pop()
        one, other = below, rest
    return one


def _polynomial(coefficients: list[fmpq_poly], name: str, x: str) -> Scalar:
    """Return a polynomial in a name, its coefficients lowest first, as one in two names."""
    powers = (Scalar.symbol(name) ** k for k in range(len(coefficients)))
    parts = (_scalar(c, x) * power for c, power in zip(coefficients, powers, strict=True))
    return sum(parts, Scalar.of(0)).numerator


def _at(
    equation: Scalar, known: Mapping[str, fmpq_poly], unknown: frozenset[str], modulus: fmpq_poly
) -> list[fmpq_poly]:
    """Return the coefficients of an equation in the unknown name, lowest first, as polynomials in x modulo p."""
    powers = {name: [fmpq_poly([1])] for name in equation.names & known.keys()}
    found: list[fmpq_poly] = [fmpq_poly()]
    for coefficient, monomial in equation.each_term():
        term, place = fmpq_poly([coefficient]), 0
        for name, power in monomial:
            if name in unknown:
                place = power
                continue
            while len(powers[name]) <= power:
                powers[name].append(powers[name][-1] * known[name] % modulus)
            term = term * powers[name][power] % modulus
        found += [fmpq_poly()] * (place + 1 - len(found))
        found[place] += term
    while len(found) > 1 and not found[-1] % modulus:
        found.pop()
    return [each % modulus for each in found]


def _inverse(value: fmpq_poly, modulus: fmpq_poly) -> fmpq_poly | None:
    """Return the inverse modulo p, None where there is none."""
    common, inverse, _ = value.xgcd(modulus)
    return inverse / common[0] % modulus if common.degree() == 0 else None


def _univariate(value: Scalar, x: str) -> fmpq_poly:
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in map(Scalar.fraction, reversed(value.coefficients(x)))])


def _scalar(value: fmpq_poly, x: str) -> Scalar:
    fractions = [Fraction(int(c.p), int(c.q)) for c in reversed(value.coeffs())]
    return from_coefficients([Scalar.of(each) for each in fractions], x) if fractions else Scalar.of(0)
