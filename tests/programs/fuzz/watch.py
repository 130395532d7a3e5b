"""What an input may not do: run code, open files, start programs, load modules, or cost more than its budget.

The hook is Python's own (PEP 578): it sees every `exec`, `compile`, `open`, import and process that Python code asks for,
and it cannot be removed again, so it lives as long as the process and looks only while it is switched on.
"""

from __future__ import annotations

import os
import re
import resource
import sys
import time
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cache
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterator
    from types import FrameType

_FORBIDDEN: tuple[str, ...] = (
    "os.",
    "subprocess.",
    "socket.",
    "shutil.",
    "ctypes.",
    "pty.",
    "signal.",
    "urllib.",
    "http.",
    "ftplib.",
)
_FORBIDDEN += ("marshal.", "tempfile.", "winreg.", "syslog.", "glob.", "webbrowser.", "sqlite3.", "mmap.", "fcntl.")
_CODE = ("exec", "compile", "code.__new__", "cpython.run_string", "cpython.run_command", "function.__new__")
#: Questions about folders and times, which change nothing.
_HARMLESS = {"os.listdir", "os.scandir", "os.fwalk", "os.walk", "signal.setitimer"}
_WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND
#: What may be imported late: our own modules, what they are built on, and the standard library.
_KNOWN = {"symobs", "sympy", "mpmath", "flint", "jinja2", "markupsafe", "click", "numpy", "encodings", "z3"}
_KNOWN |= {"gmpy2", "gmpy", "org"}  # mpmath and SymPy ask for the first two, `copy` for the last, which Jython has
_KNOWN |= set(sys.stdlib_module_names)


class Trespass(BaseException):
    """Something was reached that no input may reach; not an `Exception`, so that nobody takes it for one of theirs."""


@dataclass
class Watch:
    """The hook and what it allows.

    reads   folders whose files may be opened for reading
    writes  the one folder in which files may be made
    works   whether templates may be compiled, as they are where a page is made
    """

    reads: tuple[str, ...] = ()
    writes: str = ""
    works: bool = False
    looking: bool = field(default=False, init=False)
    trespasses: list[str] = field(default_factory=list, init=False)

    def install(self) -> None:
        """Begin to be told of what happens, until the process ends."""
        sys.addaudithook(self._hook)

    @contextmanager
    def looks(self) -> Iterator[None]:
        """Look while the block runs; raises `Trespass` behind it if something was kept from whoever did it."""
        self.trespasses.clear()
        self.looking = True
        try:
            yield
        finally:
            self.looking = False
        if self.trespasses:
            raise Trespass("; ".join(self.trespasses))

    def _hook(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self.looking:
            return
        if event not in _CODE and event not in {"open", "import"} and not event.startswith(_FORBIDDEN):
            return
        self.looking = False  # what follows is ours
        fault = self._fault(event, arguments)
        self.looking = True
        if fault:
            self.trespasses.append(fault)
            raise Trespass(fault)

    def _fault(self, event: str, arguments: tuple[Any, ...]) -> str:
        """Return what is wrong about an event, or nothing."""
        if event in _HARMLESS or (self.writes and event in _FILES and self._is_ours(arguments)):
            return ""
        if event == "import":
            return "" if str(arguments[0]).partition(".")[0] in _KNOWN else f"import of {arguments[0]}"
        # Cython makes the lines of a traceback so, where an error leaves FLINT; it runs none of our text.
        if event == "compile" and arguments[0] == b"_getframe()":
            return ""
        if event == "code.__new__" and str(arguments[1]).endswith(".pyx"):
            return ""
        frames = _modules()
        if any(name.startswith("importlib") or name == "zipimport" for name in frames):
            return ""
        if event == "open":
            return self._fault_of_open(*arguments)
        if event.startswith("ctypes.") and frames[:1] == ["z3.z3"]:  # z3 is called through ctypes
            return ""
        if (
            self.works
            and event in _PROCESSES
            and any(name.startswith("symobs.ground.child_processes.") for name in frames[:3])
        ):
            return ""
        if event in _CODE and self.works and any(name.startswith("jinja2") for name in frames[:4]):
            return ""
        return f"{event} {str(arguments)[:80]}"

    def _fault_of_open(self, path: object, mode: object, flags: object) -> str:
        is_written = isinstance(flags, int) and bool(flags & _WRITING)
        if isinstance(path, int) or path is None or (self.works and path == os.devnull):
            return ""
        place = os.path.realpath(os.fsdecode(path))  # type: ignore[arg-type]
        allowed = (self.writes,) if is_written else (*self.reads, self.writes)
        if any(folder and (place == folder or place.startswith(folder.rstrip(os.sep) + os.sep)) for folder in allowed):
            return ""
        return f"open of {place[:80]!r} ({mode})"

    def _is_ours(self, arguments: tuple[Any, ...]) -> bool:
        """Whether all paths among the arguments lie in the folder for files."""
        paths = [
            os.path.realpath(os.fsdecode(each)) for each in arguments if isinstance(each, (str, bytes, os.PathLike))
        ]
        return all(path == self.writes or path.startswith(self.writes + os.sep) for path in paths)


#: What writing a file whole needs: a name of its own, rights, and its place.
_FILES = {"os.rename", "os.remove", "os.chmod", "os.mkdir", "os.truncate", "tempfile.mkstemp", "os.unlink", "os.rmdir"}
_FILES |= {"tempfile.mkdtemp", "shutil.rmtree"}


#: What `--timeout` and `--memory` need: a process of their own, and its end.
_PROCESSES = {"os.fork", "os.kill", "os.killpg", "signal.pthread_kill"}


def _modules() -> list[str]:
    """Return the modules of the frames above the hook, the innermost first."""
    names: list[str] = []
    frame: FrameType | None = sys._getframe(2)
    while frame is not None and len(names) < 60:
        names.append(str(frame.f_globals.get("__name__", "")))
        frame = frame.f_back
    return [name for name in names if not name.startswith(__name__)]


def memory() -> int:
    """Return the largest memory this process has held so far, in bytes.

    Linux says it of the process itself; `ru_maxrss` begins with what the process held that started this one.
    """
    try:
        found = _PEAK.search(os.pread(_status(os.getpid()), 4096, 0))
    except OSError:
        found = None
    if found is None:
        return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1 if sys.platform == "darwin" else 1024)
    return int(found[1]) * 1024


_PEAK = re.compile(rb"VmHWM:\s*([0-9]+) kB")


@cache
def _status(process: int) -> int:
    """Return an open file that tells of this process; a child opens its own."""
    return os.open(f"/proc/{process}/status", os.O_RDONLY)


def processor_time() -> float:
    """Return the processor time of this process: it does not count what else the machine does."""
    return time.process_time()
