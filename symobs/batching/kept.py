"""Kept children: a thread of a worker has one child process, which does job after job and is replaced when it dies."""

from __future__ import annotations

import json
import os
import queue
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryFile
from typing import TYPE_CHECKING, Any

from symobs.batching.jobs import Budget, fingerprint
from symobs.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    #: What a worker is given of a job: its key, its kind and the text of its data.
    Order = tuple[str, str, str]

#: Seconds that a child is given beyond the time of its job before it ends itself.
_GRACE = 5.0
#: Seconds in which a child must have imported what it needs, on the busiest machine.
_START = 300.0
#: How often a job may end its process.
_ATTEMPTS = 2
_NO_MEMORY = 76
_LAST_WORDS = 2000
_LOOK_EVERY = 1.0


class Ended(RuntimeError):
    """The run is over: its children are ended and get no successors."""


def run_chunk(
    orders: Sequence[Order], budget: tuple[float | None, float | None], expected: str
) -> tuple[list[str], float]:
    """Return the rows of some jobs as JSON, made by the child of this thread, and the seconds this took.

    Raises `InputError` where this worker has other versions than expected.
    """
    began = time.monotonic()
    if identity() != expected:
        message = f"a worker has {identity()}, this process {expected}"
        raise InputError(message, where="--scheduler", repair="install the same versions everywhere")
    limits = Budget(*budget)
    rows = [_row_text(key, kind, _row(kind, payload, limits)) for key, kind, payload in orders]
    return rows, time.monotonic() - began


def run_in_process(orders: Sequence[Order], _: object, __: str) -> tuple[list[str], float]:
    """Return the same rows without a child, and so without limits."""
    from symobs.batching.child import worked  # noqa: PLC0415 - it imports the kernel

    began = time.monotonic()
    rows = [_row_text(key, kind, worked(kind, payload)[0]) for key, kind, payload in orders]
    return rows, time.monotonic() - began


def identity() -> str:
    """Return the versions that must be the same wherever jobs of one run are done."""
    return f"{fingerprint()}, Python {sys.version_info.major}.{sys.version_info.minor}"


def _row_text(key: str, kind: str, row: dict[str, Any]) -> str:
    """Return a row as JSON; its key and its status stand first, where an index is read from."""
    whole = {"key": key, "status": row.pop("status"), "kind": kind, **row}
    return json.dumps(whole, ensure_ascii=False, separators=(",", ":"))


def _row(kind: str, payload: str, limits: Budget) -> dict[str, Any]:
    """Return the row of one job; what ends its process is tried once more, in a fresh one."""
    found: dict[str, Any] = {}
    told = {"seconds": limits.seconds, "megabytes": limits.megabytes}
    for attempt in range(1, _ATTEMPTS + 1):
        child = _own_child(kind, limits, fresh=attempt > 1)
        try:
            return child.row(kind, payload, limits.seconds)
        except TimeoutError:
            reason = f"{limits.seconds:g} seconds were not enough"
            return {"status": "undecided", "error": [reason], "budget": told}
        except _NoMemory:
            found = {"status": "undecided", "error": [_too_much(limits)], "budget": told, "attempts": attempt}
        except _Died as death:
            found = {
                "status": "failed",
                "error": [f"its process ended with {death}"],
                "budget": told,
                "attempts": attempt,
            }
    return found


def _too_much(limits: Budget) -> str:
    return (
        "the memory there is was not enough"
        if limits.megabytes is None
        else f"{limits.megabytes:g} MB of memory were not enough"
    )


class _Died(RuntimeError):
    """A child has ended in the middle of a job."""


class _NoMemory(RuntimeError):
    """A child has ended for want of memory."""


class Child:
    """A process that does one job after the other."""

    def __init__(self, kind: str, megabytes: float | None) -> None:
        """Start it, ready for jobs of a kind within this memory."""
        self.megabytes = megabytes
        self.words = TemporaryFile()  # noqa: SIM115 - it lives as long as the process
        place = str(Path(__file__).parents[2])  # the child is this symobs, whatever lies in the folder it starts in
        paths = os.pathsep.join(filter(None, (place, os.environ.get("PYTHONPATH"))))
        command = [sys.executable, "-P", "-m", "symobs.batching.child", str(os.getpid()), f"{megabytes or 0:g}", kind]
        self.process = subprocess.Popen(  # noqa: S603 - our own
            command,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.words,
            env={**os.environ, "PYTHONPATH": paths},
        )
        self.lines: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self.group: int | None = None
        self.is_ready = self.is_ended = False
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        """Hand on what the child says, at its end an empty line."""
        stream: Any = self.process.stdout
        with stream:
            for line in stream:
                self.lines.put(line)
        self.lines.put(b"")

    def row(self, kind: str, payload: str, seconds: float | None) -> dict[str, Any]:
        """Return the row of a job; raises `TimeoutError`, and what says how the child has ended."""
        last = None if seconds is None else seconds + _GRACE
        order = json.dumps({"kind": kind, "payload": payload, "seconds": last}) + "\n"
        stream: Any = self.process.stdin
        with suppress(BrokenPipeError, OSError):
            stream.write(order.encode())
            stream.flush()
        if not self.is_ready:  # the time of a job begins when the child has what every job needs
            self.is_ready = bool(self._line(time.monotonic() + _START))
        end = None if seconds is None else time.monotonic() + seconds
        while True:
            line = self._line(end)
            if not line:
                raise self._death()
            said: dict[str, Any] = json.loads(line)
            if "row" in said:
                row: dict[str, Any] = said["row"]
                return row
            self.group = said["group"]

    def _line(self, end: float | None) -> bytes:
        """Return the next line of the child; raises `TimeoutError` where there is none in time."""
        while True:
            left = _LOOK_EVERY if end is None else min(_LOOK_EVERY, end - time.monotonic())
            try:
                return self.lines.get(timeout=max(0.0, left))
            except queue.Empty:
                if end is not None and time.monotonic() >= end:
                    self.end()
                    raise TimeoutError from None

    def _death(self) -> Exception:
        """Return how the child has ended."""
        if self.is_ended:
            return Ended("the run is over")
        code = self.process.wait(timeout=_GRACE)
        self.words.seek(0, os.SEEK_END)
        self.words.seek(max(0, self.words.tell() - _LAST_WORDS))
        words = self.words.read().decode(errors="replace")
        self.close()
        if code == _NO_MEMORY or "allocate memory" in words or "MemoryError" in words:
            return _NoMemory()
        return _Died(signal.Signals(-code).name if code < 0 else f"exit code {code}")

    def end(self) -> None:
        """Kill the child, and the group of processes that it waits for."""
        self.is_ended = True
        self.process.kill()
        if self.group is not None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self.group, signal.SIGKILL)
        self.close()

    def close(self) -> None:
        """Wait for the end of a child; its output is closed by who reads it."""
        self.is_ended = True
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=_GRACE)
        stream: Any = self.process.stdin
        with suppress(OSError):
            stream.close()
        self.words.close()
        with _lock:
            _children.discard(self)


_own = threading.local()
_children: set[Child] = set()
_lock = threading.Lock()


def _own_child(kind: str, limits: Budget, *, fresh: bool) -> Child:
    """Return the child of this thread, a new one where there is none that will do."""
    child: Child | None = getattr(_own, "child", None)
    if child is not None and (fresh or child.megabytes != limits.megabytes):
        child.end()
    if child is None or child.is_ended:
        child = _own.child = Child(kind, limits.megabytes)
        with _lock:
            _children.add(child)
    return child


def children() -> frozenset[Child]:
    """Return the children of this process that are there."""
    with _lock:
        return frozenset(_children)


def end_children(before: frozenset[Child] = frozenset()) -> None:
    """End the children of this process, but for those that were there before."""
    for child in children() - before:
        child.end()
