"""Answers of the live page while a control pole is dragged: gains, F, responses, as the page asks for them."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Any

from symobs.applications.live import answer
from tests.programs.benchmarks.measuring import Row, medians, processor_time

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.programs.benchmarks.measuring import Settings

PLACE = 10
#: By order: the plant, the control poles that stay, and the observer poles.
PLANTS = {
    2: ({"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"}, "-2", "-10, -10"),
    3: ({"A": "[0 1 0; 0 0 1; -1 -2 -3]", "B": "[0; 0; 1]", "C": "[1 0 0]"}, "-1+i, -1-i", "-5, -6, -7"),
    4: (
        {"A": "[0 1 0 0; 0 0 -1 0; 0 0 0 1; 0 0 11 0]", "B": "[0; 1; 0; -1]", "C": "[1 0 0 0]"},
        "-1+i, -1-i, -2",
        "-5, -6, -7, -8",
    ),
}
_STEPS = itertools.count(1)


def rows(settings: Settings) -> Iterator[Row]:
    """Yield the processor time of one answer for each order."""
    for order in PLANTS:
        found = medians(20 * settings.repetitions, {"": lambda order=order: processor_time(lambda: dragged(order))})  # type: ignore[misc]
        yield Row(f"answer while a pole is dragged, n = {order}", found[""])


def dragged(order: int) -> dict[str, Any]:
    """Return the answer at the next place of the pole, where it has not been before."""
    plant, others, observer = PLANTS[order]
    poles = {"control_poles": f"{others}, -{next(_STEPS)}/997 - 1", "observer_poles": observer}
    problem = {"task": "compensator", "plant": plant, "specification": poles}
    return answer({"schema": "symobs-live/1", "problem": problem, "moving": True, "courses": {"count": 129}})
