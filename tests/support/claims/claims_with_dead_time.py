"""What is claimed of a loop with a dead time: roots counted by the phase of P + k N e^{−sT} along a fine grid of doubles."""

from __future__ import annotations

import cmath
import itertools
import math
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.algebra import coefficients_at

if TYPE_CHECKING:
    from tests.support.algebra import Polynomial
    from tests.support.claims.claims import Setting

_NODES = 40_000


def region_holds(result: Any, at: Setting) -> None:
    """Hold the gains inside of the intervals to have no unstable root, and those just outside to have some."""
    P, N, delay = _loop(result, at)
    assert all(are_ends(P, N, delay, float(low), float(high)) for low, high in result.fields["intervals_decimal"])


def are_ends(P: Polynomial, N: Polynomial, delay: float, low: float, high: float) -> bool:
    """Whether the gains between two ends have no unstable root, and those just outside have some; below 0 nothing is asked."""
    width = high - low
    inside = not any(unstable(P, N, delay, low + part * width) for part in (0.02, 0.5, 0.98))
    is_end = low == 0 or unstable(P, N, delay, low - 0.02 * width) > 0
    return inside and is_end and unstable(P, N, delay, high + 0.02 * width) > 0


def margins_hold(result: Any, at: Setting) -> None:
    """Hold the counts, the gains around 1, the distance from −1 and the phase to the grid."""
    P, N, delay = _loop(result, at)
    assert result.fields["closed_loop_unstable"] == unstable(P, N, delay, 1)
    if result.verdict != "yes":
        return
    low, high = (float(str(result.fields[name])) for name in ("gain_down", "gain_up"))
    assert not unstable(P, N, delay, low + 0.02)
    assert not unstable(P, N, delay, 0.98 * high)
    assert unstable(P, N, delay, 1.02 * high)
    grid = [1j * 1.01**k for k in range(-1000, 1000)]
    loop = [_at(N, s) / _at(P, s) * cmath.exp(-s * delay) for s in grid]
    distance = min(abs(1 + value) for value in loop)
    assert float(result.fields["modulus"]) <= distance + 1e-6
    assert distance - float(result.fields["modulus"]) < 1e-3
    crossed = [value for value, after in itertools.pairwise(loop) if (abs(value) > 1) != (abs(after) > 1)]
    if crossed:
        least = min(abs(math.degrees(cmath.phase(-value))) for value in crossed)
        assert abs(least - float(result.fields["phase_deg"])) < 2


def unstable(P: Polynomial, N: Polynomial, delay: float, k: float) -> int:
    """Return n/2 − Δarg/π, along ω = tan φ, with (jω + 1)ⁿ divided out."""
    n, turned, before = len(P) - 1, 0.0, None
    top = 200 * (1 + abs(k)) / delay
    for step in range(_NODES + 1):
        s = 1j * top * (step / _NODES) ** 2
        value = (_at(P, s) + k * _at(N, s) * cmath.exp(-s * delay)) / (s + 1) ** n
        turned += cmath.phase(value / before) if before is not None else 0.0
        before = value
    return round(-turned / math.pi)


def _loop(result: Any, at: Setting) -> tuple[Polynomial, Polynomial, float]:
    P, N = (coefficients_at(result.answer[name], result.plant.variable, at.point) for name in ("P", "N"))
    return P, N, float(Fraction(str(result.plant.delay)))


def _at(polynomial: Polynomial, s: complex) -> complex:
    total = 0j
    for coefficient in polynomial:
        total = total * s + float(coefficient)
    return total
