"""From the text of a printed equation to its tree.

The tokens are those of every other expression (`symobs.expression`), and two more: `'` after an operand, its transpose
or, behind a signal, its derivative; and `=`.  A name is a letter, and is not evaluated here: letters do not commute.
"""

from __future__ import annotations

import re
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Any

from lark import Lark, Token, UnexpectedToken
from lark.exceptions import VisitError
from lark.lexer import Lexer
from lark.visitors import Transformer_NonRecursive

from symobs.errors import BudgetExceeded, ExpressionError
from symobs.exact import Scalar
from symobs.expression.names import Scope
from symobs.expression.source import Source, shown
from symobs.expression.tokens import Tokeniser
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator

FUNCTIONS = (
    ("det", 1),
    ("adj", 1),
    ("trace", 1),
    ("rank", 1),
    ("size", 1),
    ("eigenvalues", 1),
    ("rref", 1),
    ("ctrb", 2),
    ("obsv", 2),
    ("place", 3),
    ("Phi", 2),
    ("integral", 4),
    *((name, 1) for name in ("sqrt", "exp", "sin", "cos", "sinh", "cosh")),
)
_ARGUMENTS = dict(FUNCTIONS)
MOST_CHARACTERS = 2_000
MOST_NODES = 200
MOST_EXPONENT = 12

GRAMMAR = r"""
relation: sum (_EQUAL sum)*
?sum: term | sum ADD term -> binary
?term: product | ADD product -> sign
?product: behind | product MULTIPLY signed -> binary
?signed: behind | ADD signed -> sign
?behind: atom | behind PRIME -> primed | behind POWER VALUE -> power | behind POWER ADD VALUE -> power
?atom: VALUE -> leaf | _OPEN sum _CLOSE | LEFT row (_END row)* _RIGHT -> block | FUNCTION _OPEN sum (_COMMA sum)* _CLOSE -> call
row: sum (_COMMA sum)*
%declare VALUE FUNCTION ADD MULTIPLY POWER PRIME LEFT _RIGHT _OPEN _CLOSE _COMMA _END _EQUAL
"""


@dataclass(frozen=True)
class Node:
    """A part of a printed equation, as it is printed.

    number (`text`, `value`), letter (`text`), sum, product, negative, quotient, power (`text` is the exponent), primed,
    block of rows, row, call (`text` is the function).
    """

    kind: str
    parts: tuple[Node, ...] = ()
    text: str = ""
    value: Scalar | None = None

    def __str__(self) -> str:
        return written(self)


def read_relation(text: str, where: str) -> tuple[Node, ...]:
    """Return the members of a printed equation `a = b = …`; raises ExpressionError with the place of the fault."""
    source = Source(text, where)
    if len(text) > MOST_CHARACTERS:
        message = f"the equation has {len(text)} characters, more than {MOST_CHARACTERS}"
        raise source.error(message, 0, "print it in parts", kind=BudgetExceeded)
    try:
        members: tuple[Node, ...] = _Reader(source).transform(_parser().parse(_Printed(source).run()))
    except UnexpectedToken as found:
        at_end = found.token.type == "$END"
        position = len(text) if at_end else (found.token.start_pos or 0)
        place = "at the end" if at_end else f'before "{shown(found.token)}"'
        raise source.error(f'a number, a letter or "(" is expected {place}', position, "write one there") from None
    except VisitError as wrapped:
        raise wrapped.orig_exc from None
    if sum(1 for member in members for _ in every(member)) > MOST_NODES:
        raise source.error(f"the equation has more than {MOST_NODES} parts", 0, "print it in parts", BudgetExceeded)
    return members


def every(node: Node) -> Iterator[Node]:
    """Yield a node and all below it, from the left; a tree that is too deep is still counted."""
    waiting = [node]
    while waiting:
        yield (first := waiting.pop())
        waiting += reversed(first.parts)


def letters_of(*nodes: Node) -> list[str]:
    """Return the letters of these trees, each once, in the order in which they stand."""
    return list(dict.fromkeys(part.text for node in nodes for part in every(node) if part.kind == "letter"))


class _Printed(Tokeniser):
    """Cuts a printed equation into tokens; a letter is a VALUE without a value."""

    pattern = re.compile(
        r"(?P<NUMBER>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
        r"|(?P<NAME>[A-Za-z][A-Za-z0-9_]*)"
        r"|(?P<POWER>\*\*|\^)|(?P<MULTIPLY>[*/])|(?P<ADD>[+-])"
        r"|(?P<OPEN>[(\[])|(?P<CLOSE>[)\]])|(?P<COMMA>,)|(?P<END>;)"
        r"|(?P<PRIME>')|(?P<EQUAL>=)"
        r"|(?P<SPACE>[ \t\r\n]+)"
    )

    def __init__(self, source: Source) -> None:
        super().__init__(source, Scope.of(None, None, source.where))

    def _take(self, kind: str, text: str, at: int) -> None:
        if kind == "EQUAL" and self.open:
            raise self.source.error('"=" stands inside brackets', at, "close them first")
        if kind == "EQUAL" or (kind == "COMMA" and self.open and not self._in_brackets()):
            self.spaced = False
            self._add("_EQUAL" if kind == "EQUAL" else "_COMMA", text, at)
        else:
            super()._take(kind, text, at)

    def _name(self, name: str, at: int) -> None:
        called = self.text.startswith("(", at + len(name))
        if name in _ARGUMENTS and called:
            self._add("FUNCTION", name, at)
        elif len(name) > 64:
            raise self.source.error("a letter has more than 64 characters", at, "shorten it", kind=ExpressionError)
        else:
            self._add("VALUE", name, at)


class _Ready(Lexer):
    """Hands lark the tokens that are already made."""

    def __init__(self, _configuration: object) -> None:
        pass

    def lex(self, tokens: Any) -> Iterator[Token]:  # type: ignore[override]
        return map(_of_lark, tokens)


def _of_lark(ready: Any) -> Token:
    token = Token(ready.type, ready, start_pos=ready.start)
    token.value = ready.value
    return token


@cache
def _parser() -> Lark:
    return Lark(GRAMMAR, parser="lalr", lexer=_Ready, start="relation", maybe_placeholders=False)


class _Reader(Transformer_NonRecursive[Token, Any]):
    """Makes the tree: one method for each rule of the grammar."""

    def __init__(self, source: Source) -> None:
        super().__init__()
        self.source = source

    def relation(self, members: list[Node]) -> tuple[Node, ...]:
        return tuple(members)

    def leaf(self, parts: list[Token]) -> Node:
        value = getattr(parts[0], "value", None)
        if isinstance(value, Scalar):
            return Node("number", text=str(parts[0]), value=value)
        return Node("letter", text=str(parts[0]))

    def binary(self, parts: list[Any]) -> Node:
        left, token, right = parts
        if str(token) == "/":
            return Node("quotient", (left, right))
        kind = "product" if str(token) == "*" else "sum"
        last = (Node("negative", (right,)),) if str(token) == "-" else right.parts if right.kind == kind else (right,)
        return Node(kind, (*(left.parts if left.kind == kind else (left,)), *last))

    def sign(self, parts: list[Any]) -> Node:
        term: Node = parts[1]
        return Node("negative", (term,)) if str(parts[0]) == "-" else term

    def primed(self, parts: list[Any]) -> Node:
        return Node("primed", (parts[0],))

    def power(self, parts: list[Any]) -> Node:
        base, token, *sign, exponent = parts
        value = getattr(exponent, "value", None)
        whole = isinstance(value, Scalar) and value.fraction().denominator == 1
        if not whole or abs(value.fraction()) > MOST_EXPONENT:  # type: ignore[union-attr]
            message = f"an exponent is an integer up to {MOST_EXPONENT}"
            raise self.source.error(message, token.start_pos or 0, "write A^-1 for the inverse, A' for the transpose")
        minus = sign and str(sign[0]) == "-"
        return Node("power", (base,), text=f"{'-' if minus else ''}{int(value.fraction())}")  # type: ignore[union-attr]

    def row(self, entries: list[Node]) -> Node:
        return Node("row", tuple(entries))

    def block(self, parts: list[Any]) -> Node:
        rows = parts[1:]
        for number, row in enumerate(rows, start=1):
            if len(row.parts) != len(rows[0].parts):
                message = f"row {number} has {len(row.parts)} entries, but row 1 has {len(rows[0].parts)}"
                raise self.source.error(message, parts[0].start_pos or 0, "give every row the same number of entries")
        return Node("block", tuple(rows))

    def call(self, parts: list[Any]) -> Node:
        name, arguments = str(parts[0]), parts[1:]
        if len(arguments) != _ARGUMENTS[name]:
            message = f"{name} takes {_ARGUMENTS[name]} argument{'s' if _ARGUMENTS[name] > 1 else ''}"
            raise self.source.error(message, parts[0].start_pos or 0, "set them apart by commas")
        return Node("call", tuple(arguments), text=name)


# -- a tree as text ---------------------------------------------------------------------------------------------------

_BINDING = {"sum": 0, "negative": 1, "product": 2, "quotient": 2, "power": 3, "primed": 4}


def written(node: Node, above: int = 0, *, tight: bool = False) -> str:
    """Return the text of a tree; `tight` inside brackets, where a space sets entries apart."""
    text = _written(node, tight=tight)
    return f"({text})" if _BINDING.get(node.kind, 5) < above else text


def _written(node: Node, *, tight: bool) -> str:
    parts = node.parts
    match node.kind:
        case "number" | "letter":
            return node.text
        case "sum":
            plus, minus = ("+", "-") if tight else (" + ", " - ")
            terms = [written(parts[0], tight=tight)]
            for part in parts[1:]:
                negative = part.kind == "negative"
                inner = part.parts[0] if negative else part
                terms.append((minus if negative else plus) + written(inner, 1, tight=tight))
            return "".join(terms)
        case "negative":
            return "-" + written(parts[0], 2, tight=tight)
        case "product":
            factors = [
                written(part, 3 if i and part.kind == "quotient" else 2, tight=tight) for i, part in enumerate(parts)
            ]
            return ("*" if tight else " ").join(factors)
        case "quotient":
            return f"{written(parts[0], 2, tight=tight)}/{written(parts[1], 3, tight=tight)}"
        case "power":
            return f"{written(parts[0], 4, tight=tight)}^{node.text}"
        case "primed":
            return f"{written(parts[0], 3, tight=tight)}'"
        case "call":
            return f"{node.text}({', '.join(written(part) for part in parts)})"
        case "row":
            return " ".join(written(part, tight=True) for part in parts)
        case _:
            return "[" + "; ".join(map(_row_written, parts)) + "]"


def _row_written(row: Node) -> str:
    return " ".join(written(part, tight=True) for part in row.parts)


def with_part(node: Node, index: int, part: Node) -> Node:
    """Return the node with one part replaced."""
    return replace(node, parts=(*node.parts[:index], part, *node.parts[index + 1 :]))
