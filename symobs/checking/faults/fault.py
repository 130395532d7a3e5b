"""A fault: one change of the right answer, or of what it was computed from, that gives the student's value."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import field
from typing import Any

from symobs._dataclass import dataclass


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
