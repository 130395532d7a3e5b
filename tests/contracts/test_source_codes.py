"""The short names that the worked examples' sources have in `id`, S0 to S4, are printed nowhere: no reader knows them."""

from __future__ import annotations

import re
import tomllib
from typing import TYPE_CHECKING

import pytest

from symobs.cli.command_line import COMMANDS
from symobs.formula.convention.convention import ALIASES
from symobs.tasks.result import tasks
from tests.support.paths import ROOT
from tests.support.sampling import every
from tests.support.tools.command_line import EXAMPLES, inside

if TYPE_CHECKING:
    from pathlib import Path

CODE = re.compile(r"\bS[0-4]\b|\bS[0-4]-[A-Z]")
#: Every way to print a page, but for the PDF, which is made of the LaTeX.
FORMATS = ("latex", "beamer", "html", "markdown", "text", "json")
DATA = {path.stem: tomllib.loads(path.read_text("utf-8")) for path in EXAMPLES}
OF_SOURCES = [path for path in EXAMPLES if any(CODE.search(row) for row in DATA[path.stem].get("id", []))]
SHEET = "worked_examples/servo_feedforward.toml"


def test_the_codes_are_known() -> None:
    assert len(OF_SOURCES) > 50
    assert all(CODE.fullmatch(alias) for alias in ALIASES)


@pytest.mark.parametrize("path", every(50, OF_SOURCES, 34), ids=lambda path: path.stem)
@pytest.mark.parametrize("name", FORMATS)
def test_no_page_prints_one(path: Path, name: str) -> None:
    printed = inside("solve", str(path), "--format", name).out
    assert len(printed) > 200
    assert CODE.findall(printed) == []


def test_no_title_source_or_text_of_an_example_contains_one() -> None:
    shown = [(stem, data.get(key, "")) for stem, data in DATA.items() for key in ("title", "source", "text")]
    assert [(stem, text) for stem, text in shown if CODE.search(text)] == []


@pytest.mark.parametrize(
    "arguments",
    [
        ("--help",),
        *((command, "--help") for command in COMMANDS),
        *((name, "--help") for name in sorted(tasks())[::5]),
        ("methods",),
        ("conventions",),
        *(("conventions", name) for name in ALIASES),
        ("examples",),
        ("schema",),
        ("check", SHEET, "-"),
        ("audit", "worked_examples/pendulum_hanging_given_gain.toml"),
        ("sheet", SHEET, "worked_examples/third_order_plant.toml", "--format", "text"),
    ],
    ids=" ".join,
)
def test_no_command_prints_one(arguments: tuple[str, ...]) -> None:
    run = inside(*arguments, stdin=b'K = "[4 3]"\nL = "[19; 81]"\nF = 5\n')
    assert len(run.out) > 50
    assert CODE.findall(run.out + run.err) == []


def test_no_document_contains_one() -> None:
    pages = [
        ROOT / "README.md",
        ROOT / "CHANGELOG.md",
        ROOT / "CONTRIBUTING.md",
        *sorted((ROOT / "docs").rglob("*.md")),
    ]
    assert [path.name for path in pages if CODE.search(path.read_text("utf-8"))] == []
