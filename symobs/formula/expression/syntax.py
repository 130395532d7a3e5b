"""Second step: the tree, by precedence alone.

    sum     term, then + or - and a term, from the left
    term    ± term, or a product: -A B is -(A B)
    product signed, then * or / and a signed, from the left
    signed  ± signed, or a primed, or primed ^ signed: -2^2 is -(2^2), 2^-1 is 1/2, and powers associate to the right
    primed  atom, then ' or the argument of a function: A^-1' is the transpose of A^-1
    atom    a value, (sum), f(sum, sum, …), or [row; row; …] with a row of sums set apart by commas

One loop reads problem files and printed equations alike.  Nothing recurses: a text may hold a thousand signs in a row.
"""

from __future__ import annotations

import re
from dataclasses import field
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Complex, Scalar
from symobs.formula.expression.source import shown
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import ShapeMismatch

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.expression.source import Source, Token
    from symobs.ground.errors import InputError


# The syntax tree of an expression, before evaluation.


@dataclass
class SyntaxNode:
    """A part of an expression, as it is written.

    number (`text`, `value`), letter (`text`, no value yet), sum, product, negative, quotient, power (base, exponent), primed,
    at (a function and its argument), block of rows, row, call (`text` is the function).  `places` says where its operators
    stand, or where its text begins; it is no part of what the node is.
    """

    kind: str
    parts: tuple[SyntaxNode, ...] = ()
    text: str = ""
    value: Scalar | Complex | None = None
    places: tuple[int, ...] = field(default=(), compare=False)

    def __str__(self) -> str:
        return written(self)


def every(node: SyntaxNode) -> Iterator[SyntaxNode]:
    """Yield a node and all below it, from the left; a tree that is too deep is still counted."""
    waiting = [node]
    while waiting:
        yield (first := waiting.pop())
        waiting += reversed(first.parts)


def operands_first(node: SyntaxNode) -> Iterator[SyntaxNode]:
    """Yield a node and all below it, each after its parts, from the left; nothing recurses."""
    waiting, found = [node], []
    while waiting:
        found.append(last := waiting.pop())
        waiting += last.parts
    return reversed(found)


def letters_of(*nodes: SyntaxNode) -> list[str]:
    """Return the letters of these trees, each once, in the order in which they stand."""
    return list(dict.fromkeys(part.text for node in nodes for part in every(node) if part.kind == "letter"))


def with_part(node: SyntaxNode, index: int, part: SyntaxNode) -> SyntaxNode:
    """Return the node with one part replaced."""
    parts = (*node.parts[:index], part, *node.parts[index + 1 :])
    return SyntaxNode(node.kind, parts, node.text, node.value, node.places)


def exponent_of(node: SyntaxNode) -> int | None:
    """Return the integer that stands as the exponent of a power; None where another expression does."""
    exponent = node.parts[1]
    sign, number = (-1, exponent.parts[0]) if exponent.kind == "negative" else (1, exponent)
    whole = isinstance(number.value, Scalar) and number.value.is_constant and number.value.fraction().denominator == 1
    return sign * int(number.value.fraction()) if whole else None  # type: ignore[union-attr]


# -- a tree as text ---------------------------------------------------------------------------------------------------

_BINDING_OF_NODES = {"sum": 0, "negative": 1, "product": 2, "quotient": 2, "power": 3, "primed": 4}


def written(node: SyntaxNode, above: int = 0, *, tight: bool = False) -> str:
    """Return the text of a tree; `tight` inside brackets, where a space sets entries apart."""
    text = _written(node, tight=tight)
    return f"({text})" if _BINDING_OF_NODES.get(node.kind, 5) < above else text


def _written(node: SyntaxNode, *, tight: bool) -> str:
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
            return _product(parts, tight=tight)
        case "quotient":
            return f"{written(parts[0], 2, tight=tight)}/{written(parts[1], 3, tight=tight)}"
        case "power":
            exponent = written(parts[1], 1 if parts[1].kind == "negative" else 3, tight=tight)
            return f"{written(parts[0], 4, tight=tight)}^{exponent}"
        case "primed":
            return f"{written(parts[0], 3, tight=tight)}'"
        case "at":
            return f"{written(parts[0], 4, tight=tight)}({written(parts[1])})"
        case "call":
            return f"{node.text}({', '.join(written(part) for part in parts)})"
        case "row":
            return " ".join(written(part, tight=True) for part in parts)
        case _:
            return "[" + "; ".join(" ".join(written(part, tight=True) for part in row.parts) for row in parts) + "]"


def _product(parts: tuple[SyntaxNode, ...], *, tight: bool) -> str:
    """Return factors side by side; after a division they need their sign."""
    text = written(parts[0], 2, tight=tight)
    for before, part in pairwise(parts):
        sign = "*" if tight or before.kind == "quotient" else " "
        text += sign + written(part, 3 if part.kind == "quotient" else 2, tight=tight)
    return text


_BINDING = {"ADD": 1, "sign": 2, "MULTIPLY": 3, "inner sign": 4, "POWER": 5, "APPLY": 6}
_OPERAND_STARTS = ("VALUE", "FUNCTION", "_OPEN", "LEFT")
_OPERAND_ENDS = ("VALUE", "_CLOSE", "_RIGHT", "PRIME")
#: A sign behind one of these belongs to the one operand that follows, not to the whole term.
_BEFORE_INNER_SIGN = ("MULTIPLY", "POWER", "inner sign")
EQUAL_ROWS = "give every row the same number of entries"
#: Outside brackets `2 g` and `C A` are products, inside they are two entries.
_DECIMAL_COMMA = re.compile(r"(?<![0-9,.])[0-9]+,[0-9]+(?![0-9,.])")
_SPACED_PRODUCT = re.compile(r"([0-9]|\b[A-Z]) +([A-Za-z(])")


class _Waiting(NamedTuple):
    """An operator whose right operand is not complete, or a bracket still open."""

    kind: str
    token: Token


def parse(tokens: Sequence[Token], source: Source, apart: str = "_COMMA") -> tuple[SyntaxNode, ...]:
    """Return the trees of a text's entries, which tokens of the type `apart` set apart; raises ExpressionError.

    Brackets are matched already, and between two operands there is an operator or a comma (`tokens`).
    """
    return _Parser(source, apart).entries(tokens)


class _Parser:
    """Construction of the tree.  Invariant: `operands` are complete and belong to the operators in `waiting`."""

    def __init__(self, source: Source, apart: str) -> None:
        self.source = source
        self.apart = apart
        self.operands: list[SyntaxNode] = []
        self.waiting: list[_Waiting] = []
        #: How many entries each row has so far, of the whole text and of every bracket still open.
        self.lengths = [[1]]

    def entries(self, tokens: Sequence[Token]) -> tuple[SyntaxNode, ...]:
        """Return the trees of all entries."""
        operand = False  # whether one has just ended
        for token in tokens:
            begins = token.type in _OPERAND_STARTS or (token.type == "ADD" and not operand)
            if begins is operand:
                raise self._unexpected(token)
            self._take(token, operand=operand)
            operand = token.type in _OPERAND_ENDS
        if not operand:
            raise self._unexpected(None)
        self._complete()
        return tuple(self.operands)

    def _take(self, token: Token, *, operand: bool) -> None:
        match kind := token.type:
            case "VALUE":
                leaf = "letter" if token.value is None else "number"
                self.operands.append(SyntaxNode(leaf, text=str(token), value=token.value, places=(token.start,)))
            case "FUNCTION" | "_OPEN" | "LEFT":
                self.waiting.append(_Waiting(kind, token))
                if kind != "FUNCTION":
                    self.lengths.append([1])
            case "ADD" if not operand:
                inner = bool(self.waiting) and self.waiting[-1].kind in _BEFORE_INNER_SIGN
                self.waiting.append(_Waiting("inner sign" if inner else "sign", token))
            case "ADD" | "MULTIPLY" | "POWER" | "APPLY":
                self._complete(_BINDING[kind] + (kind == "POWER"))
                self.waiting.append(_Waiting(kind, token))
            case "PRIME":
                self._end_power()
                self.operands.append(SyntaxNode("primed", (self.operands.pop(),), places=(token.start,)))
            case _:
                self._complete()
                self._close(token)

    def _complete(self, binding: int = 0) -> None:
        """Build the operators since the last open bracket that bind at least as strongly as the next one."""
        while self.waiting and _BINDING.get(self.waiting[-1].kind, -1) >= binding:
            self._build(*self.waiting.pop())

    def _end_power(self) -> None:
        """Build the power before a prime, with the signs of its exponent: the whole is primed."""
        while True:
            place = len(self.waiting) - 1
            while place >= 0 and self.waiting[place].kind == "inner sign":
                place -= 1
            if place < 0 or self.waiting[place].kind not in ("POWER", "APPLY"):
                return
            while len(self.waiting) > place:
                self._build(*self.waiting.pop())

    def _build(self, kind: str, token: Token) -> None:
        place = (token.start,)
        last = self.operands.pop()
        match kind:
            case "sign" | "inner sign":
                found = SyntaxNode("negative", (last,), places=place) if token == "-" else last  # noqa: S105 - of the text
            case "POWER":
                found = SyntaxNode("power", (self.operands.pop(), last), places=place)
            case "APPLY":
                found = SyntaxNode("at", (self.operands.pop(), last), places=place)
            case _ if token == "/":  # noqa: S105
                found = SyntaxNode("quotient", (self.operands.pop(), last), places=place)
            case _:
                right = SyntaxNode("negative", (last,), places=place) if token == "-" else last  # noqa: S105
                found = _joined("sum" if kind == "ADD" else "product", self.operands.pop(), right, place)
        self.operands.append(found)

    def _close(self, token: Token) -> None:
        """Take the end of an entry: a comma or "=", the end of a row, a closing bracket."""
        kind, inside = token.type, self.waiting[-1].kind if self.waiting else ""
        if kind in ("_COMMA", "_EQUAL"):
            called = inside == "_OPEN" and len(self.waiting) > 1 and self.waiting[-2].kind == "FUNCTION"
            if not (inside == "LEFT" or called if inside else kind == self.apart):
                raise self._unexpected(token)
            self.lengths[-1][-1] += 1
        elif kind == "_END":
            self.lengths[-1].append(1)
        elif kind == "_RIGHT":
            self._block(self.waiting.pop().token, self.lengths.pop())
        else:
            self.waiting.pop()
            (count,) = self.lengths.pop()
            if self.waiting and self.waiting[-1].kind == "FUNCTION":
                called_by = self.waiting.pop().token
                arguments = self._taken(count)
                self.operands.append(SyntaxNode("call", arguments, text=str(called_by), places=(called_by.start,)))

    def _block(self, left: Token, lengths: Sequence[int]) -> None:
        entries = iter(self._taken(sum(lengths)))
        rows = [[next(entries) for _ in range(length)] for length in lengths]
        unequal = unequal_row(rows)
        if unequal:
            spaced = _SPACED_PRODUCT.search(self.source.text)
            meant = f"; a space sets entries apart, so write {spaced[1]}*{spaced[2]}… for a product" if spaced else ""
            if comma := _DECIMAL_COMMA.search(self.source.text):
                meant = f"; decimals have a point: {comma[0].replace(',', '.')}"
            raise self.source.error(unequal[0], left.start, EQUAL_ROWS + meant, kind=ShapeMismatch, row=unequal[1])
        nodes = tuple(SyntaxNode("row", tuple(row)) for row in rows)
        self.operands.append(SyntaxNode("block", nodes, places=(left.start,)))

    def _taken(self, count: int) -> tuple[SyntaxNode, ...]:
        """Return the last operands, which are taken off the stack."""
        start = len(self.operands) - count
        found = tuple(self.operands[start:])
        del self.operands[start:]
        return found

    def _unexpected(self, token: Token | None) -> InputError:
        place = "at the end" if token is None else f'before "{shown(token)}"'
        position = len(self.source.text) if token is None else token.start
        return self.source.error(f'a number, a name or "(" is expected {place}', position, "write one there")


def _joined(kind: str, left: SyntaxNode, right: SyntaxNode, place: tuple[int, ...]) -> SyntaxNode:
    """Return a sum or a product of all terms of both sides."""
    (first, before), (last, behind) = (
        (each.parts, each.places) if each.kind == kind else ((each,), ()) for each in (left, right)
    )
    return SyntaxNode(kind, (*first, *last), places=(*before, *place, *behind))


def unequal_row(rows: Sequence[Sequence[object]]) -> tuple[str, int] | None:
    """Return the message on the first row whose length differs from row 1, and its number."""
    for number, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            entries = "1 entry" if len(row) == 1 else f"{len(row)} entries"
            return f"row {number} has {entries}, but row 1 has {len(rows[0])}", number
    return None
