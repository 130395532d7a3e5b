"""Scalars: rational functions over Q in the generators of a field, always reduced.

numerator / denominator are coprime integer polynomials and the denominator's leading coefficient is positive, so
two scalars are equal exactly when both parts are.  Arithmetic joins fields by itself.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from flint import fmpz, fmpz_mpoly

from symobs.exact.core import number_field
from symobs.exact.core.field import RATIONALS, Field, scalar_text
from symobs.exact.core.ring import (
    common_factor,
    degree_bound,
    factors_of,
    invariants,
    length_bits,
    number_of,
    occurring,
    polynomial_fingerprint,
)
from symobs.ground.errors import WrongKind

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping


# Coefficients of a multivariate polynomial in one generator.


def coefficients_in(polynomial: fmpz_mpoly, index: int, source: Field, target: Field) -> list[fmpz_mpoly]:
    """Return the coefficients of the powers of the generator `index` of `source`, highest first, in `target`.

    The target must contain the other generators that occur.
    """
    degree = int(polynomial.degrees()[index])
    if degree == 1:
        lead = polynomial.derivative(index)
        return [target.lift(part, source) for part in (lead, polynomial - lead * source.context.gen(index))]
    places = [target.position.get(name, -1) for name in source.names]
    collected: list[dict[tuple[int, ...], fmpz]] = [{} for _ in range(degree + 1)]
    for powers, coefficient in polynomial.terms():
        monomial = [0] * len(target.names)
        for i, power in enumerate(powers):
            if power and i != index:
                monomial[places[i]] = power
        collected[degree - int(powers[index])][tuple(monomial)] = coefficient
    return [target.context.from_dict(terms) for terms in collected]


_NONE: frozenset[str] = frozenset()


class Scalar:
    """An element numerator / denominator of a field."""

    __slots__ = ("denominator_part", "field", "known_hash", "known_names", "numerator_part")

    def __init__(self, field: Field, numerator: fmpz_mpoly, denominator: fmpz_mpoly) -> None:
        """Take reduced parts; `reduced` is the general constructor."""
        self.field = field
        self.numerator_part = numerator
        self.denominator_part = denominator

    # -- construction ---------------------------------------------------------------------------------------------

    @staticmethod
    def reduced(field: Field, numerator: fmpz_mpoly, denominator: fmpz_mpoly) -> Scalar:
        """Return numerator / denominator in lowest terms; the denominator must not be zero.

        Beside roots the numerator is in normal form and the denominator free of them.
        """
        if field.roots:
            numerator, denominator = field.rationalised(numerator, denominator)
        if not numerator:
            return Scalar(field, field.zero, field.one)
        if not denominator.is_one():
            common = common_factor(numerator, denominator)
            if not common.is_one():
                numerator, denominator = numerator / common, denominator / common
            if denominator.leading_coefficient() < 0:
                numerator, denominator = -numerator, -denominator
        return Scalar(field, numerator, denominator)

    @staticmethod
    def of(value: object) -> Scalar:
        """Return the scalar equal to an integer, a fraction or a scalar."""
        if isinstance(value, Scalar):
            return value
        if isinstance(value, Fraction):
            return Scalar.rational(value.numerator, value.denominator)
        if isinstance(value, (int, fmpz)):
            return Scalar(RATIONALS, RATIONALS.context.constant(value), RATIONALS.one)
        message = f"{type(value).__name__} is not an exact number"
        raise WrongKind(message)

    @staticmethod
    def rational(numerator: int, denominator: int = 1) -> Scalar:
        """Return the number numerator / denominator."""
        constant = RATIONALS.context.constant
        return Scalar.reduced(RATIONALS, constant(numerator), constant(denominator))

    @staticmethod
    def symbol(name: str) -> Scalar:
        """Return the generator `name`."""
        field = Field.of((name,))
        return Scalar(field, field.context.gen(0), field.one)

    @staticmethod
    def generator(field: Field, name: str) -> Scalar:
        """Return the generator `name` as an element of `field`."""
        return Scalar(field, field.context.gen(field.position[name]), field.one)

    def within(self, field: Field) -> Scalar:
        """Return the same value as an element of `field`, which must contain the generators it uses."""
        if field is self.field:
            return self
        below = self.denominator_part
        if self.field is RATIONALS:
            number = field.context.constant
            bottom = field.one if below.is_one() else number(number_of(below))
            return Scalar(field, number(number_of(self.numerator_part)), bottom)
        below = field.one if below.is_one() else field.lift(below, self.field)
        return Scalar(field, field.lift(self.numerator_part, self.field), below)

    def over(self, denominator: fmpz_mpoly) -> fmpz_mpoly:
        """Return the numerator over a multiple of the denominator."""
        if denominator == self.denominator_part:
            return self.numerator_part
        return self.numerator_part * (denominator / self.denominator_part)

    def __reduce__(self) -> tuple[object, ...]:
        return (
            _from_terms,
            (self.field.names, _plain_terms(self.numerator_part), _plain_terms(self.denominator_part)),
        )

    # -- arithmetic -----------------------------------------------------------------------------------------------

    def _pair(self, other: Scalar | int | Fraction) -> tuple[Scalar, Scalar, Field]:
        if not isinstance(other, Scalar):
            other = Scalar.of(other)
        if self.field is other.field:
            return self, other, self.field
        field = self.field | other.field
        return self.within(field), other.within(field), field

    def __add__(self, other: Scalar | int | Fraction) -> Scalar:
        a, b, field = self._pair(other)
        if a.denominator_part == b.denominator_part:
            return Scalar.reduced(field, a.numerator_part + b.numerator_part, a.denominator_part)
        return Scalar.reduced(
            field,
            a.numerator_part * b.denominator_part + b.numerator_part * a.denominator_part,
            a.denominator_part * b.denominator_part,
        )

    __radd__ = __add__

    def __neg__(self) -> Scalar:
        return Scalar(self.field, -self.numerator_part, self.denominator_part)

    def __sub__(self, other: Scalar | int | Fraction) -> Scalar:
        return self + (-Scalar.of(other))

    def __rsub__(self, other: int | Fraction) -> Scalar:
        return Scalar.of(other) - self

    def __mul__(self, other: Scalar | int | Fraction) -> Scalar:
        if not isinstance(other, (Scalar, int, Fraction)):
            return NotImplemented
        a, b, field = self._pair(other)
        return Scalar.reduced(field, a.numerator_part * b.numerator_part, a.denominator_part * b.denominator_part)

    __rmul__ = __mul__

    def __truediv__(self, other: Scalar | int | Fraction) -> Scalar:
        a, b, field = self._pair(other)
        if not b.numerator_part:
            message = "division by zero"
            raise ZeroDivisionError(message)
        return Scalar.reduced(field, a.numerator_part * b.denominator_part, a.denominator_part * b.numerator_part)

    def __rtruediv__(self, other: int | Fraction) -> Scalar:
        return Scalar.of(other) / self

    def __pow__(self, exponent: int) -> Scalar:
        if exponent < 0:
            return (Scalar.of(1) / self) ** -exponent
        make = Scalar.reduced if self.field.roots else Scalar
        return make(self.field, self.numerator_part**exponent, self.denominator_part**exponent)

    # -- questions ------------------------------------------------------------------------------------------------

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Scalar):
            if not isinstance(other, (int, Fraction)):
                return NotImplemented
            other = Scalar.of(other)
        a, b = self, other
        if a.field is not b.field:
            a, b, _ = self._pair(other)
        return bool(a.numerator_part == b.numerator_part and a.denominator_part == b.denominator_part)

    def __hash__(self) -> int:
        """Return a hash of invariants that do not depend on the field; cached."""
        if not hasattr(self, "known_hash"):
            self.known_hash: int = self._hash()
        return self.known_hash

    def _hash(self) -> int:
        if self.is_constant:
            return hash(self.fraction())
        degrees = zip(self.numerator_part.degrees(), self.denominator_part.degrees(), strict=True)
        places = [index for index, (above, below) in enumerate(degrees) if above > 0 or below > 0]
        below = () if self.denominator_part.is_one() else invariants(self.denominator_part, places)
        names = tuple([self.field.names[index] for index in places])
        return hash((names, invariants(self.numerator_part, places), below))

    def __bool__(self) -> bool:
        return bool(self.numerator_part)

    @property
    def is_zero(self) -> bool:
        """Whether this is 0."""
        return not self.numerator_part

    @property
    def is_one(self) -> bool:
        """Whether this is 1."""
        return bool(self.numerator_part.is_one() and self.denominator_part.is_one())

    @property
    def is_constant(self) -> bool:
        """Whether this is a rational number."""
        above, below = self.numerator_part, self.denominator_part
        return len(above) < 2 and len(below) < 2 and bool(above.is_constant() and below.is_constant())

    @property
    def names(self) -> frozenset[str]:
        """The generators that really occur; cached, since they are used often."""
        if self.is_constant:
            return _NONE
        if not hasattr(self, "known_names"):
            parts = [part for part in (self.numerator_part, self.denominator_part) if not part.is_one()]
            self.known_names: frozenset[str] = frozenset().union(*[occurring(part, self.field.names) for part in parts])
        return self.known_names

    @property
    def size(self) -> int:
        """The number of terms of numerator and denominator."""
        return len(self.numerator_part) + len(self.denominator_part)

    def degrees(self) -> tuple[int, int]:
        """Return upper bounds of the total degrees of numerator and denominator."""
        return degree_bound(self.numerator_part), degree_bound(self.denominator_part)

    def lengths(self) -> tuple[float, float]:
        """Return bounds of log₂ of the sums of the |coefficients| of numerator and denominator."""
        return length_bits(self.numerator_part), length_bits(self.denominator_part)

    def fingerprint(self) -> str:
        """Return a text that identifies the value in practice: the whole text if short, else a summary."""
        return f"{polynomial_fingerprint(self.numerator_part)}/{polynomial_fingerprint(self.denominator_part)}"

    @property
    def numerator(self) -> Scalar:
        """The numerator of the reduced form."""
        if self.field.roots and not self.denominator_part.is_constant():
            return _lowest_terms(self, self.field.names)[0]
        return Scalar(self.field, self.numerator_part, self.field.one)

    @property
    def denominator(self) -> Scalar:
        """The denominator of the reduced form."""
        if self.field.roots and not self.denominator_part.is_constant():
            return _lowest_terms(self, self.field.names)[1]
        return Scalar(self.field, self.denominator_part, self.field.one)

    def common_denominator(self) -> Scalar:
        """Return the denominator; the same method as of a matrix."""
        return self.denominator

    def fraction(self) -> Fraction:
        """Return a constant as a `Fraction`; raises ValueError for a number with roots."""
        if self.field.roots and not self.is_constant:
            raise ValueError(f"{self} is not rational")
        above, below = number_of(self.numerator_part), number_of(self.denominator_part)
        return Fraction(int(above), None if below == 1 else int(below))

    def terms(self) -> list[tuple[int, tuple[tuple[str, int], ...]]]:
        """Return the numerator's terms as (integer coefficient, ((name, exponent), …)), highest first."""
        return list(self.each_term())

    def each_term(self) -> Iterator[tuple[int, tuple[tuple[str, int], ...]]]:
        """Yield the terms one by one."""
        for powers, coefficient in self.numerator.numerator_part.terms():
            pairs = zip(self.field.names, powers, strict=True)
            yield int(coefficient), tuple((name, int(power)) for name, power in pairs if power)

    def __str__(self) -> str:
        return scalar_text(self)

    def __repr__(self) -> str:
        return f"Scalar({self})"

    # -- as a polynomial in one generator -------------------------------------------------------------------------

    def degree(self, variable: str) -> int:
        """Return the degree of the numerator in `variable` (−1 for zero)."""
        if not self.numerator_part:
            return -1
        index = self.field.position.get(variable)
        return 0 if index is None else int(self.numerator.numerator_part.degrees()[index])

    def is_polynomial_in(self, variable: str) -> bool:
        """Return whether the denominator is free of `variable`."""
        index = self.field.position.get(variable)
        return index is None or self.denominator_part.degrees()[index] <= 0

    def coefficients(self, variable: str, field: Field | None = None) -> tuple[Scalar, ...]:
        """Return the coefficients of a polynomial in `variable`, highest power first, free of `variable`.

        They are elements of `field` where one is given; it must contain the other generators that occur.
        """
        target = self.field if field is None else field
        index = self.field.position.get(variable)
        if index is None or self.numerator_part.degrees()[index] <= 0:
            return (self.within(target),)
        parts = coefficients_in(self.numerator_part, index, self.field, target)
        below = target.lift(self.denominator_part, self.field)
        return tuple(Scalar.reduced(target, part, below) for part in parts)

    # -- factors and substitution ---------------------------------------------------------------------------------

    def factors(self) -> tuple[Scalar, tuple[tuple[Scalar, int], ...]]:
        """Return (unit, ((irreducible polynomial, multiplicity), …)) with unit · product = this value.

        Factors are primitive with positive leading coefficient; those of the denominator have negative multiplicity.
        """
        return (self, ()) if self.is_zero else _factored(self, self.field.names)

    def substitute(self, values: Mapping[str, Scalar]) -> Scalar:
        """Return the value with symbols replaced, in the arguments of functions too.

        Raises ZeroDivisionError where a denominator vanishes, and `NotWritten` for a function that has no value there.
        """
        relevant = {name: v for name, v in values.items() if name in self.field.position and name in self.names}
        for name, function in self.field.functions.items():
            if name not in values and name in self.names and function.symbols & values.keys():
                relevant[name] = function.moved(values)
        if not relevant:
            return self
        above = _compose(self.numerator.numerator_part, self.field, relevant)
        if self.denominator_part.is_one():
            return above
        return above / _compose(self.denominator.numerator_part, self.field, relevant)


def _plain_terms(polynomial: fmpz_mpoly) -> tuple[tuple[tuple[int, ...], int], ...]:
    return tuple((tuple(map(int, powers)), int(coefficient)) for powers, coefficient in polynomial.terms())


def _from_terms(
    names: tuple[str, ...],
    numerator: tuple[tuple[tuple[int, ...], int], ...],
    denominator: tuple[tuple[tuple[int, ...], int], ...],
) -> Scalar:
    field = Field.of(names)
    return Scalar(field, field.context.from_dict(dict(numerator)), field.context.from_dict(dict(denominator)))


@lru_cache(maxsize=1024)
def _factored(value: Scalar, names: tuple[str, ...]) -> tuple[Scalar, tuple[tuple[Scalar, int], ...]]:
    """Return the factors of a nonzero value over the numbers of its field, which has these names; cached."""
    field = Field.of(names)
    value = value.within(field)
    parts = [part.numerator_part for part in (value.numerator, value.denominator)]
    if field.roots:
        over, under = (number_field.factors_over(field, part) for part in parts)
        unit = value
    else:
        (above, over), (below, under) = (factors_of(field, part) for part in parts)
        unit = Scalar.rational(above, below)
    found = [(Scalar(field, part, field.one), power) for part, power in over]
    found += [(Scalar(field, part, field.one), -power) for part, power in under]
    for factor, power in found if field.roots else ():
        unit = unit / factor**power
    return unit, tuple(found)


@lru_cache(maxsize=1024)
def _lowest_terms(value: Scalar, names: tuple[str, ...]) -> tuple[Scalar, Scalar]:
    """Return numerator and denominator without a common factor over the roots of the field, which has these names."""
    field = Field.of(names)
    value = value.within(field)
    above, below = number_field.lowest_terms(field, value.numerator_part, value.denominator_part)
    return Scalar(field, above, field.one), Scalar(field, below, field.one)


def _compose(polynomial: fmpz_mpoly, field: Field, values: Mapping[str, Scalar]) -> Scalar:
    """Evaluate a polynomial at scalars: clear denominators generator by generator, compose once."""
    target = field.without(frozenset(values))
    for value in values.values():
        target = target | value.field
    if polynomial.is_constant():
        return Scalar(target, target.context.constant(number_of(polynomial)), target.one)
    powers = dict(zip(field.names, polynomial.degrees(), strict=True))
    clearing = target.one
    images = []
    homogenised: list[tuple[int, int, fmpz_mpoly]] = []
    for index, name in enumerate(field.names):
        if name not in values:
            images.append(target.context.gen(target.position[name]))
            continue
        value = values[name].within(target)
        images.append(value.numerator_part)
        if not value.denominator_part.is_one() and powers[name] > 0:
            homogenised.append((index, int(powers[name]), value.denominator_part))
            clearing = clearing * value.denominator_part ** int(powers[name])
    if not homogenised:
        return Scalar(target, target.normal(polynomial.compose(*images, ctx=target.context)), target.one)
    total = target.zero
    for exponents, coefficient in polynomial.terms():
        term = target.context.constant(coefficient)
        for image, exponent in zip(images, exponents, strict=True):
            if exponent:
                term = target.normal(term * target.normal(image ** int(exponent)))
        for index, degree, denominator in homogenised:
            term = term * denominator ** (degree - int(exponents[index]))
        total = total + term
    return Scalar.reduced(target, total, clearing)
