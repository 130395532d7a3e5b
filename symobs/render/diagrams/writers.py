"""Writers of block diagrams in TikZ, in SVG and for terminals."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from symobs.render.page.blocks import Drawing
    from symobs.render.printers.latex_printer import LatexPrinter
    from symobs.render.printers.text_printer import TextPrinter


def tikz(drawing: Drawing, printer: LatexPrinter) -> str:
    """Return a diagram in TikZ, centred on the page."""
    from symobs.render.diagrams import tikz as diagrams_tikz  # noqa: PLC0415 - only pages with a diagram pay for it

    return diagrams_tikz.tikz(drawing, printer)


def svg(drawing: Drawing, printer: TextPrinter) -> str:
    """Return a diagram as an `svg` element of a page, in the colour of the surrounding text."""
    from symobs.render.diagrams import svg as diagrams_svg  # noqa: PLC0415

    return diagrams_svg.svg(drawing, printer)


def sketch(drawing: Drawing, printer: TextPrinter, width: int) -> str:
    """Return a diagram in characters of a terminal, if possible at most `width` columns wide."""
    from symobs.render.diagrams import text  # noqa: PLC0415

    return text.sketch(drawing, printer, width)
