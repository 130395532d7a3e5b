"""The engine: hands jobs to an executor in chunks of seconds, and gives back what comes, whatever dies on the way."""

from __future__ import annotations

import json
import logging
import os
import sys
import time
from collections import deque
from concurrent.futures import (
    FIRST_COMPLETED,
    BrokenExecutor,
    CancelledError,
    Executor,
    Future,
    ThreadPoolExecutor,
    wait,
)
from contextlib import contextmanager, suppress
from functools import partial
from itertools import islice
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.batch.jobs import USUAL_BUDGET, Job, digest, fingerprint, read_payload, recheck, row_text
from symobs.ground.child_processes.budget import Budget
from symobs.ground.child_processes.child import Died, Kept
from symobs.ground.errors import CertificateRejected, InputError, SymobsError, UsageError, reason_of

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Sequence

    Order = tuple[str, str, str]


# Where jobs are done: threads of this machine with a child process each, a dask cluster, or any executor.


CHILD = "symobs.applications.batch.child"
#: How often a job may end its process.
_ATTEMPTS = 2
#: The children of a worker whose run is elsewhere; they end with its process.
_own = Kept(CHILD)
#: Seconds that a connection takes at most, and after which one that was lost is given up.
_CONNECT = 10.0
_LOST_AFTER = 10.0
_ASK = 5.0
_CLOSE = 1.0


def run_chunk(
    orders: Sequence[Order], budget: tuple[float | None, float | None], expected: str, children: Kept = _own
) -> tuple[list[str], float]:
    """Return the rows of some jobs as JSON, made by a child of this process, and the seconds this took.

    Raises `InputError` where this worker has other versions than expected.
    """
    began = time.monotonic()
    if identity() != expected:
        message = f"a worker has {identity()}, this process {expected}"
        raise InputError(message, where="--scheduler", repair="install the same versions everywhere")
    return [_row(order, Budget(*budget), children) for order in orders], time.monotonic() - began


def run_in_process(orders: Sequence[Order], _: object, __: str) -> tuple[list[str], float]:
    """Return the same rows without a child, and so without limits."""
    from symobs.applications.batch.child import worked  # noqa: PLC0415 - it imports the kernel

    began = time.monotonic()
    return [worked(order) for order in orders], time.monotonic() - began


def identity() -> str:
    """Return the versions that must be the same wherever jobs of one run are done."""
    return f"{fingerprint()}, Python {sys.version_info.major}.{sys.version_info.minor}"


def _row(order: Order, limits: Budget, children: Kept) -> str:
    """Return the row of one job; what ends its process is tried once more, in a fresh one."""
    key, kind, _ = order
    row: dict[str, Any] = {}
    for attempt in range(1, _ATTEMPTS + 1):
        try:
            with children.one(kind, megabytes=limits.megabytes, fresh=attempt > 1) as child:
                found: str = child.ask(order, limits.seconds)
                return found
        except TimeoutError:
            row = {"status": "undecided", "error": [f"{limits.seconds:g} seconds were not enough"]}
            break
        except Died as death:
            if death.for_memory:
                row = {"status": "undecided", "error": [_too_much(limits)], "attempts": attempt}
            else:
                row = {"status": "failed", "error": [f"its process ended with {death}"], "attempts": attempt}
    told = {"seconds": limits.seconds, "megabytes": limits.megabytes}
    status, error = row.pop("status"), row.pop("error")
    return row_text(key, kind, {"status": status, "error": error, "budget": told, **row})


def _too_much(limits: Budget) -> str:
    return (
        "the memory there is was not enough"
        if limits.megabytes is None
        else f"{limits.megabytes:g} MB of memory were not enough"
    )


# -- executors ---------------------------------------------------------------------------------------------------------


class Unfinished(SymobsError):
    """The run has ended before all jobs were done; what is done is kept."""

    exit_code = 5


class Workforce(NamedTuple):
    """An executor, how many chunks it works on at a time, what it is given, and whether it is still there."""

    executor: Executor
    workers: int
    work: Callable[..., tuple[list[str], float]] = run_chunk
    #: Whether it can be reached now; raises `Unfinished` when there is nobody left to wait for.
    is_there: Callable[[], bool] = lambda: True

    def submit(self, orders: Any, budget: Any) -> Future[tuple[list[str], float]]:
        """Hand over a chunk."""
        return self.executor.submit(self.work, orders, tuple(budget), identity())


class InProcess(Executor):
    """An executor that does its work at once, in this process: for tests and debuggers."""

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Return what is already done."""
        future: Future[Any] = Future()
        try:
            future.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - it is the future's
            future.set_exception(error)
        return future


@contextmanager
def workforce(
    workers: int | None = None,
    scheduler: str | None = None,
    executor: Executor | None = None,
    *,
    in_process: bool = False,
    worker_timeout: float = 60.0,
) -> Iterator[Workforce]:
    """Give who does the work: threads, the workers of a dask scheduler, or the executor of a caller."""
    if executor is not None:
        yield Workforce(executor, workers or getattr(executor, "_max_workers", None) or 1)
        return
    if in_process:
        yield Workforce(InProcess(), 1, run_in_process)
        return
    if scheduler is not None:
        with _cluster(scheduler, worker_timeout) as found:
            yield found
        return
    count, children = workers or os.cpu_count() or 1, Kept(CHILD)
    pool = ThreadPoolExecutor(count, thread_name_prefix="symobs")
    try:
        yield Workforce(pool, count, partial(run_chunk, children=children))
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        children.close()


# -- dask -------------------------------------------------------------------------------------------------------------


@contextmanager
def _cluster(address: str, worker_timeout: float) -> Iterator[Workforce]:
    """Give the workers of a dask scheduler."""
    try:
        import distributed
    except ImportError:
        repair = "install it with pip install 'symobs[distributed]', or use --workers"
        raise UsageError("dask.distributed is not installed", where="--scheduler", repair=repair) from None
    # What they have to say is said by who waits for them; with the scheduler goes whatever was being fetched.
    for name in ("distributed", "distributed.client", "tornado.application"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        client = distributed.Client(address, timeout=_CONNECT, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        repair = "start one with `dask scheduler`, and give the address that it prints: tcp://HOST:8786"
        message = f"no scheduler answers at {address}: {reason_of(error)[:200]}"
        raise InputError(message, where="--scheduler", repair=repair) from None
    try:
        count = _threads_there(client, worker_timeout)
        _require_same_versions(client)
        pool = client.get_executor(pure=False, retries=0)
        yield Workforce(pool, count, run_chunk, _Watch(client, worker_timeout))
    finally:
        with suppress(Exception):
            client.close(timeout=_CLOSE)


class _Watch:
    """What ends a wait for a cluster that is gone."""

    def __init__(self, client: Any, worker_timeout: float) -> None:
        self.client, self.worker_timeout = client, worker_timeout
        self.seen = self.staffed = self.asked = time.monotonic()

    def __call__(self) -> bool:
        """Return whether the scheduler is there; raises `Unfinished` if it, or every worker, is away for too long."""
        now = time.monotonic()
        if self.client.status == "running":
            self.seen = now
        elif now - self.seen > _LOST_AFTER:
            raise Unfinished("the scheduler is gone", where="--scheduler")
        else:
            return False
        if now - self.asked < _ASK:
            return True
        self.asked = now
        with suppress(Exception):  # a scheduler that does not answer is seen above
            if self.client.sync(self.client.scheduler.ncores, callback_timeout=_ASK):
                self.staffed = time.monotonic()
        if now - self.staffed > self.worker_timeout:
            raise Unfinished(f"there has been no worker for {self.worker_timeout:g} seconds", where="--scheduler")
        return True


def _threads_there(client: Any, worker_timeout: float) -> int:
    """Return how many threads the workers have together; raises `Unfinished` where none comes."""
    end = time.monotonic() + worker_timeout
    while True:
        with suppress(OSError, TimeoutError):
            if found := client.sync(client.scheduler.ncores, callback_timeout=_ASK):
                return sum(found.values())
        if time.monotonic() > end:
            repair = "start some with `dask worker ADDRESS --nthreads 1`"
            raise Unfinished("the scheduler has no workers", where="--scheduler", repair=repair)
        time.sleep(0.1)


def _require_same_versions(client: Any) -> None:
    """Raise `InputError` that lists the workers whose versions are not those here."""
    try:
        found = client.run(identity, on_error="return")
    except Exception as error:  # noqa: BLE001 - whatever a strange worker answers
        found = {"a worker": error}
    others = {worker: said for worker, said in found.items() if said != identity()}
    if others:
        listed = "; ".join(f"{worker}: {said}" for worker, said in sorted(others.items()))
        message = f"here is {identity()}, elsewhere other versions: {listed[:1000]}"
        raise InputError(message, where="--scheduler", repair="install the same versions on every worker")


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
                    rows = [_checked_row(text, job) for text, job in zip(texts, chunk, strict=True)]
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
    return min(max(1.0, jobs * wanted / max(seconds, 1e-6)), 2 * max(size, 1.0), LARGEST_CHUNK)


def _halves(chunk: tuple[Job, ...]) -> tuple[tuple[Job, ...], tuple[Job, ...]]:
    middle = len(chunk) // 2
    return chunk[:middle], chunk[middle:]


def _lost(job: Job) -> Row:
    row = {"key": job.key, "status": "failed", "kind": job.kind, "name": job.name}
    return {**row, "error": ["its worker died again and again"], "job": job.payload}


def _checked_row(text: str, job: Job) -> Row:
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
