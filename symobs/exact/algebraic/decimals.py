"""Decimals of exact numbers: rounding, digits, and the test of a printed rounding."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact.algebraic.enclosure import near, sign_of_number
from symobs.exact.core.generators import function_named
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable

#: A decimal of more places is written as a fraction.
_MOST_PLACES = 12
#: From this denominator on a reader wants to see the decimals of a fraction.
_HARD_TO_READ = 10


def decimal_places(value: Scalar) -> int | None:
    """Return the number of decimal places, None where the expansion is infinite or too long."""
    if not value.is_constant:
        return None
    below = value.fraction().denominator
    return next((count for count in range(_MOST_PLACES + 1) if 10**count % below == 0), None)


def decimal_digits(value: Scalar) -> str:
    """Return the digits of a decimal, without its sign: 0.3676, 60.  Raises `ValueError` where it does not end."""
    count = decimal_places(value)
    if count is None:
        message = f"{value} is not a decimal of at most {_MOST_PLACES} places"
        raise ValueError(message)
    digits = str(abs(int(value.fraction() * 10**count))).zfill(count + 1)
    return f"{digits[:-count]}.{digits[-count:]}" if count else digits


def is_rounding(exact: Scalar, shown: Scalar) -> bool:
    """Return whether a decimal is within half a unit of its last place; an integer must be exact."""
    count = decimal_places(shown)
    if count is None:
        return False
    if not exact.is_constant:
        half = Scalar.of(Fraction(1, 2 * 10**count))
        return count > 0 and all(sign_of_number(half + off) == "positive" for off in (exact - shown, shown - exact))
    off = abs(exact.fraction() - shown.fraction())
    return off == 0 if count == 0 else off * 2 * 10**count <= 1


def rounded(value: Matrix | Scalar) -> Matrix | Scalar | None:
    """Return a number or matrix rounded to decimals that suit its magnitude, trailing zeros omitted.

    None where they help nobody: nothing in it is a fraction with a large denominator, or an entry would be rounded to a
    whole number, which reads as if it were exact.
    """
    entries = value.entries if isinstance(value, Matrix) else (value,)
    numbers = [number for entry in entries if (number := _number(entry)) is not None]
    if not entries or len(numbers) < len(entries):
        return None
    if all(number.denominator < _HARD_TO_READ for number in numbers):
        return None
    found = _rounded(numbers)
    if any(near.denominator == 1 != number.denominator for near, number in zip(found, numbers, strict=True)):
        return None
    shown = [Scalar.of(near) for near in found]
    if not isinstance(value, Matrix):
        return shown[0]
    width = value.shape[1]
    return Matrix.of([shown[start : start + width] for start in range(0, len(shown), width)])


def _number(value: Scalar) -> Fraction | None:
    """Return a rational number; of a square root of one, or a real root without a closed form, an approximation."""
    if value.is_constant:
        return value.fraction()
    functions = [f for name in value.names if (f := function_named(name)) is not None]
    counted = any(f.square or f.kind == "CRootOf" for f in functions)
    return near(value) if counted else None


def _rounded(numbers: Iterable[Fraction]) -> list[Fraction]:
    """Round to four places, larger numbers to fewer."""
    numbers = list(numbers)
    largest = max(abs(number) for number in numbers)
    count = 4 if largest < 10 else 3 if largest < 100 else 2
    return [Fraction(round(number * 10**count), 10**count) for number in numbers]
