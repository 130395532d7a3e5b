"""Reading what describes a region: polynomials, bounds, relations, and the formulas that QEPCAD prints.

One grammar for `19*s/4 + h1**2`, `2 h1^2 h2 - 1 > 0`, `sqrt(h1 + 1)`, `CRootOf(x**3 - x - 1, 0)`, and for `/\\`, `\\/`, `~`
and brackets around relations.  Written without symobs and without SymPy.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

from tests.support.regions.region_algebra import (
    FALSE,
    TRUE,
    All,
    Atom,
    Not,
    Polynomial,
    Some,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Collection

    from tests.support.regions.region_algebra import Formula


class UnreadableError(ValueError):
    """A text outside the grammar."""


@dataclass(frozen=True)
class Number:
    value: Fraction


@dataclass(frozen=True)
class Name:
    name: str


@dataclass(frozen=True)
class Binary:
    """`op` is one of + - * /."""

    op: str
    left: Node
    right: Node


@dataclass(frozen=True)
class Power:
    base: Node
    exponent: int


@dataclass(frozen=True)
class Call:
    """`sqrt(a)`, `Abs(a)`, `CRootOf(p, k)`, or `CRootOf(p, x, k)` where p has other variables too."""

    function: str
    arguments: tuple[Node, ...]


@dataclass(frozen=True)
class Relation:
    """`left op right`."""

    left: Node
    op: str
    right: Node


Node: TypeAlias = Number | Name | Binary | Power | Call
#: What the reader makes of relations: a `Formula` whose atoms are still relations.
Statement: TypeAlias = "Relation | AllOf | SomeOf | NotOf"


@dataclass(frozen=True)
class AllOf:
    parts: tuple[Statement, ...]


@dataclass(frozen=True)
class SomeOf:
    parts: tuple[Statement, ...]


@dataclass(frozen=True)
class NotOf:
    part: Statement


_TOKEN = re.compile(r"\s*(?:(\d+(?:\.\d+)?)|([A-Za-z_]\w*)|(/\\|\\/|\*\*|[=!<>/]=|[-+*/^()\[\],<>=~]))")
_RELATIONS = {">": ">", ">=": ">=", "=": "=", "==": "=", "!=": "!=", "/=": "!=", "<": "<", "<=": "<="}
_FUNCTIONS = {"sqrt": "sqrt", "abs": "Abs", "Abs": "Abs", "CRootOf": "CRootOf", "rootof": "CRootOf"}
_ARGUMENTS = {"sqrt": (1,), "Abs": (1,), "CRootOf": (2, 3)}


class _Reader:
    def __init__(self, text: str) -> None:
        self.text, self.place = text, 0
        self.tokens: list[str] = []
        place, text = 0, text.rstrip()
        while place < len(text):
            match = _TOKEN.match(text, place)
            if match is None:
                raise UnreadableError(f"{text!r} at {text[place : place + 20]!r}")
            self.tokens.append(match.group().strip())
            place = match.end()

    @property
    def next(self) -> str:
        return self.tokens[self.place] if self.place < len(self.tokens) else ""

    def take(self) -> str:
        self.place += 1
        return self.tokens[self.place - 1]

    def skip(self, token: str) -> None:
        if self.next != token:
            raise UnreadableError(f"{self.text!r}: {token!r} expected, {self.next!r} found")
        self.place += 1

    # relations and their combinations

    def statement(self) -> Statement:
        parts = [self.conjunction()]
        while self.next == "\\/":
            self.take()
            parts.append(self.conjunction())
        return parts[0] if len(parts) == 1 else SomeOf(tuple(parts))

    def conjunction(self) -> Statement:
        parts = [self.unit()]
        while self.next == "/\\":
            self.take()
            parts.append(self.unit())
        return parts[0] if len(parts) == 1 else AllOf(tuple(parts))

    def unit(self) -> Statement:
        if self.next == "~":
            self.take()
            return NotOf(self.unit())
        if self.next == "[":
            self.take()
            inside = self.statement()
            self.skip("]")
            return inside
        if self.next.upper() in {"TRUE", "FALSE"}:
            return AllOf(()) if self.take().upper() == "TRUE" else SomeOf(())
        left = self.sum()
        found: list[Statement] = []
        while self.next in _RELATIONS:
            op = _RELATIONS[self.take()]
            right = self.sum()
            found.append(Relation(left, op, right))
            left = right
        if not found:
            raise UnreadableError(f"{self.text!r}: a relation expected before {self.next!r}")
        return found[0] if len(found) == 1 else AllOf(tuple(found))

    # expressions

    def sum(self) -> Node:
        sign = self.take() if self.next in {"+", "-"} else "+"
        total = self.product()
        total = Binary("-", Number(Fraction(0)), total) if sign == "-" else total
        while self.next in {"+", "-"}:
            total = Binary(self.take(), total, self.product())
        return total

    def product(self) -> Node:
        total = self.power()
        while True:
            if self.next in {"*", "/"}:
                total = Binary(self.take(), total, self.signed_power())
            elif self.next == "(" or self.next[:1].isalnum():
                total = Binary("*", total, self.power())
            else:
                return total

    def signed_power(self) -> Node:
        if self.next == "-":
            self.take()
            return Binary("-", Number(Fraction(0)), self.power())
        return self.power()

    def power(self) -> Node:
        base = self.primary()
        if self.next not in {"^", "**"}:
            return base
        self.take()
        exponent = self.exponent()
        if exponent.denominator == 1:
            return Power(base, int(exponent))
        if exponent.denominator == 2:
            return Power(Call("sqrt", (base,)), exponent.numerator)
        raise UnreadableError(f"{self.text!r}: exponent {exponent}")

    def exponent(self) -> Fraction:
        if self.next == "(":
            self.take()
            value = rational(self.sum())
            self.skip(")")
        else:
            value = rational(self.signed_power())
        return value

    def primary(self) -> Node:
        if self.next == "(":
            self.take()
            inside = self.sum()
            self.skip(")")
            return inside
        token = self.take() if self.next else ""
        if token[:1].isdigit():
            return Number(Fraction(token))
        if not re.fullmatch(r"[A-Za-z_]\w*", token):
            raise UnreadableError(f"{self.text!r}: {token!r} begins no expression")
        if token not in _FUNCTIONS or self.next != "(":
            return Name(token)
        self.take()
        arguments = [self.sum()]
        while self.next == ",":
            self.take()
            arguments.append(self.sum())
        self.skip(")")
        function = _FUNCTIONS[token]
        if len(arguments) not in _ARGUMENTS[function]:
            raise UnreadableError(f"{self.text!r}: {token} with {len(arguments)} arguments")
        return Call(function, tuple(arguments))

    def whole(self, read: Callable[[], Node | Statement]) -> Node | Statement:
        found = read()
        if self.next:
            raise UnreadableError(f"{self.text!r}: {self.next!r} is left over")
        return found


def expression(text: str) -> Node:
    """Read an expression."""
    reader = _Reader(text)
    found = reader.whole(reader.sum)
    if isinstance(found, (Relation, AllOf, SomeOf, NotOf)):
        raise UnreadableError(text)
    return found


def names_in(node: Node) -> set[str]:
    """Return the variables of an expression; those of a CRootOf, of which one is its own, are not among them."""
    match node:
        case Number() | Call("CRootOf"):
            return set()
        case Name(name):
            return {name}
        case Binary(_, left, right):
            return names_in(left) | names_in(right)
        case Power(base):
            return names_in(base)
        case Call(_, arguments):
            return set().union(*map(names_in, arguments))


def bound(text: str, names: Collection[str]) -> Node | None:
    """Read an end of an interval in these variables; None for an infinity."""
    if text in {"oo", "-oo"}:
        return None
    node = expression(text)
    if not names_in(node) <= {*names}:
        raise UnreadableError(f"{text!r} stands for itself")
    return node


def statement(text: str) -> Statement:
    """Read relations joined by and, or, not."""
    reader = _Reader(text)
    found = reader.whole(reader.statement)
    if not isinstance(found, (Relation, AllOf, SomeOf, NotOf)):
        raise UnreadableError(text)
    return found


def rational(node: Node) -> Fraction:
    """Return the value of an expression without names and roots."""
    above, below = fraction(node)
    numerator, denominator = above.constant, below.constant
    if numerator is None or not denominator:
        raise UnreadableError(f"{node} is no number")
    return numerator / denominator


def fraction(node: Node) -> tuple[Polynomial, Polynomial]:
    """Return numerator and denominator of an expression without roots."""
    match node:
        case Number(value):
            return Polynomial.of(value), Polynomial.of(1)
        case Name(name):
            return Polynomial.symbol(name), Polynomial.of(1)
        case Binary(op, left, right):
            return combined(op, fraction(left), fraction(right))
        case Power(base, exponent):
            above, below = fraction(base)
            return (above**exponent, below**exponent) if exponent >= 0 else (below**-exponent, above**-exponent)
        case Call(function):
            raise UnreadableError(f"{function} in what should be rational")


def combined(
    op: str, left: tuple[Polynomial, Polynomial], right: tuple[Polynomial, Polynomial]
) -> tuple[Polynomial, Polynomial]:
    """Return numerator and denominator of a sum, difference, product or quotient."""
    (a, b), (c, d) = left, right
    match op:
        case "*":
            return a * c, b * d
        case "/":
            return a * d, b * c
        case _:
            if b == d:
                return (a + c if op == "+" else a - c), b
            return (a * d + c * b if op == "+" else a * d - c * b), b * d


def polynomial(text: str) -> Polynomial:
    """Read a polynomial."""
    above, below = fraction(expression(text))
    if not below.constant:
        raise UnreadableError(f"{text!r} is no polynomial")
    return above * (1 / below.constant)


def formula(text: str) -> Formula:
    """Read relations between polynomials, for instance what QEPCAD prints."""
    return rational_formula(statement(text))


def rational_formula(found: Statement) -> Formula:
    """Return a set described without roots; a relation holds nowhere where a denominator vanishes."""
    match found:
        case Relation(left, op, right):
            above, below = combined("-", fraction(left), fraction(right))
            if below.constant is not None:
                return Atom(above * (1 / below.constant), op) if below.constant else FALSE
            return All((Atom(below, "!="), Atom(above * below, op)))
        case AllOf(parts):
            return All(tuple(rational_formula(part) for part in parts)) if parts else TRUE
        case SomeOf(parts):
            return Some(tuple(rational_formula(part) for part in parts)) if parts else FALSE
        case NotOf(part):
            return Not(rational_formula(part))
