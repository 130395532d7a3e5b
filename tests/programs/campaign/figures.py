"""What a campaign found: per task, kind of plant and oracle how many answers were judged, and how."""

from __future__ import annotations

import json
from collections import Counter
from typing import TYPE_CHECKING

from tests.programs.campaign.asked import Untold

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from tests.programs.campaign.asked import Asked, Difference
    from tests.programs.campaign.solving import Refused

AGREES, DIFFERS, UNTOLD = "agrees", "differs", "could not tell"


class Figures:
    """Counts that outlive the process: they are written after every batch, with the next seed."""

    def __init__(self, next_seed: int) -> None:
        self.next_seed = next_seed
        self.seconds = 0.0
        self.drawn: Counter[tuple[str, str]] = Counter()
        self.verdicts: Counter[tuple[str, str]] = Counter()
        self.refused: Counter[tuple[str, str]] = Counter()
        self.judged: Counter[tuple[str, str, str, str]] = Counter()
        self.reasons: Counter[tuple[str, str]] = Counter()

    # -- counting ------------------------------------------------------------------------------------------------------

    def answered(self, asked: Asked) -> None:
        self.drawn[asked.task, asked.kind] += 1
        self.verdicts[asked.task, asked.verdict] += 1

    def gave_up(self, refused: Refused) -> None:
        self.refused[str(refused.problem["task"]), _short(refused.reason)] += 1

    def judge(self, oracle: str, asked: Asked, judgement: Difference) -> None:
        if judgement is None:
            word = AGREES
        elif isinstance(judgement, Untold):
            word = UNTOLD
            self.reasons[oracle, _short(judgement.reason)] += 1
        else:
            word = DIFFERS
        self.judged[oracle, asked.task, asked.kind, word] += 1

    def withdraw(self, oracle: str, asked: Asked) -> None:
        """Take back a disagreement that is none any more."""
        self.judged[oracle, asked.task, asked.kind, DIFFERS] -= 1

    @property
    def total(self) -> int:
        return sum(self.drawn.values())

    def count(self, oracle: str, word: str) -> int:
        return sum(number for (name, _, _, said), number in self.judged.items() if (name, said) == (oracle, word))

    # -- keeping -------------------------------------------------------------------------------------------------------

    def save(self, path: Path) -> None:
        """Write the counts beside the old ones and then in their place."""
        tables = {name: [[*key, number] for key, number in counter.items()] for name, counter in self._counters()}
        beside = path.with_suffix(".new")
        whole = {"next_seed": self.next_seed, "seconds": round(self.seconds, 1), **tables}
        beside.write_text(json.dumps(whole), encoding="utf-8")
        beside.replace(path)

    @classmethod
    def load(cls, path: Path) -> Figures:
        data = json.loads(path.read_text(encoding="utf-8"))
        figures = cls(data["next_seed"])
        figures.seconds = data["seconds"]
        for name, counter in figures._counters():
            for *key, number in data[name]:
                counter[tuple(key)] = number
        return figures

    def _counters(self) -> Iterable[tuple[str, Counter[tuple[str, ...]]]]:
        names = ("drawn", "verdicts", "refused", "judged", "reasons")
        return [(name, getattr(self, name)) for name in names]

    # -- showing -------------------------------------------------------------------------------------------------------

    def table(self) -> str:
        """Return everything as text: task by oracle, kind by oracle, verdicts, and what could not be told and why."""
        oracles = sorted({key[0] for key in self.judged})
        lines = [
            f"{self.total} answers in {self.seconds:.0f} s ({self._rate():.0f} a minute), next seed {self.next_seed}"
        ]
        lines += ["", *self._grid("task", 1, oracles), "", *self._grid("kind of plant", 2, oracles)]
        lines += ["", "verdicts: " + ", ".join(f"{word} {number}" for word, number in self._words().most_common())]
        lines += ["", f"refused: {sum(self.refused.values())}"]
        lines += [f"  {number:6} {task}: {reason}" for (task, reason), number in self.refused.most_common(12)]
        lines += ["", "could not tell"]
        lines += [f"  {number:6} {oracle}: {reason}" for (oracle, reason), number in self.reasons.most_common(12)]
        return "\n".join(lines)

    def _rate(self) -> float:
        return 60 * self.total / self.seconds if self.seconds else 0.0

    def _words(self) -> Counter[str]:
        words: Counter[str] = Counter()
        for (_, verdict), number in self.verdicts.items():
            words[verdict] += number
        return words

    def _grid(self, title: str, place: int, oracles: Sequence[str]) -> list[str]:
        """Return rows `agrees/differs/could not tell` for each oracle."""
        names = sorted({key[place - 1] for key in self.drawn})
        lines = [f"{title:28}{'answers':>9}" + "".join(f"{oracle:>20}" for oracle in oracles)]
        for name in [*names, "all"]:
            answers = sum(number for key, number in self.drawn.items() if name in {key[place - 1], "all"})
            cells = []
            for oracle in oracles:
                said: Counter[str] = Counter()
                for key, number in self.judged.items():
                    if key[0] == oracle and name in {key[place], "all"}:
                        said[key[3]] += number
                cells.append(f"{said[AGREES]}/{said[DIFFERS]}/{said[UNTOLD]}")
            lines.append(f"{name:28}{answers:9}" + "".join(f"{cell:>20}" for cell in cells))
        return lines


def _short(text: str) -> str:
    """Return the beginning of a reason, without the numbers that make every one different."""
    return "".join("0" if character.isdigit() else character for character in text)[:90]
