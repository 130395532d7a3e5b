"""Plain text for terminals: the format `text`, 80 columns wide."""

from __future__ import annotations

import unicodedata
from copy import copy
from dataclasses import replace
from itertools import pairwise, zip_longest
from typing import TYPE_CHECKING, ClassVar

from symobs.formula.tree import Roots
from symobs.pages.formats.code.program import exact_answers
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
from symobs.pages.printers.root_lists import TEXT, in_a_row
from symobs.pages.printers.text_printer import RULE, TextPrinter, beside, text_width
from symobs.tasks.result import output_format

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.figures import Picture
    from symobs.pages.page.blocks import Block, Inline, Inlines
    from symobs.pages.page.sheet import Sheet
    from symobs.tasks.result import Document

WIDTH = 80
INDENT = "    "
#: An inline formula up to this many characters is kept on one line.
_KEPT_TOGETHER = 40
_NO_BREAK = "\N{NO-BREAK SPACE}"


@output_format
class Text:
    """Plain text for terminals."""

    name: ClassVar[str] = "text"
    suffix: ClassVar[str] = ".txt"

    def render(self, document: Document) -> str:
        """Return the document as plain text."""
        return TextWriter(printer_for(document, TextPrinter), WIDTH).body(narrate(document)) + "\n"

    def answers(self, document: Document) -> str:
        """Return the exact answers that are to be printed alone."""
        return exact_answers(document)

    def part(self, document: Document) -> str:
        """Return a question or a solution below its title."""
        title, blocks = opened(narrate(document))
        writer = TextWriter(printer_for(document, TextPrinter), WIDTH)
        below = writer.block(replace(title, text=""))
        return "\n\n".join(part for part in (below, writer.body(blocks)) if part)

    def sheet(self, sheet: Sheet) -> str:
        """Return the sheet as plain text."""
        pieces: list[str] = []
        for part in sheet.apart:
            pieces += _head(part)
            for chapter in part.chapters():
                pieces += [underlined(chapter.title, "=", WIDTH)] if chapter.title else []
                for item in chapter.items:
                    label = f"{sheet.words['problem']} {item.label}" if item.label[:1].isdigit() else item.label
                    whole = f"{label} {printable(item.title)}"
                    points = f" ({item.points})" if item.points else ""
                    heading = underlined(wrapped(f"{whole}{points}", WIDTH), "=", WIDTH)
                    pieces += [heading, item.part or wrapped(printable(item.text), WIDTH)]
        return "\n\n".join(pieces) + "\n"


def _head(sheet: Sheet) -> Iterator[str]:
    """Yield the paragraphs of the head of a sheet."""
    if sheet.course:
        yield wrapped(printable(sheet.course), WIDTH)
    if sheet.heading:
        yield underlined(wrapped(printable(sheet.heading), WIDTH), "=", WIDTH)
    if sheet.facts:
        yield "\n".join(wrapped(f"{word}: {printable(value)}", WIDTH) for word, value in sheet.facts)
    if sheet.fields:
        yield "\n\n".join(f"{word}: ".ljust(WIDTH, "_") for word in sheet.fields)
    for rows in sheet.totals:
        first = max(len(row[0]) for row in rows)
        yield "\n".join(f"{row[0]:{first}} {''.join(f'{cell:>6}' for cell in row[1:])}".rstrip() for row in rows)
    yield from (wrapped(printable(part), WIDTH) for part in sheet.header.text.split("\n\n") if part.strip())


class TextWriter:
    """Writer of blocks as lines of text; mathematics is written by its printer."""

    def __init__(self, printer: TextPrinter, width: int) -> None:
        """Write mathematics with `printer`, in lines of at most `width` columns where they can be broken."""
        self.printer = copy(printer)
        self.printer.width = width - len(INDENT)
        self.width = width

    def body(self, blocks: Sequence[Block]) -> str:
        """Return all blocks, separated by empty lines except after headings."""
        pieces = [self.block(block) for block in blocks]
        gaps = ["\n" if isinstance(before, Heading) else "\n\n" for before, _ in pairwise(blocks)]
        return "".join(text for pair in zip_longest(pieces, gaps, fillvalue="") for text in pair)

    def block(self, block: Block) -> str:
        """Return one block."""
        width = self.width
        match block:
            case Title(text, source, conventions):
                heading = underlined(wrapped(printable(text), width), "=", width)
                below = wrapped(f"{printable(source)} {self.sentence(conventions)}", width)
                return "\n".join(part for part in (heading, below) if part)
            case Heading(number, inlines, time):
                self.printer.keep_time(time)
                title = f"{number} {self.sentence(inlines)}".strip().removesuffix(".")
                return underlined(wrapped(title, width), "-", width)
            case Paragraph(inlines):
                return wrapped(self.sentence(inlines), width)
            case Display(relations, boxed, _, number):
                shown = indented(self.printer.display(relations, boxed=boxed))
                return f"{shown}    ({number})" if number else shown
            case Verified(inlines):
                return wrapped(self.sentence(inlines), width, first="✓ ")
            case Caution(label, inlines):
                return wrapped(f"{label} {self.sentence(inlines)}", width, first="! ")
            case References(label, entries):
                listed = (wrapped(printable(entry), width, first=f"[{n}] ") for n, entry in enumerate(entries, 1))
                return "\n".join([underlined(label, "-", width), *listed])
            case Drawing():
                words = wrapped(self.sentence(block.caption), width - len(INDENT))
                return indented(f"{self._sketch(block)}\n\n{words}") if words else indented(self._sketch(block))
            case AnswerSpace(is_ruled=is_ruled, lines=lines):
                return "\n\n".join(["_" * width if is_ruled else ""] * lines)
            case TableBlock():
                from symobs.pages.tables import text_table  # noqa: PLC0415 - only pages with tables

                table, legend = text_table(block, self.printer, self.remark)
                below = f"\n\n{wrapped(self.sentence(block.where), width)}\n\n{indented(legend)}" if legend else ""
                return f"{indented(table)}{below}"
            case PictureBlock(picture, sketched=sketched):
                words = wrapped(self.sentence(sketched), width - len(INDENT))
                return f"{indented(self._sketch(picture))}\n\n{indented(words)}"
            case CaseBlock(label, blocks):
                inside = TextWriter(self.printer, width - len(INDENT)).body(blocks)
                return f"{wrapped(self.sentence(label), width)}\n{indented(inside)}"
            case Columns(heads, rows):
                narrow = (width - len(RULE) * (len(heads) - 1)) // len(heads)
                writer = TextWriter(self.printer, narrow)
                titles = [underlined(wrapped(self.sentence(head), narrow), "-", narrow) for head in heads]
                cells = [titles, *([writer.body(cell) for cell in row] for row in rows)]
                return f"\n{beside([''] * len(heads), narrow)}\n".join(beside(row, narrow) for row in cells)

    def _sketch(self, item: Drawing | Picture) -> str:
        from symobs.pages.drawings.text import sketch  # noqa: PLC0415 - only pages with pictures

        return sketch(item, self.printer, self.width - len(INDENT))

    def sentence(self, inlines: Inlines) -> str:
        """Return running text with its mathematics."""
        return "".join(self._inline(part) for part in inlines)

    def remark(self, inlines: Inlines) -> str:
        """Return words without wrapping."""
        return self.sentence(inlines).replace(_NO_BREAK, " ")

    def _inline(self, part: Inline) -> str:
        if isinstance(part, str):
            return printable(part)
        if isinstance(part, Roots):
            return in_a_row(part, self.printer, TEXT, lambda root: root.replace(" ", _NO_BREAK))
        written = self.printer.inline(part)
        return written.replace(" ", _NO_BREAK) if text_width(written) <= _KEPT_TOGETHER else _kept_inside(written)


def _kept_inside(written: str) -> str:
    """Return a formula with breaks only outside parentheses and brackets, unless one of them is too long."""
    depth, start, kept = 0, 0, list(written)
    for place, character in enumerate(written):
        if character in "([":
            start = start if depth else place
            depth += 1
        elif character in ")]":
            depth -= 1
            if not depth and text_width(written[start:place]) <= _KEPT_TOGETHER:
                kept[start:place] = written[start:place].replace(" ", _NO_BREAK)
    return "".join(kept)


def printable(text: str) -> str:
    """Return external text without control and format characters."""
    return "".join(_harmless(character) for character in text)


def _harmless(character: str) -> str:
    if character.isspace():
        return " "
    kind = unicodedata.category(character)
    if kind in {"Cc", "Cf"}:
        return ""
    return "?" if kind.startswith("C") else character


def wrapped(text: str, width: int, *, first: str = "") -> str:
    """Return the text in lines of at most `width` columns; `first` opens the first line and sets in the others."""
    inside = width - text_width(first)
    lines: list[str] = []
    for word in filter(None, text.split(" ")):
        if lines and text_width(lines[-1]) + 1 + text_width(word) <= inside:
            lines[-1] += f" {word}"
        else:
            lines.append(word)
    return first + f"\n{' ' * len(first)}".join(lines).replace(_NO_BREAK, " ")


def underlined(text: str, mark: str, width: int) -> str:
    """Return the text underlined with `mark`, as wide as its last line; empty text is returned unchanged."""
    return f"{text}\n{mark * min(width, text_width(text.splitlines()[-1]))}" if text else ""


def indented(text: str) -> str:
    """Return the indented text."""
    return "\n".join(f"{INDENT}{line}".rstrip() for line in text.splitlines())
