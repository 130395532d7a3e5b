"""The writer of TikZ.  A plot is in points; a diagram is in em, so that it scales with the font."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING

from symobs.formula.tree import Conjunction, Roots
from symobs.pages.drawings.diagram_layout import Metrics, diagram_scene
from symobs.pages.drawings.plot_layout import plot_scene
from symobs.pages.drawings.scene import ABOVE, FONT_SIZE, NARROWEST, RADIUS, STYLES, arrow_head, below, coordinate
from symobs.pages.page.blocks import Drawing
from symobs.pages.page.plot_captions import caption
from symobs.pages.printers.latex_printer import centred, escape

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.formula.figures import Drawn, Label
    from symobs.pages.drawings.scene import Box, Content, Measure, Point, Scene, Sign, Stroke, TextLabel
    from symobs.pages.page.blocks import Inline
    from symobs.pages.printers.latex_printer import LatexPrinter

#: A document may define the style `closer`, to draw its plots smaller.
_PLOT = r"x=1pt,y=1pt,>=stealth,line join=round,every node/.style={inner sep=0pt,font=\footnotesize},closer/.try"
_DIAGRAM = "x=1em,y=-1em,>=Stealth,every node/.style={inner sep=0pt}"
_COLOURS = {"ink": "ink", "text": "black", "pale": "black!25"}
_SHADE = "ink!12"
#: Lines of a diagram have the width of its document.
_WIRES = {"wire": "", "arrow": "[->]"}
_BESIDE_WIRES = {"center": "", "above": "[above=0.25em]", "right": "[right=0.35em]"}
#: Heights of what is written in a plot, in points: a line of letters, a fraction.
_LINE_HEIGHT, _FRACTION_HEIGHT = 9.0, 16.0
#: In a diagram, in em: the height of a line, of a fraction, and of each row of a matrix.
_LINE, _FRACTION, _ROW = 1.1, 2.4, 1.3
#: What a junction's sign is away from the point of the arrow, along it and beside it.
_ALONG, _BESIDE = 0.5, 0.45


def tikz_scene(item: Drawing | Drawn, printer: LatexPrinter) -> Scene:
    """Return the scene of a plot or a diagram in the measures of LaTeX."""
    if isinstance(item, Drawing):
        return diagram_scene(item, metrics_for(printer), printer.width, discrete=printer.discrete)
    return plot_scene(item, measure_for(printer), printer.language)


def tikz(scene: Scene, printer: LatexPrinter) -> str:
    """Return a scene as a `tikzpicture`; requires tikz, for diagrams with its library arrows.meta."""
    lines = [
        rf"\begin{{tikzpicture}}[{_DIAGRAM if scene.is_diagram else _PLOT}]",
        *([r"\providecolor{ink}{RGB}{30,60,110}"] if not scene.is_diagram else []),
        *_shades(scene.shades),
        *map(_stroke, scene.strokes),
        *(line for box in scene.boxes for line in _box(box, printer)),
        *(_sign(sign) for sign in scene.signs if sign.kind not in {"+", "-"}),
        *(_text(text, printer, is_plot=not scene.is_diagram) for text in scene.texts),
        *(_sign(sign) for sign in scene.signs if sign.kind in {"+", "-"}),
        r"\end{tikzpicture}",
    ]
    return "\n".join(lines)


#: A diagram higher than this (in em) is drawn smaller.
_TALL = 10.0


def figure(scene: Scene, printer: LatexPrinter, words: str = "") -> str:
    """Return a centred scene, with the text below it on one page."""
    size = "\\small\n" if scene.is_diagram and abs(scene.whole.top - scene.whole.bottom) > _TALL else ""
    if not words:
        return centred(f"\n{size}{tikz(scene, printer)}\n")
    below = f"\\par\\smallskip\\parbox{{.92\\linewidth}}{{\\centering\\small {words}}}"
    return centred(
        f"\\begin{{minipage}}{{\\linewidth}}\\centering\n{size}{tikz(scene, printer)}\n{below}\n\\end{{minipage}}"
    )


def tikz_file(picture: Drawn, printer: LatexPrinter) -> str:
    r"""Return a plot with its caption for `\input` or the class `standalone`."""
    scene = tikz_scene(picture, printer)
    place = _point((scene.whole.left, scene.whole.bottom - ABOVE))
    room = max(scene.whole.right - scene.whole.left, NARROWEST)
    options = f"anchor=north west,align=left,text width={coordinate(room)}pt"
    words = "".join(
        _inline(part, printer) for part in below(caption(picture, printer.language), scene, printer.language)
    )
    caption_node = rf"\node[{options}] at {place} {{{words}}};"
    body = tikz(scene, printer).replace("\\end{tikzpicture}", f"{caption_node}\n\\end{{tikzpicture}}")
    return f"% Needs tikz, amsmath and amssymb.\n{body}\n"


# -- measures ---------------------------------------------------------------------------------------------------------


def measure_for(printer: LatexPrinter) -> Measure:
    """Return the width and height of text in a plot."""

    def measure(content: Content) -> Point:
        if isinstance(content, str):
            return 0.5 * FONT_SIZE * len(content), _LINE_HEIGHT
        box = printer.running_box(content)  # type: ignore[arg-type]  # a plot has no systems of equations
        return box.width * FONT_SIZE, _FRACTION_HEIGHT if box.height else _LINE_HEIGHT

    return measure


def metrics_for(printer: LatexPrinter) -> Metrics:
    """Return the measures of a diagram."""

    def measure(label: Label) -> Point:
        rows = label.relations if isinstance(label, Conjunction) else (label,)
        boxes = [printer.relation(row) if isinstance(label, Conjunction) else printer.typeset(row) for row in rows]  # type: ignore[arg-type]
        heights = [_FRACTION if b.height == 1 else _ROW * b.height if b.height else _LINE for b in boxes]
        return max(box.width for box in boxes), sum(heights) + 0.4 * (len(rows) - 1)

    return Metrics(measure, inside=(0.55, 0.35), smallest=2.0, junction=0.9, gap=(1.7, 0.75), beside=0.3, sign=1.1)


# -- elements ---------------------------------------------------------------------------------------------------------


def _shades(areas: tuple[tuple[Point, ...], ...]) -> Iterator[str]:
    """Return one path for all areas, so that adjacent ones show no seam."""
    if areas:
        yield rf"\fill[{_SHADE}] {' '.join(f'{_path(area)}--cycle' for area in areas)};"


def _stroke(stroke: Stroke) -> str:
    if stroke.style in _WIRES:
        return rf"\draw{_WIRES[stroke.style]} {_path(stroke.points)};"
    style = STYLES[stroke.style]
    options = [_COLOURS[style.colour], f"line width={style.width}pt"]
    pattern = [f"{word} {length}pt" for word, length in zip(cycle(("on", "off")), style.dashes or (), strict=False)]
    options += [f"dash pattern={' '.join(pattern)}"] if pattern else []
    options += ["->"] if style.has_head else []
    return rf"\draw[{','.join(options)}] {_path(stroke.points)};"


def _box(box: Box, printer: LatexPrinter) -> Iterator[str]:
    (x, y), (width, height) = box.centre, box.size
    yield rf"\draw {_point((x - width / 2, y - height / 2))} rectangle {_point((x + width / 2, y + height / 2))};"
    if isinstance(box.content, Conjunction):
        rows = r"\\[2pt]".join(map(printer.unbroken, box.content.relations))
        written = rf"\begin{{gathered}}{rows}\end{{gathered}}"
    else:
        written = rf"\displaystyle {printer.unbroken(box.content)}"  # type: ignore[arg-type]
    yield rf"\node at {_point(box.centre)} {{${written}$}};"


def _sign(sign: Sign) -> str:
    place = _point(sign.place)
    match sign.kind:
        case "dot":
            return rf"\fill[ink] {place} circle[radius={RADIUS['dot']}];"
        case "ring":
            return rf"\filldraw[ink,fill=white,line width=0.8pt] {place} circle[radius={RADIUS['ring']}];"
        case "arrow":
            return rf"\fill[ink] {_path(arrow_head(sign.place, sign.direction))}--cycle;"
        case "junction":
            return rf"\draw {place} circle[radius=0.45];"
        case "branch":
            return rf"\fill {place} circle[radius=0.15];"
        case "+" | "-":
            (x, y), (across, down) = sign.place, sign.direction
            place = _point((x - _ALONG * across + _BESIDE * abs(down), y - _ALONG * down - _BESIDE * abs(across)))
            return rf"\node at {place} {{\scriptsize${sign.kind}$}};"
        case _:
            x, y, r = *sign.place, RADIUS["cross"]
            strokes = f"{_path(((x - r, y - r), (x + r, y + r)))} {_path(((x - r, y + r), (x + r, y - r)))}"
            return rf"\draw[ink,line width=0.8pt] {strokes};"


def _text(text: TextLabel, printer: LatexPrinter, *, is_plot: bool) -> str:
    content, place = text.content, _point(text.place)
    if not is_plot:
        return rf"\node{_BESIDE_WIRES[text.anchor]} at {place} {{${printer.unbroken(content)}$}};"  # type: ignore[arg-type]
    if isinstance(content, str):
        written = f"${content.replace(',', '{,}')}$" if _is_number(content) else escape(content)
    else:
        written = _inline(content, printer)  # type: ignore[arg-type]
    return rf"\node[anchor={text.anchor}] at {place} {{{written}}};"


def _inline(part: Inline, printer: LatexPrinter) -> str:
    if isinstance(part, Roots):
        raise TypeError(part)
    return escape(part) if isinstance(part, str) else f"${printer.inline(part)}$"


def _is_number(content: str) -> bool:
    return content.lstrip("-−").replace(",", ".").replace(".", "", 1).isdigit()


def _path(points: Iterable[Point]) -> str:
    return "--".join(map(_point, points))


def _point(point: Point) -> str:
    return f"({coordinate(point[0])},{coordinate(point[1])})"
