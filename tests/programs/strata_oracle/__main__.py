"""Answers with parameters against the plants at points of their strata: a program.

Run it by `python -m tests.programs.strata_oracle --plants 20000`.

For a random plant of order two to four with one to three parameters, and one task, points are taken on every curve that
stands in a condition or a case of the answer.  The plant is specialised there and solved anew, and every branch of the
answer that covers the point is held to that.  With `--functions` the entries are functions of parameters: exp(x) is read
as a > 0, and cos(y), sin(y) as (1 − b²)/(1 + b²), 2b/(1 + b²), so that points are rational there too.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections import Counter
from dataclasses import dataclass, field
from random import Random
from typing import TYPE_CHECKING, Any

from sympy import fraction, together

from tests.programs.campaign.points import texts_at
from tests.programs.campaign.solving import solved
from tests.programs.strata_oracle.answers import Contradiction, branches, hold, relations
from tests.programs.strata_oracle.points import points_on
from tests.support.algebra import Unreadable
from tests.support.problems.random_problems import TASKS, Shape, Tables, assembled, specification, to_toml, zeros

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.programs.strata_oracle.points import Point

_SIGNS = ["real", "real", "real", "positive", "nonzero", "nonnegative", "negative"]
_FORMS = ["a", "b", "c", "a+b", "a-1", "b+1", "a*b", "b^2-a", "a^2+b^2", "a-b", "-a", "c*a", "c-b", "1-c", "a^2-1"]
_OF_FUNCTIONS = [
    "exp(x)",
    "exp(-x)",
    "cos(y)",
    "sin(y)",
    "c",
    "1-exp(x)",
    "c-cos(y)",
    "c*sin(y)",
    "exp(-x)-c",
    "1+cos(y)",
]
#: What functions of x and y are in a = exp(x) and b = tan(y/2).
_MEANINGS = {"cos": "((1-b**2)/(1+b**2))", "sin": "(2*b/(1+b**2))"}
_LETTERS = {"x": ("a", "positive"), "y": ("b", "real")}
_NUMBERS = ["0", "0", "0", "1", "-1", "2"]
#: Regions have points of their own, and what is read off signals is no matter of a plant alone.
_ASKED_TASKS = sorted(set(TASKS) - {"stability_region", "initial_state", "initial_state_covariance"})
_ASKED_TASKS += ["lyapunov", "minimum_energy_input", "output_regulation", "lqr", "kalman"]


def meant(thing: Any) -> Any:
    """Return a problem or an answer with its functions of x and y as rational functions of a and b."""
    if isinstance(thing, dict):
        return {key: meant(value) for key, value in thing.items()}
    if isinstance(thing, list):
        return [meant(value) for value in thing]
    if not isinstance(thing, str):
        return thing
    text = re.sub(r"(cos|sin)\(y\)", lambda found: _MEANINGS[found[1]], thing)
    return re.sub(r"exp\((-?)(\d*)\*?x\)", lambda found: f"(a**({found[1]}{found[2] or 1}))", text)


def drawn(seed: int, tasks: Sequence[str] = (), *, functions: bool = False) -> Tables:
    """Return the problem of a seed: a plant whose entries are small numbers and short expressions, and one task."""
    random = Random(f"strata {seed}")  # noqa: S311 - test problems, no secrets
    while True:
        task = random.choice(list(tasks) or _ASKED_TASKS)
        shape = _shape(random, task, functions=functions)
        asked: dict[str, Any] | None = {"radius": "2"} if task == "pole_advice" else specification(random, task, shape)
        if not shape.signs or asked is None or (task == "pole_advice" and shape.discrete):
            continue
        return assembled(task, shape, asked)


def _shape(random: Random, task: str, *, functions: bool) -> Shape:
    order = random.choice([2] if functions else [2, 2, 2, 2, 3, 3, 4])
    single = task in {"feedforward", "pole_advice"} or random.random() < 0.6
    inputs, outputs = (1, 1) if single else random.choice([(1, 2), (2, 1), (2, 2)])
    names = ["a", "b", "c"][: random.choice([1, 2, 2, 2, 3])]
    names = [*_LETTERS, "c"] if functions else names
    forms = _OF_FUNCTIONS if functions else [form for form in _FORMS if not {"a", "b", "c"} - set(names) & set(form)]
    density = random.choice([0.15, 0.3, 0.5])

    def table(rows: int, columns: int) -> list[list[str]]:
        return [
            [random.choice(forms if random.random() < density else _NUMBERS) for _ in range(columns)]
            for _ in range(rows)
        ]

    A, B, C = table(order, order), table(order, inputs), table(outputs, order)
    D = table(outputs, inputs) if random.random() < 0.15 else zeros(outputs, inputs)
    entries = [entry for part in (A, B, C, D) for row in part for entry in row]
    used = {name for entry in entries for name in names if re.search(rf"\b{name}\b", entry)}
    signs = {name: "real" if name in _LETTERS else random.choice(_SIGNS) for name in sorted(used)}
    return Shape(A, B, C, D, signs, random.random() < 0.3)


@dataclass
class Found:
    """What was found: how often what happened by task, and the contradictions in words."""

    counted: Counter[tuple[str, str]] = field(default_factory=Counter)
    wrong: list[str] = field(default_factory=list)

    def table(self) -> str:
        """Return the figures, a line for each task."""
        kinds = [
            "answers",
            "given up",
            "points",
            "undecided",
            "refused there",
            "uncovered",
            "contradictions",
            "crashes",
        ]
        tasks = sorted({task for task, _ in self.counted})
        lines = [f"{'':28}" + "".join(f"{kind:>15}" for kind in kinds)]
        lines += [f"{task:28}" + "".join(f"{self.counted[task, kind]:15}" for kind in kinds) for task in tasks]
        whole = (sum(self.counted[task, kind] for task in tasks) for kind in kinds)
        return "\n".join([*lines, f"{'all':28}" + "".join(f"{number:15}" for number in whole)])


def examine(
    seed: int,
    found: Found,
    tasks: Sequence[str] = (),
    seconds: float = 20,
    most: int = 10,
    *,
    functions: bool = False,
) -> None:
    """Draw a plant, solve it, and hold its answer to the plants at points of its strata."""
    problem = drawn(seed, tasks, functions=functions)
    task = problem["task"]
    try:
        answer = solved(problem, seconds)
    except Exception as error:  # noqa: BLE001 - whatever it is, no caller may see it
        found.counted[task, "crashes"] += 1
        found.wrong.append(f"seed {seed}, {task}: {error!r}")
        return
    if isinstance(answer, str):
        found.counted[task, "given up"] += 1
        return
    found.counted[task, "answers"] += 1
    if functions:
        signs: dict[str, str] = dict(_LETTERS.get(name, (name, sign)) for name, sign in problem["symbols"].items())
        problem, answer = meant(problem) | {"symbols": signs}, meant(answer) | {"symbols": signs}
    curves = [str(fraction(together(text))[0]) for text in relations(answer)] if functions else relations(answer)
    for point in points_on(curves, problem["symbols"], most):
        for kind, said in judged(problem, answer, point, seconds):
            found.counted[task, kind] += 1
            if said:
                where = ", ".join(f"{name} = {number}" for name, number in sorted(point.items()))
                found.wrong.append(f"seed {seed}, {task}, {kind} at {where}: {said}")


def judged(problem: Tables, answer: Tables, point: Point, seconds: float) -> Iterator[tuple[str, str]]:
    """Yield what becomes of a point, and the words for what is wrong."""
    at = {**texts_at({key: problem[key] for key in ("plant", "specification")}, point), "symbols": {}}
    at["plant"] |= {key: problem["plant"][key] for key in ("dt",) if key in problem["plant"]}
    try:
        covering = branches(answer, point)
        if covering is None:
            return
        there = solved({"task": problem["task"], **at}, seconds)
        if isinstance(there, str):
            yield "refused there", ""
            return
        yield "points", ""
        if not covering:
            yield "uncovered", f"no branch holds, and the answer is {there['verdict']}"
        decided = [branch for branch in covering if branch.verdict != "undecided"]
        if covering and not decided:
            yield "undecided", ""
        for branch in decided if there["verdict"] != "undecided" else ():
            try:
                hold({**problem, **at}, point, branch, there)
            except Contradiction as error:
                raise Contradiction(f"{error}, where {' and '.join(branch.when)[:200] or 'in general'}") from error
    except Contradiction as error:
        yield "contradictions", str(error)[:400]
    except Unreadable:
        return


def main(arguments: Sequence[str] | None = None) -> int:
    """Examine so many plants; 1 where an answer contradicts itself, or leaves a point out."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.strata_oracle.__main__", description=__doc__)
    parser.add_argument("--plants", type=int, default=1000, help="how many plants")
    parser.add_argument("--seed", type=int, default=0, help="the first seed")
    parser.add_argument("--seconds", type=float, default=20, help="time for one answer")
    parser.add_argument("--points", type=int, default=10, help="points of one answer")
    parser.add_argument("--task", action="append", default=[], help="ask this task alone; may be repeated")
    parser.add_argument("--functions", action="store_true", help="entries are functions of parameters")
    parser.add_argument("--show", action="store_true", help="print the problems as files")
    options = parser.parse_args(arguments)
    sys.setrecursionlimit(50_000)  # a relation of a thousand terms is a sum nested as deep
    found, begun, shown = Found(), time.perf_counter(), 0
    for seed in range(options.seed, options.seed + options.plants):
        examine(seed, found, options.task, options.seconds, options.points, functions=options.functions)
        for line in found.wrong[shown:]:
            sys.stdout.write(f"{line}\n")
        if options.show and found.wrong[shown:]:
            sys.stdout.write(to_toml(drawn(seed, options.task, functions=options.functions)))
        sys.stdout.flush()
        shown = len(found.wrong)
    sys.stdout.write(f"{found.table()}\n")
    sys.stderr.write(f"{time.perf_counter() - begun:.0f} s\n")
    return 1 if found.wrong else 0


if __name__ == "__main__":
    sys.exit(main())
