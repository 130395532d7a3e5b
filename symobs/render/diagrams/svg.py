"""Block diagrams in SVG: one self-contained element in the colour of the surrounding text."""

from __future__ import annotations

import re
import unicodedata
from typing import TYPE_CHECKING, NamedTuple
from xml.sax.saxutils import escape

from symobs.exact import Scalar
from symobs.figures.block_diagram import without_sign
from symobs.formula import Conjunction, Literal, Quotient, Relation
from symobs.phrases import PHRASES
from symobs.render.diagrams.diagram_layout import Arrangement, Metrics, arranged
from symobs.render.plots.scene import coordinate
from symobs.render.plots.svg_text import BELOW, DOT, FONTS, TextRun, spans, width_of
from symobs.render.printers.glyphs import Level
from symobs.render.printers.scalar_formula import formula_of
from symobs.render.printers.text_printer import TextBox, TextPrinter, text_box

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.figures.block_diagram import Label
    from symobs.formula import Formula
    from symobs.render.diagrams.diagram_layout import DiagramBox, DiagramMark, Line, Point, SignMark
    from symobs.render.page.blocks import Drawing

#: Units of an em, pixels of a unit.
_EM, _PIXELS = 12.0, 4 / 3
#: In em: the widest drawing, the height of a line and of a fraction, what is left free around the drawing.
_WIDTH, _LINE, _FRACTION, _MARGIN = 46.0, 1.3, 2.7, 0.7
_RADIUS, _HEAD = 0.475, 0.62
_DOT = "\u0307"
#: What stands below a letter on a terminal: K_d, χ_(A-BK).
_THIN_SPACE = "\u2009"
_FACTORS = re.compile(r"(?<=[^-+=·,;]) (?=[^-+=·])")
_BELOW = re.compile(r"_\(?([\w-]+)\)?")


class _Row(NamedTuple):
    """A line of text, and below a rule another one where it is a fraction."""

    text: str
    below: str = ""
    lead: str = ""

    @property
    def height(self) -> float:
        """In em."""
        return _FRACTION if self.below else _LINE

    @property
    def width(self) -> float:
        """In em."""
        return max(_width(self.text), _width(self.below)) + _width(self.lead) + (0.3 if self.below else 0)


class _Letters(TextPrinter):
    """Formulas on one line as on a terminal, derivatives with a dot."""

    def letter(self, name: str, mark: str) -> TextBox:
        """Return a letter, with a dot above an existing accent."""
        if mark == "dot":
            text = self.letter_text(name)
            return text_box(text + (DOT if unicodedata.combining(text[-1]) else _DOT), Level.POWER)
        return super().letter(name, mark)


def svg(drawing: Drawing, printer: TextPrinter) -> str:
    """Return a diagram as an `svg` element of a page."""
    letters = _letters(printer)
    arrangement = arranged(drawing, metrics_of(printer), _WIDTH, discrete=printer.discrete)
    left, top = -_MARGIN * _EM, -_MARGIN * _EM
    width, height = (_EM * (part + 2 * _MARGIN) for part in arrangement.size)
    box = " ".join(map(coordinate, (left, top, width, height)))
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="symobs-diagram" role="img" viewBox="{box}" '
        f'width="{coordinate(_PIXELS * width)}" height="{coordinate(_PIXELS * height)}" font-family="{FONTS}" '
        f'font-size="{coordinate(_EM)}" fill="none" stroke="currentColor" stroke-width=".9">'
    )
    return "\n".join(
        [head, f"<title>{escape(PHRASES['block_diagram'])}</title>", *_drawn(arrangement, letters), "</svg>"]
    )


def metrics_of(printer: TextPrinter) -> Metrics:
    """Return the measures of a diagram for unknown fonts."""
    letters = _letters(printer)

    def measure(label: Label) -> Point:
        rows = _rows(label, letters)
        return max(row.width for row in rows), sum(row.height for row in rows)

    return Metrics(measure, inside=(0.55, 0.3), smallest=2.0, junction=0.95, gap=(1.9, 1.1), beside=0.3, sign=1.2)


def _letters(printer: TextPrinter) -> TextPrinter:
    """Return a printer of the same letters."""
    letters = _Letters(printer.variable, printer.symbols, discrete=printer.discrete, flat=True)
    letters.letters = printer.letters
    return letters


def _rows(label: Label, printer: TextPrinter) -> list[_Row]:
    if isinstance(label, Conjunction):
        return [_Row(_text(relation, printer)) for relation in label.relations]
    return [_row(label, printer)]


def _row(formula: Formula, printer: TextPrinter) -> _Row:
    """Return a formula, as a fraction where it is one."""
    negative, body = without_sign(formula)
    if isinstance(body, Literal) and isinstance(body.value, Scalar):
        is_written_negative, body = without_sign(formula_of(body.value, printer.variable))
        negative = negative != is_written_negative
    if isinstance(body, Quotient):
        return _Row(_text(body.numerator, printer), _text(body.denominator, printer), "−" if negative else "")
    return _Row(_text(formula, printer))


def _text(item: Formula | Relation, printer: TextPrinter) -> str:
    """Return mathematics on one line, with subscripts marked."""
    written = _FACTORS.sub(_THIN_SPACE, printer.inline(item)).replace("-", "−")
    return _BELOW.sub(lambda found: "".join(BELOW + character for character in found[1]), written)


def _width(text: str) -> float:
    return width_of([TextRun(text, is_math=True)], 1.0)


# -- elements ---------------------------------------------------------------------------------------------------------


def _drawn(arrangement: Arrangement, printer: TextPrinter) -> Iterator[str]:
    yield f'<path d="{"".join(_path(line.points) for line in arrangement.lines)}"/>'
    heads = "".join(_head(line) for line in arrangement.lines if line.is_arrow)
    yield f'<path fill="currentColor" stroke="none" d="{heads}"/>'
    for box in arrangement.boxes:
        yield _rectangle(box)
        yield from _label(box.label, box.centre, printer)
    for x, y in arrangement.junctions:
        yield f'<circle cx="{_length(x)}" cy="{_length(y)}" r="{_length(_RADIUS)}"/>'
    for x, y in arrangement.branches:
        yield f'<circle fill="currentColor" stroke="none" cx="{_length(x)}" cy="{_length(y)}" r="{_length(0.16)}"/>'
    for mark in arrangement.marks:
        yield from _mark(mark, printer)
    for sign in arrangement.signs:
        yield _sign(sign)


def _rectangle(box: DiagramBox) -> str:
    (x, y), (width, height) = box.centre, box.size
    corner = f'x="{_length(x - width / 2)}" y="{_length(y - height / 2)}"'
    return f'<rect {corner} width="{_length(width)}" height="{_length(height)}"/>'


def _path(points: tuple[Point, ...]) -> str:
    return "M" + "L".join(f"{_length(x)} {_length(y)}" for x, y in points)


def _head(line: Line) -> str:
    """Return the head of an arrow at the end of a wire."""
    (x0, y0), (x1, y1) = line.points[-2:]
    long = abs(x1 - x0) + abs(y1 - y0)
    across, down = (x1 - x0) / long, (y1 - y0) / long
    back = x1 - _HEAD * across, y1 - _HEAD * down
    wings = [(back[0] + side * down * _HEAD / 3, back[1] + side * across * _HEAD / 3) for side in (1, -1)]
    return _path(((x1, y1), *wings)) + "Z"


def _label(label: Label, centre: Point, printer: TextPrinter, anchor: str = "middle") -> Iterator[str]:
    """Return rows, one below another, centred at a place."""
    rows = _rows(label, printer)
    top = centre[1] - sum(row.height for row in rows) / 2
    for row in rows:
        yield from _written_row(row, (centre[0], top + row.height / 2), anchor)
        top += row.height


def _written_row(row: _Row, centre: Point, anchor: str) -> Iterator[str]:
    if not row.below:
        yield _written(row.text, centre, anchor)
        return
    x, y = centre[0] + _width(row.lead) / 2, centre[1]
    half = max(_width(row.text), _width(row.below)) / 2 + 0.1
    yield _written(row.text, (x, y - _LINE / 2))
    yield _written(row.below, (x, y + _LINE / 2))
    yield f'<path d="{_path(((x - half, y), (x + half, y)))}"/>'
    if row.lead:
        yield _written(row.lead, (x - half - _width(row.lead) / 2, y))


def _mark(mark: DiagramMark, printer: TextPrinter) -> Iterator[str]:
    x, y = mark.place
    if mark.side == "right":
        return _label(mark.label, (x + 0.4, y), printer, "start")
    return _label(mark.label, (x, y - 0.75) if mark.side == "above" else (x, y), printer)


def _sign(sign: SignMark) -> str:
    (x, y), (across, down) = sign.place, sign.towards
    place = (x - 0.6 * across + 0.66 * abs(down), y - 0.6 * down - 0.6 * abs(across))
    return _written("−" if sign.is_negative else "+", place, size=0.85)


def _written(text: str, centre: Point, anchor: str = "middle", size: float = 1.0) -> str:
    """Return a line of text with its middle at a height."""
    inside = spans([TextRun(text, is_math=True)], size * _EM)
    place = f'x="{_length(centre[0])}" y="{_length(centre[1] + 0.32 * size)}"'
    font = f' font-size="{_length(size)}"' if size != 1 else ""
    return f'<text {place} text-anchor="{anchor}" fill="currentColor" stroke="none"{font}>{inside}</text>'


def _length(value: float) -> str:
    return coordinate(_EM * value)
