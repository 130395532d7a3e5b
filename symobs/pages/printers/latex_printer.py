r"""Formulas in LaTeX, for amsmath: `\[ … \]` where a display fits the line, `align*` where it does not."""

from __future__ import annotations

import re
import unicodedata
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.formula.notation import OPERATORS, symbol_latex
from symobs.formula.tree import Formula, Relation
from symobs.ground.dataclass import dataclass
from symobs.pages.printers import line_breaking as widths
from symobs.pages.printers.glyphs import NO_RULES, GlyphBox, Level
from symobs.pages.printers.line_breaking import Layout
from symobs.pages.printers.printer import ROWS_IN_A_LINE, Printer
from symobs.pages.printers.rational_formula import digits_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar
    from symobs.pages.printers.glyphs import Rules


_WORD = r"\mathit"
#: Behind a number it would be read as a mixed one.
_NUMERIC_FRACTION = re.compile(r"\\[dt]?frac\{?\d")
_FRACTION_OF_LETTERS = re.compile(r"-?\\frac\{(?!\d+\}\{\d+\}$)")
#: amsmath's matrices have ten columns; wider ones are set as arrays.
_MATRIX_COLUMNS = 10
#: In running text (in em, or digits): what still goes under a fraction bar, into a matrix, into an unbroken number.
_NARROW = 3.0
_WIDE = 12.0
_LONG_NUMBER = 16
_DIGITS = 5
_UNBREAKABLE = _LONG_NUMBER * widths.DIGIT
#: A display of more lines may be broken over pages.
_PAGE_OF_ROWS = 8


@dataclass
class LatexBox(GlyphBox):
    """LaTeX source; `height` is 0 for a line of letters, 1 for a fraction, else about the number of rows."""

    source: str
    height: int = 0


class LatexPrinter(Printer[LatexBox]):
    """Formula → LaTeX."""

    def __init__(
        self,
        variable: str = "s",
        symbols: Mapping[str, str] | None = None,
        *,
        discrete: bool = False,
        width: float = widths.TEXT_WIDTH,
        paged: bool = True,
    ) -> None:
        """Print as `Printer` does, in lines of `width` em; `paged` lets TeX break long displays over pages."""
        self.running = self.in_exponent = False
        super().__init__(variable, symbols, discrete=discrete)
        self.width = width
        self.paged = paged

    @property
    def style(self) -> tuple[object, ...]:
        """What changes between one formula of a page and the next."""
        return *super().style, self.running, self.in_exponent

    def inline(self, item: Formula | Relation) -> str:
        """Return mathematics for a line of text, without delimiters; TeX can break it wherever it is long."""
        return self.running_box(item).source

    def running_box(self, item: Formula | Relation) -> LatexBox:
        """Return mathematics for a line of text with its width and height."""
        running = self.styled(running=True)
        return running.relation(item) if isinstance(item, Relation) else running.typeset(item)

    def unbroken(self, item: Formula | Relation) -> str:
        """Return display mathematics without delimiters or line breaks, such as a label in a drawing."""
        return (self.relation(item) if isinstance(item, Relation) else self.typeset(item)).source

    def display(self, relations: Sequence[Relation], *, boxed: int = 0, end: str = ".") -> str:
        """Return a display: one line, centred lines, or lines aligned at the first sign of each relation."""
        rows, are_aligned = Layout(self, self.width, boxed=boxed, end=end).rows(relations)
        if len(rows) == 1 and not are_aligned:
            return rf"\[ {rows[0].right.source} \]"
        environment = "align*" if are_aligned else "gather*"
        lines = [f"{row.left.source if row.left else ''}&{row.right.source}" for row in rows]
        if not are_aligned:
            lines = [row.right.source for row in rows]
        breaks = [r"\\[3pt]" if max(a.right.height, b.right.height) else r"\\" for a, b in pairwise(rows)]
        body = "\n".join(line + after for line, after in zip(lines, [*breaks, ""], strict=True))
        written = f"\\begin{{{environment}}}\n{body}\n\\end{{{environment}}}"
        return (
            f"{{\\allowdisplaybreaks\n{written}}}\\ignorespaces"
            if self.paged and len(rows) > _PAGE_OF_ROWS
            else written
        )

    # -- glyphs ---------------------------------------------------------------------------------------------------

    def letter(self, name: str, mark: str) -> LatexBox:
        r"""Return a letter; `\dot x`, `x_k`, `x_{k+1}`."""
        source = self.letter_latex(name)
        if mark == "dot":
            stem, below, index = source.partition("_")  # the dot stands on the letter, not on its index
            source = (rf"\dot {stem}" if re.fullmatch(r"\w", stem) else rf"\dot{{{stem}}}") + below + index
        elif mark:
            stem, _, index = source.partition("_")
            below = f"{index},{mark}" if index else mark
            source = f"{stem}_{below}" if len(below) == 1 else f"{stem}_{{{below}}}"
        return LatexBox(widths.source_width(source), Level.POWER if "^" in source else Level.ATOM, source)

    def leaf(self, value: Scalar) -> LatexBox:
        """Return a whole number or a symbol."""
        if value.is_constant:
            digits = digits_of(value)
            if self.running and len(digits) > _LONG_NUMBER:
                runs = [digits[start : start + _DIGITS] for start in range(0, len(digits), _DIGITS)]
                return LatexBox(_UNBREAKABLE, Level.ATOM, r"\allowbreak ".join(runs))
            return LatexBox(len(digits) * widths.DIGIT, Level.ATOM, digits)
        (name,) = value.names
        source = symbol_latex(name, self.symbols.get(name))
        return LatexBox(widths.source_width(source), Level.POWER if "^" in source else Level.ATOM, source)

    def identity(self) -> LatexBox:
        """Write I."""
        return LatexBox(0.5, Level.ATOM, "I")

    def empty(self, shape: tuple[int, int]) -> LatexBox:
        """Return a zero with its shape."""
        source = rf"0_{{{shape[0]}\times {shape[1]}}}"
        return LatexBox(widths.source_width(source), Level.ATOM, source)

    def sign(self, *, negative: bool, leading: bool) -> LatexBox:
        """Return plus or minus."""
        return LatexBox(widths.SIGN if leading else widths.OPERATOR, Level.SUM, "-" if negative else "+")

    def comparison(self, operator: str) -> LatexBox:
        """Return the sign of a relation."""
        return LatexBox(widths.RELATION, Level.SUM, OPERATORS[operator][0])

    def joined(self, parts: Sequence[LatexBox], level: Level) -> LatexBox:
        """Return the sources one after the other, a space where a command would swallow a letter."""
        sources = [parts[0].source]
        for before, after in pairwise(part.source for part in parts):
            sources += [" ", after] if swallows(before, after) else [after]
        width, height = sum(part.width for part in parts), max(part.height for part in parts)
        return LatexBox(width, level, "".join(sources), height)

    def between(self, left: LatexBox, right: LatexBox) -> LatexBox | None:
        r"""Return `\cdot` before a number, a thin space beside a word and before the degree of a root."""
        if right.source[0].isdigit() or (left.source[-1].isdigit() and _NUMERIC_FRACTION.match(right.source)):
            return LatexBox(0.7, Level.PRODUCT, r"\cdot ")
        if self.running and left.width + right.width > _WIDE:
            return LatexBox(0.0, Level.PRODUCT, r"\allowbreak ")
        is_word = left.source.startswith(_WORD) or right.source.startswith((_WORD, r"\sqrt["))
        return LatexBox(0.17, Level.PRODUCT, r"\,") if is_word else None

    def grouped(self, box: LatexBox) -> LatexBox:
        """Return parentheses as tall as their content."""
        if box.height == 0:
            return LatexBox(box.width + 0.8, Level.ATOM, f"({box.source})")
        if self.running:
            return LatexBox(box.width + 1.0, Level.ATOM, rf"\bigl({box.source}\bigr)", box.height)
        return LatexBox(box.width + 1.6, Level.ATOM, rf"\left({box.source}\right)", box.height)

    def fraction(self, above: LatexBox, below: LatexBox) -> LatexBox:
        r"""Return `\frac`; in running text a slash where one part is long."""
        width = max(above.width, below.width)
        if self.in_exponent:
            parts = [self.at_least(Level.PRODUCT, above), self.slash(), self.at_least(Level.POWER, below)]
            return self.joined(parts, Level.PRODUCT)
        if self.running and (width > _NARROW or min(above.level, below.level) < Level.PRODUCT):
            parts = [self.at_least(Level.PRODUCT, above), self.slash(), self.at_least(Level.POWER, below)]
            return self.joined(parts, Level.PRODUCT)
        source = rf"\frac{{{above.source}}}{{{below.source}}}"
        return LatexBox(width + widths.FRACTION_BAR, Level.FRACTION, source, 1)

    def raised(self, base: LatexBox, exponent: int) -> LatexBox:
        """Return a power."""
        return self._above(base, str(exponent))

    def to_the_instant(self, base: LatexBox) -> LatexBox:
        """Return the k-th power."""
        return self._above(base, "k")

    def transposed(self, base: LatexBox) -> LatexBox:
        """Return the transpose."""
        return self._above(base, r"\mathsf T")

    def _above(self, base: LatexBox, script: str) -> LatexBox:
        written = f"^{script}" if len(script) == 1 else f"^{{{script}}}"
        width = base.width + widths.SCRIPT * widths.source_width(script)
        return LatexBox(width, Level.POWER, base.source + written, base.height)

    def applied(self, function: str, argument: LatexBox) -> LatexBox:
        """Return a function's name and its argument."""
        name = self.function_latex(function)
        source = f"{name} {argument.source}" if swallows(name, argument.source) else name + argument.source
        width = widths.source_width(name) + argument.width + 0.2
        return LatexBox(width, Level.PRODUCT, source, argument.height)

    def matrix(self, rows: Sequence[Sequence[LatexBox]], rules: Rules = NO_RULES) -> LatexBox:
        """Return a table in brackets; in running text small, or a list where it is wide or high."""
        if not self.running:
            rows = in_one_style(rows)
        columns = len(rows[0])
        width = sum(max(row[j].width for row in rows) for j in range(columns))
        width += (columns - 1) * widths.COLUMN_GAP + widths.BRACKETS
        if self.running and (width > _WIDE or len(rows) > ROWS_IN_A_LINE):
            source = r";\allowbreak\ ".join(r",\allowbreak\ ".join(entry.source for entry in row) for row in rows)
            return LatexBox(width, Level.ATOM, f"[{source}]")
        body = under_one_another(["&".join(entry.source for entry in row) for row in rows], _heights(rows), rules[0])
        if self.running and len(rows) > 1:
            source = rf"\left[\begin{{smallmatrix}}{body}\end{{smallmatrix}}\right]"
        elif any(rules):
            edges = (0, *rules[1], columns)
            preamble = "|".join("c" * (after - before) for before, after in pairwise(edges))
            source = rf"\left[\begin{{array}}{{{preamble}}}{body}\end{{array}}\right]"
            width += widths.COLUMN_GAP
        elif columns <= _MATRIX_COLUMNS:
            source = rf"\begin{{bmatrix}}{body}\end{{bmatrix}}"
        else:
            source = rf"\left[\begin{{array}}{{{'c' * columns}}}{body}\end{{array}}\right]"
            width += widths.COLUMN_GAP
        return LatexBox(width, Level.ATOM, source, max(2, len(rows)))

    def rate(self, box: LatexBox, name: str = "t") -> LatexBox:
        """Return d/dt before a stack."""
        return LatexBox(box.width + 1.2, Level.PRODUCT, rf"\frac{{d}}{{d{name}}}{box.source}", max(1, box.height))

    # -- functions of time ----------------------------------------------------------------------------------------

    def exponential(self, argument: Scalar) -> LatexBox:
        r"""Return `e^{-t/2}`, `e` of 1: fractions in the exponent are written with a slash."""
        if argument.is_one:
            return LatexBox(0.47, Level.ATOM, "e")
        exponent = self.styled(in_exponent=True).exponent(argument)
        return LatexBox(0.47 + widths.SCRIPT * exponent.width, Level.POWER, f"e^{{{exponent.source}}}")

    def root(self, argument: LatexBox, degree: int = 2) -> LatexBox:
        r"""Return `\sqrt`."""
        index = "" if degree == 2 else f"[{degree}]"
        return LatexBox(argument.width + 0.9, Level.ATOM, rf"\sqrt{index}{{{argument.source}}}", argument.height)

    def summed(self, over: LatexBox, term: LatexBox) -> LatexBox:
        r"""Return `\sum_{λ³+λ+1=0} …`."""
        width = widths.SCRIPT * over.width + term.width
        return LatexBox(width, Level.PRODUCT, rf"\sum_{{{over.source}}} {term.source}", max(2, term.height))

    def named(self, form: str) -> LatexBox:
        """Return the letter."""
        return LatexBox(widths.source_width(form), Level.ATOM, form)

    def evaluated(self, box: LatexBox, equations: Sequence[LatexBox]) -> LatexBox:
        r"""Return `\left. … \right|_{t=0}`."""
        where = ",".join(equation.source for equation in equations)
        width = box.width + 0.2 + widths.SCRIPT * sum(equation.width for equation in equations)
        return LatexBox(width, Level.POWER, rf"\left.{box.source}\right|_{{{where}}}", max(1, box.height))

    def integral(self, limits: tuple[LatexBox, LatexBox], integrand: LatexBox, name: LatexBox) -> LatexBox:
        r"""Return `\int_0^{2T} … \,dt`."""
        lower, upper = (limit.source if len(limit.source) == 1 else f"{{{limit.source}}}" for limit in limits)
        between = "" if len(name.source) == 1 else " "
        source = rf"\int_{lower}^{upper} {integrand.source}\,d{between}{name.source}"
        width = 1.2 + widths.SCRIPT * max(limit.width for limit in limits) + integrand.width + name.width + 0.7
        return LatexBox(width, Level.PRODUCT, source, max(1, integrand.height))

    # -- glyphs of broken lines -----------------------------------------------------------------------------------

    def parentheses(self, content: Sequence[LatexBox]) -> tuple[LatexBox, LatexBox]:
        r"""Return `\bigl( … \bigr)` and larger: unlike `\left`, they may stand on different lines."""
        size = ("big", "Big", "bigg", "Bigg")[min(3, max(box.height for box in content))]
        return LatexBox(0.8, Level.SUM, rf"\{size}l("), LatexBox(0.8, Level.SUM, rf"\{size}r)")

    def brackets(self) -> tuple[LatexBox, LatexBox]:
        """Return the same, square."""
        return LatexBox(0.6, Level.SUM, r"\bigl["), LatexBox(0.6, Level.SUM, r"\bigr]")

    def separators(self) -> tuple[LatexBox, LatexBox]:
        """Return comma and semicolon."""
        return LatexBox(0.5, Level.SUM, ","), LatexBox(0.7, Level.SUM, r";\;")

    def dot(self) -> LatexBox:
        r"""Return `\cdot`."""
        return LatexBox(0.9, Level.SUM, r"{}\cdot ")

    def slash(self) -> LatexBox:
        """Return a slash."""
        return LatexBox(0.5, Level.SUM, "/")

    def digits(self, run: str) -> LatexBox:
        """Return a part of a number."""
        return LatexBox(len(run) * widths.DIGIT, Level.ATOM, run.replace(",", "{,}"))

    def continued(self) -> LatexBox:
        """Return a hooked arrow."""
        return LatexBox(1.5, Level.SUM, r"{\hookrightarrow}\,")

    def star(self, number: int) -> LatexBox:
        """Return an asterisk with a number."""
        return LatexBox(0.5 + len(str(number)) * widths.DIGIT * widths.SCRIPT, Level.ATOM, rf"\ast_{{{number}}}")

    def entry_of(self, matrix: LatexBox, indices: Sequence[int]) -> LatexBox:
        """Return the matrix with its indices, in parentheses where it is more than a letter."""
        base = matrix if matrix.level == Level.ATOM and "_" not in matrix.source else self.grouped(matrix)
        separator = "," if max(indices) > 9 else ""
        below = separator.join(map(str, indices))
        width = base.width + widths.SCRIPT * widths.source_width(below)
        return LatexBox(width, Level.POWER, f"{base.source}_{{{below}}}", base.height)

    def indent(self) -> LatexBox:
        r"""Return `\quad`."""
        return LatexBox(1.0, Level.SUM, r"\quad{}")

    def framed(self, box: LatexBox) -> LatexBox:
        r"""Return `\answer`, a macro of the template."""
        return LatexBox(box.width + widths.FRAME, Level.ATOM, rf"\answer{{{box.source}}}", max(1, box.height))

    def stacked(self, lines: Sequence[LatexBox]) -> LatexBox:
        r"""Return lines of an array, all but the first indented; amsmath's `aligned` does not stand in a frame in `align*`."""
        first, *rest = lines
        indented = [first, *(self.joined([self.indent(), line], Level.SUM) for line in rest)]
        sources = [rf"\displaystyle {line.source}" for line in indented]
        body = under_one_another(sources, [max(1, 2 * line.height) for line in lines])
        width = max(line.width for line in indented) + widths.COLUMN_GAP
        return LatexBox(width, Level.SUM, rf"\begin{{array}}{{l}}{body}\end{{array}}", 2)

    def punctuation(self, mark: str) -> LatexBox:
        """Return a comma or full stop."""
        return LatexBox(0.45, Level.SUM, mark)

    def gap(self) -> LatexBox:
        r"""Return `\qquad`."""
        return LatexBox(2.0, Level.SUM, r"\qquad ")


def swallows(left: str, right: str) -> bool:
    """Return whether a command at the end of `left` would absorb the beginning of `right`."""
    command = left[left.rfind("\\") + 1 :] if "\\" in left else ""
    return bool(command) and command.isascii() and command.isalpha() and right[:1].isalpha()


def _heights(rows: Sequence[Sequence[LatexBox]]) -> list[int]:
    return [max(entry.height for entry in row) for row in rows]


def under_one_another(rows: Sequence[str], heights: Sequence[int], ruled: Sequence[int] = ()) -> str:
    r"""Return rows joined by `\\`, with the depth that tall ones need below their strut: an array adds none by itself."""
    body = rows[0]
    for number, (row, above, below) in enumerate(zip(rows[1:], heights, heights[1:], strict=False), 1):
        body += rf"\\[{max(12, 3 * above)}pt]" if above > 1 else r"\\[4pt]" if max(above, below) else r"\\"
        body += (
            rf"\hline {row}\rule{{0pt}}{{2.4ex}}" if number in ruled else row
        )  # before -2 it would make a binary minus
    return body


def in_one_style(rows: Sequence[Sequence[LatexBox]]) -> Sequence[Sequence[LatexBox]]:
    """Return the entries of a table, their fractions all set large where one has more than numbers in it."""
    if not any(_FRACTION_OF_LETTERS.match(entry.source) for row in rows for entry in row):
        return rows
    return [[_opened(entry) for entry in row] for row in rows]


def _opened(entry: LatexBox) -> LatexBox:
    """Return an entry, the fractions that stand in no other set large."""
    outer, depth = "", 0
    for part in re.split(r"(\\frac\b|[{}])", entry.source):
        depth += {"{": 1, "}": -1}.get(part, 0)
        outer += r"\dfrac" if part == r"\frac" and not depth else part
    return entry if outer == entry.source else replace(entry, source=outer, height=2)


# Escaping of external text for TeX: every title, source and word.
#
# Nothing in it is interpreted: `$x^2$` comes out as those five characters. What the built-in templates (pdfLaTeX,
# UTF-8, no further fonts) cannot show becomes a visible `?`.


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


_BELOW = zip("₀₁₂₃₄₅₆₇₈₉ₐₑₕᵢⱼₖₗₘₙₒₚᵣₛₜᵤᵥₓ", "0123456789aehijklmnoprstuvx", strict=True)
_MATHEMATICS |= {character: f"_{name}" for character, name in _BELOW}


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
