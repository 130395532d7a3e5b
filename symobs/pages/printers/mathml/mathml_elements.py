"""Elements of MathML, and the line breaks between them.

Signs carry their form (prefix, infix or postfix), because a line that was broken may begin or end with one.
"""

from __future__ import annotations

import re
from html import escape
from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.formula.notation import OPERATORS

if TYPE_CHECKING:
    from collections.abc import Iterator

THIN = '<mspace width="0.17em"/>'
MINUS, PLUS = "−", "+"
#: Signs that are read out, not seen: between a function's name and its argument, and between factors.
APPLY = "<mo>&#x2061;</mo>"
TIMES = "<mo>&#x2062;</mo>"
TIMES_OR_BREAK = '<mo form="infix">&#x2062;</mo>'
OPENING = '<mo form="prefix" stretchy="false">(</mo>'
CLOSING = '<mo form="postfix" stretchy="false">)</mo>'
LIST = '<mo form="prefix" stretchy="false">[</mo>', '<mo form="postfix" stretchy="false">]</mo>'
DOT = '<mo form="infix">⋅</mo>'
SLASH = '<mo form="infix" lspace="0" rspace="0">/</mo>'
BAR = '<mo form="postfix" fence="true" stretchy="true">|</mo>'
COMMA = '<mo separator="true">,</mo>'
SEMICOLON = '<mo separator="true">;</mo>'
#: Makes a row of a matrix as high as one of letters with a descender, so that rows of digits stand at its middle.
STRUT = '<mspace height="0.72em" depth="0.22em"/>'
LARGE = ' displaystyle="true"'
TRANSPOSE = "<mi>\N{MATHEMATICAL SANS-SERIF CAPITAL T}</mi>"
BINARY = {sign: f'<mo form="infix">{sign}</mo>' for sign in (PLUS, MINUS)}
RELATIONS = {key: f'<mo form="infix">{escape(sign)}</mo>' for key, (_, sign) in OPERATORS.items()} | {
    "~": '<mo form="infix">\N{TILDE OPERATOR}</mo>'
}

#: A formula in running text is kept whole up to the first width (in em), broken after relations up to the second.
_KEPT, _AT_RELATIONS = 9.0, 15.0
_FEW = frozenset(RELATIONS.values())
_MANY = _FEW | {*BINARY.values(), TIMES_OR_BREAK, COMMA, SEMICOLON, SLASH}


def row(elements: tuple[str, ...]) -> str:
    """Return elements as one."""
    return elements[0] if len(elements) == 1 else f"<mrow>{''.join(elements)}</mrow>"


def text(words: str) -> str:
    """Return upright text, spaces at its ends included."""
    return f"<mtext>{escape(words).replace(' ', '&#xA0;')}</mtext>"


def table(rows: list[str], kind: str) -> str:
    """Return lines as a table of a kind of the page's style: `aligned`, `centred` or `lines`."""
    return f'<mtable class="{kind}" displaystyle="true">{"".join(f"<mtr>{line}</mtr>" for line in rows)}</mtable>'


def pieces(elements: tuple[str, ...], width: float) -> Iterator[str]:
    """Yield the pieces of a formula in running text between line breaks."""
    breaks: frozenset[str] = frozenset()
    if width > _KEPT:
        breaks = _MANY if width > _AT_RELATIONS else _FEW
    piece = [elements[0]]
    for before, element in pairwise(elements):
        is_inside_number = before.startswith("<mn>") and element.startswith("<mn>")
        if before in breaks or is_inside_number:
            yield "".join(piece)
            piece = []
        piece.append(element)
    yield "".join(piece)


def is_word(element: str) -> bool:
    """Return whether an element is a name of several letters."""
    return re.match(r"<m(?:sub><m)?i>[^<]{2,}</mi>", element) is not None


def ruled_edges(above: bool, before: bool) -> str:  # noqa: FBT001 - two edges of a cell
    """Return the class of a cell with lines at its edges: attributes of tables for them are not in MathML Core."""
    names = " ".join(name for name, drawn in (("top", above), ("left", before)) if drawn)
    return f' class="{names}"' if names else ""


def sized(opening: str, closing: str, size: str) -> tuple[str, str]:
    """Return a pair of fences of one size."""
    attributes = f'stretchy="true" symmetric="true" minsize="{size}" maxsize="{size}"'
    return (
        f'<mo form="prefix" {attributes}>{opening}</mo>',
        f'<mo form="postfix" {attributes}>{closing}</mo>',
    )
