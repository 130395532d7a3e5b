"""Time and memory of a command, as `--timeout` and `--memory` allow them: the work is done by a child process."""

from __future__ import annotations

import os
import pickle
import signal
import sys
import threading
from typing import TYPE_CHECKING, Any, TypeVar

from symobs.ground.child_processes.budget import Budget
from symobs.ground.child_processes.child import Died
from symobs.ground.child_processes.forked import INTERRUPTED, NO_TIME, REQUESTS, TimeOver, forked
from symobs.ground.child_processes.inside import NO_MEMORY, is_for_want_of_memory
from symobs.ground.errors import OutOfBudget, SymobsError, TypesettingError, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType

    #: Called with the name of the task begun, or with the partial outcome that is kept if the work ends there.
    Progress = Callable[[object], None]

Value = TypeVar("Value")

#: Seconds that a child whose time is over has to leave in order (its TeX, its files); in a call into FLINT it cannot.
GRACE = 1.0
_ABORTS = {getattr(signal, name, None) for name in ("SIGABRT", "SIGSEGV", "SIGBUS")}
_LESS = "ask for less, or put numbers in place of symbols"


def within(budget: Budget, work: Callable[[Progress], Value], where: str = "") -> Value:
    """Return the value of `work`, or raise its error; raises `OutOfBudget` beyond its budget.

    `work` is given a function that takes how far it has come: a text says what it is at work on, anything else, or
    what a function returns, is what would be left of it now, and stands in `OutOfBudget.facts["left"]`.
    """
    _require_child_processes(budget)
    seconds, megabytes = budget
    reached: dict[bool, Any] = {}  # by whether it is a text, the last of each
    size = None if megabytes is None else int(megabytes * 2**20)
    child = forked(lambda report: _outcome(budget, work, report), seconds, size)
    usual = signal.signal(signal.SIGTERM, _leave)
    try:
        signal.pthread_sigmask(signal.SIG_UNBLOCK, REQUESTS)
        last = None if seconds is None else seconds + GRACE
        value, error = child.ask(None, last, hear=lambda what: reached.update({isinstance(what, str): what}))
    except (TimeoutError, Died) as end:
        code = end.code if isinstance(end, Died) else NO_TIME
        if code == INTERRUPTED:
            raise KeyboardInterrupt from None
        if code == NO_TIME and child.group is not None:  # the only group of processes that work starts is TeX
            raise _tex_stopped(budget) from None
        raise _exhausted(budget, code, reached, where) from None
    finally:
        interrupts = signal.signal(signal.SIGINT, signal.SIG_IGN)
        child.leave(GRACE / 2)  # who interrupts is not to wait a second
        signal.signal(signal.SIGINT, interrupts)
        signal.signal(signal.SIGTERM, usual)
    if error is not None:
        raise error
    found: Value = value
    return found


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


def _outcome(budget: Budget, work: Callable[[Progress], Any], report: Progress) -> tuple[Any, Exception | None]:
    """Return the value of the work, or its error as one that reaches another process; what exhausts its budget is raised."""
    try:
        return work(report), None
    except SymobsError as error:
        return None, error
    except Exception as error:  # noqa: BLE001 - whatever it is, it is handed to the parent
        if is_for_want_of_memory(error, is_bounded=budget.megabytes is not None):
            raise MemoryError from None
        return None, _portable(error)
    except TimeOver as over:
        from symobs.pages.formats.pdf import TEX_AT_WORK  # noqa: PLC0415 - only where time ran out

        if TEX_AT_WORK not in getattr(over, "__notes__", ()):
            raise
        return None, _tex_stopped(budget)


def _tex_stopped(budget: Budget) -> TypesettingError:
    message = f"TeX was stopped: {budget.seconds:g} seconds were over"
    return TypesettingError(message, repair="give more with --timeout, or write LaTeX with --format latex")


def _portable(error: Exception) -> Exception:
    """Return an error that crosses the pipe: itself, or one with its name and text."""
    try:
        pickle.loads(pickle.dumps(error))  # noqa: S301 - made a moment ago
    except Exception:  # noqa: BLE001 - whatever an error's own code does
        return RuntimeError(f"{type(error).__name__}: {error}")
    return error


def _leave(number: int, _: FrameType | None) -> None:
    raise SystemExit(128 + number)


def _exhausted(budget: Budget, code: int, reached: dict[bool, Any], where: str) -> Exception:
    """Return the error for work that has ended without a value."""
    at_work = f", at work on {reached[True]}" if True in reached else ""
    if code == NO_TIME:
        amount, option = f"{budget.seconds:g} seconds were", "give more with --timeout, "
    elif code in {NO_MEMORY, -signal.SIGKILL} or (-code in _ABORTS and _memory_is_bounded(budget)):
        amount = f"{budget.megabytes:g} MB of memory were" if budget.megabytes else "the memory there is was"
        option = "give more with --memory, " if budget.megabytes else ""
    else:
        return RuntimeError(f"the computation ended with {Died(code)}{at_work}")
    message = f"undecided: {amount} not enough{at_work}"
    return OutOfBudget(message, where=where, repair=f"{option}{_LESS}", left=reached.get(False))


def _memory_is_bounded(budget: Budget) -> bool:
    """Return whether memory is limited, here or by the system; FLINT aborts at the limit."""
    import resource  # noqa: PLC0415 - not on every system

    bounds = (resource.getrlimit(kind)[0] for kind in (resource.RLIMIT_AS, resource.RLIMIT_DATA))
    return budget.megabytes is not None or any(bound != resource.RLIM_INFINITY for bound in bounds)
