"""Plots in TikZ, with all positions from the scene."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula import Roots
from symobs.render.page.plot_captions import caption
from symobs.render.plots.caption_rows import ABOVE, NARROWEST
from symobs.render.plots.numbered_caption import below
from symobs.render.plots.plot_layout import scene_of
from symobs.render.plots.scene import FONT_SIZE, RADIUS, STYLES, arrow_head, coordinate
from symobs.render.printers.latex_escape import centred, escape

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.figures.plot import Picture
    from symobs.render.page.blocks import Inline
    from symobs.render.plots.scene import Content, Measure, Point, Scene, Sign, Stroke, TextLabel
    from symobs.render.printers.latex_printer import LatexPrinter

_COLOURS = {"ink": "ink", "text": "black", "pale": "black!25"}
_SHADE = "ink!12"
#: Heights of what is written, in points: a line of letters, a fraction.
_LINE_HEIGHT, _FRACTION_HEIGHT = 9.0, 16.0


def tikz(scene: Scene, printer: LatexPrinter) -> str:
    """Return a scene as a `tikzpicture`; requires tikz only."""
    lines = [
        r"\begin{tikzpicture}[x=1pt,y=1pt,>=stealth,line join=round,every node/.style={inner sep=0pt,font=\footnotesize}]",
        r"\providecolor{ink}{RGB}{30,60,110}",
        *_shades(scene.shades),
        *(_stroke(stroke) for stroke in scene.strokes),
        *(_sign(sign) for sign in scene.signs),
        *(_text(text, printer) for text in scene.texts),
        r"\end{tikzpicture}",
    ]
    return "\n".join(lines)


def figure(scene: Scene, words: str, printer: LatexPrinter) -> str:
    """Return a centred scene with the text below it, on one page."""
    told = f"{tikz(scene, printer)}\n\\par\\smallskip{{\\small {words}\\par}}\n"
    return centred(f"\\begin{{minipage}}{{.92\\linewidth}}\\centering\n{told}\\end{{minipage}}")


def tikz_file(picture: Picture, printer: LatexPrinter) -> str:
    r"""Return a plot with its caption for `\input` or the class `standalone`."""
    scene = latex_scene(picture, printer)
    place = f"({coordinate(scene.whole.left)},{coordinate(scene.whole.bottom - ABOVE)})"
    room = max(scene.whole.right - scene.whole.left, NARROWEST)
    options = f"anchor=north west,align=left,text width={coordinate(room)}pt"
    words = "".join(_inline(part, printer) for part in below(caption(picture), scene))
    caption_node = rf"\node[{options}] at {place} {{{words}}};"
    body = tikz(scene, printer).replace("\\end{tikzpicture}", f"{caption_node}\n\\end{{tikzpicture}}")
    return f"% Needs tikz, amsmath and amssymb.\n{body}\n"


def latex_scene(picture: Picture, printer: LatexPrinter) -> Scene:
    """Return the scene of a plot in the measures of LaTeX."""
    return scene_of(picture, measure_for(printer))


def measure_for(printer: LatexPrinter) -> Measure:
    """Return the width and height of text in a plot in LaTeX."""

    def measure(content: Content) -> tuple[float, float]:
        if isinstance(content, str):
            return 0.5 * FONT_SIZE * len(content), _LINE_HEIGHT
        box = printer.running_box(content)
        return box.width * FONT_SIZE, _FRACTION_HEIGHT if box.height else _LINE_HEIGHT

    return measure


def _shades(areas: tuple[tuple[Point, ...], ...]) -> Iterator[str]:
    """Return one path for all areas, so that adjacent ones show no seam."""
    if areas:
        yield rf"\fill[{_SHADE}] {' '.join(f'{_path(area)}--cycle' for area in areas)};"


def _stroke(stroke: Stroke) -> str:
    style = STYLES[stroke.style]
    options = [_COLOURS[style.colour], f"line width={style.width}pt"]
    if style.dashes is not None:
        on, off = style.dashes
        options.append(f"dash pattern=on {on}pt off {off}pt")
    if stroke.style == "axis":
        options.append("->")
    return rf"\draw[{','.join(options)}] {_path(stroke.points)};"


def _sign(sign: Sign) -> str:
    place = _point(sign.place)
    match sign.kind:
        case "dot":
            return rf"\fill[ink] {place} circle[radius={RADIUS['dot']}];"
        case "ring":
            return rf"\filldraw[ink,fill=white,line width=0.8pt] {place} circle[radius={RADIUS['ring']}];"
        case "arrow":
            return rf"\fill[ink] {_path(arrow_head(sign))}--cycle;"
        case _:
            x, y, r = *sign.place, RADIUS["cross"]
            strokes = f"{_path(((x - r, y - r), (x + r, y + r)))} {_path(((x - r, y + r), (x + r, y - r)))}"
            return rf"\draw[ink,line width=0.8pt] {strokes};"


def _text(text: TextLabel, printer: LatexPrinter) -> str:
    content = text.content
    written = (
        escape(content) if isinstance(content, str) and not _is_number(content) else _mathematics(content, printer)
    )
    return rf"\node[anchor={text.anchor}] at {_point(text.place)} {{{written}}};"


def _inline(part: Inline, printer: LatexPrinter) -> str:
    if isinstance(part, Roots):
        raise TypeError(part)
    return escape(part) if isinstance(part, str) else f"${printer.inline(part)}$"


def _mathematics(content: Content, printer: LatexPrinter) -> str:
    return f"${content if isinstance(content, str) else printer.inline(content)}$"


def _is_number(content: str) -> bool:
    return content.lstrip("-−").replace(".", "", 1).isdigit()


def _path(points: Iterable[Point]) -> str:
    return "--".join(_point(point) for point in points)


def _point(point: Point) -> str:
    return f"({coordinate(point[0])},{coordinate(point[1])})"
