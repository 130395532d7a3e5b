"""Reading what describes a region: polynomials, bounds, relations, and the formulas that QEPCAD prints.

One grammar for `19*s/4 + h1**2`, `2 h1^2 h2 - 1 > 0`, `sqrt(h1 + 1)`, `CRootOf(x**3 - x - 1, 0)`, and for `/\\`, `\\/`, `~`
and brackets around relations: it is brought to Python's, whose parser reads it.
"""

from __future__ import annotations

import ast
import re
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, TypeAlias

from tests.support.algebra import Unreadable, parsed
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
    from collections.abc import Collection

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


_OPERATORS = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
_RELATIONS = {ast.Gt: ">", ast.GtE: ">=", ast.Eq: "=", ast.NotEq: "!=", ast.Lt: "<", ast.LtE: "<="}
_FUNCTIONS = {"sqrt": "sqrt", "abs": "Abs", "Abs": "Abs", "CRootOf": "CRootOf", "rootof": "CRootOf"}
_ARGUMENTS = {"sqrt": (1,), "Abs": (1,), "CRootOf": (2, 3)}
#: What is written otherwise in Python: factors beside each other, then signs and words.
_IN_PYTHON: list[tuple[str, Any]] = [
    (r"\[", "("),
    (r"\]", ")"),
    (r"(?<=[\w)])\s+(?=[\w(])|(?<=\))(?=[\w(])|(?<=\b\d)(?=[A-Za-z(])", "*"),
    (r"/\\", " and "),
    (r"\\/", " or "),
    (r"~", " not "),
    (r"/=", "!="),
    (r"(?<![<>!=])=(?!=)", "=="),
    (r"\b(TRUE|FALSE)\b", lambda found: found[1].capitalize()),
]


def _read(text: str) -> Node | Statement:
    written = text.strip()
    for pattern, other in _IN_PYTHON:
        written = re.sub(pattern, other, written)
    try:
        return _node(parsed(written))
    except Unreadable as error:
        raise UnreadableError(text) from error


def _node(tree: ast.expr) -> Node | Statement:
    match tree:
        case ast.Constant(value=bool(known)):
            return AllOf(()) if known else SomeOf(())
        case ast.Constant(value=int() | float() as number):
            return Number(Fraction(str(number)))
        case ast.Name(id=name):
            return Name(name)
        case ast.UnaryOp(op=ast.USub(), operand=inner):
            return Binary("-", Number(Fraction(0)), _expression(inner))
        case ast.UnaryOp(op=ast.UAdd(), operand=inner):
            return _expression(inner)
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            return NotOf(_statement(inner))
        case ast.BoolOp(op=ast.And(), values=parts):
            return AllOf(tuple(map(_statement, parts)))
        case ast.BoolOp(values=parts):
            return SomeOf(tuple(map(_statement, parts)))
        case ast.Compare(left=first, ops=signs, comparators=others):
            members = [_expression(member) for member in (first, *others)]
            found = [
                Relation(*part)
                for part in zip(members, (_RELATIONS[type(s)] for s in signs), members[1:], strict=False)
            ]
            return found[0] if len(found) == 1 else AllOf(tuple(found))
        case ast.BinOp(left=base, op=ast.Pow(), right=power):
            exponent = rational(_expression(power))
            if exponent.denominator == 1:
                return Power(_expression(base), int(exponent))
            if exponent.denominator == 2:
                return Power(Call("sqrt", (_expression(base),)), exponent.numerator)
        case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _OPERATORS:
            return Binary(_OPERATORS[type(sign)], _expression(left), _expression(right))
        case ast.Call(func=ast.Name(id=name), args=arguments) if name in _FUNCTIONS:
            if len(arguments) in _ARGUMENTS[_FUNCTIONS[name]]:
                return Call(_FUNCTIONS[name], tuple(map(_expression, arguments)))
    raise UnreadableError(ast.unparse(tree))


def _expression(tree: ast.expr) -> Node:
    found = _node(tree)
    if isinstance(found, (Relation, AllOf, SomeOf, NotOf)):
        raise UnreadableError(ast.unparse(tree))
    return found


def _statement(tree: ast.expr) -> Statement:
    found = _node(tree)
    if not isinstance(found, (Relation, AllOf, SomeOf, NotOf)):
        raise UnreadableError(ast.unparse(tree))
    return found


def expression(text: str) -> Node:
    """Read an expression."""
    found = _read(text)
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
    found = _read(text)
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
