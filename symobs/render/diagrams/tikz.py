"""Block diagrams in TikZ, with positions in em, so that a diagram scales with the font."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula import Conjunction
from symobs.render.diagrams.diagram_layout import Arrangement, Metrics, arranged
from symobs.render.printers.latex_escape import centred

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.figures.block_diagram import Label
    from symobs.render.diagrams.diagram_layout import DiagramMark, Point, SignMark
    from symobs.render.page.blocks import Drawing
    from symobs.render.printers.latex_printer import LatexPrinter

#: In em: the height of a line, of a fraction, and of each row of a matrix.
_LINE, _FRACTION, _ROW = 1.1, 2.4, 1.3
#: What a junction's sign is away from the point of the arrow, along it and beside it.
_ALONG, _BESIDE = 0.5, 0.45


def tikz(drawing: Drawing, printer: LatexPrinter) -> str:
    """Return a diagram in TikZ, centred on the page; requires tikz and its library arrows.meta."""
    arrangement = arranged(drawing, metrics_for(printer), printer.width, discrete=printer.discrete)
    lines = "\n".join(_written(arrangement, printer))
    options = "x=1em,y=-1em,>=Stealth,every node/.style={inner sep=0pt}"
    return centred(f"\n\\begin{{tikzpicture}}[{options}]\n{lines}\n\\end{{tikzpicture}}\n")


def metrics_for(printer: LatexPrinter) -> Metrics:
    """Return the measures of a page."""

    def measure(label: Label) -> Point:
        rows = label.relations if isinstance(label, Conjunction) else (label,)
        boxes = [printer.relation(row) if isinstance(label, Conjunction) else printer.typeset(row) for row in rows]  # type: ignore[arg-type]
        heights = [_FRACTION if b.height == 1 else _ROW * b.height if b.height else _LINE for b in boxes]
        return max(box.width for box in boxes), sum(heights) + 0.4 * (len(rows) - 1)

    return Metrics(measure, inside=(0.55, 0.35), smallest=2.0, junction=0.9, gap=(1.7, 1.1), beside=0.3, sign=1.1)


def _written(arrangement: Arrangement, printer: LatexPrinter) -> Iterator[str]:
    for line in arrangement.lines:
        path = "--".join(_place(point) for point in line.points)
        yield rf"\draw{'[->]' if line.is_arrow else ''} {path};"
    for box in arrangement.boxes:
        (x, y), (width, height) = box.centre, box.size
        corners = _place((x - width / 2, y - height / 2)), _place((x + width / 2, y + height / 2))
        yield rf"\draw {corners[0]} rectangle {corners[1]};"
        yield rf"\node at {_place(box.centre)} {{{_mathematics(box.label, printer)}}};"
    for place in arrangement.junctions:
        yield rf"\draw {_place(place)} circle[radius=0.45];"
    for place in arrangement.branches:
        yield rf"\fill {_place(place)} circle[radius=0.15];"
    for mark in arrangement.marks:
        yield _mark(mark, printer)
    for sign in arrangement.signs:
        yield _sign(sign)


def _mathematics(label: Label, printer: LatexPrinter) -> str:
    if not isinstance(label, Conjunction):
        return rf"$\displaystyle {printer.unbroken(label)}$"
    rows = r"\\[2pt]".join(printer.unbroken(relation) for relation in label.relations)
    return rf"$\begin{{gathered}}{rows}\end{{gathered}}$"


def _mark(mark: DiagramMark, printer: LatexPrinter) -> str:
    side = {"above": "[above=0.25em]", "right": "[right=0.35em]"}.get(mark.side, "")
    return rf"\node{side} at {_place(mark.place)} {{${printer.unbroken(mark.label)}$}};"  # type: ignore[arg-type]


def _sign(sign: SignMark) -> str:
    (x, y), (across, down) = sign.place, sign.towards
    place = (x - _ALONG * across + _BESIDE * abs(down), y - _ALONG * down - _BESIDE * abs(across))
    return rf"\node at {_place(place)} {{\footnotesize${'-' if sign.is_negative else '+'}$}};"


def _place(point: Point) -> str:
    return "({})".format(",".join(f"{part:.2f}".rstrip("0").rstrip(".") for part in point))
