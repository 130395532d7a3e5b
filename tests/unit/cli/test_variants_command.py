"""The command `variants`: what it refuses, and what it leaves behind then."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from symobs.applications.variants.files import assignment
from symobs.ground.errors import InputError
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

OBSERVER = ROOT / "worked_examples" / "variants" / "observer.toml"
FEW = """
title = "a is {a}"
task = "observability"
[plant]
A = "[0 1; 0 a]"
C = "[1 0]"
[variants]
attempts = 20
distinct = "data"
[variants.parameters]
a = { set = [1, 2] }
"""


@tabled
def test_what_it_refuses(tmp_path: Path, arguments: list[str], code: int, message: str) -> None:
    (tmp_path / "strangers.csv").write_text("name,mark\n", "utf-8")
    run = inside("variants", str(OBSERVER), *arguments, folder=tmp_path)
    assert run.code == code
    assert message in run.err
    assert not (tmp_path / "set").exists()


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("student\n\na\n=cmd()\na\n", ""),
        ("name\tstudent\nx\ta\ny\t\n", "student 2 of 2 has no id"),
        ('student\n"' + "a" * 200_000, "not CSV"),
    ],
    ids=range(3),
)
def test_nobody_of_a_table_is_left_without_a_variant(table: str, message: str) -> None:
    if not message:
        named = [line.split(",")[0] for line in assignment(table, 1, 3, "table.csv").splitlines()]
        assert named == ["student", "a", "'=cmd()"]
        return
    with pytest.raises(InputError, match=message):
        assignment(table, 1, 3, "table.csv")


@pytest.mark.slow
def test_each_student_gets_a_sheet_with_a_head_of_its_own_and_the_key_has_one(tmp_path: Path) -> None:
    (tmp_path / "two.toml").write_text(FEW, "utf-8")
    assert inside("variants", "two.toml", "--count", "2", "--workers", "1", "-o", "set", folder=tmp_path).code == 0
    (tmp_path / "fixed.toml").write_text('task = "observability"\n[plant]\nA = "[0 1; 0 3]"\nC = "[1 0]"\n', "utf-8")
    with_one = (tmp_path / "set" / "sheet.toml").read_text("utf-8") + '[[problem]]\nfile = "../fixed.toml"\n'
    (tmp_path / "set" / "mixed.toml").write_text(with_one, "utf-8")
    for sheet, options, titles, names in (
        ("set/sheet.toml", ["--questions"], 2, 2),
        ("set/sheet.toml", ["--solutions"], 1, 0),
        ("set/mixed.toml", ["--questions"], 1, 1),
    ):
        for kind, name in (
            ("text", "Student number:"),
            ("latex", r"\fillin{Student number}"),
            ("html", "Student number"),
        ):
            page = inside("sheet", sheet, "--title", "Own numbers", "--format", kind, *options, folder=tmp_path).out
            told = page.partition("<body")[2] if kind == "html" else page.partition(r"\begin{document}")[2] or page
            assert (told.count("Own numbers"), told.count(name)) == (titles, names), (sheet, options, kind)


@pytest.mark.slow
def test_too_few_leave_nothing_behind_and_partial_ones_what_there_is(tmp_path: Path) -> None:
    (tmp_path / "few.toml").write_text(FEW, "utf-8")
    call = ("variants", "few.toml", "--count", "5", "--workers", "1", "-o", "set")
    run = inside(*call, folder=tmp_path)
    assert run.code == 4
    assert "2 of 5 variants were found" in run.err
    assert run.lines[-1].split(maxsplit=1)[1] == "the same as another variant"
    assert not (tmp_path / "set").exists()
    assert inside(*call, "--partial", folder=tmp_path).code == 4
    files = sorted(path.name for path in (tmp_path / "set").rglob("*.*"))
    assert files == ["manifest.json", "sheet.toml", "v001.toml", "v002.toml"]
    texts = [path.read_text("utf-8") for path in sorted((tmp_path / "set" / "variants").iterdir())]
    assert {text.splitlines()[0] for text in texts} in (
        {'title = "A is 1, variant 1"', 'title = "A is 2, variant 2"'},
        {'title = "A is 2, variant 1"', 'title = "A is 1, variant 2"'},
    )
    (tmp_path / "set" / "manifest.json").unlink()
    (tmp_path / "set" / "manifest.json").mkdir()
    for path in (tmp_path / "set" / "variants").iterdir():
        path.write_text("before", "utf-8")
    assert inside(*call, "--partial", folder=tmp_path).code == 3
    assert sorted(path.name for path in (tmp_path / "set").rglob("*.*")) == files


@tabled
def test_one_message_with_its_place(tmp_path: Path, arguments: list[str], message: str) -> None:
    refused = inside(*arguments, folder=tmp_path)
    assert refused.code in {2, 3}
    assert refused.err.startswith(message)
    assert len(refused.err.splitlines()) == 1
