"""Polynomials over Q(√2, √3, …): greatest common divisors and factors, on the kernel's polynomials in normal form.

A polynomial in normal form has degree at most 1 in each root.  It is determined up to a number of the field, so every
answer is *scaled*: integral and primitive, with a positive integer for its leading coefficient.

Factors are found as B. M. Trager does (Proc. SYMSAC 1976, 219-226): those of the norm, a polynomial over Q, have one
factor over the field each, once a shift of one variable by the roots has made the norm free of squares.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from functools import lru_cache, reduce
from math import lcm, prod
from typing import TYPE_CHECKING, Any, NamedTuple

from flint import fmpz, fmpz_mat, fmpz_mod_mpoly_ctx

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
    """Return the scaled greatest common divisor.

    Of polynomials over Q it is that over Q.  Else it is found modulo a prime at which the roots are integers, and its
    coefficients are the shortest numbers with these residues, which is checked by division.  Where the leading coefficient
    of `left` does not vanish there, the degree is not less than the true one: what divides both polynomials is the greatest.
    """
    if not left or not right:
        return scaled(field, left or right)
    if not any(polynomial.degrees()[index] for polynomial in (left, right) for index, _ in field.roots):
        return scaled(field, left.gcd(right))
    if not variables_of(field, left) or not variables_of(field, right):
        return field.one
    bits, squares = _FIRST_BITS, tuple(square for _, square in field.roots)
    while True:
        found = _divisor_modulo(field, left, right, _residues(squares, bits))
        if found and (found.is_one() or all(_divides(field, found, polynomial) for polynomial in (left, right))):
            return found
        bits *= 2


#: The bits of the prime that is tried first.
_FIRST_BITS = 128


class _Residues(NamedTuple):
    """A prime, and by the powers of the roots the residues of their products."""

    prime: int
    products: dict[tuple[int, ...], int]


@lru_cache(maxsize=64)
def _residues(squares: tuple[int, ...], bits: int) -> _Residues:
    """Return a prime of so many bits modulo which these squares have roots.

    It has passed the test of Baillie, Pomerance, Selfridge and Wagstaff; a number that is none, of which nobody knows one,
    could only leave a common factor where it is.
    """
    prime = 1 << bits | 1
    while not (all(fmpz(square).jacobi(prime) == 1 for square in squares) and fmpz(prime).is_probable_prime()):
        prime += 2
    roots = [int(fmpz(square).sqrtmod(prime)) for square in squares]
    powers = itertools.product((0, 1), repeat=len(roots))
    return _Residues(prime, {p: prod(r for r, power in zip(roots, p, strict=True) if power) % prime for p in powers})


def _divisor_modulo(field: Field, left: fmpz_mpoly, right: fmpz_mpoly, residues: _Residues) -> fmpz_mpoly:
    """Return the divisor modulo a prime in numbers of the field, 0 where a leading coefficient vanishes."""
    letters = tuple(f"x{index}" for index in range(len(field.names)))  # the library keeps what it is asked for
    context = fmpz_mod_mpoly_ctx.get(letters, modulus=residues.prime, ordering=field.context.ordering())
    places = [index for index, _ in field.roots]
    one, other = (_image(context, places, polynomial, residues) for polynomial in (left, right))
    if not one or max(one.monoms()) != max(_without(powers, places) for powers in left.monoms()):
        return field.zero
    terms = one.gcd(other).to_dict()
    over = pow(int(terms[max(terms)]), -1, residues.prime)
    found: dict[tuple[int, ...], Fraction] = {}
    for powers, residue in terms.items():
        for kinds, number in _number(int(residue) * over % residues.prime, residues).items():
            with_roots = list(powers)
            for place, power in zip(places, kinds, strict=True):
                with_roots[place] = power
            found[tuple(with_roots)] = number
    below = lcm(*(number.denominator for number in found.values()))
    return scaled(field, field.context.from_dict({powers: int(number * below) for powers, number in found.items()}))


def _image(context: fmpz_mod_mpoly_ctx, places: list[int], polynomial: fmpz_mpoly, residues: _Residues) -> Any:
    """Return a polynomial modulo a prime, its roots replaced by their residues."""
    found: dict[tuple[int, ...], int] = {}
    for powers, c in polynomial.terms():
        rest, kinds = _without(powers, places), tuple(int(powers[place]) for place in places)
        found[rest] = (found.get(rest, 0) + int(c) * residues.products[kinds]) % residues.prime
    return context.from_dict(found)


def _without(powers: tuple[int, ...], places: list[int]) -> tuple[int, ...]:
    return tuple(0 if k in places else int(power) for k, power in enumerate(powers))


def _number(residue: int, residues: _Residues) -> dict[tuple[int, ...], Fraction]:
    """Return the number with a residue whose numerators and denominator are short, by the powers of the roots in it.

    The vectors (a, b, …, q) with a + b √2 + … = q c modulo the prime are a lattice; the shortest one is taken.
    """
    (_, first), *others = residues.products.items()
    assert first == 1  # noqa: S101 - the product without roots comes first
    size = len(others) + 2
    rows = [[residues.prime] + [0] * (size - 1)]
    rows += [[-r, *(int(k == j) for k in range(len(others))), 0] for j, (_, r) in enumerate(others)]
    rows += [[residue] + [0] * (size - 2) + [1]]
    shortest = min(
        (row for row in fmpz_mat(rows).lll().tolist() if int(row[-1])),
        key=lambda row: sum(int(part) ** 2 for part in row),
    )
    return {
        kinds: Fraction(int(a), int(shortest[-1]))
        for kinds, a in zip(residues.products, shortest[:-1], strict=True)
        if int(a)
    }


def _divides(field: Field, divisor: fmpz_mpoly, polynomial: fmpz_mpoly) -> bool:
    above, below = field.rationalised(polynomial, divisor)
    return not divmod(above, below.primitive()[1])[1]


def _coefficients(field: Field, polynomial: fmpz_mpoly, index: int) -> list[fmpz_mpoly]:
    """Return the coefficients of the powers of a generator, highest first."""
    collected: dict[int, dict[tuple[int, ...], object]] = {}
    for powers, c in polynomial.terms():
        rest = (*powers[:index], 0, *powers[index + 1 :])
        collected.setdefault(int(powers[index]), {})[rest] = c
    return [field.context.from_dict(collected[power]) for power in sorted(collected, reverse=True)]  # type: ignore[arg-type]


def _content(field: Field, polynomial: fmpz_mpoly, index: int) -> fmpz_mpoly:
    return reduce(lambda a, b: common_divisor(field, a, b), _coefficients(field, polynomial, index), field.zero)


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
