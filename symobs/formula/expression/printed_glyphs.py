"""The characters with which formulas are printed, read back: ω₀², √3, −1 ± 2 i, a·b."""

from __future__ import annotations

import re
import unicodedata

from symobs.formula.notation import GREEK_LETTERS

#: Signs in place of the minus of ASCII, and blanks in place of its space.
MINUS = "-\u2212\u2010\u2011\u2013"
BLANK = "\u00a0\u2009\u202f\u200b\u2060\ufeff"
SUPERSCRIPTS = "⁰¹²³⁴⁵⁶⁷⁸⁹"
_BELOW = "₀₁₂₃₄₅₆₇₈₉"
_SPELT = {letter: name for name, letter in GREEK_LETTERS.items()} | {
    "ϕ": "phi",
    "ϵ": "epsilon",
    "ϑ": "theta",
    "µ": "mu",
}
_SANS_SERIF = "\U0001d5a0-\U0001d5d3"
#: A name as it is typed, or a Greek letter or one without serifs, with indices below.
PRINTED_NAME = rf"(?:[A-Za-z][A-Za-z0-9_]*|[{''.join(_SPELT)}{_SANS_SERIF}])[{_BELOW}]*"
_PAIR = re.compile(r"([^±]*)±([^±]*)")
_ASCII = (
    str.maketrans(SUPERSCRIPTS, "0123456789")
    | dict.fromkeys(map(ord, MINUS + "⁻"), "-")
    | dict.fromkeys(map(ord, "·⋅×"), "*")
)


def ascii_of(glyphs: str) -> str:
    """Return signs and digits as they are typed: ⁻² is -2, · is *."""
    return glyphs.translate(_ASCII)


def spellings(printed: str) -> tuple[str, ...]:
    """Return the names that are printed like this: ω₀ is omega0 or omega_0."""
    stem = printed.rstrip(_BELOW)
    digits = unicodedata.normalize("NFKC", printed[len(stem) :])
    plain = _SPELT.get(stem) or unicodedata.normalize("NFKC", stem)
    return (plain + digits, f"{plain}_{digits}") if digits else (plain,)


def pairs(pole: object) -> list[object]:
    """Return the two poles of a text -1 ± 2i; any other one alone."""
    pair = _PAIR.fullmatch(pole) if isinstance(pole, str) else None
    return [f"{pair[1]}+{pair[2]}", f"{pair[1]}-{pair[2]}"] if pair else [pole]
