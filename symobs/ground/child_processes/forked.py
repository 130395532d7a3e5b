"""A child that is forked to do one thing: it has all that its parent has, and leaves in order when its time is over."""

from __future__ import annotations

import gc
import os
import signal
import sys
from typing import TYPE_CHECKING, NoReturn

from symobs.ground.child_processes.child import Child
from symobs.ground.child_processes.inside import NO_MEMORY, bound_memory, listeners, say

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType
    from typing import BinaryIO

#: How a child ends whose time was over, and one that was interrupted.
NO_TIME, INTERRUPTED = 75, 130
#: What asks a process to leave.
REQUESTS = {signal.SIGINT, signal.SIGTERM}


class TimeOver(BaseException):
    """Raised by SIGALRM in the child; a BaseException so that `except Exception` cannot swallow it."""


class _Forked:
    """A process that was forked, as `subprocess` would have it."""

    def __init__(self, pid: int) -> None:
        self.pid = pid
        self.code: int | None = None

    def kill(self) -> None:
        """End it now."""
        if self.code is None:
            os.kill(self.pid, signal.SIGKILL)

    def wait(self, timeout: float | None = None) -> int:  # noqa: ARG002 - it is ending when this is called
        """Wait for its end, and return its code."""
        if self.code is None:
            self.code = os.waitstatus_to_exitcode(os.waitpid(self.pid, 0)[1])
        return self.code


def forked(work: Callable[[Callable[[object], None]], object], seconds: float | None, size: int | None) -> Child:
    """Return a child that does the work within its seconds and bytes; what the work returns is its answer.

    `work` is given a function that reports how far it has come.  Requests to leave are blocked here when this returns,
    until the parent is ready for them.
    """
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    reading, writing = os.pipe()
    signal.pthread_sigmask(signal.SIG_BLOCK, REQUESTS)  # until both sides know what to do then
    child = os.fork()
    if child == 0:
        os.close(reading)
        _do(work, seconds, size, os.fdopen(writing, "wb"))
    os.close(writing)
    return Child(_Forked(child), os.fdopen(reading, "rb"))


def _do(
    work: Callable[[Callable[[object], None]], object], seconds: float | None, size: int | None, stream: BinaryIO
) -> NoReturn:
    """Do the work, say what it returns, and end this process."""
    code = 1
    try:
        listeners.append(lambda group: say(stream, "group", group))
        _set_up(seconds, size)
        found = work(lambda reached: say(stream, "reached", reached() if callable(reached) else reached))
        signal.setitimer(signal.ITIMER_REAL, 0)
        if size is not None:
            bound_memory(None)
        say(stream, "answer", found)
        code = 0
    except TimeOver:
        code = NO_TIME
    except MemoryError:
        code = NO_MEMORY
    except KeyboardInterrupt:
        code = INTERRUPTED
    finally:
        os._exit(code)  # nothing that was prepared before the fork is to be done twice


def _set_up(seconds: float | None, size: int | None) -> None:
    """Set the limits of this process and its handlers for orderly termination."""

    def leave(number: int, _: FrameType | None) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        raise TimeOver if number == signal.SIGALRM else KeyboardInterrupt

    signal.signal(signal.SIGINT, leave)
    signal.signal(signal.SIGALRM, leave)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, REQUESTS)
    gc.freeze()  # what is there already is shared with the parent as long as nobody looks at it
    sys.unraisablehook = lambda _: None  # an alarm that C code could not pass on: the parent sees to it
    _silence()
    if size is not None:
        bound_memory(size)
    if seconds is not None:
        signal.setitimer(signal.ITIMER_REAL, seconds)


def _silence() -> None:
    """Discard the messages of aborting libraries, but not those of symobs."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    if sys.stderr is sys.__stderr__ and sys.stderr is not None:
        sys.stderr = open(os.dup(2), "w", buffering=1, encoding=sys.stderr.encoding, errors="backslashreplace")  # noqa: PTH123, SIM115 - until this process ends
        os.dup2(nowhere, 2)
