"""Names: which stand on a page already, and fresh ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from symobs.proof.derivation.builder import Builder


def taken_names(page: Builder) -> set[str]:
    """Return the names of parameters and coefficients that stand on the page."""
    named = page.environment.coefficients
    inside = {name for meaning in named.values() for name in meaning.field.names}
    return {*page.plant.symbols.signs, *page.plant.field.names, *named, *inside}


def fresh_names(stem: str, count: int, taken: Iterable[str], start: int = 1) -> tuple[str, ...]:
    """Return `stem1`, `stem2`, … (from `start` on) that are not among the names taken."""
    used = set(taken)
    names: list[str] = []
    index = start
    while len(names) < count:
        name = f"{stem}{index}"
        if name not in used:
            names.append(name)
        index += 1
    return tuple(names)
