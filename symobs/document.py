"""What a format renders: a title, its source, results, and the convention in which they are told."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from symobs.convention import STANDARD, Convention
from symobs.derivation import translated

if TYPE_CHECKING:
    from symobs.derivation import Derivation
    from symobs.method import Result


@dataclass(frozen=True)
class Document:
    """A page in the making: its title, its source, its results, and its convention."""

    title: str
    source: str
    results: tuple[Result, ...]
    convention: Convention = STANDARD

    @cached_property
    def derivations(self) -> tuple[Derivation, ...]:
        """The checked derivations of the results, in the signs of the convention."""
        return tuple(translated(result.derivation, self.convention) for result in self.results)
