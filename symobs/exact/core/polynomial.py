"""Polynomials in one variable with scalar coefficients: construction, and evaluation at a matrix."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact.core import matrix as rational_matrix
from symobs.exact.core import ring
from symobs.exact.core.field import Field
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Collection, Iterable, Sequence


def from_coefficients(coefficients: Sequence[Scalar], variable: str) -> Scalar:
    """Return Σ c_k variable^k, coefficients given highest power first."""
    generator, value = Scalar.symbol(variable), Scalar.of(0)
    for coefficient in coefficients:
        value = value * generator + coefficient
    return value


def highest_power(values: Iterable[Scalar | Matrix], names: Collection[str]) -> int:
    """Return a bound for the powers of these names in numerators and denominators, in lowest terms or not, at least 1."""
    found = 1
    for value in values:
        for entry in [value] if isinstance(value, Scalar) else value.entries:
            places = [entry.field.position[name] for name in names if name in entry.field.position]
            degrees = [part.degrees() for part in (entry.numerator_part, entry.denominator_part)] if places else []
            found = max([found, *(int(each[place]) for each in degrees for place in places)])
    return found


def coefficients_over(value: Scalar, names: Collection[str]) -> list[Scalar]:
    """Return the coefficients of a numerator as a polynomial in all other names."""
    return list(by_monomial(value, names).values())


def by_monomial(value: Scalar, names: Collection[str]) -> dict[tuple[tuple[str, int], ...], Scalar]:
    """Return the coefficients of a numerator as a polynomial in all other names, by their monomials."""
    found: dict[tuple[tuple[str, int], ...], Scalar] = {}
    for coefficient, powers in value.numerator.terms():
        inner = Scalar.of(coefficient)
        for name, power in powers:
            inner = inner * Scalar.symbol(name) ** power if name in names else inner
        monomial = tuple((name, power) for name, power in powers if name not in names)
        found[monomial] = found.get(monomial, Scalar.of(0)) + inner
    return found


def product_of(factors: Iterable[Scalar]) -> Scalar:
    """Return the product."""
    several = tuple(factors)
    value = several[0] if several else Scalar.of(1)
    for factor in several[1:]:
        value = value * factor
    return value


def apply_polynomial(factors: Iterable[Scalar], variable: str, matrix: Matrix, vector: Matrix) -> Matrix:
    """Return φ(matrix) · vector for φ the product of `factors`, by Horner's rule on one factor after the other.

    No power of the matrix is formed: a factor s + p costs one product of matrix and vector.
    """
    factors = tuple(factors)
    field = matrix.field | vector.field
    beyond = {name for f in factors for name in f.field.names if name not in field.position} - {variable}
    if beyond:
        field = field | Field.of(beyond.intersection(set().union(*(f.names for f in factors))))
    matrix, vector = matrix.within(field), vector.within(field)
    apply = _horner if field.names else rational_matrix.horner
    for factor in factors:
        vector = apply(factor.coefficients(variable, field), matrix, vector)
    return vector if field.names else vector.normal()


def _horner(coefficients: Sequence[Scalar], matrix: Matrix, vector: Matrix) -> Matrix:
    """Return Σ cₖ Mⁿ⁻ᵏ v on the integral tables: with M = N/d the step is w ← N w + cₖ dᵏ v."""
    field, rows, scale = matrix.field, matrix.polynomials, matrix.denominator
    column = [row[0] for row in vector.polynomials]
    common = field.one
    for coefficient in coefficients:
        common = ring.common_multiple(common, coefficient.denominator_part)
    whole = [coefficient.over(common) for coefficient in coefficients]
    below = vector.denominator * common * scale ** (len(whole) - 1)
    if len(whole) == 2:
        moved = ring.plus_diagonal(rows, whole[0], whole[1] * scale)
        image = [ring.dot(row, column, field.zero) for row in moved]
        return Matrix(field, tuple((entry,) for entry in image), below, vector.shape)
    image = [entry * whole[0] for entry in column] if not whole[0].is_one() else column
    power = field.one
    for numerator in whole[1:]:
        power = power * scale
        factor = numerator * power
        image = [ring.dot(row, image, field.zero) for row in rows]
        if factor:
            image = [entry + factor * old for entry, old in zip(image, column, strict=True)]
        image = list(map(field.normal, image)) if field.roots else image
    return Matrix(field, tuple((entry,) for entry in image), below, vector.shape)


def companion(coefficients: Sequence[Scalar]) -> Matrix:
    """Return the matrix of the controllable canonical form for sⁿ + c₁ sⁿ⁻¹ + … + cₙ, given c₁ … cₙ.

    Ones above the diagonal, the last row −cₙ … −c₁.
    """
    order = len(coefficients)
    rows: list[list[Scalar]] = [[Scalar.of(int(j == i + 1)) for j in range(order)] for i in range(order - 1)]
    return Matrix.of([*rows, [-c for c in reversed(coefficients)]])


def hankel_of(coefficients: Sequence[Scalar]) -> Matrix:
    """Return [cₙ₋₁ … c₁ 1; …; c₁ 1 0 …; 1 0 … 0], which transforms 𝒞 to canonical form.

    For s² + c₁ s + c₂ it is [c₁ 1; 1 0].
    """
    order = len(coefficients)
    ascending = [*reversed(coefficients), Scalar.of(1)]
    return Matrix.of(
        [[ascending[i + j + 1] if i + j + 1 <= order else Scalar.of(0) for j in range(order)] for i in range(order)]
    )


def remainder(polynomial: Scalar, divisor: Scalar, variable: str) -> tuple[Scalar, Scalar]:
    """Return (quotient, remainder); raises ZeroDivisionError for the divisor 0."""
    s = Scalar.symbol(variable)
    quotient, rest = Scalar.of(0), polynomial
    degree, top = divisor.degree(variable), divisor.coefficients(variable)[0]
    while not rest.is_zero and rest.degree(variable) >= degree:
        lead = rest.coefficients(variable)[0] / top * s ** (rest.degree(variable) - degree)
        quotient, rest = quotient + lead, rest - lead * divisor
    return quotient, rest


def discriminant(polynomial: Scalar, variable: str) -> Scalar:
    """Return the discriminant of the numerator in a variable: 0 where two roots are equal."""
    field = polynomial.field
    return Scalar(field, field.normal(polynomial.numerator_part.discriminant(variable)), field.one)


def resultant(one: Scalar, other: Scalar, variable: str) -> Scalar:
    """Return the resultant of two numerators in a variable: 0 where they have a root in common, or both leads vanish."""
    field = one.field | other.field | Field.of((variable,))
    one, other = one.within(field), other.within(field)
    return Scalar(field, field.normal(one.numerator_part.resultant(other.numerator_part, variable)), field.one)
