"""Choice of the exact region of a polynomial, within limits of time."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING

from symobs.exact import TooLarge
from symobs.stability.regions.interval_region import LineRegion
from symobs.stability.regions.plane_region import PlaneRegion, can_be_divided, plane_region
from symobs.stability.regions.short_list import short_list

if TYPE_CHECKING:
    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials


@lru_cache(maxsize=64)
def exact_region(critical: CriticalPolynomials, names: tuple[str, ...]) -> LineRegion | PlaneRegion | None:
    """Return the exact region in one or two parameters, None for more parameters or too high a degree.

    A parameter that may be 0 and not beyond has a boundary that belongs to it, which open cells do not see.
    """
    if any(critical.signs.get(name) in {"nonnegative", "nonpositive"} for name in names):
        return None
    critical = replace(critical, asked=names)
    if len(names) == 1:
        return LineRegion(critical, names[0])
    if len(names) != 2:
        return None
    found = plane_region(critical, (names[0], names[1]))
    if not can_be_divided(found):
        return None
    try:
        if not critical.never and not found.empty:
            short_list(found)
    except TooLarge:
        return None
    return found
