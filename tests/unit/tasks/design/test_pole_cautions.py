"""Cautions beside poles that were asked for: an expert says when an error grows or stays, and when a law is unstable."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import symobs
from tests.kit import tabled, tables, text_of

SERVO = ("[0 1; 0 -1]", "[0; 1]", "[1 0]")


def plant(dt: int = 0) -> symobs.StateSpace:
    return symobs.StateSpace(*SERVO, dt=dt)


@tabled
def test_observers_of_full_order(dt: int, poles: str, words: str) -> None:
    found = text_of(symobs.observer(plant(dt), poles=poles))
    assert ("Remark." in found) == bool(words)
    assert words in found


@tabled
def test_observers_of_reduced_order(pole: str, words: str) -> None:
    found = text_of(symobs.reduced_order_observer(plant(), poles=pole))
    assert ("Remark." in found) == bool(words)
    assert words in found


TASKS: list[tuple[str, dict[str, Any]]] = tables(Path(__file__))["tasks"]


@pytest.mark.parametrize(("task", "further"), TASKS)
@tabled
def test_every_task_with_both_gains(
    task: str, further: dict[str, Any], control: str, observer: str, words: list[str]
) -> None:
    found = text_of(getattr(symobs, task)(plant(), control_poles=control, observer_poles=observer, **further))
    assert found.count("Remark.") - found.count("The compensator itself") == len(words)
    assert all(said in found for said in words)


@tabled
def test_a_mode_that_F_does_not_show_is_told(
    matrices: tuple[str, str, str], control: str, observer: str, stable: str, words: str
) -> None:
    design = symobs.compensator(symobs.StateSpace(*matrices), control_poles=control, observer_poles=observer)
    assert (design.F_stable, design.compensator_stable) == ("yes", stable)
    found = text_of(design)
    assert ("is not a complete description of the compensator" in found) == bool(words)
    assert words in found
