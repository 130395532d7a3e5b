"""The documents name what is there: paths, the rooms, and programs to run."""

from __future__ import annotations

import os
import re
from pathlib import PurePosixPath

from tests.kit import tabled
from tests.support.paths import ROOT

PATH = re.compile(r"`((?:symobs|tests|docs|worked_examples|latex_templates|\.ci|\.github)/[\w./]+)`")
PROGRAM = re.compile(r"python -m (tests[\w.]+)")
ROOM = re.compile(r"^\| `(\w+)` \|", re.MULTILINE)


LINK = re.compile(r"\]\(([^)\s:]+)\)")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)
#: What a work in progress and the built site leave, which no checkout has.
NOT_KEPT = {
    *(".git", ".venv", "venv", "build", "dist", ".hypothesis", ".mypy_cache", ".pytest_cache", ".ruff_cache"),
    *("_cache", "_build", "gallery", "reference", "changelog.md", "contributing.md"),
}
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)


def text_of(page: str) -> str:
    return (ROOT / page).read_text("utf-8")


@tabled
def test_every_path_exists(page: str) -> None:
    text = text_of(page)
    named = [path for path in PATH.findall(text) if "NAME" not in path]
    named += [program.replace(".", "/") for program in PROGRAM.findall(text)]
    assert named
    assert [path for path in named if not any((ROOT / f"{path}{end}").exists() for end in ("", ".py"))] == []


def test_every_room_is_described() -> None:
    rooms = ROOM.findall(text_of("docs/architecture.md"))
    packages = {path.parent.name for path in (ROOT / "symobs").glob("[!_]*/__init__.py")}
    assert sorted(rooms) == sorted(packages)


def test_every_link_leads_somewhere_on_a_plain_checkout() -> None:
    paths = (path.relative_to(ROOT) for path in ROOT.rglob("*") if path.is_file())
    files = [path.as_posix() for path in paths if not NOT_KEPT.intersection(path.parts)]
    known = {*files, *(str(folder) for file in files for folder in PurePosixPath(file).parents)}
    texts = {page: FENCE.sub("", text_of(page)) for page in files if page.endswith(".md")}
    anchors = {
        page: {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in HEADING.findall(text)}
        for page, text in texts.items()
    }
    lost = []
    for page, text in texts.items():
        for link in LINK.findall(text):
            path, _, anchor = link.partition("#")
            there = os.path.normpath(f"{PurePosixPath(page).parent}/{path}") if path else page
            if there not in known or (anchor and anchor not in anchors.get(there, {anchor})):
                lost.append(f"{page}: {link}")
    assert lost == []
