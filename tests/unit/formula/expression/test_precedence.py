"""The order of computation, held against Python's, which reads numbers, signs, parentheses and powers alike."""

from __future__ import annotations

import ast
import re
from fractions import Fraction
from typing import TYPE_CHECKING

import pytest
from hypothesis import assume, example, given, reject
from hypothesis import strategies as st

from symobs.formula.expression import parse_matrix, parse_scalar, tokenizer
from symobs.formula.expression.names import Scope
from symobs.formula.expression.source import Source, Token
from symobs.formula.expression.syntax import every, parse
from symobs.ground.errors import InputError
from tests.kit import tabled

if TYPE_CHECKING:
    from collections.abc import Callable

MOST = 10**6
OPERATIONS: dict[type, Callable[[Fraction, Fraction], Fraction]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
}


def by_python(node: ast.AST) -> Fraction:
    """Return what Python's own tree of a text is worth."""
    match node:
        case ast.Expression(body):
            return by_python(body)
        case ast.Constant(int(value)):
            return Fraction(value)
        case ast.UnaryOp(ast.USub(), operand):
            return -by_python(operand)
        case ast.UnaryOp(_, operand):
            return by_python(operand)
        case ast.BinOp(left, ast.Pow(), right):
            base, exponent = by_python(left), by_python(right)
            assume(exponent.denominator == 1 and abs(exponent) <= 6)
            assume(abs(base.numerator) <= MOST and base.denominator <= MOST)
            return base ** int(exponent)
        case ast.BinOp(left, operator, right):
            return OPERATIONS[type(operator)](by_python(left), by_python(right))
    raise TypeError(node)


SIGNS = st.sampled_from(["+", "-", "*", "/", "**", "*-", "**-", "/+", " + ", " - ", "--", "*--"])


def _joined(parts: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    return st.one_of(
        st.tuples(parts, SIGNS, parts).map("".join),
        parts.map("({})".format),
        parts.map("-{}".format),
        parts.map("+{}".format),
    )


@given(st.recursive(st.sampled_from(["1", "2", "3", "7"]), _joined, max_leaves=14))
@example("-2**2*3")
@example("2**-2**2")
@example("7-3-2/3/2*-3**2")
@example("--+2 + (4)**2 - 1")
def test_numbers_are_worth_what_python_finds(text: str) -> None:
    try:
        expected = by_python(ast.parse(text, mode="eval"))
    except ZeroDivisionError:
        reject()
    assert parse_scalar(text).fraction() == expected


def tokens_of(text: str) -> list[Token] | None:
    """Return the tokens of a text, None where it is refused before its order is asked for."""
    try:
        return tokenizer.Tokeniser(Source(text, ""), Scope.of(None, None, "")).run()
    except InputError:
        return None


@tabled
def test_what_is_missing_is_said_with_its_place(text: str, says: str) -> None:
    with pytest.raises(InputError, match=re.escape(says)):
        parse_matrix(text)


def test_a_thousand_signs_are_read() -> None:
    text = "-" * 5_000 + "1" + "^1" * 2_000
    made = tokens_of(text)
    assert made is not None
    (tree,) = parse(made, Source(text, ""))
    assert sum(1 for _ in every(tree)) == 5_000 + 1 + 2 * 2_000
    assert parse_scalar(text).fraction() == 1
