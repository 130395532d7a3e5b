"""The time and the memory that a piece of work is allowed."""

from __future__ import annotations

from typing import NamedTuple


class Budget(NamedTuple):
    """The time and the memory allowed for a piece of work; None is unlimited."""

    seconds: float | None = None
    megabytes: float | None = None

    def exceeds(self, other: Budget) -> bool:
        """Return whether this one allows more of something than another."""
        pairs = zip(self, other, strict=True)
        return any(theirs is not None and (own is None or own > theirs) for own, theirs in pairs)
