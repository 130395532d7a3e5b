"""Regions of stability; `python -m tests.programs.benchmarks.regions` prints more of them."""

from __future__ import annotations

import statistics
from typing import TYPE_CHECKING

from tests.programs.benchmarks import regions
from tests.programs.benchmarks.measuring import Row

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Settings

PLACE = 6


def rows(settings: Settings) -> Iterator[Row]:
    """Yield symobs beside QEPCAD without its start-up."""
    found = list(regions.measure_all((), min(settings.repetitions, 5), settings.limit))
    for row in found:
        if row.ours is not None:
            yield Row(f"region {row.problem.name}", row.ours, f"QEPCAD alone; {row.verdict}", row.alone)
    times = [(row.ours, row.alone) for row in found if row.ours is not None and row.alone is not None]
    if times:
        own, alone = (statistics.median(column) for column in zip(*times, strict=True))
        yield Row("regions: medians", own, "QEPCAD alone", alone, ratio=regions.median(row.ratio for row in found))
