"""Blocks of a page, independent of the output format.

The narrator writes them, the formats read them, and neither knows the other.  Text is plain; a format escapes it.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import zip_longest
from typing import TYPE_CHECKING, TypeAlias, TypeGuard

from symobs.formula.phrases import BESIDE, CONTINUES
from symobs.formula.tree import Formula, Relation, Roots
from symobs.ground.dataclass import dataclass
from symobs.proof.derivation import Section

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from symobs.formula.figures import Label, Picture
    from symobs.proof.derivation import Sentence, Step
    from symobs.stability.criteria.routh_table import RouthTable


Inline: TypeAlias = str | Formula | Relation | Roots
Inlines: TypeAlias = tuple[Inline, ...]


@dataclass
class Title:
    """The title of a page, the source of the problem, and its conventions."""

    text: str
    source: str
    conventions: Inlines


@dataclass
class Heading:
    """A heading that runs into the paragraph after it; `number` is empty where headings are not numbered.

    Where another time begins, `time` is the variable of the polynomials from here on, and whether time is discrete.
    """

    number: str
    inlines: Inlines
    time: tuple[str, bool] | None = None


@dataclass
class Paragraph:
    """Sentences; the first may go on with what stands before them."""

    inlines: Inlines
    continues: bool = False


@dataclass
class Display:
    """Relations set apart from the text; of so many of them at the end the last members are boxed answers.

    `closing` is the punctuation mark that the sentence around it asks for after it; `number` is that of an equation to
    which a later sentence refers, 0 for others.
    """

    relations: tuple[Relation, ...]
    boxed: int = 0
    closing: str = ""
    number: int = 0


@dataclass
class Verified:
    """The check of an answer."""

    inlines: Inlines


@dataclass
class Caution:
    """A warning after its label."""

    label: str
    inlines: Inlines


@dataclass
class References:
    """The sources at the end of a page, numbered from 1."""

    label: str
    entries: tuple[str, ...]


@dataclass
class Drawing:
    """A block diagram: a figure of `flow` by its name, with the formulas and equations that label it, and its caption."""

    name: str
    labels: tuple[tuple[str, Label], ...]
    caption: Inlines = ()


@dataclass
class TableBlock:
    """The Routh array; each row has alternative remarks, of which the first that fits is printed.

    `where` goes before what the entries stand for that are too wide for the table.
    """

    table: RouthTable
    variable: str
    remarks: tuple[tuple[Inlines, ...], ...]
    where: Inlines


@dataclass
class PictureBlock:
    """A plot and its caption; `sketched` is that of the plot in characters."""

    picture: Picture
    caption: Inlines
    sketched: Inlines


@dataclass
class CaseBlock:
    """A special case: a label with its condition, and indented blocks."""

    label: Inlines
    blocks: tuple[Block, ...]


@dataclass
class Columns:
    """Blocks in columns under heads, row by row, with a cell for each head."""

    heads: tuple[Inlines, ...]
    rows: tuple[tuple[tuple[Block, ...], ...], ...]


@dataclass
class AnswerSpace:
    """Room for an answer written by hand, in centimetres; ruled, with a line every eight millimetres."""

    height: int
    is_ruled: bool

    @property
    def lines(self) -> int:
        """The number of lines."""
        return max(1, self.height * 10 // 8)


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
    | AnswerSpace
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


#: With more answers than this in one section, the last alone are set in boxes.
_MOST_BOXES = 3


def with_few_boxes(blocks: Sequence[Block]) -> list[Block]:
    """Return the blocks of a section, only the last answers in boxes where there are many: those are the result."""
    boxes = [place for place, block in enumerate(blocks) if isinstance(block, Display) and block.boxed]
    if len(boxes) <= _MOST_BOXES:
        return list(blocks)
    result = boxes[-1]
    while result - 1 in boxes:
        result -= 1
    kept: list[Block] = []
    for place, block in enumerate(blocks):
        if not isinstance(block, Display) or place >= result:
            kept.append(block)
        elif kept and isinstance(before := kept[-1], Display) and not (before.boxed or before.number):
            kept[-1] = Display((*before.relations, *block.relations))
        else:
            kept.append(replace(block, boxed=0))
    return kept


# Sections in columns: the rows of their steps.


def in_rows(runs: Sequence[Sequence[Step]]) -> list[tuple[tuple[Step, ...], ...]]:
    """Return runs of steps row by row; a step with a complete sentence begins a row."""
    cut: list[list[tuple[Step, ...]]] = []
    for run in runs:
        rows: list[tuple[Step, ...]] = []
        for step in run:
            if rows and _begins(step) and any(map(_begins, rows[-1])):
                rows.append((step,))
            else:
                rows[-1:] = [(*(rows[-1] if rows else ()), step)]
        cut.append(rows)
    return list(zip_longest(*cut, fillvalue=()))


def is_beside(step: Step) -> TypeGuard[Section]:
    """Return whether a step is a section with its sections in columns."""
    return isinstance(step, Section) and step.title.key in BESIDE


def row_by_row(section: Section) -> list[Step]:
    """Return the steps of such a section in reading order: row by row, then those below the columns."""
    columns = [step for step in section.steps if isinstance(step, Section)]
    cells = [step for row in in_rows([column.steps for column in columns]) for cell in row for step in cell]
    return [*cells, *(step for step in section.steps if step not in columns)]


def _begins(step: Step) -> bool:
    sentence: Sentence | None = getattr(step, "sentence", None)
    return sentence is not None and sentence.key not in CONTINUES
