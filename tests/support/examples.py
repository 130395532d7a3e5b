"""The worked examples: each is read, solved and written out once in a process; its tests share a worker (see conftest)."""

from __future__ import annotations

from functools import cache
from typing import TYPE_CHECKING

from symobs.problem import Problem, read
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from symobs.tasks.result import Document, Result

EXAMPLES = sorted((ROOT / "worked_examples").glob("*.toml"))
NAMES = {path.stem: path for path in EXAMPLES}


@cache
def problem_of(name: str) -> Problem:
    path = NAMES[name]
    return read(path.read_text("utf-8"), path.name, path.parent)


@cache
def results_of(name: str) -> tuple[Result, ...]:
    return problem_of(name).solve()


@cache
def document_of(name: str) -> Document:
    return problem_of(name).document(results_of(name))


def example_of(values: object) -> str | None:
    """Return the worked example that one of the values of a test names, by its path or its stem."""
    named = (getattr(value, "stem", value) for value in values) if isinstance(values, (list, tuple)) else ()
    return next((name for name in named if isinstance(name, str) and name in NAMES), None)
