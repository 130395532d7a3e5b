"""The order of tokens against a parser that lark makes of the grammar: the same order, the same fault at the same place."""

from __future__ import annotations

import re
from functools import cache
from itertools import product
from typing import TYPE_CHECKING, Any

from hypothesis import given, settings
from hypothesis import strategies as st
from lark import Lark, UnexpectedToken
from lark import Token as LarkToken
from lark.lexer import Lexer

from symobs.errors import SymobsError
from symobs.expression import order
from symobs.expression.names import Scope
from symobs.expression.order import Unexpected, in_order
from symobs.expression.source import Source
from symobs.expression.tokens import Token, Tokeniser

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from lark import Tree

RULES = re.findall(r"^    (\??\w+:.*)$", order.__doc__ or "", re.MULTILINE)
NAMES = "VALUE FUNCTION ADD MULTIPLY POWER LEFT _RIGHT _OPEN _CLOSE _COMMA _END"
OPERATIONS = {"binary": 1, "power": 1, "sign": 0, "call": 0}
PIECES = ["1", "a", "+", "-", "*", "^", "(", ")", "[", "]", ",", ";", " ", "sqrt(", "2 "]


class Ready(Lexer):
    """Hands lark the tokens that are already made, each known by its place."""

    def __init__(self, _configuration: object) -> None:
        pass

    def lex(self, tokens: Any) -> Iterator[LarkToken]:  # type: ignore[override]
        return (LarkToken(token.type, str(index), start_pos=index) for index, token in enumerate(tokens))


@cache
def parser() -> Lark:
    assert len(RULES) == 5
    grammar = "\n".join([*RULES, f"%declare {NAMES}"])
    return Lark(grammar, parser="lalr", lexer=Ready, start="row", maybe_placeholders=False)


def operations_of(tree: Tree[LarkToken] | LarkToken) -> Iterator[int]:
    """The places of operands and operators, operands first; a matrix by its bracket, behind its entries."""
    if isinstance(tree, LarkToken):
        yield int(tree)
        return
    operator = tree.children[OPERATIONS[tree.data]] if tree.data in OPERATIONS else None
    bracket = tree.children[0] if tree.data == "brackets" else None
    for child in tree.children:
        if child is not operator and child is not bracket:
            yield from operations_of(child)
    yield from (int(str(found)) for found in (operator, bracket) if found is not None)


def expected(tokens: Sequence[Token]) -> list[int] | str:
    try:
        return list(operations_of(parser().parse(tokens)))
    except UnexpectedToken as found:
        return "end" if found.token.type == "$END" else f"at {found.token}"


def found(tokens: Sequence[Token]) -> list[int] | str:
    place = {id(token): index for index, token in enumerate(tokens)}
    try:
        ordered = in_order(tokens)
    except Unexpected as fault:
        return "end" if fault.token is None else f"at {place[id(fault.token)]}"
    opened: list[int] = []
    places = []
    for kind, token in ordered:
        if kind == "LEFT":
            opened.append(place[id(token)])
        elif kind == "_RIGHT":
            places.append(opened.pop())
        elif kind not in {"_COMMA", "_END"}:
            places.append(place[id(token)])
    return places


def agree(text: str) -> bool:
    """Whether a text became tokens at all, on which both have to agree."""
    try:
        tokens = Tokeniser(Source(text, ""), Scope.of(None, None, "", functions=True)).run()
    except SymobsError:
        return False
    assert found(tokens) == expected(tokens), text
    return True


def test_all_short_texts() -> None:
    texts = ("".join(pieces) for length in range(1, 5) for pieces in product(PIECES, repeat=length))
    assert sum(map(agree, texts)) > 8_000


@settings(max_examples=300, deadline=None)
@given(st.lists(st.sampled_from(PIECES), max_size=40).map("".join))
def test_any_text(text: str) -> None:
    agree(text)


_EXPRESSIONS = st.recursive(
    st.sampled_from(["1", "a", "2.5"]),
    lambda inner: st.one_of(
        st.tuples(inner, st.sampled_from("+-*/^"), inner).map("".join),
        inner.map("-{}".format),
        inner.map("({})".format),
        inner.map("sqrt({})".format),
        st.lists(st.lists(inner, min_size=1, max_size=3).map(" ".join), min_size=1, max_size=2).map(
            lambda rows: f"[{'; '.join(rows)}]"
        ),
    ),
    max_leaves=25,
)


@settings(max_examples=300, deadline=None)
@given(_EXPRESSIONS)
def test_any_expression(text: str) -> None:
    assert agree(text)
