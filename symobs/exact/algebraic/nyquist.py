"""Where the frequency response N/P of a loop of numbers meets the real axis and the unit circle, and how it surrounds −1.

The curve is closed to the right around poles on the boundary of stability.  Then the argument principle has N = P − Z: the
encirclements of −1 counterclockwise are the unstable poles of the open loop less those of the closed loop.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import acb, arb

from symobs.exact.algebraic.loop_distances import INFINITE, certain
from symobs.exact.algebraic.real_algebraic import RealNumber, roots_of_scalar
from symobs.exact.algebraic.root_location import count_roots_by_half_plane
from symobs.exact.algebraic.root_loci import (
    LOCUS_DIGITS,
    coprime,
    frequency,
    gain_on_boundary,
    omega_digits,
    omega_of,
    on_boundary,
    whole,
)
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from fractions import Fraction


def unstable_roots(polynomial: Scalar, variable: str) -> tuple[int, int]:
    """Return how many roots are unstable and how many stand on the boundary, in discrete time after z = (w + 1)/(w − 1)."""
    coefficients = [c.fraction() for c in polynomial.coefficients(variable)]
    if variable == "s":
        _, on, right = count_roots_by_half_plane(coefficients)
        return right, on
    w, order, image = Scalar.symbol("w"), len(coefficients) - 1, Scalar.of(0)
    for k, c in enumerate(coefficients):
        image += Scalar.of(c) * (w + 1) ** (order - k) * (w - 1) ** k
    moved: list[Fraction] = [c.fraction() for c in image.coefficients("w")]
    _, on, right = count_roots_by_half_plane(moved)
    return right, on + order - (len(moved) - 1)  # roots 1 have gone to infinity


def nyquist(closed: Scalar, opened: Scalar, variable: str) -> dict[str, Any]:
    """Return the counts, the crossings of the real axis and of the unit circle, and the delay margin, by field."""
    before, after = unstable_roots(opened, variable), unstable_roots(closed, variable)
    found: dict[str, Any] = {"open_loop_unstable": before[0], "closed_loop_unstable": after[0]}
    found["encirclements"] = None if after[1] else before[0] - after[0]
    N, P = closed - opened, opened
    if N.is_zero:
        nothing: dict[str, Any] = {"axis_crossings": [], "gain_crossover": [], "phase_crossover": []}
        return {**found, **nothing, "delay_margin": INFINITE}
    P, N = coprime(P, N)
    discrete = variable == "z"
    im, re, below = on_boundary(N, P, variable)
    places = _on_range(im, discrete=discrete, ends=True)
    real = [(x, value) for x in places if (value := gain_on_boundary(x, -re, below)) is not None]
    found["axis_crossings"] = [{"omega": omega_of(x, discrete=discrete), "value": _text(v)} for x, v in real]
    found["phase_crossover"] = [omega_of(x, discrete=discrete) for x, v in real if v.sign < 0]
    level = on_boundary(N, N, variable)[2] - below
    crossed = _on_range(level, discrete=discrete, ends=False) if not level.is_zero else []
    found["gain_crossover"] = [omega_of(x, discrete=discrete) for x in crossed]
    found["delay_margin"] = _delay(crossed, N, P, variable)
    return found


def told_of(kind: str, closed: Scalar, opened: Scalar, variable: str) -> list[dict[str, str]]:
    """Return what a sentence tells of the counts, of each crossing of the axis or the circle, or of the delay margin."""
    found, discrete = nyquist(closed, opened, variable), variable == "z"
    if kind == "counts":
        names = {"before": "open_loop_unstable", "after": "closed_loop_unstable", "around": "encirclements"}
        return [
            {name: str(found[field]).replace("-", "−") for name, field in names.items() if found[field] is not None}
        ]
    if kind == "delay":
        delay = found["delay_margin"]
        return [] if delay is None else [{} if delay == INFINITE else {"delay": delay}]
    P, N = coprime(opened, closed - opened)
    im, re, below = on_boundary(N, P, variable)
    if kind == "level":
        level = on_boundary(N, N, variable)[2] - below
        crossed = _on_range(level, discrete=discrete, ends=False) if not level.is_zero else []
        return [{"omega": omega_digits(x, discrete=discrete)} for x in crossed]
    real = [(x, gain_on_boundary(x, -re, below)) for x in _on_range(im, discrete=discrete, ends=True)]
    return [
        {"omega": omega_digits(x, discrete=discrete), "value": value.decimal(LOCUS_DIGITS)}
        for x, value in real
        if value is not None
    ]


def _text(value: RealNumber) -> Any:
    closed = value.closed_form()
    return closed if closed is not None else value.text()


def _on_range(polynomial: Scalar, *, discrete: bool, ends: bool) -> list[RealNumber]:
    """Return the roots x in the range, that is ω² > 0 or −1 < cos θ < 1, and its finite ends; by rising frequency."""
    low, high = (RealNumber.of(-1), RealNumber.of(1)) if discrete else (RealNumber.of(0), None)
    found = roots_of_scalar(polynomial, "x") if "x" in polynomial.names else []
    inside = {x for x in found if low < x and (high is None or x < high)}
    if ends:
        inside |= {low} if high is None else {low, high}
    return sorted(inside, reverse=discrete)


def _delay(crossed: list[RealNumber], N: Scalar, P: Scalar, variable: str) -> str | None:
    """Return the least φ/ω over the crossovers, φ in (0, 2π) the angle by which N/P can lag until it meets −1."""
    if not crossed:
        return INFINITE

    def least(bits: int) -> arb:
        values = []
        for x in crossed:
            with Precision(bits):
                omega = x.ball(bits).acos() if variable == "z" else frequency(x).ball(bits)
                point = acb(x.ball(bits), omega.sin()) if variable == "z" else acb(0, omega)
                value = -_at(N, point, variable) / _at(P, point, variable)
                angle = value.arg()
                angle = angle + 2 * arb.pi() if angle < 0 else angle
            values.append(angle / omega)
        smallest = values[0]
        for each in values[1:]:
            smallest = smallest.min(each)
        return smallest

    return certain(least, LOCUS_DIGITS)


def _at(polynomial: Scalar, point: acb, variable: str) -> acb:
    value, scale = acb(0), polynomial.numerator.coefficients(variable)[0] / polynomial.coefficients(variable)[0]
    for coefficient in reversed(whole(polynomial, variable).coeffs()):
        value = value * point + int(coefficient)
    number = scale.fraction()
    return value * number.denominator / number.numerator
