"""Whether a value with roots and functions is 0 at a rational point: by enclosures, and by the size of what is not 0.

With rational numbers for its letters a value without exponentials is an algebraic number.  Where c x is an algebraic
integer other than 0 and no conjugate of x is larger than M, |x| is at least c^-N M^(1-N), with N the number of
conjugates: their product times c^N is an integer.  Enough digits therefore decide.  Exponentials of different
exponents are independent of each other over the algebraic functions: every one of their coefficients is looked at.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from itertools import chain
from math import comb, log2, prod
from typing import TYPE_CHECKING

from flint import acb, arb, ctx

from symobs.exact.algebraic.real_algebraic import RealRoot
from symobs.exact.core.generators import INVERSES, KINDS, PI, function_named
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals import TooLarge
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.exact.core.generators import Function

Point = Mapping[str, Fraction]

#: The bits by which values are told apart, and more than which none is computed to be called 0.
_BITS_APART, _MOST_BITS = (128, 1024), 400_000
#: A power of cos x has so many exponentials at most.
_MOST_TERMS = 400


class Outside(ArithmeticError):
    """A point at which a value is not defined, or not real."""


def is_apart(left: Scalar, right: Scalar, point: Point) -> bool:
    """Return whether two values are different at a point for certain.

    Raises `Outside` where the one on the right is not real there or a denominator vanishes; roots on the left may be
    imaginary, as in cosh(√(−a) t).
    """
    for bits in _BITS_APART:
        with Precision(bits):
            there = _Enclosed(point)
            one, other = there.value(left), there.value(right, real=True)
            if not (one - other).contains(0):
                return True
    return False


class _Enclosed:
    """Enclosures of values at one point."""

    def __init__(self, point: Point) -> None:
        self.point = point
        self.known: dict[tuple[str, bool], acb] = {}

    def value(self, value: Scalar, *, real: bool = False) -> acb:
        """Return an enclosure; raises `Outside` without one, and if `real` where a root is not real."""
        names = {name: self._generator(name, real=real) for name in value.names}
        above, below = (_summed(part, names) for part in (value.numerator, value.denominator))
        if below.contains(0):
            raise Outside
        return above / below

    def _generator(self, name: str, *, real: bool) -> acb:
        if (name, real) not in self.known:
            self.known[name, real] = self._enclosed(name, real=real)
        return self.known[name, real]

    def _enclosed(self, name: str, *, real: bool) -> acb:
        found = function_named(name)
        if found is None:
            return acb(arb.pi()) if name == PI and PI not in self.point else _ball(self.point[name])
        if isinstance(found, RealRoot):
            return acb(found.number.ball(ctx.prec))
        if found.kind not in {*KINDS, *INVERSES, "sqrt"}:
            raise TooLarge(f"{found.kind} is not evaluated here")
        inside = self.value(found.argument, real=real)
        if found.kind == "sqrt" and real and not inside.real > 0:
            raise Outside
        if found.kind in INVERSES and not (found.kind == "atan" or _DOMAINS[found.kind](inside.real)):
            raise Outside
        return getattr(inside, found.kind)()  # type: ignore[no-any-return]  # the kernel calls them so, too


#: Where an inverse function is real.
_DOMAINS = {"log": lambda x: x > 0, "asin": lambda x: abs(x) < 1, "acos": lambda x: abs(x) < 1}


def _ball(number: Fraction) -> acb:
    return acb(number.numerator) / number.denominator


def _summed(polynomial: Scalar, names: Mapping[str, acb]) -> acb:
    total = acb(0)
    for coefficient, powers in polynomial.terms():
        total += prod((names[name] ** power for name, power in powers), start=acb(int(coefficient)))
    return total


# Algebraic numbers with what is known of their conjugates.


class _MoreBits(Exception):
    """An enclosure is too wide to say whether a number is 0."""

    def __init__(self, bits: int) -> None:
        super().__init__(bits)
        self.bits = bits


@dataclass
class _Number:
    """An algebraic number: an enclosure, and logarithms to base 2: `size` of a bound M ≥ 1 of all conjugates, `below` of c."""

    ball: acb
    size: float
    below: float


class _AtPoint:
    """The algebraic numbers that values are at one point, in the precision that is set."""

    def __init__(self, point: Point, conjugates: int) -> None:
        self.point = point
        self.conjugates = conjugates
        self.known: dict[str, _Number] = {}

    def is_zero(self, number: _Number) -> bool:
        """Return whether a number is 0; raises `_MoreBits` where the enclosure is too wide."""
        if not number.ball.contains(0):
            return False
        bits = int(self.conjugates * (number.size + number.below)) + 8
        if number.ball.abs_upper() < arb(2) ** -bits:
            return True
        raise _MoreBits(bits)

    def value(self, value: Scalar) -> _Number:
        """Return the number that a value is; raises `Outside` where its denominator is 0."""
        return self._quotient(self.polynomial(value.numerator), value.denominator)

    def polynomial(self, polynomial: Scalar) -> _Number:
        """Return the number that a polynomial is."""
        terms = [(int(coefficient), powers) for coefficient, powers in polynomial.terms()]
        highest: dict[str, int] = {}
        for name, power in chain.from_iterable(powers for _, powers in terms):
            highest[name] = max(power, highest.get(name, 0))
        parts = {name: self._generator(name) for name in highest}
        ball = _summed(polynomial, {name: part.ball for name, part in parts.items()})
        sizes = [log2(abs(c)) + sum(parts[name].size * power for name, power in powers) for c, powers in terms if c]
        below = sum(parts[name].below * power for name, power in highest.items())
        return _Number(ball, max(sizes, default=0.0) + log2(max(len(sizes), 1)), below)

    def _quotient(self, above: _Number, denominator: Scalar) -> _Number:
        if all(function_named(name) is None for name in denominator.names):
            number = denominator.substitute({n: Scalar.of(self.point[n]) for n in denominator.names}).fraction()
            if not number:
                raise Outside
            size = max(log2(number.denominator) - log2(abs(number.numerator)), 0.0)
            return _Number(above.ball / _ball(number), above.size + size, above.below + log2(abs(number.numerator)))
        below = self.polynomial(denominator)
        if self.is_zero(below):
            raise Outside
        norm = self.conjugates * (below.size + below.below)
        return _Number(above.ball / below.ball, above.size + norm, above.below + norm)

    def _generator(self, name: str) -> _Number:
        if name not in self.known:
            self.known[name] = self._found(name)
        return self.known[name]

    def _found(self, name: str) -> _Number:
        found = function_named(name)
        if found is None:
            number = self.point[name]
            return _Number(_ball(number), max(log2(abs(number)), 0.0) if number else 0.0, log2(number.denominator))
        if isinstance(found, RealRoot):
            coefficients = [abs(int(c)) for c in found.number.polynomial.coeffs()]
            size = log2(1 + max(coefficients) / coefficients[-1])
            return _Number(acb(found.number.ball(ctx.prec)), size, log2(coefficients[-1]))
        if found.kind != "sqrt":
            raise TooLarge(f"{found.kind} stands below a root")
        inside = self.value(found.argument)
        if self.is_zero(inside):
            raise Outside  # where a root branches nothing is said about what is near
        return _Number(inside.ball.sqrt(), inside.size / 2, inside.below)


# Sums of exponentials.


def vanishes_at(value: Scalar, point: Point) -> bool:
    """Return whether a value is 0 at a point of its letters, taking exponentials for independent of each other.

    π counts as one of the letters.  Raises `TooLarge` where that takes too many digits, `Outside` as `is_apart` does.
    """
    found = _functions_below(value)
    moving = sorted((f for f in found if f.kind in KINDS), key=lambda f: f.name)
    turns = any(f.kind in {"cos", "sin"} for f in moving)
    degrees = [f.number.degree if isinstance(f, RealRoot) else 2 for f in found if f not in moving]
    bits = _BITS_APART[0]
    while bits <= _MOST_BITS:
        with Precision(bits + 64):
            try:
                return _vanishes(value, moving, _AtPoint(point, prod(degrees) * (2 if turns else 1)))
            except _MoreBits as more:
                bits = max(more.bits, 2 * bits)
    raise TooLarge(f"more than {_MOST_BITS} bits would be needed to see whether a number is 0")


def _functions_below(value: Scalar) -> set[Function]:
    """Return the functions in a value, also inside others."""
    found: set[Function] = set()
    for name in value.names:
        if (function := function_named(name)) is not None:
            found |= {function} | _functions_below(function.argument)
    return found


#: Multiples of the arguments of exponentials, real and imaginary ones, that make up an exponent.
_Exponent = tuple[tuple[int, int], ...]
#: A coefficient, its real and its imaginary part.
_Pair = tuple[Scalar, Scalar]


def _vanishes(value: Scalar, moving: Sequence[Function], there: _AtPoint) -> bool:
    if not moving:
        there.value(value)  # or there is none
        return there.is_zero(there.polynomial(value.numerator))
    arguments = [there.value(f.argument) for f in moving]
    classes: list[tuple[_Number, _Pair]] = []
    for exponent, pair in _by_exponent(value.numerator, moving).items():
        number = _exponent_at(exponent, arguments)
        for place, (other, (real, imaginary)) in enumerate(classes):
            if there.is_zero(_Number(number.ball - other.ball, max(number.size, other.size) + 1, number.below)):
                classes[place] = (other, (real + pair[0], imaginary + pair[1]))
                break
        else:
            classes.append((number, pair))
    return all(there.is_zero(_complex_at(pair, there)) for _, pair in classes)


def _exponent_at(exponent: _Exponent, arguments: Sequence[_Number]) -> _Number:
    """Return the number that an exponent is; its multiples share one c."""
    parts = zip(exponent, arguments, strict=True)
    ball = sum((argument.ball * acb(*multiple) for multiple, argument in parts), acb(0))
    sizes = [argument.size + log2(1 + sum(map(abs, m))) for m, argument in zip(exponent, arguments, strict=True)]
    return _Number(ball, max(sizes) + log2(len(sizes)), sum(argument.below for argument in arguments))


def _complex_at(pair: _Pair, there: _AtPoint) -> _Number:
    real, imaginary = map(there.value, pair)
    ball = real.ball + imaginary.ball * acb(0, 1)
    return _Number(ball, max(real.size, imaginary.size) + 1, real.below + imaginary.below)


def _by_exponent(polynomial: Scalar, moving: Sequence[Function]) -> dict[_Exponent, _Pair]:
    """Return the coefficients of the exponentials that a polynomial in exponentials, cosines and sines consists of."""
    places: dict[str, int] = {f.name: place for place, f in enumerate(moving)}
    found: dict[_Exponent, _Pair] = {}
    for coefficient, powers in polynomial.terms():
        rest = Scalar.of(int(coefficient))
        sums: dict[_Exponent, _Pair] = {((0, 0),) * len(moving): (Scalar.of(1), Scalar.of(0))}
        for name, power in powers:
            if name not in places:
                rest = rest * Scalar.symbol(name) ** power
                continue
            sums = dict(_times_power(sums, moving[places[name]].kind, power, places[name]))
            if len(sums) > _MOST_TERMS:
                raise TooLarge(f"{name}**{power} has too many terms")
        for exponent, (real, imaginary) in sums.items():
            before = found.get(exponent, (Scalar.of(0), Scalar.of(0)))
            found[exponent] = before[0] + rest * real, before[1] + rest * imaginary
    return found


def _times_power(
    sums: Mapping[_Exponent, _Pair], kind: str, power: int, place: int
) -> Iterator[tuple[_Exponent, _Pair]]:
    """Yield the terms of a sum of exponentials times a power of exp, cosh, sinh, cos or sin of the argument at a place."""
    for exponent, (real, imaginary) in sums.items():
        for k in range(1 if kind == "exp" else power + 1):
            steps = power - 2 * k
            before = exponent[place]
            moved = (before[0], before[1] + steps) if kind in {"cos", "sin"} else (before[0] + steps, before[1])
            factor = Scalar.of(1 if kind == "exp" else Fraction(comb(power, k), 2**power))
            if kind in {"sinh", "sin"} and k % 2:
                factor = -factor
            pair = real * factor, imaginary * factor
            for _ in range(power if kind == "sin" else 0):  # sin x = -i (e^ix - e^-ix)/2
                pair = pair[1], -pair[0]
            yield (*exponent[:place], moved, *exponent[place + 1 :]), pair
