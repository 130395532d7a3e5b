"""docs/cluster.md does what it says: its lines are run as they stand, on another port, killed in the middle, and go on."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from tests.support.paths import ROOT
from tests.support.problems.batches import design
from tests.support.tools.command_line import SAFETY, environment

if TYPE_CHECKING:
    from pathlib import Path

pytest.importorskip("distributed")
pytestmark = pytest.mark.slow

PAGE = (ROOT / "docs" / "cluster.md").read_text("utf-8")
_, HERE, GRID, CLUSTER = (
    block.splitlines() for block in re.findall(r"^```sh\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
)
PROGRAMS = {"symobs": [sys.executable, "-m", "symobs"], "dask": [sys.executable, "-m", "dask"]}


@pytest.fixture(name="folder")
def folder_of_the_page(tmp_path: Path) -> Path:
    (tmp_path / "problems").mkdir()
    for number in range(120):
        (tmp_path / "problems" / f"p{number}.toml").write_text(design(number), "utf-8")
    (cart,) = re.findall(r"`cart\.toml`:\n\n```toml\n(.*?)^```", PAGE, re.MULTILINE | re.DOTALL)
    (tmp_path / "cart.toml").write_text(cart, "utf-8")
    return tmp_path


def started(line: str, folder: Path, port: int = 8786) -> subprocess.Popen[str]:
    program, *words = shlex.split(line.replace("8786", str(port)))
    command = [*PROGRAMS[program], *words]
    with (folder / "log.txt").open("a", encoding="utf-8") as log:
        return subprocess.Popen(command, cwd=folder, env=environment(), stdout=log, stderr=log, text=True)


def test_its_lines_for_one_machine(folder: Path) -> None:
    for path in sorted((folder / "problems").iterdir())[4:]:
        path.unlink()
    for line in (*HERE, *GRID):
        with started(line, folder) as process:
            assert process.wait(timeout=SAFETY) == 0, (line, (folder / "log.txt").read_text("utf-8"))
    assert len(list((folder / "results" / "files").rglob("*.tex"))) == 4
    assert len((folder / "designs.csv").read_text("utf-8").splitlines()) == 81
