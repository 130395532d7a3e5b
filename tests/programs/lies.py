"""Lies about random designs: `python -m tests.programs.lies --designs 1000 [--lines 60] [--log PATH]`.

With `--examples` about the worked examples instead; with `--match NAME` about some of them.
Every entry of every answer and witness is changed in every way of `tests.support.tampering.mutations`, and of the lines of
the page as many as are asked for, at even distances (all with `--lines 0`).  What is not rejected must be true as well by
other means.
"""

from __future__ import annotations

import argparse
import itertools
import sys
from collections import defaultdict
from pathlib import Path
from random import Random
from typing import TYPE_CHECKING

from symobs.ground.errors import DerivationRejected, SymobsError
from symobs.problem import read
from tests.support.derivations import is_true
from tests.support.paths import ROOT
from tests.support.problems.random_problems import Tables, problem, to_toml
from tests.support.tampering.lies import Count, try_answers, try_lines, try_witnesses
from tests.support.tampering.mutations import parts_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.tasks.result import Result

#: What is asked: tasks with a plant whose claims are held in plain fractions or by SymPy.
ASKED = (
    "observer",
    "state_feedback",
    "compensator",
    "observability",
    "controllability",
    "reduced_order_observer",
    "tracking",
    "detectability",
    "stabilizability",
    "transfer_function",
    "characteristic_polynomial",
    "canonical_form",
    "decomposition",
    "dual",
    "pbh",
    "feedforward",
)
KINDS = ("numeric", "parametric", "defective", "hidden", "discrete", "feedthrough", "several")
ALL = 10**9


def drawn(number: int) -> Tables:
    """Return the problem of a number: all kinds of plants and all questions in turn."""
    random, kind = Random(f"design {number}"), KINDS[number % len(KINDS)]  # noqa: S311 - test plants, no secrets
    task = ASKED[number // len(KINDS) % len(ASKED)]
    return problem(random, [task], [kind if (task, kind) != ("feedforward", "several") else "numeric"])


def try_result(result: Result, label: str, answers: Count, lines: Count, most_lines: int) -> None:
    """Tell all lies about one result."""
    for where, part in parts_of(result, f"{label} "):
        try_answers(part, where, answers, ALL)
        try_witnesses(part, where, answers, ALL)
    before = len(lines.lies)
    try:
        result.derivation.check()
    except DerivationRejected as error:
        lines.lies.append(f"{label}: its own page is refused: {error}")
        return
    if not is_true(result.derivation):
        lines.lies.append("its own page is not true at random points")
    try_lines(result, lines, most_lines or ALL)
    lines.lies[before:] = [f"{label}: {lie}" for lie in lines.lies[before:]]


def tried(numbers: Sequence[int], most_lines: int) -> Iterator[tuple[Tables, Count, Count]]:
    """Yield each design with what became of the lies about its answers and its lines; refused questions are left out."""
    for number in numbers:
        design, answers, lines = drawn(number), Count(), Count()
        try:
            (result,) = read(to_toml(design)).solve()
        except SymobsError:
            continue
        label = f"design {number} ({design['task']})"
        try_result(result, label, answers, lines, most_lines)
        yield design, answers, lines


def tried_examples(match: str, most_lines: int) -> Iterator[tuple[str, Count, Count]]:
    """Yield each worked example with what became of the lies about it, the shortest first."""
    files = (ROOT / "worked_examples").glob("*.toml")
    for path in sorted((path for path in files if match in path.stem), key=lambda path: path.stat().st_size):
        answers, lines = Count(), Count()
        for result in read(path.read_text(encoding="utf-8")).solve():
            try_result(result, path.stem, answers, lines, most_lines)
        yield path.stem, answers, lines


def main(arguments: Sequence[str]) -> int:
    """Tell lies about random designs; 1 where one survives."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.lies", description=__doc__)
    parser.add_argument("--designs", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--examples", action="store_true", help="the worked examples instead")
    parser.add_argument("--match", default="", help="a part of an example's name")
    parser.add_argument("--lines", type=int, default=0, help="how many changes of the lines of a page, 0 for all")
    parser.add_argument("--log", type=Path, help="a file for the figures as they grow")
    chosen = parser.parse_args(arguments)
    table = Table(chosen.log)
    if chosen.examples:
        for name, answers, lines in tried_examples(chosen.match, chosen.lines):
            table.add(name, answers, lines)
    else:
        numbers = itertools.count(chosen.first)
        while table.designs < chosen.designs:
            for design, answers, lines in tried([next(numbers)], chosen.lines):
                table.add(design["task"], answers, lines)
    print(table)
    return int(bool(table.survived))


class Table:
    """The figures as they grow: by what was asked, and all together."""

    def __init__(self, log: Path | None) -> None:
        self.log = log
        self.rows: dict[str, list[int]] = defaultdict(lambda: [0, 0, 0, 0, 0])
        self.survived: list[str] = []

    @property
    def designs(self) -> int:
        """How many designs were lied about."""
        return self.rows["all answers"][0]

    def add(self, name: str, answers: Count, lines: Count) -> None:
        """Add what became of the lies about one design, and write all down."""
        for kind, count in (("answers", answers), ("lines", lines)):
            for key in (f"{name}, {kind}", f"all {kind}"):
                numbers = (1, count.tried, count.rejected, count.true, len(count.lies))
                self.rows[key] = [old + new for old, new in zip(self.rows[key], numbers, strict=True)]
            self.survived += count.lies
        if self.log:
            self.log.write_text(f"{self}\n", encoding="utf-8")

    def __str__(self) -> str:
        head = "".join(f"{word:>10}" for word in ("designs", "tried", "rejected", "true", "survived"))
        rows = [f"{key:50}" + "".join(f"{number:10}" for number in row) for key, row in sorted(self.rows.items())]
        return "\n".join([" " * 50 + head, *rows, *self.survived])


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
