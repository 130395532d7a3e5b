"""The documents name what is there: paths, the rooms, and programs to run."""

from __future__ import annotations

import re

from tests.kit import tabled
from tests.support.paths import ROOT

PATH = re.compile(r"`((?:symobs|tests|docs|worked_examples|latex_templates|\.ci|\.github)/[\w./]+)`")
PROGRAM = re.compile(r"python -m (tests[\w.]+)")
ROOM = re.compile(r"^\| `(\w+)` \|", re.MULTILINE)


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
