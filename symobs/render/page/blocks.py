"""Blocks of a page, independent of the output format.

The narrator writes them, the formats read them, and neither knows the other.  Text is plain; a format escapes it.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from symobs._dataclass import dataclass
from symobs.formula import Formula, Relation, Roots

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from symobs.figures.block_diagram import Label
    from symobs.figures.plot import Picture
    from symobs.stability.criteria.routh_table import RouthTable

Inline: TypeAlias = str | Formula | Relation | Roots
Inlines: TypeAlias = tuple[Inline, ...]


@dataclass(frozen=True)
class Title:
    """The title of a page, the source of the problem, and its conventions."""

    text: str
    source: str
    conventions: Inlines


@dataclass(frozen=True)
class Heading:
    """A heading that runs into the paragraph after it; `number` is empty where headings are not numbered."""

    number: str
    inlines: Inlines


@dataclass(frozen=True)
class Paragraph:
    """Sentences; the first may go on with what stands before them."""

    inlines: Inlines
    continues: bool = False


@dataclass(frozen=True)
class Display:
    """Relations set apart from the text; boxed, the last member of the last one is an answer.

    `closing` is the punctuation mark that the sentence around it asks for after it.
    """

    relations: tuple[Relation, ...]
    boxed: bool = False
    closing: str = ""


@dataclass(frozen=True)
class Verified:
    """The check of an answer."""

    inlines: Inlines


@dataclass(frozen=True)
class Caution:
    """A warning after its label."""

    label: str
    inlines: Inlines


@dataclass(frozen=True)
class References:
    """The sources at the end of a page, numbered from 1."""

    label: str
    entries: tuple[str, ...]


@dataclass(frozen=True)
class Drawing:
    """A block diagram: a figure of `flow` by its name, with the formulas and equations that label it."""

    name: str
    labels: tuple[tuple[str, Label], ...]


@dataclass(frozen=True)
class TableBlock:
    """The Routh array; each row has alternative remarks, of which the first that fits is printed.

    `where` goes before what the entries stand for that are too wide for the table.
    """

    table: RouthTable
    variable: str
    remarks: tuple[tuple[Inlines, ...], ...]
    where: Inlines


@dataclass(frozen=True)
class PictureBlock:
    """A plot and its caption."""

    picture: Picture
    caption: Inlines


@dataclass(frozen=True)
class CaseBlock:
    """A special case: a label with its condition, and indented blocks."""

    label: Inlines
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Columns:
    """Blocks in columns under heads, row by row, with a cell for each head."""

    heads: tuple[Inlines, ...]
    rows: tuple[tuple[tuple[Block, ...], ...], ...]


Block: TypeAlias = (
    Title
    | Heading
    | Paragraph
    | Display
    | Verified
    | Caution
    | References
    | Drawing
    | PictureBlock
    | TableBlock
    | CaseBlock
    | Columns
)


def every(blocks: Iterable[Block]) -> Iterator[Block]:
    """Yield all blocks, including those of cases and columns."""
    for block in blocks:
        yield block
        if isinstance(block, CaseBlock):
            yield from every(block.blocks)
        elif isinstance(block, Columns):
            yield from every(inner for row in block.rows for cell in row for inner in cell)


def opened(page: tuple[Block, ...]) -> tuple[Title, tuple[Block, ...]]:
    """Return the title of a page and the blocks below it."""
    title, *body = page
    if not isinstance(title, Title):
        raise TypeError(f"a page begins with its title, not with {type(title).__name__}")
    return title, tuple(body)
