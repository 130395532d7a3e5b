"""The course: every problem, variant, sheet, question and mark of it, held against what was worked out by hand."""

from __future__ import annotations

import csv
import importlib.util
import re
import shutil
import sys
from pathlib import Path

import pytest

from symobs.applications.export import exercises, export
from symobs.applications.variants import Variants
from symobs.ground.errors import ProblemErrors
from symobs.problem import read
from symobs.problem.expect import mismatches
from symobs.problem.file_tables import parse
from symobs.problem.sheet_file import read_sheet
from symobs.tasks.result import render
from tests.kit import tables
from tests.support.paths import ROOT
from tests.support.tools.command_line import inside
from tests.unit.applications.export import test_other_platforms, test_prairielearn, test_stack

COURSE = ROOT / "worked_examples" / "course"
FOLDERS = sorted(path.parent for path in COURSE.glob("[0-9]*/sheet.toml"))
EXAM = COURSE / "exam"
FILES = {
    f"{path.parent.name}/{path.stem}": path
    for folder in (*FOLDERS, EXAM)
    for path in sorted(folder.glob("*.toml"))
    if path.name != "sheet.toml"
}
DRAWN = [name for name, path in FILES.items() if "[variants" in path.read_text("utf-8")]
FIXED = [name for name in FILES if name not in DRAWN]


@pytest.mark.slow
@pytest.mark.parametrize("name", FIXED)
def test_a_problem_meets_what_it_expects_and_its_key_is_checked(name: str) -> None:
    path = FILES[name]
    problem = read(path.read_text("utf-8"), path.name, path.parent)
    assert problem.title
    assert problem.source.startswith("State-space course")
    assert problem.expect
    results = problem.solve()
    assert mismatches(problem.viewed(results), problem.expect) == []
    assert render(problem.document(results), "text")


@pytest.mark.slow
@pytest.mark.parametrize("name", DRAWN)
def test_variants_meet_what_their_file_expects(name: str) -> None:
    """A file says what it expects in its letters, or, where a construction draws the plant, why it does not."""
    text = FILES[name].read_text("utf-8")
    data = parse(text)
    assert ("construct" in data["variants"]) == ("# No [expect]:" in text) == ("expect" not in data)
    assert len(list(Variants(text, 3, where=name, folder=FILES[name].parent, in_process=True))) == 3


def test_twelve_sheets_and_an_examination_hand_out_every_problem() -> None:
    sheets = [read_sheet((folder / "sheet.toml").read_text("utf-8"), folder.name, folder, _text) for folder in FOLDERS]
    assert [sheet.header.number for sheet in sheets] == [str(number) for number in range(1, 13)]
    for folder, sheet in zip(FOLDERS, sheets, strict=True):
        named = [problem.file for problem in sheet.problems]
        assert 3 <= len(named) <= 4
        there = {path.name for path in folder.glob("*.toml")} - {"sheet.toml", "own_numbers.toml"}
        assert {str(file).rpartition("/")[2] for file in named} == there
        assert (folder / "own_numbers.toml").exists()
    exam = read_sheet((EXAM / "sheet.toml").read_text("utf-8"), "exam", EXAM, _text)
    assert exam.header.is_exam
    assert all(f"exam/{path.stem}" in DRAWN for path in EXAM.glob("*.toml") if path.name != "sheet.toml")


def _text(file: str) -> str:
    return Path(file).read_text("utf-8")


# -- learning platforms -----------------------------------------------------------------------------------------------


#: The problems that a platform takes whole, after the table of `docs/exporting.md`.
TAKEN = {
    platform: [f"{folder}/{name}" for folder, names in folders.items() for name in names.split()]
    for platform, folders in tables(Path(__file__))["taken"].items()
}


@pytest.mark.slow
@pytest.mark.parametrize("name", FIXED)
def test_a_platform_takes_what_it_can_hold(name: str) -> None:
    taken, reasons = set(), []
    for platform in TAKEN:
        try:
            export(platform, exercises([str(FILES[name])]))
        except ProblemErrors as refused:
            reasons.append(str(refused))
        else:
            taken.add(platform)
    assert taken == {platform for platform, names in TAKEN.items() if name in names}
    assert all("an exported grader" in why or "export to stack, prairielearn or ipynb" in why for why in reasons)


@pytest.mark.slow
@pytest.mark.parametrize("name", TAKEN["prairielearn"])
def test_the_grader_of_prairielearn_agrees_with_check(name: str) -> None:
    test_prairielearn.agree(f"course/{name}", 3)


@pytest.mark.slow
@pytest.mark.skipif(shutil.which("maxima") is None, reason="maxima is not installed")
@pytest.mark.parametrize("name", TAKEN["stack"])
def test_the_trees_of_stack_agree_with_check(name: str) -> None:
    test_stack.agree(f"course/{name}", 3)


@pytest.mark.slow
@pytest.mark.parametrize("name", TAKEN["moodle"])
def test_a_quiz_of_moodle_agrees_with_check(name: str) -> None:
    test_other_platforms.test_a_moodle_quiz_takes_what_check_takes(f"course/{name}")


# -- a class ----------------------------------------------------------------------------------------------------------


def test_a_class_is_marked_as_a_reader_would_mark_it(tmp_path: Path) -> None:
    marking = COURSE / "marking"
    problem = COURSE / "09_compensator" / "motor.toml"
    done = inside("check", str(problem), "--submissions", str(marking / "answers.csv"), "-o", str(tmp_path / "out"))
    assert done.code == 0
    found = [
        {**row, **{field: row[f"part:compensator.{field}"] for field in "KLF"}}
        for row in _rows(tmp_path / "out/marks.csv")
    ]
    wanted = _rows(marking / "expected.csv")
    fields = ("student", "verdict", "score", "K", "L", "F")
    assert [[row[field] for field in fields] for row in found] == [[row[field] for field in fields] for row in wanted]
    assert {row["student"] for row in wanted} == {row["student"] for row in _rows(COURSE / "students.csv")}


def _rows(path: Path) -> list[dict[str, str]]:
    return list(csv.DictReader(path.read_text("utf-8").splitlines()))


# -- the build --------------------------------------------------------------------------------------------------------

#: In place of symobs: it writes what it is called with, and refuses to export an observer's gain, and tanks altogether.
STAND_IN = r"""
import pathlib, sys
words = sys.argv[1:]
if words[-1] == "--asked":
    sys.exit(print("[answer]" + ("" if "tank" in words[1] else '\n# K = ""\n# L = ""') + "\n\n# [[step]]"))
if words[0] == "export" and "--asked" not in words and "07_" in words[1]:
    print("observer.L: it cannot be held; leave it out", file=sys.stderr)
    sys.exit(3)
if words[0] == "export" and "tank" in words[1]:
    print("observer.K: it cannot be held; leave it out\nobserver.L: nor this", file=sys.stderr)
    sys.exit(3)
target = pathlib.Path(words[words.index("-o") + 1])
made = {"variants": ["manifest.json", "variants/v001.toml"], "check": ["marks.csv"]}
files = [target / name for name in made.get(words[0], [])] or [target / "q" if "prairielearn" in words else target]
for file in files:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text('task = "observer"' if file.suffix == ".toml" else " ".join(words))
"""


@pytest.mark.slow
def test_the_build_says_what_is_left_out_and_does_nothing_twice(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    spec = importlib.util.spec_from_file_location("build", COURSE / "build.py")
    assert spec is not None
    assert spec.loader is not None
    build = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(build)
    (tmp_path / "stand_in.py").write_text(STAND_IN)
    monkeypatch.setattr(build, "SYMOBS", (sys.executable, "-S", "-E", str(tmp_path / "stand_in.py")))
    monkeypatch.setattr(build.shutil, "which", lambda _: "latexmk")
    monkeypatch.setattr(sys, "argv", ["build.py", str(tmp_path / "out")])
    assert build.main() == 0
    said = capsys.readouterr().out
    assert "banks/notes/moodle/01_models_two_tanks.txt  left out, observer.K: it cannot be held (and 1 more)\n" in said
    assert re.search(
        r"banks/notes/stack/07_observer_pendulum\.txt  .* s, without observer\.L: it cannot be held\n", said
    )
    out = tmp_path / "out"
    assert sorted(path.name for path in (out / "09_compensator").iterdir()) == [
        "key.pdf", "own_numbers", "questions.html", "questions.pdf",
    ]  # fmt: skip
    assert "--versions 2" in (out / "exam" / "key.pdf").read_text()
    bank = (out / "banks" / "moodle" / "bank.xml").read_text().split()
    assert str(COURSE / "05_feedback" / "satellite.toml") in bank
    assert not any("07_observer" in word or "two_tanks" in word for word in bank)
    assert build.main() == 0
    assert set(re.findall(r": (\d+) to build", capsys.readouterr().out)) == {"0"}
    (out / "exam" / "key.pdf").unlink()
    monkeypatch.setattr(build, "SYMOBS", (sys.executable, "-c", "import sys; sys.exit('broken')"))
    assert build.main() == 1
    assert "exam/key.pdf  FAILED with exit code 1: broken" in capsys.readouterr().out
