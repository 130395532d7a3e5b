"""The precision of enclosures: FLINT has one for the process, held by one thread at a time."""

from __future__ import annotations

from threading import RLock
from typing import TYPE_CHECKING

from flint import ctx

if TYPE_CHECKING:
    from types import TracebackType

_IN_USE = RLock()


class Precision:
    """A context manager that computes with this many bits, `with Precision(128): ...`; it may be nested."""

    __slots__ = ("before", "bits")

    def __init__(self, bits: int) -> None:
        """Take the bits of the block."""
        self.bits = bits

    def __enter__(self) -> None:
        _IN_USE.acquire()
        self.before, ctx.prec = ctx.prec, self.bits

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        ctx.prec = self.before
        _IN_USE.release()
