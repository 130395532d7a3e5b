"""The pages of the documentation do what they say: shell lines run in order, print what is shown, Python gives its values."""

from __future__ import annotations

import re
import shlex
from itertools import takewhile
from typing import TYPE_CHECKING, Any

import pytest

from tests.support.paths import ROOT
from tests.support.tools.command_line import inside

if TYPE_CHECKING:
    from pathlib import Path

PAGES = [
    "start", "how_to", "web_pages", "live", "believe", "tutorials/engineer", "tutorials/lecturer", "tutorials/student",
]  # fmt: skip
#: Without blocks of a shell or of Python, or with those of a developer.
WITHOUT = {"index", "architecture", "measurements", "changelog", "contributing"}
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```", re.MULTILINE | re.DOTALL)
#: What opens a browser, and what needs a notebook.
INTERACTIVE = re.compile(r"^symobs serve$|symobs\.live\(", re.MULTILINE)


def blocks(page: str) -> list[tuple[str, str]]:
    return BLOCK.findall((ROOT / "docs" / f"{page}.md").read_text(encoding="utf-8"))


@pytest.fixture(name="written")
def pages_written() -> set[str]:
    """The pages that are not written from the code when the site is built."""
    there = {str(path.relative_to(ROOT / "docs").with_suffix("")) for path in (ROOT / "docs").rglob("*.md")}
    return {name for name in there if name.split("/")[0] not in {"gallery", "reference"}}


def test_every_page_is_in_the_contents_of_the_site(written: set[str]) -> None:
    contents = (ROOT / "docs" / "index.md").read_text(encoding="utf-8").splitlines()
    assert written - {"index"} - set(contents) == set()


def test_every_page_is_run_somewhere(written: set[str]) -> None:
    others = [path for path in (ROOT / "tests").rglob("test_*.py") if path.name != "test_document_pages.py"]
    tests = "".join(path.read_text(encoding="utf-8") for path in others)
    elsewhere = {
        name for name in written if re.search(rf'docs(?:/|" / "){name}\.md"', tests)
    }  # they need more than its lines
    assert {"guide", "checking", "cluster", "values_and_programs"} <= elsewhere
    assert written - elsewhere - WITHOUT == set(PAGES)
    for name in WITHOUT & written - {"contributing"}:
        assert not {language for language, _ in blocks(name)} & {"sh", "python"}, name


def run(block: str, folder: Path) -> str:
    """What the lines of a shell print: `symobs` with `>`, `| grep` and `|| test $? =`, and `cat` with and without a text."""
    printed, lines = "", iter(block.splitlines())
    for line in lines:
        if text := re.fullmatch(r"cat (>>?) (\S+) <<'END'", line):
            with (folder / text[2]).open("a" if text[1] == ">>" else "w", encoding="utf-8") as file:
                file.writelines(f"{each}\n" for each in takewhile(lambda each: each != "END", lines))
        elif line.startswith("cat "):
            printed += (folder / line[4:]).read_text(encoding="utf-8")
        elif line:
            command, _, code = line.partition(" || test $? = ")
            command, _, wanted = command.partition(" | grep ")
            words, _, target = command.partition(" > ")
            ran = inside(*shlex.split(words)[1:], folder=folder)
            assert words.startswith("symobs ")
            assert (ran.code, line) == (int(code or 0), line), ran.err
            assert wanted.removeprefix("-i ").lower() in ran.out.lower()
            if target:
                (folder / target).write_text(ran.out, encoding="utf-8")
            else:
                printed += ran.out
    return printed


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_a_page_does_what_it_says(page: str, tmp_path: Path) -> None:
    names: dict[str, Any] = {}
    printed: str | None = None
    for language, block in blocks(page):
        if INTERACTIVE.search(block):
            printed = None
        elif language == "sh":
            printed = run(block, tmp_path)
        elif language == "text" and printed is not None:
            assert all(line in printed for line in block.splitlines()), f"{block}\n{printed}"
        elif language == "python":
            exec(block, names)  # noqa: S102 - the text of our own page
            for expression, value in re.findall(r"^(\S.*?)  # (.+)$", block, re.MULTILINE):
                shown = re.sub(r",\s+", ", ", repr(eval(expression, names)))  # noqa: S307
                assert re.sub(r"\[\s+", "[", shown) == value, expression
