"""Plot files of results: SVG and TikZ, and PNG and PDF by matplotlib."""

from __future__ import annotations

from functools import lru_cache
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.ground.errors import DerivationRejected, UsageError
from symobs.pages.drawings.plot_layout import plot_scene
from symobs.pages.drawings.scene import FONT_SIZE, NARROWEST, RADIUS, STYLES, arrow_head, caption_below, head_of
from symobs.pages.drawings.svg import svg_file
from symobs.pages.drawings.tikz import tikz_file
from symobs.pages.page.narrator import printer_for
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from symobs.proof.derivation import Plot
from symobs.tasks.result import Document

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from matplotlib.figure import Figure

    from symobs.formula.figures import Drawn, Picture, SweepCurves, SweepMap
    from symobs.formula.phrases.languages import Language
    from symobs.formula.tree import Formula, Relation
    from symobs.pages.drawings.scene import Content, Point, Rectangle, Scene, Sign, Stroke
    from symobs.proof.derivation import Step
    from symobs.tasks.result import Result


# Plots by matplotlib, for PNG and PDF, with mathematics by matplotlib's own TeX.


_COLOURS = {"ink": "#1e3c6e", "text": "black", "pale": "0.78"}
_SHADE = "#e4e7ed"
_FONT: dict[str, Any] = {"family": ["STIXGeneral", "DejaVu Sans"], "math_fontfamily": "stix"}
_SPACE = 0.28 * FONT_SIZE
_RESOLUTION = 220
_HORIZONTAL, _VERTICAL = {"west": "left", "east": "right"}, {"north": "top", "south": "bottom"}


#: Nothing that changes from run to run.
_METADATA: dict[str, dict[str, Any]] = {
    "png": {"Software": None},
    "pdf": {"CreationDate": None, "Producer": None},
}


def require_matplotlib() -> None:
    """Raise `UsageError` if matplotlib is missing."""
    try:
        import matplotlib.figure  # noqa: F401
    except ImportError:
        message = "pictures in PNG and PDF need matplotlib"
        raise UsageError(message, repair="pip install matplotlib, or name a file that ends in .svg or .tex") from None


def drawn_by_matplotlib(pictures: Sequence[Drawn], latex: LatexPrinter, text: TextPrinter) -> Figure:
    """Return plots with their captions below each other in one figure of matplotlib."""
    require_matplotlib()
    from matplotlib.figure import Figure

    write = _writer(latex, text)
    laid_out = [_laid_out(picture, write, latex.language) for picture in pictures]
    sizes = [(whole.right - whole.left, whole.top - whole.bottom) for _, whole, _ in laid_out]
    width, height = max(size[0] for size in sizes), sum(size[1] for size in sizes)
    figure, above = Figure(figsize=(width / 72, height / 72), facecolor="white"), height
    for (scene, whole, rows), (own_width, own_height) in zip(laid_out, sizes, strict=True):
        above -= own_height
        axes = figure.add_axes((0, above / height, own_width / width, own_height / height))
        axes.set(xlim=(whole.left, whole.right), ylim=(whole.bottom, whole.top))
        axes.axis("off")
        _draw(scene, axes, write)
        for place, row in rows:
            axes.text(*place, _joined(row), fontsize=FONT_SIZE, va="center", **_FONT)
    return figure


def _laid_out(
    picture: Drawn, write: Callable[[Content], str], language: Language
) -> tuple[Scene, Rectangle, Sequence[tuple[Point, list[list[str]]]]]:
    """Return the scene of a plot, its size with the caption, and the rows of the caption."""
    scene = plot_scene(picture, lambda content: _size(write(content)), language)
    widest = max(scene.whole.right - scene.whole.left, NARROWEST) / 2

    def mathematics(content: Formula | Relation) -> list[str]:
        """Return mathematics whole, or broken after its signs if it is long."""
        piece = write(content)
        return [piece] if _size(piece)[0] <= widest else _broken(piece)

    whole, rows = caption_below(picture, scene, language, _escaped, mathematics, lambda piece: _size(piece)[0], _SPACE)
    return scene, whole, rows


def _escaped(text: str) -> str:
    return text.replace("$", r"\$")


def _writer(latex: LatexPrinter, text: TextPrinter) -> Callable[[Content], str]:
    """Return the writer of mathematics for matplotlib: LaTeX if its TeX supports it, else plain text."""
    from matplotlib.mathtext import MathTextParser

    parser: Any = MathTextParser("path")

    def write(content: Content) -> str:
        if isinstance(content, str):
            return _escaped(content.replace("-", "−"))
        written = f"${latex.inline(content)}$"  # type: ignore[arg-type]
        try:
            parser.parse(written)
        except ValueError:
            return _escaped(text.inline(content))  # type: ignore[arg-type]
        return written

    return write


@lru_cache(maxsize=1024)
def _size(written: str) -> tuple[float, float]:
    """Return the width and height of a text in matplotlib."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextPath

    font = FontProperties(**_FONT, size=FONT_SIZE)
    extents = TextPath((0, 0), written, prop=font).get_extents()
    return float(extents.x1), max(float(extents.height) + 1.5, 0.9 * FONT_SIZE)


def _broken(written: str) -> list[str]:
    """Return mathematics in parts ending with a sign outside parentheses and braces."""
    parts, depth = [""], 0
    for place, character in enumerate(written[1:-1]):
        depth += (character in "({") - (character in ")}")
        parts[-1] += character
        if character in "+-=" and depth == 0 and place:
            parts.append("")
    return [f"${part}$" for part in parts if part] if written.startswith("$") else written.split(" ")


def _joined(row: list[list[str]]) -> str:
    """Return a row as one text, consecutive parts of a formula joined."""
    return " ".join("".join(word) for word in row).replace("$ $", "")


# -- drawing ----------------------------------------------------------------------------------------------------------


def _draw(scene: Scene, axes: Any, write: Callable[[Content], str]) -> None:
    if scene.shades:
        _fill(axes, scene.shades, _SHADE)
    for stroke in scene.strokes:
        _stroke(axes, stroke)
    for sign in scene.signs:
        _sign(axes, sign)
    for text in scene.texts:
        anchors = {
            "ha": _HORIZONTAL.get(text.anchor, "center"),
            "va": _VERTICAL.get(text.anchor, "center_baseline" if text.anchor == "east" else "center"),
        }
        axes.text(*text.place, write(text.content), fontsize=FONT_SIZE, **anchors, **_FONT)


def _fill(axes: Any, areas: Sequence[Sequence[Point]], colour: str) -> None:
    """Fill areas as one path: two that touch show no seam."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path

    paths = [Path([*area, area[0]], closed=True) for area in areas]
    axes.add_patch(PathPatch(Path.make_compound_path(*paths), facecolor=colour, edgecolor="none", zorder=0))


def _stroke(axes: Any, stroke: Stroke) -> None:
    style = STYLES[stroke.style]
    dashes: dict[str, Any] = {"linestyle": (0, tuple(d / style.width for d in style.dashes))} if style.dashes else {}
    colour = _COLOURS[style.colour]
    axes.plot(
        *zip(*stroke.points, strict=True), color=colour, lw=style.width, solid_capstyle="butt", zorder=1, **dashes
    )
    if style.has_head:
        _fill(axes, [head_of(stroke)], colour)


def _sign(axes: Any, sign: Sign) -> None:
    from matplotlib.patches import Circle

    ink, radius = _COLOURS["ink"], RADIUS.get(sign.kind, 0.0)
    x, y = sign.place
    match sign.kind:
        case "dot":
            axes.add_patch(Circle(sign.place, radius, facecolor=ink, edgecolor="none", zorder=2))
        case "ring":
            axes.add_patch(Circle(sign.place, radius, facecolor="white", edgecolor=ink, linewidth=0.8, zorder=2))
        case "arrow":
            _fill(axes, [arrow_head(sign.place, sign.direction)], ink)
        case _:
            for turn in (1, -1):
                ends = (x - radius, x + radius), (y - turn * radius, y + turn * radius)
                axes.plot(*ends, color=ink, linewidth=0.8, zorder=2)


SUFFIXES = (".svg", ".png", ".pdf", ".tex")
_BY_MATPLOTLIB = {".png": "png", ".pdf": "pdf"}


def check_target(path: str) -> None:
    """Raise `UsageError`, before any computation, for a file to which no plot can be written."""
    suffix = Path(path).suffix.lower()
    if suffix not in SUFFIXES:
        message = f"the suffix {suffix[:20]!r} names no format of pictures" if suffix else "a picture needs a suffix"
        raise UsageError(message, where="--plot", repair=f"name a file that ends in {', '.join(SUFFIXES)}")
    if suffix in _BY_MATPLOTLIB:
        require_matplotlib()


def picture_file(results: Sequence[Result], path: str, language: str = "en") -> bytes:
    """Return the plot of the first result with one, in the format of the suffix of `path`, its caption in a language."""
    check_target(path)
    shown = ((result, picture) for result in results for picture in pictures_of(result))
    if any(result.picture is not None and not is_shown(result.picture, result) for result in results):
        raise DerivationRejected("the page shows another picture")
    result, picture = next(shown, (None, None))
    if result is None or picture is None:
        message = f"there is no picture of {', '.join(result.task for result in results)}"
        raise UsageError(
            message, where="--plot", repair="leave --plot out, or ask for a task whose page shows a picture"
        )
    document = Document("", "", (result,), language=language)
    return _written(picture, document, Path(path).suffix.lower())


def figure(result: Result) -> Figure:
    """Return the pictures of a result's page as a figure of matplotlib; raises `UsageError` where it has none."""
    pictures = pictures_of(result)
    if not pictures:
        repair = "ask for a task whose page shows a picture, such as response, stability_region or margins"
        raise UsageError(f"there is no picture of {result.task}", where="plot", repair=repair)
    document = Document("", "", (result,))
    return drawn_by_matplotlib(pictures, printer_for(document, LatexPrinter), printer_for(document, TextPrinter))


def sweep_file(picture: SweepCurves | SweepMap, path: str) -> bytes:
    """Return the plot of a sweep in the format of the suffix of `path`."""
    return _written(picture, Document("", "", ()), Path(path).suffix.lower())


def _written(picture: Drawn, document: Document, suffix: str) -> bytes:
    latex, text = printer_for(document, LatexPrinter), printer_for(document, TextPrinter)
    match suffix:
        case ".svg":
            return svg_file(picture, text).encode()
        case ".tex":
            return tikz_file(picture, latex).encode()
        case _:
            return saved(drawn_by_matplotlib([picture], latex, text), _BY_MATPLOTLIB[suffix])


def saved(drawn: Figure, kind: str) -> bytes:
    """Return a figure as `png` or `pdf`, the same bytes every time."""
    buffer = BytesIO()
    drawn.savefig(buffer, format=kind, dpi=_RESOLUTION, metadata=_METADATA[kind])
    return buffer.getvalue()


def is_shown(picture: Picture, result: Result) -> bool:
    """Return whether a plot is one of the result's page."""
    return picture in pictures_of(result)


def pictures_of(result: Result) -> list[Picture]:
    """Return the plots of a result's page, which is checked; raises `DerivationRejected`."""
    result.derivation.check()
    return list(dict.fromkeys(_shown(result.derivation.steps)))


def _shown(steps: Sequence[Step]) -> Iterator[Picture]:
    for step in steps:
        if isinstance(step, Plot):
            yield step.picture
        yield from _shown(getattr(step, "steps", ()))
