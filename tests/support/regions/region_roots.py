"""Exact real numbers for judging regions: real roots in FLINT's certified balls, and signs of expressions with roots.

What is asked of a root is decided in integers.  A sum with square roots is decided by balls (Arb) where it is not 0, and by
FLINT's algebraic numbers where it may be.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from math import gcd, isqrt, lcm, prod
from typing import TYPE_CHECKING, Any

from flint import arb, ctx, fmpq, fmpz_poly
from flint.types._gr import gr_real_qqbar_ctx  # type: ignore[import-not-found, unused-ignore]

from tests.support.regions.region_texts import (
    Binary,
    Call,
    Name,
    Node,
    Number,
    Power,
    UnreadableError,
    fraction,
    rational,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_LAST_PRECISION = 1 << 13


class UndefinedError(ArithmeticError):
    """A division by 0, or the root of a negative number."""


class _IrrationalError(ArithmeticError):
    pass


# -- real roots ----------------------------------------------------------------------------------------------------


def primitive(coefficients: Sequence[Fraction | int]) -> tuple[int, ...]:
    """Return a positive multiple with coprime integers, without leading zeros; the highest power comes first."""
    fractions = [Fraction(c) for c in coefficients]
    scale = lcm(*(c.denominator for c in fractions))
    found = [int(c * scale) for c in fractions]
    while found and not found[0]:
        found.pop(0)
    common = gcd(*found) or 1
    return tuple(c // common for c in found)


def _value(polynomial: Sequence[int], x: Fraction) -> int:
    """Return the value times a positive number."""
    total, scale = 0, 1
    for c in polynomial:
        total = total * x.numerator + c * scale
        scale *= x.denominator
    return total


def count_real_roots(polynomial: Sequence[int]) -> int:
    """Count the distinct real roots."""
    return len(real_roots(polynomial))


@dataclass
class Root:
    """The only root of a squarefree polynomial between two rational numbers that are no roots, or (low = high) itself."""

    polynomial: tuple[int, ...]
    low: Fraction
    high: Fraction

    def compare(self, x: Fraction) -> int:
        """Return the sign of root − x; the enclosure shrinks by what is learned."""
        if self.low == self.high:
            return (self.low > x) - (self.low < x)
        if x <= self.low:
            return 1
        if x >= self.high:
            return -1
        here = _value(self.polynomial, x)
        if here == 0:
            self.low = self.high = x
            return 0
        if (here > 0) == (_value(self.polynomial, self.low) > 0):
            self.low = x
            return 1
        self.high = x
        return -1

    def narrow(self, width: Fraction) -> None:
        """Halve the enclosure until it is no wider than this."""
        while self.high - self.low > width:
            self.compare((self.low + self.high) / 2)


def real_roots(coefficients: Sequence[Fraction | int]) -> list[Root]:
    """Return the distinct real roots in ascending order, each in the ball that FLINT certifies."""
    whole = fmpz_poly(list(reversed(primitive(coefficients))))
    if whole.degree() < 1:
        return []
    free = whole / whole.gcd(whole.derivative())
    polynomial = primitive([int(c) for c in reversed(free.coeffs())])
    found = []
    roots: Any = free.complex_roots()
    for root, _ in roots:
        if root.imag == 0:
            middle, radius = (_fraction(part) for part in (root.real.mid(), root.real.rad()))
            found.append(Root(polynomial, middle - radius, middle + radius))
    return sorted(found, key=lambda root: root.low)


def _fraction(value: arb) -> Fraction:
    """Return a number that has no radius."""
    mantissa, exponent = value.man_exp()
    return Fraction(int(mantissa)) * Fraction(2) ** int(exponent)


# -- expressions at a point -----------------------------------------------------------------------------------------


def root_of(node: Call, point: Mapping[str, Fraction]) -> Root:
    """Return the real root that `CRootOf(p, k)` names; real roots are counted first, in ascending order."""
    above, below = fraction(node.arguments[0])
    if below.constant is None or below.constant < 0:
        raise UnreadableError(f"{node}: no polynomial")
    match node.arguments[1:-1]:
        case (Name(name),):
            generators = frozenset({name})
        case _:
            generators = above.names - point.keys() if len(above.names) > 1 else above.names
    if len(generators) != 1:
        raise UnreadableError(f"{node}: which variable?")
    (generator,) = generators
    if not above.names - generators <= point.keys():
        raise UnreadableError(f"{node}: depends on a variable")
    values = above.at({name: point[name] for name in above.names - generators})
    constants = [c.constant for c in values.coefficients(generator)]
    found = _roots_cached(primitive([c for c in constants if c is not None]))
    k = rational(node.arguments[-1])
    if not 0 <= k < len(found):
        raise UndefinedError(f"{node} is not real")
    return found[int(k)]


@lru_cache(maxsize=4096)
def _roots_cached(polynomial: tuple[int, ...]) -> list[Root]:
    return real_roots(polynomial)


def value(node: Node, point: Mapping[str, Fraction]) -> Fraction:
    """Return the value of an expression where it is seen to be rational."""
    match node:
        case Number(number):
            return number
        case Name(name):
            if name not in point:
                raise UnreadableError(f"{name} has no value")
            return point[name]
        case Binary(op, left, right):
            a, b = value(left, point), value(right, point)
            if op == "/" and not b:
                raise UndefinedError(str(node))
            return a + b if op == "+" else a - b if op == "-" else a * b if op == "*" else a / b
        case Power(base, exponent):
            a = value(base, point)
            if exponent < 0 and not a:
                raise UndefinedError(str(node))
            return a**exponent
        case Call("sqrt", (inside,)):
            a = value(inside, point)
            if a < 0:
                raise UndefinedError(str(node))
            above, below = isqrt(a.numerator), isqrt(a.denominator)
            if above * above != a.numerator or below * below != a.denominator:
                raise _IrrationalError
            return Fraction(above, below)
        case Call("Abs", (inside,)):
            return abs(value(inside, point))
        case Call():
            root = root_of(node, point)
            if root.low != root.high:
                raise _IrrationalError
            return root.low


def compare(node: Node, x: Fraction, point: Mapping[str, Fraction]) -> int:
    """Return the sign of an expression at a point minus x, exactly."""
    if isinstance(node, Call) and node.function == "CRootOf":
        return root_of(node, point).compare(x)
    return sign(Binary("-", node, Number(x)), point)


def sign(node: Node, point: Mapping[str, Fraction]) -> int:
    """Return the sign of an expression at a point, exactly."""
    try:
        exact = value(node, point)
    except _IrrationalError:
        pass
    else:
        return (exact > 0) - (exact < 0)
    precision, before = 64, ctx.prec
    try:
        while precision <= _LAST_PRECISION:
            ctx.prec = precision
            ball = _ball(node, point)
            if ball > 0 or ball < 0:
                return 1 if ball > 0 else -1
            if precision == 256 and not _has_root_of(node) and _is_zero(node, point):
                return 0
            precision *= 2
    finally:
        ctx.prec = before
    raise UnreadableError(f"{node}: sign not decided at {dict(point)}")


def _ball(node: Node, point: Mapping[str, Fraction]) -> arb:
    match node:
        case Number() | Name():
            number = value(node, point)
            return arb(fmpq(number.numerator, number.denominator))
        case Binary(op, left, right):
            a, b = _ball(left, point), _ball(right, point)
            if op == "/" and sign_is_zero(right, point, b):
                raise UndefinedError(str(node))
            return a + b if op == "+" else a - b if op == "-" else a * b if op == "*" else a / b
        case Power(base, exponent):
            a = _ball(base, point)
            if exponent < 0 and sign_is_zero(base, point, a):
                raise UndefinedError(str(node))
            power = prod([a] * abs(exponent), start=arb(1))  # `arb ** 2` knows no ball around 0
            return power if exponent >= 0 else 1 / power
        case Call("sqrt", (inside,)):
            inner = _ball(inside, point)
            if not inner > 0:
                precision = ctx.prec
                seen = sign(inside, point)
                ctx.prec = precision
                if seen < 0:
                    raise UndefinedError(str(node))
                if seen == 0:
                    return arb(0)
                inner = _ball(inside, point)
            return inner.sqrt()
        case Call("Abs", (inside,)):
            return abs(_ball(inside, point))
        case Call():
            root = root_of(node, point)
            root.narrow(Fraction(1, 1 << ctx.prec))
            middle, radius = (root.low + root.high) / 2, (root.high - root.low) / 2
            return _ball(Number(middle), point) + arb(0, 1) * _ball(Number(radius), point)


def sign_is_zero(node: Node, point: Mapping[str, Fraction], ball: arb) -> bool:
    """Tell whether an expression is 0 where its ball does not say so."""
    return not (ball > 0 or ball < 0) and sign(node, point) == 0


def _has_root_of(node: Node) -> bool:
    match node:
        case Number() | Name():
            return False
        case Binary(_, left, right):
            return _has_root_of(left) or _has_root_of(right)
        case Power(base):
            return _has_root_of(base)
        case Call(function, arguments):
            return function == "CRootOf" or any(_has_root_of(argument) for argument in arguments)


def _is_zero(node: Node, point: Mapping[str, Fraction]) -> bool:
    numbers = gr_real_qqbar_ctx.new()
    return bool(_algebraic(node, point, numbers) == numbers(0))


def _algebraic(node: Node, point: Mapping[str, Fraction], numbers: Any) -> Any:
    match node:
        case Number() | Name():
            number = value(node, point)
            return numbers(fmpq(number.numerator, number.denominator))
        case Binary(op, left, right):
            a, b = _algebraic(left, point, numbers), _algebraic(right, point, numbers)
            return a + b if op == "+" else a - b if op == "-" else a * b if op == "*" else a / b
        case Power(base, exponent):
            a = _algebraic(base, point, numbers)
            return a**exponent
        case Call("sqrt", (inside,)):
            return _algebraic(inside, point, numbers).sqrt()
        case Call(_, (inside, *_)):
            return abs(_algebraic(inside, point, numbers))
