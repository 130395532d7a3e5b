"""Text in SVG: letters of mathematics in italics, sub- and superscripts smaller and off the line."""

from __future__ import annotations

import re
import unicodedata
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple
from xml.sax.saxutils import escape

from symobs.render.plots.scene import coordinate

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

FONTS = "'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif"
#: Sub- and superscripts: their size, and how far they are lowered, in parts of the size of the font.
_SCRIPT, _LOWERED = 0.72, {"sub": 0.2, "super": -0.36, "": 0.0, "dot": -0.2}
#: The character after this one stands below the letter before, upright.
BELOW = "\ue000"
#: A dot above an accent: fonts put both at one place, so it is a character of its own, set back over the letter.
DOT, _SET_BACK = "\ue001", 0.36
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
    is_math: bool


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
        text = escape("".join(character for character, _, _ in run)).replace(DOT, "˙")
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
