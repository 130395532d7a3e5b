"""Real zeros of a function of one name: intervals that hold one each, and whether there are others, by ball arithmetic.

A ball where the function is not 0 is left out; one where its slope is not 0 holds a zero where the signs at its ends differ,
and one alone; any other is halved.  Far out the function is looked at in 1/x.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING

from flint import arb

from symobs.exact.core.generators import PI, NotWritten, derivative, function_named
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.exact.core.generators import Function

#: The bits of balls; intervals are narrowed to this part of one, and no more than so many are looked at.
_BITS, _NARROW, _MOST = 256, Fraction(1, 1 << 60), 4_000
#: Beyond this the function is looked at in 1/x.
_FAR = Fraction(1 << 40)
#: Where an interval is cut, off its middle: zeros at round numbers are to lie inside.
_PART = Fraction(253, 512)
#: What is narrower than this and still open is given up.
_LEAST = Fraction(1, 1 << 40)

Interval = tuple[Fraction, Fraction]


def value_on(value: Scalar, name: str, interval: Interval) -> arb | None:
    """Return an enclosure of the values of a function on an interval, None where there is none."""
    try:
        with Precision(_BITS):
            found = _Balls(name, interval).value(value)
    except (NotWritten, ZeroDivisionError):
        return None
    return found if found.is_finite() else None


def sign_on(value: Scalar, name: str, interval: Interval) -> int:
    """Return 1 or −1 where a function has this sign on a whole interval, else 0."""
    found = value_on(value, name, interval)
    return 0 if found is None else (found > 0) - (found < 0)


def digits_on(value: Scalar, name: str, interval: Interval, digits: int) -> str:
    """Return so many digits of a function on an interval as are certain, at most `digits`; empty where none are."""
    found = value_on(value, name, interval)
    if found is None:
        return ""
    text = str(found.str(digits, radius=False))
    return "" if "nan" in text or "+/-" in text else text


def isolated(value: Scalar, name: str, low: Fraction | None, high: Fraction | None) -> tuple[list[Interval], bool]:
    """Return narrow intervals that hold one simple zero each between two ends, and whether these are all zeros there.

    Without an end the function is looked at as far as 2⁴⁰, and beyond that in 1/x.
    """
    is_complete = all(end is not None or not _vanishes_far(value, name, side) for end, side in ((low, -1), (high, 1)))
    slope = derivative(value, name)
    found: list[Interval] = []
    begin, stop = (-_FAR if low is None else low), (_FAR if high is None else high)
    waiting, seen = (
        sorted(_parts(begin, stop), key=lambda each: -abs(each[0] + each[1])),
        0,
    )  # the innermost are taken first
    while waiting:
        seen += 1
        interval = waiting.pop()
        if seen > _MOST:
            return sorted(found), False
        if sign_on(value, name, interval):
            continue
        if sign_on(slope, name, interval):
            signs = [sign_on(value, name, (end, end)) for end in interval]
            if 0 in signs:
                is_complete = False
            elif signs[0] != signs[1]:
                found.append(_narrowed(value, name, interval, signs[0]))
            continue
        middle = interval[0] + (interval[1] - interval[0]) * _PART
        if interval[1] - interval[0] < _LEAST * max(Fraction(1), abs(middle)):
            is_complete = False
            continue
        waiting += [(interval[0], middle), (middle, interval[1])]
    return sorted(found), is_complete


def _parts(low: Fraction, high: Fraction) -> Iterator[Interval]:
    """Yield intervals at odd places, so that zeros at round numbers do not lie at their ends; from 0 on they double."""
    ends = [low, *(s * Fraction(2) ** k * Fraction(513, 512) for s in (-1, 1) for k in range(-8, 41)), high]
    inside = sorted({end for end in ends if low <= end <= high})
    yield from pairwise(inside)


def _narrowed(value: Scalar, name: str, interval: Interval, sign: int) -> Interval:
    """Return a narrow interval inside of one over whose ends the sign changes once."""
    low, high = interval
    while high - low > _NARROW * max(Fraction(1), abs(low)):
        middle = low + (high - low) * _PART
        found = sign_on(value, name, (middle, middle))
        if not found:
            break
        low, high = (middle, high) if found == sign else (low, middle)
    return low, high


def _vanishes_far(value: Scalar, name: str, side: int) -> bool:
    """Return whether a function may vanish beyond the largest number that is looked at, on one side."""
    turned = value.numerator.substitute({name: Scalar.of(side) / Scalar.symbol(name)}).numerator
    ends = (Fraction(0), 1 / _FAR)
    return not sign_on(turned, name, ends)


class _Balls:
    """Enclosures of functions of one name on an interval; on which side of 0 that lies."""

    def __init__(self, name: str, interval: Interval) -> None:
        low, high = interval
        middle, radius = (low + high) / 2, (high - low) / 2
        ball = arb(middle.numerator) / middle.denominator
        if radius:
            ball += (arb(radius.numerator) / radius.denominator) * arb(0, 1)
        self.known = {name: ball}
        self.ends = interval
        self.name, self.side = name, 1 if low >= 0 else -1 if high <= 0 else 0

    def value(self, value: Scalar) -> arb:
        """Return an enclosure of a value, which may not be finite; raises `NotWritten` for what has none."""
        return self._polynomial(value.numerator) / self._polynomial(value.denominator)

    def _polynomial(self, value: Scalar) -> arb:
        total = arb(0)
        for coefficient, powers in value.terms():
            term = arb(coefficient)
            for name, power in powers:
                if name not in self.known:
                    self.known[name] = self._generator(name)
                for _ in range(power):  # arb's own power is none of a ball around 0
                    term = term * self.known[name]
            total = total + term
        return total

    def _generator(self, name: str) -> arb:
        found = function_named(name)
        if found is None:
            if name != PI:
                raise NotWritten(name)
            return arb.pi()
        inside = self.value(found.argument)
        if not inside.is_finite():
            return self._at_infinity(found)
        if not hasattr(inside, found.kind):
            raise NotWritten(found.kind)
        enclosed: arb = getattr(inside, found.kind)()
        return enclosed

    def _at_infinity(self, found: Function) -> arb:
        """Return an enclosure where the argument is of any size: waves lie between ±1, and e⁻ᵃ between 0 and 1 for a > 0."""
        if found.kind in {"cos", "sin"}:
            return arb(0, 1)
        if found.kind == "exp" and self._sign(found.argument.numerator) * self._sign(found.argument.denominator) < 0:
            return arb(0).union(self._largest(found))
        raise NotWritten(found.kind)

    def _largest(self, found: Function) -> arb:
        """Return a bound of e⁻ᵃ: its value at the end off 0 where a = c/xᵏ falls, else 1."""
        above, below = found.argument.numerator, found.argument.denominator
        end = self.ends[1] if self.side > 0 else self.ends[0]
        if above.is_constant and len([*below.terms()]) == 1 and below.names == {self.name} and end:
            return _Balls(self.name, (end, end)).value(found.argument).exp()
        return arb(1)

    def _sign(self, value: Scalar) -> int:
        """Return the sign of a polynomial inside of the interval, 0 where it is not seen; of one term by that of the name."""
        ball = self._polynomial(value)
        if ball > 0 or ball < 0:
            return 1 if ball > 0 else -1
        terms = [*value.terms()]
        if len(terms) != 1 or any(name != self.name for name, _ in terms[0][1]):
            return 0
        coefficient, powers = terms[0]
        sign = 1 if coefficient > 0 else -1
        for _, power in powers:
            sign *= self.side**power
        return sign
