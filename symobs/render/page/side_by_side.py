"""Blocks side by side: which steps make a row, and how lines of characters stand beside each other."""

from __future__ import annotations

from itertools import zip_longest
from typing import TYPE_CHECKING, TypeGuard

from symobs.derivation import Section
from symobs.phrases import BESIDE, PHRASES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.derivation import Sentence, Step


def in_rows(runs: Sequence[Sequence[Step]]) -> list[tuple[tuple[Step, ...], ...]]:
    """Return runs of steps row by row: a step whose sentence goes on with nothing begins a row."""
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
    """Return whether a step is a section whose sections stand side by side."""
    return isinstance(step, Section) and step.title.key in BESIDE


def row_by_row(section: Section) -> list[Step]:
    """Return the steps of such a section as they are read: row by row, and then what stands below the columns."""
    columns = [step for step in section.steps if isinstance(step, Section)]
    cells = [step for row in in_rows([column.steps for column in columns]) for cell in row for step in cell]
    return [*cells, *(step for step in section.steps if step not in columns)]


def _begins(step: Step) -> bool:
    sentence: Sentence | None = getattr(step, "sentence", None)
    return sentence is not None and not PHRASES[sentence.key][:1].islower()
