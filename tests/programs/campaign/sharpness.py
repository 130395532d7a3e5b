"""How sharp an oracle is: one number of an answer is changed by a ten-thousandth of itself, and is that noticed?

python -m tests.programs.campaign.sharpness --answers 300 --oracle "Octave control"
"""

from __future__ import annotations

import argparse
import re
import sys
from collections import Counter
from random import Random
from typing import TYPE_CHECKING, Any

from tests.programs.campaign import discovery
from tests.programs.campaign.asked import Asked, Untold
from tests.programs.campaign.plants import drawn
from tests.programs.campaign.solving import solved

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from tests.programs.campaign.asked import Tables
    from tests.programs.campaign.discovery import Oracle

#: What an oracle in numbers reads: other fields say how an answer was found, or repeat it in other letters.
FIELDS = (
    *("matrix", "kernel", "rank", "unobservable_modes", "uncontrollable_modes", "determinant", "modes"),
    *("fixed_polynomial", "polynomial", "roots", "transfer_function", "poles", "zeros", "T", "A", "B", "C", "D"),
    *("finite_sum", "x0", "K", "L", "closed_loop_matrix", "closed_loop_matrix_estimate", "compensator_matrix"),
    *("B_u", "B_y", "F", "G", "H", "M", "closed_loop_polynomial", "closed_loop", "closed_loop_unity", "K_d"),
    *("error_matrix", "sizes", "minimal_order", "observability_rank", "controllability_rank"),
)
_NUMBER = re.compile(r"(?<![\w*^])(?<!\*\* )\d+(?![\w(])")
_CHANGE = "10001/10000"


def changed(asked: Asked, random: Random, fields: Sequence[str] = FIELDS) -> tuple[str, Asked] | None:
    """Return the answer with one of its numbers changed, and where; None where it has none."""
    places = [(name, path) for name in fields for path in _leaves(asked.answer.get(name))]
    if not places:
        return None
    name, path = random.choice(places)
    answer: Tables = {**asked.answer, name: _replaced(asked.answer[name], path, random)}
    return name, Asked(asked.kind, asked.seed, asked.problem, answer)


def _leaves(value: Any) -> Iterator[tuple[Any, ...]]:
    if isinstance(value, list):
        for k, entry in enumerate(value):
            yield from ((k, *path) for path in _leaves(entry))
    elif isinstance(value, dict):
        for key, entry in value.items():
            yield from ((key, *path) for path in _leaves(entry))
    elif isinstance(value, (str, int)) and not isinstance(value, bool):
        yield ()


def _replaced(value: Any, path: tuple[Any, ...], random: Random) -> Any:
    if not path:
        return value + random.choice([-1, 1]) if isinstance(value, int) else _off(value, random)
    first, *rest = path
    copy: Any = list(value) if isinstance(value, list) else dict(value)
    copy[first] = _replaced(value[first], tuple(rest), random)
    return copy


def _off(text: str, random: Random) -> str:
    """Return an expression with one of its coefficients changed; in 0 and in what has none, something is added."""
    found = list(_NUMBER.finditer(text))
    if text == "0" or text.endswith("oo") or not found or "Root" in text:
        return f"{text} + 1/10000"
    one = random.choice(found)
    other = f"({one.group()}*{_CHANGE})" if int(one.group()) else "(1/10000)"
    return f"{text[: one.start()]}{other}{text[one.end() :]}"


def measured(oracle: Oracle, answers: Sequence[Asked], changes: int = 3) -> Counter[tuple[str, str]]:
    """Return how many changes were noticed, not noticed, or could not be told, by field, of answers agreed to."""
    random = Random(1)  # noqa: S311 - test problems, no secrets
    fields = getattr(oracle, "FIELDS", FIELDS)
    agreed = [a for a, said in zip(answers, oracle.differences(answers), strict=True) if said is None]
    tried = [found for asked in agreed for _ in range(changes) if (found := changed(asked, random, fields)) is not None]
    said = oracle.differences([asked for _, asked in tried])
    counts: Counter[tuple[str, str]] = Counter()
    for (name, asked), judgement in zip(tried, said, strict=True):
        word = "noticed" if isinstance(judgement, str) else "not told" if isinstance(judgement, Untold) else "missed"
        counts[f"{asked.task}.{name}", word] += 1
    return counts


def answers_to(seeds: Sequence[int], oracle: Oracle, tasks: Sequence[str] = ()) -> list[Asked]:
    """Return our answers to the problems of these seeds that an oracle judges."""
    problems = ((seed, *drawn(seed, tasks)) for seed in seeds)
    found = (solved(kind, seed, problem, 4) for seed, kind, problem in problems if oracle.covers(problem))
    return [answer for answer in found if isinstance(answer, Asked)]


def main() -> int:
    """Print what was noticed, field by field."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--answers", type=int, default=200)
    parser.add_argument("--seed", type=int, default=2_000_000)
    parser.add_argument("--oracle", action="append", default=[])
    options = parser.parse_args()
    for name, oracle in discovery.found()[0].items():
        if options.oracle and name not in options.oracle:
            continue
        counts = measured(oracle, answers_to(range(options.seed, options.seed + options.answers), oracle))
        words: Counter[str] = Counter()
        for (_, word), number in counts.items():
            words[word] += number
        sys.stdout.write(f"{name}: {dict(words)}\n")
        for field in sorted({field for field, word in counts if word != "noticed"}):
            found = {word: number for (where, word), number in counts.items() if where == field}
            sys.stdout.write(f"  {field:44} {found}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
