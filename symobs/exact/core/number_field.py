"""Polynomials over Q(√2, √3, …): greatest common divisors and factors, on the kernel's polynomials in normal form.

A polynomial in normal form has degree at most 1 in each root.  It is determined up to a number of the field, so every
answer is *scaled*: integral and primitive, with a positive integer for its leading coefficient.

Factors are found as B. M. Trager does (Proc. SYMSAC 1976, 219-226): those of the norm, a polynomial over Q, have one
factor over the field each, once a shift of one variable by the roots has made the norm free of squares.
"""

from __future__ import annotations

from functools import reduce
from typing import TYPE_CHECKING

from symobs.exact.core.ring import factors_of, in_order

if TYPE_CHECKING:
    from flint import fmpz_mpoly

    from symobs.exact.core.field import Field


def scaled(field: Field, polynomial: fmpz_mpoly) -> fmpz_mpoly:
    """Return the multiple of a polynomial by a number that is primitive and has a positive integer in front."""
    places = [index for index, _ in field.roots]
    first = min(polynomial.monoms(), key=lambda powers: _rank(powers, places))
    others = {k: power for k, power in enumerate(first) if k not in places}
    lead = {powers: c for powers, c in polynomial.terms() if all(powers[k] == power for k, power in others.items())}
    number = field.context.from_dict(
        {tuple(p if k in places else 0 for k, p in enumerate(m)): c for m, c in lead.items()}
    )
    polynomial, _ = field.rationalised(polynomial, number)
    _, polynomial = polynomial.primitive()
    return -polynomial if _lead(polynomial, places) < 0 else polynomial


def _rank(powers: tuple[int, ...], places: list[int]) -> tuple[int, ...]:
    """Return the sort key of a monomial without its roots, the leading one first."""
    return tuple(-power for k, power in enumerate(powers) if k not in places)


def _lead(polynomial: fmpz_mpoly, places: list[int]) -> int:
    first = min(polynomial.terms(), key=lambda term: _rank(term[0], places))
    return int(first[1])


def variables_of(field: Field, polynomial: fmpz_mpoly) -> list[int]:
    """Return the generators other than roots that occur, those of low degree first."""
    roots = {index for index, _ in field.roots}
    degrees = polynomial.degrees()
    found = [k for k, degree in enumerate(degrees) if degree > 0 and k not in roots]
    return sorted(found, key=lambda k: degrees[k])


def quotient(field: Field, dividend: fmpz_mpoly, divisor: fmpz_mpoly) -> fmpz_mpoly:
    """Return the scaled quotient of a division without remainder."""
    above, below = field.rationalised(dividend, divisor)
    return scaled(field, above / below.primitive()[1]) if above else above


def common_divisor(field: Field, left: fmpz_mpoly, right: fmpz_mpoly) -> fmpz_mpoly:
    """Return the scaled greatest common divisor, by primitive remainders."""
    if not left or not right:
        return scaled(field, left or right)
    here, there = variables_of(field, left), variables_of(field, right)
    if not here or not there or field.norm(left).gcd(field.norm(right)).is_constant():
        return field.one
    index = next((k for k in here if k in there), None)
    if index is None:
        return common_divisor(field, _content(field, left, here[0]), right)
    contents = _content(field, left, index), _content(field, right, index)
    left, right = quotient(field, left, contents[0]), quotient(field, right, contents[1])
    if left.degrees()[index] < right.degrees()[index]:
        left, right = right, left
    while right and right.degrees()[index] > 0:
        left, right = right, _primitive(field, _remainder(field, left, right, index), index)
    primitive = left if not right else field.one
    return scaled(field, field.normal(primitive * common_divisor(field, *contents)))


def _coefficients(field: Field, polynomial: fmpz_mpoly, index: int) -> list[fmpz_mpoly]:
    """Return the coefficients of the powers of a generator, highest first."""
    collected: dict[int, dict[tuple[int, ...], object]] = {}
    for powers, c in polynomial.terms():
        rest = (*powers[:index], 0, *powers[index + 1 :])
        collected.setdefault(int(powers[index]), {})[rest] = c
    return [field.context.from_dict(collected[power]) for power in sorted(collected, reverse=True)]  # type: ignore[arg-type]


def _content(field: Field, polynomial: fmpz_mpoly, index: int) -> fmpz_mpoly:
    return reduce(lambda a, b: common_divisor(field, a, b), _coefficients(field, polynomial, index), field.zero)


def _primitive(field: Field, polynomial: fmpz_mpoly, index: int) -> fmpz_mpoly:
    return quotient(field, polynomial, _content(field, polynomial, index)) if polynomial else polynomial


def _remainder(field: Field, left: fmpz_mpoly, right: fmpz_mpoly, index: int) -> fmpz_mpoly:
    """Return the remainder of a pseudo-division in one generator."""
    generator, degree = field.context.gen(index), right.degrees()[index]
    lead = _coefficients(field, right, index)[0]
    while left and (excess := left.degrees()[index] - degree) >= 0:
        top = _coefficients(field, left, index)[0]
        left = field.normal(lead * left - top * right * generator ** int(excess))
    return left


def lowest_terms(field: Field, numerator: fmpz_mpoly, denominator: fmpz_mpoly) -> tuple[fmpz_mpoly, fmpz_mpoly]:
    """Return a fraction, whose denominator has no root, as one of integral polynomials without common factor."""
    rational = numerator.gcd(denominator)
    numerator, denominator = numerator / rational, denominator / rational
    below = quotient(field, denominator, _shared(field, numerator, denominator))
    above = field.normal(numerator * below)
    shared = above.gcd(denominator)
    return above / shared, below * (denominator / shared)


def _shared(field: Field, numerator: fmpz_mpoly, denominator: fmpz_mpoly) -> fmpz_mpoly:
    """Return the product of the common factors of a polynomial and one over Q that have roots.

    A factor over Q that is linear in a generator has none over the field: the greatest common divisor of its coefficients
    is the same there.
    """
    parts = [(part, power) for part, power in factors_of(field, denominator)[1] if 1 not in part.degrees()]
    found, norm = field.one, field.norm(numerator) if parts else field.zero
    for part, power in parts:
        if divmod(norm, part)[1]:
            continue
        for factor in _irreducible(field, part):
            for _ in range(power):
                above, below = field.rationalised(numerator, factor)
                divided, rest = divmod(above, below.primitive()[1])
                if rest:
                    break
                numerator, found = divided, field.normal(found * factor)
    return found


def factors_over(field: Field, polynomial: fmpz_mpoly) -> list[tuple[fmpz_mpoly, int]]:
    """Return the scaled irreducible factors with multiplicities; their product is the polynomial up to a number."""
    found: dict[str, tuple[fmpz_mpoly, int]] = {}
    for part, power in factors_of(field, polynomial)[1]:
        for factor in _irreducible(field, part):
            _, before = found.get(str(factor), (factor, 0))
            found[str(factor)] = (factor, before + power)
    return in_order(list(found.values()))


def _irreducible(field: Field, polynomial: fmpz_mpoly) -> list[fmpz_mpoly]:
    """Return the factors of a polynomial that has none over Z[roots, parameters]."""
    variables = variables_of(field, polynomial)
    if not variables:
        return []
    index = variables[0]
    divisor = _content(field, polynomial, index)
    if divisor.is_one() and polynomial.degrees()[index] == 1:
        return [scaled(field, polynomial)]
    if divisor.is_one():  # a square may be hidden, too
        divisor = common_divisor(field, polynomial, polynomial.derivative(index))
    if not divisor.is_one():
        return _irreducible(field, divisor) + _irreducible(field, quotient(field, polynomial, divisor))
    parts, shift = _factors_of_norm(field, polynomial, index)
    if len(parts) == 1:
        return [scaled(field, polynomial)]
    return [common_divisor(field, polynomial, _shifted(field, part, index, shift)) for part in parts]


def _factors_of_norm(field: Field, polynomial: fmpz_mpoly, index: int) -> tuple[list[fmpz_mpoly], fmpz_mpoly]:
    """Return the factors of a norm without squares, and the shift of a generator by roots that leads to it."""
    step = 0
    while True:
        shift = field.zero
        for place, (root, _) in enumerate(field.roots):
            shift = shift + field.context.gen(root) * (step * (place + 1) ** 2)
        parts = factors_of(field, field.norm(_shifted(field, polynomial, index, -shift)))[1]
        if all(power == 1 for _, power in parts):
            return [part for part, _ in parts], shift
        step += 1


def _shifted(field: Field, polynomial: fmpz_mpoly, index: int, shift: fmpz_mpoly) -> fmpz_mpoly:
    images = list(field.context.gens())
    images[index] = images[index] + shift
    return field.normal(polynomial.compose(*images, ctx=field.context))
