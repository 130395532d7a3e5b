"""Significant digits of exact numbers: the text that a page prints."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.exact.algebraic.enclosure import is_number, near, sign_of_number
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.scalar import Scalar
from symobs.exact.numerals.rounded_roots import are_rounded_roots, is_correctly_written, is_exact, is_zero, root_parts

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.exact.algebraic.polynomial_roots import Root
    from symobs.exact.numerals.rounded_roots import Bounds, RootText


#: Powers of ten from which on an exact number, and the least one below which any number, is written with a power of ten.
_LONGEST_WHOLE, _LONGEST_ZEROS = 9, -4
#: Bits of the approximations that a rounding is read from.
_BITS = (64, 256, 1024, 4000)


def significant(value: Scalar, digits: int) -> str | None:
    """Return the text of a number that is not negative, None where it is no number or cannot be approximated.

    A number that has no more digits, and a longer one where that takes no more room, is written exactly; another one is
    rounded, with a power of ten from 10^digits on, and below 10^-4.
    """
    if value.is_constant:
        number = value.fraction()
        rounded = _rounded(number, digits)
        exact = _exact(number, digits)
        return exact if exact is not None and (_is_short(number, digits) or _room(exact) <= _room(rounded)) else rounded
    return next(_roundings(value, digits), None)


#: Digits to which irrational data are rounded where only rational ones are treated.
DATA_DIGITS = 15


def in_digits(matrix: Matrix) -> Matrix | None:
    """Return a matrix of numbers, the irrational ones correctly rounded; None where an entry is no number that can be."""
    entries = [entry if entry.is_constant else _in_digits(entry) for entry in matrix.entries]
    rows, columns = matrix.shape
    if any(entry is None for entry in entries):
        return None
    found = [entry for entry in entries if entry is not None]
    return Matrix.of([found[row * columns : (row + 1) * columns] for row in range(rows)], columns)


def _in_digits(entry: Scalar) -> Scalar | None:
    sign = sign_of_number(entry) if is_number(entry) else ""
    text = significant(-entry if sign == "negative" else entry, DATA_DIGITS) if sign else None
    return None if text is None else Scalar.of(Fraction(text) * (-1 if sign == "negative" else 1))


def _roundings(value: Scalar, digits: int) -> Iterator[str]:
    """Yield the rounding of a number that is not rational, from the first approximation that is near enough."""
    for bits in _BITS if is_number(value) else ():
        approximation = near(value, bits)
        if approximation:
            text = _rounded(approximation, digits)
            if is_correctly_written(value, text, digits):
                yield text


def _is_short(number: Fraction, digits: int) -> bool:
    """Return whether a number has at most the given significant digits."""
    units = _units(number)
    return units is not None and len(str(units).rstrip("0")) <= digits


def _units(number: Fraction) -> int | None:
    """Return the significant digits of a decimal that ends, trailing zeros of a whole number among them."""
    twos, fives, below = 0, 0, number.denominator
    while below % 2 == 0:
        twos, below = twos + 1, below // 2
    while below % 5 == 0:
        fives, below = fives + 1, below // 5
    return int(number * 10 ** max(twos, fives)) if below == 1 else None


def _exact(number: Fraction, digits: int) -> str | None:
    """Return a decimal that ends, with a power of ten where its digits stand far from the point."""
    units = _units(number)
    if units is None or number == 0:
        return None if units is None else "0"
    stripped = str(units).rstrip("0")
    power = _power(number)
    if len(stripped) <= digits and not _LONGEST_ZEROS <= power <= _LONGEST_WHOLE:
        return f"{stripped[0]}{'.' * (len(stripped) > 1)}{stripped[1:]}e{power}"
    return _plain(stripped, power)


def _rounded(number: Fraction, digits: int) -> str:
    """Return a positive number rounded to significant digits."""
    if number == 0:
        return "0"
    power = _power(number)
    units = round(number / Fraction(10) ** (power - digits + 1))
    if units == 10**digits:
        units, power = units // 10, power + 1
    written = str(units)
    if _LONGEST_ZEROS <= power < digits:
        return _plain(written, power)
    return f"{written[0]}{'.' * (digits > 1)}{written[1:]}e{power}"


def _plain(written: str, power: int) -> str:
    """Return digits with their point, the first of them standing for a multiple of 10^power."""
    if power < 0:
        return f"0.{'0' * (-power - 1)}{written}"
    whole, places = written[: power + 1].ljust(power + 1, "0"), written[power + 1 :]
    return f"{whole}.{places}" if places else whole


def _power(number: Fraction) -> int:
    """Return the largest k with 10^k not above a positive number."""
    power = len(str(number.numerator)) - len(str(number.denominator))
    return power if Fraction(10) ** power <= number else power - 1


def _room(text: str) -> int:
    """Return the characters of a text, a power of ten with its base and its dot."""
    return len(text.replace("e", "·10"))


# Roots of a polynomial in decimals: the texts that a page prints.


def rounded_roots(roots: Sequence[Root], digits: int) -> tuple[RootText, ...] | None:
    """Return the texts of roots, None where one has parameters or cannot be separated from its neighbours."""
    parts = root_parts(roots, digits)
    if parts is None:
        return None
    texts: list[RootText] = []
    for real, imaginary in parts:
        first = _text(real, digits)
        second = "" if is_zero(imaginary) else _text(imaginary, digits)
        if first is None or second is None:
            return None
        exact = is_exact(real, first) and (not second or is_exact(imaginary, second))
        texts.append((first, second, not exact))
    return tuple(texts) if are_rounded_roots(roots, tuple(texts), digits) else None


def _text(bounds: Bounds, digits: int) -> str | None:
    """Return the signed text of a part."""
    if is_zero(bounds):
        return "0"
    sign = sign_of_number(bounds[0])
    if sign not in {"positive", "negative"}:
        return None
    size = significant(bounds[0] if sign == "positive" else -bounds[1], digits)
    return None if size is None else f"{'-' * (sign == 'negative')}{size}"
