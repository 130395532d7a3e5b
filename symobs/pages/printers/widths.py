"""Widths of LaTeX mathematics in Computer Modern, in em, for line breaking."""

from __future__ import annotations

import re

TEXT_WIDTH = 40.0  # the line of the template is 41.5 em
SCRIPT = 0.74
DIGIT = 0.5
OPERATOR = 1.23
SIGN = 0.78
RELATION = 1.34
COLUMN_GAP = 0.92
BRACKETS = 1.2
FRACTION_BAR = 0.25
FRAME = 0.75

_MATH_ITALIC = {
    **dict(zip("abcdefghi", (0.53, 0.43, 0.44, 0.53, 0.47, 0.57, 0.5, 0.58, 0.35), strict=True)),
    **dict(zip("jklmnopqr", (0.44, 0.54, 0.31, 0.88, 0.6, 0.49, 0.51, 0.47, 0.47), strict=True)),
    **dict(zip("stuvwxyz", (0.47, 0.37, 0.58, 0.5, 0.73, 0.58, 0.51, 0.48), strict=True)),
    **dict(zip("ABCDEFGHI", (0.75, 0.78, 0.76, 0.83, 0.77, 0.76, 0.79, 0.9, 0.49), strict=True)),
    **dict(zip("JKLMNOPQR", (0.63, 0.9, 0.69, 1.06, 0.9, 0.77, 0.74, 0.8, 0.77), strict=True)),
    **dict(zip("STUVWXYZ", (0.65, 0.7, 0.77, 0.77, 1.07, 0.89, 0.76, 0.73), strict=True)),
}
_PUNCTUATION = {"(": 0.39, ")": 0.39, "[": 0.28, "]": 0.28, ",": 0.45, ".": 0.28, " ": 0.0, "-": 1.0, "+": 1.0}
_WIDTHLESS = frozenset(
    (
        *("hat", "dot", "ddot", "bar", "tilde", "vec", "check", "acute", "grave", "breve", "mathstrut"),
        *("mathcal", "mathrm", "mathit", "mathbf", "mathsf", "mathbb", "boldsymbol", "text", "operatorname"),
        *("left", "right", "big", "bigl", "bigr", "displaystyle", "textstyle"),
    )
)
_FUNCTIONS = {"sin": 1.23, "cos": 1.34, "sinh": 1.79, "cosh": 1.9}  # the space after them is the argument's
_COMMANDS = {
    **_FUNCTIONS,
    "iota": 0.36,
    "det": 1.4,
    "quad": 1.0,
    "qquad": 2.0,
    "psi": 0.69,
    "Omega": 0.73,
    "prime": 0.28,
}
_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|[\^_{}]|.", re.DOTALL)


def source_width(source: str) -> float:
    """Return the width of a symbol's LaTeX: letters, commands, accents, sub- and superscripts."""
    width, scales, scale = 0.0, [1.0], 1.0
    for part in _TOKEN.findall(source):
        if part in "^_":
            scale = scales[-1] * SCRIPT
        elif part == "{":
            scales.append(scale)
        elif part == "}":
            scales = scales[:-1] or [1.0]
            scale = scales[-1]
        elif part[1:] not in _WIDTHLESS:
            width += scale * _token_width(part)
            scale = scales[-1]
    return width


def _token_width(token: str) -> float:
    if token.startswith("\\"):
        return _COMMANDS.get(token[1:], 0.66) if len(token) > 2 else 0.3
    if token.isdigit():
        return DIGIT
    return _MATH_ITALIC.get(token, _PUNCTUATION.get(token, 0.8))
