"""Pieces of text in columns beside each other."""

from __future__ import annotations

from itertools import zip_longest
from typing import TYPE_CHECKING

from symobs.pages.printers.text_printer import text_width

if TYPE_CHECKING:
    from collections.abc import Sequence


#: What stands between two columns of characters.
RULE = " │ "


def beside(cells: Sequence[str], width: int) -> str:
    """Return pieces of text beside each other, each `width` columns wide and padded to the height of the highest."""
    lines = zip_longest(*(cell.split("\n") for cell in cells), fillvalue="")
    return "\n".join(RULE.join(f"{part}{' ' * (width - text_width(part))}" for part in line).rstrip() for line in lines)
