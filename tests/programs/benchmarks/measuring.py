"""How subjects are timed, and how what was found is shown: rows of one table, as text or as Markdown."""

from __future__ import annotations

import statistics
import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

HEAD = ("work", "symobs", "beside", "time", "ratio", "asked")


@dataclass(frozen=True)
class Row:
    """One line of the table: what symobs took, what another took, and the ratio asked for."""

    work: str
    ours: float
    other: str = ""
    theirs: float | None = None
    asked: str = ""
    inverted: bool = False
    ratio: float | None = None  # where it is not that of the two times
    beyond: bool = False  # the other gave no answer in the time that stands there
    unit: str = "s"

    def cells(self) -> tuple[str, ...]:
        """Return the line as texts."""
        if self.theirs is None:
            return self.work, written(self.ours, self.unit), self.other, "", "", self.asked
        ratio = self.ratio
        if ratio is None:
            ratio = self.ours / self.theirs if self.inverted else self.theirs / self.ours
        mark = "> " if self.beyond else ""
        theirs = f"{mark}{written(self.theirs, self.unit)}"
        return self.work, written(self.ours, self.unit), self.other, theirs, f"{mark}{_short(ratio)}", self.asked


def written(value: float, unit: str) -> str:
    """Return a figure with its unit, seconds below one as milliseconds."""
    if unit == "s" and value < 1:
        return f"{_short(1000 * value)} ms"
    return f"{_short(value)} {unit}".rstrip()


def _short(value: float) -> str:
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


@dataclass(frozen=True)
class Settings:
    """How often each subject runs, and how long another system may take."""

    repetitions: int
    limit: float


def medians(repetitions: int, subjects: Mapping[str, Callable[[], float | None]]) -> dict[str, float]:
    """Return each subject's median over repetitions in which all take turns; a subject that gives up is left out."""
    found: dict[str, list[float]] = {name: [] for name in subjects}
    for _ in range(repetitions):
        for name in list(found):
            seconds = subjects[name]()
            if seconds is None:
                del found[name]
            else:
                found[name].append(seconds)
    return {name: statistics.median(values) for name, values in found.items()}


def several(times: int, subject: Callable[[], float]) -> Callable[[], float]:
    """Return the median of a subject run several times in a row, for subjects much shorter than the others."""
    return lambda: statistics.median(subject() for _ in range(times))


def processor_time(function: Callable[[], object]) -> float:
    """Return the processor time of a call."""
    start = time.process_time()
    function()
    return time.process_time() - start


def table(rows: Sequence[Row]) -> str:
    """Return the rows in columns."""
    lines = [HEAD, *(row.cells() for row in rows)]
    widths = [max(len(line[column]) for line in lines) for column in range(len(HEAD))]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip() for line in lines
    )


def markdown(rows: Sequence[Row]) -> str:
    """Return the rows as a table in Markdown, without what is asked; figures stand on the right."""
    sides = ("---", "---:", "---", "---:", "---:")
    lines = [HEAD[:-1], sides, *(tuple(cell.replace("|", r"\|") for cell in row.cells()[:-1]) for row in rows)]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)
