r"""Slides: the format `beamer`, one frame a section, broken by TeX."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.formula.phrases.languages import Language, language_named
from symobs.pages.formats.latex import END_OF_FIGURE, KEPT_END_OF_FIGURE, LatexWriter, has_drawings, head_of
from symobs.pages.formats.templates import fill
from symobs.pages.page.blocks import (
    AnswerSpace,
    Caution,
    Columns,
    Display,
    Drawing,
    Heading,
    Paragraph,
    PictureBlock,
    References,
    TableBlock,
    Verified,
    opened,
)
from symobs.pages.page.narrator import narrate, printer_for
from symobs.pages.printers.latex_printer import LatexPrinter, escape
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence
    from pathlib import Path

    from symobs.pages.page.blocks import Block
    from symobs.pages.page.sheet import Sheet
    from symobs.tasks.result import Document

#: em of 10 pt: 145 mm of a slide 160 mm wide, less than a sheet of paper has.
WIDTH = 39.5
#: A boxed answer or a matrix of more rows than this may be too high for a slide; other displays break between rows.
_TALL, _MATRIX = 6, re.compile(r"\\begin\{bmatrix\}(.*?)\\end\{bmatrix\}", re.DOTALL)
#: The end of a row, and the beginning of one that goes on with a sign: they stay on one slide of so many lines.
_ROW_END, _GOES_ON, _LINES = re.compile(r"\\\\(\[3pt\])?$"), re.compile(r"&(=|\\approx|\\quad)"), 10
#: What keeps two blocks together, a list before the second one, too.
_KEPT, _INSET, _UNPARTED = "\n\\par\\nopagebreak\n", r"\end{inset}", r"\csname @endparpenalty\endcsname=10000"
#: So many references fit below what is before them; what is not broken.
_FEW, _UNBROKEN = 12, (Columns, Drawing, PictureBlock, TableBlock)


@output_format
class Beamer:
    """Slides for LaTeX's class `beamer`; selected by name only, since its suffix is that of LaTeX."""

    name: ClassVar[str] = "beamer"
    suffix: ClassVar[str] = ".tex"
    template: ClassVar[str] = "beamer.tex"

    def render(self, document: Document) -> str:
        """Return the LaTeX of the slides."""
        return _slides([self.part(document)], language_named(document.language), document.templates)

    def part(self, document: Document) -> dict[str, Any]:
        """Return the template values of a document: its title and its frames."""
        title, blocks = opened(narrate(document))
        printer = printer_for(document, LatexPrinter)
        printer.width = WIDTH
        writer = _SlideWriter(printer)
        return {
            "title": escape(title.text).strip(),
            "source": escape(title.source).strip(),
            "conventions": writer.sentence(title.conventions),
            "head": None,
            "frames": [writer.frame(heading, body) for heading, body in _frames(blocks)],
            "drawings": has_drawings(blocks),
        }

    def sheet(self, sheet: Sheet) -> str:
        """Return the LaTeX of all problems' slides, those of each chapter after its title."""
        decks: list[dict[str, Any]] = []
        for part in sheet.apart:
            head = head_of(part)
            decks.append({**_title(part.heading), "head": head if any(head.values()) else None})
            for chapter in part.chapters():
                decks += [_title(chapter.title)] if chapter.title else []
                for item in chapter.items:
                    points = f" ({item.points.replace(' ', '~')})" if item.points else ""
                    slides = {**_title(""), "source": escape(item.text), **(item.part or {})}
                    slides["title"] = f"{item.label} {escape(item.title)}{points}".strip()
                    decks.append(_on_one_slide(slides) if item.part and item.kind == "questions" else slides)
        return _slides(decks, language_named(sheet.language), sheet.templates)


def _slides(decks: list[dict[str, Any]], language: Language, folder: Path | None) -> str:
    drawings = any(deck["drawings"] for deck in decks)
    values = {"decks": decks, "drawings": drawings, "babel": language.words["babel"]}
    return fill(Beamer.template, values, folder=folder)


def _on_one_slide(deck: dict[str, Any]) -> dict[str, Any]:
    """Return a question without a slide for its title, which is that of its only one."""
    below = f"\\framesubtitle{{{deck['source']}}}\n" if deck["source"] else ""
    body = "\n\n".join(f"\\textbf{{{frame['title']}.}} {frame['body']}" for frame in deck["frames"])
    return {**_title(""), "drawings": deck["drawings"], "frames": [{"title": deck["title"], "body": below + body}]}


def _title(text: str) -> dict[str, Any]:
    """Return slides with a title only."""
    slides = {"title": escape(text).strip(), "source": "", "conventions": "", "head": None}
    return {**slides, "frames": [], "drawings": False}


def _frames(blocks: Sequence[Block]) -> list[tuple[Heading, list[Block]]]:
    """Return the blocks of each heading of the first level; a section of one sentence has no frame of its own."""
    frames: list[tuple[Heading, list[Block]]] = []
    for heading, body in _sections(blocks):
        if frames and (_is_sentence(body) or _is_sentence(frames[-1][1])):
            frames[-1][1].extend((heading, *body))
        else:
            frames.append((heading, body))
    return frames


def _sections(blocks: Sequence[Block]) -> Iterator[tuple[Heading, list[Block]]]:
    """Yield each heading of the first level with the blocks after it; leading blocks belong to the first."""
    title = Heading("", ())
    body: list[Block] = []
    for block in blocks:
        if not isinstance(block, Heading) or block.number.count(".") > 1:
            body.append(block)
        elif not title.inlines or not body:
            title = block
        else:
            yield title, body
            title, body = block, []
    if body:
        yield title, body


def _is_sentence(body: Sequence[Block]) -> bool:
    return len(body) == 1 and isinstance(body[0], Paragraph | Verified)


def _is_no_slide(last: Block) -> bool:
    """Return whether the end of a frame stays with what is before it: a sentence, and a short list of references."""
    if isinstance(last, References):
        return len(last.entries) <= _FEW
    return isinstance(last, Paragraph | Verified | Caution)


class _SlideWriter(LatexWriter):
    """Writer of blocks for slides, which fits unbreakable ones."""

    def frame(self, heading: Heading, body: Sequence[Block]) -> dict[str, str]:
        """Return the template values of a frame."""
        self.printer.keep_time(heading.time)
        parts = [tuple(body)]
        while len(parts[0]) > 1 and _is_no_slide(parts[0][-1]):
            if len(parts) > 1 and isinstance(parts[0][-2], _UNBROKEN):
                break  # a figure leaves room for one of them
            parts[:1] = [parts[0][:-1], parts[0][-1:]]
        *front, last = map(self.body, parts)
        kept = [*map(_kept_with_next, front), last]
        written = _KEPT.join(kept).replace(_INSET + _KEPT, rf"{_UNPARTED} {_INSET}{_KEPT}")
        return {"title": self.sentence(heading.inlines).removesuffix("."), "body": written}

    def block(self, block: Block) -> str:
        """Return one block."""
        if isinstance(block, AnswerSpace):  # nobody writes on a slide
            return ""
        written, is_whole = super().block(block), True
        if isinstance(block, Display):
            unparted = [written.partition(r"\answer{")[2], *_MATRIX.findall(written)]
            written, is_whole = linked(written)
            is_whole = is_whole and all(part.count(r"\\") <= _TALL for part in unparted)
        if not is_whole or isinstance(block, (*_UNBROKEN, References)):
            led = "\\nopagebreak\n" if isinstance(block, Display) else ""  # what leads to a display stands on its slide
            return f"{led}\\begin{{fitted}}\n{written}\n\\end{{fitted}}"
        return written


def _kept_with_next(body: str) -> str:
    """Return blocks without a break after the display or the figure at their end."""
    front, figure, end = body.rpartition(END_OF_FIGURE)
    if figure and end == "\n\\end{fitted}":
        return f"{front}{KEPT_END_OF_FIGURE}{end}"
    if body.endswith(r"\]"):
        return body.removesuffix(r"\]") + r"\postdisplaypenalty=10000 \]"
    for name in ("align*", "gather*"):
        if body.endswith(rf"\end{{{name}}}"):
            front, _, display = body.rpartition(rf"\begin{{{name}}}")
            return rf"{front}{{\postdisplaypenalty=10000 \begin{{{name}}}{display}}}"
    return body


def linked(display: str) -> tuple[str, bool]:
    """Return a display without a slide that begins with a sign, and whether it is one that may be broken.

    The rows of a chain stay together while they fit on a slide; one of more begins again with its left side before a
    sign of equality, and where there is none the display is to be made smaller.
    """
    rows, left, height, is_whole = display.split("\n"), "", 0, True
    for place, row in enumerate(rows):
        here = max([2 * ("frac" in row), *(part.count(r"\\") for part in _MATRIX.findall(row))]) + 1
        if not _GOES_ON.match(row):
            left, height = row.partition("&")[0], here
        elif height + here <= _LINES:
            rows[place - 1] = _ROW_END.sub(r"\\\\*\1", rows[place - 1])
            height += here
        elif left and not row.startswith(r"&\quad"):
            rows[place], height = f"{left}{row}", here
        else:
            is_whole = False
    return "\n".join(rows), is_whole
