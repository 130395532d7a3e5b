r"""Templates of the user's own: one block replaced, whole ones, broken ones, and what none of them can do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from symobs.ground.errors import InputError
from symobs.pages.formats.latex import typeset
from symobs.pages.formats.templates import template_folder
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.problems.steps import document
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

OBSERVER = str(ROOT / "worked_examples" / "servo_observer.toml")
BUILT_IN = sorted(path.name for path in template_folder().glob("*.tex"))


def own(folder: Path, name: str, text: str) -> Path:
    (folder / name).write_text(text, "utf-8")
    return folder


def test_the_built_in_templates_are_known() -> None:
    assert BUILT_IN == ["article.tex", "beamer.tex", "fragment.tex", "sheet.tex"]
    assert inside("templates").out.split() == BUILT_IN


@tabled
def test_one_block_replaced(name: str, block: str, command: list[str], tmp_path: Path) -> None:
    text = f'\\BLOCK{{extends "symobs/{name}"}}\n\\BLOCK{{block {block}}}\nMINE \\VAR{{super()}}\\BLOCK{{endblock}}\n'
    own(tmp_path, name, text)
    plain = inside(*command, OBSERVER)
    mine = inside(*command, OBSERVER, "--templates", str(tmp_path))
    assert mine.code == 0, mine.err
    assert "MINE" in mine.out
    assert [line.replace("MINE ", "") for line in mine.out.splitlines()] == plain.out.splitlines()


def test_copied_templates_give_the_same_pages(tmp_path: Path) -> None:
    assert inside("templates", "copy", str(tmp_path)).code == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == BUILT_IN
    for command in (
        ["solve"],
        ["sheet"],
        ["solve", "--format", "beamer"],
        ["observer", "--A", "0", "--C", "1", "--poles", "-1"],
    ):
        arguments = [*command, *([] if "--A" in command else [OBSERVER])]
        assert inside(*arguments, "--templates", str(tmp_path)) == inside(*arguments)


@tabled
def test_a_broken_template_is_told_with_its_line(text: str, place: str, reason: str, tmp_path: Path) -> None:
    run = inside("solve", OBSERVER, "--templates", str(own(tmp_path, "article.tex", text)))
    assert (run.code, run.out) == (3, "")
    (line,) = run.lines
    assert line.startswith(f"{place}: ")
    assert reason in line
    assert "symobs" in line.partition(";")[2]


@tabled
def test_a_template_reads_no_file_outside_its_folder(name: str, tmp_path: Path) -> None:
    folder = tmp_path / "templates"
    folder.mkdir()
    own(tmp_path, "secret.tex", "SECRET")
    for directive in (
        f'\\BLOCK{{include "{name}"}}',
        f'\\BLOCK{{extends "{name}"}}',
        f'\\BLOCK{{import "{name}" as x}}',
    ):
        own(folder, "article.tex", directive)
        with pytest.raises(InputError, match="there is no template"):
            typeset(document(title="x"), "article.tex", folder=folder)


@tabled
def test_a_template_runs_no_code(expression: str, tmp_path: Path) -> None:
    own(tmp_path, "article.tex", f"\\VAR{{{expression}}}")
    with pytest.raises(InputError, match=r"unsafe|undefined|cannot be used"):
        typeset(document(title="x"), "article.tex", folder=tmp_path)


def test_a_folder_without_templates_is_refused(tmp_path: Path) -> None:
    run = inside("solve", OBSERVER, "--templates", str(tmp_path))
    assert run.code == 3
    assert "none of the templates article.tex, beamer.tex" in run.err
    assert "symobs templates copy FOLDER" in run.err
    own(tmp_path, "article.tex", "mine")
    run = inside("solve", OBSERVER, "--format", "text", "--templates", str(tmp_path))
    assert run.code == 2
    assert "the format text has no LaTeX template" in run.err
