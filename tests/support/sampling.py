"""How much is tried: a sample by default, the same in every run; all of it with SYMOBS_FULL=1."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, TypeVar

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable

T = TypeVar("T")

FULL = os.environ.get("SYMOBS_FULL") == "1"


def every(step: int, found: Iterable[T], start: int = 0) -> list[T]:
    """Return one of `step` things, from another start for another test, so that together they try all of them."""
    return list(found) if FULL else list(found)[start::step]


def seeds(quick: int, total: int = 200) -> list[Any]:
    """Return seeds: a few for the quick tests, sixteen for the slow ones, all of them with SYMOBS_FULL=1."""
    slow = range(quick, total if FULL else 16)
    return [*range(quick), *(pytest.param(seed, marks=pytest.mark.slow) for seed in slow)]


def tried(count: int) -> int:
    """Return how many examples of a long property Hypothesis draws: a third, all of them with SYMOBS_FULL=1."""
    return count if FULL else count // 3
