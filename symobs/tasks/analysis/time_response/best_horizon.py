"""Stationary points of a variance as a function of the horizon."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact.core.generators import derivative, function_named
from symobs.system.conditions import never_zero

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.exact import Scalar


def stationary(variance: Scalar, end: str, signs: Mapping[str, str]) -> str | None:
    """Return `T**4 == 140*r/q` where the derivative vanishes at one power of the horizon, else None."""
    if any(function_named(name) for name in variance.names):
        return None
    factors = [f for f, _ in derivative(variance, end).numerator.factors()[1] if not never_zero(f, signs)]
    if len(factors) != 1:
        return None
    lead, *rest = factors[0].coefficients(end)
    if any(not c.is_zero for c in rest[:-1]) or not rest:
        return None
    return f"{end}**{len(rest)} == {-rest[-1] / lead}"
