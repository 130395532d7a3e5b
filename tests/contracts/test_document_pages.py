"""The pages of the documentation do what they say: shell lines run in order, print what is shown, Python gives its values."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import pytest

from tests.support.paths import ROOT
from tests.support.tools.document_pages import blocks, follow

if TYPE_CHECKING:
    from pathlib import Path

PAGES = [
    "index", "start", "how_to", "web_pages", "live", "believe", "sheets", "checking", "exporting", "values_and_programs",
    "other_programs",
    "tutorials/engineer", "tutorials/lecturer", "tutorials/student",
]  # fmt: skip
#: They need more than their lines.
ELSEWHERE = {"guide", "cluster", "variants", "tutorials/afternoon"}
#: Without blocks of a shell or of Python, or with those of a developer.
WITHOUT = {"architecture", "measurements", "changelog", "contributing"}


@pytest.fixture(name="written")
def pages_written() -> set[str]:
    """The pages that are not written from the code when the site is built."""
    there = {str(path.relative_to(ROOT / "docs").with_suffix("")) for path in (ROOT / "docs").rglob("*.md")}
    return {name for name in there if name.split("/")[0] not in {"gallery", "reference"}}


def test_every_page_is_in_the_contents_of_the_site(written: set[str]) -> None:
    contents = re.findall(r"\]\(([\w/]+)\.md", (ROOT / "docs" / "index.md").read_text("utf-8"))
    assert written - {"index"} - set(contents) == set()


def test_every_page_is_run_somewhere(written: set[str]) -> None:
    others = [path for path in (ROOT / "tests").rglob("test_*.py") if path.name != "test_document_pages.py"]
    tests = "".join(path.read_text("utf-8") for path in others)
    assert written - WITHOUT - set(PAGES) == ELSEWHERE
    for name in ELSEWHERE:
        assert re.search(rf'docs(?:/|" / "){name}\.md"', tests), name
    for name in WITHOUT & written - {"contributing"}:
        assert not {language for _, language, _ in blocks(name)} & {"sh", "python"}, name


@pytest.mark.slow
@pytest.mark.parametrize("page", PAGES)
def test_a_page_does_what_it_says(page: str, tmp_path: Path) -> None:
    follow(page, tmp_path)
