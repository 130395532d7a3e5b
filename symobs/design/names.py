"""Which names stand on a page already."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from symobs.page import Page


def taken_names(page: Page) -> set[str]:
    """Return the names of parameters and coefficients that stand on the page."""
    named = page.environment.coefficients
    inside = {name for meaning in named.values() for name in meaning.field.names}
    return {*page.plant.symbols.signs, *page.plant.field.names, *named, *inside}
