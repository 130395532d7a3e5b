"""Paths that are no files, or files of something else: a line that names the place and the repair, for every command."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.kit import tabled
from tests.support.tools.command_line import SERVO, inside

READING = [["solve"], ["audit"], ["sheet"], ["sheet", str(SERVO)]]
WRITING = [
    ["solve", str(SERVO), "-o"],
    ["solve", str(SERVO), "--plot"],
    ["observer", "--A", "[0]", "--C", "[1]", "--poles", "-1", "-o"],
    ["audit", str(SERVO), "-o"],
    ["sheet", str(SERVO), "-o"],
]
CHOOSING = [["solve", str(SERVO), option] for option in ("--templates", "--convention")]


@pytest.fixture(autouse=True)
def _among_wrong_paths(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("folder.toml").mkdir()
    Path("picture.toml").write_bytes(b"\x89PNG\r\n\x1a\n\x00\xff")
    Path("templates").mkdir()
    Path("templates/article.tex").write_bytes(b"\xff\xfe")


def refusal(*arguments: str) -> str:
    """What a run says that is refused, on one line with a repair, nothing being written."""
    before = sorted(Path().rglob("*"))
    run = inside(*arguments, folder=Path.cwd())
    assert run.code in {2, 3}
    assert run.out == ""
    (line,) = run.lines
    place, _, rest = line.partition(": ")
    assert place
    assert "; " in rest
    assert "internal error" not in line
    assert "codec" not in line
    assert sorted(Path().rglob("*")) == before
    return line


@pytest.mark.parametrize("command", READING, ids=" ".join)
@tabled
def test_what_cannot_be_read_is_named(command: list[str], path: str, said: str) -> None:
    assert refusal(*command, path).startswith(said)


@pytest.mark.parametrize("command", READING, ids=" ".join)
def test_what_must_not_be_read_is_named(command: list[str], monkeypatch: pytest.MonkeyPatch) -> None:
    usual = Path.open

    def refused(path: Path, *arguments: Any, **more: Any) -> Any:
        if path.name == "secret.toml":
            raise PermissionError(13, "Permission denied")
        return usual(path, *arguments, **more)

    monkeypatch.setattr(Path, "open", refused)
    assert refusal(*command, "secret.toml").startswith("secret.toml: Permission denied; ")


@pytest.mark.parametrize("command", WRITING, ids=lambda command: f"{command[0]} {command[-1]}")
@pytest.mark.parametrize("path", ["missing/page.svg", "picture.toml/page.svg"])
def test_what_cannot_be_written_is_named_before_work(command: list[str], path: str) -> None:
    assert refusal(*command, path, "--format", "text").startswith(f"{path}: there is no folder ")


@pytest.mark.parametrize("command", CHOOSING, ids=lambda command: command[-1])
@tabled
def test_what_cannot_be_chosen_is_named(command: list[str], path: str) -> None:
    assert path in refusal(*command, path)
