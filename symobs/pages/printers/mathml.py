"""Formulas as MathML Core, without scripts, fonts or network.

A box is a row of elements.  Signs carry their form (prefix or infix), because a line that was broken may begin with one.
A long formula in running text is several `math` elements, between which a browser may end a line: inside one it cannot.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

from symobs.formula.notation import symbol_latex
from symobs.formula.tree import Formula, Relation
from symobs.ground.dataclass import dataclass
from symobs.pages.printers import line_breaking as widths
from symobs.pages.printers.glyphs import NO_RULES, GlyphBox, Level
from symobs.pages.printers.latex_to_mathml import (
    APPLY,
    BAR,
    BINARY,
    CLOSING,
    COMMA,
    DOT,
    LARGE,
    LIST,
    MINUS,
    OPENING,
    PLUS,
    RELATIONS,
    SEMICOLON,
    SLASH,
    STRUT,
    THIN,
    TIMES,
    TIMES_OR_BREAK,
    TRANSPOSE,
    accented,
    elements_of,
    indexed,
    is_word,
    parts_of,
    pieces,
    row,
    ruled_edges,
    sized,
    table,
    text,
)
from symobs.pages.printers.line_breaking import Layout
from symobs.pages.printers.printer import ROWS_IN_A_LINE, Printer
from symobs.pages.printers.rational_formula import digits_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar
    from symobs.pages.printers.glyphs import Rules


_SPACED = f"{TIMES}{THIN}"
#: In running text (in em, or digits): what still goes under a fraction bar, into a matrix, into an unbroken number.
_NARROW, _WIDE = 3.0, 12.0
_LONG_NUMBER, _DIGITS = 16, 5
_NUMBER = re.compile(r"(?:<msup>)?<mn>")
_FRACTION_OF_NUMBERS = re.compile(r"<mfrac><mn>\d+</mn><mn>\d+</mn></mfrac>")
#: A display up to this many times as wide as its line is not thought of as too wide: widths are estimates.
_EXCESS = 1.05
_SIZES = ("1.2em", "1.8em", "2.4em", "3em")


@dataclass
class MathmlBox(GlyphBox):
    """Elements side by side; `height` is 0 for a line of letters, 1 for a fraction, else about the number of rows.

    `indexed` is a letter apart from its index, so that an exponent can stand above the index.
    """

    elements: tuple[str, ...]
    height: int = 0
    indexed: tuple[str, str] | None = None

    @property
    def source(self) -> str:
        """The elements as text."""
        return "".join(self.elements)

    @property
    def one(self) -> str:
        """The box as one element."""
        return row(self.elements)


class MathmlPrinter(Printer[MathmlBox]):
    """Formula → MathML."""

    def __init__(
        self,
        variable: str = "s",
        symbols: Mapping[str, str] | None = None,
        *,
        discrete: bool = False,
        width: float = widths.TEXT_WIDTH,
    ) -> None:
        """Print as `Printer` does, in lines of `width` em."""
        self.running = self.in_exponent = False
        super().__init__(variable, symbols, discrete=discrete)
        self.width = width

    @property
    def style(self) -> tuple[object, ...]:
        """What changes between one formula of a page and the next."""
        return *super().style, self.running, self.in_exponent

    def inline(self, item: Formula | Relation) -> str:
        """Return `math` elements for a line of text."""
        box = self.running_box(item)
        return "".join(f"<math>{piece}</math>" for piece in pieces(box.elements, box.width))

    def running_box(self, item: Formula | Relation) -> MathmlBox:
        """Return mathematics for a line of text."""
        running = self.styled(running=True)
        return running.relation(item) if isinstance(item, Relation) else running.typeset(item)

    def unbroken(self, item: Formula | Relation) -> str:
        """Return the elements of display mathematics on one line, such as a label in a drawing."""
        return (self.relation(item) if isinstance(item, Relation) else self.typeset(item)).source

    def display(self, relations: Sequence[Relation], *, boxed: int = 0, end: str = ".") -> str:
        """Return one `math` element: a line, centred lines, or lines aligned at the first sign of each relation.

        `--excess` says by how much it is wider than the line where it could not be broken; print shrinks it so far.
        """
        rows, are_aligned = Layout(self, self.width, boxed=boxed, end=end).rows(relations)
        widest = max(line.left.width if line.left else 0.0 for line in rows) + max(line.right.width for line in rows)
        style = f' style="--excess:{widest / self.width:.2f}"' if widest > _EXCESS * self.width else ""
        if len(rows) == 1 and not are_aligned:
            return f'<math display="block"{style}>{rows[0].right.source}</math>'
        lines = [f"<mtd>{line.right.source}</mtd>" for line in rows]
        if are_aligned:
            lefts = [line.left.source if line.left else "" for line in rows]
            lines = [f"<mtd>{left}</mtd>{line}" for left, line in zip(lefts, lines, strict=True)]
        body = table(lines, "aligned" if are_aligned else "centred")
        return f'<math display="block"{style}>{body}</math>'

    # -- glyphs ---------------------------------------------------------------------------------------------------

    def letter(self, name: str, mark: str) -> MathmlBox:
        """Return a letter; ẋ, x with the index k or k + 1."""
        form = self.letter_latex(name)
        first, *rest = parts_of(form)
        if mark == "dot":
            first = accented(first, "dot")
        elif mark:
            first = indexed(first, mark)
        level = Level.POWER if "^" in form else Level.ATOM
        apart = (first.base, first.below) if first.below and not first.above and not rest else None
        elements = (first.written, *(part.written for part in rest))
        return MathmlBox(widths.source_width(f"{form}_{{{mark}}}"), level, elements, 0, apart)

    def leaf(self, value: Scalar) -> MathmlBox:
        """Return a whole number or a symbol."""
        if value.is_constant:
            digits = digits_of(value)
            step = _DIGITS if self.running and len(digits) > _LONG_NUMBER else len(digits)
            runs = tuple(f"<mn>{digits[start : start + step]}</mn>" for start in range(0, len(digits), step))
            return MathmlBox(len(digits) * widths.DIGIT, Level.ATOM, runs)
        (name,) = value.names
        return self.named(symbol_latex(name, self.symbols.get(name)))

    def named(self, form: str) -> MathmlBox:
        """Return the letter."""
        parts = parts_of(form)
        apart = (parts[0].base, parts[0].below) if len(parts) == 1 and parts[0].below and not parts[0].above else None
        return MathmlBox(widths.source_width(form), Level.ATOM, tuple(part.written for part in parts), 0, apart)

    def identity(self) -> MathmlBox:
        """Write I."""
        return MathmlBox(0.5, Level.ATOM, ("<mi>I</mi>",))

    def empty(self, shape: tuple[int, int]) -> MathmlBox:
        """Return a zero with its shape."""
        below = f"<mrow><mn>{shape[0]}</mn><mo>×</mo><mn>{shape[1]}</mn></mrow>"
        return MathmlBox(2.0, Level.ATOM, (f"<msub><mn>0</mn>{below}</msub>",))

    def sign(self, *, negative: bool, leading: bool) -> MathmlBox:
        """Return plus or minus."""
        sign = MINUS if negative else PLUS
        element = f'<mo form="prefix">{sign}</mo>' if leading else BINARY[sign]
        return MathmlBox(widths.SIGN if leading else widths.OPERATOR, Level.SUM, (element,))

    def comparison(self, operator: str) -> MathmlBox:
        """Return the sign of a relation."""
        return MathmlBox(widths.RELATION, Level.SUM, (RELATIONS[operator],))

    def joined(self, parts: Sequence[MathmlBox], level: Level) -> MathmlBox:
        """Return the elements one after the other."""
        elements = tuple(element for part in parts for element in part.elements)
        return MathmlBox(sum(part.width for part in parts), level, elements, max(part.height for part in parts))

    def between(self, left: MathmlBox, right: MathmlBox) -> MathmlBox:
        """Return a dot before a number, a thin space beside a tall factor or a word, else an invisible times."""
        if _NUMBER.match(right.elements[0]):
            return MathmlBox(0.7, Level.PRODUCT, (DOT,))
        if self.running and left.width + right.width > _WIDE:
            return MathmlBox(0.0, Level.PRODUCT, (TIMES_OR_BREAK,))
        is_apart = max(left.height, right.height) > 0 or is_word(left.elements[-1]) or is_word(right.elements[0])
        return MathmlBox(0.17, Level.PRODUCT, (_SPACED,)) if is_apart else MathmlBox(0.0, Level.PRODUCT, (TIMES,))

    def grouped(self, box: MathmlBox) -> MathmlBox:
        """Return parentheses as tall as their content, breakable in running text."""
        if self.running:
            return MathmlBox(box.width + 0.8, Level.ATOM, (OPENING, *box.elements, CLOSING), box.height)
        if box.height == 0:
            return MathmlBox(box.width + 0.8, Level.ATOM, (f"<mrow>{OPENING}{box.source}{CLOSING}</mrow>",))
        inside = f'<mo form="prefix">(</mo>{box.one}<mo form="postfix">)</mo>'
        return MathmlBox(box.width + 1.6, Level.ATOM, (f"<mrow>{inside}</mrow>",), box.height)

    def fraction(self, above: MathmlBox, below: MathmlBox) -> MathmlBox:
        """Return a fraction; in exponents, and in running text where one part is long, a slash."""
        width = max(above.width, below.width)
        is_long = self.running and (width > _NARROW or min(above.level, below.level) < Level.PRODUCT)
        if self.in_exponent or is_long:
            parts = [self.at_least(Level.PRODUCT, above), self.slash(), self.at_least(Level.POWER, below)]
            return self.joined(parts, Level.PRODUCT)
        element = f"<mfrac>{above.one}{below.one}</mfrac>"
        return MathmlBox(width + widths.FRACTION_BAR, Level.FRACTION, (element,), 1)

    def raised(self, base: MathmlBox, exponent: int) -> MathmlBox:
        """Return a power."""
        digits = f"<mn>{abs(exponent)}</mn>"
        script = digits if exponent >= 0 else f'<mrow><mo form="prefix">−</mo>{digits}</mrow>'
        return self._above(base, script, len(str(exponent)) * widths.DIGIT)

    def to_the_instant(self, base: MathmlBox) -> MathmlBox:
        """Return the k-th power."""
        return self._above(base, "<mi>k</mi>", 0.5)

    def transposed(self, base: MathmlBox) -> MathmlBox:
        """Return the transpose."""
        return self._above(base, TRANSPOSE, 0.7)

    def _above(self, base: MathmlBox, script: str, width: float) -> MathmlBox:
        width = base.width + widths.SCRIPT * width
        if base.indexed:
            return MathmlBox(width, Level.POWER, (f"<msubsup>{''.join(base.indexed)}{script}</msubsup>",), base.height)
        *front, last = base.elements
        if last in {CLOSING, LIST[1]}:  # a line may end between these parentheses
            elements = (*front, f"<msup>{last}{script}</msup>")
            return MathmlBox(width, Level.POWER, elements, base.height)
        return MathmlBox(width, Level.POWER, (f"<msup>{base.one}{script}</msup>",), base.height)

    def applied(self, function: str, argument: MathmlBox) -> MathmlBox:
        """Return a function's name and its argument."""
        form = self.function_latex(function)
        is_enclosed = ">(</mo>" in argument.elements[0][:60]
        elements = (*elements_of(form), APPLY, *(() if is_enclosed else (THIN,)), *argument.elements)
        return MathmlBox(widths.source_width(form) + argument.width + 0.2, Level.PRODUCT, elements, argument.height)

    def matrix(self, rows: Sequence[Sequence[MathmlBox]], rules: Rules = NO_RULES) -> MathmlBox:
        """Return a table in brackets; in running text small, or a list where it is wide or high."""
        columns = len(rows[0])
        width = sum(max(row[j].width for row in rows) for j in range(columns))
        width += (columns - 1) * widths.COLUMN_GAP + widths.BRACKETS
        if self.running and (width > _WIDE or len(rows) > ROWS_IN_A_LINE):
            return _list_of(rows)
        body, size = "", LARGE * (not self.running and any(is_large(entry) for line in rows for entry in line))
        for below, line in enumerate(rows):
            ends = [size + ruled_edges(below in rules[0], after in rules[1]) for after in range(columns)]
            body += f"<mtr>{''.join(map(_cell, line, [STRUT, *[''] * (columns - 1)], ends))}</mtr>"
        small = ' scriptlevel="+1"' if self.running and len(rows) > 1 else ""
        fences = '<mo form="prefix">[</mo>', '<mo form="postfix">]</mo>'
        element = f"<mrow{small}>{fences[0]}<mtable>{body}</mtable>{fences[1]}</mrow>"
        return MathmlBox(width, Level.ATOM, (element,), max(2, len(rows)))

    def rate(self, box: MathmlBox, name: str = "t") -> MathmlBox:
        """Return d/dt before a stack."""
        below = row(("<mi>d</mi>", *elements_of(symbol_latex(name))))
        elements = (f"<mfrac><mi>d</mi>{below}</mfrac>", _SPACED.replace(TIMES, APPLY), *box.elements)
        return MathmlBox(box.width + 1.2, Level.PRODUCT, elements, max(1, box.height))

    # -- functions of time ----------------------------------------------------------------------------------------

    def exponential(self, argument: Scalar) -> MathmlBox:
        """Return the exponential, e of 1: fractions in its exponent with a slash."""
        if argument.is_one:
            return MathmlBox(0.47, Level.ATOM, ("<mi>e</mi>",))
        exponent = self.styled(in_exponent=True).exponent(argument)
        element = f"<msup><mi>e</mi>{exponent.one}</msup>"
        return MathmlBox(0.47 + widths.SCRIPT * exponent.width, Level.POWER, (element,))

    def root(self, argument: MathmlBox, degree: int = 2) -> MathmlBox:
        """Return a root."""
        root = f"<msqrt>{argument.source}</msqrt>" if degree == 2 else f"<mroot>{argument.one}<mn>{degree}</mn></mroot>"
        return MathmlBox(argument.width + 0.9, Level.ATOM, (root,), argument.height)

    def summed(self, over: MathmlBox, term: MathmlBox) -> MathmlBox:
        """Return a sum over all that fulfil an equation."""
        width = widths.SCRIPT * over.width + term.width
        elements = (f'<munder><mo form="prefix">∑</mo>{over.one}</munder>', *term.elements)
        return MathmlBox(width, Level.PRODUCT, elements, max(2, term.height))

    def evaluated(self, box: MathmlBox, equations: Sequence[MathmlBox]) -> MathmlBox:
        """Return the value behind a bar."""
        where: list[str] = []
        for equation in equations:
            where += [COMMA, *equation.elements] if where else equation.elements
        width = box.width + 0.2 + widths.SCRIPT * sum(equation.width for equation in equations)
        element = f"<msub><mrow>{box.one}{BAR}</mrow>{row(tuple(where))}</msub>"
        return MathmlBox(width, Level.POWER, (element,), max(1, box.height))

    def integral(self, limits: tuple[MathmlBox, MathmlBox], integrand: MathmlBox, name: MathmlBox) -> MathmlBox:
        """Return an integral with its limits."""
        lower, upper = limits
        sign = f'<msubsup><mo form="prefix">∫</mo>{lower.one}{upper.one}</msubsup>'
        elements = (sign, *integrand.elements, THIN, "<mi>d</mi>", *name.elements)
        width = 1.2 + widths.SCRIPT * max(limit.width for limit in limits) + integrand.width + name.width + 0.7
        return MathmlBox(width, Level.PRODUCT, elements, max(1, integrand.height))

    # -- glyphs of broken lines -----------------------------------------------------------------------------------

    def parentheses(self, content: Sequence[MathmlBox]) -> tuple[MathmlBox, MathmlBox]:
        """Return a pair of parentheses of fixed size, which may be on different rows."""
        return _sized("(", ")", _SIZES[min(3, max(box.height for box in content))], 0.8)

    def brackets(self) -> tuple[MathmlBox, MathmlBox]:
        """Return the same, square."""
        return _sized("[", "]", _SIZES[0], 0.6)

    def separators(self) -> tuple[MathmlBox, MathmlBox]:
        """Return comma and semicolon."""
        return MathmlBox(0.5, Level.SUM, (COMMA,)), MathmlBox(0.7, Level.SUM, (SEMICOLON,))

    def dot(self) -> MathmlBox:
        """Return the dot."""
        return MathmlBox(0.9, Level.SUM, (DOT,))

    def slash(self) -> MathmlBox:
        """Return a slash."""
        return MathmlBox(0.5, Level.SUM, (SLASH,))

    def digits(self, run: str) -> MathmlBox:
        """Return a part of a number."""
        return MathmlBox(len(run) * widths.DIGIT, Level.ATOM, (f"<mn>{run}</mn>",))

    def continued(self) -> MathmlBox:
        """Return a hooked arrow."""
        return MathmlBox(1.5, Level.SUM, (f'<mi mathvariant="normal">↪</mi>{THIN}',))

    def star(self, number: int) -> MathmlBox:
        """Return an asterisk with a number."""
        element = f'<msub><mi mathvariant="normal">\N{ASTERISK OPERATOR}</mi><mn>{number}</mn></msub>'
        return MathmlBox(0.5 + len(str(number)) * widths.DIGIT * widths.SCRIPT, Level.ATOM, (element,))

    def entry_of(self, matrix: MathmlBox, indices: Sequence[int]) -> MathmlBox:
        """Return the matrix with its indices, in parentheses where it is more than a letter."""
        base = matrix if matrix.level == Level.ATOM and not matrix.indexed else self.grouped(matrix)
        separator = "," if max(indices) > 9 else ""
        below = separator.join(map(str, indices))
        width = base.width + widths.SCRIPT * len(below) * widths.DIGIT
        return MathmlBox(width, Level.POWER, (f"<msub>{base.one}<mn>{below}</mn></msub>",), base.height)

    def indent(self) -> MathmlBox:
        """Return a space."""
        return MathmlBox(1.0, Level.SUM, ('<mspace width="1em"/>',))

    def framed(self, box: MathmlBox) -> MathmlBox:
        """Return a framed row."""
        element = f'<mrow class="answer">{box.source}</mrow>'
        return MathmlBox(box.width + widths.FRAME, Level.ATOM, (element,), max(1, box.height))

    def stacked(self, lines: Sequence[MathmlBox]) -> MathmlBox:
        """Return lines of a table, all but the first indented."""
        indented = [lines[0], *(self.joined([self.indent(), line], Level.SUM) for line in lines[1:])]
        element = table([f"<mtd>{line.source}</mtd>" for line in indented], "lines")
        return MathmlBox(max(line.width for line in indented) + widths.COLUMN_GAP, Level.SUM, (element,), 2)

    def punctuation(self, mark: str) -> MathmlBox:
        """Return a comma or full stop."""
        return MathmlBox(0.45, Level.SUM, (text(mark),))

    def gap(self) -> MathmlBox:
        """Return a wide space."""
        return MathmlBox(2.0, Level.SUM, ('<mspace width="2em"/>',))


def _cell(entry: MathmlBox, strut: str, attributes: str) -> str:
    return f"<mtd{attributes}>{strut}{entry.source}</mtd>"


def is_large(entry: MathmlBox) -> bool:
    """Return whether an entry of a table is set large: a fraction with more than numbers in it."""
    has_fraction = any(element.startswith("<mfrac>") for element in entry.elements[:2])
    return has_fraction and not _FRACTION_OF_NUMBERS.fullmatch(entry.elements[-1])


def _list_of(rows: Sequence[Sequence[MathmlBox]]) -> MathmlBox:
    """Return a matrix as a list of its entries, [a, b; c, d]."""
    elements: list[str] = []
    for line in rows:
        for place, entry in enumerate(line):
            mark = COMMA if place else SEMICOLON
            elements += [mark, *entry.elements] if elements else entry.elements
    width = sum(entry.width + widths.COLUMN_GAP for line in rows for entry in line)
    return MathmlBox(width, Level.ATOM, (LIST[0], *elements, LIST[1]))


def _sized(opening: str, closing: str, size: str, width: float) -> tuple[MathmlBox, MathmlBox]:
    """Return a pair of fences of one size."""
    left, right = sized(opening, closing, size)
    return MathmlBox(width, Level.SUM, (left,)), MathmlBox(width, Level.SUM, (right,))
