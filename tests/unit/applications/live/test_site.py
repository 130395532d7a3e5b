"""The static site: what is packed, what is refused; `programs/live_site.py` holds its answers against those of the engine."""

from __future__ import annotations

import json
import re
import subprocess
import sys
import zipfile
from typing import TYPE_CHECKING

import pytest

from symobs.applications.live.site import build
from symobs.applications.live.site.__main__ import main
from tests.support.tools.command_line import SAFETY, environment

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

RUNTIME = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")


@pytest.fixture(name="given")
def stand_ins(tmp_path: Path) -> tuple[Path, Path]:
    """A folder and a wheel with the names of what the registries have, and nothing in them."""
    pyodide, wheel = tmp_path / "pyodide", tmp_path / "python_flint-1-cp314-cp314-pyemscripten_2026_0_wasm32.whl"
    pyodide.mkdir()
    for name in RUNTIME:
        (pyodide / name).write_text(name)
    (pyodide / "package.json").write_text('{"version": "1.2.3"}')
    with zipfile.ZipFile(wheel, "w") as archive:
        archive.writestr("flint/__init__.py", "")
    return pyodide, wheel


def test_the_folder_holds_everything_that_it_asks_for(given: tuple[Path, Path], tmp_path: Path) -> None:
    out = tmp_path / "out"
    size = build(out, *given)
    files = {path.relative_to(out).as_posix(): path for path in out.rglob("*") if path.is_file()}
    assert size == sum(path.stat().st_size for path in files.values())
    contents = json.loads(files["contents.js"].read_text().removeprefix("self.CONTENTS = ").rstrip(";\n"))
    assert set(contents["files"]) == {"./", *files} - {"THIRD-PARTY.txt"}
    assert contents["wheel"] in files
    asked = set(_asked(out))
    assert {"start-wasm.js", "symobs-live.js", "live.css", "worker.js", "offline.js", "symobs.zip"} <= asked
    assert asked - set(files) - {"pyodide/"} == set()
    page = files["index.html"].read_text("utf-8")
    assert "script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self';" in page
    assert "<math" in page.partition('class="first"')[2]  # there is something to read while Python is loaded
    whole = "".join(path.read_text("utf-8") for name, path in files.items() if name.endswith(("html", "js", "css")))
    assert "https:" not in whole
    assert "eval(" not in whole
    assert "Pyodide 1.2.3" in files["THIRD-PARTY.txt"].read_text()
    before = {name: path.read_bytes() for name, path in files.items()}
    build(out, *given)  # it may be written again, and is the same
    assert before == {path.relative_to(out).as_posix(): path.read_bytes() for path in out.rglob("*") if path.is_file()}


def _asked(out: Path) -> Iterator[str]:
    """Every file that the page and its scripts name."""
    for path in (out / "index.html", *out.glob("*.js")):
        text = path.read_text("utf-8")
        yield from re.findall(r'(?:src|href)="([\w./-]+)"', text)
        yield from re.findall(r'(?:from|import|here\(|importScripts\(|Worker\(|register\() ?"(?:\./)?([\w./-]+)"', text)


@pytest.mark.slow
def test_the_packed_package_answers_by_itself(given: tuple[Path, Path], tmp_path: Path) -> None:
    build(tmp_path / "out", *given)
    with zipfile.ZipFile(tmp_path / "out" / "symobs.zip") as archive:
        archive.extractall(tmp_path / "packed")
    program = """
import json, symobs
from symobs.applications.live.child import respond
plant, poles = {"A": "[0 1; 0 -1]", "C": "[1 0]"}, {"poles": "-10, -10"}
for want in ({"want": "start"}, {"want": "page"}, {"want": "export", "as": "latex"}, {"want": "answer"}):
    problem = {"task": "observer", "plant": plant, "specification": poles}
    found = json.loads(respond(json.dumps({"schema": "symobs-live/1", "problem": problem, **want}).encode()))
    print(found["status"], len(found.get("examples", [])) > 50, found.get("result", {}).get("L"))
print(symobs.__file__)
"""
    command = [sys.executable, "-P", "-c", program]
    run = subprocess.run(
        command,
        env=environment() | {"PYTHONPATH": str(tmp_path / "packed")},
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=SAFETY,
        check=False,
    )
    assert run.stdout.splitlines() == [
        "done True None",
        "done False None",
        "done False None",
        "done False [['19'], ['81']]",
        str(tmp_path / "packed" / "symobs" / "__init__.py"),
    ], run.stderr


def test_what_is_something_else_is_refused_before_anything_is_written(
    given: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pyodide, wheel = given
    out = tmp_path / "out"
    with pytest.raises(ValueError, match=r"not a wheel for WebAssembly"):
        build(out, pyodide, pyodide / "python_stdlib.zip")
    (pyodide / "pyodide.asm.wasm").unlink()
    with pytest.raises(ValueError, match=r"pyodide.asm.wasm missing; give the folder of the npm package"):
        build(out, pyodide, wheel)
    assert not out.exists()
    (pyodide / "pyodide.asm.wasm").write_text("")
    out.mkdir()
    (out / "mine.txt").write_text("kept")
    monkeypatch.setattr(sys, "argv", ["site", str(out), "--pyodide", str(pyodide), "--flint", str(wheel)])
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 2
    assert "something else in this folder; give a new one" in capsys.readouterr().err
    assert [path.name for path in out.iterdir()] == ["mine.txt"]


def test_an_installed_package_is_packed_once(
    given: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("__init__.py", "worked_examples/servo.toml", "latex_templates/article.tex"):
        (tmp_path / "symobs" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "symobs" / name).write_text("")
    monkeypatch.setattr("symobs.applications.live.site._PACKAGE", tmp_path / "symobs")
    build(tmp_path / "out", *given)
    with zipfile.ZipFile(tmp_path / "out" / "symobs.zip") as archive:
        names = archive.namelist()
    assert "symobs/worked_examples/servo.toml" in names
    assert len(names) == len(set(names))
