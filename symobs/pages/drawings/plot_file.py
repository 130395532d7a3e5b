"""Plot files of results: SVG and TikZ, and PNG and PDF by matplotlib."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from symobs.ground.errors import DerivationRejected, UsageError
from symobs.pages.drawings.matplotlib_writer import drawn_by_matplotlib, require_matplotlib
from symobs.pages.drawings.svg import svg_file
from symobs.pages.drawings.tikz import tikz_file
from symobs.pages.page.narrator import printer_for
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.text_printer import TextPrinter
from symobs.proof.derivation import Plot
from symobs.tasks.result import Document

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.figures.plot import Drawn, Picture, SweepCurves, SweepMap
    from symobs.proof.derivation import Step
    from symobs.tasks.result import Result

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
    result = next((result for result in results if result.picture is not None), None)
    if result is None or result.picture is None:
        message = f"there is no picture of {', '.join(result.task for result in results)}"
        raise UsageError(
            message, where="--plot", repair="leave --plot out, or ask for a task whose page shows a picture"
        )
    _require_checked(result.picture, result)
    document = Document("", "", (result,), language=language)
    return _written(result.picture, document, Path(path).suffix.lower())


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
            return drawn_by_matplotlib(picture, _BY_MATPLOTLIB[suffix], latex, text)


def _require_checked(picture: Picture, result: Result) -> None:
    """Raise `DerivationRejected` unless the plot is one of the result's checked page."""
    if not is_shown(picture, result):
        raise DerivationRejected("the page shows another picture", repair="please report this: it is a bug of symobs")


def is_shown(picture: Picture, result: Result) -> bool:
    """Return whether a plot is one of the result's page, which is checked."""
    result.derivation.check()
    return picture in set(_shown(result.derivation.steps))


def _shown(steps: Sequence[Step]) -> Iterator[Picture]:
    for step in steps:
        if isinstance(step, Plot):
            yield step.picture
        yield from _shown(getattr(step, "steps", ()))
