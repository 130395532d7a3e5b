"""The side of who asks: a child that is started, asked, ended, and replaced where it is kept."""

from __future__ import annotations

import os
import pickle
import queue
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO, TYPE_CHECKING, Any, Protocol

from symobs.ground.child_processes.inside import HEAD, NO_MEMORY

if TYPE_CHECKING:
    from collections.abc import Callable, Hashable, Iterator

#: Seconds that a child is given beyond the time of its question before it ends itself, and to end.
GRACE = 5.0
#: Seconds in which a child must have imported what it needs, on the busiest machine.
_START = 300.0
_LOOK_EVERY = 1.0
_LAST_WORDS = 2000


class Died(RuntimeError):
    """A child has ended without an answer: its exit code, and whether it had not enough memory."""

    def __init__(self, code: int, *, for_memory: bool = False) -> None:
        super().__init__(signal.Signals(-code).name if code < 0 else f"exit code {code}")
        self.code, self.for_memory = code, for_memory


class Ended(RuntimeError):
    """The children were ended by who keeps them, and get no successors."""


class Process(Protocol):
    """A process that was started, as `subprocess` has it."""

    pid: int

    def kill(self) -> None:
        """End it now."""

    def wait(self, timeout: float | None = None) -> int:
        """Wait for its end, and return its code."""


class Child:
    """A process that answers one question after the other, and can be ended at any moment."""

    def __init__(self, process: Process, said: IO[bytes], asked: IO[bytes] | None = None) -> None:
        """Take a process, the stream of its records, and the one it reads questions from, if it does."""
        self.process, self.asked = process, asked
        #: What it writes to standard error, where that is kept.
        self.words: IO[bytes] | None = None
        self.group: int | None = None
        self.is_ready, self.is_ended = asked is None, False
        self._records: queue.SimpleQueue[bytes] = queue.SimpleQueue()
        self._listener = threading.Thread(target=self._listen, args=(said,), daemon=True)
        self._listener.start()

    def _listen(self, said: IO[bytes]) -> None:
        """Hand on the records of the child, at its end an empty one."""
        with said:
            while len(head := said.read(HEAD)) == HEAD:
                record = said.read(int.from_bytes(head))
                if len(record) == int.from_bytes(head):
                    self._records.put(record)
        self._records.put(b"")

    def ask(
        self,
        question: object = None,
        seconds: float | None = None,
        *,
        hear: Callable[[Any], object] = lambda _: None,
        look: Callable[[], object] = lambda: None,
        every: float = _LOOK_EVERY,
    ) -> Any:
        """Return the answer to a question; `hear` is called with what the child reports on the way, `look` as time passes.

        Raises `TimeoutError` where there is no answer in time, and `Died`; the child has ended then.
        """
        if self.asked is not None:
            last = None if seconds is None else seconds + GRACE
            with suppress(OSError):
                self.asked.write(pickle.dumps((question, last)))
                self.asked.flush()
        end = None if seconds is None else time.monotonic() + seconds
        while True:
            # The time of a question begins when the child has what every question needs.
            kind, content = self._record(end if self.is_ready else time.monotonic() + _START, look, every)
            if kind == "ready":
                self.is_ready, end = True, None if seconds is None else time.monotonic() + seconds
            elif kind == "group":
                self.group = content
            elif kind == "reached":
                hear(content)
            else:
                if kind == "last":
                    self.end()
                return content

    def _record(self, end: float | None, look: Callable[[], object], every: float) -> tuple[str, Any]:
        """Return the next record of the child; raises `TimeoutError` where there is none in time, and `Died`."""
        while True:
            left = every if end is None else min(every, end - time.monotonic())
            try:
                record = self._records.get(timeout=max(0.0, left))
            except queue.Empty:
                if end is not None and time.monotonic() >= end:
                    self.end()
                    raise TimeoutError from None
                look()
                continue
            if not record:
                raise self._death()
            kind, content = pickle.loads(record)  # noqa: S301 - our own child's
            return kind, content

    def _death(self) -> Exception:
        """Return how the child has ended."""
        if self.is_ended:
            return Ended("the children were ended")
        code, words = self.process.wait(timeout=GRACE), b""
        if self.words is not None:
            self.words.seek(max(0, self.words.seek(0, os.SEEK_END) - _LAST_WORDS))
            words = self.words.read()
        self.end()
        return Died(code, for_memory=code == NO_MEMORY or b"allocate memory" in words or b"MemoryError" in words)

    def leave(self, seconds: float) -> None:
        """Let the child leave in order, and end it if it does not."""
        if not self.is_ended:
            with suppress(ProcessLookupError):
                os.kill(self.process.pid, signal.SIGINT)
            self._listener.join(seconds)
        self.end()

    def end(self) -> None:
        """End the child, and the group of processes that it waits for."""
        if self.is_ended:
            return
        self.is_ended = True
        self.process.kill()
        self._listener.join(GRACE)
        while not self._records.empty():
            record = self._records.get(timeout=0)
            kind, content = pickle.loads(record) if record else ("", None)  # noqa: S301 - our own child's
            if kind == "group":
                self.group = content
        self._records.put(b"")  # for who waits for an answer
        if self.group is not None:
            with suppress(ProcessLookupError, PermissionError):
                os.killpg(self.group, signal.SIGKILL)
        with suppress(subprocess.TimeoutExpired):
            self.process.wait(timeout=GRACE)
        for stream in (self.asked, self.words):
            if stream is not None:
                with suppress(OSError):
                    stream.close()


def started(module: str, *words: str, megabytes: float | None = None) -> Child:
    """Start the module of a child, which ends in `serve`, in a process of its own.

    It is started afresh, never forked: a thread of another worker may hold any lock.
    """
    return _starter(os.getpid()).submit(_start, module, megabytes, words).result(timeout=_START)


@cache
def _starter(_process: int) -> ThreadPoolExecutor:
    """Return the thread that starts all children of a process: where it ends, with the process, they end."""
    return ThreadPoolExecutor(1, thread_name_prefix="symobs-starter")


def _start(module: str, megabytes: float | None, words: tuple[str, ...]) -> Child:
    place = str(Path(__file__).parents[3])  # the child is this symobs, whatever lies in the folder it starts in
    paths = os.pathsep.join(filter(None, (place, os.environ.get("PYTHONPATH"))))
    last_words = TemporaryFile()  # noqa: SIM115 - it lives as long as the process
    process = subprocess.Popen(  # noqa: S603 - our own
        [sys.executable, "-P", "-m", module, str(os.getpid()), f"{megabytes or 0:g}", *words],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=last_words,
        env={**os.environ, "PYTHONPATH": paths},
        process_group=0 if os.name == "posix" else None,  # a terminal's Ctrl-C is for who started it
    )
    child = Child(process, process.stdout, process.stdin)  # type: ignore[arg-type]
    child.words = last_words
    return child


class Kept:
    """Children of one module, kept from question to question; one that has ended is replaced."""

    def __init__(self, module: str) -> None:
        """Take the module that `started` starts."""
        self.module = module
        self._lock = threading.RLock()
        self._idle: dict[Hashable, list[Child]] = {}
        self._all: set[Child] = set()
        self._is_closed = False

    @contextmanager
    def one(self, *words: str, megabytes: float | None = None, fresh: bool = False) -> Iterator[Child]:
        """Give a child that nobody else asks, a new one where there is none; one that is left by an error is ended.

        Raises `Ended` when the children were ended.
        """
        with self._lock:
            idle = self._idle.setdefault((words, megabytes), [])
            child = idle.pop() if idle and not fresh else None
        child = child or self._added(words, megabytes)
        try:
            yield child
        except BaseException:
            child.end()
            raise
        finally:
            with self._lock:
                if child.is_ended:
                    self._all.discard(child)
                else:
                    idle.append(child)

    def add(self, count: int, *words: str, megabytes: float | None = None) -> None:
        """Start children before they are needed, until there are so many."""
        with self._lock, suppress(Ended):
            while len(self._all) < count:
                child = self._added(words, megabytes)
                self._idle.setdefault((words, megabytes), []).insert(0, child)  # asked last: it is getting ready

    def _added(self, words: tuple[str, ...], megabytes: float | None) -> Child:
        with self._lock:
            if self._is_closed:
                raise Ended("the children were ended")
            child = started(self.module, *words, megabytes=megabytes)
            self._all.add(child)
            return child

    def close(self) -> None:
        """End all, also those at work."""
        with self._lock:
            self._is_closed, children = True, list(self._all)
        for child in children:
            child.end()
