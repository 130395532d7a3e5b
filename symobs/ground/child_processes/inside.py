"""The side of a child: what bounds it, what it tells of itself, and how it answers until nobody asks."""

from __future__ import annotations

import errno
import gc
import os
import pickle
import signal
import sys
from contextlib import contextmanager, suppress
from typing import TYPE_CHECKING, Any, NoReturn

from symobs.ground.child_processes import COLLECTED_AFTER

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from typing import BinaryIO

#: How a child ends that had not enough memory.
NO_MEMORY = 76
#: The bytes that tell the length of a record.
HEAD = 8

#: Who wants to know: called with the number of a group when it has started, and with None when it has ended.
listeners: list[Callable[[int | None], None]] = []


@contextmanager
def running(group: int) -> Iterator[None]:
    """Report that a group of processes has started, and, whatever happens, that it has ended."""
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


def is_for_want_of_memory(error: Exception, *, is_bounded: bool = True) -> bool:
    """Return whether an error is due to exhausted memory, where it is bounded also one of an import or of C code."""
    if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
        return True
    return is_bounded and type(error) in {SystemError, ImportError}


def say(stream: BinaryIO, kind: str, content: object) -> None:
    """Write a record: its length, its kind and its content."""
    data = pickle.dumps((kind, content))
    stream.write(len(data).to_bytes(HEAD) + data)
    stream.flush()


def serve(
    prepare: Callable[..., object], answer: Callable[[Any], object], is_worn: Callable[[], bool] = lambda: False
) -> NoReturn:
    """Answer what comes over standard input until it ends, or until this process is to be replaced.

    The command has the number of the parent, the megabytes allowed (0 is unlimited), and what `prepare` is called with.
    """
    parent, megabytes, *words = sys.argv[1:]
    stream = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what libraries print must not come between the records
    _die_with(int(parent))
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.set_threshold(COLLECTED_AFTER)
    listeners.append(lambda group: say(stream, "group", group))
    prepare(*words)
    gc.freeze()
    if float(megabytes):
        with suppress(ImportError, ValueError, OSError):  # where the system can
            bound_memory(int(float(megabytes) * 2**20))
    say(stream, "ready", None)
    while True:
        try:
            question, seconds = pickle.load(sys.stdin.buffer)  # noqa: S301 - the parent's
        except (EOFError, pickle.UnpicklingError):  # in the middle of a question, too
            os._exit(0)
        _limit(seconds)
        try:
            found = answer(question)
        except MemoryError:
            os._exit(NO_MEMORY)  # what the libraries left behind is no ground to build on
        _limit(None)
        say(stream, "last" if is_worn() else "answer", found)


def _limit(seconds: float | None) -> None:
    """End this process when its time is over for good, should nobody be there to do it."""
    if hasattr(signal, "setitimer"):
        signal.signal(signal.SIGALRM, signal.SIG_DFL)
        signal.setitimer(signal.ITIMER_REAL, 0 if seconds is None else seconds)


def _die_with(parent: int) -> None:
    """Ask Linux to kill this process when the thread that started it ends; elsewhere its input ends then."""
    if sys.platform == "linux":
        import ctypes  # noqa: PLC0415 - on Linux only

        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
        if os.getppid() != parent:  # it ended before it was asked for
            os._exit(0)
