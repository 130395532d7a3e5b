"""Sums of c e^p cos q and c e^p sin q, with rational c and polynomials p and q of one generator: form and antiderivatives.

A sum is held as `to_quasipolynomial` gives it.  An antiderivative of c e^p, if there is an elementary one, is r e^p with
r' + p' r = c (Liouville), and where c is a polynomial so is r: its coefficients follow from the highest down.
"""

from __future__ import annotations

from symobs.exact.core.generators import ZERO, derivative, function, function_named, symbols_in
from symobs.exact.core.scalar import Scalar
from symobs.exact.time_functions.quasipolynomial import Key, Quasipolynomial, to_quasipolynomial


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
