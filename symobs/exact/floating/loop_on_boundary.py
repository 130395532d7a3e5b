"""A loop N/P on the boundary of stability, over the frequency: magnitude, phase and locus in ball arithmetic, rounded."""

from __future__ import annotations

from math import ceil, floor, log10, pi
from typing import TYPE_CHECKING, Any, NamedTuple

from flint import acb, arb, fmpz_poly

from symobs.exact.algebraic.root_location import integers
from symobs.exact.core.ring import Precision

if TYPE_CHECKING:
    from fractions import Fraction

_BITS = 128


class LoopCurves(NamedTuple):
    """The ends of the frequencies; dB, degrees and the plane at each, in whole parts, None where a value is not known."""

    frequencies: tuple[float, float]
    magnitude: list[int | None]
    phase: list[int | None]
    locus: list[list[int | None]]


def loop_on_boundary(
    above: list[Fraction], below: list[Fraction], points: int, parts: int, *, discrete: bool
) -> LoopCurves:
    """Return N/P at s = iω, or z = e^{iθ}, from the coefficients of P + N and P.

    The phase is a sum over zeros and poles, so that it has no jumps.
    """
    whole = integers([*above, *below])
    closed, opened = (fmpz_poly(part[::-1]) for part in (whole[: len(above)], whole[len(above) :]))
    moved = closed - opened
    with Precision(_BITS):
        zeros, poles, roots = (_roots(polynomial) for polynomial in (moved, opened, closed))
        factors = [*zeros, *((root, -power) for root, power in poles)]
        gain = (acb(moved[moved.degree()]) / acb(opened[opened.degree()])).log()
        low, high = _frequencies([root for root, _ in [*factors, *roots]], discrete=discrete)
        values = []
        for k in range(points + 1):
            turned = acb(0, arb(min(high, low * (high / low) ** (k / points))))
            terms = (power * _logarithm(turned, root, discrete=discrete) for root, power in factors)
            logarithm = gain + sum(terms, acb(0))
            values.append((logarithm, logarithm.exp()))
        return LoopCurves(
            (low, high),
            [_whole(20 * logarithm.real / arb(10).log(), parts) for logarithm, _ in values],
            [_whole(180 * logarithm.imag / arb.pi(), parts) for logarithm, _ in values],
            [[_whole(value.real, parts), _whole(value.imag, parts)] for _, value in values],
        )


def _roots(polynomial: fmpz_poly) -> list[tuple[acb, int]]:
    found: Any = polynomial.complex_roots()
    return list(found)


def _frequencies(roots: list[Any], *, discrete: bool) -> tuple[float, float]:
    """Return decades around the moduli of the roots; in discrete time angles up to π."""
    sizes = [size for root in roots if (size := float(abs(root - 1 if discrete else root).mid())) > 1e-9] or [1.0]
    low = 10.0 ** floor(log10(min(sizes) / 3))
    return (min(low, 0.1), pi) if discrete else (low, 10.0 ** ceil(log10(max(sizes) * 3)))


def _logarithm(turned: acb, root: acb, *, discrete: bool) -> acb:
    """Return log(s − r) on a branch that is continuous along the boundary, `turned` is log s in discrete time, else s."""
    if discrete:
        s = turned.exp()
        return turned + (1 - root / s).log() if bool(abs(root) <= 1) else (-root).log() + (1 - s / root).log()
    return (root - turned).log() + acb(0, arb.pi()) if bool(root.real > 0) else (turned - root).log()


def _whole(value: arb, parts: int) -> int | None:
    """Return a number in parts; None where it is not finite or not known so well."""
    return round(float(value.mid()) * parts) if value.is_finite() and float(value.rad()) < 1 / parts else None
