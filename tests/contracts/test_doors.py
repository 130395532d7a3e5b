"""Small plants with letters through the doors of a problem file: what was found at the edges, and more of it at random."""

from __future__ import annotations

import random
import re
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import pytest

import symobs
from symobs.ground.errors import DerivationRejected, SymobsError
from symobs.problem.validation import validate
from symobs.proof.derivation import CaseStep, Section
from symobs.tasks.result import tasks
from symobs.tasks.result.writers import render
from tests.kit import tables
from tests.programs.doors import faults
from tests.support.problems.random_plants import small_problem
from tests.support.sampling import FULL

PROBLEMS = tables(Path(__file__))["problems"]


@pytest.mark.parametrize(
    ("task", "signs", "plant", "asked", "verdict", "words"),
    [row[1:] for row in PROBLEMS],
    ids=[row[0] for row in PROBLEMS],
)
def test_an_answer_found_at_the_edges(
    task: str, signs: dict[str, str], plant: dict[str, Any], asked: dict[str, Any], verdict: str, words: str
) -> None:
    problem = {"title": task, "task": task, "symbols": signs, "plant": plant, "specification": asked}
    assert faults(task, problem) == verdict
    found = validate(problem)
    page = render(found.document(found.solve()), "text")
    assert re.search(words, str(page)), page


def test_a_page_without_the_cases_it_promises_is_rejected() -> None:
    plant = symobs.StateSpace("[0 1; 0 0]", C="[a 0]", symbols={"a": "real"})
    written = symobs.observability(plant).derivation
    written.check()

    def without_cases(steps: tuple[Any, ...]) -> tuple[Any, ...]:
        kept = (step for step in steps if not isinstance(step, CaseStep))
        return tuple(replace(s, steps=without_cases(s.steps)) if isinstance(s, Section) else s for s in kept)

    with pytest.raises(DerivationRejected, match="promises cases that do not follow"):
        replace(written, steps=without_cases(written.steps)).check()


@pytest.mark.slow
@pytest.mark.parametrize("part", range(100 if FULL else 2))
def test_no_door_of_a_small_plant_is_a_bug(part: int) -> None:
    names, wrong = sorted(tasks()), list[str]()
    for seed in range(35 * part, 35 * part + 35):
        chance, name = random.Random(seed), names[seed % len(names)]  # noqa: S311 - repeats
        try:
            problem = small_problem(name, chance)
            said = symobs.bounded(partial(faults, name, problem), timeout=5)
        except (SymobsError, ZeroDivisionError):  # no such plant, or not in this time
            continue
        if said.split()[0].isupper():
            wrong.append(f"{seed} {problem}: {said}")
    assert not wrong, "\n".join(wrong)
