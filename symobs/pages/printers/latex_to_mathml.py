"""Letters as MathML, from the LaTeX of the notation.

Only what forms of letters are made of is read: letters, digits, sub- and superscripts, accents, alphabets, names of
functions, parentheses.  Anything else is shown as the text it is; nothing raises, and all text is escaped.
"""

from __future__ import annotations

import re
import unicodedata
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from html import escape
from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.formula.notation import GREEK, OPERATORS, symbol_text
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator


# Elements of MathML, and the line breaks between them.
#
# Signs carry their form (prefix, infix or postfix), because a line that was broken may begin or end with one.


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


_PIECE = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:(?:\.|\{,\})\d+)?|.", re.DOTALL)


_LETTERS = {name: symbol_text(name) for name in GREEK} | {
    "varepsilon": "ε",
    "epsilon": "\N{GREEK LUNATE EPSILON SYMBOL}",
    "vartheta": "ϑ",
    "varphi": "φ",
    "partial": "∂",
    "phi": "ϕ",
    "ell": "\N{SCRIPT SMALL L}",
}


_SIGNS = {
    "ldots": "…",
    "cdot": "⋅",
    "times": "×",
    "ast": "\N{ASTERISK OPERATOR}",
    "*": "\N{ASTERISK OPERATOR}",
    "star": "⋆",
    "prime": "′",
    "'": "′",
    "dagger": "†",
    "top": "\N{DOWN TACK}",
    "le": "≤",
    "ge": "≥",
    "neq": "≠",
    "sim": "\N{TILDE OPERATOR}",
    "infty": "∞",
}


_ACCENTS = {
    "hat": "\N{MODIFIER LETTER CIRCUMFLEX ACCENT}",
    "widehat": "\N{MODIFIER LETTER CIRCUMFLEX ACCENT}",
    "tilde": "\N{SMALL TILDE}",
    "widetilde": "\N{SMALL TILDE}",
    "bar": "¯",
    "overline": "¯",
    "vec": "→",
    "dot": ".",
    "ddot": "..",
    "check": "ˇ",
    "breve": "˘",
    "acute": "\N{ACUTE ACCENT}",
    "grave": "`",
}


_FUNCTIONS = frozenset(("det", "sin", "cos", "sinh", "cosh", "exp", "rank", "tan", "ln", "min", "max"))
_SPACES = frozenset((" ", "\\,", "\\;", "\\ ", "\\!"))


#: What Unicode calls the alphabets of mathematics; some letters had a place, under another name, before them.
_ALPHABETS = {
    "mathcal": ("MATHEMATICAL SCRIPT", "SCRIPT"),
    "mathbf": ("MATHEMATICAL BOLD",),
    "boldsymbol": ("MATHEMATICAL BOLD ITALIC",),
    "mathsf": ("MATHEMATICAL SANS-SERIF",),
    "mathbb": ("MATHEMATICAL DOUBLE-STRUCK", "DOUBLE-STRUCK"),
    "mathit": ("MATHEMATICAL ITALIC",),
    "mathfrak": ("MATHEMATICAL FRAKTUR", "BLACK-LETTER"),
}


@dataclass
class LatexPart:
    """One part of a form: an element with its sub- and superscript."""

    base: str
    below: str = ""
    above: str = ""

    @property
    def written(self) -> str:
        """The part as one element."""
        if self.below and self.above:
            return f"<msubsup>{self.base}{self.below}{self.above}</msubsup>"
        if self.below:
            return f"<msub>{self.base}{self.below}</msub>"
        return f"<msup>{self.base}{self.above}</msup>" if self.above else self.base


@lru_cache(maxsize=1024)
def parts_of(form: str) -> tuple[LatexPart, ...]:
    """Return the parts of a form, at least one."""
    return tuple(_Reader(form).sequence()) or (LatexPart("<mrow></mrow>"),)


def elements_of(form: str) -> tuple[str, ...]:
    """Return the elements of a form."""
    return tuple(part.written for part in parts_of(form))


def accented(part: LatexPart, accent: str) -> LatexPart:
    """Return a part with an accent such as `dot` on the letter itself, not on its index."""
    return replace(part, base=_over(part.base, _ACCENTS[accent]))


def indexed(part: LatexPart, index: str) -> LatexPart:
    """Return a part with a further index."""
    further = elements_of(index)
    return replace(part, below=row((part.below, "<mo>,</mo>", *further) if part.below else further))


def _over(base: str, mark: str) -> str:
    """Put a mark over an element, bars and dots as limits, since browsers set accents too close."""
    accent = "" if mark[0] in ".¯" else ' accent="true"'
    return f'<mover{accent}>{base}<mo stretchy="false">{mark}</mo></mover>'


class _Reader:
    """A parser of forms."""

    def __init__(self, form: str) -> None:
        self.pieces: list[str] = _PIECE.findall(form)
        self.place = 0

    def sequence(self, closing: str = "") -> list[LatexPart]:
        """Return the parts up to a closing brace, or to the end."""
        parts: list[LatexPart] = []
        while self.place < len(self.pieces):
            piece = self.next()
            if piece in _SPACES or (piece == "}" and not closing):
                continue
            if piece == closing:
                break
            if piece in "^_":
                self.script(parts, piece)
            else:
                parts += self.part(piece)
        return parts

    def next(self) -> str:
        """Return the next piece, an empty one at the end."""
        piece = self.pieces[self.place] if self.place < len(self.pieces) else ""
        self.place += 1
        return piece

    def script(self, parts: list[LatexPart], piece: str) -> None:
        """Put a script to the part before it."""
        last = parts.pop() if parts else LatexPart("<mrow></mrow>")
        script = self.argument()
        if piece == "^":
            parts.append(LatexPart(last.written, "", script) if last.above else replace(last, above=script))
        else:
            parts.append(LatexPart(last.written, script) if last.below else replace(last, below=script))

    def argument(self) -> str:
        """Return the argument of a command or a script as one element: a piece, or a group in braces."""
        while self.place < len(self.pieces) and self.pieces[self.place] in _SPACES:
            self.place += 1
        piece = self.next()
        parts = self.sequence("}") if piece == "{" else self.part(piece)
        return row(tuple(part.written for part in parts)) if parts else "<mrow></mrow>"

    def raw(self) -> str:
        """Return the argument of an alphabet as text."""
        while self.place < len(self.pieces) and self.pieces[self.place] in _SPACES:
            self.place += 1
        piece = self.next()
        if piece != "{":
            return piece[:1]
        words = ""
        while (piece := self.next()) not in {"}", ""}:
            words += piece
        return words

    def part(self, piece: str) -> list[LatexPart]:
        """Return the part of a piece with its argument."""
        name = piece[1:] if piece.startswith("\\") and len(piece) > 1 else ""
        if piece == "{":
            inside = self.sequence("}")
            return inside if len(inside) == 1 else [LatexPart(row(tuple(part.written for part in inside)))]
        if name in _ACCENTS:
            return [LatexPart(_over(self.argument(), _ACCENTS[name]))]
        if name in {"mathrm", "text", "operatorname"}:
            return self.upright(name)
        if name in _ALPHABETS:
            return [LatexPart(_in_alphabet(name, self.raw()))]
        if name in _FUNCTIONS:
            return self.function(name)
        if name == "not":
            return [LatexPart(_sign("≢" if self.next() == r"\equiv" else "≠"))]
        if name in _LETTERS:
            return [LatexPart(f"<mi{_upright(_LETTERS[name])}>{_LETTERS[name]}</mi>")]
        return [LatexPart(_SIGN_ELEMENTS.get(piece) or _plain(name or piece))]

    def upright(self, name: str) -> list[LatexPart]:
        words = self.raw()
        if name == "operatorname":
            return self.function(words)
        if name == "text" or not words.isalpha():
            return [LatexPart(text(words))]
        return [LatexPart(f"<mi{_normal(words)}>{escape(words)}</mi>")]

    def function(self, name: str) -> list[LatexPart]:
        """Return a function's name; a space where its argument has no parentheses."""
        follows = self.pieces[self.place] if self.place < len(self.pieces) else "("
        space = [] if follows == "(" else [LatexPart(APPLY), LatexPart(THIN)]
        return [LatexPart(f"<mi{_normal(name)}>{escape(name)}</mi>"), *space]


def _plain(piece: str) -> str:
    piece = piece.replace("{,}", ",")
    if piece[:1].isdigit():
        return f"<mn>{piece}</mn>"
    if len(piece) == 1 and piece.isalpha():
        return f"<mi>{escape(piece)}</mi>"
    if piece in _SIGNS or piece in "+=<>,|/.:;[]":
        return _sign(_SIGNS.get(piece, piece))
    return text(piece)


def _sign(sign: str) -> str:
    return f"<mo>{escape(sign)}</mo>"


_SIGN_ELEMENTS = {"(": OPENING, ")": CLOSING, "-": "<mo>−</mo>", r"\ldots": "<mi>…</mi>"}


def _normal(word: str) -> str:
    """Return a function's name, a single letter made upright."""
    return ' mathvariant="normal"' if len(word) == 1 else ""


def _upright(letter: str) -> str:
    """Return a letter, capital Greek ones upright as in LaTeX."""
    return ' mathvariant="normal"' if letter.isupper() else ""


def _in_alphabet(name: str, words: str) -> str:
    if name == "mathit" and len(words) == 1:
        return f"<mi>{escape(words)}</mi>"
    return f"<mi>{''.join(escape(_styled(letter, _ALPHABETS[name])) for letter in words)}</mi>"


def _styled(letter: str, alphabets: tuple[str, ...]) -> str:
    """Return a letter in the first alphabet that has it, else the letter itself."""
    kind = "CAPITAL" if letter.isupper() else "SMALL"
    for alphabet in alphabets:
        with suppress(KeyError):
            return unicodedata.lookup(f"{alphabet} {kind} {letter.upper()}")
    return "\N{PLANCK CONSTANT}" if alphabets == _ALPHABETS["mathit"] and letter == "h" else letter
