"""Sheets a second: all worked examples from their text to a page, in one process."""

from __future__ import annotations

import time
from collections import Counter
from typing import TYPE_CHECKING

from symobs.problem import parse, validate
from symobs.tasks.result import render
from tests.programs.benchmarks.measuring import Row
from tests.support.paths import ROOT

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from tests.programs.benchmarks.measuring import Settings

PLACE = 7
_FORMATS = ("html", "text", "json", "latex")


def rows(_: Settings) -> Iterator[Row]:
    """Yield how many problems a second come to a page in each format, and which take longest to LaTeX."""
    files = sorted((ROOT / "worked_examples").glob("*.toml"))
    spent: Counter[str] = Counter()
    single: dict[str, float] = {}
    for file in files:
        times = spent_on(file)
        spent.update(times)
        single[file.stem] = times["latex"]
    for name in _FORMATS:
        yield Row(f"{len(files)} worked examples to {name}", len(files) / spent[name], unit="problems/s")
    for name in sorted(single, key=lambda stem: -single[stem])[:3]:
        yield Row(f"longest to LaTeX: {name}", single[name])


def spent_on(file: Path) -> dict[str, float]:
    """Return the processor time from a file to each format; what they share counts for each."""
    start = time.process_time()
    problem = validate(parse(file.read_text("utf-8"), str(file)), None, file.parent)
    document = problem.document(problem.solve())
    solved = time.process_time()
    _ = document.derivations
    told = time.process_time()
    found = {}
    for name in _FORMATS:
        before = time.process_time()
        render(document, name)
        found[name] = time.process_time() - before + (solved if name == "json" else told) - start
    return found
