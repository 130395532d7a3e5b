"""Block diagrams: each known by name, drawn once in TikZ and once for terminals.

`loop`: the plant above, the compensator in the return path, negative feedback.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula import Letter

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.formula import Formula
    from symobs.render.blocks import Drawing
    from symobs.render.latex_printer import LatexPrinter
    from symobs.render.text_printer import TextPrinter

    Labels = Mapping[str, Formula]

#: What stands in a box whose formula would not fit the page; the page defines both letters.
_LETTERS: Labels = {"plant": Letter("P"), "compensator": Letter("F")}


def tikz(drawing: Drawing, printer: LatexPrinter) -> str:
    """Return a drawing in TikZ."""
    return {"loop": _tikz_loop}[drawing.name](dict(drawing.labels), printer)


def sketch(drawing: Drawing, printer: TextPrinter, width: int) -> str:
    """Return a drawing in the characters of a terminal, at most `width` columns wide where that can be."""
    return {"loop": _sketch_loop}[drawing.name](dict(drawing.labels), printer, width)


def _shorter_and_shorter(labels: Labels) -> Iterator[Labels]:
    """Yield the labels, then with a letter for the compensator, then for both."""
    yield labels
    yield {**labels, "compensator": _LETTERS["compensator"]}
    yield _LETTERS


def _fitting(labels: Labels, fits: Callable[[Labels], bool]) -> Labels:
    return next((shorter for shorter in _shorter_and_shorter(labels) if fits(shorter)), _LETTERS)


# -- TikZ -------------------------------------------------------------------------------------------------------------

_TIKZ_LOOP = r"""\begin{center}
\begin{tikzpicture}[>=Stealth,node distance=11mm,
  box/.style={draw,minimum height=8mm,inner xsep=6pt},sum/.style={draw,circle,inner sep=1.6pt}]
\node (r) {$r=0$};
\node[sum,right=of r] (s) {};
\node[box,right=@before@mm of s] (P) {$\displaystyle @plant@$};
\coordinate[right=@after@mm of P] (o);
\node[right=8mm of o] (y) {$@y@$};
\node[box,below=9mm of P] (F) {$\displaystyle @compensator@$};
\draw[->] (r)--(s) node[pos=.8,above]{\small$+$};
\draw[->] (s)--node[above]{$@u@$}(P);
\draw (P)--(o);
\draw[->] (o)--(y);
\draw[->] (o)|-(F);
\draw[->] (F)-|(s) node[pos=.93,left]{\small$-$};
\end{tikzpicture}
\end{center}"""
_EM = 3.85  # mm, at 11 pt
_BEFORE, _AFTER, _MARGINS = 11.0, 14.0, 46.0  # mm beside the plant; _MARGINS for r, y, the sum and the arrows there
_OVERLAP = 7.0  # mm by which a wide compensator may reach beyond the plant on either side
_PAGE = 150.0  # mm


def _tikz_loop(labels: Labels, printer: LatexPrinter) -> str:
    """Draw the loop; a compensator wider than the plant pushes the plant's neighbours away."""

    def overhang(labels: Labels) -> float:
        plant, compensator = (printer.typeset(labels[place]).width for place in ("plant", "compensator"))
        return max(0.0, (compensator - plant) / 2 * _EM - _OVERLAP)

    def fits(labels: Labels) -> bool:
        plant = printer.typeset(labels["plant"]).width * _EM
        return _MARGINS + _BEFORE + plant + _AFTER + 2 * overhang(labels) <= _PAGE

    labels = _fitting(labels, fits)
    beyond = overhang(labels)
    marks = {"before": f"{_BEFORE + beyond:.3g}", "after": f"{_AFTER + beyond:.3g}"}
    formulas = {**labels, "u": Letter("u"), "y": Letter("y")}
    marks |= {place: printer.unbroken(formula) for place, formula in formulas.items()}
    picture = _TIKZ_LOOP
    for place, mark in marks.items():
        picture = picture.replace(f"@{place}@", mark)
    return picture


# -- terminals --------------------------------------------------------------------------------------------------------

_SKETCH_MARGINS = 32  # columns beside the boxes


def _sketch_loop(labels: Labels, printer: TextPrinter, width: int) -> str:
    """Draw both boxes equally wide, the return path below."""

    def box_width(labels: Labels) -> int:
        return 2 + max(len(printer.inline(labels[place])) for place in ("plant", "compensator"))

    labels = _fitting(labels, lambda labels: box_width(labels) + _SKETCH_MARGINS <= width)
    inside = box_width(labels)
    edge = "─" * inside
    plant, compensator = (f"{printer.inline(labels[place]):^{inside}}" for place in ("plant", "compensator"))
    u, y = printer.inline(Letter("u")), printer.inline(Letter("y"))
    return "\n".join(
        (
            f"         +   {u}    ┌{edge}┐",
            f"r = 0 ───▶○──────▶│{plant}├───┬───▶ {y}",
            f"          ▲ −     └{edge}┘   │",
            f"          │       ┌{edge}┐   │",
            f"          └───────┤{compensator}│◀──┘",
            f"                  └{edge}┘",
        )
    )
