"""The text being read: its tokens, safe excerpts of it, and errors that point into it."""

from __future__ import annotations

from dataclasses import replace
from math import comb, lcm
from typing import TYPE_CHECKING, Self, TypeAlias

from symobs.exact import Complex, Scalar
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import ExpressionError, InputError

if TYPE_CHECKING:
    from collections.abc import Sequence


MOST_SHOWN = 60
#: An error that points into a text shows this much of it, more than half of it before the place.
_EXCERPT, _BEFORE = 40, 24


def shown(text: str, most: int = MOST_SHOWN) -> str:
    """Return the beginning of a text, safe to print: no control characters, nothing long."""
    safe = "".join(c if c.isprintable() else c.encode("unicode_escape").decode("ascii") for c in text[: most + 1])
    return safe if len(safe) <= most else safe[: most - 1] + "…"


@dataclass
class Source:
    """A text and the place it comes from (`plant.A`)."""

    text: str
    where: str

    def error(
        self, message: str, position: int, repair: str = "", kind: type[InputError] = ExpressionError, **facts: object
    ) -> InputError:
        """Return an error with `message` at the character `position`."""
        before = self.text[:position]
        line, column = before.count("\n") + 1, position - before.rfind("\n")
        start = max(0, position - _BEFORE)
        excerpt = shown(("…" if start else "") + self.text[start:], _EXCERPT)
        place = f"line {line}, column {column}" if "\n" in self.text else f"column {column}"
        facts |= {"text": excerpt, "line": line, "column": column}
        return kind(f'{message}, at {place} of "{excerpt}"', where=self.where, repair=repair, **facts)


class Token(str):
    """A piece of the text: its type, its start, and its exact number, None if it has none."""

    __slots__ = ("start", "type", "value")

    type: str
    start: int
    value: Scalar | Complex | None

    def __new__(cls, type_: str, text: str, start: int, value: Scalar | Complex | None = None) -> Self:
        """Make the token of a text."""
        token = super().__new__(cls, text)
        token.type, token.start, token.value = type_, start, value
        return token


# Bounds for the size of a result, computed before the operation.
#
# A FLINT call cannot be interrupted, so what is too large must never be started.


Number: TypeAlias = Scalar | Complex
MOST_EXPONENT = 1_000
#: A coefficient of 10,000 bits still prints as a decimal number; a polynomial still lists 10,000 coefficients.
MOST_BITS = 10_000
MOST_DEGREE = 10_000
MOST_TERMS = 20_000
#: What all operations of one call may cost together, in machine words written: about a second of work at the worst.
MOST_WORK = 3_000_000


@dataclass
class Size:
    """An upper bound of an integer polynomial: its generators, total degree, terms, and bits of a coefficient."""

    names: frozenset[str]
    degree: int
    terms: int
    bits: int

    @staticmethod
    def of(polynomial: Scalar) -> Size:
        """Return the size of a polynomial, the numerator of the scalar."""
        part = polynomial.numerator_part
        bits = max((int(coefficient).bit_length() for coefficient in part.coeffs()), default=0)
        return Size(frozenset(polynomial.field.names), max(0, int(part.total_degree())), len(part), bits)

    @property
    def words(self) -> int:
        """The number of machine words."""
        return self.terms * (len(self.names) + 1 + self.bits // 64)

    @property
    def excess(self) -> str:
        """The excess over the limits, empty if there is none."""
        if self.bits > MOST_BITS:
            return f"a number of more than {MOST_BITS} bits"
        if self.degree > MOST_DEGREE:
            return f"a power beyond {MOST_DEGREE}"
        return f"more than {MOST_TERMS} terms" if self.terms > MOST_TERMS else ""

    def __add__(self, other: Size) -> Size:
        bits = max(self.bits, other.bits) + 1
        return _bounded(self.names | other.names, max(self.degree, other.degree), self.terms + other.terms, bits)

    def __mul__(self, other: Size) -> Size:
        bits = self.bits + other.bits + min(self.terms, other.terms).bit_length()
        return _bounded(self.names | other.names, self.degree + other.degree, self.terms * other.terms, bits)

    def __pow__(self, exponent: int) -> Size:
        terms = comb(self.terms + exponent - 1, exponent) if self.terms > 1 else 1
        return _bounded(
            self.names, self.degree * exponent, terms, exponent * (self.bits + (self.terms - 1).bit_length())
        )


def _bounded(names: frozenset[str], degree: int, terms: int, bits: int) -> Size:
    """Return a size with no more terms than there are monomials of that degree."""
    monomials = comb(len(names) + degree, len(names)) if degree <= MOST_DEGREE else terms
    return Size(names, degree, min(terms, monomials), bits)


_ONE = Size(frozenset(), 0, 1, 1)
Parts: TypeAlias = tuple[Size, Size]


def parts(value: Number) -> Parts:
    """Return the sizes of numerator and denominator; of a complex number, over one denominator."""
    if isinstance(value, Scalar):
        return Size.of(value), _ONE if value.denominator_part.is_one() else Size.of(value.denominator)
    (a, b), (c, d) = parts(value.real), parts(value.imaginary)
    return a * d + c * b, b * d


@dataclass(frozen=False)
class Meter:
    """The accumulated cost of the texts of one call."""

    spent: int = 0

    def charge(self, cost: int, sizes: Parts) -> str:
        """Charge an operation with results of these sizes; return the excess, empty if there is none."""
        self.spent += cost
        excess = sizes[0].excess or sizes[1].excess
        return excess or ("too much, all operations so far together" if self.spent > MOST_WORK else "")


def work(above: Size, below: Size) -> int:
    """Return the cost of building a numerator and a denominator and of finding their common divisor.

    The divisor's share was measured where it is largest, on sparse polynomials of high degree: it grows with their
    words and with the square of the lower degree.
    """
    words = above.words + below.words
    return words + words * min(above.degree, below.degree) ** 2 // 20


def operation_size(sign: str, left: Number, right: Number) -> Parts:
    """Return a bound of left + right, left - right, left * right or left / right before it is reduced."""
    (a, b), (c, d) = parts(left), parts(right)
    if sign == "*":
        return a * c, b * d
    if isinstance(left, Complex) or isinstance(right, Complex):
        return (a * d * c, b * c * c) if sign == "/" else (a * d + c * b, b * d)
    if sign == "/":
        return a * d, b * c
    return (a + c, b) if left.denominator == right.denominator else (a * d + c * b, b * d)


def power_size(base: Scalar, exponent: int) -> Parts:
    """Return a bound of base ** exponent."""
    above, below = parts(base)
    return above ** abs(exponent), below ** abs(exponent)


def common_denominator_excess(entries: Sequence[Scalar]) -> str:
    """Return the excess of a common denominator of these entries, empty if there is none."""
    fractions = [entry for entry in entries if not entry.denominator_part.is_one()]
    common, whole, spent = _ONE, 1, 0
    for denominator in dict.fromkeys(entry.denominator for entry in fractions):
        if denominator.is_constant:
            whole = lcm(whole, int(denominator.fraction()))
        else:
            size = Size.of(denominator)
            spent += work(common, size)
            common = common * size
        if spent > MOST_WORK or len(entries) * whole.bit_length() > MOST_WORK * 64:
            return "too much"
    common = replace(common, bits=common.bits + whole.bit_length())
    spent += sum((Size.of(entry) * common).words for entry in entries) if fractions else 0
    return "too much" if spent > MOST_WORK else ""
