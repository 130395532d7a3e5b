"""Certified enclosures, and signs, of numbers built from roots, exponentials, cosines, sines and π (trusted)."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from flint import arb, ctx

from symobs.exact.algebraic.real_algebraic import RealRoot
from symobs.exact.algebraic.root_parts import RootPart
from symobs.exact.algebraic.root_sum import RootSum
from symobs.exact.core.generators import PI, function_named, symbols_in
from symobs.exact.core.ring import Precision

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact.core.scalar import Scalar

#: Bits that are tried in turn until an enclosure keeps clear of 0.
_BITS = (64, 256, 1024, 4096)
_KINDS = {"sqrt", "exp", "cos", "sin", "cosh", "sinh", "log", "asin", "acos", "atan", "CRootOf", "RootPart"}


def is_number(value: Scalar) -> bool:
    """Return whether a value has no parameter: only rational numbers, π, roots, and functions of them."""
    if not value.names:
        return True
    found = [f for name in value.names if (f := function_named(name)) is not None]
    is_written = all(f.kind in _KINDS or (isinstance(f, RootSum) and f.is_rational) for f in found)
    return is_written and symbols_in(value) <= {PI}


def sign_of_number(value: Scalar) -> str:
    """Return `positive` or `negative`, or `real` if the value has parameters or may be 0."""
    if not is_number(value):
        return "real"
    for bits in _BITS:
        found = _enclosed(value, bits)
        if found > 0:
            return "positive"
        if found < 0:
            return "negative"
    return "real"


def decimal(value: Scalar) -> float:
    """Return a floating-point approximation, for heuristics and warnings only."""
    return float(_enclosed(value, _BITS[0]).mid())


def near(value: Scalar, bits: int = 40) -> Fraction | None:
    """Return a rational approximation with error below 2^-bits, None if no enclosure is that narrow."""
    if not is_number(value):
        return None
    for precision in _BITS:
        found = _enclosed(value, precision)
        if found.rad() < arb(2) ** -bits:
            middle = found.mid().fmpq()
            return Fraction(int(middle.p), int(middle.q))
    return None


def _enclosed(value: Scalar, bits: int) -> arb:
    """Return an interval that holds the number."""
    with Precision(bits):
        return _ball(value)


def _ball(value: Scalar) -> arb:
    if value.is_constant:
        number = value.fraction()
        return arb(number.numerator) / number.denominator
    names = {name: _generator(name) for name in value.names}
    above, below = (polynomial_ball(part, names) for part in (value.numerator, value.denominator))
    return above / below


def polynomial_ball(value: Scalar, names: Mapping[str, arb]) -> arb:
    """Return an enclosure of a polynomial, given those of its names; a number has its own."""
    total = arb(0)
    for coefficient, powers in value.terms():
        term = arb(coefficient)
        for name, power in powers:
            term = term * (names[name] if name in names else _generator(name)) ** power
        total = total + term
    return total


def _generator(name: str) -> arb:
    found = function_named(name)
    if found is None:
        return arb.pi()
    if isinstance(found, RealRoot):
        return found.number.ball(ctx.prec)
    if isinstance(found, RootPart):
        return found.enclosed()
    if isinstance(found, RootSum):
        return _sum_over_roots(found, ctx.prec)
    enclosed: arb = getattr(_ball(found.argument), found.kind)()  # the kernel calls them so, too
    return enclosed


@lru_cache(maxsize=1024)
def _sum_over_roots(found: RootSum, bits: int) -> arb:  # noqa: ARG001 - the precision, by which it is kept
    return found.enclosed(_ball(found.argument))
