"""HTML: the formats `html` (one self-contained page) and `html_fragment` (for insertion into another page).

Mathematics is MathML, pictures are SVG, and there is no script: the page forbids itself everything but its own style.
"""

from __future__ import annotations

import re
from copy import copy
from dataclasses import replace
from html import escape
from itertools import count
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, ClassVar

from symobs.formula import Roots
from symobs.phrases.languages import language_named
from symobs.render.page.blocks import (
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
from symobs.render.page.narrator import narrate, printer_for
from symobs.render.printers.mathml.mathml_elements import MINUS, PLUS
from symobs.render.printers.mathml.mathml_printer import MathmlPrinter
from symobs.render.printers.root_lists import RootGlyphs, listed
from symobs.render.printers.text_printer import TextPrinter
from symobs.render.tables.html_and_markdown import html_table
from symobs.result import output_format

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.render.page.blocks import Block, Inline, Inlines
    from symobs.render.page.sheet import Sheet
    from symobs.result import Document

#: Stands for the place of a part on a sheet until it is known; no text contains it.
_SOMEWHERE = "\0"
_FOLDER = Path(__file__).parent
_INSET = 2.0  # em, as in the style
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ufffe\uffff\ud800-\udfff\u202a-\u202e\u2066-\u2069]")
_OPENING_QUOTE = re.compile(r'(?:^|(?<=[\s(\[{]))"')
_ROOTS = RootGlyphs(
    square_root=lambda inside: f"<msqrt>{inside}</msqrt>",
    plus_minus="<mo>±</mo>",
    among=lambda s, equation: f"<mo>{{</mo>{s}<mo>:</mo>{equation}<mo>}}</mo>",
    number=lambda number: f"<mn>{number}</mn>",
    minus=f"<mo>{MINUS}</mo>",
    plus=f"<mo>{PLUS}</mo>",
    imaginary="<mi>i</mi>",
    written=lambda printer, item: printer.running_box(item).source,
)


@output_format
class Html:
    """A self-contained HTML page."""

    name: ClassVar[str] = "html"
    suffix: ClassVar[str] = ".html"

    def render(self, document: Document) -> str:
        """Return the document as a page."""
        title, _ = opened(blocks := narrate(document))
        return page(title.text, HtmlWriter(printer_for(document, MathmlPrinter)).body(blocks), document.language)

    def part(self, document: Document) -> str:
        """Return a question or a solution below its title, independent of its place."""
        title, blocks = opened(narrate(document))
        writer = HtmlWriter(printer_for(document, MathmlPrinter), prefix=_SOMEWHERE, level=3)
        return writer.body((replace(title, text=""), *blocks))

    def sheet(self, sheet: Sheet) -> str:
        """Return the sheet as one page, its contents linked to questions and solutions."""
        pieces = [f"<h1>{plain(sheet.title)}</h1>"] if sheet.title else []
        pieces += [_contents(sheet)] if sheet.is_long else []
        phrases = language_named(sheet.language).phrases
        for name, parts in sheet.chapters():
            pieces.append(f'<h2 class="chapter" id="{name}">{phrases[f"sheet_{name}"]}</h2>')
            for entry, part in parts:
                place = f"{name}-{entry.number}"
                pieces.append(f'<h3 class="problem" id="{place}">{entry.number}. {plain(entry.title)}</h3>')
                pieces.append(part.replace(_SOMEWHERE, f"{place}-") if part else f"<p>{plain(entry.failure)}</p>")
        return page(sheet.title, "\n".join(pieces), sheet.language)


@output_format
class HtmlFragment:
    """The body alone, with a style that affects nothing outside."""

    name: ClassVar[str] = "html_fragment"
    suffix: ClassVar[str] = ".html"

    def render(self, document: Document) -> str:
        """Return the body."""
        writer = HtmlWriter(printer_for(document, MathmlPrinter), prefix=None, level=2)
        body = writer.body(narrate(document))
        return f'<div class="symobs">\n<style>\n{style()}</style>\n{body}\n</div>\n'


def _contents(sheet: Sheet) -> str:
    """Return the table of contents: every problem once, with a link to each of its parts."""
    names = [name for name, _ in sheet.chapters()]
    phrases = language_named(sheet.language).phrases
    rows = []
    for entry in sheet.entries:
        links = [f'<a href="#{name}-{entry.number}">{phrases["sheet_solution"]}</a>' for name in names[1:]]
        first = f'<a href="#{names[0]}-{entry.number}">{plain(entry.title)}</a>'
        rows.append(f"<li>{first}{''.join(f' ({link})' for link in links)}</li>")
    listed = "\n".join(rows)
    return f"<nav>\n<h2>{phrases['sheet_contents']}</h2>\n<ol>\n{listed}\n</ol>\n</nav>"


def page(title: str, body: str, language: str = "en") -> str:
    """Return a whole page around a body, which is HTML already, in a language."""
    skeleton = Template((_FOLDER / "html_page.html").read_text(encoding="utf-8"))
    return skeleton.substitute(title=plain(title) or "symobs", style=style(), body=body, language=language)


def style() -> str:
    """Return the style of the content of `class="symobs"`."""
    return (_FOLDER / "html_body.css").read_text(encoding="utf-8")


def plain(text: str) -> str:
    """Return external text as escaped HTML, with quotation marks as in LaTeX.

    Characters that would steer the reader's screen, and those that no page may contain, are left out.
    """
    line = _CONTROL.sub("", re.sub(r"\s+", " ", text))
    curled = _OPENING_QUOTE.sub("“", line).replace('"', "”").replace("'", "\N{RIGHT SINGLE QUOTATION MARK}")
    return escape(curled)


class HtmlWriter:
    """Writer of blocks as HTML; mathematics is written by its printer."""

    def __init__(self, printer: MathmlPrinter, *, prefix: str | None = "", level: int = 1, inset: float = 0.0) -> None:
        """Write mathematics with `printer`, on lines shorter by `inset` em.

        A title is a heading of `level`, and `prefix` begins every id: parts of one page are told apart by it.  Without a
        prefix there are no ids, since nobody knows the page around.
        """
        self.printer = copy(printer)
        self.printer.width = printer.width - inset
        self.prefix = prefix
        self.level = level
        self.unnumbered = count(1)

    def body(self, blocks: Sequence[Block]) -> str:
        """Return all blocks."""
        return "\n".join(filter(None, (self.block(block) for block in blocks)))

    def block(self, block: Block) -> str:
        """Return one block."""
        match block:
            case Title(text, source, conventions):
                return self._title(plain(text).strip(), f"{plain(source)} {self.sentence(conventions)}".strip())
            case Heading(number, inlines):
                return self._heading(number, self.sentence(inlines))
            case Paragraph(inlines):
                return f"<p>{self.sentence(inlines)}</p>"
            case Display(relations, boxed, closing):
                return self._display(self.printer.display(relations, boxed=boxed, end=closing))
            case Verified(inlines):
                return f'<p class="verified">{self.sentence(inlines)}</p>'
            case Caution(label, inlines):
                return f'<p class="caution"><strong>{plain(label)}</strong> {self.sentence(inlines)}</p>'
            case References(label, entries):
                listed = "\n".join(f"<li>{plain(entry)}</li>" for entry in entries)
                return f'<p class="references"><strong>{plain(label)}</strong></p>\n<ol class="references">\n{listed}\n</ol>'
            case TableBlock():
                table, told = html_table(block, self.printer, self.sentence)
                below = f"\n<p>{self.sentence(block.where)}</p>\n{self._display(told)}" if told else ""
                return f'<div class="table">{table}</div>{below}'
            case Drawing() | PictureBlock():
                return self._picture(block)
            case CaseBlock(label, blocks):
                prefix = None if self.prefix is None else f"{self.prefix}case-"
                inside = HtmlWriter(self.printer, prefix=prefix, level=self.level + 1, inset=_INSET)
                inside.unnumbered = self.unnumbered
                label_line = f"<p><strong>{self.sentence(label)}</strong></p>"
                return f'<div class="case">\n{label_line}\n{inside.body(blocks)}\n</div>'
            case Columns():
                return self._columns(block)

    def sentence(self, inlines: Inlines) -> str:
        """Return running text, words escaped and mathematics as MathML."""
        return "".join(self._inline(part) for part in inlines)

    def _inline(self, part: Inline) -> str:
        if isinstance(part, str):
            return plain(part)
        if isinstance(part, Roots):
            return ", ".join(f"<math>{root}</math>" for root in listed(part, self.printer, _ROOTS))
        return self.printer.inline(part)

    def _title(self, text: str, below: str) -> str:
        heading = f"<h{self.level}>{text}</h{self.level}>" if text else ""
        return "\n".join(filter(None, (heading, f'<p class="source">{below}</p>' if below else "")))

    def _heading(self, number: str, words: str) -> str:
        """Return a heading without a full stop, one level deeper for each part of its number."""
        depth = min(6, self.level + max(1, number.count(".")))
        words = f"{number} {words}".strip().removesuffix(".")
        if self.prefix is None:
            return f"<h{depth}>{words}</h{depth}>"
        place = number.rstrip(".").replace(".", "-") or f"part-{next(self.unnumbered)}"
        return f'<h{depth} id="{self.prefix}s-{place}">{words}</h{depth}>'

    def _columns(self, block: Columns) -> str:
        """Return a table with a column of blocks for each head."""
        inset = self.printer.width - (self.printer.width - _INSET) / len(block.heads)
        inside = HtmlWriter(self.printer, prefix=None, level=self.level + 1, inset=inset)
        heads = "".join(f'<th scope="col">{self.sentence(head)}</th>' for head in block.heads)
        rows = ["".join(f"<td>{inside.body(cell)}</td>" for cell in row) for row in block.rows]
        body = "\n".join(f"<tr>{row}</tr>" for row in rows)
        return f'<div class="table">\n<table class="columns">\n<tr>{heads}</tr>\n{body}\n</table>\n</div>'

    def _display(self, mathematics: str) -> str:
        return f'<div class="display">{mathematics}</div>'

    def _picture(self, block: Drawing | PictureBlock) -> str:
        from symobs.render.drawings.captions import below  # noqa: PLC0415 - only pages with pictures
        from symobs.render.drawings.svg import svg, svg_scene  # noqa: PLC0415

        printer = TextPrinter.of(self.printer)
        if isinstance(block, Drawing):
            return f"<figure>\n{svg(svg_scene(block, printer), printer, printer.language.phrases['block_diagram'])}\n</figure>"
        scene = svg_scene(block.picture, printer)
        words = below(block.caption, scene, printer.language)
        spoken = "".join(
            part if isinstance(part, str) else printer.inline(part) for part in words if not isinstance(part, Roots)
        )
        return f"<figure>\n{svg(scene, printer, spoken)}\n<figcaption>{self.sentence(words)}</figcaption>\n</figure>"
