"""Forms of the letters of a convention: from the typed letter to LaTeX and to the terminal."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING
from unicodedata import normalize

from symobs.formula.notation import GREEK_LATEX, GREEK_LETTERS, LETTERS, SUBSCRIPTS, LetterForm

if TYPE_CHECKING:
    from collections.abc import Sequence

_ACCENTS = {"bar": "\N{COMBINING MACRON}", "tilde": "\N{COMBINING TILDE}", "hat": "\N{COMBINING CIRCUMFLEX ACCENT}"}
_ARGUMENT = re.compile(r"\(.*\)$")


def letter_form(name: str, standard: LetterForm) -> LetterForm:
    """Return the form of a typed letter such as `M`, `x_bar` or `r_o`.

    What the standard letter is a function of stays behind it: `r_o` for φ(s) is r_o(s).
    """
    stem, *marks = name.split("_")
    letters = stem.rstrip("0123456789")
    latex, text = GREEK_LATEX.get(letters) or _slanted(letters), GREEK_LETTERS.get(letters, letters)
    for accent in [mark for mark in marks if mark in _ACCENTS]:
        latex = rf"\{accent} {latex}" if len(latex) == 1 else rf"\{accent}{{{latex}}}"
        text = normalize("NFC", text + _ACCENTS[accent])
    below = ",".join(filter(None, [stem[len(letters) :], *(mark for mark in marks if mark not in _ACCENTS)]))
    if below.isdigit():
        latex, text = latex + (f"_{below}" if len(below) == 1 else f"_{{{below}}}"), text + below.translate(SUBSCRIPTS)
    elif below:
        latex, text = rf"{latex}_{{\mathrm{{{below}}}}}", f"{text}_{below}"
    behind = _ARGUMENT.search(standard.text)
    argument = behind[0] if behind else ""
    return LetterForm(latex + argument, text + argument, standard.spoken)


def _slanted(letters: str) -> str:
    return letters if len(letters) == 1 else rf"\mathit{{{letters}}}"


def of_polynomial(name: str, sign: int, factors: Sequence[LetterForm]) -> dict[str, LetterForm]:
    """Return the forms of the polynomial of A plus or minus a product, as a letter and as a function."""
    mark, spoken = "+" if sign > 0 else "-", LETTERS[name].spoken
    latex = rf"\chi_{{A{mark}{''.join(factor.latex for factor in factors)}}}"
    text = f"χ_(A{mark}{''.join(factor.text for factor in factors)})"
    return {
        name: LetterForm(f"{latex}({{v}})", f"{text}({{v}})", spoken),
        f"{name}_at": LetterForm(latex, text, spoken),
    }


def of_determinant(gramian: LetterForm) -> dict[str, LetterForm]:
    """Return the form of the determinant of the Gramian up to t."""
    return {"det_W": LetterForm(rf"\det {gramian.latex}", f"det {gramian.text}", LETTERS["det_W"].spoken)}
