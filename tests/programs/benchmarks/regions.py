"""Regions of stability beside QEPCAD: `python -m tests.programs.benchmarks.regions` prints a line for each problem.

symobs is timed in process from the text of the polynomial to the JSON of the checked result, with names that
no earlier repetition used, and as a process of its own (`solve`).  QEPCAD is given the strict inequalities of Liénard and
Chipart, which it does not have to make itself, in the form and with the order of variables it is fastest in; "alone" is
without its start-up: 101 times the same in one process less once, divided by 100 (8 where it is slow).  These two are
processor time; whole processes are wall time.  Three ratios: QEPCAD alone over symobs in process, QEPCAD as a process
over symobs in process (what a program in Python waits for), and process over process.
"""

from __future__ import annotations

import argparse
import gc
import itertools
import re
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING

from tests.programs.benchmarks import other_systems, qepcad
from tests.support.independent_algebra.region_algebra import TRUE
from tests.support.regions import region_answers, region_checks
from tests.support.regions.region_problems import PROBLEMS, by_name

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from tests.support.regions.region_problem import Problem
    from tests.support.regions.region_proofs import Proof

_SERIAL = itertools.count()
_SIGNIFICANT = 0.0005  # less than this the clocks do not tell from nothing


@dataclass(frozen=True)
class Measured:
    """What one problem took, in seconds; None where it gave no answer."""

    problem: Problem
    ours: float | None
    process: float | None
    alone: float | None
    started: float | None
    proofs: Mapping[str, Proof] = field(default_factory=dict)

    @property
    def ratio(self) -> float | None:
        """QEPCAD without its start-up over symobs in process."""
        return self.alone / self.ours if self.alone is not None and self.ours else None

    @property
    def ratio_with_start(self) -> float | None:
        """QEPCAD as a process over symobs in process."""
        return self.started / self.ours if self.started is not None and self.ours else None

    @property
    def ratio_of_processes(self) -> float | None:
        """QEPCAD as a process over symobs as a process."""
        return self.started / self.process if self.started is not None and self.process else None

    @property
    def verdict(self) -> str:
        """What was proved of each part of the answer; where they differ, the point."""
        told = [
            f"{part} {proof}" + (f" at {dict(proof.point)}" if proof.point and proof.verdict == "different" else "")
            for part, proof in self.proofs.items()
        ]
        if told and all(proof.verdict == "same" for proof in self.proofs.values()):
            by = sorted({name for proof in self.proofs.values() for name in proof.by.split(", ") if name})
            return f"same: {', '.join(self.proofs)} ({', '.join(by)})"
        return "; ".join(told)


def renamed(problem: Problem) -> Problem:
    """Return the problem with names that no earlier one had, so that nothing remembered serves it."""
    suffix = f"_{next(_SERIAL)}"
    fresh = {name: name + suffix for name in problem.names}
    text = re.sub(r"[A-Za-z]\w*", lambda match: fresh.get(match.group(), match.group()), problem.text)
    symbols = {fresh[name]: sign for name, sign in problem.symbols.items()}
    return replace(problem, text=text, parameters=tuple(fresh[name] for name in problem.parameters), symbols=symbols)


def ours(problem: Problem, repetitions: int) -> float:
    """Return the median time from text to JSON."""
    found = []
    for _ in range(repetitions + 1):  # at the first, what is imported late comes in
        other = renamed(problem)
        gc.collect()
        start = time.process_time()
        region_answers.call(other).to_json()
        found.append(time.process_time() - start)
    return statistics.median(found[1:])


def problem_file(problem: Problem) -> str:
    """Return the problem as a file for the command line."""
    keywords = dict(problem.keywords)
    lines = ['task = "stability_region"', ""]
    for title, entries in (
        ("plant", {"dt": "true"} if keywords.pop("dt", False) else {}),
        ("symbols", {name: f'"{sign}"' for name, sign in keywords.pop("symbols", {}).items()}),
    ):
        if entries:
            lines += [f"[{title}]", *(f"{key} = {value}" for key, value in entries.items()), ""]
    names = ", ".join(f'"{name}"' for name in keywords.pop("parameters"))
    lines += ["[specification]", f'polynomial = "{problem.text}"', f"parameters = [{names}]"]
    return "\n".join([*lines, *(f'{key} = "{value}"' for key, value in keywords.items()), ""])


def as_process(problem: Problem, limit: float = 60) -> float | None:
    """Return the wall time of `symobs solve` on a file, the second time; None where it fails."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "problem.toml"
        path.write_text(problem_file(problem), encoding="utf-8")
        command = ["env", "-u", "PYTHONDONTWRITEBYTECODE", sys.executable, "-m", "symobs", "solve", str(path)]
        done = [other_systems.run([*command, "--format", "json"], limit) for _ in range(2)][-1]  # the first compiles
    return done.wall if done is not None and '"stable_if"' in done.output else None


def best_of_qepcad(problem: Problem, repetitions: int, limit: float) -> tuple[float | None, float | None]:
    """Return what QEPCAD's fastest formulation takes alone, and the median of it as a process."""
    tried = {name: qepcad.seconds(question, limit) for name, question in qepcad.inequalities(problem)}
    answered = {name: seconds for name, seconds in tried.items() if seconds is not None}
    if not answered:
        return None, None
    fastest = min(answered, key=lambda name: answered[name])
    question = dict(qepcad.inequalities(problem))[fastest]
    replies = [reply for _ in range(repetitions) if (reply := qepcad.ask(question, limit)) is not None]
    return answered[fastest], statistics.median(reply.run.wall for reply in replies) if replies else None


def measure(problem: Problem, repetitions: int, limit: float) -> Measured:
    """Time both on a problem, and hold one answer against the other."""
    own, answer = ours(problem, repetitions), region_answers.ask(problem)
    process = as_process(problem)
    if not other_systems.available("qepcad"):
        return Measured(problem, own, process, None, None)
    alone, started = best_of_qepcad(problem, repetitions, limit)
    truth = region_checks.truth_of(problem, limit)
    proofs = dict(region_checks.proofs(problem, answer, truth, min(limit, 20))) if truth is not None else {}
    return Measured(problem, own, process, alone, started, proofs)


def start_up(repetitions: int) -> float | None:
    """Return the median wall time of QEPCAD on nothing to speak of."""
    question = qepcad.Question(("h",), (), TRUE)
    replies = [reply for _ in range(repetitions) if (reply := qepcad.ask(question)) is not None]
    return statistics.median(reply.run.wall for reply in replies) if replies else None


def median(ratios: Iterable[float | None]) -> float | None:
    """Return the median of the ratios there are."""
    found = [ratio for ratio in ratios if ratio is not None]
    return statistics.median(found) if found else None


def table(rows: Sequence[Measured]) -> str:
    """Return the rows in columns, the medians of the ratios below."""
    head = (
        "problem",
        "symobs",
        "solve",
        "QEPCAD alone",
        "QEPCAD",
        "alone/in process",
        "QEPCAD/in process",
        "QEPCAD/solve",
    )
    lines: list[tuple[str, ...]] = [(*head, "")]
    ratios = [(row.ratio, row.ratio_with_start, row.ratio_of_processes) for row in rows]
    for row, of_row in zip(rows, ratios, strict=True):
        times = (row.ours, row.process, row.alone, row.started)
        lines.append((row.problem.name, *map(_milliseconds, times), *map(_ratio, of_row), row.verdict))
    middle = [median(column) for column in zip(*ratios, strict=True)]
    lines.append(("median", "", "", "", "", *map(_ratio, middle), ""))
    widths = [max(len(line[column]) for line in lines) for column in range(len(head) + 1)]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines
    )


def _milliseconds(seconds: float | None) -> str:
    if seconds is None:
        return "-"
    return f"{1000 * seconds:.3g} ms" if seconds >= _SIGNIFICANT else f"< {1000 * _SIGNIFICANT:g} ms"


def _ratio(ratio: float | None) -> str:
    return "-" if ratio is None else f"{ratio:.3g}"


def measure_all(names: Sequence[str], repetitions: int, limit: float) -> Iterator[Measured]:
    """Yield all problems, or those named; what fails is named on standard error."""
    for problem in [by_name(name) for name in names] or PROBLEMS:
        print(f"  {problem.name} …", file=sys.stderr)
        yield measure(problem, repetitions, limit)


def main(arguments: Sequence[str] | None = None) -> None:
    """Time the problems and print the table."""
    parser = argparse.ArgumentParser(
        prog="python -m tests.programs.benchmarks.regions", description="Regions beside QEPCAD."
    )
    parser.add_argument(
        "names", nargs="*", help="problems of tests/support/regions/region_problems.py; all where none is named"
    )
    parser.add_argument("--repetitions", type=int, default=5, help="how often each runs (5)")
    parser.add_argument("--limit", type=float, default=60, help="seconds QEPCAD may take (60)")
    given = parser.parse_args(arguments)
    rows = list(measure_all(given.names, given.repetitions, given.limit))
    print(table(rows))
    seconds = start_up(given.repetitions)
    if seconds is not None:
        print(f"QEPCAD's start-up: {1000 * seconds:.3g} ms")


if __name__ == "__main__":
    main()
