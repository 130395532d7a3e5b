"""Remarks beside the rows of the Routh array."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.formula.convention import STANDARD
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.tree import Literal
from symobs.pages.page.prose import filled
from symobs.proof.derivation import Sentence

if TYPE_CHECKING:
    from symobs.formula.phrases.languages import Language
    from symobs.pages.page.blocks import Inlines
    from symobs.stability.criteria.routh_table import RouthTable


def remarks(table: RouthTable, variable: str, language: Language = ENGLISH) -> tuple[tuple[Inlines, ...], ...]:
    """Return the remarks beside each row of an array: none, or the replacement of zeros, in full and shorter."""
    found: list[tuple[Inlines, ...]] = []
    for row in table.rows:
        if row.origin == "epsilon":
            small = Literal(row.entries[0])
            found.append((filled(Sentence("routh_row_epsilon", (("epsilon", small),)), STANDARD, language),))
        elif row.origin == "auxiliary":
            polynomial = Literal(table.auxiliary(row, variable))
            full = filled(Sentence("routh_row_auxiliary", (("auxiliary", polynomial),)), STANDARD, language)
            found.append((full, filled(Sentence("routh_row_derivative"), STANDARD, language)))
        else:
            found.append(())
    return tuple(found)
