"""Blocks: what a page is made of, before any format decides how it looks.

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
    """What the page is about, where the problem comes from, and the conventions it keeps."""

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
    """Sentences."""

    inlines: Inlines


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
    """A warning, or with `warns` False another note in small print, after its label."""

    label: str
    inlines: Inlines
    warns: bool = True


@dataclass(frozen=True)
class Drawing:
    """A block diagram: a figure of `flow` by its name, with the formulas and equations that label it."""

    name: str
    labels: tuple[tuple[str, Label], ...]


@dataclass(frozen=True)
class TableBlock:
    """Routh's table; each row with the remarks that may stand beside it, of which one is chosen, the first if it fits.

    `where` goes before what the entries stand for that are too wide for the table.
    """

    table: RouthTable
    variable: str
    remarks: tuple[tuple[Inlines, ...], ...]
    where: Inlines


@dataclass(frozen=True)
class PictureBlock:
    """A picture and what stands below it."""

    picture: Picture
    caption: Inlines


@dataclass(frozen=True)
class CaseBlock:
    """What holds in a special case: the label says which, the blocks are set in from the margin."""

    label: Inlines
    blocks: tuple[Block, ...]


@dataclass(frozen=True)
class Columns:
    """Blocks side by side under their heads, row by row; each row has a cell for each head."""

    heads: tuple[Inlines, ...]
    rows: tuple[tuple[tuple[Block, ...], ...], ...]


Block: TypeAlias = (
    Title
    | Heading
    | Paragraph
    | Display
    | Verified
    | Caution
    | Drawing
    | PictureBlock
    | TableBlock
    | CaseBlock
    | Columns
)


def every(blocks: Iterable[Block]) -> Iterator[Block]:
    """Yield all blocks, those inside cases and columns too."""
    for block in blocks:
        yield block
        if isinstance(block, CaseBlock):
            yield from every(block.blocks)
        elif isinstance(block, Columns):
            yield from every(inner for row in block.rows for cell in row for inner in cell)


def opened(page: tuple[Block, ...]) -> tuple[Title, tuple[Block, ...]]:
    """Return a page's title and what stands below it."""
    title, *body = page
    if not isinstance(title, Title):
        raise TypeError(f"a page begins with its title, not with {type(title).__name__}")
    return title, tuple(body)
