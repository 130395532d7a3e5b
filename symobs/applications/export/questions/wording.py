r"""What a question says: its page as HTML with LaTeX, as Markdown or with MathML, and a sentence at every input.

The page is that of `symobs sheet --questions`, its title left to the platform.  Text of a problem file is text there: what a
platform would take for a command (`{@`, `[[`, `$`, `\(`, a tag) is kept from it.
"""

from __future__ import annotations

import re
from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING
from xml.etree.ElementTree import fromstring

from symobs.formula.phrases import PHRASES
from symobs.formula.tree import Roots
from symobs.pages.formats.html import HtmlWriter
from symobs.pages.formats.markdown import Markdown, portable
from symobs.pages.page.blocks import Display, Heading, Paragraph, Title
from symobs.pages.page.narrator import narrate, printer_for
from symobs.pages.printers.display_layout import Layout
from symobs.pages.printers.latex_printer import LatexPrinter
from symobs.pages.printers.mathml.mathml_printer import MathmlPrinter
from symobs.pages.printers.root_lists import LATEX, listed
from symobs.problem.question import question_of

if TYPE_CHECKING:
    from symobs.applications.export.questions.exercise import Exercise
    from symobs.applications.export.questions.parts import ExportedPart
    from symobs.pages.page.blocks import Block, Inlines
    from symobs.problem.question import Question

_LETTER = re.compile(r"([A-Za-z])(?:_([A-Za-z0-9]+))?")
#: Characters at which some platform begins a formula, a command or a gap.
_SPECIAL = re.compile(r"[\\${}\[\]#~]")
_NOT_TEX = '<span class="tex2jax_ignore mathjax_ignore">{}</span>'
_CONTROL = re.compile("[\x00-\x08\x0b-\x1f\x7f-\x9f\ufffe\uffff\ud800-\udfff\u202a-\u202e\u2066-\u2069]")


def plain(text: str) -> str:
    """Return text on one line without control characters."""
    return " ".join(_CONTROL.sub(" ", text).split())


def html_text(text: str) -> str:
    """Return text as HTML that no platform reads as anything else; the spaces at its ends stay."""
    shown = escape(_CONTROL.sub(" ", text), quote=False)
    return _SPECIAL.sub(lambda found: _NOT_TEX.format(f"&#{ord(found[0])};"), shown)


# -- the page ---------------------------------------------------------------------------------------------------------


def question_html(exercise: Exercise, *, dollars: bool = False) -> str:
    r"""Return the question as HTML, its formulas in LaTeX between `\(…\)` and `\[…\]`, or between dollars."""
    document = _document(exercise)
    return _TexHtml(printer_for(document, LatexPrinter), dollars=dollars).body(narrate(document))


def question_markdown(exercise: Exercise) -> str:
    """Return the question as Markdown, its formulas in LaTeX between dollars."""
    return Markdown().part(_document(exercise)).strip()


def question_xhtml(exercise: Exercise) -> str:
    """Return the question as well-formed XHTML, its formulas in MathML."""
    document = _document(exercise)
    body = HtmlWriter(printer_for(document, MathmlPrinter), prefix=None, level=3).body(narrate(document))
    body = body.replace("<math", '<math xmlns="http://www.w3.org/1998/Math/MathML"')
    fromstring(f"<div>{body}</div>")  # noqa: S314 - our own text: it must be well formed
    return body


def _document(exercise: Exercise) -> Question:
    return replace(question_of(exercise.problem), title="", source="")


class _TexHtml:
    """Writer of a question as HTML with LaTeX."""

    def __init__(self, printer: LatexPrinter, *, dollars: bool) -> None:
        """Write formulas between dollars, or between backslashes and brackets."""
        self.printer = printer
        self.inline, self.display = (("$", "$"), ("$$", "$$")) if dollars else ((r"\(", r"\)"), (r"\[", r"\]"))

    def body(self, blocks: tuple[Block, ...]) -> str:
        """Return all blocks."""
        return "\n".join(filter(None, map(self.block, blocks)))

    def block(self, block: Block) -> str:
        """Return one block."""
        match block:
            case Title(_, _, conventions):
                return f"<p>{self.sentence(conventions)}</p>" if conventions else ""
            case Heading(_, inlines):
                return f"<h4>{self.sentence(inlines).removesuffix('.')}</h4>"
            case Paragraph(inlines):
                return f"<p>{self.sentence(inlines)}</p>"
            case Display(relations, boxed, closing):
                rows, are_aligned = Layout(self.printer, self.printer.width, boxed=boxed, end=closing).rows(relations)
                lines = [
                    f"{row.left.source if row.left and are_aligned else ''}{'&' * are_aligned}{row.right.source}"
                    for row in rows
                ]
                body = r"\cr ".join(map(portable, lines))
                kind = "aligned" if are_aligned else "gathered"
                if len(lines) > 1 or are_aligned:
                    body = rf"\begin{{{kind}}}{body}\end{{{kind}}}"
                return f"<p>{self._between(self.display, body)}</p>"
        message = f"a question contains no {type(block).__name__}"
        raise TypeError(message)

    def sentence(self, inlines: Inlines) -> str:
        """Return running text."""
        return "".join(self._inline(part) for part in inlines)

    def _inline(self, part: object) -> str:
        if isinstance(part, str):
            return html_text(part)
        if isinstance(part, Roots):
            return ", ".join(self._math(root) for root in listed(part, self.printer, LATEX))
        return self._math(self.printer.inline(part))  # type: ignore[arg-type]

    def _math(self, latex: str) -> str:
        return self._between(self.inline, portable(latex).strip())

    @staticmethod
    def _between(ends: tuple[str, str], latex: str) -> str:
        """Return mathematics: no two brackets, no brace before a sign of a platform, and no HTML within."""
        return f"{ends[0]}{escape(latex.replace('[[', '[ [').replace('{#', '{ #').replace('{@', '{ @'))}{ends[1]}"


# -- the inputs -------------------------------------------------------------------------------------------------------


def label(part: ExportedPart, begin: str = r"\(", end: str = r"\)") -> str:
    """Return what stands in front of an input: a letter as mathematics, or the name of the field."""
    found = _LETTER.fullmatch(part.letter)
    if found and (found[2] is not None or len(part.letter) == 1):
        return f"{begin}{found[1]}{f'_{{{found[2]}}}' if found[2] else ''}{end}"
    return part.letter.replace("_", " ")


def instruction(part: ExportedPart, entries: str = "export_entries") -> str:
    """Return how to fill in an input, without its letter; `entries` is the phrase on numbers."""
    rows, columns = part.shape
    if part.kind == "word":
        return PHRASES["export_word"]
    said = PHRASES["export_function"].format(variable=part.data["variable"]) if part.is_function else PHRASES[entries]
    if (rows, columns) != (1, 1):
        said = f"{PHRASES['export_size'].format(rows=rows, columns=columns)} {said}"
    return f"{said} {PHRASES['export_many']}" if part.free else said


def matrix_text(part: ExportedPart) -> str:
    """Return a right value as a text that symobs reads."""
    rows = ["  ".join(str(entry).replace(" ", "") for entry in row) for row in part.right]
    return str(part.right[0][0]) if part.shape == (1, 1) and part.kind != "gain" else f"[{'; '.join(rows)}]"
