"""HTML: the formats `html` (one self-contained page) and `html_fragment` (for insertion into another page).

Mathematics is MathML, pictures are SVG, and there is no script: the page forbids itself everything but its own style, and
where it offers buttons that copy LaTeX their one script, known by its hash.
"""

from __future__ import annotations

import base64
import hashlib
import re
from base64 import b64encode
from copy import copy
from dataclasses import replace
from html import escape
from itertools import count
from pathlib import Path
from string import Template
from typing import TYPE_CHECKING, ClassVar

from symobs.formula.phrases.languages import language_named
from symobs.formula.tree import Roots
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
from symobs.pages.page.detail_level import DETAILS
from symobs.pages.page.narrator import narrate, printer_for
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.latex_to_mathml import MINUS, PLUS, THIN
from symobs.pages.printers.mathml import MathmlPrinter
from symobs.pages.printers.root_lists import RootGlyphs, in_a_row
from symobs.pages.printers.text_printer import TextPrinter
from symobs.pages.tables import html_table
from symobs.tasks.result import output_format
from symobs.tasks.result.output_methods import PLAIN

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.pages.page.blocks import Block, Inline, Inlines
    from symobs.pages.page.sheet import Sheet
    from symobs.tasks.result import Document
    from symobs.tasks.result.output_methods import WebPage


# Interactive parts of an HTML page: levels of detail, buttons that copy LaTeX, a link to a live page.
#
# Levels are radio buttons and a rule of style. The buttons are made by the one script, which the policy of the page
# names by its hash: where scripts do not run, there is no button and nothing is missing.


_FOLDER = Path(__file__).parent


def style_of(web: WebPage) -> str:
    """Return the style sheet of the interactive parts."""
    return (_FOLDER / "html_web.css").read_text("utf-8") if web.details or web.copy or web.live else ""


def script_of(web: WebPage, language: str) -> tuple[str, str]:
    """Return the script with its words, as elements, and the policy that allows it and no other."""
    if not web.copy:
        return "", ""
    text = (_FOLDER / "html_copy.js").read_text("utf-8")
    mark = base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()
    phrases = language_named(language).phrases
    words = " ".join(f'data-{word}="{escape(phrases[f"web_{word}"])}"' for word in ("copy", "copied", "refused"))
    return f'<div hidden="" id="words" {words}></div>\n<script>{text}</script>\n', f"; script-src 'sha256-{mark}'"


def switch(web: WebPage, chosen: str, language: str) -> str:
    """Return the choice of the level of detail, if there is one."""
    if not web.details:
        return ""
    phrases, checked = language_named(language).phrases, ' checked="checked"'
    buttons = [
        f'<label><input type="radio" name="detail" value="{name}"{checked * (name == chosen)}/> '
        f"{phrases[f'web_{name}']}</label>"
        for name in DETAILS
    ]
    lines = ['<fieldset class="details">', f"<legend>{phrases['web_detail']}</legend>", *buttons, "</fieldset>"]
    return "\n".join(lines)


def levels(bodies: Mapping[str, str]) -> str:
    """Return the bodies of all levels, of which the choice shows one."""
    return "\n".join(f'<div data-detail="{name}">\n{body}\n</div>' for name, body in bodies.items())


def live_link(web: WebPage, language: str) -> str:
    """Return the link to the live page, if there is one."""
    if not web.live:
        return ""
    return f'<p class="live"><a href="{escape(web.live)}">{language_named(language).phrases["web_live"]}</a></p>'


def folded(solution: str, language: str) -> str:
    """Return a solution that is shown when it is opened."""
    word = language_named(language).phrases["web_solution"]
    return f'<details class="solution">\n<summary>{word}</summary>\n{solution}\n</details>'


#: Stands for the place of a part on a sheet until it is known; no text contains it.
_SOMEWHERE = "\0"
_PICTURES = {"png": "image/png", "jpg": "image/jpeg"}
_INSET = 2.0  # em, as in the style
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ufffe\uffff\ud800-\udfff\u202a-\u202e\u2066-\u2069]")
_OPENING_QUOTE = re.compile(r'(?:^|(?<=[\s(\[{]))"')
#: Mathematics with the signs that stand at it, between which browsers would break a line.
_WITH_SIGNS = re.compile(r"[(\[]*<math>(?:(?!</math>).)*</math>[)\],.;:]*")


def _whole(text: str) -> str:
    """Return mathematics and its signs on one line."""
    return text if text.startswith("<") and text.endswith(">") else f'<span class="whole">{text}</span>'


_ROOTS = RootGlyphs(
    square_root=lambda inside: f"<msqrt>{inside}</msqrt>",
    plus_minus="<mo>±</mo>",
    among=lambda s, equation: f"<mo>{{</mo>{s}<mo>:</mo>{equation}<mo>}}</mo>",
    number=lambda number: f"<mn>{number}</mn>",
    minus=f"<mo>{MINUS}</mo>",
    plus=f"<mo>{PLUS}</mo>",
    about="<mo>≈</mo>",
    imaginary="<mi>i</mi>",
    space=THIN,
    written=lambda printer, item: printer.running_box(item).source,
)


@output_format
class Html:
    """A self-contained HTML page."""

    name: ClassVar[str] = "html"
    suffix: ClassVar[str] = ".html"
    #: The kinds of picture that a browser shows.
    pictures: ClassVar[tuple[str, ...]] = tuple(_PICTURES)

    def render(self, document: Document) -> str:
        """Return the document as a page."""
        title, blocks = opened(narrate(document))
        offered = (live_link(document.web, document.language), switch(document.web, document.detail, document.language))
        pieces = (_writer(document).block(title), *offered, _body_of(document, blocks))
        return page(title.text, "\n".join(filter(None, pieces)), document.web, language=document.language)

    def part(self, document: Document) -> str:
        """Return a question or a solution below its title, independent of its place."""
        title, blocks = opened(narrate(document))
        head = _writer(document, level=3).block(replace(title, text=""))
        body = _body_of(document, blocks, prefix=_SOMEWHERE, level=3)
        return "\n".join(filter(None, (head, live_link(document.web, document.language), body)))

    def sheet(self, sheet: Sheet) -> str:
        """Return the sheet as one page, its contents linked to questions and solutions."""
        first, *further = ("\n".join(_pieces(part)) for part in sheet.apart)
        whole = "\n".join([first, *(f'<section class="apart">\n{each}\n</section>' for each in further)])
        return page(
            sheet.heading,
            whole,
            sheet.web,
            language=sheet.language,
            has_picture=sheet.header.logo is not None,
        )


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


def _pieces(sheet: Sheet) -> Iterator[str]:
    """Yield the pieces of a sheet: its head, its table of contents, and its chapters."""
    yield from _head(sheet)
    if sheet.web.details and sheet.has_solutions:
        yield switch(sheet.web, sheet.detail, sheet.language)
    if sheet.is_long:
        yield _contents(sheet)
    for chapter in sheet.chapters():
        if chapter.title:
            yield f'<h2 class="chapter" id="{chapter.name}">{chapter.title}</h2>'
        for item in chapter.items:
            points = f' <span class="points">{item.points}</span>' if item.points else ""
            kind = "problem apart" if sheet.header.is_exam and item.kind == "questions" else "problem"
            heading = f"{item.label} {plain(item.title)}{points}" if item.title else f"{item.label}{points}"
            yield f'<h3 class="{kind}" id="{item.place}">{heading}</h3>'
            body = item.part or f"<p>{plain(item.text)}</p>"
            placed = body.replace(_SOMEWHERE, f"{item.place}-")
            is_folded = item.part and sheet.web.details and item.kind == "solutions"
            yield folded(placed, sheet.language) if is_folded else placed


def _head(sheet: Sheet) -> Iterator[str]:
    """Yield the pieces of the head of a sheet, its picture as data."""
    if (logo := sheet.header.logo) is not None:
        data = b64encode(logo.content).decode("ascii")
        yield f'<img class="logo" alt="" src="data:{_PICTURES[logo.kind]};base64,{data}"/>'
    if sheet.course:
        yield f'<p class="course">{plain(sheet.course)}</p>'
    if sheet.heading:
        yield f"<h1>{plain(sheet.heading)}</h1>"
    if sheet.facts:
        spans = (f"<span>{word}: {plain(value)}</span>" for word, value in sheet.facts)
        yield f'<p class="facts">{" ".join(spans)}</p>'
    if sheet.fields:
        yield f'<p class="fields">{" ".join(f"<span>{word}</span>" for word in sheet.fields)}</p>'
    for rows in sheet.totals:
        cells = (f'<th scope="row">{row[0]}</th>{"".join(f"<td>{cell}</td>" for cell in row[1:])}' for row in rows)
        yield f'<div class="table"><table class="totals">{"".join(f"<tr>{row}</tr>" for row in cells)}</table></div>'
    yield from (f"<p>{plain(part)}</p>" for part in sheet.header.text.split("\n\n") if part.strip())


def _writer(document: Document, prefix: str = "", level: int = 1) -> HtmlWriter:
    """Return the writer of a document; for copy buttons with LaTeX, too."""
    writer = HtmlWriter(printer_for(document, MathmlPrinter), prefix=prefix, level=level)
    if document.web.copy:
        writer.latex = printer_for(document, LatexPrinter)
        writer.latex.paged = False
    return writer


def _body_of(document: Document, blocks: Sequence[Block], prefix: str = "", level: int = 1) -> str:
    """Return what stands below the title, at each level of detail where there is a choice; ids differ between levels."""
    if not document.web.details:
        return _writer(document, prefix, level).body(blocks)
    bodies = {}
    for detail in DETAILS:
        _, shown = opened(narrate(replace(document, detail=detail)))
        bodies[detail] = _writer(document, f"{prefix}{detail}-", level).body(shown)
    return levels(bodies)


def _contents(sheet: Sheet) -> str:
    """Return the table of contents: every problem once, with a link to each of its parts."""
    names = sheet.kinds
    rows = []
    for entry in sheet.entries:
        links = [f'<a href="#{name}-{entry.number}">{sheet.words["solution"]}</a>' for name in names[1:]]
        first = f'<a href="#{names[0]}-{entry.number}">{plain(entry.title)}</a>'
        rows.append(f"<li>{first}{''.join(f' ({link})' for link in links)}</li>")
    listed = "\n".join(rows)
    return f"<nav>\n<h2>{sheet.words['contents']}</h2>\n<ol>\n{listed}\n</ol>\n</nav>"


def page(title: str, body: str, web: WebPage = PLAIN, *, language: str = "en", has_picture: bool = False) -> str:
    """Return a complete page around an HTML body, in a language, with its interactive parts.

    Pictures are allowed as data alone, where there is one.
    """
    skeleton = Template((_FOLDER / "html_page.html").read_text("utf-8"))
    script, policy = script_of(web, language)
    policy += "; img-src data:" if has_picture else ""
    whole = {"style": style() + style_of(web), "body": body, "script": script, "policy": policy, "language": language}
    return skeleton.substitute(title=plain(title) or "symobs", **whole)


def style() -> str:
    """Return the style of the content of `class="symobs"`."""
    return (_FOLDER / "html_body.css").read_text("utf-8")


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
        self.latex: LatexPrinter | None = None

    def body(self, blocks: Sequence[Block]) -> str:
        """Return all blocks."""
        return "\n".join(filter(None, (self.block(block) for block in blocks)))

    def block(self, block: Block) -> str:
        """Return one block."""
        match block:
            case Title(text, source, conventions):
                return self._title(plain(text).strip(), f"{plain(source)} {self.sentence(conventions)}".strip())
            case Heading(number, inlines, time):
                self.printer.keep_time(time)
                if self.latex is not None:
                    self.latex.keep_time(time)
                return self._heading(number, "".join(map(self._inline, inlines)))
            case Paragraph(inlines):
                return f"<p>{self.sentence(inlines)}</p>"
            case Display(relations, boxed, closing, number):
                shown = self._display(self.printer.display(relations, boxed=boxed, end=closing), number)
                if self.latex is None:
                    return shown
                return f'<div data-latex="{escape(self.latex.display(relations, end=""))}">{shown}</div>'
            case Verified(inlines):
                return f'<p class="verified">{self.sentence(inlines)}</p>'
            case Caution(label, inlines):
                return f'<p class="caution"><strong>{plain(label)}</strong> {self.sentence(inlines)}</p>'
            case References(label, entries):
                listed = "\n".join(f"<li>{plain(entry)}</li>" for entry in entries)
                return f'<p class="references"><strong>{plain(label)}</strong></p>\n<ol class="references">\n{listed}\n</ol>'
            case TableBlock():
                table, legend = html_table(block, self.printer, self.sentence)
                below = f"\n<p>{self.sentence(block.where)}</p>\n{self._display(legend)}" if legend else ""
                return f'<div class="table">{table}</div>{below}'
            case Drawing() | PictureBlock():
                return self._picture(block)
            case CaseBlock(label, blocks):
                prefix = None if self.prefix is None else f"{self.prefix}case-"
                inside = HtmlWriter(self.printer, prefix=prefix, level=self.level + 1, inset=_INSET)
                inside.unnumbered, inside.latex = self.unnumbered, self.latex
                label_line = f"<p><strong>{self.sentence(label)}</strong></p>"
                return f'<div class="case">\n{label_line}\n{inside.body(blocks)}\n</div>'
            case Columns():
                return self._columns(block)
            case AnswerSpace(is_ruled=is_ruled, lines=lines):
                kind = "space ruled" if is_ruled else "space"
                return f'<div class="{kind}">{"<div></div>" * lines}</div>'

    def sentence(self, inlines: Inlines) -> str:
        """Return running text, words escaped and mathematics as MathML."""
        text = "".join(map(self._inline, inlines))
        return _WITH_SIGNS.sub(lambda found: _whole(found[0]), text)

    def _inline(self, part: Inline) -> str:
        if isinstance(part, str):
            return plain(part)
        if isinstance(part, Roots):
            return in_a_row(part, self.printer, _ROOTS, "<math>{}</math>".format)
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
        inside.latex = self.latex
        heads = "".join(f'<th scope="col">{self.sentence(head)}</th>' for head in block.heads)
        rows = ["".join(f"<td>{inside.body(cell)}</td>" for cell in row) for row in block.rows]
        body = "\n".join(f"<tr>{row}</tr>" for row in rows)
        return f'<div class="table">\n<table class="columns">\n<tr>{heads}</tr>\n{body}\n</table>\n</div>'

    def _display(self, mathematics: str, number: int = 0) -> str:
        label = f'<span class="number">({number})</span>' if number else ""
        return f'<div class="display">{mathematics}{label}</div>'

    def _picture(self, block: Drawing | PictureBlock) -> str:
        from symobs.pages.drawings.scene import below  # noqa: PLC0415 - only pages with pictures
        from symobs.pages.drawings.svg import svg, svg_scene  # noqa: PLC0415

        printer = TextPrinter.of(self.printer)
        if isinstance(block, Drawing):
            drawn = svg(svg_scene(block, printer), printer, printer.language.phrases["block_diagram"])
            below_it = f"<figcaption>{self.sentence(block.caption)}</figcaption>\n" if block.caption else ""
            return f"<figure>\n{drawn}\n{below_it}</figure>"
        scene = svg_scene(block.picture, printer)
        words = below(block.caption, scene, printer.language)
        spoken = "".join(
            part if isinstance(part, str) else printer.inline(part) for part in words if not isinstance(part, Roots)
        )
        return f"<figure>\n{svg(scene, printer, spoken)}\n<figcaption>{self.sentence(words)}</figcaption>\n</figure>"
