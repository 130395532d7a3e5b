"""The writer of SVG: one self-contained element, for a page or a file.

Text is real text in the colour of the page around it.  A page may set `--symobs-ink` (curves and shade of a plot) and
`--symobs-paper` (the inside of open circles); without them a blue is used that can be read on white and on black, and
the browser's own background.
"""

from __future__ import annotations

import re
import unicodedata
from html import escape
from itertools import groupby
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Scalar
from symobs.formula.figures import without_sign
from symobs.formula.tree import Conjunction, Literal, Quotient
from symobs.pages.drawings.diagram_layout import Metrics, diagram_scene
from symobs.pages.drawings.plot_layout import plot_scene
from symobs.pages.drawings.scene import (
    FONT_SIZE,
    NARROWEST,
    RADIUS,
    STYLES,
    Rectangle,
    arrow_head,
    caption_below,
    coordinate,
    head_of,
    spaced,
)
from symobs.pages.page.blocks import Drawing
from symobs.pages.printers.glyphs import Level
from symobs.pages.printers.scalar_formula import formula_of
from symobs.pages.printers.text_printer import TextBox, TextPrinter, text_box

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from symobs.formula.figures import Drawn, Label
    from symobs.formula.tree import Formula, Relation
    from symobs.pages.drawings.scene import Box, Content, Measure, Point, Scene, Sign, Stroke, TextLabel


# Text in SVG: letters of mathematics in italics, sub- and superscripts smaller and off the line.


FONTS = "'STIX Two Text','Latin Modern Roman','Cambria','Times New Roman','DejaVu Serif',serif"
#: Sub- and superscripts: their size, and how far they are lowered, in parts of the size of the font.
_SCRIPT, _LOWERED = 0.72, {"sub": 0.2, "super": -0.36, "": 0.0, "dot": -0.2}
#: The character after this one stands below the letter before, upright.
BELOW = "\ue000"
#: A dot above an accent: fonts put both at one place, so it is a character of its own, set back over the letter.
DOT, _SET_BACK = "\ue001", 0.36
_ACCENT_DOT, _THIN_SPACE = "\u0307", "\u2009"
#: Two factors side by side; what stands below a letter on a terminal: K_d, χ_(A-BK).
_FACTORS = re.compile(r"(?<=[^-+=·,;]) (?=[^-+=·])")
_BELOW = re.compile(r"_\(?([\w-]+)\)?")
#: In parts of the size of the font: the height of a line, of a fraction, and what a rule is longer than its fraction.
_LINE, _FRACTION, _RULE = 1.3, 2.7, 0.3
#: Names of several letters, such as Re, stand upright.
_WORDS = re.compile(r"[A-Za-z]{2,}")


_SPECIAL_WIDTHS = {
    **dict.fromkeys("ijlIft.,:;!|'()[]/ ", 0.36),
    **dict.fromkeys("mwMW", 0.9),
    **dict.fromkeys("+−=<>≤≥≠±", 0.68),
}


class TextRun(NamedTuple):
    """A part of a line of text; letters of mathematics are set in italics."""

    text: str
    is_math: bool = False


class TextRow(NamedTuple):
    """A line of text, and below a rule another one where it is a fraction, with its sign before it."""

    text: TextRun
    below: TextRun | None = None
    lead: TextRun = TextRun("")

    @property
    def height(self) -> float:
        """In parts of the size of the font."""
        return _FRACTION if self.below else _LINE

    @property
    def width(self) -> float:
        """In parts of the size of the font."""
        widest = max(width_of([run], 1.0) for run in (self.text, self.below) if run)
        return widest + width_of([self.lead], 1.0) + (_RULE if self.below else 0)


class Letters(TextPrinter):
    """Formulas on one line as on a terminal, derivatives with a dot."""

    def letter(self, name: str, mark: str) -> TextBox:
        """Return a letter, with a dot above an existing accent."""
        if mark == "dot":
            text = self.letter_text(name)
            return text_box(text + (DOT if unicodedata.combining(text[-1]) else _ACCENT_DOT), Level.POWER)
        return super().letter(name, mark)


def rows_of(content: Content, printer: TextPrinter, *, stacked: bool = False) -> list[TextRow]:
    """Return what is written in rows; with `stacked` a fraction has a rule and thin spaces stand between factors."""
    if isinstance(content, str):
        return [TextRow(TextRun(content.replace("-", "−")))]
    if isinstance(content, Conjunction):
        return [TextRow(_run(relation, printer)) for relation in content.relations]
    if not stacked:
        return [TextRow(TextRun(text_of(content, printer), is_math=True))]
    negative, body = without_sign(content)  # type: ignore[arg-type]
    if isinstance(body, Literal) and isinstance(body.value, Scalar):
        is_written_negative, body = without_sign(formula_of(body.value, printer.variable))
        negative = negative != is_written_negative
    if isinstance(body, Quotient):
        return [
            TextRow(_run(body.numerator, printer), _run(body.denominator, printer), TextRun("−" if negative else ""))
        ]
    return [TextRow(_run(content, printer))]


def _run(item: Formula | Relation, printer: TextPrinter) -> TextRun:
    return TextRun(_FACTORS.sub(_THIN_SPACE, text_of(item, printer)), is_math=True)


def text_of(item: Formula | Relation, printer: TextPrinter) -> str:
    """Return mathematics on one line, with subscripts marked."""
    written = printer.inline(item).replace("-", "−")
    return _BELOW.sub(lambda found: "".join(BELOW + character for character in found[1]), written)


def width_of(pieces: Iterable[TextRun], size: float) -> float:
    """Return a generous estimate of the width of text, for unknown fonts; accents have no width."""
    return size * sum(
        (_SCRIPT if level else 1.0) * _SPECIAL_WIDTHS.get(character, 0.56)
        for piece in pieces
        for character, level, _ in _characters(piece)
        if not unicodedata.combining(character) and character != DOT
    )


def spans(pieces: Iterable[TextRun], size: float) -> str:
    """Return the content of a text element, with sub- and superscripts shifted."""
    written: list[str] = []
    before = 0.0
    every = (character for piece in pieces for character in _characters(piece))
    for (level, is_italic), run in groupby(every, key=lambda item: item[1:]):
        text = escape("".join(character for character, _, _ in run), quote=False).replace(DOT, "˙")
        lowered = _LOWERED[level] * size
        attributes = [f'dy="{coordinate(lowered - before)}"'] if lowered != before else []
        attributes += [f'dx="{coordinate(-_SET_BACK * size)}"'] if level == "dot" else []
        attributes += [f'font-size="{coordinate(_SCRIPT * size)}"'] if level in {"sub", "super"} else []
        attributes += ['font-style="italic"'] if is_italic else []
        written.append(f"<tspan {' '.join(attributes)}>{text}</tspan>" if attributes else text)
        before = lowered
    return "".join(written)


def _characters(piece: TextRun) -> Iterator[tuple[str, str, bool]]:
    """Yield every character, whether it is a sub- or superscript, and whether it is set in italics."""
    words = {place for word in _WORDS.finditer(piece.text) for place in range(*word.span())}
    is_italic = False
    for place, character in enumerate(piece.text):
        form = unicodedata.decomposition(character)
        level = {"<sub>": "sub", "<super>": "super"}.get(form.partition(" ")[0], "")
        plain = unicodedata.normalize("NFKC", character) if level else character
        if character == BELOW:
            continue
        if character == DOT:
            yield character, "dot", False
            continue
        if place and piece.text[place - 1] == BELOW:
            yield character, "sub", False
            continue
        if not unicodedata.combining(character):  # an accent goes with its letter
            is_italic = piece.is_math and plain.isalpha() and place not in words
        yield plain, level, is_italic


_INK, _PIXELS = "#3b74c9", 4 / 3
_CLASSES = {"ink": "ink", "text": "axis", "pale": "pale"}
_ANCHORS = {"west": "start", "east": "end", "right": "start"}
#: How far the middle of a text stands from its anchor, in parts of the size of the font.
_OFFSETS = {"north": (0.0, 0.45), "south": (0.0, -0.5), "above": (0.0, -0.75), "right": (0.4, 0.0)}


_STYLE = (
    ".symobs-picture .ink{stroke:var(--symobs-ink,#3b74c9)}"
    ".symobs-picture .full{fill:var(--symobs-ink,#3b74c9)}"
    ".symobs-picture .open{fill:var(--symobs-paper,Canvas)}"
)


_OWN_FILE = "svg{color-scheme:light dark;color:CanvasText}"
#: In a diagram: the size of its font and the widest drawing, in points; in parts of that size what is left free around,
#: the radii of junctions and branches, the heads of arrows, and where signs stand, along a wire and beside it.
_EM, _WIDEST = 12.0, 46.0 * 12
_MARGIN, _JUNCTION, _BRANCH, _HEAD = 0.7, 0.475, 0.16, 0.62
_ALONG, _RIGHT, _OVER, _SIGN = 0.6, 0.66, 0.6, 0.85


def svg_scene(item: Drawing | Drawn, printer: TextPrinter) -> Scene:
    """Return the scene of a plot or a diagram in the measures of SVG."""
    if isinstance(item, Drawing):
        return diagram_scene(item, metrics_of(printer), _WIDEST, discrete=printer.discrete)
    return plot_scene(item, measure_for(printer), printer.language)


def svg(scene: Scene, printer: TextPrinter, title: str = "", *, alone: bool = False) -> str:
    """Return a scene as an `svg` element of a page, or of a file where it is `alone`; `title` is its text alternative."""
    writer = _Writer(scene, printer)
    whole = scene.whole.grown(_MARGIN * _EM) if scene.is_diagram else scene.whole
    return writer.element(
        whole, writer.drawn(), title, "" if scene.is_diagram else (_OWN_FILE if alone else "") + _STYLE
    )


def svg_file(picture: Drawn, printer: TextPrinter) -> str:
    """Return a plot with its caption as an SVG file."""
    scene = svg_scene(picture, printer)
    letters, space = Letters.of(printer, flat=True), TextRun(" ")
    widest = max(scene.whole.right - scene.whole.left, NARROWEST) / 2

    def mathematics(content: Formula | Relation) -> list[TextRun]:
        piece = TextRun(text_of(content, letters), is_math=True)
        parts = [piece.text] if _width([piece]) <= widest else piece.text.split(" ")
        return [TextRun(part, is_math=True) for part in parts]

    whole, rows = caption_below(
        picture, scene, printer.language, TextRun, mathematics, lambda piece: _width([piece]), _width([space])
    )
    lines = [(place, spaced(row, space)) for place, row in rows]
    writer = _Writer(scene, printer)
    under = [writer.written(line, place, "start") for place, line in lines]
    title = " ".join("".join(piece.text for piece in line) for _, line in lines)
    return writer.element(whole, [*writer.drawn(), *under], title, _OWN_FILE + _STYLE) + "\n"


# -- measures ---------------------------------------------------------------------------------------------------------


def _width(pieces: Iterable[TextRun]) -> float:
    return width_of(pieces, FONT_SIZE)


def measure_for(printer: TextPrinter) -> Measure:
    """Return a generous estimate of the width and height of text in a plot, for unknown fonts."""
    letters = Letters.of(printer, flat=True)

    def measure(content: Content) -> Point:
        return max(row.width for row in rows_of(content, letters)) * FONT_SIZE, 1.15 * FONT_SIZE

    return measure


def metrics_of(printer: TextPrinter) -> Metrics:
    """Return the measures of a diagram for unknown fonts."""
    letters = Letters.of(printer, flat=True)

    def measure(label: Label) -> Point:
        rows = rows_of(label, letters, stacked=True)
        return _EM * max(row.width for row in rows), _EM * sum(row.height for row in rows)

    return Metrics(
        measure,
        inside=(0.55 * _EM, 0.3 * _EM),
        smallest=2 * _EM,
        junction=2 * _JUNCTION * _EM,
        gap=(1.9 * _EM, 1.1 * _EM),
        beside=0.3 * _EM,
        sign=1.2 * _EM,
    )


# -- elements ---------------------------------------------------------------------------------------------------------


class _Writer:
    """The elements of a scene: `down` is the direction of its y on the screen, `size` that of its font."""

    def __init__(self, scene: Scene, printer: TextPrinter) -> None:
        self.scene, self.letters = scene, Letters.of(printer, flat=True)
        self.down, self.size = (1, _EM) if scene.is_diagram else (-1, FONT_SIZE)

    def element(self, whole: Rectangle, parts: Iterable[str], title: str, style: str) -> str:
        """Return the whole element."""
        width, height = whole.right - whole.left, whole.top - whole.bottom
        top = min(self.down * whole.top, self.down * whole.bottom)
        box = " ".join(map(coordinate, (whole.left, top, width, height)))
        head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" class="symobs-{"diagram" if self.scene.is_diagram else "picture"}" '
            f'role="img" viewBox="{box}" width="{coordinate(_PIXELS * width)}" '
            f'height="{coordinate(_PIXELS * height)}" font-family="{FONTS}" font-size="{self.size:g}" fill="none" '
            'stroke-linejoin="round">'
        )
        named = [f"<title>{escape(title, quote=False)}</title>"] if title else []
        styled = [f"<style>{style}</style>"] if style else []
        return "\n".join([head, *named, *styled, *parts, "</svg>"])

    def drawn(self) -> Iterator[str]:
        """Yield the elements, from the lowest layer up."""
        scene = self.scene
        if scene.shades:
            areas = "".join(f"{self.path(area)}Z" for area in scene.shades)
            yield f'<path class="full" fill="{_INK}" fill-opacity=".2" d="{areas}"/>'
        for style, strokes in groupby(scene.strokes, key=lambda stroke: stroke.style):
            yield from self.strokes(style, list(strokes))
        for box in scene.boxes:
            yield from self.box(box)
        yield from map(self.sign, scene.signs)
        for text in scene.texts:
            yield from self.label(text)

    def strokes(self, name: str, strokes: Sequence[Stroke]) -> Iterator[str]:
        """Yield lines of one style, and the heads of arrows."""
        style = STYLES[name]
        colour = _INK if style.colour == "ink" else "currentColor"
        attributes = [f'class="{_CLASSES[style.colour]}" stroke="{colour}" stroke-width="{style.width}"']
        attributes += [f'stroke-dasharray="{" ".join(map(str, style.dashes))}"'] if style.dashes else []
        attributes += ['stroke-opacity=".35"'] if style.colour == "pale" else []
        yield f'<path {" ".join(attributes)} d="{"".join(self.path(stroke.points) for stroke in strokes)}"/>'
        if style.has_head:
            long = {"long": _HEAD * _EM} if self.scene.is_diagram else {}
            heads = "".join(f"{self.path(head_of(stroke, **long))}Z" for stroke in strokes)
            yield f'<path fill="currentColor" d="{heads}"/>'

    def box(self, box: Box) -> Iterator[str]:
        """Yield a box of a diagram, and its label in rows."""
        (x, y), (width, height) = box.centre, box.size
        corner = f'x="{coordinate(x - width / 2)}" y="{coordinate(y - height / 2)}"'
        size = f'width="{coordinate(width)}" height="{coordinate(height)}"'
        yield f'<rect stroke="currentColor" stroke-width="0.9" {corner} {size}/>'
        yield from self.rows(rows_of(box.content, self.letters, stacked=True), box.centre)

    def sign(self, sign: Sign) -> str:
        """Return a small sign."""
        x, y = coordinate(sign.place[0]), coordinate(self.down * sign.place[1])
        radius = RADIUS.get(sign.kind, 0.0)
        match sign.kind:
            case "dot":
                return f'<circle class="full" fill="{_INK}" cx="{x}" cy="{y}" r="{radius}"/>'
            case "ring":
                ink = f'stroke="{_INK}" stroke-width=".8"'
                return f'<circle class="ink open" fill="#fff" {ink} cx="{x}" cy="{y}" r="{radius}"/>'
            case "arrow":
                head = self.path(arrow_head(sign.place, sign.direction))
                return f'<path class="full" fill="{_INK}" d="{head}Z"/>'
            case "junction":
                ink = 'stroke="currentColor" stroke-width="0.9"'
                return f'<circle {ink} cx="{x}" cy="{y}" r="{coordinate(_JUNCTION * _EM)}"/>'
            case "branch":
                return f'<circle fill="currentColor" cx="{x}" cy="{y}" r="{coordinate(_BRANCH * _EM)}"/>'
            case "+" | "-":
                across, down = sign.direction
                aside = _RIGHT * abs(down) - _ALONG * across, -_ALONG * down - _OVER * abs(across)
                place = sign.place[0] + _EM * aside[0], sign.place[1] + _EM * aside[1]
                return self.written([TextRun(sign.kind.replace("-", "−"))], place, size=_SIGN)
            case _:
                cross = (
                    f"M{x} {y}m-{radius} -{radius}l{2 * radius} {2 * radius}m0 -{2 * radius}l-{2 * radius} {2 * radius}"
                )
                return f'<path class="ink" stroke="{_INK}" stroke-width=".8" d="{cross}"/>'

    def path(self, points: Iterable[Point]) -> str:
        """Return a line."""
        return "M" + "L".join(f"{coordinate(x)} {coordinate(self.down * y)}" for x, y in points)

    # -- text ---------------------------------------------------------------------------------------------------------

    def label(self, text: TextLabel) -> Iterator[str]:
        """Yield a label at its anchor."""
        across, down = _OFFSETS.get(text.anchor, (0.0, 0.0))
        place = text.place[0] + across * self.size, text.place[1] + self.down * down * self.size
        rows = rows_of(text.content, self.letters, stacked=self.scene.is_diagram)
        yield from self.rows(rows, place, _ANCHORS.get(text.anchor, "middle"))

    def rows(self, rows: Sequence[TextRow], centre: Point, anchor: str = "middle") -> Iterator[str]:
        """Yield rows, one below another, centred at a place."""
        (x, y), size = centre, self.size
        y -= self.down * size * sum(row.height for row in rows) / 2
        for row in rows:
            y += self.down * size * row.height / 2
            yield from self.row(row, (x, y), anchor)
            y += self.down * size * row.height / 2

    def row(self, row: TextRow, centre: Point, anchor: str) -> Iterator[str]:
        """Yield a row, a fraction with its rule."""
        if not row.below:
            yield self.written([row.text], centre, anchor)
            return
        lead = width_of([row.lead], self.size)
        x, y = centre[0] + lead / 2, centre[1]
        half = (row.width * self.size - lead) / 2 - 0.05 * self.size
        off = self.down * row.height * self.size / 4
        yield self.written([row.text], (x, y - off))
        yield self.written([row.below], (x, y + off))
        yield f'<path stroke="currentColor" stroke-width="0.9" d="{self.path(((x - half, y), (x + half, y)))}"/>'
        if row.lead.text:
            yield self.written([row.lead], (x - half - lead / 2, y))

    def written(self, pieces: Iterable[TextRun], centre: Point, anchor: str = "middle", size: float = 1.0) -> str:
        """Return a line of text with its middle at a height."""
        x, y = coordinate(centre[0]), coordinate(self.down * centre[1] + 0.3 * size * self.size)
        font = f' font-size="{coordinate(size * self.size)}"' if size != 1 else ""
        inside = spans(pieces, size * self.size)
        return f'<text x="{x}" y="{y}" text-anchor="{anchor}" fill="currentColor"{font}>{inside}</text>'
