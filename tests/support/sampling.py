"""How much is tried: a sample by default, the same in every run; all of it with SYMOBS_FULL=1."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Iterable

T = TypeVar("T")

FULL = os.environ.get("SYMOBS_FULL") == "1"


def every(step: int, found: Iterable[T], start: int = 0) -> list[T]:
    """Return one of `step` things, from another start for another test, so that together they try all of them."""
    return list(found) if FULL else list(found)[start::step]
