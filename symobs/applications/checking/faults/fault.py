"""A fault: one change of the right answer, or of what it was computed from, that gives the student's value."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field
from typing import TYPE_CHECKING, Any

from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.exact import Matrix


@dataclass(frozen=True)
class Fault:
    """The slip by its name, the reason in words, and the place: `[row, column]` or `{"coefficient": 1}`."""

    slip: str
    reason: str
    place: Any = None


@dataclass(frozen=True)
class Explained:
    """Why a part is wrong: the slip, None where none was found, other ones that fit as well, and what the value does."""

    slip: str | None = None
    reason: str = ""
    place: Any = None
    alternatives: tuple[Fault, ...] = ()
    effect: Mapping[str, str] = field(default_factory=dict)
    tried: int = 0


#: Finds the faults of one kind that reproduce a value.
Kind = Callable[[], Iterable[Fault]]


def is_empty_but_for(value: Matrix, i: int, j: int) -> bool:
    """Return whether all other entries of a matrix are zero, so that this one is all that there is to find."""
    return all(entry.is_zero for a, row in enumerate(value.rows) for b, entry in enumerate(row) if (a, b) != (i, j))


def first_kind(kinds: Iterable[Kind]) -> Explained:
    """Return the fault of the first kind that reproduces the value; several of one kind are ambiguous."""
    tried = 0
    for kind in kinds:
        tried += 1
        found = list({(fault.slip, fault.reason): fault for fault in kind()}.values())
        if len(found) == 1:
            return Explained(found[0].slip, found[0].reason, found[0].place, tried=tried)
        if found:
            return Explained("ambiguous", "one of several slips", None, tuple(found), tried=tried)
    return Explained(tried=tried)
