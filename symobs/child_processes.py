"""What a process that may be ended from outside tells and bears: the group it waits for, and a bound of its memory."""

from __future__ import annotations

import sys
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


def bound_memory(size: int | None) -> None:
    """Limit the data of this process and its children in bytes; None removes the limit."""
    import resource  # noqa: PLC0415 - not on every system

    # On Linux the data alone; elsewhere all addresses, libraries and reserved space included.
    kind = resource.RLIMIT_DATA if sys.platform == "linux" else resource.RLIMIT_AS
    most = resource.getrlimit(kind)[1]
    wanted = most if size is None else size if most == resource.RLIM_INFINITY else min(size, most)
    resource.setrlimit(kind, (wanted, most))
    if size is not None:
        resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))
