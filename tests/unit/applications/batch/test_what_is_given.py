"""What a run is given: folders, files and numbers as people have them, and what a run says of them when it goes on."""

from __future__ import annotations

import json
import re
import sqlite3
from contextlib import closing
from typing import TYPE_CHECKING, Any

import pytest

import symobs
from symobs.applications.batch.run import verified
from symobs.applications.batch.store import Store
from symobs.ground.errors import UsageError
from tests.kit import tabled
from tests.support.problems.batches import design
from tests.support.tools.command_line import SERVO, inside
from tests.unit.applications.batch.test_sweep import CART

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path


@pytest.fixture(name="folder")
def folder_of_problems(tmp_path: Path) -> Path:
    """Two problems, of which one is none."""
    folder = tmp_path / "problems"
    folder.mkdir()
    (folder / "good.toml").write_text(design(7), "utf-8")
    (folder / "bad.toml").write_text("nothing", "utf-8")
    return folder


def _shortened(data: bytes) -> bytes:
    return data[:-5000]


def _of_another_kind(_: bytes) -> bytes:
    return b"no database" * 1000


@pytest.mark.parametrize("damage", [_shortened, _of_another_kind])
def test_damaged_rows_are_named_and_done_again(damage: Callable[[bytes], bytes], folder: Path, tmp_path: Path) -> None:
    words, place = ["batch", folder.name, "--out", "out", "--in-process"], tmp_path / "out" / "rows.sqlite"
    assert inside(*words, folder=tmp_path).code == 4
    before = sorted(map(json.dumps, Store(tmp_path / "out").rows()))
    place.write_bytes(damage(place.read_bytes()))
    for each in (["batch", "--verify", "out"], [*words, "--dry-run"], words):
        found = inside(*each, folder=tmp_path)
        assert found.code == 4
        assert re.match("out/rows.sqlite: this file was damaged: .*; rename it to rows.sqlite.damaged and", found.err)
    place.rename(place.with_name("rows.sqlite.damaged"))
    assert inside(*words, folder=tmp_path).err == "1 done, 1 unreadable\n"
    assert sorted(map(json.dumps, Store(tmp_path / "out").rows())) == before


def test_what_is_no_row_is_named(folder: Path, tmp_path: Path) -> None:
    assert inside("batch", folder.name, "--out", "out", "--in-process", folder=tmp_path).code == 4
    with closing(sqlite3.connect(tmp_path / "out" / "rows.sqlite")) as rows, rows:
        rows.execute("UPDATE rows SET row = substr(row, 20)")
    found = inside("batch", "--verify", "out", folder=tmp_path)
    assert found.code == 4
    assert re.match("out/rows.sqlite: this file was damaged: what is stored of [0-9a-f]{16} is no whole row", found.err)


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
        (folder / name).write_text(design(number), "utf-8")
    (folder / "link.toml").symlink_to(SERVO)
    left = inside("batch", str(folder), "--out", str(out), "--in-process", folder=tmp_path)
    assert (left.code, left.err) == (0, "7 done\n")
    assert {row["name"] for row in Store(out).rows()} == {*names, "link.toml"}
    assert json.loads((out / "manifest.json").read_text("utf-8"))["counts"]["done"] == 7


@tabled
def test_what_cannot_be_used_is_said_and_nothing_is_made(
    arguments: list[str], code: int, says: str, folder: Path, tmp_path: Path
) -> None:
    (tmp_path / "empty").mkdir()
    (tmp_path / "cart.toml").write_text(CART, "utf-8")
    left = inside(*arguments, folder=tmp_path)
    assert left.code == code, left.err
    assert says in left.err
    assert {path.name for path in tmp_path.iterdir()} == {"problems", "empty", "cart.toml"}
    assert len(list(folder.iterdir())) == 2


@tabled
def test_a_number_of_workers_is_a_number(workers: Any, tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"workers: .* is no number of workers; give a whole number from 1 to 1024"):
        symobs.batch(design(4), out=tmp_path / "out", workers=workers)
    assert not list(tmp_path.iterdir())
