"""Every task passes every door, or the table beside this file says why it does not."""

from __future__ import annotations

from pathlib import Path

import pytest

from symobs.tasks.result import tasks
from tests.kit import tables
from tests.programs.matrix import DOORS, NOTHING, cell

REASONS = {(task, door): reason for task, door, reason in tables(Path(__file__))["reasons"]}


@pytest.mark.slow
@pytest.mark.parametrize("door", DOORS)
@pytest.mark.parametrize("task", sorted(tasks()))
def test_a_task_passes_a_door_or_has_its_reason(task: str, door: str) -> None:
    way = cell(task, door)
    if (task, door) in REASONS:
        assert way, "it passes: take its reason out of the table"
    else:
        assert not way or way.startswith(NOTHING), way


def test_few_doors_are_shut() -> None:
    """At most 8 % of the cells; each reason names a task and a door that there are."""
    assert len(REASONS) <= 0.08 * len(tasks()) * len(DOORS)
    assert all(task in tasks() and door in DOORS and reason for (task, door), reason in REASONS.items())
