"""Quasipolynomials: sums of c · tⁿ e^{αt}, c · tⁿ e^{αt} cos βt and c · tⁿ e^{αt} sin βt with constants c, α, β.

These functions are linearly independent, so a sum has one form: two are equal where their coefficients are.  Sums are
closed under products, derivatives and integrals.  Constants are scalars, with square roots in normal form (`normal_form`).
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact.core.generators import (
    ONE,
    ZERO,
    function,
    function_named,
    identities,
    leads_with_minus,
    normal_form,
    roots_in,
    symbols_in,
    with_roots,
)
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

_HALF = Fraction(1, 2)


class Key(NamedTuple):
    """The function tⁿ e^{rate · t}, times cos or sin of frequency · t if `wave` is one of them."""

    power: int
    rate: Scalar
    wave: str
    frequency: Scalar


@dataclass
class Quasipolynomial:
    """Σ coefficient · function; no coefficient is 0."""

    terms: Mapping[Key, Scalar]

    @staticmethod
    def of(terms: Iterable[tuple[Key, Scalar]]) -> Quasipolynomial:
        """Return the sum of terms, collected by function."""
        total: dict[Key, Scalar] = {}
        for key, coefficient in terms:
            total[key] = total[key] + coefficient if key in total else coefficient
        tidied = {key: normal_form(coefficient) for key, coefficient in total.items()}
        return Quasipolynomial({key: coefficient for key, coefficient in tidied.items() if not coefficient.is_zero})

    @staticmethod
    def constant(value: Scalar) -> Quasipolynomial:
        """Return a constant."""
        return Quasipolynomial.of([(Key(0, ZERO, "", ZERO), value)])

    def __add__(self, other: Quasipolynomial) -> Quasipolynomial:
        return Quasipolynomial.of([*self.terms.items(), *other.terms.items()])

    def __neg__(self) -> Quasipolynomial:
        return Quasipolynomial({key: -coefficient for key, coefficient in self.terms.items()})

    def __sub__(self, other: Quasipolynomial) -> Quasipolynomial:
        return self + (-other)

    def scaled(self, factor: Scalar) -> Quasipolynomial:
        """Return the sum times a constant."""
        return Quasipolynomial.of([(key, coefficient * factor) for key, coefficient in self.terms.items()])

    def __mul__(self, other: Quasipolynomial) -> Quasipolynomial:
        found: list[tuple[Key, Scalar]] = []
        for a, left in self.terms.items():
            for b, right in other.terms.items():
                found += _times(a, b, left * right)
        return Quasipolynomial.of(found)

    @property
    def is_zero(self) -> bool:
        """Whether the function vanishes."""
        return not self.terms

    @property
    def at_zero(self) -> Scalar:
        """The value at t = 0."""
        total = ZERO
        for key, coefficient in self.terms.items():
            if key.power == 0 and key.wave != "sin":
                total = total + coefficient
        return normal_form(total)

    def derivative(self) -> Quasipolynomial:
        """Return d/dt."""
        found: list[tuple[Key, Scalar]] = []
        for key, c in self.terms.items():
            if key.power:
                found.append((key._replace(power=key.power - 1), c * key.power))
            found.append((key, c * key.rate))
            if key.wave:
                other = "sin" if key.wave == "cos" else "cos"
                found.append((key._replace(wave=other), c * key.frequency * (-1 if key.wave == "cos" else 1)))
        return Quasipolynomial.of(found)

    def integral(self) -> Quasipolynomial:
        """Return the integral from 0 to t, by parts; where a rate depends on parameters it must not vanish."""
        found: list[tuple[Key, Scalar]] = []
        for key, coefficient in self.terms.items():
            found += _primitive(key, coefficient)
        whole = Quasipolynomial.of(found)
        return whole - Quasipolynomial.constant(whole.at_zero)

    def reversed(self) -> Quasipolynomial:
        """Return the function of −t."""
        found = []
        for key, c in self.terms.items():
            sign = (-1) ** key.power * (-1 if key.wave == "sin" else 1)
            found.append((key._replace(rate=-key.rate), c * sign))
        return Quasipolynomial.of(found)

    def value_at(self, time: Scalar) -> Scalar:
        """Return the scalar whose generators are functions of `time`, conjugate exponentials as cosh and sinh."""
        total = ZERO
        parts = [part for key, c in self.terms.items() for part in (key.rate, key.frequency, c)]
        roots = dict.fromkeys(root for part in parts for root in roots_in(part))
        for key, coefficient in _hyperbolic(self.terms):
            value = with_roots(normal_form(coefficient), roots) * time**key.power * function("exp", key.rate * time)
            total = total + (value * function(key.wave, key.frequency * time) if key.wave else value)
        return total


def _key(power: int, rate: Scalar, wave: str, frequency: Scalar, c: Scalar) -> list[tuple[Key, Scalar]]:
    """Return a term in normal form: a positive frequency, or none."""
    if frequency.is_zero:
        return [] if wave == "sin" else [(Key(power, rate, "", ZERO), c)]
    if leads_with_minus(frequency):
        frequency, c = -frequency, (-c if wave == "sin" else c)
    return [(Key(power, rate, wave, frequency), c)]


def _times(a: Key, b: Key, c: Scalar) -> list[tuple[Key, Scalar]]:
    """Return a product of two functions as a sum, that of two waves by sum and difference of angles."""
    power, rate = a.power + b.power, normal_form(a.rate + b.rate)
    if not a.wave or not b.wave:
        return [(Key(power, rate, a.wave or b.wave, a.frequency + b.frequency), c)]
    if a.wave == "cos" and b.wave == "sin":
        a, b = b, a
    both, apart = normal_form(a.frequency + b.frequency), normal_form(a.frequency - b.frequency)
    half = c * _HALF
    if a.wave == "sin" and b.wave == "sin":
        return [*_key(power, rate, "cos", apart, half), *_key(power, rate, "cos", both, -half)]
    return [*_key(power, rate, a.wave, apart, half), *_key(power, rate, a.wave, both, half)]


def _primitive(key: Key, c: Scalar) -> list[tuple[Key, Scalar]]:
    """Return an antiderivative of c tⁿ e^{αt} (1, cos βt or sin βt)."""
    power, a, b = key.power, key.rate, key.frequency
    if a.is_zero and not key.wave:
        return [(key._replace(power=power + 1), c / (power + 1))]
    if not key.wave:
        lower = _primitive(key._replace(power=power - 1), -(c * power) / a) if power else []
        return [(key, normal_form(c / a)), *lower]
    size = normal_form(a * a + b * b)
    p, q = (c, ZERO) if key.wave == "cos" else (ZERO, c)
    found: list[tuple[Key, Scalar]] = []
    for wave, part in (("cos", (a * p - b * q) / size), ("sin", (b * p + a * q) / size)):
        if not part.is_zero:
            found.append((key._replace(wave=wave), normal_form(part)))
            found += _primitive(key._replace(wave=wave, power=power - 1), -part * power) if power else []
    return found


def _hyperbolic(terms: Mapping[Key, Scalar]) -> list[tuple[Key, Scalar]]:
    """Return the terms with e^{(σ+μ)t} and e^{(σ−μ)t} as e^{σt} cosh μt and e^{σt} sinh μt where μ is a root.

    Where a cosine or sine stands beside such a pair, the two exponentials stay.
    """
    found: dict[Key, Scalar] = {}
    for key, c in terms.items():
        middle, offset = rate_parts(key.rate)
        if offset.is_zero or key.wave:
            found[key] = found.get(key, ZERO) + c
            continue
        turned = leads_with_minus(offset)
        offset = -offset if turned else offset
        for wave, part in (("cosh", c), ("sinh", -c if turned else c)):
            place = Key(key.power, middle, wave, offset)
            found[place] = found.get(place, ZERO) + part
    return [(key, c) for key, c in found.items() if not normal_form(c).is_zero]


def rate_parts(rate: Scalar) -> tuple[Scalar, Scalar]:
    """Return (the part without square roots, the rest); beside others, roots of primes are numbers as all are.

    A rate that divides by roots is all without.
    """
    roots = roots_in(rate)
    names: list[str] = [f.name for f in roots if not f.square] or [f.name for f in roots]
    moving = dict.fromkeys(names, ZERO)
    plain = rate if moving.keys() & rate.denominator.names else rate.substitute(moving)
    return plain, rate - plain


# -- from scalars ----------------------------------------------------------------------------------------------------


def quasi_of(value: Scalar, time: str = "t") -> Quasipolynomial:
    """Return the quasipolynomial of a scalar; raises ValueError if it is none, such as exp(t²) or 1/t."""
    waves, found = to_quasipolynomial(value, time), list[tuple[Key, Scalar]]()
    for key, c in waves.terms.items() if waves else ():
        rate, frequency = (part / Scalar.symbol(time) for part in (key.rate, key.frequency))
        if time in symbols_in(rate) | symbols_in(frequency) | symbols_in(c.denominator):
            waves = None
            break
        for power, coefficient in enumerate(reversed(c.coefficients(time))):
            found += _key(power, rate, key.wave, frequency, coefficient)
    if waves is None:
        raise ValueError(f"{value} is not a sum of exponentials, sines and cosines times powers of {time}")
    return Quasipolynomial.of(found)


def depends_on_time(name: str, by: str) -> bool:
    """Return whether a generator is a function of the generator `by`."""
    found = function_named(name)
    return found is not None and found.kind != "sqrt" and by in found.symbols


def to_quasipolynomial(value: Scalar, by: str = "") -> Quasipolynomial | None:
    """Return a value as a sum of functions of the generator `by`, of all generators where none is named.

    Rates and frequencies are the exponents and arguments themselves, and powers are 0.  None where a denominator, or
    something that is no exponential, cosine or sine, stands in the way.
    """

    def counts(name: str) -> bool:
        found = function_named(name)
        return depends_on_time(name, by) if by else found is not None and found.kind != "sqrt"

    meanings, _ = identities([value])
    if not any(name.startswith(("cos(", "sin(")) for name in value.denominator.names):
        meanings = {name: meaning for name, meaning in meanings.items() if not name.startswith(("cos(", "sin("))}
    value = value.substitute({name: meaning for name, meaning in meanings.items() if counts(name)})
    below, lowered = value.denominator, ZERO
    for name in value.denominator.names:
        if counts(name):
            found, power = function_named(name), below.degree(name)
            below = below / Scalar.symbol(name) ** power
            if found is None or found.kind != "exp" or name in below.names:
                return None
            lowered = lowered - found.argument * power
    total: list[tuple[Key, Scalar]] = []
    for coefficient, powers in value.numerator.terms():
        constant, exponent, waves = Scalar.of(coefficient) / below, lowered, Quasipolynomial.constant(ONE)
        for name, power in powers:
            found = function_named(name)
            if found is None or not counts(name):
                constant = constant * Scalar.symbol(name) ** power
            elif found.kind == "exp":
                exponent = exponent + found.argument * power
            elif found.kind in {"cos", "sin"}:
                for _ in range(power):
                    waves = waves * Quasipolynomial({Key(0, ZERO, found.kind, found.argument): ONE})
            else:
                return None
        total += [(key._replace(rate=exponent), c * constant) for key, c in waves.terms.items()]
    return Quasipolynomial.of(total)


# -- tables ----------------------------------------------------------------------------------------------------------

Table = tuple[tuple[Quasipolynomial, ...], ...]


def table_of(matrix: Matrix, time: str = "t") -> Table:
    """Return the entries of a matrix as sums."""
    return tuple(tuple(quasi_of(entry, time) for entry in row) for row in matrix.rows)


def product(left: Table, right: Table) -> Table:
    """Return the matrix product."""
    columns = transposed(right)
    return tuple(tuple(_dot(row, column) for column in columns) for row in left)


def _dot(row: Iterable[Quasipolynomial], column: Iterable[Quasipolynomial]) -> Quasipolynomial:
    total = Quasipolynomial({})
    for a, b in zip(row, column, strict=True):
        total = total + a * b
    return total


def transposed(table: Table) -> Table:
    """Return the transpose."""
    return tuple(zip(*table, strict=True))


def integral(table: Table) -> Table:
    """Return the integrals from 0 to t, entry by entry."""
    return tuple(tuple(entry.integral() for entry in row) for row in table)


def determinant(table: Table) -> Quasipolynomial:
    """Return the determinant, by the first row."""
    if len(table) == 1:
        return table[0][0]
    total = Quasipolynomial({})
    for j, entry in enumerate(table[0]):
        if not entry.is_zero:
            rest = tuple(row[:j] + row[j + 1 :] for row in table[1:])
            term = entry * determinant(rest)
            total = total - term if j % 2 else total + term
    return total


def matrix_at(table: Table, time: Scalar) -> Matrix:
    """Return the matrix of values in functions of `time`."""
    return Matrix.of([[entry.value_at(time) for entry in row] for row in table], len(table[0]))
