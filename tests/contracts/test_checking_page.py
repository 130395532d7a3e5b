"""The page on checking answers shows what the commands do."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

from tests.support.paths import ROOT
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

PAGE = (ROOT / "docs" / "checking.md").read_text(encoding="utf-8")


def block(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


def test_every_command_of_the_page_runs_and_prints_what_it_shows(tmp_path: Path) -> None:
    (problem,), (answer,), (shown,) = block("toml"), block("text"), block("report")
    (tmp_path / "problem.toml").write_text(problem, encoding="utf-8")
    (tmp_path / "answer.txt").write_text(answer, encoding="utf-8")
    (tmp_path / "class.csv").write_text('Email address,K,L\na@b.c,[4 3],"[19; 81]"\n', encoding="utf-8")
    lines = [line for each in block("sh") for line in each.splitlines()]
    assert len(lines) == 5
    outputs = [inside(*shlex.split(line, comments=True)[1:], folder=tmp_path) for line in lines]
    assert [run.code for run in outputs] == [0, 4, 4, 4, 0]
    assert outputs[1].out == shown
    assert "81" not in outputs[2].out
    assert "81" in (tmp_path / "feedback.html").read_text(encoding="utf-8")
    assert (tmp_path / "RESULTS" / "marks.csv").read_text(encoding="utf-8").splitlines()[1] == (
        "a@b.c,,incomplete,5.00,right,right,missing"
    )
