"""LaTeX: the formats `latex` (a complete document) and `fragment` (for insertion into another document)."""

from __future__ import annotations

import re
from copy import copy
from itertools import pairwise, zip_longest
from typing import TYPE_CHECKING, Any, ClassVar

from symobs.formula.phrases.languages import language_named
from symobs.formula.tree import Roots
from symobs.pages.formats.templates import fill
from symobs.pages.page.blocks import (
    AnswerSpace,
    CaseBlock,
    Caution,
    Columns,
    Display,
    Drawing,
    Heading,
    Paragraph,
    PictureBlock,
    References,
    TableBlock,
    Title,
    Verified,
    every,
    opened,
)
from symobs.pages.page.narrator import narrate, printer_for
from symobs.pages.printers.latex_printer import LatexPrinter, escape
from symobs.pages.printers.root_lists import LATEX, in_a_row
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from symobs.pages.page.blocks import Block, Inline, Inlines
    from symobs.pages.page.sheet import Sheet
    from symobs.tasks.result import Document

_INSET = 1.5  # em, as in the templates
_LETTER = 0.5  # em, a letter of running text and a little more
_SPACE = 2.0  # em, a `\qquad`
#: Words of no more letters stand on the line of the display that they introduce.
_FEW_LETTERS = 30
_OPENING = r"\[ "
_GUTTER = 0.06  # between columns, of the line


@output_format
class LatexArticle:
    """A whole LaTeX document, one page or more of A4."""

    name: ClassVar[str] = "latex"
    suffix: ClassVar[str] = ".tex"
    template: ClassVar[str] = "article.tex"

    def render(self, document: Document) -> str:
        """Return the document's LaTeX."""
        return typeset(document, self.template, folder=document.templates)

    def part(self, document: Document) -> dict[str, object]:
        """Return the template values of a question or a solution."""
        return values_of(document)

    def sheet(self, sheet: Sheet) -> str:
        """Return the sheet's LaTeX."""
        return typeset_sheet(sheet, "sheet.tex")


@output_format
class LatexFragment:
    """The body alone, with the definitions of its commands."""

    name: ClassVar[str] = "fragment"
    suffix: ClassVar[str] = ".tex"
    template: ClassVar[str] = "fragment.tex"

    def render(self, document: Document) -> str:
        """Return the LaTeX of the body."""
        return typeset(document, self.template, folder=document.templates)


def typeset(document: Document, template: str, *, folder: Path | None = None) -> str:
    """Return a document in a template; `folder` has the user's templates."""
    return fill(template, values_of(document), folder=folder)


def values_of(document: Document) -> dict[str, object]:
    """Return the template values of a document."""
    title, blocks = opened(narrate(document))
    writer = LatexWriter(printer_for(document, LatexPrinter))
    return {
        "title": escape(title.text).strip(),
        "source": escape(title.source).strip(),
        "conventions": writer.sentence(title.conventions),
        "body": writer.body(blocks),
        "drawings": has_drawings(blocks),
        "babel": writer.printer.language.words["babel"],
    }


def has_drawings(blocks: Sequence[Block]) -> bool:
    """Return whether a page needs TikZ."""
    return any(isinstance(block, Drawing | PictureBlock) for block in every(blocks))


def typeset_sheet(sheet: Sheet, template: str) -> str:
    """Return a sheet in a template; the values of a problem are those of its part, its number, and its failure."""
    language, parts = language_named(sheet.language), [_values_of_sheet(each) for each in sheet.apart]
    chapters = [chapter for part in parts for chapter in part["chapters"]]
    values = {
        **parts[0],
        "parts": parts,
        "is_exam": sheet.header.is_exam,
        "kinds": sheet.kinds,
        "contents": sheet.words["contents"] if sheet.is_long else "",
        "words": sheet.words,
        "drawings": any(problem.get("drawings") for chapter in chapters for problem in chapter["problems"]),
        "babel": language.words["babel"],
    }
    return fill(template, values, folder=sheet.templates)


def _values_of_sheet(sheet: Sheet) -> dict[str, Any]:
    """Return the title of a sheet, its head, its table of points and its chapters for a template."""
    chapters: list[dict[str, Any]] = []
    for chapter in sheet.chapters():
        problems: list[dict[str, Any]] = []
        for item in chapter.items:
            slots = {"label": item.label, "title": escape(item.title).strip(), "points": item.points}
            slots |= {"failure": escape(item.text)}
            place = {"number": item.entry.number, "kind": item.kind, "place": item.place}
            problems.append({"source": "", "conventions": "", "body": "", **(item.part or {}), **slots, **place})
        chapters.append({"name": chapter.name, "title": chapter.title, "problems": problems})
    title = escape(sheet.heading).strip()
    return {"title": title, "head": head_of(sheet), "totals": sheet.totals, "chapters": chapters}


def head_of(sheet: Sheet) -> dict[str, Any]:
    """Return the template values of the head of a sheet."""
    return {
        "course": escape(sheet.course).strip(),
        "facts": [(word, escape(value).strip()) for word, value in sheet.facts],
        "fields": sheet.fields,
        "text": [escape(part).strip() for part in sheet.header.text.split("\n\n") if part.strip()],
        "logo": sheet.header.logo.path if sheet.header.logo else "",
    }


class LatexWriter:
    """Writer of blocks as LaTeX; mathematics is written by its printer."""

    def __init__(self, printer: LatexPrinter, *, inset: float = 0.0) -> None:
        """Write mathematics with `printer`, on lines shorter by `inset` em."""
        self.printer = copy(printer)
        self.printer.width = printer.width - inset

    def body(self, blocks: Sequence[Block]) -> str:
        """Return all blocks, each continuing its paragraph or beginning a new one."""
        pieces = [self.block(block) for block in blocks]
        gaps = [_gap(before, after) for before, after in pairwise(blocks)]
        for place in range(1, len(blocks)):
            if isinstance(blocks[place], References):  # no page begins with them: they stay with a figure, too
                pieces[place - 1] = pieces[place - 1].replace(END_OF_FIGURE, KEPT_END_OF_FIGURE)
        for place in range(1, len(blocks) - 1):
            if led := self._led_in(*blocks[place - 1 : place + 2]):
                pieces[place : place + 2], gaps[place] = ("", led), ""
        return "".join(text for pair in zip_longest(pieces, gaps, fillvalue="") for text in pair)

    def _led_in(self, before: Block, words: Block, display: Block) -> str:
        """Return a display with the few words between it and the one before it on its line, if there is room for them."""
        match before, words, display:
            case Display(), Paragraph((str(text),), continues), Display():
                if len(text) > _FEW_LETTERS or not (continues or text.endswith(",")):
                    return ""
                trial = LatexWriter(self.printer, inset=_LETTER * len(text) + _SPACE)
                trial.printer.stars = dict(self.printer.stars)
                written = trial.block(display)
                if written.startswith(_OPENING) and not display.number:
                    return rf"{_OPENING}\text{{{escape(text)}}}\qquad {written.removeprefix(_OPENING)}"
        return ""

    def block(self, block: Block) -> str:
        """Return one block."""
        match block:
            case Heading(number, inlines, time):
                self.printer.keep_time(time)
                return rf"\textbf{{{f'{number} ' * bool(number)}{self.sentence(inlines)}}}"
            case Paragraph(inlines):
                return self.sentence(inlines)
            case Display(relations, boxed, closing, number):
                written = self.printer.display(relations, boxed=boxed, end=closing)
                if number:
                    written = re.sub(r"(?= \\\]$|\n\\end\{(?:align|gather)\*\}$)", rf"\\tag{{{number}}}", written)
                return _kept_with_next(written) if closing == "," else written
            case Verified(inlines):
                return rf"\verified{{{self.sentence(inlines)}}}"
            case Caution(label, inlines):
                return rf"\caution{{{escape(label)}}}{{{self.sentence(inlines)}}}"
            case References(label, entries):
                listed = "\n".join(rf"\item {escape(entry)}" for entry in entries)
                return f"\\begin{{references}}{{{escape(label)}}}\n{listed}\n\\end{{references}}"
            case TableBlock():
                from symobs.pages.tables import latex_table  # noqa: PLC0415 - only pages with tables

                return latex_table(block, self.printer, self.sentence)
            case Drawing() | PictureBlock():
                return self._picture(block)
            case CaseBlock(label, blocks):
                first = _gap(Heading("", label), blocks[0]) if blocks else ""
                body = type(self)(self.printer, inset=_INSET).body(blocks)
                return f"\\begin{{inset}}\n\\textbf{{{self.sentence(label)}}}{first}{body}\n\\end{{inset}}"
            case Columns():
                return self._columns(block)
            case AnswerSpace(is_ruled=is_ruled, lines=lines):
                return rf"\answer{'lines' if is_ruled else 'space'}{{{lines}}}"
            case Title(text):
                return escape(text)

    def _picture(self, block: Drawing | PictureBlock) -> str:
        from symobs.pages.drawings.scene import below  # noqa: PLC0415 - only pages with pictures
        from symobs.pages.drawings.tikz import figure, tikz_scene  # noqa: PLC0415

        if isinstance(block, Drawing):
            return figure(tikz_scene(block, self.printer), self.printer, self.sentence(block.caption))
        scene = tikz_scene(block.picture, self.printer)
        return figure(scene, self.printer, self.sentence(below(block.caption, scene, self.printer.language)))

    def _columns(self, block: Columns) -> str:
        """Return rows of boxes with a continuous rule between the columns; a page may break between rows."""
        count = len(block.heads)
        part = round((1 - _GUTTER * (count - 1)) / count, 4)
        writer = LatexWriter(self.printer, inset=(1 - part) * self.printer.width)
        heads: list[tuple[str, tuple[Block, ...]]] = [
            (rf"\textbf{{{self.sentence(head)}}}", ()) for head in block.heads
        ]
        cells = [heads, *([(writer.body(cell), cell) for cell in row] for row in block.rows)]
        boxes = [[_in_column(text, inside, part) for text, inside in row] for row in cells]
        between = "\\hfill\\vrule\\hfill\n"
        head, *rows = [rf"\noindent{between.join(row)}\par\nointerlineskip" for row in boxes]
        body = "\n".join([head, r"\nobreak\hrule\nobreak\vskip0pt", *rows])
        return f"\\par\\medskip{{\\parskip=0pt\n{body}\n}}\\medskip"

    def sentence(self, inlines: Inlines) -> str:
        """Return running text, words escaped and mathematics between dollars."""
        return "".join(self._inline(part) for part in inlines)

    def _inline(self, part: Inline) -> str:
        if isinstance(part, str):
            return escape(part)
        if isinstance(part, Roots):
            return in_a_row(part, self.printer, LATEX, "${}$".format)
        return f"${self.printer.inline(part)}$"


def _in_column(text: str, blocks: Sequence[Block], part: float) -> str:
    """Return a cell as a box; a check in it breaks before a sign of equality, and a display at its end has its own space."""
    before, after = r"\rule{0pt}{2.6ex}", "5pt"
    if blocks and isinstance(blocks[0], Verified):
        before, text = r"\relpenalty=10000 ", text.replace("=", r"\allowbreak=")
    if blocks and isinstance(blocks[-1], Display):
        after = "1pt"
    return rf"\begin{{minipage}}[t]{{{part}\linewidth}}\raggedright{before}{text}\par\kern{after}\end{{minipage}}"


END_OF_FIGURE = r"\end{center}}"
KEPT_END_OF_FIGURE = r"\csname @endparpenalty\endcsname=10000 \end{center}}"


def _kept_with_next(display: str) -> str:
    """Return a display on one line that no page break separates from what follows it."""
    return display.removesuffix(r"\]") + r"\postdisplaypenalty=5000 \]" if display.endswith(r"\]") else display


def _gap(before: Block, after: Block) -> str:
    """Return the separator of two blocks; an empty line begins a new paragraph."""
    if isinstance(before, Heading) and isinstance(after, Paragraph):
        return " "
    if isinstance(after, Heading):
        return "\n\n\\addvspace{4pt plus 1pt}\n"
    begins = isinstance(after, CaseBlock) or (isinstance(before, Paragraph) and isinstance(after, Paragraph))
    return "\n\n" if begins else "\n"
