"""Four hundred answers in the notations of books, LaTeX, MATLAB, NumPy and SymPy, right and wrong: each has its verdict."""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

from symobs.applications.checking import Checked

CORPUS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))


@pytest.mark.parametrize("name", CORPUS)
def test_every_answer_has_its_verdict(name: str) -> None:
    checked, wrong = Checked.of(CORPUS[name]["problem"]), []
    for answer, expected in CORPUS[name]["answers"]:
        report = checked.report(answer)
        found = {part.verdict for part in report.parts} - {"missing"}
        if expected.startswith("line "):
            found = {"wrong" if any(line.verdict == "false" for line in report.lines) else "right"}
            unread = [line for line in report.lines if line.verdict not in {"true", "false"}]
            found |= {line.verdict for line in unread}
        if (found or {"none"}) != {expected.removeprefix("line ")}:
            wrong.append((answer, expected, found, [part.reason for part in report.parts]))
    assert not wrong


def test_exchanged_answers_are_called_by_their_names() -> None:
    report = Checked.of(CORPUS["servo"]["problem"]).report("K = [19 81]\nL = [4 3]")
    assert [part.reason for part in report.parts[:2]] == ["this is the transpose of L", "this is K"]
    assert "K" not in Checked.of(CORPUS["servo"]["problem"]).report("L = [4; 3]").parts[1].reason


@pytest.mark.parametrize(
    "line", ["adj A = [1 1; 0 0]", "inv A = [1 0; 0 1]", "eig A = -1", "let M = [1 2]", "aaaaaaaaaaaaaaaaaaaaaaaaa = 1"]
)
def test_operators_are_no_words_around_a_relation(line: str) -> None:
    report = Checked.of(CORPUS["servo"]["problem"]).report(f"{line}\nL = [19; 81]")
    assert {part.verdict for part in report.parts} == {"missing", "right"}
    assert "false" not in {each.verdict for each in report.lines}
