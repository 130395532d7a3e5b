"""Plots as SVG: one self-contained element, for a page or a file.

Text is real text in the colour of the page around it.  A page may set `--symobs-ink` (curves and shade) and
`--symobs-paper` (the inside of open circles); without them a blue is used that can be read on white and on black, and
the browser's own background.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

from symobs.render.page.plot_captions import caption
from symobs.render.plots.caption_rows import ABOVE, NARROWEST, ROW, rows_of, spaced, words_of
from symobs.render.plots.numbered_caption import below
from symobs.render.plots.plot_layout import scene_of
from symobs.render.plots.scene import FONT_SIZE, RADIUS, STYLES, Rectangle, Sign, arrow_head, coordinate
from symobs.render.plots.svg_text import FONTS, TextRun, spans, width_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.figures.plot import Picture
    from symobs.formula import Formula, Relation
    from symobs.render.page.blocks import Inlines
    from symobs.render.plots.scene import Content, Measure, Point, Scene, Stroke
    from symobs.render.printers.text_printer import TextPrinter

_INK, _PIXELS = "#3b74c9", 4 / 3
_CLASSES = {"ink": "ink", "text": "axis", "pale": "pale"}
_ANCHORS = {"west": "start", "east": "end"}
#: Where the baseline stands below the anchor, in parts of the size of the font.
_BASELINES = {"north": 0.75, "south": -0.2}
_STYLE = (
    ".symobs-picture .ink{stroke:var(--symobs-ink,#3b74c9)}"
    ".symobs-picture .full{fill:var(--symobs-ink,#3b74c9)}"
    ".symobs-picture .open{fill:var(--symobs-paper,Canvas)}"
)
_OWN_FILE = "svg{color-scheme:light dark;color:CanvasText}"


def svg_scene(picture: Picture, printer: TextPrinter) -> Scene:
    """Return the scene of a plot in the measures of SVG."""
    return scene_of(picture, measure_for(printer))


def svg(scene: Scene, printer: TextPrinter, title: str = "") -> str:
    """Return a scene as an `svg` element of a page; `title` is its text alternative."""
    return _element(scene.whole, _drawn(scene, printer), title, _STYLE)


def svg_file(picture: Picture, printer: TextPrinter) -> str:
    """Return a plot with its caption as an SVG file."""
    scene = svg_scene(picture, printer)
    words = below(caption(picture), scene)
    lines = _caption_rows(words, scene.whole, printer)
    box = scene.whole
    right = max([box.right, *(box.left + 3 + _width(line) for line in lines)])
    whole = Rectangle(box.left, box.bottom - ABOVE - ROW * len(lines), right, box.top)
    under = [
        _written((box.left + 3, box.bottom - ABOVE - ROW * (place + 0.5)), "start", line)
        for place, line in enumerate(lines)
    ]
    title = " ".join("".join(piece.text for piece in line) for line in lines)
    return _element(whole, [*_drawn(scene, printer), *under], title, _OWN_FILE + _STYLE) + "\n"


def measure_for(printer: TextPrinter) -> Measure:
    """Return a generous estimate of the width and height of text in a plot, for unknown fonts."""

    def measure(content: Content) -> tuple[float, float]:
        return _width([_piece(content, printer)]), 1.15 * FONT_SIZE

    return measure


def _piece(content: Content, printer: TextPrinter) -> TextRun:
    return TextRun(content.replace("-", "−"), False) if isinstance(content, str) else _mathematics(content, printer)  # noqa: FBT003


def _mathematics(content: Formula | Relation, printer: TextPrinter) -> TextRun:
    return TextRun(printer.inline(content).replace("-", "−"), True)  # noqa: FBT003


# -- elements ---------------------------------------------------------------------------------------------------------


def _element(whole: Rectangle, parts: Iterable[str], title: str, style: str) -> str:
    width, height = whole.right - whole.left, whole.top - whole.bottom
    box = " ".join(map(coordinate, (whole.left, -whole.top, width, height)))
    size = f'width="{coordinate(_PIXELS * width)}" height="{coordinate(_PIXELS * height)}"'
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="symobs-picture" role="img" viewBox="{box}" {size} '
        f'font-family="{FONTS}" font-size="{FONT_SIZE:g}" fill="none" stroke-linejoin="round">'
    )
    named = [f"<title>{escape(title)}</title>"] if title else []
    return "\n".join([head, *named, f"<style>{style}</style>", *parts, "</svg>"])


def _drawn(scene: Scene, printer: TextPrinter) -> Iterator[str]:
    if scene.shades:
        areas = "".join(f"{_path(area)}Z" for area in scene.shades)
        yield f'<path class="full" fill="{_INK}" fill-opacity=".2" d="{areas}"/>'
    for stroke in scene.strokes:
        yield _stroke(stroke)
    for sign in scene.signs:
        yield _sign(sign)
    for text in scene.texts:
        x, y = text.place
        lowered = FONT_SIZE * (_BASELINES.get(text.anchor, 0.3) - 0.3)
        yield _written((x, y - lowered), _ANCHORS.get(text.anchor, "middle"), [_piece(text.content, printer)])


def _stroke(stroke: Stroke) -> str:
    style = STYLES[stroke.style]
    colour = _INK if style.colour == "ink" else "currentColor"
    attributes = [f'class="{_CLASSES[style.colour]}" stroke="{colour}" stroke-width="{style.width}"']
    attributes += [f'stroke-dasharray="{style.dashes[0]} {style.dashes[1]}"'] if style.dashes else []
    attributes += ['stroke-opacity=".35"'] if style.colour == "pale" else []
    line = f'<path {" ".join(attributes)} d="{_path(stroke.points)}"/>'
    return line + _arrow(stroke) if stroke.style == "axis" else line


def _arrow(stroke: Stroke) -> str:
    """Return the head of an axis."""
    (x0, y0), (x1, y1) = stroke.points[-2:]
    head = arrow_head(Sign("arrow", (x1, y1), (x1 - x0, y1 - y0)))
    return f'<path fill="currentColor" d="{_path(head)}Z"/>'


def _sign(sign: Sign) -> str:
    x, y = coordinate(sign.place[0]), coordinate(-sign.place[1])
    radius = RADIUS.get(sign.kind, 0.0)
    match sign.kind:
        case "dot":
            return f'<circle class="full" fill="{_INK}" cx="{x}" cy="{y}" r="{radius}"/>'
        case "ring":
            ink = f'stroke="{_INK}" stroke-width=".8"'
            return f'<circle class="ink open" fill="#fff" {ink} cx="{x}" cy="{y}" r="{radius}"/>'
        case "arrow":
            return f'<path class="full" fill="{_INK}" d="{_path(arrow_head(sign))}Z"/>'
        case _:
            strokes = (
                f"M{x} {y}m-{radius} -{radius}l{2 * radius} {2 * radius}m0 -{2 * radius}l-{2 * radius} {2 * radius}"
            )
            return f'<path class="ink" stroke="{_INK}" stroke-width=".8" d="{strokes}"/>'


def _path(points: Iterable[Point]) -> str:
    return "M" + "L".join(f"{coordinate(x)} {coordinate(-y)}" for x, y in points)


# -- text -------------------------------------------------------------------------------------------------------------


def _written(place: Point, anchor: str, pieces: Iterable[TextRun]) -> str:
    """Return a text at its baseline."""
    x, y = coordinate(place[0]), coordinate(0.3 * FONT_SIZE - place[1])
    return f'<text x="{x}" y="{y}" text-anchor="{anchor}" fill="currentColor">{spans(pieces, FONT_SIZE)}</text>'


def _width(pieces: Iterable[TextRun]) -> float:
    return width_of(pieces, FONT_SIZE)


def _caption_rows(words: Inlines, whole: Rectangle, printer: TextPrinter) -> list[list[TextRun]]:
    """Return the caption in rows of about the width of the plot."""
    room = max(whole.right - whole.left, NARROWEST)
    space = TextRun(" ", False)  # noqa: FBT003

    def mathematics(content: Formula | Relation) -> list[TextRun]:
        piece = _mathematics(content, printer)
        return [piece] if _width([piece]) <= room / 2 else [TextRun(part, True) for part in piece.text.split(" ")]  # noqa: FBT003

    pieces = words_of(words, lambda text: TextRun(text, False), mathematics)  # noqa: FBT003
    rows = rows_of(pieces, lambda piece: _width([piece]), _width([space]), room)
    return [spaced(row, space) for row in rows]
