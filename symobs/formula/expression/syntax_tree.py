"""The syntax tree of an expression, before evaluation."""

from __future__ import annotations

from dataclasses import field
from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.exact import Complex, Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator


@dataclass(frozen=True)
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

_BINDING = {"sum": 0, "negative": 1, "product": 2, "quotient": 2, "power": 3, "primed": 4}


def written(node: SyntaxNode, above: int = 0, *, tight: bool = False) -> str:
    """Return the text of a tree; `tight` inside brackets, where a space sets entries apart."""
    text = _written(node, tight=tight)
    return f"({text})" if _BINDING.get(node.kind, 5) < above else text


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
