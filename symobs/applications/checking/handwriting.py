"""What people write, in the notation of problem files: LaTeX, calls of programs, transposes, words; and names of answers.

Leniency is here alone: each rewriting is of what has one meaning, and what may have two is left as it is, to be refused with
its place.  What is rewritten is judged as everything else is.
"""

from __future__ import annotations

import re
from itertools import combinations, pairwise
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.formula.expression import without_latex
from symobs.formula.expression.names import spellings
from symobs.formula.notation import GREEK_LETTERS, LETTERS
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from symobs.tasks.result.in_convention import ResultInConvention


# -- marks of documents ------------------------------------------------------------------------------------------------


_DOCUMENT = re.compile(r"\\begin\{document\}(.*?)(?:\\end\{document\}|\Z)", re.DOTALL)
_FENCE = re.compile(r"(?m)^[ \t]*(?:```|~~~).*$")
#: What stands before a definition in a list, - L = …, a) L = …, and in the prompt of a program.
_BULLET = re.compile(
    r"(?m)^[ \t]*(?:[-*+•][ \t]+|\(?(?:\d{1,2}|[a-z])\)[ \t]+|\d{1,2}\.[ \t]+|>>>?[ \t]*)"
    r"(?=[$*`\\]{0,2}\w[^=\n]{0,40}=)"
)
_STRONG = re.compile(r"(?<![\w)\]])(\*\*|__|`+)(?=\S)([^\n]*?\S)\1(?![\w(])")
#: Statements of programs that define nothing.
_STATEMENT = re.compile(
    r"(?m)^[ \t]*(?:(?:import|from|print|disp|display|fprintf|clear|clc|close|format|syms|pkg)\b|init_printing|plt\.)[^=\n]*$"
)


def without_marks(text: str) -> str:
    """Return a text without the marks of Markdown and LaTeX around it, and without statements that define nothing."""
    if found := _DOCUMENT.search(text):
        text = found[1]
    text = _BULLET.sub("", _STATEMENT.sub("", _FENCE.sub("", text)))
    return _STRONG.sub(r"\2", text) if "`" in text or "**" in text or "__" in text else text


# -- matrices drawn over several lines, in a box, as pages of text have them ---------------------------------------------


_FRAME = re.compile(r"[┌┐└┘─│]")
#: The conditions of a region as a page frames them.
_FRAMED = re.compile(r"\s*│ ([^│⎡⎢⎣=≈]*[<>][^│=≈]*) │\s*")
_DRAWN = re.compile(r"[⎡⎢⎣]([^⎡⎢⎣⎤⎥⎦]*)[⎤⎥⎦]")
#: Names of entries and of parts that a page explains below a formula: M(1,2), exp(A t)(1,2), *₁.
_PLACE = re.compile(r"([A-Za-zα-ωΑ-Ω]\w*(?:\([A-Za-z ]+\))?)\((\d),(\d)\)")
_ABBREVIATED, _DIGITS = re.compile(r"\*([₁-₉])"), str.maketrans("₀₁₂₃₄₅₆₇₈₉", "0123456789")


def _named(found: re.Match[str]) -> str:
    return f"{re.sub(r'[^A-Za-z]+', '_', found[1])}_{found[2]}_{found[3]}"


def without_drawings(text: str) -> str:
    """Return a text with matrices that stand over several lines on one: ⎡1  2⎤ above ⎣3  4⎦ is [1, 2; 3, 4]."""
    if not re.search("[⎡│]", text):
        return text
    text = _ABBREVIATED.sub(lambda f: f"part_{f[1].translate(_DIGITS)}", _PLACE.sub(_named, text))
    written: list[str] = []
    block: list[str] = []
    for line in text.splitlines():
        framed = _FRAMED.fullmatch(line)
        plain = f"stable_if = {framed[1]}" if framed else _FRAME.sub(" ", line)
        if not plain.strip() and line.strip():
            continue
        if not _DRAWN.search(plain):
            written.append(plain)
            continue
        block.append(plain)
        if "⎣" in plain:
            written.append(_on_one_line(block))
            block = []
    return "\n".join(written + block)


def _on_one_line(block: list[str]) -> str:
    """Return lines that hold rows of matrices as one, what stands between these being on any of them."""
    cut = [_DRAWN.split(line) for line in block]
    count = max(map(len, cut))
    if any(len(parts) != count for parts in cut):
        return "\n".join(block)
    columns = [[part.strip() for part in column] for column in zip(*cut, strict=True)]
    told = [" ".join(filter(None, column)) for column in columns]
    rows = [_written([re.split(r"\s{2,}", row) for row in column]) for column in columns]
    return " ".join(rows[k] if k % 2 else told[k] for k in range(count))


# -- calls of programs, transposes, sums of matrices ---------------------------------------------------------------------


QUOTES = "\"' "
_RATIONAL = re.compile(r"(?:\b[A-Za-z]+\.)?\b(?:Rational|Fraction)\(\s*([^(),]+?)\s*(?:,\s*([^(),]+?)\s*)?\)")
_FUNCTION = re.compile(r"tf\(\s*\[?([^][]*?)\]?\s*,\s*\[([^][]*)\]\s*(,\s*[\w.]+\s*)?\)")
_TRANSPOSED = re.compile(r"(?P<inside>\[[^][]*\]|\([^()]*[,;][^()]*\))\s*(?:'|\^\s*\(?T\)?|\.T\b|ᵀ)")
_TURNED = re.compile(r"\b(?:np\.)?transpose\(\s*(\[[^][]*\])\s*\)")
_MATRIX = re.compile(r"\[[^][]*\]")
#: Letters of matrices and the variable as a product without blanks: sI, BK, LC.
_TOGETHER = re.compile(r"(?:\b|(?<=[-^]\d))(?:[sz]I|(?!AND|OR\b)[A-Z]{2,4})\b")
_INDEXED = re.compile(r"\b([A-Za-z]+)(_?)(\d+)\b")
_SQUARE_ROOT = re.compile(
    r"(?<![\w.])(?!e\b)(\d+|[A-Za-z]\w*|\([^()]*\))\s*\^\s*(?:\(\s*1/2\s*\)|0?\.5(?![\d.]))|\bsqrt\s*(\d+)(?![\w.(])"
)
_BEFORE_MATRIX = re.compile(r"(?<![\w.)/^])(\d+/\d+)\s*\*?\s*(?=\[)")
#: Longer words are parted in too many ways.
_LONGEST_PRODUCT = 20
_WORDS_OF_LINES = {"rank", "det", "adj", "exp", "where", "and", "or", "yes", "no", "trace"}
_NAME = re.compile(r"(?<![A-Za-z_.])[A-Za-z][A-Za-z0-9_]*(?![A-Za-z0-9_(])")
_BEFORE_BRACKET = re.compile(r"(?<![A-Za-z_.])[A-Za-z]\w*_?\d+(?=\()")
_EXPONENTIAL = re.compile(
    r"(?<![A-Za-z_])e\s*\^\s*(\((?:[^()]|\([^()]*\))*\)|-?\s*[A-Za-z0-9.]+(?![A-Za-z0-9_.]))(?!\s*\^)"
)
_DECIMAL_FACTOR = re.compile(r"(\d+\.\d+)(?=(?!e[-+]?\d)[A-Za-z(])")


#: Functions of a matrix before its letter, det O, and what else they are called.
_OF_LETTER = re.compile(
    r"(?<![\w\\])(det|rank|[Rr]ang|rg|rk|trace|tr|[Ss]pur)\s+(?=([A-ZΠΓ]\w*)(?![\w(])\s*(?:[=<>!≠]|$))\2"
)
_FUNCTIONS = {"rang": "rank", "rg": "rank", "rk": "rank", "tr": "trace", "spur": "trace"}
_CALLED_OTHERWISE = re.compile(r"(?<![\w\\])(?:[Rr]ang|rg|rk|tr|[Ss]pur)(?=\()")
#: The transpose of a letter, A^T, A.T, and of a product of letters in parentheses.
_LETTER_TURNED = re.compile(
    r"((?<![A-Za-z0-9_])[A-ZΠΓ](?:_?[a-z0-9])?|\([^()]*[A-ZΠΓ][^()]*\))\s*(?:\^\s*\(?T\)?(?!\w)|\.T\b|ᵀ)"
)
_INVERSE = re.compile(r"(?<!\w)inv\(\s*([A-Z]\w*)\s*\)")
_DIAGONAL = re.compile(r"(?<!\w)(?:np\.|sp\.)?[dD]iag\(\s*\[?((?:[^()\[\]]|\([^()]*\))*)\]?\s*\)")
_UNIT = re.compile(r"(?<!\w)(?:(?:np\.|sp\.)?eye\(\s*(\d)\s*\)|(?:np\.)?identity\(\s*(\d)\s*\)|I_(\d)(?!\w))")
_ZEROS = re.compile(r"(?<!\w)(?:np\.)?zeros\(\s*\(?(\d)\s*,\s*(\d)\)?\s*\)")
#: Values at an instant that have letters of their own: x(0), x_1(0), W(0, T).
_AT_ZERO = re.compile(r"(?<![A-Za-z])x(?:_?(\d))?\(\s*(?:0|t_?0)\s*\)")
_OVER_TIME = re.compile(r"(?<![A-Za-z])(W(?:_\w+)?)\(\s*(?:0\s*,\s*)?[A-Za-z]\w*\s*\)(?=\s*=)")


def unit_matrix(order: int) -> str:
    """Return the text of an identity matrix."""
    return _written([[str(int(i == j)) for j in range(order)] for i in range(order)])


def _diagonal(found: re.Match[str]) -> str:
    entries = _entries(found[1])
    return _written([[entry if i == j else "0" for j in range(len(entries))] for i, entry in enumerate(entries)])


def in_matrices(text: str) -> str:
    """Return a text with diag(1, 2), eye(2), I_2 and zeros(1, 2) written out, and with det(O), rank(O), A', R^-1 and x0."""
    text = _AT_ZERO.sub(lambda f: f"x0_{f[1]}" if f[1] else "x0", _OVER_TIME.sub(r"\1", text))
    text = _OF_LETTER.sub(lambda f: f"{_FUNCTIONS.get(f[1].lower(), f[1])}({f[2]})", text)
    text = _CALLED_OTHERWISE.sub(lambda f: _FUNCTIONS[f[0].lower()], text)
    text = _INVERSE.sub(r"\1^-1", _LETTER_TURNED.sub(r"\1'", text))
    text = _UNIT.sub(lambda f: unit_matrix(int(f[1] or f[2] or f[3])), _DIAGONAL.sub(_diagonal, text))
    return _ZEROS.sub(lambda f: _written([["0"] * int(f[2])] * int(f[1])), text)


def readable(text: str) -> str:
    """Return the text of a value as a problem file has it."""
    text = _QUOTED_MATRIX.sub(r"[\1]", without_latex(text).replace("÷", "/"))
    text = _OF_BLANKS.sub(lambda f: f"({', '.join(f[1].split())})", _OF_ANGLE.sub(r"\1(\2)", text))
    text = in_matrices(text)
    text = _SQUARE_ROOT.sub(lambda f: f"sqrt({f[1].strip('()') if f[1] else f[2]})", text)
    text = _BEFORE_MATRIX.sub(r"(\1)*", text)
    text = _RATIONAL.sub(lambda f: f"(({f[1].strip(QUOTES)})/({f[2] or 1}))", text)
    text = _FUNCTION.sub(_quotient, text)
    text = _TURNED.sub(r"\1'", text)
    text = _TRANSPOSED.sub(lambda found: _turned(found["inside"]), text)
    return _summed(text) if len(_MATRIX.findall(text)) > 1 else text


def law_of(text: Any, states: int) -> list[str] | None:
    """Return the coefficients of the states in u = -18 x1 - 6 x2 or u = -[18 6] x; None for another text."""
    if not isinstance(text, str) or len(text) > _LONGEST:
        return None
    if row := re.fullmatch(r"\s*(-?)\s*(\[[^][]*\])\s*\*?\s*x", text):
        (entries,) = rows if len(rows := _rows(row[2])) == 1 else ([],)
        return [f"{row[1]}({entry})" for entry in entries] or None
    terms = re.findall(r"([-+]?)\s*((?:[^-+()]|\([^()]*\))*?)\s*\*?\s*(?<![A-Za-z])x_?(\d)\s*", text)
    places = [int(place) for _, _, place in terms]
    whole = "".join(f"{sign}{factor}x{place}" for sign, factor, place in terms)
    if (
        len({*places}) != len(places)
        or not places
        or max(places) > states
        or re.sub(r"[\s*_]", "", text) != re.sub(r"[\s*]", "", whole)
    ):
        return None
    found = dict.fromkeys(range(1, states + 1), "0")
    found |= {int(place): f"{sign}({factor.strip() or 1})" for sign, factor, place in terms}
    return [*found.values()]


def without_words(text: str) -> str:
    """Return a text without words before its value, up to a colon or to *is*; a text of other words as it is."""
    if len(text) > _LONGEST:
        return text
    found = re.fullmatch(
        r"((?:[^\W\d_]{2,}\s+)*[^\W\d_]{2,}\s*(?::|(?<=\bis)|(?<=\bist)|(?<=\blautet)))\s+(\S.*?)\.?", text, re.DOTALL
    )
    words = re.findall(r"[^\W\d_]+", found[1].lower()) if found else []
    return found[2] if found and all(word in _AROUND or word.endswith(_NOUNS) for word in words) else text


def in_letters(text: str, names: Collection[str], variable: str) -> str:
    """Return a text in the names that are declared: h1 for h_1, a*b for ab, exp(-t) for e^(-t), s for p and lambda."""

    def declared(found: re.Match[str]) -> str:
        letter, line, digits = found.groups()
        other = f"{letter}{'' if line else '_'}{digits}"
        return other if found[0] not in names and other in names else found[0]

    text = re.sub(r"(λ|lambda|lam)\s*I(?!\w)", r"\1*I", text)
    text = _TOGETHER.sub(lambda found: found[0] if found[0] in names else "*".join(found[0]), text)
    text = _INDEXED.sub(declared, text)
    text = _NAME.sub(lambda found: _as_product(found[0], names), text)
    text = _BEFORE_BRACKET.sub(lambda found: _before_bracket(found[0], names), text)
    text = _DECIMAL_FACTOR.sub(r"\1*", text)
    for other in {"p", "lambda", "λ"} - {*names}:
        if not re.search(rf"(?<![A-Za-z_]){variable}(?![A-Za-z0-9_])", text):
            text = re.sub(rf"(?<![A-Za-z_]){other}(?![A-Za-z0-9_])", variable, text)
    return text if "e" in names else _EXPONENTIAL.sub(lambda found: f"exp({found[1]})", text)


def _as_product(word: str, names: Collection[str]) -> str:
    """Return names that are written together, ab or h_1k_1, as their product, where they can be parted in one way alone."""
    if word in names or not 1 < len(word) <= _LONGEST_PRODUCT or word in _WORDS_OF_LINES:
        return word
    known = {spelt: name for name in names for spelt in (name, re.sub(r"(?<=[A-Za-z])_?(?=\d+$)", "_", name))}
    partings: list[list[list[str]]] = [[] for _ in word] + [[[]]]  # of what begins at each place, two at most
    for place in reversed(range(len(word))):
        for spelt, name in known.items():
            if word.startswith(spelt, place):
                partings[place] += [[name, *rest] for rest in partings[place + len(spelt)]]
        del partings[place][2:]
    return "*".join(partings[0][0]) if len(partings[0]) == 1 else word


def _before_bracket(word: str, names: Collection[str]) -> str:
    """Return names with an index that are written together before a bracket, lm_1(2l - g), as factors of it."""
    product = _as_product(word, names)
    return word if product == word else f"{product}*"


def _quotient(found: re.Match[str]) -> str:
    """Return the rational function of MATLAB's lists of coefficients; with a sampling period it is one in z."""
    variable = "z" if found[3] else "s"

    def polynomial(coefficients: str) -> str:
        listed = re.split(r"[,\s]+", coefficients.strip())
        return "+".join(f"({c})*{variable}^{len(listed) - k}" for k, c in enumerate(listed, 1))

    return f"(({polynomial(found[1])})/({polynomial(found[2])}))"


def _entries(row: str) -> list[str]:
    return [entry.strip() for entry in (_split(",", row) if "," in row else _split(r"\s+", row.strip()))]


def _split(separator: str, text: str) -> list[str]:
    """Return the parts of a text between separators that stand in no parentheses."""
    parts, start = [], 0
    for found in re.finditer(separator, text):
        if text.count("(", 0, found.start()) == text.count(")", 0, found.start()):
            parts.append(text[start : found.start()])
            start = found.end()
    return [*parts, text[start:]]


def _rows(matrix: str) -> list[list[str]]:
    return [_entries(row) for row in re.split(r"[;\n]", matrix.strip()[1:-1]) if row.strip()]


def _written(rows: list[list[str]]) -> str:
    return f"[{'; '.join(', '.join(row) for row in rows)}]"


def _turned(matrix: str) -> str:
    """Return the transpose; of (1, 2), which is a vector, neither row nor column, itself."""
    rows = [] if matrix.startswith("(") else _rows(matrix)
    return _written([list(column) for column in zip(*rows, strict=True)]) if len({*map(len, rows)}) == 1 else matrix


def _summed(text: str) -> str:
    """Return a sum of matrices, each with a factor before it, as one matrix; another text as it is."""
    terms: list[tuple[str, list[list[str]]]] = []
    end = 0
    for found in _MATRIX.finditer(text):
        factor = text[end : found.start()].strip()
        if terms and not factor.startswith(("+", "-")):
            return text
        sign = "-" if factor.startswith("-") else ""
        factor = factor[factor[:1] in {"+", "-"} :].strip().removesuffix("*").strip()
        outside = re.sub(r"\([^()]*\)", "", re.sub(r"\([^()]*\)", "", factor))
        if re.search(r"[-+()]", outside):
            return text
        terms.append((f"{sign}({factor or 1})", _rows(found[0])))
        end = found.end()
    sizes = {tuple(map(len, rows)) for _, rows in terms}
    if text[end:].strip() or len(sizes) != 1 or not all(rows for _, rows in terms):
        return text
    first = terms[0][1]
    return _written(
        [
            ["+".join(f"{f}*({rows[i][j]})" for f, rows in terms) for j in range(len(first[0]))]
            for i in range(len(first))
        ]
    )


# -- lists without brackets ----------------------------------------------------------------------------------------------


def as_entries(value: Any, count: int) -> Any:
    """Return the entries of (1, 2), {1, 2}, 1, 2 or 1; 2 as a list where there are so many; another value as it is."""
    if not isinstance(value, str) or count < 1:
        return value
    text = value.strip()
    inside = text[1:-1] if text[:1] + text[-1:] in {"()", "{}"} else text
    if "[" in inside or (inside == text and not re.search(r"[,;]|\d\s+-?\d", text)):
        return value
    for separator in (r";|\n", ",", r"\s+"):
        parts = [part.strip() for part in re.split(separator, inside.strip())]
        if len(parts) == count and all(parts) and all(p.count("(") == p.count(")") for p in parts):
            return value if count == 1 else parts
    return value


def with_commas(value: Any, columns: int) -> Any:
    """Return rows without commas as they have so many entries: two blanks apart, [a b   a + b], or one, [3 a; a^2].

    So are products in one reading alone, [a^2 2 a]; raises `InputError` with both where there are two.
    """
    if not isinstance(value, str) or "," in value or not _MATRIX.fullmatch(value.strip()):
        return value
    lines = [row.strip() for row in value.strip()[1:-1].split(";")]
    if columns == 1 and any(re.search(r"[\w)]\s+[^\W\d]", line) for line in lines):
        return _written([[f"({line})"] for line in lines])
    rows = [_split(r"\s{2,}", line) for line in lines]
    if {len(row) for row in rows} == {columns}:
        return _written(rows)
    if {len(_split(r"\s+", line)) for line in lines} == {columns}:
        return value
    parted = [_parted(line, columns) for line in lines]
    if max(map(len, parted)) > 1 and all(parted):
        both = " or ".join(_written([row[min(k, len(row) - 1)] for row in parted]) for k in (0, 1))
        raise InputError("the blanks have two readings", repair=f"write {both}")
    return _written([row[0] for row in parted]) if all(parted) else value


#: More blanks than these in a row are parted in too many ways.
_MOST_GAPS = 12


def _parted(line: str, columns: int) -> list[list[str]]:
    """Return the ways, two at most, to part a row into so many entries: a number or a sign after a blank begins one.

    Where every blank parts two entries there is no other way.
    """
    words = _split(r"\s+", line)
    factors = [""]
    for word in words:  # a sign between blanks stands in a sum
        if word in {"+", "-", "*", "/"} or factors[-1].endswith((" + ", " - ", " * ", " / ")):
            factors[-1] += f" {word} " if word in {"+", "-", "*", "/"} else word
        else:
            factors.append(word)
    factors = factors[1:] if not factors[0] else factors
    gaps = range(1, len(factors))
    if len(factors) <= columns or len(factors) > _MOST_GAPS:
        return [factors] if len(factors) == columns else []
    ways = []
    for chosen in combinations(gaps, columns - 1):
        if all(k in chosen or factors[k][0].isalpha() for k in gaps):
            ends = [0, *chosen, len(factors)]
            ways.append([" ".join(factors[i:j]) for i, j in pairwise(ends)])
    return ways[:2]


def without_and(value: Any) -> Any:
    """Return a list of numbers, -1 and -2, (1, 2) or 1 1 0, as it is written with commas."""
    if not isinstance(value, str) or re.search(r"[][{}\n]", value):
        return value
    text = re.sub(r"\s*,?\s*\b(?:and|und)\b\s*", ", ", value.strip())
    text = text[1:-1] if text.startswith("(") and text.endswith(")") and "," in text and text.count("(") == 1 else text
    return re.sub(r"\s+", ", ", text) if re.fullmatch(r"-?\d+(?:\s+-?\d+)+", text) else text


# -- lines ---------------------------------------------------------------------------------------------------------------


_LEADING = re.compile(r"(?:(?:[^\W\d_]{2,}|=>|⇒|->|→|∴)[,:]?\s+)+(?=[A-Za-z]\w*(?:\([stz]\)|\^T|')?\s*:?=(?![=<>]))")
#: A gain that is a vector, k^T = (1, 2) or l = (1, 2).
_SMALL = re.compile(r"(?:k\s*(?:'|\^\s*T|ᵀ)|l)\s*=\s*(?=[\[(])")
_SEVERAL = re.compile(r"(?:s|λ|lambda|lam)_?\{?1,\s*\d\}?\s*=")
_SIZES = re.compile(r"sizes?\s*[:=]\s*(.*=.*)")
_ARROW = re.compile(r"(?:=>|⇒|->|→|∴)\s*")
_COLON = re.compile(r"([A-Za-z]\w*)\s*:\s+(?!=)")
_LEFT_TURNED = re.compile(
    r"(?:transpose\(\s*([A-Z]\w*)\s*\)|([A-Z]\w*)\s*(?:'|\^\s*T|\.T|ᵀ))\s*=\s*([^=]*(?:\[|\((?=[^()]*,))[^=]*)"
)
#: A transfer function between its signals, Y(s) = ... U(s).
_OF_SIGNALS = re.compile(r"Y(?:\(([sz])\))?\s*=\s*(.+?)\s*\*?\s*U(?:\([sz]\))?")
_OF_BLANKS = re.compile(r"\((\s*-?[\d./]+(?:\s+-?[\d./]+)+\s*)\)(?=\s*(?:'|\^|\.T|ᵀ))")
#: The sine of one letter, with a factor, without parentheses.
_OF_ANGLE = re.compile(
    r"(?<![A-Za-z_])(sinh?|cosh?)\s+"
    r"((?:[\d.]+\s*\*?\s*)?(?:[A-Za-z]\w*\s*\*?\s+)?t|(?:[\d.]+\s*\*?\s*)?[A-Za-z]\w*(?=\s*(?:$|[-+,;\])])))(?![\w(])"
)
_QUOTED_MATRIX = re.compile(r"""(?:\w+\.)?matrix\(\s*["']([^"'\[\]]*)["']\s*\)""")
_OF_P = re.compile(r"([A-Za-zχφ]\w*\s*)\(\s*(?:p|lambda|λ)\s*\)(?=\s*=)")
_WORDS = ((re.compile(r"&&|\u2227|\bund\b"), " and "), (re.compile(r"\|\||\u2228|\boder\b"), " or "))
_TURNED_ORDER = re.compile(r"([^<>=]*)(?:=>|=<)([^<>=]*)")
#: Words that stand before a relation and change nothing.
_AROUND = frozenset(
    """a an the this gain gains feedback observer state matrix matrices compensator controller answer result solution step
    response transfer function characteristic polynomial eigenvalues eigenvalue poles with
    therefore finally is are thus so hence also then therefore we get obtain have gives
    yields der die das ein eine verstärkung rückführung beobachter regler ergebnis lösung antwort polynom charakteristische
    charakteristisches eigenwerte eigenwert mit lautet lauten ist sind folglich damit somit daher wir erhalten""".split()  # noqa: SIM905 - prose
)


#: What compounds of German end in.
_NOUNS = (
    "verstärkung",
    "rückführung",
    "matrix",
    "vektor",
    "funktion",
    "polynom",
    "regler",
    "beobachter",
    "werte",
    "lösung",
)


def plain_line(line: str) -> str:
    """Return a line without the words before its relation and the point behind it, its letter on the left alone."""
    line = in_matrices(_ARROW.sub("", line, count=1) if _ARROW.match(line) else line)
    words = _LEADING.match(line)
    if sizes := _SIZES.fullmatch(line):
        return f"sizes = {sizes[1].replace('=', ':')}"
    if words and all(word in _AROUND or word.endswith(_NOUNS) for word in re.findall(r"[^\W\d_]+", words[0].lower())):
        line = line[words.end() :]
    if line.endswith(".") and not line.endswith(".."):
        line = line[:-1].rstrip()
    line = _SEVERAL.sub("eigenvalues =", line)
    line = _SMALL.sub(lambda f: f"{f[0][0].upper()} = ", line) if _SMALL.match(line) else line
    if signals := _OF_SIGNALS.fullmatch(line):
        line = f"Y/U = {signals[2]}"
    line = _COLON.sub(r"\1 = ", line, count=1) if _COLON.match(line) and "=" not in line else line
    if turned := _LEFT_TURNED.fullmatch(line):
        line = f"{turned[1] or turned[2]} = {_turned(v) if _MATRIX.fullmatch(v := readable(turned[3].strip())) else v}"
    line = _OF_P.sub(r"\1(s)", line, count=1)
    if re.search(r"[<>](?!.*\bwhere\b)", line):
        for pattern, word in _WORDS:
            line = pattern.sub(word, line)
        parts = re.split(r"(\band\b|\bor\b|[,;()])", line)
        line = "".join(p.replace("=>", ">=").replace("=<", "<=") if _TURNED_ORDER.fullmatch(p) else p for p in parts)
    return line


# -- names of answers ----------------------------------------------------------------------------------------------------


_PENCIL = re.compile(r"(?:det\(|\|)(?:[szp]|lam(?:bda)?)(?:I|E|1)-A(?:\)|\|)")
_LOOP = re.compile(r"(?:det\(|\|)(?:[szp]|lam(?:bda)?)(?:I|E|1)-\(?A[-+][A-Z]{2}\)?(?:\)|\|)")
_POLYNOMIAL = re.compile(r"chi(?:_?A)?|phi|[pP]|Delta")
_O = r"(?:[OQM](?:_?[obO\d])?|Obs?)"
_CTR = r"(?:[QSMC](?:_?[csrBS\d])?|Ctr|Co|\[B,?AB.*\])"
#: How a field is called besides by the letter of its page; where the name may call others, in a task.
_CALLED: dict[str, re.Pattern[str]] = {
    "polynomial": _POLYNOMIAL,
    "closed_loop_polynomial": _POLYNOMIAL,
    "transfer_function": re.compile(r"[GHPT]|Y/U"),
    "controllability.matrix": re.compile(_CTR),
    "controllability.rank": re.compile(rf"(?:rank|rang|rk)\(?{_CTR}\)?", re.IGNORECASE),
    "observability.matrix": re.compile(_O),
    "observability.rank": re.compile(rf"(?:rank|rang|rk)\(?{_O}\)?", re.IGNORECASE),
    "observability.kernel": re.compile(rf"(?:ker|kern|null|N)\(?{_O}\)?", re.IGNORECASE),
    "roots": re.compile(r"eig(?:envalues?|enwerte?|s)?(?:\(A\))?|roots|Nullstellen", re.IGNORECASE),
    "poles": re.compile(r"eig(?:envalues?|enwerte?|s)?(?:\(A-[BL][KC]\))?|poles?|Pole|Polstellen", re.IGNORECASE),
    "gramian.matrix": re.compile(r"[WPQ](?:_?[corsT])?"),
    "matrix_exponential.matrix": re.compile(r"(?:e\^\(?At\)?|expm\(At\)|Phi|exp_At)"),
    "zero_order_hold.A": re.compile(r"A_?d|Phi"),
    "zero_order_hold.B": re.compile(r"B_?d|Gamma"),
}


def squashed(left: str) -> str:
    """Return the left side of a relation without what is written in several ways: blanks, stars, argument, brackets."""
    spelt = "".join(spellings(c)[0] if c in GREEK_LETTERS.values() else c for c in left)
    text = re.sub(r"[\s*·]", "", spelt)
    text = re.sub(r"\(([szpt]|lam(bda)?)\)", "", text)
    return re.sub(r"_[({]([^(){}]*)[)}]", r"_\1", text)  # chi_(A-BK), chi_{A-BK}


def letters_of(view: ResultInConvention, field: str) -> set[str]:
    """Return the letter by which the page calls a field, in the standard convention and in that of the result."""
    name = view.result.letters.get(field, "")
    forms = {**LETTERS, **view.convention.forms(reduced=view.result.has_reduced_observer)}
    return {squashed(name), squashed(forms[name].alone.text) if name in forms else ""} - {""}


def fields_of(asked: Sequence[tuple[ResultInConvention, str]], values: Mapping[str, Any]) -> dict[tuple[str, str], Any]:
    """Return the values of parts, task and field, that are called by their letter on the page, else as usual.

    The letter of a page, whose last value counts, goes before other names; where these have several values, or may call
    several parts, none counts.
    """
    keys, found, usual = (
        {key: squashed(key) for key in values},
        dict[tuple[str, str], Any](),
        dict[tuple[str, str], Any](),
    )
    own = set[str]().union(*(letters_of(view, field) for view, field in asked))
    for view, field in asked:
        owner = next(
            (each for each, letter in view.result.letters.items() if letter == view.result.letters.get(field)), field
        )
        letters, part = letters_of(view, field) if owner == field else set(), (view.task, field)
        pattern = _CALLED.get(f"{view.task}.{field}", _CALLED.get(field))
        by_letter = [values[key] for key, name in keys.items() if name in letters]
        pencil = _PENCIL if "chi" in letters else _LOOP if {"chi_K", "chi_L"} & letters else None
        by_pencil = [values[key] for key, name in keys.items() if pencil and pencil.fullmatch(name)]
        others = [values[key] for key, name in keys.items() if name not in own and pattern and pattern.fullmatch(name)]
        if by_letter or by_pencil:
            found[part] = (by_letter or by_pencil)[-1]
        elif others and all(value == others[0] for value in others):
            usual[part] = others[0]
    once = {part: value for part, value in usual.items() if sum(value is each for each in usual.values()) == 1}
    return found | once


_OWN, _LONGEST = re.compile(r"(?<!\w)[^\W\d_]\w*(?!\w|\()"), 5_000
_OF_LETTERS = re.compile(r"(?:\+?\s*[A-Z]\w*\s+[zuy]\s*)+")


def coefficients_of(members: Sequence[str]) -> dict[str, str]:
    """Return the values of F, G and H in a chain F z + G u + H y = -2 z + [1 0] u + 3 y."""
    named = next((member for member in members if _OF_LETTERS.fullmatch(member)), "")
    letters = {signal: letter for letter, signal in re.findall(r"([A-Z]\w*)\s+([zuy])", named)}
    terms, depth = [""], 0
    for c in members[-1]:
        depth += (c in "([") - (c in ")]")
        if c in "+-" and not depth and terms[-1].strip():
            terms.append("")
        terms[-1] += c
    found = {}
    for term in terms:
        factor, signal = term.strip().removeprefix("+").strip()[:-1].rstrip(" *"), term.strip()[-1:]
        if signal not in letters or letters[signal] in found:
            return {}
        found[letters[signal]] = f"{factor}1" if factor in {"", "-"} else factor
    return found


#: Definitions of a student's own letters within each other.
_WITHIN = 20


def with_own_letters(value: Any, values: Mapping[str, Any], known: Collection[str]) -> Any:
    """Return a value with what the answer says of letters that are not the problem's: k1 in [k1, k2] beside k1 = 3."""

    def meant(found: re.Match[str]) -> str:
        name = found[0]
        is_own = isinstance(values.get(name), str) and not {name, name.translate(_DIGITS)} & {*known}
        return f"({values[name]})" if is_own else name

    for _ in range(_WITHIN if isinstance(value, str) else 0):
        before, value = value, _OWN.sub(meant, value)
        if value == before or len(value) > _LONGEST:
            break
    return value


#: What eigenvalues are called, before their numbers.
EIGENVALUES = "s|p|lambda|lam|λ"


def entries_of(view: ResultInConvention, values: Mapping[str, Any]) -> dict[str, list[Any]]:
    """Return the gains, rows or columns, and the matrices of which all entries are given: l1 = 16, l2 = 80; p11 = 2, ..."""
    found = {}
    for letter, names in letters_of_entries(view).items():
        right = _entries_by_letter(view, letter)
        given = [[next((values[n] for n in each if n in values), None) for each in row] for row in names]
        if right is not None and right == right.T:  # of a symmetric matrix half of them are enough
            given = [
                [b if a is None else a for a, b in zip(*pair, strict=True)]
                for pair in zip(given, zip(*given, strict=True), strict=True)
            ]
        if names and all(entry is not None for row in given for entry in row):
            alone = [entry for row in given for entry in row]
            found[letter] = given if len(given) > 1 and len(given[0]) > 1 else alone
    return found


def _entries_by_letter(view: ResultInConvention, letter: str) -> Matrix | None:
    """Return what has this letter as a matrix, a list as a column; None for anything else."""
    value = view.fields.get(letter)
    if isinstance(value, Matrix):
        return value
    if isinstance(value, list) and value and all(isinstance(entry, Scalar) for entry in value):
        return Matrix.column(value)
    return None


def named_entries(view: ResultInConvention) -> dict[str, Scalar]:
    """Return the values of the entries of gains and matrices by their names, p11 and p_11."""
    found: dict[str, Scalar] = {}
    for letter, names in letters_of_entries(view).items():
        right = _entries_by_letter(view, letter)
        for row, values in zip(names, right.rows if right is not None else (), strict=False):
            for each, value in zip(row, values, strict=True):
                found |= dict.fromkeys(each, value)
    return found


def listed_of(view: ResultInConvention, values: Mapping[str, Any]) -> dict[str, list[Any]]:
    """Return the poles or zeros that are numbered: s1 = -1, s2 = -2."""
    found = {}
    for field, letters in (("poles", EIGENVALUES), ("roots", EIGENVALUES), ("zeros", "z|n")):
        if view.result.fields.get(field):
            numbered = {n[1]: values[key] for key in values if (n := re.fullmatch(rf"(?:{letters})_?(\d)", key))}
            all_of_them = [str(k) for k in range(1, len(view.result.fields[field]) + 1)]
            if sorted(numbered) == all_of_them:  # fewer of them are lines
                found[field] = [*numbered.values()]
    return found


def letters_of_entries(view: ResultInConvention) -> dict[str, list[list[tuple[str, str]]]]:
    """Return the letters of the entries by rows, k1 and k_1, p11 and p_11, x0_1: of gains, of matrices with one letter.

    Those of the plant, and names of the problem, have no entries here.
    """
    known, result = view.plant.symbols.signs, view.result
    found = {}
    for field in dict.fromkeys((*result.gains, *result.answered_by, *result.leads)):
        letter = view.letter_of(field)
        value = _entries_by_letter(view, letter)
        if value is None or letter in {"A", "B", "C", "D"} or len(letter.rstrip("0")) != 1:
            continue
        rows, columns = value.shape
        own = letter.lower()
        line = "_" if own[-1].isdigit() else ""  # x0_1
        ends = [
            [f"{i + 1}{j + 1}" if min(rows, columns) > 1 else f"{max(i, j) + 1}" for j in range(columns)]
            for i in range(rows)
        ]
        names = [[(f"{own}{line}{end}", f"{own}_{end}") for end in row] for row in ends]
        found[letter] = [] if {name for row in names for each in row for name in each} & {*known} else names
    return found
