"""Formulas on a terminal, in Unicode: `[0 1; 0 -1]` in a line of text, brackets over several lines in a display."""

from __future__ import annotations

import unicodedata
from itertools import zip_longest
from typing import TYPE_CHECKING, Any, Self

from symobs.formula.notation import FUNCTIONS, OPERATORS, symbol_text
from symobs.formula.tree import Formula, Relation
from symobs.ground.dataclass import dataclass
from symobs.pages.printers.glyphs import NO_RULES, GlyphBox, Level
from symobs.pages.printers.line_breaking import Layout
from symobs.pages.printers.printer import Printer
from symobs.pages.printers.rational_formula import digits_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar
    from symobs.pages.printers.glyphs import Rules


_SUPERSCRIPT_DIGITS = "⁰¹²³⁴⁵⁶⁷⁸⁹⁻"
_SUPERSCRIPTS = str.maketrans("0123456789-", _SUPERSCRIPT_DIGITS)
_SUBSCRIPTS = str.maketrans("0123456789", "₀₁₂₃₄₅₆₇₈₉")
_INDEX = {"k": "ₖ", "k+1": "ₖ₊₁"}
_BRACKETS = {"(": ("⎛⎜⎝", "⎞⎟⎠"), "[": ("⎡⎢⎣", "⎤⎥⎦")}


@dataclass
class TextBox(GlyphBox):
    """Lines of equal width; `baseline` is the one that stands on the line of its neighbours."""

    lines: tuple[str, ...]
    baseline: int = 0

    @property
    def line(self) -> str:
        """The line of the baseline."""
        return self.lines[self.baseline]


class TextPrinter(Printer[TextBox]):
    """Formula → Unicode text."""

    slashes = True

    def __init__(
        self,
        variable: str = "s",
        symbols: Mapping[str, str] | None = None,
        *,
        discrete: bool = False,
        width: int = 96,
        flat: bool = False,
    ) -> None:
        """Print as `Printer` does, in lines of `width` columns; `flat` keeps every matrix on one line."""
        self.flat = flat
        super().__init__(variable, symbols, discrete=discrete)
        self.width = width

    @classmethod
    def of(cls, other: Printer[Any], *, width: int = 96, flat: bool = False) -> Self:
        """Return a printer with the letters of another one."""
        printer = cls(other.variable, other.symbols, discrete=other.discrete, width=width, flat=flat)
        printer.letters, printer.language = other.letters, other.language
        return printer

    @property
    def style(self) -> tuple[object, ...]:
        """What changes between one formula of a page and the next."""
        return *super().style, self.flat

    def inline(self, item: Formula | Relation) -> str:
        """Return mathematics on one line."""
        if not self.flat:
            return self.styled(flat=True).inline(item)
        return (self.relation(item) if isinstance(item, Relation) else self.typeset(item)).line

    def display(self, relations: Sequence[Relation], *, boxed: int = 0, end: str = "") -> str:
        """Return a display, aligned at the first sign of each relation; tall rows stand apart."""
        rows, _ = Layout(self, self.width, boxed=boxed, end=end).rows(relations)
        margin = max(int(row.left.width) if row.left else 0 for row in rows)
        written: list[str] = []
        was_tall = False
        for row in rows:
            box = self.joined([_pad_left(row.left or text_box(""), margin), row.right], Level.SUM)
            is_tall = len(box.lines) > 1
            written += [""] if written and (is_tall or was_tall) else []
            written += [line.rstrip() for line in box.lines]
            was_tall = is_tall
        return "\n".join(written)

    # -- glyphs ---------------------------------------------------------------------------------------------------

    def letter(self, name: str, mark: str) -> TextBox:
        """Return a letter; ẋ, xₖ, xₖ₊₁."""
        text = self.letter_text(name)
        if mark == "dot":
            dotted = unicodedata.normalize("NFC", f"{text}\u0307")
            return text_box(dotted if len(dotted) == 1 else f"d{text}/dt", Level.POWER)
        level = Level.POWER if text[-1] in _SUPERSCRIPT_DIGITS else Level.ATOM
        return text_box(text + _INDEX.get(mark, ""), level)

    def leaf(self, value: Scalar) -> TextBox:
        """Return a whole number or a symbol."""
        if value.is_constant:
            return text_box(digits_of(value))
        (name,) = value.names
        return text_box(symbol_text(name, self.symbols.get(name)))

    def identity(self) -> TextBox:
        """Write I."""
        return text_box("I")

    def empty(self, shape: tuple[int, int]) -> TextBox:
        """Return a zero with its shape."""
        return text_box(f"0({shape[0]}×{shape[1]})")

    def sign(self, *, negative: bool, leading: bool) -> TextBox:
        """Return plus or minus."""
        glyph = "-" if negative else "+"
        return text_box(glyph if leading else f" {glyph} ", Level.SUM)

    def comparison(self, operator: str) -> TextBox:
        """Return the sign of a relation."""
        return text_box(f" {OPERATORS[operator][1]} ", Level.SUM)

    def joined(self, parts: Sequence[TextBox], level: Level) -> TextBox:
        """Return the boxes side by side, baselines in one line."""
        above = max(part.baseline for part in parts)
        below = max(len(part.lines) - part.baseline for part in parts)
        lines = ["".join(_line_at(part, offset) for part in parts) for offset in range(-above, below)]
        return TextBox(sum(part.width for part in parts), level, tuple(lines), above)

    def between(self, left: TextBox, right: TextBox) -> TextBox | None:
        """Return a dot before a number; no space after one, nor at a parenthesis."""
        before, after = left.line.rstrip(_SUPERSCRIPT_DIGITS), right.line
        if after[0].isdigit():
            return text_box("·")
        if before.isdigit():
            return text_box(" ") if _starts_with_word(after) else None
        is_open = before.endswith(")") or after.startswith("(") or (before == self.variable and after == "I")
        return None if is_open else text_box(" ")

    def grouped(self, box: TextBox) -> TextBox:
        """Return parentheses as tall as their content."""
        return self._fenced(box, "(", ")", Level.ATOM)

    def _fenced(self, box: TextBox, opening: str, closing: str, level: Level) -> TextBox:
        rows = len(box.lines)
        if rows == 1:
            return text_box(f"{opening}{box.line}{closing}", level)
        left, right = (_tall(shape, rows) for shape in _BRACKETS[opening])
        lines = tuple(f"{a}{line}{b}" for a, line, b in zip(left, box.lines, right, strict=True))
        return TextBox(box.width + 2, level, lines, box.baseline)

    def fraction(self, above: TextBox, below: TextBox) -> TextBox:
        """Return above/below, parenthesised where one of them is a sum or product."""
        above, below = self.at_least(Level.PRODUCT, above), self.at_least(Level.POWER, below)
        return self.joined([above, text_box("/"), below], Level.PRODUCT)

    def raised(self, base: TextBox, exponent: int) -> TextBox:
        """Return a power."""
        return self._above(base, str(exponent).translate(_SUPERSCRIPTS))

    def to_the_instant(self, base: TextBox) -> TextBox:
        """Return the k-th power."""
        return self._above(base, "ᵏ")

    def transposed(self, base: TextBox) -> TextBox:
        """Return the transpose."""
        return self._above(base, "ᵀ")

    def _above(self, base: TextBox, script: str) -> TextBox:
        lines = (base.lines[0] + script, *(line + " " * len(script) for line in base.lines[1:]))
        return TextBox(base.width + len(script), Level.POWER, lines, base.baseline)

    def applied(self, function: str, argument: TextBox) -> TextBox:
        """Return a function's name and its argument."""
        known = self.letters[function].text if function in self.letters else FUNCTIONS.get(function, ("", ""))[1]
        name = self.language.words["rank"] if function == "rank" else known or function.replace("_", " ")
        if function in {"sin", "cos", "sinh", "cosh"} and argument.line[0] not in "([":
            argument = self.grouped(argument)
        space = "" if argument.line[0] in "([" or len(argument.lines) > 1 else " "
        return self.joined([text_box(name + space), argument], Level.PRODUCT)

    def matrix(self, rows: Sequence[Sequence[TextBox]], rules: Rules = NO_RULES) -> TextBox:
        """Return a table in brackets; on one line its entries are written without spaces."""
        if self.flat:
            written = (" ".join(_tight(entry.line) for entry in row) for row in rows)
            return text_box(f"[{'; '.join(written)}]")
        widths = [max(row[j].width for row in rows) for j in range(len(rows[0]))]
        if len(rows) == 1 and rules == NO_RULES and any("·" in _tight(entry.line) for entry in rows[0]):
            return text_box(f"[{', '.join(entry.line for entry in rows[0])}]")
        lines: list[str] = []
        between = [1 if number in rules[1] else 0 for number in range(1, len(widths))]
        for number, row in enumerate(rows):
            cells = [_pad_left(entry, width) for entry, width in zip(row, widths, strict=True)]
            height = max(len(cell.lines) for cell in cells)
            bars = [TextBox(3, Level.ATOM, (" │ ",) * height, max(cell.baseline for cell in cells))] * len(between)
            gaps = [bar if ruled else text_box("  ") for bar, ruled in zip(bars, between, strict=True)]
            spaced = [cells[0], *(part for pair in zip(gaps, cells[1:], strict=True) for part in pair)]
            if number in rules[0]:
                lines.append(
                    "".join("─" * int(w) + ("─┼─" if r else "──") for w, r in zip(widths, between, strict=False))
                )
                lines[-1] += "─" * int(widths[-1])
            lines += self.joined(spaced, Level.ATOM).lines
        width = sum(widths) + 2 * len(between) + sum(between)
        body = TextBox(width, Level.ATOM, tuple(lines), (len(lines) - 1) // 2)
        return self._fenced(body, "[", "]", Level.ATOM)

    def rate(self, box: TextBox, name: str = "t") -> TextBox:
        """Return d/dt before a stack."""
        return self.joined([text_box(f"d/d{name} "), box], Level.PRODUCT)

    # -- functions of time ----------------------------------------------------------------------------------------

    def exponential(self, argument: Scalar) -> TextBox:
        """exp(-t)."""
        return self.joined([text_box("exp"), self.grouped(self.exponent(argument))], Level.POWER)

    def root(self, argument: TextBox, degree: int = 2) -> TextBox:
        """Return √3, √(ω² - b²), ⁵√2."""
        sign = "√" if degree == 2 else f"{degree}√".translate(_SUPERSCRIPTS)
        return self.joined([text_box(sign), self.at_least(Level.ATOM, argument)], Level.POWER)

    def summed(self, over: TextBox, term: TextBox) -> TextBox:
        """Return Σ[λ³ + λ + 1 = 0] …."""
        return self.joined([text_box("Σ["), over, text_box("] "), term], Level.PRODUCT)

    def named(self, form: str) -> TextBox:
        """Return the letter: a Greek one by its glyph."""
        if form.endswith(r"\ldots"):
            return text_box(form.replace(r"\ldots", "…").replace("{,}", ","))
        return text_box(symbol_text(form.lstrip("\\").replace("{", "").replace("}", "")))

    def evaluated(self, box: TextBox, equations: Sequence[TextBox]) -> TextBox:
        """Write X|t=0."""
        where = ",".join(equation.line.replace(" ", "") for equation in equations)
        return self.joined([box, text_box(f"|{where}")], Level.POWER)

    def integral(self, limits: tuple[TextBox, TextBox], integrand: TextBox, name: TextBox) -> TextBox:
        """Return ∫(0..T) … dt."""
        parts = [text_box("∫("), limits[0], text_box(".."), limits[1], text_box(") "), integrand, text_box(" d"), name]
        return self.joined(parts, Level.PRODUCT)

    # -- glyphs of broken lines -----------------------------------------------------------------------------------

    def parentheses(self, content: Sequence[TextBox]) -> tuple[TextBox, TextBox]:
        """Return a pair as tall as the content."""
        above = max(box.baseline for box in content)
        below = max(len(box.lines) - box.baseline for box in content)
        if above + below == 1:
            return text_box("("), text_box(")")
        left, right = (tuple(_tall(shape, above + below)) for shape in _BRACKETS["("])
        return TextBox(1, Level.SUM, left, above), TextBox(1, Level.SUM, right, above)

    def brackets(self) -> tuple[TextBox, TextBox]:
        """Return a plain pair, square."""
        return text_box("["), text_box("]")

    def separators(self) -> tuple[TextBox, TextBox]:
        """Return comma and semicolon."""
        return text_box(", "), text_box("; ")

    def dot(self) -> TextBox:
        """Return a centred dot."""
        return text_box("· ")

    def slash(self) -> TextBox:
        """Return a slash."""
        return text_box("/")

    def digits(self, run: str) -> TextBox:
        """Return a part of a number."""
        return text_box(run)

    def continued(self) -> TextBox:
        """Return a hooked arrow."""
        return text_box("↪ ")

    def star(self, number: int) -> TextBox:
        """Return an asterisk with a number."""
        return text_box(f"*{str(number).translate(_SUBSCRIPTS)}")

    def entry_of(self, matrix: TextBox, indices: Sequence[int]) -> TextBox:
        """Return the matrix with its indices in parentheses, as in MATLAB."""
        base = matrix if matrix.level == Level.ATOM else self.grouped(matrix)
        return self.joined([base, text_box(f"({','.join(map(str, indices))})")], Level.POWER)

    def indent(self) -> TextBox:
        """Return four columns."""
        return text_box("    ")

    def framed(self, box: TextBox) -> TextBox:
        """Return a frame of rules."""
        rule = "─" * (int(box.width) + 2)
        lines = (f"┌{rule}┐", *(f"│ {line} │" for line in box.lines), f"└{rule}┘")
        return TextBox(box.width + 4, Level.ATOM, lines, box.baseline + 1)

    def stacked(self, lines: Sequence[TextBox]) -> TextBox:
        """Return the lines under one another, all but the first indented."""
        first, *rest = lines
        boxes = [first, *(self.joined([self.indent(), line], Level.SUM) for line in rest)]
        width = max(box.width for box in boxes)
        padded = [line + " " * int(width - box.width) for box in boxes for line in box.lines]
        return TextBox(width, Level.SUM, tuple(padded), first.baseline)

    def punctuation(self, mark: str) -> TextBox:
        """Return a comma or full stop."""
        return text_box(mark)

    def gap(self) -> TextBox:
        """Return four columns."""
        return text_box("    ")


def text_box(text: str, level: Level = Level.ATOM) -> TextBox:
    """Return a box of one line."""
    return TextBox(text_width(text), level, (text,))


def text_width(text: str) -> int:
    """Return the number of columns a terminal uses; accents stand on their letters."""
    return len(text) if text.isascii() else sum(not unicodedata.combining(character) for character in text)


def _starts_with_word(text: str) -> bool:
    return len(text) > 1 and text[:2].isascii() and text[:2].isalpha()


def _line_at(box: TextBox, offset: int) -> str:
    index = box.baseline + offset
    return box.lines[index] if 0 <= index < len(box.lines) else " " * int(box.width)


def _tall(shape: str, rows: int) -> str:
    """Return the top of a fence, its middle as often as needed, its bottom."""
    return shape[0] + shape[1] * (rows - 2) + shape[2]


def _tight(entry: str) -> str:
    return entry.replace(" + ", "+").replace(" - ", "-").replace(" ", "·")


def _pad_left(box: TextBox, width: float) -> TextBox:
    space = " " * int(width - box.width)
    return TextBox(width, box.level, tuple(space + line for line in box.lines), box.baseline)


# Pieces of text in columns beside each other.


#: What stands between two columns of characters.
RULE = " │ "


def beside(cells: Sequence[str], width: int) -> str:
    """Return pieces of text beside each other, each `width` columns wide and padded to the height of the highest."""
    lines = zip_longest(*(cell.split("\n") for cell in cells), fillvalue="")
    return "\n".join(RULE.join(f"{part}{' ' * (width - text_width(part))}" for part in line).rstrip() for line in lines)
