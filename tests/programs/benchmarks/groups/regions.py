"""Regions of stability beside QEPCAD, which is given the strict inequalities of Liénard and Chipart.

symobs is timed from the text of the polynomial to the JSON of the checked result, with names that no earlier repetition
used; QEPCAD in the form and with the order of variables it is fastest in, without its start-up.
"""

from __future__ import annotations

import itertools
import re
import statistics
from dataclasses import replace
from typing import TYPE_CHECKING

from tests.programs.benchmarks import other_systems
from tests.programs.benchmarks.measuring import Row, medians, processor_time
from tests.support.regions import qepcad, region_answers
from tests.support.regions.region_problems import PROBLEMS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Settings
    from tests.support.regions.region_problem import Problem

PLACE = 6
_SERIAL = itertools.count()


def rows(settings: Settings) -> Iterator[Row]:
    """Yield symobs beside QEPCAD for each problem, and the medians."""
    times: list[tuple[float, float]] = []
    for problem in PROBLEMS:
        own = medians(min(settings.repetitions, 5), {"": lambda problem=problem: ours(problem)})[""]  # type: ignore[misc]
        tried = [qepcad.seconds(question, settings.limit) for _, question in questions(problem)]
        answered = [seconds for seconds in tried if seconds is not None]
        times += [(own, min(answered))] if answered else []
        yield Row(f"region {problem.name}", own, "QEPCAD alone", min(answered, default=None))
    if times:
        own, alone = (statistics.median(column) for column in zip(*times, strict=True))
        yield Row("regions: medians", own, "QEPCAD alone", alone, ratio=statistics.median(b / a for a, b in times))


def questions(problem: Problem) -> list[tuple[str, qepcad.Question]]:
    """Return the formulations that QEPCAD may choose from; none where it is not installed."""
    return list(qepcad.inequalities(problem)) if other_systems.available("qepcad") else []


def renamed(problem: Problem) -> Problem:
    """Return the problem with names that no earlier one had, so that nothing remembered serves it."""
    suffix = f"_{next(_SERIAL)}"
    fresh = {name: name + suffix for name in problem.names}
    text = re.sub(r"[A-Za-z]\w*", lambda match: fresh.get(match.group(), match.group()), problem.text)
    symbols = {fresh[name]: sign for name, sign in problem.symbols.items()}
    return replace(problem, text=text, parameters=tuple(fresh[name] for name in problem.parameters), symbols=symbols)


def ours(problem: Problem) -> float:
    """Return the processor time from text to JSON."""
    other = renamed(problem)
    return processor_time(lambda: region_answers.call(other).to_json())
