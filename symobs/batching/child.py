"""The process that does the work: a line of JSON in, a line of JSON out, until its input ends.

It is a process of its own, started afresh: a call into FLINT hears no signal and aborts where memory ends, so that only
another process can end it, or survive it.
"""

from __future__ import annotations

import errno
import gc
import json
import os
import signal
import sys
from typing import IO, Any, NoReturn

from symobs.batching.jobs import digest, read_payload
from symobs.batching.kinds import prepare, run
from symobs.child_processes import bound_memory, listeners
from symobs.errors import ProblemErrors, SymobsError

_NO_MEMORY = 76
#: Imports and derivations make many objects that stay.
_COLLECTED_AFTER = 50_000


def main(parent: str, megabytes: str, kind: str) -> NoReturn:
    """Work on what comes from this parent, first of this kind, within this memory; 0 is unlimited."""
    said = os.fdopen(os.dup(1), "wb", buffering=0)
    os.dup2(2, 1)  # what libraries print must not come between the lines
    _die_with(int(parent))
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # a terminal tells the whole group; the parent sees to its end
    gc.set_threshold(_COLLECTED_AFTER)
    listeners.append(lambda group: _say(said, {"group": group}))
    if float(megabytes):
        bound_memory(int(float(megabytes) * 2**20))
    prepare(kind)
    _say(said, {"ready": kind})
    for line in sys.stdin.buffer:
        job = json.loads(line)
        _limit(job["seconds"])
        row, out_of_memory = worked(job["kind"], job["payload"])
        _limit(None)
        if out_of_memory:
            os._exit(_NO_MEMORY)  # what the libraries left behind is no ground to build on
        _say(said, {"row": row})
    os._exit(0)


def _say(stream: IO[bytes], message: dict[str, Any]) -> None:
    data = memoryview(json.dumps(message, ensure_ascii=False).encode("utf-8", "surrogatepass") + b"\n")
    while data:
        data = data[stream.write(data) or 0 :]


def worked(kind: str, payload: str) -> tuple[dict[str, Any], bool]:
    """Return the row of a job, and whether there was not enough memory for it."""
    try:
        row = run(kind, read_payload(payload))
        if "result" in row:
            row["sha256"] = digest(row["result"])
    except MemoryError:
        return {}, True
    except SymobsError as error:
        errors = error.errors if isinstance(error, ProblemErrors) else (error,)
        if any(each.exit_code != SymobsError.exit_code for each in errors):
            row = {"status": "failed", "error": str(error).split("\n")}
        else:
            row = {"status": "unreadable", "error": str(error).split("\n")}
    except Exception as error:  # noqa: BLE001 - whatever it is, the other jobs go on
        if type(error) in {SystemError, ImportError} or getattr(error, "errno", None) == errno.ENOMEM:
            return {}, True
        row = {"status": "failed", "error": [f"internal error: {type(error).__name__}: {str(error)[:200]}"]}
    return row, False


def _limit(seconds: float | None) -> None:
    """End this process when the time of a job is over for good, should nobody be there to do it."""
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


if __name__ == "__main__":
    main(*sys.argv[1:])
