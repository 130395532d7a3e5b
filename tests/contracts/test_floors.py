"""What the linters of the lint step do not see: text never becomes code, kernels load late, trusted code stays short."""

from __future__ import annotations

import ast
import subprocess
import sys
from typing import TYPE_CHECKING

from tests.kit import tabled
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator

SOURCES = sorted((ROOT / "symobs").rglob("*.py"))
TEXTS = {path.relative_to(ROOT).as_posix(): path.read_text("utf-8") for path in SOURCES}
#: The lines without imports of all modules that say "(trusted)" at their beginning: whoever audits the checks reads these.
#: 35 of them are for loops with a dead time, whose crossings, counts and pictures no other check covers.
MOST_TRUSTED = 5368
#: Who loads modules by name: the package, what is imported late, the registry, the command line, the tables of phrases
#: and of kinds of work.
BY_NAME = (
    "symobs/__init__.py",
    "symobs/ground/later.py",
    "symobs/tasks/result/",
    "symobs/cli/",
    "symobs/formula/phrases/catalogue.py",
    "symobs/applications/batch/jobs.py",
)
LATE = {"control", "distributed", "flint", "matplotlib", "mpmath", "numpy", "pyarrow", "scipy", "sympy", "z3"}


def trespasses(place: str, source: str) -> Iterator[str]:
    """Every call that turns text into code, SymPy at work outside of the kernel, and modules loaded by name."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        match node:
            case ast.Call(func=ast.Name(id="compile" | "eval" | "exec" | "__import__" | "S" as word)):
                yield f"{place}:{node.lineno}: calls {word}"
            case ast.FunctionDef() if not place.startswith("symobs/exact/") and "sympy" in _imported(node):
                yield f"{place}:{node.lineno}: only symobs/exact works with SymPy"
            case _:
                pass
    if not place.startswith(BY_NAME) and {"importlib", "importlib.util", "pkgutil", "runpy"} & _imported(tree):
        yield f"{place}: loads modules by name"


def _imported(tree: ast.AST) -> set[str]:
    nodes = [*ast.walk(tree)]
    names = {alias.name for node in nodes if isinstance(node, ast.Import) for alias in node.names}
    return names | {str(node.module) for node in nodes if isinstance(node, ast.ImportFrom)}


def test_nothing_trespasses() -> None:
    assert [fault for place, source in TEXTS.items() for fault in trespasses(place, source)] == []


@tabled
def test_a_trespass_is_seen(source: str) -> None:
    assert [*trespasses("symobs/system/plant.py", source)]


def test_what_is_trusted_stays_short() -> None:
    trusted = {place: _read_lines(text) for place, text in TEXTS.items() if "(trusted)" in text.partition("\n")[0]}
    assert {"check.py", "claims.py", "result.py", "wording_check.py"} <= {place.rpartition("/")[2] for place in trusted}
    assert sum(trusted.values()) <= MOST_TRUSTED, trusted


def _read_lines(text: str) -> int:
    """The lines of a module that are no imports."""
    nodes = (node for node in ast.walk(ast.parse(text)) if isinstance(node, (ast.Import, ast.ImportFrom)))
    return text.count("\n") - sum((node.end_lineno or 0) - node.lineno + 1 for node in nodes)


def test_importing_symobs_imports_nothing_heavy() -> None:
    code = f"import sys, symobs; print(*sorted({LATE!r} & sys.modules.keys()))"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert run.stdout.split() == []
