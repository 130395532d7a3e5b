"""A class: every submission has a verdict, nothing of one harms another, and what a spreadsheet would run is disarmed."""

from __future__ import annotations

import csv
import hashlib
import io
import json
from typing import TYPE_CHECKING

import pytest
from jsonschema import Draft202012Validator  # type: ignore[import-untyped]

from symobs.applications.checking import SHOW, Checked, CheckReport
from symobs.applications.checking.classroom import safe
from symobs.applications.checking.report import schema
from symobs.applications.checking.submissions import report_of_row
from tests.kit import tabled
from tests.support.problems.answered import SERVO
from tests.support.tools.command_line import Run, inside

if TYPE_CHECKING:
    from pathlib import Path

F = "(319 s + 400)/(s^2 + 23 s + 161)"
ROWS = [
    ["s1", "[4 3]", "[19; 81]", F],
    ["s2", "[4, 3]", "[-19; -81]", ""],
    ["s1", "[4 3]", "[19; 80]", F],  # hands in again: this one counts
    ["s3", "[9 9]", "[7; 7]", "1/s"],
    ["s4", "[9 9]", "[7; 7]", "1/s"],
    ["=cmd()", "\u22124", "[19; 81]", F],
    ["big", "[" + "1 " * 35_000 + "]", "[19; 81]", F],
    ["../../etc", "__import__('os')", "[19; 81]", F],
]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a problem and the table of a class: a byte-order mark, semicolons, a foreign column."""
    stream = io.StringIO()
    writer = csv.writer(stream, delimiter=";", lineterminator="\r\n")
    writer.writerow(["Email address", "Time", "K", "L", "compensator.F"])
    writer.writerows([row[0], "12:00", *row[1:]] for row in ROWS)
    (tmp_path / "class.csv").write_text(stream.getvalue(), encoding="utf-8-sig")
    (tmp_path / "problem.toml").write_text(SERVO, "utf-8")
    return tmp_path


def run(folder: Path, *more: str) -> Run:
    return inside("check", "problem.toml", "--submissions", "class.csv", "-o", "RESULTS", *more, folder=folder)


def test_a_class_is_marked_and_counted(folder: Path) -> None:
    found = run(folder, "--map", "Email address=student", "--feedback")
    assert (found.code, found.err) == (0, "")
    results = folder / "RESULTS"
    reports = [json.loads(line) for line in (results / "results.jsonl").read_text("utf-8").splitlines()]
    validator = Draft202012Validator(schema())
    for report in reports:
        validator.validate(report)
    verdicts = {report["student"]: report["verdict"] for report in reports}
    assert verdicts == {
        "s2": "wrong",
        "s1": "wrong",
        "s3": "wrong",
        "s4": "wrong",
        "=cmd()": "wrong",
        "big": "unreadable",
        "../../etc": "unreadable",
    }
    marks = list(csv.reader(io.StringIO((results / "marks.csv").read_text("utf-8"))))
    assert marks[0] == ["student", "variant", "verdict", "score", *(f"part:compensator.{name}" for name in "KLF")]
    assert marks[1] == ["s2", "", "wrong", "1.50", "right", "wrong", "missing"]
    assert marks[5][0] == "'=cmd()"
    summary = json.loads((results / "summary.json").read_text("utf-8"))
    assert summary["superseded"] == [{"student": "s1", "place": "line 2"}]
    assert summary["verdicts"] == {"unreadable": 2, "wrong": 5}
    assert summary["slips"]["compensator.L"][0] == {"slip": "entry", "count": 1, "students": ["s1"]}
    assert {"given": "[7; 7]", "count": 2, "students": ["s3", "s4"]} in summary["agreement"]["compensator.L"]
    assert "larger than 64 kB" in summary["unreadable"][0]["message"]
    assert {row[0]: row[3] for row in marks if row[2] == "unreadable"} == {"big": "", "../../etc": ""}
    by_hand = [entry for entry in summary["by_hand"] if entry["student"] == "big"]
    assert [entry["part"] for entry in by_hand] == [f"compensator.{name}" for name in "KLF"]
    assert all("larger than 64 kB" in entry["reason"] for entry in by_hand)
    pages = {path.name for path in (results / "feedback").iterdir()}
    assert pages == {hashlib.sha256(name.encode()).hexdigest()[:16] + ".html" for name in verdicts}


def test_what_ended_its_process_is_undecided() -> None:
    report = report_of_row({"status": "undecided", "error": ["4 seconds were not enough"]}, SERVO, "", "reason")
    assert (report.verdict, report.score) == ("undecided", None)
    assert {part.reason for part in report.parts} == {"4 seconds were not enough"}


@pytest.mark.parametrize("show", SHOW)
def test_a_report_is_read_back_as_it_was(show: str) -> None:
    steps = ["det(s*I - A + L*C) = s^2 + 19*s + 81", "L = [19; 80]"]
    for answer in ({"K": "[4 3]", "L": "[19; 80]", "F": "1/s"}, {"L": "[-19; -81]"}, f"L = [19; 81]\n{steps[0]}"):
        report = Checked.of(SERVO).report(answer, show)
        read = CheckReport.from_data({**json.loads(json.dumps(report.as_data())), "page": report.page})
        assert (read.to_html(), read.to_text(), read.as_data()) == (
            report.to_html(),
            report.to_text(),
            report.as_data(),
        )


@tabled
def test_a_table_that_cannot_be_used_is_refused(folder: Path, table: str, mapped: list[str], message: str) -> None:
    (folder / "class.csv").write_text(table, "utf-8")
    found = run(folder, *(part for entry in mapped for part in ("--map", entry)))
    assert found.code == 3
    assert message in found.err
    assert not (folder / "RESULTS").exists()


def test_json_lines_and_a_folder_of_files_say_the_same(folder: Path) -> None:
    (folder / "class.jsonl").write_text(
        '{"student": "a", "L": "[19; 81]"}\n{"student": "b", "answer": {"K": "[4 3]"}}\n'
    )
    (folder / "answers").mkdir()
    (folder / "answers" / "a.txt").write_text("L = [19; 81]\n")
    (folder / "answers" / "b.toml").write_text('[answer]\nK = "[4 3]"\n')
    marks = []
    for name in ("class.jsonl", "answers"):
        found = inside("check", "problem.toml", "--submissions", name, "-o", "OUT", folder=folder)
        assert (found.code, found.err) == (0, "")
        marks.append((folder / "OUT" / "marks.csv").read_text())
    assert marks[0] == marks[1]
    assert marks[0].splitlines()[1:] == [
        "a,,incomplete,1.00,missing,right,missing",
        "b,,incomplete,1.00,right,missing,missing",
    ]


@tabled
def test_no_cell_is_a_formula(cell: str) -> None:
    assert safe(cell) == f"'{cell}"
    assert [safe(number) for number in ("-3", "+4.5", "s1")] == ["-3", "+4.5", "s1"]


@tabled
def test_the_exit_code_of_one_answer(folder: Path, answer: str, code: int) -> None:
    found = inside("check", "problem.toml", "-", folder=folder, stdin=answer.encode())
    assert found.code == code
    assert found.out or found.err


def test_how_the_command_is_used(folder: Path) -> None:
    for arguments, message in (
        (["problem.toml"], "one thing is to be done at a time"),
        (["-", "-"], "standard input holds one file"),
        (["problem.toml", "-", "--show", "all"], "is nothing to show"),
        (["problem.toml", "-", "--format", "pdf"], "is not a format of this command"),
        (["problem.toml", "--submissions", "class.csv"], "the results of a class need a folder"),
        (
            ["problem.toml", "-", "-o", "report.pdf"],
            'the suffix ".pdf" names no format of this command; end it in .txt, .md,',
        ),
        (["problem.toml", "-", "--format", "json", "-o", "a.html"], 'the suffix ".html" is that of html, not of json'),
    ):
        found = inside("check", *arguments, folder=folder)
        assert (found.code, message in found.err) == (2, True), found.err
    printed = inside("check", "problem.toml", "--asked", folder=folder)
    assert (printed.code, printed.out.count("# a ")) == (0, 3)
    assert json.loads(inside("schema", "check", folder=folder).out)["title"] == "symobs check"
    assert inside("schema", "nothing", folder=folder).code == 2
