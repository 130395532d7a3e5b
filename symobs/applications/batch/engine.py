"""The engine: hands jobs to an executor in chunks of seconds, and gives back what comes, whatever dies on the way."""

from __future__ import annotations

import json
import time
from collections import deque
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, CancelledError, Future, wait
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.batch.executors import Unfinished, Workforce
from symobs.applications.batch.jobs import USUAL_BUDGET, Job, digest, read_payload
from symobs.applications.batch.kinds import recheck
from symobs.ground.errors import CertificateRejected

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator

    from symobs.ground.child_processes.budget import Budget

#: Chunks in flight for each worker: enough that none waits, few enough that memory does not grow with the jobs.
IN_FLIGHT = 4
LARGEST_CHUNK = 10_000
_LOOK_EVERY = 1.0
#: The first rows of a run are all checked again by other code: of a run that has few, every one.
ALL_RECHECKED_BELOW = 200

Row = dict[str, Any]


class Settings(NamedTuple):
    """How a run goes about its jobs."""

    budget: Budget = USUAL_BUDGET
    chunk_seconds: float = 2.0
    #: The share of rows that are checked again, from 0 to 1.
    recheck: float = 0.01
    deadline: float | None = None


class Chunk(NamedTuple):
    """The rows of a chunk, in the order of its jobs, and how long it took."""

    rows: list[Row]
    seconds: float


def work(jobs: Iterable[Job], force: Workforce, settings: Settings) -> Iterator[Chunk]:
    """Yield the rows of all jobs, chunk by chunk in the order in which they come.

    Raises `Unfinished` when time is over or nobody is left to work, and `CertificateRejected` for a row that does not
    hold.  Every row that was yielded stands.
    """
    queue, ahead, again = iter(jobs), deque[Job](), deque[tuple[Job, ...]]()
    waiting: dict[Future[tuple[list[str], float]], tuple[Job, ...]] = {}
    size, end = 1.0, None if settings.deadline is None else time.monotonic() + settings.deadline
    examine = _examiner(settings.recheck)
    is_there = True
    try:
        while True:
            was_there, is_there = is_there, force.is_there()
            if is_there and not was_there:  # who is back may never answer what was under way when it went
                again.extend(_taken_back(waiting))
            if end is not None and time.monotonic() > end:
                break
            while is_there and len(waiting) < IN_FLIGHT * force.workers:
                chunk = again.popleft() if again else _next_chunk(queue, ahead, int(size), force.workers)
                if not chunk:
                    break
                waiting[force.submit([(job.key, job.kind, job.payload) for job in chunk], settings.budget)] = chunk
            if not waiting and is_there:
                return
            done, _ = wait(waiting, timeout=_LOOK_EVERY, return_when=FIRST_COMPLETED)
            if not waiting:
                time.sleep(_LOOK_EVERY)
            for future in [each for each in waiting if each in done]:
                chunk = waiting.pop(future)
                answer = _answer(future)
                if answer is None:
                    again.append(chunk)
                elif answer == _WORKER_DIED:
                    again.extend(half for half in _halves(chunk) if len(chunk) > 1)
                    if len(chunk) == 1:
                        yield Chunk([_lost(chunk[0])], 0.0)
                else:
                    texts, seconds = answer
                    rows = [_row(text, job) for text, job in zip(texts, chunk, strict=True)]
                    for row, job in zip(rows, chunk, strict=True):
                        examine(row, job)
                    size = _next_size(size, len(chunk), seconds, settings.chunk_seconds)
                    yield Chunk(rows, seconds)
    finally:
        for future in waiting:
            future.cancel()
    if waiting or again or ahead or next(queue, None) is not None:
        raise Unfinished(f"{settings.deadline:g} seconds are over", where="--deadline")


def _next_chunk(queue: Iterator[Job], ahead: deque[Job], size: int, workers: int) -> tuple[Job, ...]:
    """Return so many jobs, or fewer near the end: what is left is shared out so that all workers end together."""
    shares = 2 * workers
    ahead.extend(islice(queue, max(0, shares * size - len(ahead))))
    count = max(1, min(size, len(ahead) // shares))
    return tuple(ahead.popleft() for _ in range(min(count, len(ahead))))


def _taken_back(waiting: dict[Future[tuple[list[str], float]], tuple[Job, ...]]) -> list[tuple[Job, ...]]:
    """Cancel what has no answer yet, and return its chunks: a job is pure, so that doing it again is harmless."""
    unanswered = [future for future in waiting if not future.done()]
    chunks = [waiting.pop(future) for future in unanswered]
    for future in unanswered:
        future.cancel()
    return chunks


_WORKER_DIED = ([""], -1.0)


def _answer(future: Future[tuple[list[str], float]]) -> tuple[list[str], float] | None:
    """Return what a chunk has come to: its rows, that its workers died, or None where it was cancelled elsewhere."""
    try:
        return future.result(timeout=0)
    except CancelledError:  # the scheduler is gone, which is seen in a moment
        return None
    except BrokenExecutor as error:
        raise Unfinished(f"the executor is broken: {error}") from None
    except Exception as error:
        if type(error).__name__ != "KilledWorker":
            raise
        return _WORKER_DIED


def _next_size(size: float, jobs: int, seconds: float, wanted: float) -> float:
    """Return the size of the next chunks: what the last one's pace gives, growing at most twofold."""
    paced = jobs * wanted / max(seconds, 1e-6)
    return min(max(1.0, paced), 2 * max(size, 1.0), LARGEST_CHUNK)


def _halves(chunk: tuple[Job, ...]) -> tuple[tuple[Job, ...], tuple[Job, ...]]:
    middle = len(chunk) // 2
    return chunk[:middle], chunk[middle:]


def _lost(job: Job) -> Row:
    row = {"key": job.key, "status": "failed", "kind": job.kind, "name": job.name}
    return {**row, "error": ["its worker died again and again"], "job": job.payload}


def _row(text: str, job: Job) -> Row:
    """Return a row that came, with the name of its job; raises `CertificateRejected` if it was changed on its way."""
    came: Row = json.loads(text)
    row = {
        "key": came.pop("key"),
        "status": came.pop("status"),
        "kind": came.pop("kind"),
        "name": job.name,
        **came,
        "job": job.payload,
    }
    if row["key"] != job.key or ("result" in row and row.get("sha256") != digest(row["result"])):
        raise rejected(job.name, "the row is not the one that was sent")
    return row


def rejected(name: str, reason: str) -> CertificateRejected:
    """Return the error for a row that does not hold."""
    message = f"this result does not hold: {reason}"
    return CertificateRejected(message, where=name, repair="please report this: a worker, or symobs, is wrong")


def _examiner(share: float) -> Callable[[Row, Job], None]:
    """Return what checks rows again: all of the first ones, then those whose keys say so."""
    seen = 0
    highest = int(share * 2**64)

    def examine(row: Row, job: Job) -> None:
        nonlocal seen
        chosen = int(job.key[:16], 16) < highest or (share > 0 and seen < ALL_RECHECKED_BELOW)
        seen += 1
        if chosen:
            examined(row, job)

    return examine


def examined(row: Row, job: Job) -> None:
    """Raise `CertificateRejected` if a row does not hold, by other code than that which made it."""
    reason = recheck(job.kind, read_payload(job.payload), row)
    if reason is not None:
        raise rejected(job.name, reason)
