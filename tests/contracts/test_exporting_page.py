"""The page on exported questions shows what the command does."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING

from symobs.exporting import PLATFORMS
from tests.support.paths import ROOT
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

PAGE = (ROOT / "docs" / "exporting.md").read_text(encoding="utf-8")


def test_every_command_of_the_page_does_what_it_says(tmp_path: Path) -> None:
    problem, lines, refused = (
        re.findall(rf"^```{kind}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL) for kind in ("toml", "sh", "report")
    )
    (tmp_path / "problem.toml").write_text(problem[0], encoding="utf-8")
    runs = [inside(*shlex.split(line)[1:], folder=tmp_path) for line in lines[0].splitlines()]
    assert [run.code for run in runs] == [0] * 6 + [3]
    assert runs[-1].err == refused[0]
    made = {path.name for path in tmp_path.iterdir()}
    assert made == {"problem.toml", "COURSE", "servo.xml", "NOTEBOOKS", "quiz.xml", "EXAMS", "items.zip"}


def test_the_page_lists_every_platform() -> None:
    assert set(PLATFORMS) <= set(re.findall(r"`(\w+)`", PAGE))
