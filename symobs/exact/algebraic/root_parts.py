"""Sums over roots mode by mode: Σ c e^{λt} over real roots, 2 e^{σt} (a cos ωt − b sin ωt) over pairs (trusted).

For numbers alone, with c = λᵖ/q′(λ).  The numbers σ, ω, a, b have no name but their decimals; they are known by
enclosures of any precision.
"""

from __future__ import annotations

from functools import lru_cache
from math import prod
from typing import TYPE_CHECKING, Any

from flint import acb, acb_poly, arb, ctx, fmpq, fmpq_mat, fmpq_poly

from symobs.exact.algebraic.root_sum import RootSum, roots_and_slopes
from symobs.exact.core.field import EIGENVALUE
from symobs.exact.core.generators import Function, function, function_named
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_ZERO, _LAMBDA = Scalar.of(0), Scalar.symbol(EIGENVALUE)
#: Bits by which the roots are told apart, and their parts from 0.
_BITS = 512


@dataclass
class RootPart(Function):
    """±Re or ±Im of λ, or of λᵖ/q′(λ), for one root λ of q with Im λ ≥ 0; printed with so many digits, never negative."""

    polynomial: Scalar
    index: int
    #: p, or None for λ itself.
    power: int | None
    is_imaginary: bool
    is_negative: bool
    digits: int

    @property
    def text(self) -> str:
        """The name of the generator."""
        part, sign = "im" if self.is_imaginary else "re", "-" if self.is_negative else ""
        return f"RootPart({sign}{part}, {self.power}, {self.index}, {self.polynomial}, {self.digits})"

    @property
    def symbols(self) -> frozenset[str]:
        """None: it is a number."""
        return frozenset()

    def rate(self, time: str) -> Scalar:  # noqa: ARG002 - it does not move
        """Return 0."""
        return _ZERO

    def moved(self, values: Mapping[str, Scalar]) -> Scalar:  # noqa: ARG002 - it has no symbols
        """Return the number itself."""
        return self.value

    def enclosed(self) -> arb:
        """Return an enclosure at the precision of the kernel."""
        found = _part(self.polynomial, self.index, self.power, is_imaginary=self.is_imaginary, bits=ctx.prec)
        return -found if self.is_negative else found


def in_modes(value: Scalar, digits: int) -> Scalar | None:
    """Return a value with its sums over roots mode by mode; None where one has letters, or a part that may be 0."""
    sums = {name: f for name in value.names if isinstance(f := function_named(name), RootSum)}
    if not sums or not all(f.is_rational for f in sums.values()):
        return None
    found = {name: _of_sum(f, digits) for name, f in sums.items()}
    known = {name: modes for name, modes in found.items() if modes is not None}
    return _without_zeros(value.substitute(known)) if len(known) == len(found) else None


def vanishes(value: Scalar) -> bool:
    """Return whether a value mode by mode is seen to be 0: the coefficient of each function is."""
    return _without_zeros(value).is_zero


def _without_zeros(value: Scalar) -> Scalar:
    """Return the value without the functions whose coefficient, a sum of parts of one root, is seen to be 0."""
    coefficients: dict[tuple[tuple[str, int], ...], list[tuple[int, str | None]]] = {}
    for number, powers in value.numerator.terms():
        parts = [(name, power) for name, power in powers if isinstance(function_named(name), RootPart)]
        rest = tuple(pair for pair in powers if pair not in parts)
        name = parts[0][0] if parts and sum(power for _, power in parts) == 1 else None
        coefficients.setdefault(rest, []).append((number, name))
    total = value.numerator
    for rest, terms in coefficients.items():
        if _is_zero_sum(terms):
            monomial = prod((Scalar.symbol(name) ** power for name, power in rest), start=Scalar.of(1))
            for number, name in terms:
                total = total - number * Scalar.symbol(name or "") * monomial
    return total / value.denominator


def _is_zero_sum(terms: Sequence[tuple[int, str | None]]) -> bool:
    """Return whether a combination of parts of one root is seen to be 0."""
    found = [(number, function_named(name) if name is not None else None) for number, name in terms]
    parts = [(-number if part.is_negative else number, part) for number, part in found if isinstance(part, RootPart)]
    kinds = {(part.polynomial, part.index, part.is_imaginary, part.power is None) for _, part in parts}
    if len(parts) < len(terms) or len(kinds) != 1 or parts[0][1].power is None:
        return False
    above = sum((number * _LAMBDA ** (part.power or 0) for number, part in parts), _ZERO)
    one = parts[0][1]
    return _is_zero(one.polynomial, one.index, above, is_imaginary=one.is_imaginary)


def _of_sum(found: RootSum, digits: int) -> Scalar | None:
    """Return one sum mode by mode."""
    total, time = _ZERO, found.argument
    for index, (root, _) in enumerate(_upper_roots(found.polynomial, _BITS)):
        parts = [_number(found.polynomial, index, None, digits, is_imaginary=False)]
        parts += [_number(found.polynomial, index, found.power, digits, is_imaginary=part) for part in (False, True)]
        if root.imag.is_zero():
            parts[2] = _ZERO
        fading, real, turned = parts
        if fading is None or real is None or turned is None:
            return None
        if root.imag.is_zero():
            total = total + real * function("exp", fading * time)
            continue
        speed = _number(found.polynomial, index, None, digits, is_imaginary=True)
        if speed is None:
            return None
        waves = real * function("cos", speed * time) - turned * function("sin", speed * time)
        total = total + 2 * function("exp", fading * time) * waves
    return total


def _number(q: Scalar, index: int, power: int | None, digits: int, *, is_imaginary: bool) -> Scalar | None:
    """Return a part as a number with its sign; None where it cannot be told from 0 and is not seen to be 0."""
    ball = _part(q, index, power, is_imaginary=is_imaginary, bits=_BITS)
    if ball > 0 or ball < 0:
        part = RootPart("RootPart", _ZERO, q, index, power, is_imaginary, bool(ball < 0), digits)
        return -part.value if part.is_negative else part.value
    above = None if power is None else _LAMBDA**power
    return _ZERO if _is_zero(q, index, above, is_imaginary=is_imaginary) else None


def _is_zero(q: Scalar, index: int, above: Scalar | None, *, is_imaginary: bool) -> bool:
    """Return whether a part of λ, or of c = g(λ)/q′(λ) with g `above`, is seen to be 0.

    c is a root of the minimal polynomial r of multiplication by g(λ)/q′(λ) modulo q, whose roots lie in disjoint enclosures,
    those of real ones without an imaginary part.  gcd(r(x), r(−x)) has with c also −c̄ among its roots: where the mirror image
    of the enclosure of c meets no other one, −c̄ is c.
    """
    coefficients = _polynomial(q)
    order = coefficients.degree()
    companion = fmpq_mat(order, order, [int(j == i + 1) for i in range(order) for j in range(order)])
    for j in range(order):
        companion[order - 1, j] = -coefficients[j] / coefficients[order]
    moved, (c, slope) = companion, _upper_roots(q, _BITS)[index]
    if above is not None:
        top = _polynomial(above)
        moved = _at(top, companion) * _at(coefficients.derivative(), companion).inv()
        with Precision(_BITS):
            c = acb_poly(top)(c) / slope
    r: Any = moved.minpoly()
    with Precision(_BITS):
        places = [place for place, _ in r.complex_roots()]
        mirrored = [place for place, _ in r.gcd(r(fmpq_poly([0, -1]))).complex_roots()]

    def at(place: Any) -> list[Any]:
        return [each for each in places if each.overlaps(place)]

    own = at(c)
    if len(own) != 1:
        return False
    if is_imaginary:
        return bool(own[0].imag.is_zero())
    is_mirrored = any(at(place) == own for place in mirrored if place.overlaps(own[0]))
    return is_mirrored and at(acb(-own[0].real, own[0].imag)) == own


def _polynomial(value: Scalar) -> Any:
    """Return a polynomial in λ as the kernel has it."""
    numbers = [c.fraction() for c in reversed(value.coefficients(EIGENVALUE))]
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in numbers])


def _at(polynomial: Any, matrix: Any) -> Any:
    return sum((matrix**k * polynomial[k] for k in range(polynomial.degree() + 1)), matrix * 0)


def _part(q: Scalar, index: int, power: int | None, *, is_imaginary: bool, bits: int) -> arb:
    root, slope = _upper_roots(q, bits)[index]
    found = root if power is None else root**power / slope
    return found.imag if is_imaginary else found.real


@lru_cache(maxsize=64)
def _upper_roots(q: Scalar, bits: int) -> list[tuple[acb, acb]]:
    """Return enclosures of the roots with Im λ ≥ 0 and of the slopes there, in one order at every precision.

    At a higher precision than that of the order a root is the one whose enclosure overlaps, which is one alone.
    """
    bits = max(bits, _BITS)
    coefficients = tuple(c.fraction() for c in reversed(q.coefficients(EIGENVALUE)))
    found = [pair for pair in roots_and_slopes(coefficients, bits) if not pair[0].imag < 0]
    if bits == _BITS:
        return sorted(found, key=lambda pair: (-float(pair[0].real.mid()), float(pair[0].imag.mid())))
    ordered = [[pair for pair in found if pair[0].overlaps(root)] for root, _ in _upper_roots(q, _BITS)]
    return [pair for (pair,) in ordered]
