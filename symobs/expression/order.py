"""Second step: the tokens of a text in the order in which they are computed (reverse Polish notation).

The grammar, as lark would have it:

    row: sum (_COMMA sum)*
    ?sum: product | sum ADD product -> binary
    ?product: signed | product MULTIPLY signed -> binary
    ?signed: atom | ADD signed -> sign | atom POWER signed -> power
    ?atom: VALUE | _OPEN sum _CLOSE | LEFT row (_END row)* _RIGHT -> brackets | FUNCTION _OPEN sum _CLOSE -> call

A sign binds its power, -2^2 = -(2^2), and an exponent takes a sign, 2^-1; powers associate to the right.  Every rule
is a matter of what binds tighter, so two lists do (Dijkstra's shunting yard).  A parser that lark makes of this grammar
agrees in a test; here it would take longer to make than all texts of a file to read.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.expression.tokens import Token

#: How tight an operator binds what stands beside it; what closes or separates binds nothing.
_TIGHTNESS = {"ADD": 1, "MULTIPLY": 2, "SIGN": 3, "POWER": 4}


class Unexpected(Exception):
    """A token, or None for the end of the text, stands where an operand is expected, or behind one."""

    def __init__(self, token: Token | None) -> None:
        super().__init__(token)
        self.token = token


def in_order(tokens: Sequence[Token]) -> list[tuple[str, Token]]:
    """Return the tokens, each with what it does, so that every operation comes behind its operands.

    VALUE gives an operand; SIGN and FUNCTION take one, ADD, MULTIPLY and POWER two; LEFT opens a matrix, _COMMA and
    _END take its next entry, and _RIGHT the last.  Brackets are matched already.  Raises `Unexpected`.
    """
    done: list[tuple[str, Token]] = []
    waiting: list[tuple[str, Token]] = []
    behind_operand = False
    for token in tokens:
        kind = token.type
        if not behind_operand:
            behind_operand = _begin(kind, token, done, waiting)
            continue
        tightness = _TIGHTNESS.get(kind, 0)
        if not tightness and kind in {"VALUE", "FUNCTION", "_OPEN", "LEFT"}:
            raise Unexpected(token)
        while waiting and _TIGHTNESS.get(waiting[-1][0], 0) >= max(tightness + (kind == "POWER"), 1):
            done.append(waiting.pop())
        if tightness:
            waiting.append((kind, token))
        elif kind == "_CLOSE":
            waiting.pop()
            if waiting and waiting[-1][0] == "FUNCTION":
                done.append(waiting.pop())
        else:
            done.append((kind, token))
            if kind == "_RIGHT":
                waiting.pop()
        behind_operand = kind in {"_CLOSE", "_RIGHT"}
    if not behind_operand:
        raise Unexpected(None)
    return [*done, *reversed(waiting)]


def _begin(kind: str, token: Token, done: list[tuple[str, Token]], waiting: list[tuple[str, Token]]) -> bool:
    """Take a token where an operand is expected; tell whether it is the operand."""
    if kind == "VALUE":
        done.append((kind, token))
        return True
    if kind not in {"ADD", "_OPEN", "LEFT", "FUNCTION"}:
        raise Unexpected(token)
    if kind == "LEFT":
        done.append((kind, token))
    waiting.append(("SIGN" if kind == "ADD" else kind, token))
    return False
