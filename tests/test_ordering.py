"""The order of computation, held against a parser made by lark from the grammar as it is written."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from lark import Lark, Token, Transformer, UnexpectedToken
from lark.lexer import Lexer

from symobs.errors import InputError
from symobs.expression import tokens
from symobs.expression.names import Scope
from symobs.expression.ordering import Step, postfix
from symobs.expression.source import Source

GRAMMAR = r"""
row: sum (_COMMA sum)*
?sum: product | sum ADD product -> operation
?product: signed | product MULTIPLY signed -> operation
?signed: atom | ADD signed -> sign | atom POWER signed -> operation
?atom: VALUE -> value | _OPEN sum _CLOSE | LEFT row (_END row)* _RIGHT -> brackets | FUNCTION _OPEN sum _CLOSE -> call
%declare VALUE FUNCTION ADD MULTIPLY POWER LEFT _RIGHT _OPEN _CLOSE _COMMA _END
"""


class _Ready(Lexer):
    def __init__(self, _configuration: object) -> None:
        pass

    def lex(self, made: Any) -> Any:  # type: ignore[override]
        return (Token(token.type, token, start_pos=token.start) for token in made)


class _Postfix(Transformer[Token, Any]):
    """Writes a tree as its steps: kind, place, and the lengths of rows."""

    def row(self, entries: list[list[Any]]) -> list[list[Any]]:
        return entries

    def value(self, parts: list[Token]) -> list[Any]:
        return [("VALUE", parts[0].start_pos, ())]

    def operation(self, parts: list[Any]) -> list[Any]:
        return [*parts[0], *parts[2], (parts[1].type, parts[1].start_pos, ())]

    def sign(self, parts: list[Any]) -> list[Any]:
        return [*parts[1], ("sign", parts[0].start_pos, ())]

    def call(self, parts: list[Any]) -> list[Any]:
        return [*parts[1], ("FUNCTION", parts[0].start_pos, ())]

    def brackets(self, parts: list[Any]) -> list[Any]:
        left, *rows = parts
        inside = [step for row in rows for entry in row for step in entry]
        return [*inside, ("LEFT", left.start_pos, tuple(len(row) for row in rows))]


PARSER = Lark(GRAMMAR, parser="lalr", lexer=_Ready, start="row", maybe_placeholders=False)
PIECES = ["1", "2.5", "a", "b ", "sqrt(", "(", ")", "[", "]", ",", ";", "\n", " ", "+", "-", "*", "/", "^", "**"]


def by_grammar(made: list[tokens.Token]) -> list[Any] | int | None:
    """Return the steps, or where the first token stands that cannot follow, None for the end."""
    try:
        entries = _Postfix().transform(PARSER.parse(made))
    except UnexpectedToken as found:
        return None if found.token.type == "$END" else found.token.start_pos
    return [step for entry in entries for step in entry]


def by_precedence(made: list[tokens.Token], text: str) -> list[Any] | int | None:
    """Return the same from `postfix`."""
    try:
        found: list[Step] = postfix(made, Source(text, ""))
    except InputError as error:
        above = text.split("\n")[: int(str(error.facts["line"])) - 1]
        position = sum(len(line) + 1 for line in above) + int(str(error.facts["column"])) - 1
        return None if position == len(text) else position
    return [(step.kind, step.token.start, step.rows) for step in found]


def tokens_of(text: str) -> list[tokens.Token] | None:
    """Return the tokens of a text, None where it is refused before its order is asked for."""
    try:
        return tokens.Tokeniser(Source(text, ""), Scope.of(None, None, "")).run()
    except InputError:
        return None


@given(st.lists(st.sampled_from(PIECES), min_size=1, max_size=14).map("".join))
@example("-a^-2^3*b")
@example("[1 -2; a, (b + 1)^2]/3")
@example("--+2 + sqrt(4)^2 - 1")
def test_steps_are_those_of_the_grammar(text: str) -> None:
    made = tokens_of(text)
    if made is not None:
        assert by_precedence(made, text) == by_grammar(made)


OPERANDS = st.sampled_from(["1", "a", "sqrt(4)"])


def _joined(parts: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
    sign = st.sampled_from(["+", "-", "*", "/", "^", "*-", "^-", " + ", " - "])
    return st.one_of(
        st.tuples(parts, sign, parts).map("".join),
        parts.map("({})".format),
        parts.map("-{}".format),
        parts.map("sqrt({})".format),
        st.lists(parts, min_size=1, max_size=3).map(lambda row: f"[{', '.join(row)}]"),
        st.lists(parts, min_size=1, max_size=3).map(lambda column: f"[{'; '.join(column)}]"),
    )


@given(st.recursive(OPERANDS, _joined, max_leaves=12))
def test_steps_of_well_formed_texts_are_those_of_the_grammar(text: str) -> None:
    made = tokens_of(text)
    assert made is not None
    steps = by_precedence(made, text)
    assert isinstance(steps, list)
    assert steps == by_grammar(made)


@pytest.mark.parametrize("text", ["1 +", "(", "2 * ", "[1,", "*1", "(*2)", "[;", "2^"])
def test_what_is_missing_is_missed_by_both(text: str) -> None:
    made = tokens_of(text)
    if made is not None:
        assert not isinstance(by_precedence(made, text), list)
        assert by_precedence(made, text) == by_grammar(made)


def test_a_thousand_signs_are_read() -> None:
    text = "-" * 5_000 + "1" + "^1" * 2_000
    made = tokens_of(text)
    assert made is not None
    assert len(postfix(made, Source(text, ""))) == 5_000 + 1 + 2 * 2_000
