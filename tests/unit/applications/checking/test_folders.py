"""A folder of a class: whatever a student hands in is read, or named with the reason; nobody vanishes."""

from __future__ import annotations

import csv
import io
import json
from typing import TYPE_CHECKING

import pytest

from symobs.applications.checking.folders import decoded
from symobs.ground.errors import InputError
from tests.support.problems.answered import SERVO
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

L = "L = [19; 81]\n"
NOTEBOOK = json.dumps(
    {
        "cells": [
            {"cell_type": "markdown", "source": ["The gain of the observer\n"]},
            {"cell_type": "code", "source": ["import numpy as np\n", "L = np.array([[19], [81]])"], "outputs": []},
        ],
        "nbformat": 4,
    }
)
TEX = "\\documentclass{article}\n\\begin{document}\n\\[ L = \\begin{bmatrix} 19 \\\\ 81 \\end{bmatrix} \\]\n\\end{document}\n"
FILES = {
    "s01.txt": L.encode(),
    "s02.TXT": L.encode(),
    "s03.md": f"# Answer\n\n- {L}".encode(),
    "s04.tex": TEX.encode(),
    "s05.m": b"% gain\nL = [19; 81];\ndisp(L)\n",
    "s06.py": b"import numpy as np\nL = np.array([[19], [81]])\nprint(L)\n",
    "s07.ipynb": NOTEBOOK.encode(),
    "s08": L.encode(),
    "s09/answer.txt": L.encode(),
    "s10_4711_assignsubmission_file_/sheet 3/gain.m": b"L = [19; 81];\n",
    "s11.txt": "Verst\u00e4rkung L = [19; 81]\n".encode("latin-1"),
    "s12.txt": L.encode("utf-16"),
    "s13.txt": L.encode("utf-16-le"),
    "s14.toml": b'[answer]\nL = "[19; 81]"\n',
    "s15.json": b'{"answer": {"L": "[19; 81]"}}',
    "s16_1_assignsubmission_onlinetext_/onlinetext.html": b"<p>L = [19; 81]</p>",
    "s17/ps1/timestamp.txt": b"2026-01-02 15:58:23 UTC\n",
    "s17/ps1/problem.ipynb": NOTEBOOK.encode(),
}
LEFT_OUT = {
    "t01.pdf": b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n",
    "t02.docx": b"PK\x03\x04\x14\x00",
    "t03/scan.jpg": b"\xff\xd8\xff\xe0\x00\x10JFIF",
    "t04.bin": bytes(range(32)),
    "s02/.DS_Store": b"\x00",  # no one handed that in
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with a problem and the files of a class."""
    (tmp_path / "problem.toml").write_text(SERVO, "utf-8")
    return tmp_path


def write(folder: Path, files: dict[str, bytes]) -> None:
    for name, raw in files.items():
        path = folder / "class" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(raw)


def marks(folder: Path) -> dict[str, dict[str, str]]:
    text = (folder / "OUT" / "marks.csv").read_text("utf-8")
    return {row["student"]: row for row in csv.DictReader(io.StringIO(text))}


def run(folder: Path, *more: str) -> tuple[int, str, str]:
    found = inside("check", "problem.toml", "--submissions", "class", "-o", "OUT", *more, folder=folder)
    return found.code, found.out, found.err


def test_every_sort_of_text_is_read(folder: Path) -> None:
    write(folder, FILES)
    code, out, err = run(folder)
    assert (code, err) == (0, "")
    rows = marks(folder)
    assert len(rows) == len(FILES) - 1  # s17 has two files
    assert {name: row["part:compensator.L"] for name, row in rows.items()} == dict.fromkeys(rows, "right")
    assert {"s10_4711", "s16_1", "s08"} <= rows.keys()
    assert "17 students, 0 of them not yet marked" in out
    assert "summary.md" in out
    assert "1.00 of 3.00 on average" in out
    assert "s17: s17/ps1/problem.ipynb counts, not s17/ps1/timestamp.txt" in out
    reports = [json.loads(line) for line in (folder / "OUT" / "results.jsonl").read_text("utf-8").splitlines()]
    notes = {report["student"]: report["hints"] for report in reports if report["hints"]}
    assert notes == {"s11": ["read as Latin-1"], "s12": ["read as UTF-16"], "s13": ["read as UTF-16"]}


def test_what_cannot_be_read_is_named(folder: Path) -> None:
    write(folder, {"s01.txt": L.encode(), "s02/answer.txt": L.encode(), "s02/photo.png": b"\x89PNG", **LEFT_OUT})
    (folder / "class" / "t05").mkdir()
    code, out, err = run(folder, "--feedback")
    assert code == 3
    rows = marks(folder)
    assert {name: (row["verdict"], row["score"]) for name, row in rows.items() if name[0] == "t"} == {
        f"t0{k}": ("unreadable", "") for k in range(1, 6)
    }
    assert rows["s02"]["part:compensator.L"] == "right"
    left_out = json.loads((folder / "OUT" / "summary.json").read_text("utf-8"))["left_out"]
    assert {entry["file"] for entry in left_out} == {*LEFT_OUT, "s02/photo.png", "t05/"} - {"s02/.DS_Store"}
    assert "t01.pdf is left out: this is a PDF, no text; save the answer as plain text in UTF-8" in err
    summary = (folder / "OUT" / "summary.md").read_text("utf-8")
    assert all(name in summary for name in ("t01.pdf", "t02.docx", "t03/scan.jpg", "t04.bin", "s02/photo.png"))
    assert "5 of them not yet marked" in out
    pages = [path.read_text("utf-8") for path in (folder / "OUT" / "feedback").iterdir()]
    assert sum("not yet marked, to be marked by hand" in page and "0.00" not in page for page in pages) == 5


def test_two_files_of_a_student(folder: Path) -> None:
    write(folder, {"a.txt": b"L = [1; 2]\n", "a.md": L.encode(), "b/1.txt": b"L = [1; 2]\n", "b/2.txt": L.encode()})
    _, out, _ = run(folder)
    assert "a: a.txt counts, not a.md" in out
    assert "b: b/2.txt counts, not b/1.txt" in out
    assert {name: row["part:compensator.L"] for name, row in marks(folder).items()} == {"a": "wrong", "b": "right"}


def test_one_column_holds_whole_answers(folder: Path) -> None:
    table = 'student,Response 1\na,"K = [4 3]\nL = [19; 81]"\nb,L = [19; 80]\n'
    (folder / "class").write_bytes(table.encode("utf-16"))
    code, _, err = run(folder, "--map", "Response 1=answer")
    assert (code, err) == (0, "class: read as UTF-16\n")
    rows = marks(folder)
    assert [row["part:compensator.L"] for row in rows.values()] == ["right", "wrong"]
    code, _, err = run(folder)
    assert code == 3
    assert 'write --map "Response 1=answer"' in err


def test_json_lines_hold_texts(folder: Path) -> None:
    lines = [{"student": "a", "text": "K = [4 3]\nL = [19; 81]"}, {"student": "b", "text": "L = [19; 80]"}]
    (folder / "class.jsonl").write_text("\n".join(map(json.dumps, lines)), "utf-8")
    found = inside("check", "problem.toml", "--submissions", "class.jsonl", "-o", "OUT", folder=folder)
    assert found.code == 0
    assert [row["part:compensator.L"] for row in marks(folder).values()] == ["right", "wrong"]


def test_a_single_answer_in_another_encoding(folder: Path) -> None:
    (folder / "answer.txt").write_bytes("Verst\u00e4rkung: L = [19; 81]".encode("latin-1"))
    found = inside("check", "problem.toml", "answer.txt", folder=folder)
    assert "L  right" in found.out
    assert "read as Latin-1" in found.out
    (folder / "answer.pdf").write_bytes(b"%PDF-1.4")
    found = inside("check", "problem.toml", "answer.pdf", folder=folder)
    assert (found.code, "this is a PDF, no text; save the answer as plain text" in found.err) == (3, True)


def test_milestones_are_points_of_the_total(folder: Path) -> None:
    scheme = '\n[marking]\ntotal = 10\nasked = ["compensator.L"]\n'
    scheme += '[[marking.milestone]]\nrelation = "A - L C = [-19 1; -81 -1]"\npoints = 3\n'
    (folder / "problem.toml").write_text(SERVO + scheme, "utf-8")
    found = inside("check", "problem.toml", "-", folder=folder, stdin=L.encode())
    assert "right: 7.00 of 10.00" in found.out
    assert "step 1 of the derivation is not shown: 3.00 of the marks" in found.out
    both = L + "A - L C = [-19 1; -81 -1]\n"
    found = inside("check", "problem.toml", "-", folder=folder, stdin=both.encode())
    assert "right: 10.00 of 10.00" in found.out
    assert "not shown" not in found.out
    (folder / "problem.toml").write_text(SERVO + scheme.replace("points = 3", "points = 11"), "utf-8")
    found = inside("check", "problem.toml", "-", folder=folder, stdin=L.encode())
    assert (found.code, "the milestones have 11 points, the whole answer 10" in found.err) == (3, True)


@pytest.mark.parametrize("raw", [b"%PDF-1.7", b"\x00\x01\x02", b"PK\x03\x04", b"a\x00b\x01c"])
def test_what_is_no_text_is_refused(raw: bytes) -> None:
    with pytest.raises(InputError, match="no text"):
        decoded(raw)


def test_json_holds_values_by_name_with_a_student_or_without(folder: Path) -> None:
    (folder / "named").mkdir()
    for name, text in (("s1.json", '{"L": "[19; 81]"}'), ("s2.json", '{"student": "Ada", "L": "[19; 81]"}')):
        (folder / "named" / name).write_text(text, "utf-8")
    found = inside("check", "problem.toml", "--submissions", "named", "-o", "OUT", folder=folder)
    reports = [json.loads(line) for line in (folder / "OUT" / "results.jsonl").read_text("utf-8").splitlines()]
    assert found.code == 0, found.err
    parts = [{part["part"]: part["verdict"] for part in report["parts"]} for report in reports]
    assert [each["compensator.L"] for each in parts] == ["right", "right"]
