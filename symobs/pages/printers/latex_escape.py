r"""Escaping of external text for TeX: every title, source and word.

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
    "$": r"\symbol{36}",  # \$ takes its sign from a bitmap font, which microtype refuses
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
    "`": r"\`{}",  # an accent on nothing; \textasciigrave is such a sign too
}
_TYPOGRAPHY = {
    "“": "``",
    "”": "''",
    "\N{LEFT SINGLE QUOTATION MARK}": "`",
    "\N{RIGHT SINGLE QUOTATION MARK}": "'",
    "\N{HYPHEN}": "-",
    "\N{NON-BREAKING HYPHEN}": "-",
    "–": "--",
    "—": "---",
    "…": r"\dots{}",
    "\N{NO-BREAK SPACE}": "~",
}
_GREEK = {
    "α": "alpha",
    "β": "beta",
    "γ": "gamma",
    "δ": "delta",
    "ε": "varepsilon",
    "ϵ": "epsilon",
    "ζ": "zeta",
    "η": "eta",
    "θ": "theta",
    "ϑ": "vartheta",
    "\N{GREEK SMALL LETTER IOTA}": "iota",
    "κ": "kappa",
    "λ": "lambda",
    "μ": "mu",
    "µ": "mu",
    "ν": "nu",
    "ξ": "xi",
    "π": "pi",
    "ρ": "rho",
    "ς": "varsigma",
    "σ": "sigma",
    "τ": "tau",
    "\N{GREEK SMALL LETTER UPSILON}": "upsilon",
    "φ": "varphi",
    "ϕ": "phi",
    "χ": "chi",
    "ψ": "psi",
    "ω": "omega",
    "Γ": "Gamma",
    "Δ": "Delta",
    "Θ": "Theta",
    "Λ": "Lambda",
    "Ξ": "Xi",
    "Π": "Pi",
    "Σ": "Sigma",
    "\N{GREEK CAPITAL LETTER UPSILON}": "Upsilon",
    "Φ": "Phi",
    "Ψ": "Psi",
    "Ω": "Omega",
}
_MATHEMATICS = {character: rf"\{name}" for character, name in _GREEK.items()} | {
    "−": "-",
    "§": r"\mathsection",
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
_SHOWN = _SPECIAL | _TYPOGRAPHY | {character: f"${latex}$" for character, latex in _MATHEMATICS.items()}
_ACCENTS = {"\u0302": r"\hat", "\u0303": r"\tilde", "\u0304": r"\bar", "\u0307": r"\dot", "\u0308": r"\ddot"}
#: Letters that LaTeX knows in UTF-8 without a package; a test typesets every one.
LETTERS = frozenset(
    "¡¿ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÑÒÓÔÕÖØÙÚÛÜÝßàáâãäåæçèéêëìíîïñòóôõöøùúûüýÿĀāĂăĆćĈĉĊċČčĎďĒēĔĕĖėĚěĜĝĞğĠġĢģĤĥĨĩĪīĬĭİıĴĵĶķĹĺĻļĽľŁł"
    "ŃńŅņŇňŌōŎŏŐőŒœŔŕŖŗŘřŚśŜŝŞşŠšŢţŤťŨũŪūŬŭŮůŰűŴŵŶŷŸŹźŻżŽžȘșȚț"
)

_WHITE = re.compile(r"[^\S\u00a0]+")
_CLUSTER = re.compile("(.)([\u0300-\u036f]*)", re.DOTALL)
_OPENING_QUOTE = re.compile(r'(?:^|(?<=[\s(\[{]))"')
_RUN_TOGETHER = {"--", "''", "``", "?`", "!`"}  # TeX makes one character of each
_AS_IT_IS = re.compile("[A-Za-z0-9.,;:()=+/]*")
_LONG_WORD = 40  # characters; a longer one must be allowed to break, or it leaves the page
_PIECE = 20


def centred(body: str) -> str:
    """Return centred LaTeX, kept on one page with the line before it."""
    kept = r"\csname @beginparpenalty\endcsname=10000 "
    return f"{{{kept}\\begin{{center}}{body}\\end{{center}}}}"


def escape(text: str) -> str:
    """Return the text escaped for LaTeX on one line, white space collapsed."""
    line = unicodedata.normalize("NFC", _WHITE.sub(" ", text))
    quoted = _OPENING_QUOTE.sub("“", line).replace('"', "”")
    return " ".join(_word(word) for word in quoted.split(" "))


def _word(word: str) -> str:
    """Return one word, with break points if very long, and without ligatures."""
    if len(word) <= _LONG_WORD and _AS_IT_IS.fullmatch(word):
        return word
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
    if character in _SHOWN:
        return _SHOWN[character]
    if unicodedata.category(character) in {"Cc", "Cf"}:
        return ""
    if character.isascii() or character in LETTERS:
        return character
    parts = unicodedata.normalize("NFD", character)
    return _cluster(parts[0], parts[1]) if len(parts) == 2 else "?"


def _mathematics(character: str) -> str:
    """Return a letter as mathematics, or nothing for another character."""
    return character if character.isascii() and character.isalpha() else _MATHEMATICS.get(character, "")
