"""LaTeX in the notation of problem files: matrices, fractions, roots, powers and indices, Greek letters, functions."""

from __future__ import annotations

import re

_TABLE = r"(?:[bpB]?(?:small)?matrix|array)\}"
_ENVIRONMENT = re.compile(rf"\\begin\{{{_TABLE}(?:\{{[lcr|]*\}})?(.*?)\\end\{{{_TABLE}", re.DOTALL)
_DISPLAY = re.compile(
    r"\\(?:begin|end)\{(?:align|equation|gather|multline|eqnarray|split|aligned|displaymath|math)\*?\}"
)
_ROW_END = re.compile(r"\\\\(?:\[[^]]*\])?|\\cr\b")
#: Commands with nothing to read, those that only set their argument, and fences.
_SPACES = re.compile(r"(?<!\\)\\(?:[,;:! ]|q?quad\b|displaystyle\b)|\\(?:left|right|[bB]igg?[lr]?)(?![A-Za-z])\.?|\$")
_SET = re.compile(
    r"\\(?:math(?:rm|bf|sf|it|cal)|boldsymbol|operatorname|text(?:bf)?|boxed|underline)(?:\s*\{([^{}]*)\}|\s+([A-Za-z0-9]))"
)
_APPLIED = re.compile(
    r"\\(sinh?|cosh?|exp)\s*(?:(?=\()|([\d.]*\s*(?:\\[A-Za-z]+|[A-Za-z](?![A-Za-z]))(?:_\w+)?)(?=\s*(?:$|[-+=,;&)\]}]|\\\\)))"
)
_QUOTIENT = re.compile(r"\\[dtc]?frac\s*(?:\{([^{}]*)\}|(\d))\s*(?:\{([^{}]*)\}|(\d))")
#: Longer texts are left alone.
_LONGEST = 20_000
#: Groups of LaTeX within each other.
_DEEPEST = 20
_ROOT = re.compile(r"\\sqrt\s{0,9}(?:\[\s{0,9}(\d)\s{0,9}\])?\s{0,9}\{([^{}]*)\}")
#: Square and fourth roots; a name does not begin another entry of a row.
_ROOTS = {None: " sqrt({})", "2": " sqrt({})", "4": " sqrt(sqrt({}))"}
_ABOVE, _BELOW = re.compile(r"\^\s*\{([^{}]*)\}"), re.compile(r"_\s*\{([^{}]*)\}")
_SIGNS = {
    "pm": "±",
    "cdot": "*",
    "times": "*",
    "div": "/",
    "top": "T",
    "implies": "=>",
    "land": " and ",
    "wedge": " and ",
}
_SIGNS |= {"lor": " or ", "vee": " or ", "lt": "<", "gt": ">", "ne": "!=", "neq": "!="}
_SIGNS |= {"approx": "≈", "le": "<=", "leq": "<=", "ge": ">=", "geq": ">="}


def without_latex(text: str) -> str:
    """Return a text whose LaTeX is written as in problem files: [1, 2; 3, 4], (a)/(b), exp(-t), omega_0."""
    if "\x0crac" in text or "\x08egin" in text:  # between double quotes TOML reads \f and \b as characters
        text = text.replace("\x0crac", r"\frac").replace("\x08egin", r"\begin")
    if len(text) > _LONGEST or not re.search(r"\\[][()A-Za-z;,:!]|[\^_]\{|\$", text):
        return text
    text = re.sub(r"\\text\{[^{}]*\}\s*\\qquad", "", text)  # the words before a display
    text = re.sub(r"(?<!\\)\\[][()]|~(?!=)", " ", text)  # the signs around one, and blanks
    text = re.sub(r"\^\s{0,9}(?:\{\s{0,9}\\circ\s{0,9}\}|\\circ\b)", "°", text)
    text = re.sub(r"\\bar\s{0,9}\{?\s{0,9}([A-Za-z])\s{0,9}\}?", r"\1_bar", _SPACES.sub(" ", text))
    for _ in range(_DEEPEST):
        before = text
        text = _SET.sub(lambda f: f[1] if f[1] is not None else f[2], text)
        text = _QUOTIENT.sub(lambda f: f"(({f[1] or f[2]})/({f[3] or f[4]}))", text)
        text = _ROOT.sub(lambda f: _ROOTS.get(f[1], f" ({{}})^(1/{f[1]})").format(f[2]), text)
        text = _ABOVE.sub(lambda f: f"^{f[1].strip()}" if f[1].strip() == "T" else f"^({f[1]})", text)
        text = _BELOW.sub(_indexed, text)
        if before == text:
            break
    text = _ENVIRONMENT.sub(lambda found: _rows_of_latex(found[1]), text)
    text = _SET.sub(lambda f: f[1] if f[1] is not None else f[2], _DISPLAY.sub("\n", text))
    text = re.sub(r"(?<=[A-Za-z0-9])e\^", " e^", text)
    text = _APPLIED.sub(lambda f: f" {f[1]}({f[2]})" if f[2] else f" {f[1]}", text)
    text = re.sub(r"\\([A-Za-z]+)(_?)", lambda f: _SIGNS.get(f[1], f" {f[1]}{f[2] or ' '}"), text)
    text = re.sub(r"[(\[|]\s*(\[[^][]*\])\s*[)\]|]", r"\1", text)
    text = re.sub(r"\\[{}]", lambda found: found[0][1], text)
    return _ROW_END.sub("\n", text).replace("&", " ")


def _indexed(found: re.Match[str]) -> str:
    """Return an index, with the sign of a product where a letter or a digit follows."""
    follows = found.string[found.end() : found.end() + 1]
    return "_" + re.sub(r"\s+", "", found[1]) + ("*" if follows.isalnum() else "")


def _rows_of_latex(body: str) -> str:
    rows = [row for row in _ROW_END.split(re.sub(r"\\hline", "", body)) if row.strip()]
    return f"[{'; '.join(', '.join(cell.strip() for cell in row.split('&')) for row in rows)}]"
