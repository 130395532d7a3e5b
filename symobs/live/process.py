"""Children that answer: each can be killed at any moment, and another takes its place.

A call into FLINT hears no signal and one that gets no memory aborts its process, so that all mathematics of the server is
done in children, under a limit of time and of memory.
"""

from __future__ import annotations

import json
import multiprocessing
import os
import signal
import sys
import threading
import time
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from symobs._dataclass import dataclass
from symobs.live.request import SCHEMA

if TYPE_CHECKING:
    from collections.abc import Callable
    from multiprocessing.connection import Connection
    from multiprocessing.context import BaseContext

#: A child is replaced after so many answers, or when it has grown to so many megabytes.
MOST_ANSWERS, MOST_MEGABYTES = 10_000, 500
#: A whole page may take as many times the seconds of an answer.
PAGE_FACTOR = 6
_LOOK_EVERY, _START_WITHIN, _MOST_SECONDS = 0.02, 30.0, 600
_LONG = {"page", "view", "export"}


@dataclass(frozen=True)
class Budget:
    """Seconds an answer may take, megabytes a child may use."""

    seconds: float = 5.0
    megabytes: int = 1000


class Gone(Exception):
    """Whoever asked has left."""


class Child:
    """One process that answers."""

    def __init__(self, context: BaseContext, megabytes: int, target: Callable[[Connection, int], None]) -> None:
        """Start it."""
        self.connection, other = context.Pipe()
        process: Any = context.Process  # type: ignore[attr-defined]
        self.process = process(target=target, args=(other, megabytes), daemon=True)
        self.process.start()
        other.close()
        self.answers = 0

    def ask(self, body: bytes, seconds: float, left: Callable[[], bool]) -> bytes:
        """Return the response; raises `TimeoutError`, `EOFError` where the child died, `Gone` where the asker left."""
        self.connection.send_bytes(body)
        end = time.monotonic() + seconds + (_START_WITHIN if self.answers == 0 else 0.0)
        while not self.connection.poll(_LOOK_EVERY):
            if time.monotonic() > end:
                raise TimeoutError
            if left():
                raise Gone
        self.answers += 1
        return self.connection.recv_bytes()

    def kill(self) -> None:
        """End it now."""
        with suppress(OSError):
            self.process.kill()
        self.process.join(1)
        self.connection.close()


class Children:
    """At most two children; a third question waits until one is free."""

    def __init__(self, budget: Budget, target: Callable[[Connection, int], None] | None = None) -> None:
        """Prepare; the first child is started with the first question, or by `warm`; `target` is what it does."""
        method = "forkserver" if "forkserver" in multiprocessing.get_all_start_methods() else "spawn"
        self.context: Any = multiprocessing.get_context(method)
        if method == "forkserver":
            self.context.set_forkserver_preload(["symobs.live.warm"])
            _start_forkserver()
        self.budget, self.target = budget, target or work
        self.idle: list[Child] = []
        self.busy: set[Child] = set()
        self.free = threading.BoundedSemaphore(2)
        self.lock = threading.Lock()

    def warm(self) -> None:
        """Start a child before it is needed."""
        with self.free:
            child = Child(self.context, self.budget.megabytes, self.target)
            try:
                child.ask(b'{"schema": "symobs-live/1", "want": "start"}', self.budget.seconds, lambda: False)
            except (TimeoutError, OSError, EOFError):
                child.kill()
                return
            with self.lock:
                self.idle.append(child)

    def answer(self, body: bytes, left: Callable[[], bool] = lambda: False) -> bytes:
        """Return the response to a request; raises `Gone`."""
        seconds = self.budget.seconds * (PAGE_FACTOR if _wanted(body) in _LONG else 1)
        with self.free:
            with self.lock:
                child = self.idle.pop() if self.idle else None
                child = child or Child(self.context, self.budget.megabytes, self.target)
                self.busy.add(child)
            try:
                found = child.ask(body, min(seconds, _MOST_SECONDS), left)
            except TimeoutError:
                child.kill()
                return _undecided(body, f"not decided within {seconds:g} s")
            except (EOFError, OSError):
                child.kill()
                return _undecided(body, f"{self.budget.megabytes} MB of memory were not enough")
            except BaseException:
                child.kill()
                raise
            finally:
                with self.lock:
                    self.busy.discard(child)
            if child.answers >= MOST_ANSWERS or found[:1] == b"!":
                child.kill()
            else:
                with self.lock:
                    self.idle.append(child)
            return found.removeprefix(b"!")

    def close(self) -> None:
        """End all, also those at work."""
        with self.lock:
            for child in self.busy:
                child.process.kill()
            for child in self.idle:
                child.kill()
            self.idle.clear()


def _start_forkserver() -> None:
    """Start the process that children are forked from, deaf to the Ctrl-C that ends this one."""
    from multiprocessing import forkserver  # noqa: PLC0415 - not on every system

    is_main = threading.current_thread() is threading.main_thread()
    usual = signal.signal(signal.SIGINT, signal.SIG_IGN) if is_main else None
    try:
        forkserver.ensure_running()
    finally:
        if is_main:
            signal.signal(signal.SIGINT, usual)


def _wanted(body: bytes) -> object:
    with suppress(ValueError, RecursionError):
        asked = json.loads(body)
        return asked.get("want", "answer") if isinstance(asked, dict) else None
    return None


def _undecided(body: bytes, message: str) -> bytes:
    with suppress(ValueError, RecursionError):
        asked = json.loads(body)
        identity = asked.get("id") if isinstance(asked, dict) else None
        found = {"schema": SCHEMA, "id": identity, "status": "undecided", "message": message}
        return json.dumps(found).encode()
    return json.dumps({"schema": SCHEMA, "id": None, "status": "undecided", "message": message}).encode()


# -- the child --------------------------------------------------------------------------------------------------------


def work(connection: Connection, megabytes: int) -> None:
    """Answer until nobody asks; a response after which the process is to be replaced begins with `!`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the server hears it, and ends this process
    limit(megabytes)
    from symobs.live.answering import answer  # noqa: PLC0415 - after the limit is set
    from symobs.live.request import parsed  # noqa: PLC0415
    from symobs.live.warm import prepare  # noqa: PLC0415

    prepare()
    while True:
        try:
            body = connection.recv_bytes()
        except (EOFError, OSError):
            return
        connection.send_bytes(_large() + respond(body, answer, parsed))


def respond(body: bytes, answer: Callable[[object], dict[str, Any]], parsed: Callable[[bytes], Any]) -> bytes:
    """Return the response to the bytes of a request."""
    from symobs.errors import SymobsError  # noqa: PLC0415
    from symobs.live.answering import errors_of  # noqa: PLC0415

    begin = time.perf_counter()
    try:
        found = answer(parsed(body))
    except SymobsError as error:
        found = {"schema": SCHEMA, "id": None, "status": "bad", "errors": errors_of(error)}
    found["ms"] = round(1000 * (time.perf_counter() - begin), 1)
    whole = json.dumps(found, ensure_ascii=False, separators=(",", ":")).encode("utf-8", "backslashreplace")
    if len(whole) > 2**20:
        found = {key: found.get(key) for key in ("schema", "id")}
        whole = json.dumps(found | {"status": "undecided", "message": "the answer is longer than 1 MB"}).encode()
    return whole


def limit(megabytes: int) -> None:
    """Bound the memory of this process, where the system can."""
    try:
        import resource  # noqa: PLC0415 - not on every system
    except ImportError:
        return
    kind = resource.RLIMIT_DATA if sys.platform == "linux" else resource.RLIMIT_AS
    with suppress(ValueError, OSError):
        resource.setrlimit(kind, (megabytes << 20, resource.getrlimit(kind)[1]))
        resource.setrlimit(resource.RLIMIT_CORE, (0, resource.getrlimit(resource.RLIMIT_CORE)[1]))


def _large() -> bytes:
    """Return the mark of a process that has grown too large."""
    try:
        with open("/proc/self/statm", encoding="ascii") as stream:  # noqa: PTH123 - no file of anybody
            pages = int(stream.read().split()[1])
    except (OSError, ValueError, IndexError):
        return b""
    return b"!" if pages * os.sysconf("SC_PAGE_SIZE") > MOST_MEGABYTES << 20 else b""
