"""Which group of processes this one has started and waits for, told to whoever may have to end it from outside."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

#: Who wants to know: called with the number of a group when it has started, and with None when it has ended.
listeners: list[Callable[[int | None], None]] = []


@contextmanager
def running(group: int) -> Iterator[None]:
    """Tell that a group of processes has started, and, whatever happens, that it has ended."""
    try:
        _tell(group)
        yield
    finally:
        _tell(None)


def _tell(group: int | None) -> None:
    for listener in listeners:
        listener(group)
