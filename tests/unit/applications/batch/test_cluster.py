"""A dask cluster of real processes and sockets: workers, scheduler and client die, and nothing is lost or done twice."""

from __future__ import annotations

import json
import random
import re
import shutil
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

import pytest

from symobs.applications.batch.store import Store
from tests.support.paths import ROOT
from tests.support.problems.batches import design, eventually
from tests.support.sampling import FULL
from tests.support.tools.command_line import SAFETY, environment

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

pytest.importorskip("distributed")
pytestmark = pytest.mark.slow


def free_port() -> int:
    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        port: int = found.getsockname()[1]
        return port


class Cluster:
    """A scheduler and its workers, each a process of its own."""

    def __init__(self, folder: Path, port: int) -> None:
        self.folder, self.port = folder, port
        self.scheduler: subprocess.Popen[bytes] | None = None
        self.workers: list[subprocess.Popen[bytes]] = []

    @property
    def address(self) -> str:
        return f"tcp://127.0.0.1:{self.port}"

    def _start(self, *words: str, checkout: Path = ROOT) -> subprocess.Popen[bytes]:
        command = [sys.executable, "-m", "distributed.cli.dask_" + words[0], *words[1:]]
        with (self.folder / f"{words[0]}-{time.monotonic_ns()}.log").open("wb") as log:
            return subprocess.Popen(command, cwd=self.folder, env=environment(checkout), stdout=log, stderr=log)

    def start_scheduler(self) -> None:
        self.scheduler = self._start("scheduler", "--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")
        assert eventually(lambda: self._answers() or self.scheduler is None)

    def _answers(self) -> bool:
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def start_worker(self, checkout: Path = ROOT) -> subprocess.Popen[bytes]:
        words = ("worker", self.address, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--death-timeout", "10")
        self.workers.append(self._start(*words, checkout=checkout))
        return self.workers[-1]

    def end(self) -> None:
        for process in (self.scheduler, *self.workers):
            if process is not None:
                process.kill()
                process.wait(timeout=SAFETY)


@contextmanager
def cluster(folder: Path, workers: int) -> Iterator[Cluster]:
    folder.mkdir(exist_ok=True)
    found = Cluster(folder, free_port())
    try:
        found.start_scheduler()
        for _ in range(workers):
            found.start_worker()
        yield found
    finally:
        found.end()


def problems(folder: Path, count: int) -> Path:
    folder.mkdir(exist_ok=True)
    for number in range(count):
        (folder / f"p{number:04}.toml").write_text(design(number), "utf-8")
    return folder


def client(folder: Path, out: Path, *options: str) -> subprocess.Popen[str]:
    command = [
        sys.executable,
        "-m",
        "symobs",
        "batch",
        str(folder),
        "--out",
        str(out),
        "--chunk-seconds",
        "0.2",
        *options,
    ]
    return subprocess.Popen(command, cwd=ROOT, env=environment(), stderr=subprocess.PIPE, text=True)


def rows(out: Path) -> list[str]:
    return sorted(json.dumps(row) for row in Store(out).rows())


def stored(out: Path) -> int:
    return Store(out).count


@pytest.fixture(name="plain", scope="module")
def local_run(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str]]:
    """Many problems, and their rows as this machine alone finds them."""
    folder = problems(tmp_path_factory.mktemp("many") / "problems", 160)
    out = folder.parent / "out"
    with client(folder, out, "--workers", "2") as process:
        assert process.wait(timeout=SAFETY) == 0
    found = rows(out)
    assert len(found) == 160
    return folder, found


def _has_rows(out: Path, least: int) -> bool:
    return stored(out) >= least


def killing_workers(plain: tuple[Path, list[str]], tmp_path: Path, seed: int) -> None:
    """Kill every worker once, at some time, another one coming in its place."""
    folder, wanted = plain
    drawn, out = random.Random(seed), tmp_path / f"out{seed}"  # noqa: S311
    with cluster(tmp_path / f"cluster{seed}", 2) as found, client(folder, out, "--scheduler", found.address) as process:
        for worker in tuple(found.workers):
            least = min(stored(out) + drawn.randint(1, 40), len(wanted))
            assert eventually(partial(_has_rows, out, least))
            worker.send_signal(signal.SIGKILL)
            found.start_worker()
        assert process.wait(timeout=SAFETY) == 0
    assert rows(out) == wanted
    assert stored(out) == len(wanted)


@pytest.mark.parametrize("seed", range(20 if FULL else 2))
def test_killed_workers_lose_nothing_and_double_nothing(
    seed: int, plain: tuple[Path, list[str]], tmp_path: Path
) -> None:
    killing_workers(plain, tmp_path, seed)


def test_a_killed_scheduler_ends_the_run_which_goes_on(plain: tuple[Path, list[str]], tmp_path: Path) -> None:
    folder, wanted = plain
    out = tmp_path / "out"
    with cluster(tmp_path / "cluster", 2) as found:
        with client(folder, out, "--scheduler", found.address) as process:
            assert eventually(lambda: stored(out) >= 48)
            assert found.scheduler is not None
            found.scheduler.kill()
            found.scheduler.wait(timeout=SAFETY)
            said = process.communicate(timeout=SAFETY)[1]
        assert process.returncode == 5
        last = said.splitlines()[-1]
        count = re.fullmatch(
            r"--scheduler: the scheduler is gone; (\d+) of 160 problems done, run the same command again to go on", last
        )
        assert count is not None, said
        assert "Traceback" not in said
        kept = stored(out)
        assert kept == int(count[1])
        before = rows(out)
        found.start_scheduler()
        for _ in range(2):
            found.start_worker()
        with client(folder, out, "--scheduler", found.address) as process:
            assert process.wait(timeout=SAFETY) == 0
    assert rows(out) == wanted
    assert stored(out) == len(wanted)
    assert {*before} <= {*rows(out)}


def test_a_cluster_that_is_not_there_is_said(tmp_path: Path) -> None:
    folder = problems(tmp_path / "problems", 1)
    with client(folder, tmp_path / "out", "--scheduler", f"tcp://127.0.0.1:{free_port()}") as process:
        said = process.communicate(timeout=SAFETY)[1]
    assert process.returncode == 3
    assert re.search(
        r"^--scheduler: no scheduler answers at tcp://127.0.0.1:\d+: .*; start one with", said, re.MULTILINE
    )
    assert "Traceback" not in said


def test_a_worker_of_another_version_is_refused_before_any_work(tmp_path: Path) -> None:
    """A checkout of another version, made for its worker."""
    folder, other = problems(tmp_path / "problems", 2), tmp_path / "other"
    shutil.copytree(ROOT / "symobs", other / "symobs")
    jobs = other / "symobs" / "applications" / "batch" / "jobs.py"
    jobs.write_text(jobs.read_text("utf-8").replace("symobs-batch/1", "symobs-batch/0"), "utf-8")
    with cluster(tmp_path / "cluster", 1) as found:
        found.start_worker(other)
        assert eventually(lambda: _workers(found.address) == 2)
        with client(folder, tmp_path / "out", "--scheduler", found.address) as process:
            said = process.communicate(timeout=SAFETY)[1]
    assert process.returncode == 3
    assert "elsewhere other versions" in said
    assert "symobs-batch/0" in said
    assert not stored(tmp_path / "out")


def _workers(address: str) -> int:
    import distributed  # noqa: PLC0415 - skipped without it

    with distributed.Client(address, set_as_default=False) as asking:
        return len(asking.nthreads())
