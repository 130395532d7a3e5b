"""A lecturer's afternoon: the lines of the page run in order, with fewer variants and students, and mark the class it plays."""

from __future__ import annotations

import csv
import json
import re
import shlex
from typing import TYPE_CHECKING
from xml.etree.ElementTree import fromstring

import pytest

from tests.support.paths import ROOT
from tests.support.tools.command_line import Run, inside

if TYPE_CHECKING:
    from pathlib import Path

PAGE = (ROOT / "docs/tutorials/afternoon.md").read_text("utf-8")
VARIANTS, STUDENTS = 4, 20


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


@pytest.mark.slow
def test_the_afternoon(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (problem,), (students, play), shell = blocks("toml"), blocks("python"), blocks("sh")
    (tmp_path / "problem.toml").write_text(problem, "utf-8")
    monkeypatch.chdir(tmp_path)
    exec(students.replace("60", str(STUDENTS)), {})  # noqa: S102 - the page is ours

    def run(block: str) -> list[Run]:
        lines = [shlex.split(line)[1:] for line in block.splitlines()]
        return [inside(*(str(VARIANTS) if word == "30" else word for word in line), folder=tmp_path) for line in lines]

    before = [*run(shell[0]), *run(shell[1])]
    assert [each.code for each in before] == [0] * 5, before
    assert (tmp_path / "handout.tex").read_text("utf-8").count("variant ") == VARIANTS
    manifest = json.loads((tmp_path / "SET" / "manifest.json").read_text("utf-8"))
    key = (tmp_path / "key.tex").read_text("utf-8")
    for each in manifest["variants"]:
        assert rf"\begin{{bmatrix}}{each['answers']['L'].strip('[]').replace('; ', chr(92) * 2)}\end{{bmatrix}}" in key
    quiz = fromstring((tmp_path / "quiz.xml").read_text("utf-8"))  # noqa: S314 - our own
    assert len(quiz.findall(".//deployedseed")) == VARIANTS
    assert len(json.loads(next(tmp_path.glob("COURSE/questions/*/variants.json")).read_text())) == VARIANTS

    exec(compile(play, "page", "exec"), {})  # noqa: S102 - the page is ours
    marked, _ = run(shell[2])
    assert (marked.code, marked.err) == (0, "")
    summary = json.loads((tmp_path / "RESULTS" / "summary.json").read_text("utf-8"))
    slips = {part: {each["slip"]: each["count"] for each in found} for part, found in summary["slips"].items()}
    tenth = STUDENTS // 10
    assert (
        slips["compensator.K"]["transposed"]
        == slips["compensator.L"]["sign"]
        == slips["compensator.L"]["entry"]
        == tenth
    )
    assert summary["parts"]["compensator.F"]["missing"] == summary["parts"]["compensator.K"]["unreadable"] == tenth
    assert summary["parts"]["compensator.F"]["follows"] >= 2 * tenth
    with (tmp_path / "RESULTS" / "marks.csv").open(encoding="utf-8") as file:
        marks = list(csv.DictReader(file))
    shares = dict(csv.reader((tmp_path / "SET" / "assignment.csv").read_text("utf-8").splitlines()))
    assert [row["variant"] for row in marks] == [shares[row["student"]] for row in marks]
    assert all(row["score"] == "10.00" for i, row in enumerate(marks) if i % 10 in {0, 6, 9})
    picture = fromstring((tmp_path / "RESULTS" / "summary.svg").read_text("utf-8"))  # noqa: S314 - our own
    said = {text.text for text in picture.iter() if text.tag.endswith("text")}
    assert {"compensator.L: right", "sign", "entry", "unreadable", "transposed"} <= said


def test_the_picture_of_the_page_is_one_of_ours() -> None:
    picture = fromstring((ROOT / "docs/tutorials/afternoon.svg").read_text("utf-8"))  # noqa: S314 - our own
    assert picture[0].text == "What became of the answers of 60 students"
