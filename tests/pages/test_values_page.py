"""The page about values and programs does what it says."""

from __future__ import annotations

import re
import shlex
from typing import TYPE_CHECKING, Any

from tests.support.paths import ROOT
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

PAGE = (ROOT / "docs" / "values_and_programs.md").read_text(encoding="utf-8")
FILE = """
task = "compensator"
[symbols]
k = "positive"
[plant]
A = "[0 1; 0 -k]"
B = "[0; 1]"
C = "[1 0]"
[specification]
control_poles = "-2, -2"
observer_poles = "-10, -10"
"""


def blocks(language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)


def test_python_gives_the_values_in_its_comments() -> None:
    names: dict[str, Any] = {}
    compared = 0
    for block in blocks("python"):
        exec(block, names)  # noqa: S102 - the text of our own page
        for expression, comment in re.findall(r"^(\S.*?)  # (.+)$", block, re.MULTILINE):
            shown = repr(eval(expression, names))  # noqa: S307
            assert re.sub(r"([\[(])\s+", r"\1", re.sub(r",\s*", ", ", shown)) == comment
            compared += 1
    assert compared == 7


def test_shell_lines_run(tmp_path: Path) -> None:
    (tmp_path / "servo.toml").write_text(FILE, encoding="utf-8")
    lines = [line for block in blocks("sh") for line in block.splitlines()]
    assert len(lines) == 6
    for line in lines:
        run = inside(*shlex.split(line, comments=True)[1:], folder=tmp_path)
        assert (run.code, run.err) == (0, ""), line
        assert run.out or "-o" in line
    assert "compensator_step" in (tmp_path / "compensator_step.m").read_text(encoding="utf-8")
