"""Antiderivatives in one generator, the time: of rational functions, and of sums of c e^p cos q and c e^p sin q.

Those of rational functions are sought among rational functions (Ostrogradsky's method): where a logarithm would be needed
there is none.  The others are those of `waves`.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, TypeVar

from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.algebraic.rounded_decimals import root_in_field
from symobs.exact.core.generators import ZERO, NotWritten, derivative, function, function_named, square_root, symbols_in
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.polynomial import from_coefficients
from symobs.exact.core.scalar import Scalar
from symobs.exact.linear_algebra.elimination import kernel
from symobs.exact.time_functions.quasipolynomial import Key, Quasipolynomial, depends_on_time, to_quasipolynomial

if TYPE_CHECKING:
    from collections.abc import Sequence


# Sums of c e^p cos q and c e^p sin q, with rational c and polynomials p and q of one generator: form and
# antiderivatives.
#
# A sum is held as `to_quasipolynomial` gives it. An antiderivative of c e^p, if there is an elementary one, is r e^p
# with r' + p' r = c (Liouville), and where c is a polynomial so is r: its coefficients follow from the highest down.


def value_of(waves: Quasipolynomial) -> Scalar:
    """Return the sum as a scalar."""
    total = ZERO
    for key, c in waves.terms.items():
        value = c * function("exp", key.rate)
        total = total + (value * function(key.wave, key.frequency) if key.wave else value)
    return total


def collected(value: Scalar) -> Scalar:
    """Return a value with one exponential and at most one cosine or sine in each term, if possible."""
    if not any(function_named(name) for name in value.names):
        return value
    waves = to_quasipolynomial(value)
    return value if waves is None else value_of(waves)


def antiderivative_of_waves(value: Scalar, name: str) -> tuple[Scalar, Scalar] | None:
    """Return (an antiderivative of the terms with functions of `name`, the rest of the integrand).

    None where a term has no elementary antiderivative, or is not treated here: exponents and coefficients are polynomials.
    """
    waves = to_quasipolynomial(value, name)
    if waves is None:
        return None
    groups: dict[tuple[Scalar, Scalar], dict[str, Scalar]] = {}
    for key, c in waves.terms.items():
        groups.setdefault((key.rate, key.frequency), {})[key.wave] = c
    rest = groups.pop((ZERO, ZERO), {}).get("", ZERO)
    found: list[tuple[Key, Scalar]] = []
    for (p, q), parts in groups.items():
        if derivative(p, name).is_zero and derivative(q, name).is_zero:  # e^t e^(t0 - t) is constant
            rest = rest + value_of(Quasipolynomial.of((Key(0, p, wave, q), c) for wave, c in parts.items()))
            continue
        pair = _solved(p, q, (parts.get("cos", parts.get("", ZERO)), parts.get("sin", ZERO)), name)
        if pair is None:
            return None
        names = ("cos", "sin") if not q.is_zero else ("", "")
        found += [(Key(0, p, wave, q), r) for wave, r in zip(names, pair, strict=True) if not r.is_zero]
    return value_of(Quasipolynomial.of(found)), rest


def _solved(p: Scalar, q: Scalar, wanted: tuple[Scalar, Scalar], name: str) -> tuple[Scalar, Scalar] | None:
    """Return polynomials u, v with u' + p'u + q'v = a and v' + p'v − q'u = b, None if there are none."""
    if any(name in symbols_in(part.denominator) for part in (p, q, *wanted)):
        return None
    a, b = wanted
    growth, turn, t = derivative(p, name), derivative(q, name), Scalar.symbol(name)
    degree = max(growth.degree(name), turn.degree(name))
    x, y = _coefficient(growth, degree, name), _coefficient(turn, degree, name)
    u = v = ZERO
    while not (a.is_zero and b.is_zero):
        power = max(part.degree(name) for part in (a, b) if not part.is_zero)
        if power < degree:
            return None
        above, beside, size = _coefficient(a, power, name), _coefficient(b, power, name), x * x + y * y
        monomial = t ** (power - degree)
        du, dv = (x * above - y * beside) / size * monomial, (y * above + x * beside) / size * monomial
        a = a - derivative(du, name) - growth * du - turn * dv
        b = b - derivative(dv, name) - growth * dv + turn * du
        u, v = u + du, v + dv
    return u, v


def _coefficient(value: Scalar, power: int, name: str) -> Scalar:
    """Return the coefficient of a power of a generator in a polynomial of it."""
    found = value.coefficients(name)
    return found[len(found) - 1 - power] if power < len(found) else ZERO


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


# Butterworth polynomials, with cosines of rational angles by square roots.


def twice_cosine(turns: Fraction) -> Scalar:
    """Return 2 cos(π turns) for 0 ≤ turns ≤ 1, by halving angles.

    An even denominator is halved down, 2 cos θ = √(2 + 2 cos 2θ); 1, 3 and 5 are known.  Raises `NotWritten` elsewhere.
    """
    if turns > Fraction(1, 2):
        return -twice_cosine(1 - turns)
    if turns == Fraction(1, 2):
        return Scalar.of(0)
    if turns.denominator % 2 == 0:
        square = twice_cosine(2 * turns) + 2
        root = root_in_field(square) if is_number(square) else None
        return square_root(square) if root is None else root
    if turns == 0:
        return Scalar.of(2)
    if turns.denominator == 3:
        return Scalar.of(1)
    if turns.denominator == 5:
        return (square_root(Scalar.of(5)) + (1 if turns.numerator == 1 else -1)) / 2
    raise NotWritten(f"cos({turns}*pi) is not written with square roots here")


def butterworth_angles(count: int) -> tuple[Fraction, ...]:
    """Return the angles of the complex pairs from the negative real axis, in half turns."""
    return tuple(Fraction(2 * k + 1 - count % 2, 2 * count) for k in range(count % 2, count // 2 + count % 2))


def butterworth(count: int, radius: Scalar, variable: str) -> tuple[Scalar, ...]:
    """Return the real factors of the p with p(s) p(−s) = ω^{2N} + (−1)^N s^{2N} whose roots lie in Re s < 0 for ω > 0."""
    s = Scalar.symbol(variable)
    pairs = [s**2 + twice_cosine(turns) * radius * s + radius**2 for turns in butterworth_angles(count)]
    return (*([s + radius] if count % 2 else []), *pairs)
