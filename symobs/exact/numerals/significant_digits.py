"""Significant digits of exact numbers: the test that a text is the correct rounding of one (trusted).

A text is `0.3676`, `16987` or `1.2346e-7`, always of a number that is not negative.  Either it is exactly the number, or it
has as many significant digits as were asked for, trailing zeros among them, and is the multiple of the unit of its last
place that is nearest to the number; of two that are equally near the even one.
"""

from __future__ import annotations

import re
from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact.algebraic.enclosure import sign_of_number

if TYPE_CHECKING:
    from symobs.exact.core.scalar import Scalar

_WRITTEN = re.compile(r"(?P<whole>0|[1-9][0-9]*)(?:\.(?P<places>[0-9]+))?(?:e(?P<power>-?[1-9][0-9]*))?")


def is_correctly_written(exact: Scalar, text: str, digits: int) -> bool:
    """Return whether a text is the number itself, or its correct rounding to so many significant digits."""
    found = _WRITTEN.fullmatch(text)
    if found is None:
        return False
    places = found["places"] or ""
    units = int(found["whole"] + places)
    unit = Fraction(10) ** (int(found["power"] or 0) - len(places))
    shown = units * unit
    if exact.is_constant and exact.fraction() == shown:
        return True
    if len(str(units)) != digits or units == 0:
        return False
    is_below = exact.fraction() < shown if exact.is_constant else sign_of_number(shown - exact) == "positive"
    if is_below and units == 10 ** (digits - 1):  # below a power of ten the digits stand one place further
        units, unit = 10 * units, unit / 10
    if exact.is_constant:
        off = abs(exact.fraction() - shown)
        return 2 * off < unit or (2 * off == unit and units % 2 == 0)
    return all(sign_of_number(unit / 2 + off) == "positive" for off in (exact - shown, shown - exact))


def is_written_exactly(exact: Scalar, text: str) -> bool:
    """Return whether a text is exactly the number."""
    return exact.is_constant and Fraction(text) == exact.fraction()
