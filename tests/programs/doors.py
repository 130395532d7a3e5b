"""Every task through the doors of a problem file: python -m tests.programs.doors --problems 20000.

Random small plants with letters; for each the answer, its page in two formats and languages, its JSON and its question
are asked.  Counted are crashes, pages without a verdict, and what takes longer than a limit and is not undecided.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import random
import re
import sys
import time
import warnings
from collections import Counter
from typing import TYPE_CHECKING, Any

import symobs
from symobs.ground.errors import SymobsError, SymobsWarning
from symobs.problem.question import question_of
from symobs.problem.validation import validate
from symobs.tasks.result import tasks
from symobs.tasks.result.writers import render
from tests.support.problems.random_plants import small_problem

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

#: Formats of a page, each with its language.
PAGES = (("text", "en"), ("html", "de"))
#: What a page of a test of rank says of the pair, beside the sentence "if and only if".
_VERDICT = re.compile(
    r"(is|are) (not )?(observable|controllable|detectable|stabilizable)|^\s*In this case|not decided here", re.MULTILINE
)
_RANK_TESTS = {"observability", "controllability", "detectability", "stabilizability"}


def faults(name: str, problem: dict[str, Any], left: Callable[[], None] = lambda: None) -> str:
    """Return what went wrong with the doors of a problem, "refused" or "undecided" with a reason, or nothing."""
    warnings.simplefilter("error", SymobsWarning)
    try:
        found = validate(problem)
        shown = render(question_of(found), "text"), render(question_of(found), "latex")
        assert all(shown), "the question is empty"
        results = found.solve()
        left()
        document = found.document(results)
        pages = {(kind, language): render(_in(document, language), kind) for kind, language in PAGES}
        (answer,) = (json.loads(result.to_json())["results"][0] for result in results)
    except SymobsError as error:
        return f"BUG {error}" if error.exit_code == 1 else f"refused: {type(error).__name__}"
    except Exception as error:  # noqa: BLE001 - it is what is looked for
        return f"CRASH {type(error).__name__}: {error}"
    if any(not page for page in pages.values()):
        return "NO PAGE"
    sentences = re.sub(r"\s+", " ", str(pages["text", "en"])).split(". ")
    said = ". ".join(
        sentence for sentence in sentences if "if and only if" not in sentence or "In this case" in sentence
    )
    if name in _RANK_TESTS and answer["verdict"] in {"yes", "no"} and not _VERDICT.search(said):
        return "NO VERDICT on the page"
    return str(answer["verdict"])


def _in(document: Any, language: str) -> Any:
    from dataclasses import replace  # noqa: PLC0415 - the classes of symobs keep to its protocol

    return replace(document, language=language)


def examined(seed: int, wanted: Sequence[str], seconds: float) -> tuple[int, str, str, float, dict[str, Any]]:
    """Return the seed, the task, what became of its problem, the seconds it took, and the problem."""
    chance, name = random.Random(seed), wanted[seed % len(wanted)]  # noqa: S311 - repeats
    problem = dict[str, Any]()
    started = time.process_time()
    try:
        problem = small_problem(name, chance)
        said = symobs.bounded(lambda: faults(name, problem), timeout=seconds)
    except SymobsError as error:
        said = f"SLOW {error}"[:60] if "time" in str(error) else f"refused: {type(error).__name__}"
    except ZeroDivisionError:
        said = "refused: no such plant"
    return seed, name, said, time.process_time() - started, problem


def _work(asked: tuple[int, Sequence[str], float]) -> tuple[int, str, str, float, dict[str, Any]]:
    return examined(*asked)


def main(arguments: Sequence[str] | None = None) -> int:
    """Examine so many problems; print each fault with its problem, and what was counted."""
    parser = argparse.ArgumentParser(prog="python -m tests.programs.doors", description=__doc__)
    parser.add_argument("--problems", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0, help="the first seed")
    parser.add_argument("--seconds", type=float, default=20, help="time for one problem with all its doors")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--task", action="append", choices=sorted(tasks()), help="this task alone; may be repeated")
    options = parser.parse_args(arguments)
    wanted = options.task or sorted(tasks())
    counted: Counter[str] = Counter()
    asked = ((seed, wanted, options.seconds) for seed in range(options.seed, options.seed + options.problems))
    with multiprocessing.get_context("fork").Pool(options.jobs, maxtasksperchild=200) as pool:
        for seed, name, said, _, problem in pool.imap_unordered(_work, asked):
            word = said.split()[0].rstrip(":")
            counted[said if word == "refused" else word] += 1
            if word.isupper():
                print(seed, name, said, json.dumps(problem), flush=True)
    print(*(f"{count:7d} {word}" for word, count in counted.most_common()), sep="\n")
    return int(any(word.isupper() for word in counted))


if __name__ == "__main__":
    sys.exit(main())
