"""What a slot of a sentence holds where a language has words for it: numbers of things, and a choice of states."""

from __future__ import annotations

from symobs.ground.dataclass import dataclass


@dataclass(frozen=True)
class Counted:
    """How many of a thing there are, or which one is meant: `thing` is a key of `COUNTS`; `among` how many there are in all."""

    thing: str
    count: int
    among: int = 0


@dataclass(frozen=True)
class StateChoice:
    """Sets of states, counted from 1, any one of which will do; all are of the same size."""

    sets: tuple[tuple[int, ...], ...]


#: What languages put into words.
SPOKEN = (Counted, StateChoice)
