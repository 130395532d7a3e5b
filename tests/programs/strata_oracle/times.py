"""How long strata take: python -m tests.programs.strata_oracle.times --plants 100 --seconds 60.

Random plants of order three with two parameters and two inputs or outputs, each given one design task in a process of
its own.  The figures are CPU seconds; `generic` is the answer with its conditions, `whole` its JSON with all cases.
"""

from __future__ import annotations

import argparse
import json
import os
import resource
import sys
from collections import Counter
from random import Random
from statistics import median, quantiles
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.ground.errors import SymobsError
from symobs.pages.formats.json import result_object
from symobs.problem import validate
from symobs.problem.file_tables import parse

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

TASKS = ("compensator", "feedforward", "tracking", "reduced_order_observer")
_ENTRIES = ("0",) * 6 + ("1", "-1", "1", "a", "b", "a*b", "b+1", "a-1", "a+b")
_REFUSED = "refused"


class Run(NamedTuple):
    """CPU seconds of the generic answer and of the whole, None where it did not come, and strata without an answer."""

    seed: int
    task: str
    generic: float | None
    whole: float | None
    cases: int = 0
    undecided: int = 0


def drawn(seed: int) -> tuple[str, str]:
    """Return the task of a seed and the text of its problem."""
    random = Random(f"times {seed}")  # noqa: S311 - test problems, no secrets
    task = TASKS[seed % len(TASKS)]
    while True:
        inputs, outputs = random.choice([(2, 1), (2, 2)] if task == "feedforward" else [(1, 2), (2, 1), (2, 2)])
        A, B, C = (
            "; ".join(" ".join(random.choice(_ENTRIES) for _ in range(columns)) for _ in range(rows))
            for rows, columns in ((3, 3), (3, inputs), (outputs, 3))
        )
        if not all(name in A + B + C for name in "ab") or any(not row.strip(" 0") for row in C.split(";")):
            continue
        minimal = task in {"tracking", "reduced_order_observer"}
        poles = list(range(-4, -4 - (3 - outputs if minimal else 3), -1))
        if task == "reduced_order_observer":
            given = f"poles = {poles}\n"
        else:
            given = f"control_poles = [-1, -2, -3]\nobserver_poles = {poles}\n"
        if task == "tracking":
            given += 'reference_matrix = "[0 1 0; 0 0 1; 0 0 0]"\n'
        plant = f'[plant]\nA = "[{A}]"\nB = "[{B}]"\nC = "[{C}]"\n'
        return task, f'task = "{task}"\n[symbols]\na = "real"\nb = "real"\n{plant}[specification]\n{given}'


def strata(answer: dict[str, Any]) -> Iterator[bool]:
    """Yield for each case, and each case of a case, whether it is decided."""
    for case in answer.get("cases", []):
        yield case["verdict"] != "undecided"
        yield from strata(case)


def run(seed: int, seconds: int) -> Run | None:
    """Solve one problem in a process of its own that may take so many seconds of CPU; None where it is refused."""
    task, text = drawn(seed)
    reading, writing = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(reading)
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
        with os.fdopen(writing, "w") as told:
            _solve(text, told)
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading) as heard:
        lines = heard.read().splitlines()
    os.waitpid(child, 0)
    if lines == [_REFUSED]:
        return None
    generic = float(lines[0]) if lines else None
    if len(lines) < 2:
        return Run(seed, task, generic, None)
    whole, cases, undecided = json.loads(lines[1])
    return Run(seed, task, generic, whole, cases, undecided)


def _solve(text: str, told: Any) -> None:
    before = _cpu()
    try:
        (result,) = validate(parse(text, "problem")).solve()
        _ = result.holds_where, result.verdict
        told.write(f"{_cpu() - before}\n")
        told.flush()
        decided = list(strata(result_object(result)))
        told.write(json.dumps([_cpu() - before, len(decided), decided.count(False)]))
    except SymobsError:
        told.write(_REFUSED)


def _cpu() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def table(runs: Sequence[Run]) -> str:
    """Return the figures, a line for each task."""
    head = ("task", "plants", "no generic", "not ended", "over 10 s", "all decided", "median", "p95", "most", "strata")
    lines = ["".join(f"{name:>13}" if place else f"{name:24}" for place, name in enumerate(head))]
    for task in (*TASKS, ""):
        mine = [each for each in runs if task in ("", each.task)]
        ended = [each for each in mine if each.whole is not None]
        times = sorted(each.whole for each in ended if each.whole is not None)
        if len(times) < 2:
            continue
        count: Counter[str] = Counter()
        for each in mine:
            count["generic"] += each.generic is None
            count["over"] += each.whole is None or each.whole > 10
            count["decided"] += each.whole is not None and each.undecided == 0
        figures = [len(mine), count["generic"], len(mine) - len(ended), count["over"], count["decided"]]
        spread = [f"{median(times):.2f}", f"{quantiles(times, n=20)[-1]:.2f}", f"{times[-1]:.2f}"]
        cells = [*map(str, figures), *spread, str(sum(each.cases for each in ended))]
        lines.append(f"{task or 'all':24}" + "".join(f"{cell:>13}" for cell in cells))
    return "\n".join(lines)


def main(arguments: Sequence[str] | None = None) -> int:
    """Measure so many plants and print a line for each, then the table."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.strata_oracle.times", description=__doc__)
    parser.add_argument("--plants", type=int, default=100, help="how many plants")
    parser.add_argument("--seed", type=int, default=0, help="the first seed")
    parser.add_argument("--seconds", type=int, default=60, help="CPU time for one plant")
    options = parser.parse_args(arguments)
    runs = []
    for seed in range(options.seed, options.seed + options.plants):
        found = run(seed, options.seconds)
        if found is not None:
            runs.append(found)
            sys.stdout.write(" ".join(map(str, found)) + "\n")
            sys.stdout.flush()
    sys.stdout.write(f"{table(runs)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
