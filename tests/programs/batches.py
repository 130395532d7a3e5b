"""Measure runs of many problems: `python -m tests.programs.batches [--jobs 400] [--points 40000] [--table]`.

The same designs in a plain loop, with joblib and with plain dask, none of which checks, stores or survives anything, and by
`symobs batch`, on this machine and on two workers of dask; time by the clock, and of the processor with all processes that
worked.  Then the first result of a fresh command, what a job costs beyond its work, and a store of a million finished keys
begun again (`--keys`).  With `--table` no more; else how time grows with jobs and points, and by that what a cluster would
take, which is a model and no measurement.
"""

from __future__ import annotations

import argparse
import math
import os
import resource
import shutil
import subprocess
import sys
import tempfile
import time
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.engine import Settings
from symobs.applications.batch.jobs import job, read_payload, row_text, solve_job
from symobs.applications.batch.run import Batch
from symobs.applications.batch.store import Store
from symobs.applications.batch.sweep import block
from symobs.applications.batch.sweep.plan import BLOCK, Plan
from symobs.pages.formats.json import result_object
from symobs.problem import read
from tests.support.problems.batches import children_of, design
from tests.support.tools.command_line import environment, installed_environment
from tests.unit.applications.batch.test_sweep import CART

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from symobs.applications.batch.jobs import Job

#: Seconds of the machine that stores, a row of a sweep: 9 µs to take it, 28 µs to write it into the table.
STORED = 37e-6


def solved(number: int) -> list[Any]:
    """One design with its whole JSON, unchecked by others."""
    return [result_object(result) for result in read(design(number)).solve()]


def timed(work: Callable[[], object]) -> tuple[float, float]:
    """Seconds by the clock, and of the processor with all children that have ended."""

    def used() -> float:
        return sum(
            float(getattr(resource.getrusage(who), part))
            for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
            for part in ("ru_utime", "ru_stime")
        )

    began, before = time.perf_counter(), used()
    more = work()
    return time.perf_counter() - began, used() - before + (more if isinstance(more, float) else 0.0)


def by_batch(count: int, folder: Path, **who: Any) -> None:
    """All designs into a store."""
    shutil.rmtree(folder, ignore_errors=True)
    settings = Settings()
    Batch(lambda: (solve_job(design(n), f"p{n}") for n in range(count)), folder, settings=settings, **who).finish()


def by_batch_on_dask(count: int, folder: Path) -> float:
    """All designs into a store, by two processes of dask; return the seconds of their children, which nobody waits for."""
    import distributed  # noqa: PLC0415

    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster:
        by_batch(count, folder, scheduler=cluster.scheduler_address)
        workers = [worker.process.pid for worker in cluster.workers.values()]
        return sum(used_by(child) for worker in workers for child in children_of(worker))


def used_by(process: int) -> float:
    """The processor time of a process that is still there."""
    words = Path(f"/proc/{process}/stat").read_text(encoding="ascii").rpartition(")")[2].split()
    return (int(words[11]) + int(words[12])) / os.sysconf("SC_CLK_TCK")


def first_result(folder: Path) -> float:
    """Seconds by the clock from the start of a command to its first stored row."""
    (folder / "problems").mkdir()
    for number in range(20):
        (folder / "problems" / f"p{number}.toml").write_text(design(number), encoding="utf-8")
    words = [sys.executable, "-m", "symobs", "batch", str(folder / "problems"), "--out"]
    installed = installed_environment(folder / "compiled")
    subprocess.run([*words, str(folder / "before")], env=installed, stderr=subprocess.DEVNULL, check=True)
    words.append(str(folder / "first"))
    began = time.perf_counter()
    with subprocess.Popen(words, env=installed, stderr=subprocess.DEVNULL) as process:
        while not Store(folder / "first").chunks() and process.poll() is None:
            time.sleep(0.005)
        return time.perf_counter() - began


def begun_again(folder: Path, count: int) -> None:
    """Print what it takes to go on where so many jobs are done, of which none is left."""

    def jobs() -> Iterator[Job]:
        return (job("solve", {"number": number}) for number in range(count))

    row = {"status": "done", "sha256": "0" * 64, "result": ["1" * 400]}
    for number, chunk in enumerate(batched(jobs(), 2000)):
        place = folder / "rows" / f"{number % 256:02x}" / f"{number:016x}.jsonl"
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text("".join(row_text(each.key, each.kind, {**row}) + "\n" for each in chunk), encoding="utf-8")
    for what in ("from its rows", "from its index"):
        run = Batch(jobs, folder, workers=1)
        clock, processor = timed(run.finish)
        print(f"{run.kept} finished jobs, begun again {what}: {clock:.1f} s, processor {processor:.1f} s")


def batched(jobs: Iterator[Job], count: int) -> Iterator[list[Job]]:
    """Lists of so many jobs."""
    while chunk := list(islice(jobs, count)):
        yield chunk


def by_joblib(count: int) -> None:
    """All designs by two processes of joblib."""
    import joblib  # type: ignore[import-not-found,unused-ignore]  # noqa: PLC0415

    joblib.Parallel(n_jobs=2)(joblib.delayed(solved)(n) for n in range(count))
    joblib.externals.loky.get_reusable_executor().shutdown(wait=True)  # its processes are counted when they have ended


def by_dask(count: int) -> None:
    """All designs by two processes of dask."""
    import distributed  # noqa: PLC0415

    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster,
        distributed.Client(cluster) as client,
    ):
        client.gather(client.map(solved, range(count)))


def exponent(measured: list[tuple[float, float]]) -> float:
    """The p of time ~ sizeᵖ that fits best."""
    logs = [(math.log(size), math.log(seconds)) for size, seconds in measured]
    mean = [sum(values) / len(logs) for values in zip(*logs, strict=True)]
    slope: float = sum((x - mean[0]) * (y - mean[1]) for x, y in logs) / sum((x - mean[0]) ** 2 for x, _ in logs)
    return slope


def grown(kind: str, sizes: list[tuple[int, int]]) -> None:
    """Print how processor time and memory grow with jobs or points, or with workers; each run is a process of its own."""
    seen = []
    for number, workers in sizes:
        words = [sys.executable, "-m", __spec__.name, "--one", kind, str(number), str(workers)]
        found = subprocess.run(words, env=environment(), check=True, capture_output=True, text=True)
        seen.append((number, workers, *map(float, found.stdout.split())))
        print("{} {}, {} workers: processor {:.1f} s, {:.0f} MB, its largest child {:.0f} MB".format(kind, *seen[-1]))
    by = 0 if sizes[0][0] != sizes[-1][0] else 1
    powers = [exponent([(each[by], each[k]) for each in seen]) for k in (2, 3, 4)]
    what = ("processor time", "memory", "memory of a child")
    told = ", ".join(f"{name} {power:.2f}" for name, power in zip(what, powers, strict=True))
    print(f"powers of the number of {kind if by == 0 else 'workers'}: {told}")


def one(kind: str, number: int, workers: int) -> None:
    """Do one run, and print its processor time, the memory of this process, and that of the largest child."""
    with tempfile.TemporaryDirectory() as folder:
        if kind == "jobs":
            work = lambda: by_batch(number, Path(folder), workers=workers)  # noqa: E731
        else:
            plan = Plan(CART, f"l=1:1:{number // 100}, m=1:1:100", "K, L")
            work = lambda: Batch(plan.jobs, Path(folder), workers=workers).finish()  # type: ignore[assignment]  # noqa: E731
        used = timed(work)[1]
    memory = [resource.getrusage(who).ru_maxrss / 1024 for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    print(used, *memory)


def main() -> None:
    """Print what was measured."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--one", nargs=3)
    asked.add_argument("--jobs", type=int, default=400)
    asked.add_argument("--points", type=int, default=40_000)
    asked.add_argument("--keys", type=int, default=10**6)
    asked.add_argument("--table", action="store_true")
    options = asked.parse_args()
    if options.one:
        one(options.one[0], int(options.one[1]), int(options.one[2]))
        return
    folder = Path(tempfile.mkdtemp()) / "out"
    count = options.jobs
    solved(0)
    rows = {
        "plain loop": timed(lambda: [solved(n) for n in range(count)]),
        "joblib, 2": timed(lambda: by_joblib(count)),
        "dask, 2": timed(lambda: by_dask(count)),
        "batch, 1 worker": timed(lambda: by_batch(count, folder, workers=1)),
        "batch, dask, 2": timed(lambda: by_batch_on_dask(count, folder)),
        "batch, 2 workers": timed(lambda: by_batch(count, folder, workers=2)),
    }
    plain, plain_processor = rows["plain loop"]
    for name, (clock, processor) in rows.items():
        ratios = clock / plain, processor / plain_processor
        print(f"{name:18} {clock:7.2f} s ({ratios[0]:4.2f})   processor {processor:7.2f} s ({ratios[1]:4.2f})")
    alone = timed(lambda: by_batch(1, folder.with_name("one"), workers=1))[1]
    beyond = (rows["batch, 1 worker"][1] - alone - plain_processor) / count
    print(f"beyond its work a job takes {beyond * 1e3:.2f} ms of the processor")
    print(f"the first result of a fresh command is there after {first_result(folder.parent):.2f} s")
    begun_again(folder.with_name("keys"), options.keys)
    if options.table:
        return
    grown("jobs", [(n, 2) for n in (count // 4, count // 2, count)])
    grown("points", [(n, 2) for n in (options.points // 4, options.points // 2, options.points)])
    grown("jobs", [(count, workers) for workers in (1, 2, 4)])
    jobs = list(Plan(CART, f"l=1:1:{options.points // 400}, m=1:1:100", "K, L").jobs())
    began = time.process_time()
    for each_block in jobs:
        block.run(read_payload(each_block.payload))
    each = (time.process_time() - began) / (options.points // 400 * 100)
    print(f"a point of a block: {each * 1e3:.3f} ms")
    design_seconds = rows["batch, 1 worker"][1] / count
    points, designs = (max(10**8 * each / 100, 10**8 * STORED) / 60, 10**6 * design_seconds / 100 / 60)
    print(
        f"by this model (no measurement), 100 processors as fast as this one, blocks of {BLOCK} points, {STORED * 1e6:.0f} µs "
        f"a row on the machine that stores: 10^6 designs {designs:.0f} min, 10^8 points {points:.0f} min"
    )


if __name__ == "__main__":
    main()
