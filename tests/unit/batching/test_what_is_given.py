"""What a run is given: folders, files and numbers as people have them, and what a run says of them when it goes on."""

from __future__ import annotations

import json
import shutil
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.batching.engine import Settings, work
from symobs.batching.executors import InProcess, Workforce
from symobs.batching.jobs import job, row_text
from symobs.batching.run import batch, verified
from symobs.batching.store import Store
from symobs.errors import UsageError
from tests.support.problems.batches import design
from tests.support.tools.command_line import SERVO, inside
from tests.unit.batching.test_sweep import CART

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(name="folder")
def folder_of_problems(tmp_path: Path) -> Path:
    """Two problems, of which one is none."""
    folder = tmp_path / "problems"
    folder.mkdir()
    (folder / "good.toml").write_text(design(7), encoding="utf-8")
    (folder / "bad.toml").write_text("nothing", encoding="utf-8")
    return folder


def test_a_run_that_goes_on_says_of_its_problems_what_it_said_before(folder: Path, tmp_path: Path) -> None:
    words = ["batch", folder.name, "--out", "out", "--in-process"]
    for _ in range(2):  # the second time from the index of keys
        left = inside(*words, folder=tmp_path)
        assert (left.code, left.err) == (4, "1 done, 1 unreadable\n")
    (tmp_path / "out" / "keys.bin").unlink()
    assert inside(*words, folder=tmp_path).code == 4


def test_what_a_problem_was_before_it_was_changed_counts_no_more(folder: Path, tmp_path: Path) -> None:
    words = ["batch", folder.name, "--out", "out", "--in-process"]
    assert inside(*words, folder=tmp_path).code == 4
    (folder / "bad.toml").write_text(design(8), encoding="utf-8")
    assert inside(*words, "--dry-run", folder=tmp_path).err == "2 problems, 1 to be done, 1 done already\n"
    for _ in range(2):
        left = inside(*words, folder=tmp_path)
        assert (left.code, left.err) == (0, "2 done\n")
    assert len(list(Store(tmp_path / "out").rows())) == 3
    assert batch(folder, out=tmp_path / "out").failed == []


def test_equal_problems_are_done_once_and_said(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "good.toml", folder / "bad.toml")
    left = inside("batch", "problems", "--out", "out", "--in-process", folder=tmp_path)
    assert (left.code, left.err) == (0, "1 done, 1 equal to others\n")


def test_a_file_that_cannot_be_read_loses_no_other(folder: Path, tmp_path: Path) -> None:
    (folder / "a.toml").symlink_to("nowhere")
    (folder / "bytes.toml").write_bytes(b"\xff\xfe\x00")
    (folder / "folder.toml").mkdir()
    (folder / "loop").symlink_to(folder)
    left = inside("batch", "problems", "--out", "out", "--in-process", folder=tmp_path)
    assert (left.code, left.err) == (4, "1 done, 3 unreadable\n")
    told = {row["name"]: row["error"][0] for row in Store(tmp_path / "out").rows() if row["status"] == "unreadable"}
    assert told.keys() == {"a.toml", "bytes.toml", "bad.toml"}
    assert "a.toml: No such file or directory" in told["a.toml"]
    assert "bytes.toml: byte 0 is not UTF-8" in told["bytes.toml"]
    assert verified(tmp_path / "out") == 4


def test_names_are_what_they_are(tmp_path: Path) -> None:
    names = ["a b.toml", "new\nline.toml", "ünï\N{GRINNING FACE}.toml", "-o.toml", "a'\"$.toml", "\udcff.toml"]
    folder, out = tmp_path / "prob lems\n", tmp_path / "out ü\n"
    folder.mkdir()
    for number, name in enumerate(names):
        (folder / name).write_text(design(number), encoding="utf-8")
    (folder / "link.toml").symlink_to(SERVO)
    left = inside("batch", str(folder), "--out", str(out), "--in-process", folder=tmp_path)
    assert (left.code, left.err) == (0, "7 done\n")
    assert {row["name"] for row in Store(out).rows()} == {*names, "link.toml"}
    assert json.loads((out / "manifest.json").read_text(encoding="utf-8"))["counts"]["done"] == 7


@pytest.mark.parametrize("count", [1, 5, 118, 1000])
def test_the_last_chunks_are_small(count: int) -> None:
    """A tenth of a second a job, so that chunks of two seconds have twenty: but no worker has more than its share left."""
    sizes: list[int] = []

    def rows(orders: Any, *_: object) -> tuple[list[str], float]:
        sizes.append(len(orders))
        return [row_text(key, kind, {"status": "done"}) for key, kind, _ in orders], len(orders) / 10

    jobs = [job("solve", {"number": number}, str(number)) for number in range(count)]
    chunks = work(jobs, Workforce(InProcess(), 8, rows), Settings(recheck=0))
    assert [row["name"] for chunk in chunks for row in chunk.rows] == [str(number) for number in range(count)]
    left = [count - sum(sizes[:k]) for k in range(len(sizes))]
    assert all(size <= max(1, here / 16) for size, here in zip(sizes, left, strict=True))
    assert max(sizes) == {1: 1, 5: 1, 118: 5, 1000: 20}[count]


@pytest.mark.parametrize(
    ("arguments", "code", "says"),
    [
        (["batch", "problems", "--out", ""], 2, "--out: no folder for the results is named"),
        (["batch", "problems", "--out", "problems"], 2, "--out: problems is the folder of the problems; name a folder"),
        (["batch", "empty", "missing.toml", "--out", "x"], 3, "empty: there is no problem file in this folder"),
        (["batch", "empty", "missing.toml", "--out", "x"], 3, "missing.toml: No such file or directory"),
        (["sweep", "problems", "--over", "l=1", "--out", "x.csv"], 3, "problems: Is a directory; give a problem file"),
        (["sweep", "cart.toml", "--over", "l=1, m=1", "--out", ""], 2, "--out: no table is named"),
    ],
)
def test_what_cannot_be_used_is_said_and_nothing_is_made(
    arguments: list[str], code: int, says: str, folder: Path, tmp_path: Path
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "cart.toml").write_text(CART, encoding="utf-8")
    left = inside(*arguments, folder=tmp_path)
    assert left.code == code, left.err
    assert says in left.err
    assert {path.name for path in tmp_path.iterdir()} == {"problems", "empty", "cart.toml"}
    assert len(list(folder.iterdir())) == 2


@pytest.mark.parametrize("workers", [0, -1, 1.5, "2", True, 10**6])
def test_a_number_of_workers_is_a_number(workers: Any, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"workers: .* is no number of workers; give a whole number from 1 to 1024"):
        symobs.batch(design(4), out=tmp_path / "out", workers=workers)
    assert not list(tmp_path.iterdir())
