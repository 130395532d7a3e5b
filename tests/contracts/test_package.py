"""The wheel carries what the installed package needs, and nothing else."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from email import message_from_bytes
from typing import TYPE_CHECKING
from zipfile import ZipFile

import pytest

from tests.kit import tabled
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

SETTINGS = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
VERSION = SETTINGS["project"]["version"]
INFO = f"symobs-{VERSION}.dist-info"


@pytest.fixture(name="wheel", scope="module")
def built_wheel(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """The files of a freshly built wheel, by name."""
    folder = tmp_path_factory.mktemp("wheel")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", str(folder), str(ROOT)]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stdout + run.stderr
    (path,) = folder.glob("symobs-*-py3-none-any.whl")
    with ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def files_below(folder: Path) -> set[Path]:
    return {
        path.relative_to(folder) for path in folder.rglob("*") if path.is_file() and "__pycache__" not in path.parts
    }


@tabled
def test_a_folder_reaches_the_wheel_whole(wheel: dict[str, bytes], here: str, there: str) -> None:
    files = files_below(ROOT / here)
    assert files, f"{here}/ is empty"
    for file in files:
        assert wheel.get(f"{there}/{file.as_posix()}") == (ROOT / here / file).read_bytes(), file


def test_the_wheel_is_typed(wheel: dict[str, bytes]) -> None:
    assert "symobs/py.typed" in wheel


def test_the_wheel_holds_nothing_else(wheel: dict[str, bytes]) -> None:
    assert {name.split("/")[0] for name in wheel} == {"symobs", INFO}
    assert not [name for name in wheel if "__pycache__" in name]


def test_metadata(wheel: dict[str, bytes]) -> None:
    metadata = message_from_bytes(wheel[f"{INFO}/METADATA"])
    assert metadata["Name"] == "symobs"
    assert metadata["Version"] == VERSION
    assert metadata["Requires-Python"] == ">=3.11"
    assert metadata["License-Expression"] == "MIT"
    assert f"{INFO}/licenses/LICENSE" in wheel
    required = [line for line in metadata.get_all("Requires-Dist", []) if "extra ==" not in line]
    names = {line.split(">=")[0] for line in required}
    assert names == {"click", "jinja2", "mpmath", "numpy", "python-flint", "sympy"}
    extras = {"browser-test", "control", "distributed", "docs", "mcp", "notebook", "plot", "table", "test", "verify"}
    assert set(metadata.get_all("Provides-Extra", [])) == extras
    assert b"symobs = symobs.__main__:main" in wheel[f"{INFO}/entry_points.txt"]


def test_the_source_distribution_has_what_the_readme_links_to() -> None:
    included = SETTINGS["tool"]["hatch"]["build"]["targets"]["sdist"]["include"]
    assert [path for path in included if not (ROOT / path.lstrip("/")).exists()] == []
    links = re.findall(r"\]\((?!https?:)([^)#\s]+)\)", (ROOT / "README.md").read_text("utf-8"))
    assert links
    assert [link for link in links if not any(f"/{link}".startswith(path) for path in included)] == []


def test_the_citation_is_of_this_version() -> None:
    lines = (ROOT / "CITATION.cff").read_text("utf-8").splitlines()
    assert f"version: {VERSION}" in lines
    assert f"## [{VERSION}]" in (ROOT / "CHANGELOG.md").read_text("utf-8").splitlines()


@pytest.mark.parametrize("file", [".conda/recipe.yaml", "environment.yml"])
def test_conda_asks_for_what_the_project_asks_for(file: str) -> None:
    told = (ROOT / file).read_text("utf-8")
    lines = {line.strip().removeprefix("- ") for line in told.splitlines()}
    for wanted in SETTINGS["project"]["dependencies"]:
        assert wanted.replace(">=", " >=") in lines, wanted
    lowest = SETTINGS["project"]["requires-python"].removeprefix(">=")
    assert f"python >={lowest}" in lines or (f'python_min: "{lowest}"' in lines and f"version: {VERSION}" in lines)
