"""Random problems of every task, judged by independent systems: python -m tests.programs.campaign --problems 10000.

Hypothesis draws the problems; the first answer that a system contradicts, or that is an exception, is made as small as it
can be and shown as a problem file.  It is kept in `.hypothesis` and tried first in the next run of the same seed.
"""

from __future__ import annotations

import argparse
import shutil
import sys
from collections import Counter
from typing import TYPE_CHECKING, Protocol

from hypothesis import HealthCheck, given, seed, settings

from tests.programs.campaign import qepcad
from tests.programs.campaign.solving import solved
from tests.programs.campaign.systems import OCTAVE, PARI, SYSTEMS, Difference, Untold
from tests.support.problems.random_problems import TASKS, problems, to_toml

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tests.support.problems.random_problems import Tables

#: Problems of one run of Hypothesis, which remembers them all.
BATCH = 500


class Oracle(Protocol):
    """An independent system that judges answers."""

    @property
    def NAME(self) -> str: ...

    @property
    def COMMAND(self) -> str: ...

    def covers(self, problem: Tables) -> bool:
        """Tell whether answers to this problem can be judged."""

    def difference(self, given: Tables, answer: Tables) -> Difference:
        """Return None where it agrees, a text of one line where it does not, `Untold` where it cannot tell."""


ORACLES: dict[str, Oracle] = {oracle.NAME: oracle for oracle in (*SYSTEMS, qepcad)}  # type: ignore[misc]


def judged(oracle: Oracle, problem: Tables, answer: Tables) -> Difference:
    """Return a judgement; where doubles disagree and the exact system agrees, rounding misled them."""
    said = oracle.difference(problem, answer)
    if oracle is OCTAVE and isinstance(said, str) and PARI.difference(problem, answer) is None:
        return Untold("PARI agrees where doubles say otherwise")
    return said


def examine(problem: Tables, oracles: Sequence[Oracle], counted: Counter[str], seconds: float = 4) -> None:
    """Solve a problem and let every system judge the answer; an AssertionError where one contradicts it."""
    answer = solved(problem, seconds)
    counted["refused" if isinstance(answer, str) else f"answers: {answer['verdict']}"] += 1
    if isinstance(answer, str):
        return
    for oracle in (oracle for oracle in oracles if oracle.covers(problem)):
        said = judged(oracle, problem, answer)
        word = "differs" if isinstance(said, str) else "cannot tell" if said else "agrees"
        counted[f"{oracle.NAME} {word}"] += 1
        assert not isinstance(said, str), f"{oracle.NAME}: {said}\n{to_toml(problem)}"


def main(arguments: Sequence[str] | None = None) -> int:
    """Examine so many problems and print what was counted; raises where an answer is contradicted."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.campaign", description=__doc__)
    parser.add_argument("--problems", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1, help="the first seed")
    parser.add_argument("--seconds", type=float, default=4, help="processor time for one answer")
    parser.add_argument("--oracle", action="append", choices=ORACLES, help="ask this system alone; may be repeated")
    parser.add_argument("--task", action="append", default=[], choices=TASKS, help="ask this task alone; likewise")
    options = parser.parse_args(arguments)
    wanted = [oracle for name, oracle in ORACLES.items() if name in (options.oracle or ORACLES)]
    oracles = [oracle for oracle in wanted if shutil.which(oracle.COMMAND)]
    for oracle in wanted:
        if oracle not in oracles:
            print(f"{oracle.COMMAND} is not on PATH", file=sys.stderr)
    counted: Counter[str] = Counter()

    @settings(max_examples=min(BATCH, options.problems), deadline=None, suppress_health_check=list(HealthCheck))
    @given(problems(options.task))
    def test(problem: Tables) -> None:
        examine(problem, oracles, counted, options.seconds)

    for number in range(-(-options.problems // BATCH)):
        seed(options.seed + number)(test)()
        print(dict(counted), file=sys.stderr, flush=True)
    for what in sorted(counted):
        print(f"{counted[what]:8} {what}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
