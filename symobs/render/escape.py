r"""Text from outside made harmless for TeX: the one function every title, source and word passes through.

Nothing in it is interpreted: `$x^2$` comes out as those five characters.  What the built-in templates (pdfLaTeX,
UTF-8, no further fonts) cannot show becomes a visible `?`.
"""

from __future__ import annotations

import re
import unicodedata

_SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "^": r"\textasciicircum{}",
    "_": r"\_",
    "~": r"\textasciitilde{}",
    "%": r"\%",
    # Not special, but other characters in TeX's oldest text font.
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    "`": r"\textasciigrave{}",
}
_TYPOGRAPHY = {
    "“": "``",
    "”": "''",
    "‘": "`",
    "’": "'",
    "‐": "-",
    "‑": "-",
    "–": "--",
    "—": "---",
    "…": r"\dots{}",
    "§": r"\S{}",
    "©": r"\copyright{}",
}
_GREEK = {
    chr(code): name
    for code, name in zip(
        [*range(0x3B1, 0x3BF), *range(0x3C0, 0x3CA), *map(ord, "ΓΔΘΛΞΠΣΥΦΨΩϑϕϵ")],
        (
            "alpha beta gamma delta varepsilon zeta eta theta iota kappa lambda mu nu xi pi rho varsigma sigma tau "
            "upsilon varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Upsilon Phi Psi Omega vartheta phi epsilon"
        ).split(),
        strict=True,
    )
}
_MATHEMATICS = {character: rf"\{name}" for character, name in _GREEK.items()} | {
    "µ": r"\mu",
    "−": "-",
    "×": r"\times",
    "÷": r"\div",
    "±": r"\pm",
    "·": r"\cdot",
    "°": r"^\circ",
    "²": "^2",
    "³": "^3",
    "¹": "^1",
    "½": r"\tfrac12",
    "∞": r"\infty",
    "√": r"\surd",
    "≠": r"\neq",
    "≤": r"\le",
    "≥": r"\ge",
    "≈": r"\approx",
    "→": r"\to",
    "∈": r"\in",
    "ℝ": r"\mathbb R",
    "𝒪": r"\mathcal O",
    "𝒞": r"\mathcal C",
}
_ACCENTS = {"\u0302": r"\hat", "\u0303": r"\tilde", "\u0304": r"\bar", "\u0307": r"\dot", "\u0308": r"\ddot"}
#: Letters that LaTeX knows in UTF-8 without a package; a test typesets every one.
LETTERS = frozenset(
    "¡¿ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÑÒÓÔÕÖØÙÚÛÜÝßàáâãäåæçèéêëìíîïñòóôõöøùúûüýÿĀāĂăĆćĈĉĊċČčĎďĒēĔĕĖėĚěĜĝĞğĠġĢģĤĥĨĩĪīĬĭİıĴĵĶķĹĺĻļĽľŁł"
    "ŃńŅņŇňŌōŎŏŐőŒœŔŕŖŗŘřŚśŜŝŞşŠšŢţŤťŨũŪūŬŭŮůŰűŴŵŶŷŸŹźŻżŽžȘșȚț"
)

_CLUSTER = re.compile("(.)([\u0300-\u036f]*)", re.DOTALL)
_OPENING_QUOTE = re.compile(r'(?:^|(?<=[\s(\[{]))"')
_RUN_TOGETHER = {"--", "''", "``", "?`", "!`"}  # TeX makes one character of each
_LONG_WORD = 40  # characters; a longer one must be allowed to break, or it leaves the page
_PIECE = 20


def escape(text: str) -> str:
    """Return LaTeX that shows the text as it is, on one line."""
    line = unicodedata.normalize("NFC", " ".join(text.split()))
    quoted = _OPENING_QUOTE.sub("“", line).replace('"', "”")
    return " ".join(_word(word) for word in quoted.split(" "))


def _word(word: str) -> str:
    """Return one word, with places to break where it is very long, and no two characters run into a third."""
    pieces: list[str] = []
    clusters = [_cluster(*match.groups()) for match in _CLUSTER.finditer(word)]
    for place, piece in enumerate(clusters):
        if len(clusters) > _LONG_WORD and place and place % _PIECE == 0:
            pieces.append(r"\allowbreak{}")
        elif pieces and pieces[-1][-1:] + piece[:1] in _RUN_TOGETHER:
            pieces.append("{}")
        pieces.append(piece)
    return "".join(pieces)


def _cluster(character: str, marks: str) -> str:
    """Return the LaTeX of one character and the combining marks after it."""
    if not marks:
        return _character(character)
    if len(marks) == 1 and marks in _ACCENTS and (plain := _mathematics(character)):
        return rf"${_ACCENTS[marks]} {plain}$"
    return "?"


def _character(character: str) -> str:
    if character in _SPECIAL:
        return _SPECIAL[character]
    if character.isascii():
        return character if character.isprintable() else ""
    if character in LETTERS:
        return character
    if character in _TYPOGRAPHY:
        return _TYPOGRAPHY[character]
    if character in _MATHEMATICS:
        return f"${_MATHEMATICS[character]}$"
    base, *marks = unicodedata.normalize("NFD", character)
    if len(marks) == 1:
        return _cluster(base, marks[0])
    return "" if unicodedata.category(character) in {"Cc", "Cf"} else "?"


def _mathematics(character: str) -> str:
    """Return a letter as mathematics, or nothing where it is none."""
    return character if character.isascii() and character.isalpha() else _MATHEMATICS.get(character, "")
