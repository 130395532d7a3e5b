"""How far the loop of a design is from instability: ends of the gain exactly, phase, distance and peak with certain digits.

For K the loop is K(sI − A)⁻¹B, for L it is C(sI − A)⁻¹L, for a compensator F(s)G(s); P is its denominator without any
cancelling, P + N the characteristic polynomial of the closed loop, and k the gain that it is multiplied by.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypedDict

from symobs.exact import RealNumber, Scalar
from symobs.exact.algebraic.loop_distances import INFINITE, MARGIN_DIGITS, Loop, slowest_root
from symobs.tasks.analysis.stability_region.stability_region import stability_region

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction


#: The margins, as they are called.
Margin: TypeAlias = Literal["gain_down", "gain_up", "phase_deg", "modulus", "peak", "slowest"]
MARGINS: tuple[Margin, ...] = ("gain_down", "gain_up", "phase_deg", "modulus", "peak", "slowest")


class MarginNumbers(TypedDict):
    """Exact numbers, certain decimals as texts, `oo`; None of a loop that is not stable, whose slowest root may be known."""

    gain_down: RealNumber | Scalar | str | None
    gain_up: RealNumber | Scalar | str | None
    phase_deg: str | None
    modulus: str | None
    peak: str | None
    slowest: RealNumber | None


NO_MARGINS: MarginNumbers = {
    "gain_down": None,
    "gain_up": None,
    "phase_deg": None,
    "modulus": None,
    "peak": None,
    "slowest": None,
}


class NotRational(ValueError):
    """Raised for a loop with other than rational numbers."""


def margins_of(closed: Scalar, opened: Scalar, variable: str, dt: object) -> MarginNumbers:
    """Return the margins of the loop with the polynomials P + N and P; the slowest root alone where it is not stable.

    Raises `NotRational`.
    """
    discrete = variable == "z"
    above, below = (numbers(polynomial, variable) for polynomial in (closed, opened))
    slowest = slowest_root(above, discrete=discrete)
    if not slowest < RealNumber.of(int(discrete)):
        return {**NO_MARGINS, "slowest": slowest}
    loop = Loop.of(above, below, discrete=discrete)
    low, high = gains_of(above, below, dt)
    return {
        "gain_down": low,
        "gain_up": high,
        "phase_deg": loop.phase(MARGIN_DIGITS),
        "modulus": loop.modulus(MARGIN_DIGITS),
        "peak": loop.peak(MARGIN_DIGITS),
        "slowest": slowest,
    }


def numbers(polynomial: Scalar, variable: str) -> Sequence[Fraction]:
    """Return the coefficients of a polynomial; raises `NotRational`."""
    found = polynomial.coefficients(variable)
    if not all(entry.is_constant for entry in found):
        raise NotRational(str(polynomial))
    return [entry.fraction() for entry in found]


def gains_of(
    closed: Sequence[Fraction], opened: Sequence[Fraction], dt: object
) -> tuple[RealNumber | str, RealNumber | str]:
    """Return the ends of the interval around 1 of the gains k > 0 for which P + kN is stable; P + N and P by coefficients."""
    if closed == opened:
        return RealNumber.of(0), INFINITE
    variable, k, moved = Scalar.symbol("z" if dt else "s"), Scalar.symbol("k"), Scalar.of(0)
    for whole, part in zip(closed, opened, strict=True):
        moved = moved * variable + Scalar.of(part) + k * Scalar.of(whole - part)
    region: Any = stability_region(moved, symbols={"k": "positive"}, dt=dt, parameters="k")
    one = RealNumber.of(1)
    for piece in region.region.intervals:
        low, high = piece.low or RealNumber.of(0), piece.high
        if low < one and (high is None or one < high):
            return low, INFINITE if high is None else high
    raise AssertionError(region.stable_if)
