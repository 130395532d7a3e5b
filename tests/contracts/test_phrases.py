"""Phrases are data beside their task: tables of literals, found by listing, which load no code of the floors they lie on."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
import tomllib
from functools import cache
from typing import TYPE_CHECKING

import pytest

from symobs.formula.phrases import PHRASES, RESTS_ON, THEOREMS
from symobs.formula.phrases.english import question_phrases
from symobs.formula.phrases.literature import LITERATURE, bibliography, cited
from symobs.tasks.result import Task, methods, tasks
from tests.kit import tabled
from tests.support.examples import document_of
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from pathlib import Path

FILES = sorted((ROOT / "symobs").rglob("*_phrases.py"))
TABLES = {"PHRASES", "QUESTIONS", "ASSERTS", "DEMANDS", "ROWS", "RESTS_ON", "THEOREMS", "FIGURES", "WORDS", "COUNTS"}
LISTS = {"NAMING", "OPENS", "EXPLAINS", "BESIDE", "SPELLS_OUT", "UNSAID", "CONTINUES"}
TASKS = sorted(tasks().values(), key=lambda task: task.name)


def faults(source: str) -> list[str]:
    """What in a module of phrases is no docstring, no table that the catalogue reads, or no literal."""
    docstring, *rest = ast.parse(source).body
    found = [] if isinstance(docstring, ast.Expr) else ["no docstring"]
    for node in rest:
        match node:
            case ast.ImportFrom(module="__future__"):
                continue
            case ast.AnnAssign(target=ast.Name(id=name), value=ast.Dict() as value) if name in TABLES:
                pass
            case ast.Assign(targets=[ast.Name(id=name)], value=ast.Tuple() as value) if name in LISTS:
                pass
            case _:
                found.append(f"{node.lineno}: {ast.unparse(node)[:60]}")
                continue
        found += [f"{name}: {ast.unparse(part)[:60]}" for part in ast.walk(value) if not is_literal(part)]
    return found


def is_literal(node: ast.AST) -> bool:
    """Whether a node is a constant, a tuple, or a table without another one spread in it."""
    return isinstance(node, ast.Constant | ast.Tuple | ast.Load) or (
        isinstance(node, ast.Dict) and None not in node.keys
    )


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_a_module_of_phrases_contains_only_literal_tables(path: Path) -> None:
    assert faults(path.read_text("utf-8")) == []


@tabled
def test_what_is_no_literal_table_is_seen(source: str) -> None:
    assert faults(source)


def test_every_phrase_is_found() -> None:
    written = [key for path in FILES for key in keys_of(path)]
    assert sorted(written) == sorted(PHRASES)
    assert question_phrases.PHRASES.keys() < PHRASES.keys()


def keys_of(path: Path) -> list[str]:
    """The keys of the phrases in a file."""
    tree = ast.parse(path.read_text("utf-8"))
    return [
        key
        for node in tree.body
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
        if node.target.id in {"PHRASES", "QUESTIONS"} and isinstance(node.value, ast.Dict)
        for key in (part.value for part in node.value.keys if isinstance(part, ast.Constant))
        if isinstance(key, str)
    ]


def test_every_theorem_is_appealed_to_and_none_is_missing() -> None:
    assert set(RESTS_ON.values()) == THEOREMS.keys()


def test_what_theorems_and_methods_cite_is_in_the_literature() -> None:
    sources = [THEOREMS[name] for name in THEOREMS]
    sources += [found.source for name in tasks() for found in methods(name).values()]
    keys = {key for source in sources for key, _ in cited(source)}
    own_words = {"definition", "least-squares estimate", "standard: equating coefficients"}
    assert keys - own_words - {"second-order step response"} <= LITERATURE.keys()
    assert LITERATURE.keys() <= keys


def test_the_bibliography_has_an_entry_for_every_work() -> None:
    entries = bibliography(LITERATURE)
    assert re.findall(r"^@(\w+)\{(\w+),$", entries, re.MULTILINE) == [
        (kind, key) for key, (kind, _) in sorted(LITERATURE.items())
    ]
    assert "  author = {S. P. Bhattacharyya and E. de Souza}," in entries
    assert "  author = {R. E. Kalman and Y. C. Ho and K. S. Narendra}," in entries
    assert "  pages = {261--263}," in entries


def test_the_phrases_bring_no_code_with_them() -> None:
    code = "import sys, symobs.formula.phrases; print(*(m for m in sys.modules if m.startswith('symobs.')))"
    run = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    loaded = [name for name in run.stdout.split() if not name.endswith("_phrases")]
    folders = [name for name in loaded if not name.startswith("symobs.formula.phrases")]
    for name in folders:
        path = ROOT.joinpath(*name.split("."), "__init__.py")
        assert [type(node) for node in ast.parse(path.read_text("utf-8")).body] == [ast.Expr], name


# -- what a task owns ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
def test_a_task_owns_its_phrases_and_its_question(task: Task) -> None:
    folder = ROOT.joinpath(*task.function.__module__.split(".")).parent
    to_write = (folder / f"{task.name}_phrases.py").relative_to(ROOT)
    mine = [path for path in folder.glob("*_phrases.py") if f"ask {task.name}" in keys_of(path)]
    assert mine, f"{task.name} has no question: write {to_write} with QUESTIONS = {{'ask {task.name}': ...}}"
    assert any(key.split()[0] not in {"ask", "also"} for path in folder.glob("*_phrases.py") for key in keys_of(path))


@cache
def examples() -> dict[str, Path]:
    """The shortest worked example of every task."""
    found: dict[str, Path] = {}
    for path in sorted(ROOT.glob("worked_examples/*.toml"), key=lambda path: path.stat().st_size):
        problem = tomllib.loads(path.read_text("utf-8"))
        for name in (problem.get("task"), *problem.get("tasks", ())):
            found.setdefault(name, path)
    return found


@pytest.mark.parametrize("task", TASKS, ids=lambda task: task.name)
def test_a_task_has_a_worked_example_with_a_page(task: Task) -> None:
    assert task.name in examples(), f"{task.name} has no example: write worked_examples/{task.name}.toml"
    assert document_of(examples()[task.name].stem).derivations
