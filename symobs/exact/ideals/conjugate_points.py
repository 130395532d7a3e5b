"""Finitely many points by one coordinate: a polynomial p(x) that is 0, and every other name as a polynomial in x.

Over Q[x]/(p) such a system needs no Buchberger: what is univariate is divided by p, what is linear in a new name with a unit
as its coefficient is solved for that name.  Each step keeps the ideal, and the result is its reduced Gröbner basis in every
lexicographic order in which x comes last.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from flint import fmpq, fmpq_poly

from symobs.exact.core.polynomial import from_coefficients
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping


def conjugate_points(equations: Iterable[Scalar]) -> tuple[str, tuple[Scalar, ...]] | None:
    """Return x and other generators of the same ideal: p(x), and y − g(x) for every other name y; None for other systems.

    Where the equations have no common zero the only generator is 1.  Equations are polynomials without roots of numbers.
    """
    left = sorted((equation.numerator for equation in equations if not equation.is_zero), key=lambda e: len(e.names))
    if not left or len(left[0].names) != 1 or any(equation.field.roots for equation in left):
        return None
    (x,) = left[0].names
    modulus, known = _univariate(left[0], x), {x: fmpq_poly([0, 1])}
    while left:
        rest = []
        for equation in left:
            unknown = equation.names - known.keys()
            if len(unknown) > 1:
                rest.append(equation)
                continue
            coefficients = _at(equation, known, unknown, modulus)
            if len(coefficients) == 1:
                modulus = modulus.gcd(coefficients[0])
                if modulus.degree() == 0:
                    return x, (Scalar.of(1),)
                known = {name: value % modulus for name, value in known.items()}
                continue
            (name,) = unknown
            inverse = _inverse(coefficients[1], modulus) if len(coefficients) == 2 else None
            if inverse is None:
                rest.append(equation)
            else:
                known[name] = -coefficients[0] * inverse % modulus
        if len(rest) == len(left):
            return None
        left = rest
    others = (_solved(name, value, x) for name, value in known.items() if name != x)
    return x, (_scalar(modulus, x).numerator, *others)


def _solved(name: str, value: fmpq_poly, x: str) -> Scalar:
    return (Scalar.symbol(name) - _scalar(value, x)).numerator


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
