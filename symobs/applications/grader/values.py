"""Exact values: rational functions of one variable over the rational numbers, and the reading of texts.

Nothing of a text is executed: `read` is a parser of its own, with bounds on everything that could grow.
"""

from __future__ import annotations

import hashlib
import json
import re
from fractions import Fraction
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

#: The coefficients of a polynomial, from the lowest power, without zeros behind the last; numerator and denominator.
Poly = tuple[Fraction, ...]
Ratio = tuple[Poly, Poly]

MOST_CHARACTERS, MOST_NESTING, MOST_EXPONENT, MOST_DEGREE, MOST_BITS = 2000, 50, 1000, 60, 20000
_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?(?![0-9.]))"
    r"|(?P<name>[A-Za-z][A-Za-z0-9_]*)|(?P<sign>\*\*|[-+*/^()])|(?P<space>[ \t\r\n]+)"
)
DECIMAL = re.compile(r"\s*([+-]?)\s*([0-9]*)(?:\.([0-9]*))?(?:[eE]([+-]?[0-9]{1,3}))?\s*")
#: Numerator or denominator 1.
ONE: Poly = (Fraction(1),)
#: What editors and web pages put in place of the minus and of nothing.
TYPED = str.maketrans(
    dict.fromkeys("\u2212\u2010\u2011\u2013", "-") | dict.fromkeys("\u200b\u2060\ufeff") | {"\u00a0": " "}
)


class UnreadableError(Exception):
    """A text that is no value, and why."""


class VanishingError(UnreadableError):
    """A division by zero."""


# -- polynomials: coefficients from the lowest power, without zeros behind the last; the zero polynomial is empty --------


def poly(values: Iterable[Fraction | int]) -> Poly:
    """Return coefficients without zeros at the end."""
    found = [Fraction(value) for value in values]
    while found and not found[-1]:
        found.pop()
    return tuple(found)


def plus(p: Poly, q: Poly) -> Poly:
    """Return p + q."""
    size = max(len(p), len(q))
    return poly((p[k] if k < len(p) else 0) + (q[k] if k < len(q) else 0) for k in range(size))


def scaled(p: Poly, factor: Fraction | int) -> Poly:
    """Return a multiple of p."""
    return poly(factor * value for value in p)


def times(p: Poly, q: Poly) -> Poly:
    """Return p q."""
    found = [Fraction(0)] * (len(p) + len(q))
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            found[i + j] += a * b
    return poly(found)


def divided(p: Poly, q: Poly) -> tuple[Poly, Poly]:
    """Return quotient and remainder."""
    rest, quotient = list(p), [Fraction(0)] * max(0, len(p) - len(q) + 1)
    for k in range(len(p) - len(q), -1, -1):
        quotient[k] = rest[k + len(q) - 1] / q[-1]
        for j, b in enumerate(q):
            rest[k + j] -= quotient[k] * b
    return poly(quotient), poly(rest)


def divided_by(above: Poly, below: Poly = ONE) -> Ratio:
    """Return a rational function in lowest terms, its denominator monic."""
    if not below:
        raise VanishingError("a division by zero")
    p, q = above, below
    while q:
        p, q = q, divided(p, q)[1]
    above, below = divided(above, p)[0], divided(below, p)[0]
    return scaled(above, 1 / below[-1]), scaled(below, 1 / below[-1])


# -- reading -------------------------------------------------------------------------------------------------------------


def read(text: str, names: Mapping[str, Ratio]) -> Ratio:
    """Return the value of a text; `names` holds the values of its letters."""
    if len(text) > MOST_CHARACTERS:
        raise UnreadableError("this is too long")
    tokens: list[tuple[str, str]] = []
    text, place = text.translate(TYPED).strip().removesuffix(";"), 0
    while place < len(text):
        found = _TOKEN.match(text, place)
        if found is None:
            raise UnreadableError(f"{text[place]!r} cannot stand in a value")
        if found.lastgroup != "space":
            tokens.append((str(found.lastgroup), found.group().replace("**", "^")))
        place = found.end()
    reader = _Reader(tokens, names)
    value = reader.sum(0)
    if reader.place < len(tokens):
        raise UnreadableError(f"{tokens[reader.place][1]!r} stands in a wrong place")
    return value


class _Reader:
    """Recursive descent: sums, products (also of neighbours), signs, powers."""

    def __init__(self, tokens: list[tuple[str, str]], names: Mapping[str, Ratio]) -> None:
        """Take the tokens of a text and the values of its letters."""
        self.tokens, self.names, self.place = tokens, names, 0

    def next(self) -> tuple[str, str]:
        """Return kind and text of the token that comes."""
        return self.tokens[self.place] if self.place < len(self.tokens) else ("end", "")

    def takes(self, *signs: str) -> str:
        """Return the sign that comes, if it is one of these, and go on behind it."""
        kind, text = self.next()
        if kind == "sign" and text in signs:
            self.place += 1
            return text
        return ""

    def sum(self, depth: int) -> Ratio:
        """Return a sum of products."""
        value = self.product(depth)
        while sign := self.takes("+", "-"):
            (a, b), (c, d) = value, self.product(depth)
            value = bounded(plus(times(a, d), scaled(times(c, b), 1 if sign == "+" else -1)), times(b, d))
        return value

    def product(self, depth: int) -> Ratio:
        """Return a product, its sign written or not, or a quotient."""
        value, last = self.signed(depth), ""
        while True:
            before = self.tokens[self.place - 1][0]
            sign = self.takes("*", "/")
            kind, text = self.next()
            if not sign and not (kind in {"number", "name"} or text == "("):
                return value
            if not sign and kind == before == "number":
                raise UnreadableError("a number follows a number")
            if not sign and last == "/":
                raise UnreadableError("a product without its sign follows a division: write the sign, or parentheses")
            last = sign or "*"
            (a, b), (c, d) = value, self.signed(depth)
            value = bounded(times(a, d), times(b, c)) if last == "/" else bounded(times(a, c), times(b, d))

    def signed(self, depth: int) -> Ratio:
        """Return a power with its signs: -2^2 is -(2^2)."""
        negative = False
        while sign := self.takes("+", "-"):
            negative ^= sign == "-"
        value = self.atom(depth)
        if self.takes("^"):
            value = self.power(value, self.signed(depth + 1))
        return (scaled(value[0], -1), value[1]) if negative else value

    def power(self, value: Ratio, exponent: Ratio) -> Ratio:
        """Return a power with an integer exponent."""
        number = exponent[0][0] if exponent[0] else Fraction(0)
        if len(exponent[0]) > 1 or len(exponent[1]) > 1 or number.denominator > 1 or abs(number) > MOST_EXPONENT:
            raise UnreadableError(f"an exponent is an integer up to {MOST_EXPONENT}")
        above, below = value if number >= 0 else divided_by(value[1], value[0])
        found = (ONE, ONE)
        for _ in range(abs(int(number))):
            found = bounded(times(found[0], above), times(found[1], below))
        return found

    def atom(self, depth: int) -> Ratio:
        """Return a number, a letter, or a sum in parentheses."""
        kind, text = self.next()
        self.place += 1
        if depth > MOST_NESTING:
            raise UnreadableError("brackets are nested too deeply")
        if text == "(":
            value = self.sum(depth + 1)
            if not self.takes(")"):
                raise UnreadableError("a parenthesis is not closed")
            return value
        if kind == "number":
            return bounded(poly([Fraction(text)]), ONE)
        if kind == "name" and text in self.names:
            return self.names[text]
        if kind == "name":
            known = ", ".join(sorted(self.names))
            raise UnreadableError(f"{text} is not a letter of this question" + (f" ({known})" if known else ""))
        message = f"{text!r} stands in a wrong place" if text else "a value is missing"
        raise UnreadableError(message)


def bounded(above: Poly, below: Poly) -> Ratio:
    """Return a rational function, if it is small enough to go on with."""
    if max(len(above), len(below)) > MOST_DEGREE or any(
        max(abs(c.numerator).bit_length(), c.denominator.bit_length()) > MOST_BITS for c in (*above, *below)
    ):
        raise UnreadableError("this is too large")
    return divided_by(above, below) if len(below) > 1 or not below else (scaled(above, 1 / below[0]), ONE)


def number(value: Ratio) -> Fraction:
    """Return a value without the variable as a number."""
    above, below = value
    if len(above) > 1 or len(below) > 1:
        raise UnreadableError("a number is expected here")
    return above[0] if above else Fraction(0)


def points(question: Mapping[str, Any], given: object) -> list[dict[str, Ratio]]:
    """Return the values of the symbols at which everything is computed: one empty point where there are none."""
    if not question["names"]:
        return [{}]
    seed = json.dumps([question, given], sort_keys=True, default=str)
    drawn = [
        {
            name: int(hashlib.sha256(f"{k}{name}{seed}".encode("utf-8", "replace")).hexdigest()[:15], 16) + 2
            for name in question["names"]
        }
        for k in range(2)
    ]
    return [{name: (poly([value]), ONE) for name, value in point.items()} for point in drawn]
