"""Where results go: whole or not at all, and what is said of a place that takes none."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from symobs.cli.shared.output import write_all
from symobs.ground.errors import InputError
from tests.kit import tabled
from tests.support.paths import ROOT
from tests.support.tools.command_line import SAFETY, SERVO, Run, environment, inside

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    RequireTool = Callable[[str], str]

REGION = ROOT / "worked_examples" / "region_nonconvex.toml"
#: Symobs with files of no more than so many bytes.
SMALL_FILES = """
import resource, runpy, sys
resource.setrlimit(resource.RLIMIT_FSIZE, (4000, 4000))
sys.argv[0] = "symobs"
runpy.run_module("symobs", run_name="__main__", alter_sys=True)
"""


def run(*command: str, folder: Path) -> Run:
    """Run a command in a folder, with the messages of a system that speaks English."""
    found = subprocess.run(
        command, cwd=folder, env=environment() | {"LC_ALL": "C"}, capture_output=True, timeout=SAFETY, check=False
    )
    return Run(found.returncode, found.stdout.decode(), found.stderr.decode())


@pytest.fixture(name="bound")
def symobs_that_permissions_bind(require_tool: RequireTool) -> list[str]:
    """Symobs for whom permissions hold: an administrator puts the right to ignore them away."""
    own = [sys.executable, "-m", "symobs"]
    if os.geteuid() != 0:
        return own
    without = "-dac_override,-dac_read_search"
    return [require_tool("setpriv"), f"--bounding-set={without}", f"--inh-caps={without}", *own]


def contents(folder: Path) -> dict[str, str]:
    return {path.name: path.read_text("utf-8") for path in folder.iterdir() if path.is_file()}


# -- places that take nothing -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("target", "said"),
    [
        ("folder", "folder: this is a folder; name a file in a folder that can be written"),
        ("a\0b", "a\\x00b: embedded null byte; "),
        ("a" * 300, "name too long; name a file in a folder that can be written"),
        ("\x1b[2J/page.tex", "\\x1b[2J/page.tex: there is no folder "),
    ],
)
@pytest.mark.parametrize("command", [["solve"], ["sheet"], ["audit"]], ids=lambda command: command[0])
def test_a_place_that_takes_nothing_is_said_at_once(command: list[str], target: str, said: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "page.tex").write_text("before", "utf-8")
    form = [] if command == ["audit"] else ["--format", "latex"]
    left = inside(*command, "nothing.toml", "-o", target, *form, folder=tmp_path)  # nothing is read, let alone computed
    assert (left.code, left.out) == (3, "")
    assert said.lower() in left.err.lower()
    assert left.err.count("\n") == 1
    assert contents(tmp_path) == {"page.tex": "before"}


def test_a_folder_that_cannot_be_written(bound: list[str], tmp_path: Path) -> None:
    closed = tmp_path / "closed"
    closed.mkdir(mode=0o555)
    left = run(*bound, "solve", str(SERVO), "-o", "closed/page.tex", folder=tmp_path)
    assert left == (
        3,
        "",
        "closed/page.tex: the folder cannot be written; name a file in a folder that can be written\n",
    )
    copied = run(*bound, "templates", "copy", "closed/templates", folder=tmp_path)
    assert copied == (3, "", "closed/templates: Permission denied; name a folder that can be written\n")
    assert not any(closed.iterdir())


# -- places that are full ---------------------------------------------------------------------------------------------


def test_a_file_that_may_not_become_so_large(tmp_path: Path) -> None:
    (tmp_path / "page.tex").write_text("before", "utf-8")
    left = run(sys.executable, "-B", "-c", SMALL_FILES, "solve", str(SERVO), "-o", "page.tex", folder=tmp_path)
    assert (left.code, left.out) == (3, "")
    assert left.err == (
        "page.tex: File too large; raise the limit on the size of files (ulimit -f), or name a file elsewhere with -o\n"
    )
    assert contents(tmp_path) == {"page.tex": "before"}


@pytest.fixture(name="small_disk")
def a_disk_of_sixteen_kilobytes(tmp_path: Path) -> Iterator[Path | None]:
    """A file system that is soon full; None where this process may not mount one."""
    place = tmp_path / "disk"
    place.mkdir()
    mounting = ["mount", "-t", "tmpfs", "-o", "size=16k", "tmpfs", str(place)]
    try:
        mounted = subprocess.run(mounting, capture_output=True, timeout=SAFETY, check=False).returncode == 0
    except OSError:
        mounted = False
    yield place if mounted else None
    if mounted:
        subprocess.run(["umount", str(place)], timeout=SAFETY, check=True)


@tabled
def test_a_disk_that_is_full(small_disk: Path | None, budget: list[str], tmp_path: Path) -> None:
    if small_disk is None:
        return  # the limit on the size of files and /dev/full remain
    (small_disk / "page.html").write_text("before", "utf-8")
    (small_disk / "full").write_text("x" * 12288, "utf-8")
    left = inside("solve", str(SERVO), "-o", "disk/page.html", *budget, folder=tmp_path)
    assert (left.code, left.out) == (3, "")
    assert left.err == ("disk/page.html: No space left on device; make room there, or name a file elsewhere with -o\n")
    assert contents(small_disk) == {"page.html": "before", "full": "x" * 12288}
    both = inside("solve", str(REGION), "-o", "page.txt", "--plot", "disk/map.svg", *budget, folder=tmp_path)
    assert both.code == 3
    assert both.err.startswith("disk/map.svg: No space left on device; ")
    assert contents(small_disk) == {"page.html": "before", "full": "x" * 12288}
    assert contents(tmp_path) == {}
    copied = inside("templates", "copy", "disk/templates", folder=tmp_path)
    assert copied.code == 3
    assert "No space left on device" in copied.err
    assert contents(small_disk / "templates") == {}


# -- several results --------------------------------------------------------------------------------------------------


def test_of_several_files_all_are_written_or_none(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    old, new, last = tmp_path / "old", tmp_path / "new", tmp_path / "last"
    old.write_text("before", "utf-8")
    last.write_text("before too", "utf-8")
    outputs = [("first", str(old)), ("second", str(new)), ("third", str(last))]
    replace = Path.replace

    def fail_at_the_last(self: Path, target: Path) -> Path:
        if target == last and self.suffix != ".before":
            raise PermissionError(1, "Operation not permitted")
        return replace(self, target)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "replace", fail_at_the_last)
        with pytest.raises(InputError, match="last: Operation not permitted; name a file"):
            write_all(outputs)
    assert contents(tmp_path) == {"old": "before", "last": "before too"}
    write_all(outputs)
    assert contents(tmp_path) == {"old": "first", "new": "second", "last": "third"}


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_no_file_is_written_where_standard_output_is_full(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "symobs", "solve", str(REGION), "--plot", "map.svg"]
    with Path("/dev/full").open("wb") as full:
        left = subprocess.run(
            command, cwd=tmp_path, env=environment(), stdout=full, stderr=subprocess.PIPE, timeout=SAFETY, check=False
        )
    assert left.returncode == 3
    assert left.stderr.decode() == (
        "standard output: No space left on device; make room there, or name a file elsewhere with -o\n"
    )
    assert contents(tmp_path) == {}


def test_without_standard_output_or_error(tmp_path: Path) -> None:
    shell = f"{sys.executable} -m symobs solve {SERVO} --format text"
    closed = run("sh", "-c", f"{shell} >&-", folder=tmp_path)
    assert (closed.code, closed.err) == (
        3,
        "standard output: Bad file descriptor; name a file with -o\n",
    )
    silent = run("sh", "-c", f"{shell} 2>&-", folder=tmp_path)
    assert silent.code == 0
    assert silent.out.startswith("Output feedback")
