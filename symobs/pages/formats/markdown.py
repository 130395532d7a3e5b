r"""Markdown: the format `markdown`, for notebooks and for forges such as GitHub and GitLab.

Programs that read Markdown take backslashes before punctuation away, even inside mathematics, and read `<` as the
beginning of HTML.  So mathematics is written with named commands only, all of them known to KaTeX and MathJax: `\cr`
ends a row, `\lbrace` is a brace.  Pictures and block diagrams are fenced text: forges remove embedded SVG and data URIs,
and a file beside the page gets lost; characters survive everywhere.
"""

from __future__ import annotations

import re
from copy import copy
from dataclasses import replace
from typing import TYPE_CHECKING, ClassVar

from symobs.formula.tree import Roots
from symobs.pages.formats.text import printable
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
    opened,
)
from symobs.pages.page.narrator import narrate, printer_for
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.line_breaking import Layout
from symobs.pages.printers.root_lists import LATEX, in_a_row
from symobs.pages.printers.text_printer import TextPrinter
from symobs.pages.tables import markdown_table
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.figures import Picture
    from symobs.formula.tree import Relation
    from symobs.pages.page.blocks import Block, Inline, Inlines
    from symobs.pages.page.sheet import Sheet
    from symobs.tasks.result import Document

_SKETCH = 78  # columns
_SOURCE = re.compile(r"\\begin\{array\}\{[c|l]+\}|\\(?:\\(?:\[\d+pt\])?|[A-Za-z]+ ?|.)|[<>|]", re.DOTALL)
#: What a command of the LaTeX pages is here; all others are known everywhere and stay.
_NAMED = {
    r"\,": r"\thinspace ",
    r"\;": r"\thickspace ",
    r"\ ": r"\space ",
    r"\{": r"\lbrace ",
    r"\}": r"\rbrace ",
    r"\answer": r"\boxed",
    r"\allowbreak": "",
    "<": r"\lt ",
    ">": r"\gt ",
    "|": r"\vert ",
}
_SPECIAL = re.compile(r"[\\`*_\[\]<>|~$&#]")
_AT_START = re.compile(r"^(\s*\d*)(?=[-+=:.)])")


@output_format
class Markdown:
    """Markdown for notebooks and forges."""

    name: ClassVar[str] = "markdown"
    suffix: ClassVar[str] = ".md"

    def render(self, document: Document) -> str:
        """Return the document as Markdown."""
        return MarkdownWriter(printer_for(document, LatexPrinter)).body(narrate(document)) + "\n"

    def part(self, document: Document) -> str:
        """Return a question or a solution below its title."""
        title, blocks = opened(narrate(document))
        return MarkdownWriter(printer_for(document, LatexPrinter), level=3).body((replace(title, text=""), *blocks))

    def sheet(self, sheet: Sheet) -> str:
        """Return the sheet as Markdown; forges make a table of contents of its headings by themselves."""
        pieces: list[str] = []
        for part in sheet.apart:
            pieces += _head(part)
            for chapter in part.chapters():
                pieces += [f"## {chapter.title}"] if chapter.title else []
                for item in chapter.items:
                    points = f" ({item.points})" if item.points else ""
                    pieces.append(f"### {item.label} {plain(item.title)}".strip() + points)
                    pieces.append(item.part or paragraph(plain(item.text)))
        return "\n\n".join(pieces) + "\n"


def _head(sheet: Sheet) -> Iterator[str]:
    """Yield the paragraphs of the head of a sheet; a picture would be another file, and nobody fills in Markdown."""
    if sheet.heading.strip():
        yield f"# {plain(sheet.heading).strip()}"
    if sheet.course:
        yield paragraph(plain(sheet.course))
    if sheet.facts:
        yield "  \n".join(f"**{word}:** {plain(value)}" for word, value in sheet.facts)
    for rows in sheet.totals:
        lines = [f"| {' | '.join(row)} |" for row in rows[:2]]
        yield "\n".join([lines[0], f"|{' --- |' * len(rows[0])}", lines[1]])
    yield from (paragraph(plain(part)) for part in sheet.header.text.split("\n\n") if part.strip())


def portable(latex: str) -> str:
    """Return mathematics without a backslash before punctuation, `<`, `>` or `|`."""
    return _SOURCE.sub(_renamed, latex)


def _renamed(match: re.Match[str]) -> str:
    found = match[0]
    if found.startswith(r"\begin{array}"):  # its bars are the lines between blocks
        return found
    if found.startswith("\\\\"):
        return r"\cr "
    name = found.rstrip() if found[-1:] == " " and len(found) > 2 else found
    return _NAMED.get(name, found)


def plain(text: str) -> str:
    """Return external text as escaped Markdown on one line."""
    return _SPECIAL.sub(_harmless, printable(text))


def code(text: str) -> str:
    """Return external text as code on one line, which a cell of a table may hold: nothing in it is read as Markdown."""
    line = " ".join(printable(text).split())
    fence = "`" * (max(map(len, re.findall("`+", line)), default=0) + 1)
    edge = " " if line[:1] == "`" or line[-1:] == "`" else ""
    return f"{fence}{edge}{line}{edge}{fence}".replace("|", "\\|") if line else ""


def paragraph(line: str) -> str:
    """Return a line, a leading mark of a list or heading escaped."""
    return _AT_START.sub(r"\1\\", line)


def _harmless(match: re.Match[str]) -> str:
    return {"<": "&lt;", ">": "&gt;", "&": "&amp;"}.get(match[0], f"\\{match[0]}")


class MarkdownWriter:
    """Writer of blocks as Markdown; mathematics is written by the printer of LaTeX."""

    def __init__(self, printer: LatexPrinter, *, level: int = 1) -> None:
        """Write mathematics with `printer`; a title is a heading of `level`."""
        self.printer = copy(printer)
        self.printer.paged = False
        self.level = level

    def body(self, blocks: Sequence[Block]) -> str:
        """Return all blocks, an empty line between two."""
        return "\n\n".join(filter(None, (self.block(block) for block in blocks)))

    def block(self, block: Block) -> str:
        """Return one block."""
        match block:
            case Title(text, source, conventions):
                heading = f"{'#' * self.level} {plain(text).strip()}" if text.strip() else ""
                below = paragraph(f"{plain(source)} {self.sentence(conventions)}".strip())
                return "\n\n".join(filter(None, (heading, below)))
            case Heading(number, inlines, time):
                self.printer.keep_time(time)
                depth = min(6, self.level + max(1, number.count(".")))
                return f"{'#' * depth} {f'{number} {self.sentence(inlines)}'.strip().removesuffix('.')}"
            case Paragraph(inlines):
                return paragraph(self.sentence(inlines))
            case Display(relations, boxed, closing, number):
                shown = self.display(relations, boxed=boxed, end=closing)
                return rf"{shown.removesuffix(' $$')} \tag{{{number}}} $$" if number else shown
            case Verified(inlines):
                return f"✓ {self.sentence(inlines)}"
            case Caution(label, inlines):
                return quoted(f"**{plain(label)}** {self.sentence(inlines)}")
            case References(label, entries):
                listed = (f"- \\[{number}\\] {plain(entry)}" for number, entry in enumerate(entries, 1))
                return "\n".join([f"**{plain(label)}**", "", *listed])
            case Drawing(caption=words):
                return f"{self._sketch(block)}\n\n{self.sentence(words)}" if words else self._sketch(block)
            case TableBlock():
                table, legend = markdown_table(block, self.printer, self.sentence, self.mathematics)
                return "\n\n".join([table, self.sentence(block.where), self.display(legend)]) if legend else table
            case PictureBlock(picture, sketched=sketched):
                return f"{self._sketch(picture)}\n\n{self.sentence(sketched)}"
            case AnswerSpace():  # nobody writes on it by hand
                return ""
            case CaseBlock(label, blocks):
                inside = MarkdownWriter(self.printer, level=self.level + 1).body(blocks)
                return quoted(f"**{self.sentence(label)}**\n\n{inside}")
            case Columns(heads, rows):
                writer = MarkdownWriter(self.printer, level=self.level + 1)
                writer.printer.width = self.printer.width / len(heads)
                lines = [[self.sentence(head) for head in heads], [":---"] * len(heads)]
                lines += [["<br>".join(map(writer.in_a_cell, cell)) for cell in row] for row in rows]
                return "\n".join(f"| {' | '.join(line)} |" for line in lines)

    def in_a_cell(self, block: Block) -> str:
        """Return a block on one line, its mathematics as in running text."""
        return re.sub(r"\$\$ (.*?) \$\$", r"$\\displaystyle \1$", self.block(block)).replace("\n", "<br>")

    def display(self, relations: Sequence[Relation], *, boxed: int = 0, end: str = ".") -> str:
        """Return a display on one line, since further lines would need the marks of the surrounding blocks."""
        rows, are_aligned = Layout(self.printer, self.printer.width, boxed=boxed, end=end).rows(relations)
        if len(rows) == 1 and not are_aligned:
            return f"$$ {portable(rows[0].right.source)} $$"
        lines = [f"{row.left.source if row.left else ''}&{row.right.source}" for row in rows]
        if not are_aligned:
            lines = [row.right.source for row in rows]
        kind = "aligned" if are_aligned else "gathered"
        body = r"\cr ".join(map(portable, lines))
        return rf"$$ \begin{{{kind}}}{body}\end{{{kind}}} $$"

    def sentence(self, inlines: Inlines) -> str:
        """Return running text, words escaped and mathematics between dollars."""
        return "".join(self._inline(part) for part in inlines)

    def _inline(self, part: Inline) -> str:
        if isinstance(part, str):
            return plain(part)
        if isinstance(part, Roots):
            return in_a_row(part, self.printer, LATEX, self.mathematics)
        return self.mathematics(self.printer.inline(part))

    def mathematics(self, latex: str) -> str:
        """Return mathematics for a line of text."""
        return f"${portable(latex).strip()}$"

    def _sketch(self, item: Drawing | Picture) -> str:
        from symobs.pages.drawings.text import sketch  # noqa: PLC0415 - only pages with pictures

        return fenced(sketch(item, TextPrinter.of(self.printer, width=_SKETCH), _SKETCH))


def fenced(text: str) -> str:
    """Return a fenced block of characters."""
    return f"```text\n{text}\n```"


def quoted(text: str) -> str:
    """Return blocks in a quotation."""
    return "\n".join(f"> {line}".rstrip() for line in text.splitlines())
