"""What margins claim: the polynomials in plain fractions, gains by stability on both sides, the rest on a grid of doubles."""

from __future__ import annotations

import cmath
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.support.algebra import characteristic, coefficients_at
from tests.support.claims import claims_with_dead_time

if TYPE_CHECKING:
    from tests.support.algebra import Polynomial
    from tests.support.claims.claims import Setting


def holds(result: Any, at: Setting) -> None:
    """Hold the margins of a state feedback, or of a controller, to its loop."""
    if result.plant.delay is not None:
        claims_with_dead_time.margins_hold(result, at)
        return
    if result.answer["closed"] is None:
        assert result.verdict == "no"
        return
    closed, opened = (
        coefficients_at(result.answer[name], result.plant.variable, at.point) for name in ("closed", "opened")
    )
    if "" in at.wanted:
        assert closed == at.wanted[""]
        assert opened == characteristic(at.A)
        assert result.design is not None
    if result.answer["open"]:
        assert result.verdict == "undecided"
        return
    assert (result.verdict == "yes") == at.is_stable(closed)
    if result.verdict == "yes":
        _gains(result, closed, opened, at)
        _on_the_boundary(result, closed, opened, discrete=at.discrete)


def _gains(result: Any, closed: Polynomial, opened: Polynomial, at: Setting) -> None:
    """Hold the loop to be stable just inside of the ends of the gain, and not just outside."""

    def is_stable(k: Fraction) -> bool:
        return at.is_stable([p + k * (c - p) for c, p in zip(closed, opened, strict=True)])

    unit = Fraction(1, 10**6)
    for end, inwards in ((result.gain_down, 1), (result.gain_up, -1)):
        if not end.is_finite:
            assert is_stable(Fraction(10**9))
            continue
        place = Fraction(str(end.n(30)))
        assert is_stable(place + inwards * unit * max(place, Fraction(1)))
        assert end == 0 or not is_stable(place - inwards * unit * place)


def _on_the_boundary(result: Any, closed: Polynomial, opened: Polynomial, *, discrete: bool) -> None:
    """Hold the distance to what the loop keeps on a grid."""

    def at_point(polynomial: Polynomial, s: complex) -> complex:
        total = 0j
        for coefficient in polynomial:
            total = total * s + float(coefficient)
        return total

    grid = [cmath.exp(0.031j * k) for k in range(101)] if discrete else [1j * 1.1**k for k in range(-60, 60)]
    values = [(abs(at_point(closed, s)), abs(at_point(opened, s))) for s in grid]
    assert all(one >= (float(result.modulus) - 1e-5) * other for one, other in values)
    assert abs(float(result.modulus) * float(result.peak) - 1) < 1e-4 * (1 + float(result.peak))
