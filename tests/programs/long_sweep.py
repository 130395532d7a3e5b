"""Measure a long sweep: `python -m tests.programs.long_sweep [--points 1000000] [--kills 2] [--workers 2] [--folder F]`.

K and L of the cart-pole with both claims at every point, into one Parquet file: time, processor time, memory on the way,
bytes a row.  With `--kills` a second run is killed so often, goes on, and has to give the same table.
"""

from __future__ import annotations

import argparse
import resource
import subprocess
import sys
import tempfile
import time
from math import isqrt
from pathlib import Path

from symobs.applications.batch.store import Store, work_folder
from symobs.applications.batch.sweep.plan import BLOCK
from tests.support.tools.command_line import environment
from tests.unit.applications.batch.test_sweep import CART

#: Seconds between two looks at the memory.
_LOOK = 0.5


def resident(process: int) -> tuple[float, float]:
    """The megabytes a process holds, and those of all its children together."""

    def of(number: str | int) -> float:
        try:
            lines = Path(f"/proc/{number}/status").read_text(encoding="ascii").splitlines()
        except OSError:
            return 0.0
        return sum(float(line.split()[1]) / 1024 for line in lines if line.startswith("VmRSS"))

    try:
        children = [
            child
            for task in Path(f"/proc/{process}/task").iterdir()
            for child in (task / "children").read_text().split()
        ]
    except OSError:
        children = []
    return of(process), sum(map(of, children))


def command(folder: Path, points: int, workers: int, out: str) -> list[str]:
    """The sweep, two names with about as many values each."""
    (folder / "cart.toml").write_text(CART, encoding="utf-8")
    rows = isqrt(points)
    over = f"l=0.01:0.01:{rows}/100, m=0.01:0.01:{points // rows}/100"
    words = ["sweep", "cart.toml", "--over", over, "--columns", "K,L", "--workers", str(workers), "--quiet"]
    return [sys.executable, "-m", "symobs", *words, "--out", out]


def unbroken(folder: Path, points: int, workers: int) -> Path:
    """Run the sweep and print what it took."""
    out, store = folder / "whole.parquet", Store(work_folder(folder / "whole.parquet"))
    began, before = time.perf_counter(), resource.getrusage(resource.RUSAGE_CHILDREN)
    seen: list[tuple[float, float, float]] = []
    written = None
    with subprocess.Popen(command(folder, points, workers, out.name), cwd=folder, env=environment()) as process:
        while process.poll() is None:
            time.sleep(_LOOK)
            if (folder / f".{out.name}.tmp").exists() and written is None:
                written = time.perf_counter() - began
                print(f"rows are all there after {written:.1f} s, {store_size(store.folder) / points:.0f} bytes a row")
            seen.append((time.perf_counter() - began, *resident(process.pid)))
    clock, after = time.perf_counter() - began, resource.getrusage(resource.RUSAGE_CHILDREN)
    used = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    print(
        f"{points} points, {workers} workers: {clock:.1f} s, processor {used:.1f} s ({used / points * 1e3:.3f} ms a point), "
        f"{out.stat().st_size / points:.1f} bytes a row, exit {process.returncode}"
    )
    for share in (0.1, 0.25, 0.5, 0.75, 0.99):
        at, own, children = seen[int(share * (len(seen) - 1))]
        print(f"  after {at:6.1f} s: {own:5.0f} MB, its children {children:5.0f} MB")
    print(f"  at most {max(own for _, own, _ in seen):.0f} MB, its children {max(c for *_, c in seen):.0f} MB")
    return out


def store_size(folder: Path) -> int:
    """The bytes of the rows that wait."""
    return sum(path.stat().st_size for path in folder.glob("rows/*/*.jsonl"))


def broken(folder: Path, points: int, workers: int, kills: int) -> Path:
    """Run the sweep, kill it at even shares of its blocks, and let it go on."""
    out = folder / "killed.parquet"
    words, store, blocks = command(folder, points, workers, out.name), Store(work_folder(out)), -(-points // BLOCK)
    began = time.perf_counter()
    for kill in range(1, kills + 1):
        with subprocess.Popen(words, cwd=folder, env=environment()) as process:
            while stored(store) < blocks * kill / (kills + 1):
                time.sleep(_LOOK)
            process.kill()
        print(f"killed after {time.perf_counter() - began:.1f} s, {stored(store)} of {blocks} blocks are there")
    subprocess.run(words, cwd=folder, env=environment(), check=True)
    print(f"done after {time.perf_counter() - began:.1f} s in all")
    return out


def stored(store: Store) -> int:
    """How many blocks are there."""
    return sum(path.read_bytes().count(b"\n") for path in store.chunks())


def same(one: Path, other: Path) -> bool:
    """Whether two tables have the same rows; a group of rows of each is in memory at a time."""
    import pyarrow.parquet as pq  # type: ignore[import-untyped,unused-ignore]  # noqa: PLC0415 - an extra

    first, second = pq.ParquetFile(one), pq.ParquetFile(other)
    groups = range(first.num_row_groups)
    return first.num_row_groups == second.num_row_groups and all(
        first.read_row_group(k).equals(second.read_row_group(k)) for k in groups
    )


def main() -> None:
    """Print what was measured."""
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("--points", type=int, default=10**6)
    asked.add_argument("--workers", type=int, default=2)
    asked.add_argument("--kills", type=int, default=0)
    asked.add_argument("--folder", type=Path, help="A table that is there already is compared with, not made again.")
    options = asked.parse_args()
    folder = options.folder or Path(tempfile.mkdtemp())
    folder.mkdir(exist_ok=True)
    whole = folder / "whole.parquet"
    if not whole.exists():
        unbroken(folder, options.points, options.workers)
    if options.kills:
        killed = broken(folder, options.points, options.workers, options.kills)
        bytes_too = whole.read_bytes() == killed.read_bytes()
        print(f"the same rows: {same(whole, killed)}, the same bytes: {bytes_too}")


if __name__ == "__main__":
    main()
