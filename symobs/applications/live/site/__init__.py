"""The static site: the live page with Python in the browser, packed from files that were fetched before.

The folder it writes can be served by any static server; nothing else is asked for, and what it answers is computed by the
same code as on a server, in WebAssembly.
"""

from __future__ import annotations

import hashlib
import json
import shutil
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

from symobs.applications.live.assets import ASSETS, script, style
from symobs.applications.live.beginning import SERVO
from symobs.applications.live.page import page_object
from symobs.problem import validate

if TYPE_CHECKING:
    from collections.abc import Iterator

_HERE = Path(__file__).parent
_PACKAGE = _HERE.parents[2]
#: Folders which an installed package holds itself; in a checkout they lie beside it.
_DATA = ("worked_examples", "latex_templates")
_KINDS = {".py", ".css", ".json", ".toml", ".tex"}
_RUNTIME = ("pyodide.mjs", "pyodide.asm.mjs", "pyodide.asm.wasm", "python_stdlib.zip", "pyodide-lock.json")
#: What answers need: not the command line, nor what runs many problems or checks what others wrote.
_NEEDLESS = {"cli", "batch", "checking", "export", "variants", "audit", "site", "course", "__pycache__"}
#: Scripts come from here alone, and WebAssembly is compiled; nothing else is run, and nobody else is asked.
POLICY = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; connect-src 'self'; "
    "style-src 'self' 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"
)
#: Where the parts come from, as docs/live.md says it.
_FETCHED = """\
fetch them with
  npm install --ignore-scripts pyodide@314.0.7
  pip download --no-deps --only-binary=:all: --platform pyemscripten_2026_0_wasm32 --python-version 314 python-flint"""
_THIRD = """\
This site carries, as their makers publish them:

Jinja and MarkupSafe, in symobs.zip, BSD-3-Clause.

Pyodide {pyodide}, in pyodide/, MPL-2.0: CPython (PSF-2.0) compiled to WebAssembly.
python-flint, in {wheel}, MIT; the wheel holds FLINT (LGPL-3.0-or-later), GMP (LGPL-3.0-or-later or
GPL-2.0-or-later) and MPFR (LGPL-3.0-or-later) as separate shared libraries, unmodified, with their
licences; a wheel with other builds of them may take its place, named in contents.js.
"""


def build(out: Path, pyodide: Path, flint: Path) -> int:
    """Write the site into a folder and return its size in bytes.

    pyodide   the folder of the npm package of that name
    flint     the wheel of python-flint for the same Pyodide
    Raises `ValueError` with all that is wrong with them, before anything is written.
    """
    wrong = [*_wrong_runtime(pyodide), *_wrong_wheel(flint)]
    if wrong:
        wrong.append(_FETCHED)
    if out.exists() and any(out.iterdir()) and not (out / "contents.js").is_file():
        wrong.append(f"{out}: there is something else in this folder; give a new one")
    if wrong:
        raise ValueError("\n".join(wrong))
    shutil.rmtree(out, ignore_errors=True)
    (out / "pyodide").mkdir(parents=True)
    for name in _RUNTIME:
        shutil.copyfile(pyodide / name, out / "pyodide" / name)
    shutil.copyfile(flint, out / flint.name)
    for path in _HERE.glob("*.js"):
        shutil.copyfile(path, out / path.name)
    page = _page((ASSETS / "http.html").read_text(encoding="utf-8"))
    for name, text in (("symobs-live.js", script()), ("live.css", style()), ("index.html", page)):
        (out / name).write_text(text, encoding="utf-8")
    version = json.loads((pyodide / "package.json").read_text(encoding="utf-8"))["version"]
    (out / "THIRD-PARTY.txt").write_text(_THIRD.format(pyodide=version, wheel=flint.name), encoding="utf-8")
    _pack(out / "symobs.zip")
    files = sorted(path for path in out.rglob("*") if path.is_file())
    told = hashlib.sha256(b"".join(hashlib.sha256(path.read_bytes()).digest() for path in files)).hexdigest()[:16]
    names = ["./", "contents.js", *(path.relative_to(out).as_posix() for path in files if path.suffix != ".txt")]
    contents = {"version": f"symobs-live-{told}", "wheel": flint.name, "files": names}
    (out / "contents.js").write_text(f"self.CONTENTS = {json.dumps(contents, indent=1)};\n", encoding="utf-8")
    return sum(path.stat().st_size for path in out.rglob("*") if path.is_file())


def _wrong_runtime(folder: Path) -> Iterator[str]:
    """Yield what is wrong with the folder of the npm package."""
    absent = [name for name in (*_RUNTIME, "package.json") if not (folder / name).is_file()]
    if not folder.is_dir():
        yield f"--pyodide: there is no folder {folder}"
    elif absent:
        yield f"--pyodide: {folder}: {', '.join(absent)} missing; give the folder of the npm package pyodide"


def _wrong_wheel(wheel: Path) -> Iterator[str]:
    """Yield what is wrong with the wheel."""
    if not wheel.is_file():
        yield f"--flint: there is no file {wheel}"
    elif not zipfile.is_zipfile(wheel) or not wheel.name.endswith("wasm32.whl"):
        yield f"--flint: {wheel}: not a wheel for WebAssembly; give python_flint-…_wasm32.whl"


def _page(text: str) -> str:
    """Return the page of the server with the site's policy, its script, what is being loaded, and a derivation meanwhile."""
    policy = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">'
    changes = (
        ('<meta charset="utf-8">', f'<meta charset="utf-8">\n{policy}'),
        ("start-http.js", "start-wasm.js"),
        (
            "<main></main>",
            f'<p role="status" class="loading">Loading …</p>\n<main></main>\n<article class="first">{_first()}</article>',
        ),
    )
    for before, after in changes:
        if text.count(before) != 1:
            raise ValueError(f"http.html: {before} is expected once")
        text = text.replace(before, after)
    return text


def _first() -> str:
    """Return the derivation of the problem that the page begins with, to be read while Python is loaded."""
    data = {
        "task": "compensator",
        "plant": SERVO,
        "specification": {"control_poles": "-2, -2", "observer_poles": "-10, -10"},
    }
    problem = validate(data)
    return str(page_object(problem, problem.solve()[-1], "outline")["html"])


def _pack(path: Path) -> None:
    """Write what answers need of the package, its data, and what its documents are made with; the same bytes every time."""
    import jinja2  # noqa: PLC0415 - only what is packed
    import markupsafe  # noqa: PLC0415

    folders = {_PACKAGE: "symobs"}
    for name in _DATA:
        if not (_PACKAGE / name).is_dir():
            folders[_PACKAGE.parent / name] = f"symobs/{name}"
    for module in (jinja2, markupsafe):
        folders[Path(str(module.__file__)).parent] = module.__name__
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        for folder, name in folders.items():
            for file in sorted(folder.rglob("*")):
                parts = file.relative_to(folder).parts
                if file.suffix in _KINDS and not _NEEDLESS.intersection(parts):
                    entry = zipfile.ZipInfo("/".join((name, *parts)))
                    archive.writestr(entry, file.read_bytes(), zipfile.ZIP_DEFLATED)
