"""Runs: the same rows whoever works, nothing lost and nothing twice, whatever ends on the way."""

from __future__ import annotations

import json
import os
import random
import signal
import sqlite3
import subprocess
import sys
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import closing
from functools import partial
from multiprocessing import get_context
from typing import TYPE_CHECKING, Any

import pytest

from symobs.applications.batch import jobs as kinds
from symobs.applications.batch.engine import InProcess, Settings, Workforce, run_chunk, run_in_process, work
from symobs.applications.batch.jobs import Job, job, key_of, solve_job
from symobs.applications.batch.run import Batch, batch, verified
from symobs.applications.batch.store import Store
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import CertificateRejected, InputError
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.batches import Tampering, children_of, design, eventually, hostile_kind
from tests.support.tools.command_line import SAFETY, SERVO, environment, inside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

pytestmark = pytest.mark.slow


def stored(folder: Path) -> list[str]:
    """The rows of a run as texts, in one order."""
    return sorted(json.dumps(row) for row in Store(folder).rows())


@pytest.fixture(name="hostile")
def hostile_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The kind `hostile` known here and to every child; what it began stands in the file that is returned."""
    folder = tmp_path / "kind"
    folder.mkdir()
    monkeypatch.setenv("PYTHONPATH", hostile_kind(folder))
    monkeypatch.syspath_prepend(str(folder))
    monkeypatch.setitem(kinds.KINDS, "hostile", "hostile_kind")
    monkeypatch.delitem(sys.modules, "hostile_kind", raising=False)
    return tmp_path / "begun"


def orders(log: Path, count: int, **does: str) -> list[Job]:
    """Jobs of the kind `hostile`, of which some misbehave."""
    plain = {"log": str(log), "seconds": 0.02}
    wrong = {int(name.removeprefix("at")): what for name, what in does.items()}
    return [
        job("hostile", {**plain, "number": n, "name": f"n{n}", "does": wrong.get(n, "")}, f"n{n}") for n in range(count)
    ]


def run(jobs: Iterable[Job], out: Path | None, seconds: float = 60.0, megabytes: float = 2000.0, **more: Any) -> Batch:
    listed = list(jobs)
    settings = Settings(Budget(seconds, megabytes), chunk_seconds=0.05)
    return Batch(lambda: listed, out, settings=settings, **more).finish()


# -- the same rows ----------------------------------------------------------------------------------------------------


def test_the_same_rows_whoever_works(tmp_path: Path) -> None:
    files = []
    for number in range(4, 10):
        files.append(tmp_path / f"p{number}.toml")
        files[-1].write_text(design(number), "utf-8")
    (tmp_path / "bad.toml").write_text('task = "compensator"\n[plant]\nA = "[0 1"\n', "utf-8")
    files.append(tmp_path / "bad.toml")
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        ways: dict[str, dict[str, Any]] = {"one": {"workers": 1}, "two": {"workers": 2}, "own": {"executor": pool}}
        rows = {name: stored(batch(files, out=tmp_path / name, **way).folder or tmp_path) for name, way in ways.items()}
    jobs = [solve_job(file.read_text("utf-8"), file.name, tmp_path) for file in files]
    rows["here"] = stored(run(jobs, tmp_path / "here", in_process=True).folder or tmp_path)
    assert rows["one"] == rows["two"] == rows["own"] == rows["here"]
    assert len(rows["one"]) == 7
    by_name = {row["name"]: row for row in map(json.loads, rows["one"])}
    alone = json.loads(inside("solve", str(files[0]), "--format", "json").out)["results"]
    assert by_name["p4.toml"]["result"] == alone
    assert by_name["bad.toml"]["status"] == "unreadable"
    assert any("plant.A" in line for line in by_name["bad.toml"]["error"])


def test_the_key_is_of_what_the_answer_depends_on(tmp_path: Path) -> None:
    text = design(7)
    same = "# another comment\n" + text.replace("task", 'title = "x"\nid = "y"\ntask', 1).replace(" = ", "=")
    assert solve_job(text, "a").key == solve_job(same, "b", tmp_path).key
    assert solve_job(text, "a").key != solve_job(design(8), "a").key
    assert solve_job(text, "a", formats=("latex",)).key != solve_job(same, "a", formats=("latex",)).key
    assert solve_job(text, "a").key != solve_job(text, "a", fields="answer").key
    assert json.loads(solve_job("[plant]\nx = 1979-05-27", "a").payload)["text"]
    decimals = [solve_job(text.replace("-1, -2", f"{pole}, -2"), "a").key for pole in ("-1.5", '"-1.5"', "-1.50")]
    assert len({*decimals}) == 3
    own = (tmp_path / "own.toml", tmp_path / "other")
    own[0].write_text('law = "u = K x_hat"\n', "utf-8")
    own[1].mkdir()
    (own[1] / "own.toml").write_text('law = "u = -K x_hat"\n', "utf-8")
    written = text.replace("task", 'convention = "own"\ntask', 1)
    assert solve_job(written, "a", tmp_path).key != solve_job(written, "a", own[1]).key


def test_pages_and_names_of_what_stands_twice(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / f"{name}.toml").write_text(SERVO.read_text("utf-8"), "utf-8")
    out = tmp_path / "out"
    done = batch([tmp_path / "a.toml", tmp_path / "b.toml"], out=out, workers=1, formats=["text", "latex"])
    (row,) = done.rows()
    assert row["files"].keys() == {"text", "latex"}
    page = inside("solve", str(tmp_path / "a.toml"), "--format", "latex").out
    assert (out / row["files"]["latex"]).read_text("utf-8") == page
    manifest = json.loads((out / "manifest.json").read_text("utf-8"))
    assert manifest["names"] == {row["key"]: ["b.toml"]}
    assert manifest["counts"] == {"done": 1, "no": 0, "unreadable": 0, "undecided": 0, "failed": 0}


# -- what misbehaves --------------------------------------------------------------------------------------------------


def test_one_job_that_misbehaves_loses_no_other(hostile: Path, tmp_path: Path) -> None:
    jobs, others = orders(hostile, 24, at3="abort", at8="eat", at13="hang", at18="raise"), {*children_of(os.getpid())}
    done = run(jobs, tmp_path / "out", seconds=4.0, megabytes=400.0, workers=2)
    assert done.counts == {"done": 20, "no": 0, "unreadable": 0, "undecided": 2, "failed": 2}
    told = {row["name"]: (row["status"], row["error"][0]) for row in done.rows() if row["status"] != "done"}
    assert told == {
        "n3": ("failed", "its process ended with SIGABRT"),
        "n8": ("undecided", "400 MB of memory were not enough"),
        "n13": ("undecided", "4 seconds were not enough"),
        "n18": ("failed", "internal error: KeyError: 'x'"),
    }
    begun = hostile.read_text("utf-8").split()
    assert {name: begun.count(name) for name in ("n3", "n13", "n5")} == {"n3": 2, "n13": 1, "n5": 1}
    assert eventually(lambda: {*children_of(os.getpid())} <= others)


def test_more_time_tries_what_was_undecided_again(hostile: Path, tmp_path: Path) -> None:
    jobs = orders(hostile, 3, at1="sleep")
    slow = [*jobs[:1], job("hostile", {**json.loads(jobs[1].payload), "seconds": 2.0}, "slow"), *jobs[2:]]
    assert run(slow, tmp_path / "out", seconds=1.0, workers=1).counts["undecided"] == 1
    assert run(slow, tmp_path / "out", seconds=1.0, workers=1).kept == 3
    again = run(slow, tmp_path / "out", seconds=60.0, workers=1)
    assert (again.kept, again.counts["done"], again.counts["undecided"]) == (2, 3, 0)
    assert sorted(row["name"] for row in again.rows()) == ["n0", "n2", "slow"]


# -- the store --------------------------------------------------------------------------------------------------------


def test_a_second_run_in_one_folder_is_refused(hostile: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    first = Batch(lambda: orders(hostile, 3), out, workers=1)
    rows = iter(first)
    next(rows)
    with pytest.raises(InputError, match=f"another run is at work here \\(process {os.getpid()} on ") as refused:
        run(orders(hostile, 3), out, workers=1)
    assert refused.value.exit_code == 3
    assert len(list(rows)) == 2
    assert run(orders(hostile, 3), out, workers=1).kept == 3


def test_a_full_disk_leaves_a_store_that_can_be_read(
    hostile: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out, jobs = tmp_path / "out", orders(hostile, 60)
    opened = sqlite3.connect

    def small(*place: Any, **how: Any) -> sqlite3.Connection:
        found: sqlite3.Connection = opened(*place, **how)
        found.execute("PRAGMA max_page_count = 6")
        return found

    with monkeypatch.context() as patch:
        patch.setattr(sqlite3, "connect", small)
        with pytest.raises(InputError, match="database or disk is full; make room there") as refused:
            run(jobs, out, workers=1)
    assert refused.value.where == str(out)
    assert 0 < len(stored(out)) < 60
    assert run(jobs, out, workers=1).counts["done"] == 60


def test_what_a_lost_connection_leaves_without_an_answer_is_done_again() -> None:
    """An executor that goes away with what it was given, and answers once it is back."""
    lost: list[Future[Any]] = []
    seen = iter([True, True, False, False])

    class Goes(InProcess):
        def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
            if lost:
                return super().submit(fn, *args, **kwargs)
            lost.append(Future())
            return lost[0]

    jobs = [solve_job(design(number), f"p{number}") for number in range(3)]
    force = Workforce(Goes(), 1, run_in_process, lambda: next(seen, True))
    rows = [row for chunk in work(jobs, force, Settings()) for row in chunk.rows]
    assert sorted(row["name"] for row in rows) == ["p0", "p1", "p2"]
    assert {row["status"] for row in rows} == {"done"}
    assert lost[0].cancelled()


# -- deadlines, signals and death -------------------------------------------------------------------------------------


_CLIENT = """
import sys
from symobs.ground.child_processes.budget import Budget
from symobs.applications.batch.jobs import job
from symobs.applications.batch.engine import Settings
from symobs.applications.batch.run import Batch
from symobs.cli.commands.batch import finish
log, out, count = sys.argv[1], sys.argv[2], int(sys.argv[3])
from pathlib import Path
def jobs():
    for n in range(count):
        yield job("hostile", {"log": log, "seconds": 0.01, "number": n, "name": f"n{n}", "does": "sleep"}, f"n{n}")
finish(Batch(jobs, Path(out), workers=2, settings=Settings(chunk_seconds=0.05)), count, quiet=True)
"""


def client(log: Path, out: Path, count: int) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", _CLIENT, str(log), str(out), str(count)]
    return subprocess.Popen(command, cwd=ROOT, stderr=subprocess.PIPE, text=True)


def _has_rows(out: Path, wanted: int) -> bool:
    return Store(out).count >= wanted


def _has_ended(process: int) -> bool:
    return not children_of(process)


def killed_and_gone_on(hostile: Path, out: Path, count: int, kills: int) -> None:
    """Kill a run again and again: what was stored stays, no child is left, and nothing is done twice in vain."""
    drawn, most = random.Random(7), 2 * 4 * 40  # noqa: S311
    for _ in range(kills):
        before = Store(out).count
        with client(hostile, out, count) as process:
            wanted = before + drawn.randint(1, 4)
            assert eventually(partial(_has_rows, out, wanted))
            process.kill()
        assert eventually(partial(_has_ended, process.pid))
        assert len({json.loads(text)["key"] for text in stored(out)}) == len(stored(out))
    with client(hostile, out, count) as process:
        assert process.wait(timeout=SAFETY) == 0
    rows = [json.loads(text) for text in stored(out)]
    assert sorted(row["result"]["square"] for row in rows) == [n * n for n in range(count)]
    assert len(hostile.read_text("utf-8").split()) <= count + kills * most


def test_a_killed_run_goes_on_where_it_was(hostile: Path, tmp_path: Path) -> None:
    killed_and_gone_on(hostile, tmp_path / "out", count=150, kills=2)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupted_run_keeps_what_it_has_and_leaves_nobody(number: int, hostile: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    problems = [tmp_path / f"p{n}.toml" for n in range(120)]
    for n, path in enumerate(problems):
        path.write_text(design(n), "utf-8")
    command = [
        sys.executable,
        "-m",
        "symobs",
        "batch",
        *map(str, problems),
        "--out",
        str(out),
        "--chunk-seconds",
        "0.1",
    ]
    with subprocess.Popen(command, cwd=ROOT, env=environment(), stderr=subprocess.PIPE, text=True) as process:
        assert eventually(lambda: Store(out).count > 1)
        process.send_signal(number)
        assert process.communicate(timeout=SAFETY)[1].splitlines()[-1] == "interrupted"
    assert process.returncode == 130
    assert eventually(lambda: not children_of(process.pid))
    assert stored(out)
    assert hostile.name == "begun"


# -- what came over the wire ------------------------------------------------------------------------------------------


def test_a_changed_result_is_found_by_other_code(tmp_path: Path) -> None:
    jobs = [solve_job(design(number), f"p{number}") for number in range(4, 8)]

    def change(row: dict[str, Any]) -> None:
        row["result"][0]["L"][1][0] += " + 1"

    with pytest.raises(CertificateRejected, match=r"p6: this result does not hold: .*det"):
        run(jobs, tmp_path / "out", executor=Tampering(jobs[2].key, change))
    assert len(stored(tmp_path / "out")) == 2


def test_a_result_damaged_on_its_way_is_refused() -> None:
    jobs = [solve_job(design(number), f"p{number}") for number in (4, 5)]

    def unhashed(row: dict[str, Any]) -> None:
        row["result"] = [{**row["result"][0], "K": [["1", "2", "3"]]}]
        row["key"] = "0" * 64

    with pytest.raises(CertificateRejected, match="the row is not the one that was sent"):
        run(jobs, None, executor=Tampering(jobs[1].key, unhashed))


def changed(out: Path, row: dict[str, Any]) -> None:
    """Put a row in the place of the only one."""
    with closing(sqlite3.connect(out / "rows.sqlite")) as rows, rows:
        rows.execute("UPDATE rows SET row = ?", (json.dumps(row).encode(),))


def test_a_stored_result_that_was_changed_is_found(tmp_path: Path) -> None:
    (tmp_path / "p.toml").write_text(design(5), "utf-8")
    out = tmp_path / "out"
    batch(tmp_path / "p.toml", out=out, workers=1)
    assert verified(out) == 1
    (row,) = Store(out).rows()
    for change, says in (({"sha256": "0"}, "hash"), ({"job": row["job"].replace("-3", "-4")}, "key")):
        changed(out, {**row, **change})
        with pytest.raises(CertificateRejected, match=says):
            verified(out)
    moved = row["job"].replace('"control_poles":[-1,-2,-3]', '"control_poles":[-1,-2,-4]')
    assert moved != row["job"]
    changed(out, {**row, "job": moved, "key": key_of("solve", moved)})
    with pytest.raises(CertificateRejected, match="det"):
        verified(out)


def test_other_versions_are_refused_before_any_work() -> None:
    with pytest.raises(InputError, match=r"a worker has symobs .*, this process symobs 9"):
        run_chunk([], (None, None), "symobs 9")


# -- the command ------------------------------------------------------------------------------------------------------


def test_the_command_says_what_it_did_and_goes_on(tmp_path: Path) -> None:
    (tmp_path / "bad.toml").write_text("nothing", "utf-8")
    arguments = ["batch", str(SERVO), str(tmp_path / "bad.toml"), "--out", str(tmp_path / "out"), "--workers", "1"]
    planned = inside(*arguments, "--dry-run")
    assert (planned.code, planned.err) == (0, "2 problems, 2 to be done, 0 done already\n")
    first = inside(*arguments)
    assert (first.code, first.err) == (4, "1 done, 1 unreadable\n")
    assert inside(*arguments, "--dry-run").err == "2 problems, 0 to be done, 2 done already\n"
    assert inside("batch", "--verify", str(tmp_path / "out")).err == "2 results hold\n"


@tabled
def test_what_cannot_be_done_is_said(arguments: list[str], code: int, says: str, tmp_path: Path) -> None:
    left = inside(*arguments, folder=tmp_path)
    assert left.code == code
    assert says in left.err
