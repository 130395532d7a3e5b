"""Text in SVG: letters of mathematics in italics, sub- and superscripts smaller and off the line."""

from __future__ import annotations

import re
import unicodedata
from html import escape
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Scalar
from symobs.formula.figures.block_diagram import without_sign
from symobs.formula.tree import Conjunction, Literal, Quotient
from symobs.pages.drawings.scene import coordinate
from symobs.pages.printers.glyphs import Level
from symobs.pages.printers.scalar_formula import formula_of
from symobs.pages.printers.text_printer import TextBox, TextPrinter, text_box

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.formula.tree import Formula, Relation
    from symobs.pages.drawings.scene import Content

FONTS = "'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif"
#: Sub- and superscripts: their size, and how far they are lowered, in parts of the size of the font.
_SCRIPT, _LOWERED = 0.72, {"sub": 0.2, "super": -0.36, "": 0.0, "dot": -0.2}
#: The character after this one stands below the letter before, upright.
BELOW = "\ue000"
#: A dot above an accent: fonts put both at one place, so it is a character of its own, set back over the letter.
DOT, _SET_BACK = "\ue001", 0.36
_ACCENT_DOT, _THIN_SPACE = "\u0307", "\u2009"
#: Two factors side by side; what stands below a letter on a terminal: K_d, χ_(A-BK).
_FACTORS = re.compile(r"(?<=[^-+=·,;]) (?=[^-+=·])")
_BELOW = re.compile(r"_\(?([\w-]+)\)?")
#: In parts of the size of the font: the height of a line, of a fraction, and what a rule is longer than its fraction.
_LINE, _FRACTION, _RULE = 1.3, 2.7, 0.3
#: Names of several letters, such as Re, stand upright.
_WORDS = re.compile(r"[A-Za-z]{2,}")
_SPECIAL_WIDTHS = {
    **dict.fromkeys("ijlIft.,:;!|'()[]/ ", 0.36),
    **dict.fromkeys("mwMW", 0.9),
    **dict.fromkeys("+−=<>≤≥≠±", 0.68),
}


class TextRun(NamedTuple):
    """A part of a line of text; letters of mathematics are set in italics."""

    text: str
    is_math: bool = False


class TextRow(NamedTuple):
    """A line of text, and below a rule another one where it is a fraction, with its sign before it."""

    text: TextRun
    below: TextRun | None = None
    lead: TextRun = TextRun("")

    @property
    def height(self) -> float:
        """In parts of the size of the font."""
        return _FRACTION if self.below else _LINE

    @property
    def width(self) -> float:
        """In parts of the size of the font."""
        widest = max(width_of([run], 1.0) for run in (self.text, self.below) if run)
        return widest + width_of([self.lead], 1.0) + (_RULE if self.below else 0)


class Letters(TextPrinter):
    """Formulas on one line as on a terminal, derivatives with a dot."""

    def letter(self, name: str, mark: str) -> TextBox:
        """Return a letter, with a dot above an existing accent."""
        if mark == "dot":
            text = self.letter_text(name)
            return text_box(text + (DOT if unicodedata.combining(text[-1]) else _ACCENT_DOT), Level.POWER)
        return super().letter(name, mark)


def rows_of(content: Content, printer: TextPrinter, *, stacked: bool = False) -> list[TextRow]:
    """Return what is written in rows; with `stacked` a fraction has a rule and thin spaces stand between factors."""
    if isinstance(content, str):
        return [TextRow(TextRun(content.replace("-", "−")))]
    if isinstance(content, Conjunction):
        return [TextRow(_run(relation, printer)) for relation in content.relations]
    if not stacked:
        return [TextRow(TextRun(text_of(content, printer), is_math=True))]
    negative, body = without_sign(content)  # type: ignore[arg-type]
    if isinstance(body, Literal) and isinstance(body.value, Scalar):
        is_written_negative, body = without_sign(formula_of(body.value, printer.variable))
        negative = negative != is_written_negative
    if isinstance(body, Quotient):
        return [
            TextRow(_run(body.numerator, printer), _run(body.denominator, printer), TextRun("−" if negative else ""))
        ]
    return [TextRow(_run(content, printer))]


def _run(item: Formula | Relation, printer: TextPrinter) -> TextRun:
    return TextRun(_FACTORS.sub(_THIN_SPACE, text_of(item, printer)), is_math=True)


def text_of(item: Formula | Relation, printer: TextPrinter) -> str:
    """Return mathematics on one line, with subscripts marked."""
    written = printer.inline(item).replace("-", "−")
    return _BELOW.sub(lambda found: "".join(BELOW + character for character in found[1]), written)


def width_of(pieces: Iterable[TextRun], size: float) -> float:
    """Return a generous estimate of the width of text, for unknown fonts; accents have no width."""
    return size * sum(
        (_SCRIPT if level else 1.0) * _SPECIAL_WIDTHS.get(character, 0.56)
        for piece in pieces
        for character, level, _ in _characters(piece)
        if not unicodedata.combining(character) and character != DOT
    )


def spans(pieces: Iterable[TextRun], size: float) -> str:
    """Return the content of a text element, with sub- and superscripts shifted."""
    written: list[str] = []
    before = 0.0
    every = (character for piece in pieces for character in _characters(piece))
    for (level, is_italic), run in groupby(every, key=lambda item: item[1:]):
        text = escape("".join(character for character, _, _ in run), quote=False).replace(DOT, "˙")
        lowered = _LOWERED[level] * size
        attributes = [f'dy="{coordinate(lowered - before)}"'] if lowered != before else []
        attributes += [f'dx="{coordinate(-_SET_BACK * size)}"'] if level == "dot" else []
        attributes += [f'font-size="{coordinate(_SCRIPT * size)}"'] if level in {"sub", "super"} else []
        attributes += ['font-style="italic"'] if is_italic else []
        written.append(f"<tspan {' '.join(attributes)}>{text}</tspan>" if attributes else text)
        before = lowered
    return "".join(written)


def _characters(piece: TextRun) -> Iterator[tuple[str, str, bool]]:
    """Yield every character, whether it is a sub- or superscript, and whether it is set in italics."""
    words = {place for word in _WORDS.finditer(piece.text) for place in range(*word.span())}
    is_italic = False
    for place, character in enumerate(piece.text):
        form = unicodedata.decomposition(character)
        level = {"<sub>": "sub", "<super>": "super"}.get(form.partition(" ")[0], "")
        plain = unicodedata.normalize("NFKC", character) if level else character
        if character == BELOW:
            continue
        if character == DOT:
            yield character, "dot", False
            continue
        if place and piece.text[place - 1] == BELOW:
            yield character, "sub", False
            continue
        if not unicodedata.combining(character):  # an accent goes with its letter
            is_italic = piece.is_math and plain.isalpha() and place not in words
        yield plain, level, is_italic
