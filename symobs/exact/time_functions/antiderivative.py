"""Antiderivatives in one generator, the time: of rational functions, and of sums of c e^p cos q and c e^p sin q.

Those of rational functions are sought among rational functions (Ostrogradsky's method): where a logarithm would be needed
there is none.  The others are those of `waves`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from symobs.exact.core.generators import derivative, function
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.polynomial import from_coefficients
from symobs.exact.core.scalar import Scalar
from symobs.exact.linear_algebra.elimination import kernel
from symobs.exact.time_functions.quasipolynomial import depends_on_time
from symobs.exact.time_functions.trigonometric_sums import antiderivative_of_waves

if TYPE_CHECKING:
    from collections.abc import Sequence

Value = TypeVar("Value", Scalar, Matrix)

#: Beyond this degree of a denominator no rational antiderivative is sought: the equations grow with it.
DEGREE_UP_TO = 12


def antiderivative(value: Value, name: str) -> Value | None:
    """Return an antiderivative, None if none is found in closed form without logarithms."""
    if isinstance(value, Matrix):
        found = [[_antiderivative(entry, name) for entry in row] for row in value.rows]
        entries = [[entry for entry in row if entry is not None] for row in found]
        if any(len(row) != value.shape[1] for row in entries):
            return None
        return Matrix.of(entries, value.shape[1])
    return _antiderivative(value, name)


def _antiderivative(value: Scalar, name: str) -> Scalar | None:
    if any(depends_on_time(other, name) for other in value.names):
        found = antiderivative_of_waves(value, name)
        if found is None or (rest := _antiderivative(found[1], name)) is None:
            return None
        return found[0] + rest
    below = value.denominator
    whole, rest = _divided(value, name)
    total = _of_polynomial(whole, name)
    if rest.is_zero:
        return total
    if below.degree(name) > DEGREE_UP_TO:
        return None
    return None if (part := _of_proper(rest, name)) is None else total + part


def _divided(value: Scalar, name: str) -> tuple[Scalar, Scalar]:
    """Return (polynomial part, proper part) in `name`."""
    below = value.denominator
    lead, *lower = below.coefficients(name)
    remainder = [c / lead for c in value.numerator.coefficients(name)]
    quotient: list[Scalar] = []
    while len(remainder) > len(lower):
        factor = remainder.pop(0)
        quotient.append(factor)
        for i, c in enumerate(lower):
            remainder[i] = remainder[i] - factor * c / lead
    whole = from_coefficients(quotient, name)
    return whole, value - whole


def _of_polynomial(value: Scalar, name: str) -> Scalar:
    coefficients = value.coefficients(name)
    degree = len(coefficients)
    raised = [c * Scalar.rational(1, degree - i) for i, c in enumerate(coefficients)]
    return from_coefficients([*raised, Scalar.of(0)], name)


def _of_proper(value: Scalar, name: str) -> Scalar | None:
    """Return Q/D₁ with (Q/D₁)' = P/D, D₁ = gcd(D, D'), where it exists.

    Q of degree below D₁'s, by comparing coefficients: Q' D/D₁ − Q (D/D₁) D₁'/D₁ = P.
    """
    below = value.denominator
    power = Scalar.of(1)
    for factor, exponent in below.factors()[1]:
        power = power * factor ** (exponent - 1) if factor.degree(name) > 0 else power
    degree = power.degree(name)
    if degree < 1:
        return None
    t = Scalar.symbol(name)
    columns = [(derivative(t**k / power, name) * below, t**k) for k in range(degree)]
    found = _combination([column for column, _ in columns], value.numerator, name)
    if found is None:
        return None
    total = Scalar.of(0)
    for coefficient, (_, monomial) in zip(found, columns, strict=True):
        total = total + coefficient * monomial / power
    return total


def _combination(parts: Sequence[Scalar], whole: Scalar, name: str) -> list[Scalar] | None:
    """Return c with Σ cᵢ parts[i] = whole for polynomials in `name`, None if there is none."""
    height = max(part.degree(name) for part in (*parts, whole)) + 1

    def column(value: Scalar) -> list[Scalar]:
        coefficients = list(value.coefficients(name))
        return [Scalar.of(0)] * (height - len(coefficients)) + coefficients

    table = Matrix.of([column(part) for part in (*parts, whole)]).T
    basis = kernel(table)
    if basis.shape[1] != 1 or basis[len(parts), 0].is_zero:
        return None
    return [-basis[i, 0] / basis[len(parts), 0] for i in range(len(parts))]


def exponential_of_integral(value: Scalar, name: str) -> Scalar | None:
    """Return ρ = e^p Π fᵢ^nᵢ with ρ' = value · ρ, None unless value = p' + Σ nᵢ fᵢ'/fᵢ for a polynomial p."""
    if any(depends_on_time(other, name) for other in value.names):
        return None
    whole, rest = _divided(value, name)
    found = _of_logarithms(rest, name)
    return None if found is None else found * function("exp", _of_polynomial(whole, name))


def _of_logarithms(value: Scalar, name: str) -> Scalar | None:
    """Return a rational ρ with ρ' = value · ρ, where value = Σ nᵢ fᵢ'/fᵢ with integers nᵢ."""
    if value.is_zero:
        return Scalar.of(1)
    below = value.denominator
    factors = [(factor, power) for factor, power in below.factors()[1] if factor.degree(name) > 0]
    if not factors or any(power > 1 for _, power in factors) or value.degree(name) >= below.degree(name):
        return None
    parts = [derivative(factor, name) / factor * below for factor, _ in factors]
    found = _combination(parts, value.numerator, name)
    if found is None or any(not n.is_constant or n.fraction().denominator != 1 for n in found):
        return None
    result = Scalar.of(1)
    for (factor, _), n in zip(factors, found, strict=True):
        result = result * factor ** int(n.fraction())
    return result
