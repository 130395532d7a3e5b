"""The page on variants shows what the commands do."""

from __future__ import annotations

import json
import re
import shlex
from typing import TYPE_CHECKING

import pytest

from symobs.applications.variants.constructions import CONSTRUCTIONS
from symobs.applications.variants.parameters import read_parameter
from symobs.applications.variants.table import CONSTRAINTS, PAGE
from symobs.problem import parse
from tests.support.paths import ROOT
from tests.support.tools.command_line import inside
from tests.support.tools.document_pages import blocks, run

if TYPE_CHECKING:
    from pathlib import Path

PAGE_TEXT = (ROOT / "docs" / "variants.md").read_text("utf-8")


def test_the_page_names_all_there_is() -> None:
    for name in (*CONSTRUCTIONS, *CONSTRAINTS, *PAGE):
        assert re.search(rf"\b{name}\b", PAGE_TEXT), name
    *_, (_, _, parameters) = blocks("variants")
    for name, table in parse(parameters).items():
        assert name == "when" or read_parameter(name, table, lambda *told: pytest.fail(str(told)))


@pytest.mark.slow
def test_every_command_of_the_page_runs(tmp_path: Path) -> None:
    *files, (_, _, lines), _ = blocks("variants")
    for file, _, text in files:
        (tmp_path / file).write_text(text, "utf-8")
    assert run(lines, tmp_path)
    manifest = json.loads((tmp_path / "SET" / "manifest.json").read_text("utf-8"))
    assert [each["file"] for each in manifest["variants"]] == [f"variants/v00{i}.toml" for i in (1, 2, 3)]
    assert manifest["variants"][1]["answers"]["L"] == "[-4; 9]"
    assert len((tmp_path / "SET" / "report.md").read_text("utf-8").splitlines()) > 10
    handout, key = ((tmp_path / name).read_text("utf-8") for name in ("handout.tex", "key.tex"))
    assert handout.count("variant ") == 3
    assert r"\begin{bmatrix}-4\\9\end{bmatrix}" not in handout
    assert r"\begin{bmatrix}-4\\9\end{bmatrix}" in key
    again = inside(*shlex.split("variants problem.toml --count 2 --seed 7 -o SET"), folder=tmp_path)
    assert again.code == 3
    assert "there are variants already" in again.err
