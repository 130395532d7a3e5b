"""What every child needs, imported once: a process that is forked from one with it answers at once."""

from __future__ import annotations

from symobs.live.answering import answer
from symobs.result import formats, tasks


def prepare() -> None:
    """Import every task and format, and solve one problem, so that the first question pays for nothing."""
    tasks()
    formats()
    plant = {"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"}
    poles = {"control_poles": "-2, -2", "observer_poles": "-10, -10"}
    problem = {"task": "compensator", "plant": plant, "specification": poles}
    answer({"schema": "symobs-live/1", "problem": problem, "courses": {"count": 9}})


prepare()
