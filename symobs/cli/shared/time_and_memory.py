"""Time and memory of a command, as `--timeout` and `--memory` allow them.

The work is done by a child process and handed back whole: a call into FLINT hears no signal, and one that gets no memory
aborts its process, so that neither can be ended or told from within.
"""

from __future__ import annotations

import errno
import gc
import io
import os
import pickle
import select
import signal
import sys
import threading
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Any, NamedTuple, NoReturn, TypeVar

from symobs.child_processes import bound_memory, listeners
from symobs.errors import OutOfBudget, SymobsError, TypesettingError, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from types import FrameType

    #: Called with the name of the task begun, or with the partial outcome that is kept if the work ends there.
    Progress = Callable[[object], None]

Value = TypeVar("Value")

#: Seconds that a child whose time is over has to leave in order (its TeX, its files); in a call into FLINT it cannot.
GRACE = 1.0
_LOOK_EVERY = 0.01
#: How a child leaves that cannot say more.
_NO_TIME, _NO_MEMORY, _INTERRUPTED = 75, 76, 130
_ASKED_TO_LEAVE = {signal.SIGINT, signal.SIGTERM}
_LESS = "ask for less, or put numbers in place of symbols"


class Budget(NamedTuple):
    """The time and memory allowed for a piece of work; None is unlimited."""

    seconds: float | None = None
    megabytes: float | None = None


class _TimeOver(BaseException):
    """Raised by SIGALRM in the worker; a BaseException so that `except Exception` cannot swallow it."""


def within(budget: Budget, work: Callable[[Progress], Value], where: str = "") -> Value:
    """Return the value of `work`, or raise its error; raises `OutOfBudget` beyond its budget.

    `work` is given a function that takes how far it has come: a text says what it is at work on, anything else, or
    what a function returns, is what would be left of it now, and stands in `OutOfBudget.facts["left"]`.
    """
    _require_child_processes(budget)
    for stream in (sys.stdout, sys.stderr):
        if stream is not None:
            stream.flush()
    reading, writing = os.pipe()
    signal.pthread_sigmask(signal.SIG_BLOCK, _ASKED_TO_LEAVE)  # until both sides know what to do then
    child = os.fork()
    if child == 0:
        os.close(reading)
        _work(budget, work, writing)
    os.close(writing)
    with open(reading, "rb", buffering=0) as stream:  # noqa: PTH123 - a pipe, no path
        said, status = _heard(stream, child, budget.seconds)
    value: Value = _answer(said, status, budget, where)
    return value


def bounded(work: Callable[[], Value], *, timeout: float | None = None, memory: float | None = None) -> Value:
    """Return the value of a function of no arguments, computed within its time and memory.

    timeout   seconds; memory   megabytes; None is unlimited
    The work is done by a child process and its value handed back: `bounded(lambda: symobs.observer(plant, poles="-1,
    -2"), timeout=10)`.  What it prints is lost, and its errors are raised here.  Raises `OutOfBudget` where time or
    memory is not enough, `UsageError` where the system cannot bound them.
    """
    for name, amount in (("timeout", timeout), ("memory", memory)):
        if amount is not None and not 0 < amount < float("inf"):
            raise UsageError(f"{amount} is not a positive number", where=name, repair=f"write for example {name}=60")
    if threading.current_thread() is not threading.main_thread():
        message = "only the main thread can wait for a computation that is to be ended"
        raise UsageError(message, where="bounded", repair="call it in the main thread, or in a process of its own")
    try:
        return within(Budget(timeout, memory), lambda _: work())
    except (OutOfBudget, UsageError) as error:
        error.where, error.repair = error.where.replace("--", ""), error.repair.replace("--", "")
        raise


def _require_child_processes(budget: Budget) -> None:
    """Raise `UsageError` if the system cannot enforce a budget."""
    option = "--memory" if budget.seconds is None else "--timeout"
    if not hasattr(os, "fork"):
        repair = f"leave {option} out, or use Linux, macOS or the Windows Subsystem for Linux"
        raise UsageError("this system cannot end a computation that is under way", where=option, repair=repair)
    if budget.megabytes is not None and sys.platform == "darwin":
        repair = "leave it out, or use Linux"
        raise UsageError("macOS does not bound the memory of a process", where="--memory", repair=repair)


# -- the child --------------------------------------------------------------------------------------------------------


def _work(budget: Budget, work: Callable[[Progress], Any], writing: int) -> NoReturn:
    """Do the work, write its value to a pipe, and end this process."""
    code = 1
    try:
        with open(writing, "wb", buffering=0) as stream:

            def report_progress(reached: object) -> None:
                _say(stream, "reached", reached() if callable(reached) else reached)

            try:
                listeners.append(lambda group: _say(stream, "group", group))
                _set_up(budget)
                kind, outcome = "value", work(report_progress)
            except SymobsError as error:
                kind, outcome = "error", error
            except Exception as error:  # noqa: BLE001 - whatever it is, it is handed to the parent
                if _for_want_of_memory(error, budget):
                    raise MemoryError from None
                kind, outcome = "error", _portable(error)
            except _TimeOver as over:
                if not _tex_was_at_work(over):
                    raise
                kind, outcome = "error", _tex_took_too_long(budget)
            _lift(budget)
            _say(stream, kind, outcome)
        code = 0
    except _TimeOver:
        code = _NO_TIME
    except MemoryError:
        code = _NO_MEMORY
    except KeyboardInterrupt:
        code = _INTERRUPTED
    finally:
        os._exit(code)  # nothing that was prepared before the fork is to be done twice


def _say(stream: io.RawIOBase, kind: str, content: object) -> None:
    data = memoryview(pickle.dumps((kind, content)))
    while data:
        data = data[stream.write(data) or 0 :]


def _set_up(budget: Budget) -> None:
    """Set the limits of this process and its handlers for orderly termination."""

    def leave(number: int, _: FrameType | None) -> None:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        raise _TimeOver if number == signal.SIGALRM else KeyboardInterrupt

    signal.signal(signal.SIGINT, leave)
    signal.signal(signal.SIGALRM, leave)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, _ASKED_TO_LEAVE)
    gc.freeze()  # what is there already is shared with the parent as long as nobody looks at it
    sys.unraisablehook = lambda _: None  # an alarm that C code could not pass on: the parent sees to it
    _silence()
    if budget.megabytes is not None:
        bound_memory(int(budget.megabytes * 2**20))
    if budget.seconds is not None:
        signal.setitimer(signal.ITIMER_REAL, budget.seconds)


def _silence() -> None:
    """Discard the messages of aborting libraries, but not those of symobs."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    if sys.stderr is sys.__stderr__ and sys.stderr is not None:
        sys.stderr = open(os.dup(2), "w", buffering=1, encoding=sys.stderr.encoding, errors="backslashreplace")  # noqa: PTH123, SIM115 - until this process ends
        os.dup2(nowhere, 2)


def _lift(budget: Budget) -> None:
    """Remove the limits once the answer is computed."""
    signal.setitimer(signal.ITIMER_REAL, 0)
    if budget.megabytes is not None:
        bound_memory(None)


def _for_want_of_memory(error: Exception, budget: Budget) -> bool:
    """Return whether an error is due to exhausted memory, including those of imports and C code."""
    if isinstance(error, MemoryError) or getattr(error, "errno", None) == errno.ENOMEM:
        return True
    return budget.megabytes is not None and isinstance(error, SystemError | ImportError)


def _portable(error: Exception) -> Exception:
    """Return an error that crosses the pipe: itself, or one with its name and text."""
    try:
        pickle.loads(pickle.dumps(error))  # noqa: S301 - made a moment ago
    except Exception:  # noqa: BLE001 - whatever an error's own code does
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _tex_was_at_work(error: BaseException) -> bool:
    from symobs.render.formats.pdf import TEX_AT_WORK  # noqa: PLC0415 - only where time ran out

    return TEX_AT_WORK in getattr(error, "__notes__", ())


def _tex_took_too_long(budget: Budget) -> TypesettingError:
    message = f"TeX was stopped: {budget.seconds:g} seconds were over"
    return TypesettingError(message, repair="give more with --timeout, or write LaTeX with --format latex")


# -- the parent -------------------------------------------------------------------------------------------------------


def _heard(stream: io.FileIO, child: int, seconds: float | None) -> tuple[bytes, int | None]:
    """Return the output of a child and its status, None if it was ended."""
    said = bytearray()
    end = None if seconds is None else time.monotonic() + seconds + GRACE
    usual = signal.signal(signal.SIGTERM, _leave)
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, _ASKED_TO_LEAVE)
        while True:
            left = None if end is None else max(0.0, end - time.monotonic())
            if not select.select([stream], [], [], left)[0]:
                _kill(child, stream, said)
                return bytes(said), None
            chunk = stream.read(1 << 20)
            if not chunk:
                status = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
                _end_group(said)
                return bytes(said), status
            said += chunk
    except BaseException:
        _end(child, stream, said)
        raise
    finally:
        signal.signal(signal.SIGTERM, usual)


def _leave(number: int, _: FrameType | None) -> None:
    raise SystemExit(128 + number)


def _kill(child: int, stream: io.FileIO, said: bytearray) -> None:
    """Kill a child that does not terminate, and the group of processes that it waits for."""
    os.kill(child, signal.SIGKILL)
    os.waitpid(child, 0)
    while chunk := stream.read(1 << 20):  # up to its end: nobody else holds the pipe
        said += chunk
    _end_group(said)


def _end_group(said: bytearray) -> None:
    """Kill the group of processes that a terminated child was waiting for."""
    groups = [content for kind, content in _records(said) if kind == "group"]
    if groups and groups[-1] is not None:
        with suppress(ProcessLookupError):
            os.killpg(groups[-1], signal.SIGKILL)


def _end(child: int, stream: io.FileIO, said: bytearray) -> None:
    """Terminate a child, and kill it if it does not exit."""
    usual = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        os.kill(child, signal.SIGINT)
        end = time.monotonic() + GRACE / 2  # who interrupts is not to wait a second
        while os.waitpid(child, os.WNOHANG)[0] == 0:
            if time.monotonic() > end:
                _kill(child, stream, said)
                return
            time.sleep(_LOOK_EVERY)
    except (ProcessLookupError, ChildProcessError):
        return  # it has ended and has been waited for
    finally:
        signal.signal(signal.SIGINT, usual)


def _answer(said: bytes, status: int | None, budget: Budget, where: str) -> Any:
    """Return the child's value, or raise the error that ended it."""
    left, at_work = None, ""
    for kind, content in _records(said):
        if kind == "value":
            return content
        if kind == "error":
            raise content
        if kind == "group":
            continue
        if isinstance(content, str):
            at_work = f", at work on {content}"
        else:
            left = content
    if status is None or status == _NO_TIME:
        message = f"undecided: {budget.seconds:g} seconds were not enough{at_work}"
        raise OutOfBudget(message, where=where, repair=f"give more with --timeout, {_LESS}", left=left)
    if status in {_NO_MEMORY, -signal.SIGKILL} or (_memory_is_bounded(budget) and _crashed(status)):
        amount = f"{budget.megabytes:g} MB of memory were" if budget.megabytes else "the memory there is was"
        more = "give more with --memory, " if budget.megabytes else ""
        message = f"undecided: {amount} not enough{at_work}"
        raise OutOfBudget(message, where=where, repair=f"{more}{_LESS}", left=left)
    if status == _INTERRUPTED:
        raise KeyboardInterrupt
    name = signal.Signals(-status).name if status < 0 else f"exit code {status}"
    raise RuntimeError(f"the computation ended with {name}{at_work}")


def _records(said: bytes | bytearray) -> Iterator[tuple[str, Any]]:
    """Yield the complete records of a child."""
    records = io.BytesIO(said)
    with suppress(EOFError, pickle.UnpicklingError):
        while True:
            yield pickle.load(records)  # noqa: S301 - our own child's


def _memory_is_bounded(budget: Budget) -> bool:
    """Return whether memory is limited, here or by the system; FLINT aborts at the limit."""
    import resource  # noqa: PLC0415 - not on every system

    bounds = (resource.getrlimit(kind)[0] for kind in (resource.RLIMIT_AS, resource.RLIMIT_DATA))
    return budget.megabytes is not None or any(bound != resource.RLIM_INFINITY for bound in bounds)


def _crashed(status: int | None) -> bool:
    return status in {-signal.SIGABRT, -signal.SIGSEGV, -signal.SIGBUS}
