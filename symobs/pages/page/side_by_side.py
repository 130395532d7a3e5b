"""Sections in columns: the rows of their steps."""

from __future__ import annotations

from itertools import zip_longest
from typing import TYPE_CHECKING, TypeGuard

from symobs.formula.phrases import BESIDE, CONTINUES
from symobs.proof.derivation import Section

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.proof.derivation import Sentence, Step


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
