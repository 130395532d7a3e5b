"""Cautions beside poles that were asked for: an expert says when an error grows or stays, and when a law is unstable."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import symobs
from tests.kit import tabled

SERVO = ("[0 1; 0 -1]", "[0; 1]", "[1 0]")
FALLING = ("[0 1; 4 -1]", "[0; 1]", "[2 1]")
REFERENCE = "[0 1; 4 -1]"


def page(result: Any) -> str:
    return " ".join(result.to("text").split())


def plant(dt: int = 0) -> symobs.StateSpace:
    return symobs.StateSpace(*SERVO, dt=dt)


@tabled
def test_observers_of_full_order(dt: int, poles: str, words: str) -> None:
    found = page(symobs.observer(plant(dt), poles=poles))
    assert ("Remark." in found) == bool(words)
    assert words in found


@tabled
def test_observers_of_reduced_order(pole: str, words: str) -> None:
    found = page(symobs.reduced_order_observer(plant(), poles=pole))
    assert ("Remark." in found) == bool(words)
    assert words in found


TASKS: list[tuple[str, dict[str, Any]]] = [
    ("compensator", {}),
    ("feedforward", {}),
    ("tracking", {"reference_matrix": "[0 1; -1 0]", "observer": "full"}),
]


@pytest.mark.parametrize(("task", "further"), TASKS)
@pytest.mark.parametrize(
    ("control", "observer", "words"),
    [
        ("1, -2", "-3, -4", ["the closed loop is unstable"]),
        ("i, -i", "-3, -4", ["does not converge to an equilibrium"]),
        ("-1, -2", "0, -4", ["a component of the estimation error does not decay"]),
        ("2, -2", "3, -4", ["the closed loop is unstable", "the estimation error grows"]),
        ("-1, -2", "-3, -4", []),
    ],
)
def test_every_task_with_both_gains(
    task: str, further: dict[str, Any], control: str, observer: str, words: list[str]
) -> None:
    found = page(getattr(symobs, task)(plant(), control_poles=control, observer_poles=observer, **further))
    assert found.count("Remark.") - found.count("The compensator itself") == len(words)
    assert all(said in found for said in words)


@pytest.mark.parametrize("observer", ["full", "minimal"])
@pytest.mark.parametrize("control", ["-9, -5", "-2, -1"])
def test_a_law_that_is_unstable_by_itself_is_told(observer: str, control: str) -> None:
    """The eigenvalues are numpy's."""
    poles = "-50, -60" if observer == "full" else "-50"
    falling = symobs.StateSpace(*FALLING)
    asked: dict[str, Any] = {"control_poles": control, "observer_poles": poles, "observer": observer}
    own = np.array(symobs.compensator(falling, **asked).compensator_matrix.tolist(), dtype=float)
    is_stable = max(np.linalg.eigvals(own).real) < 0
    for task, further in (("feedforward", {}), ("tracking", {"reference_matrix": REFERENCE})):
        found = page(getattr(symobs, task)(falling, **asked, **further))
        assert ("The compensator itself is unstable" in found) != is_stable


def test_there_are_laws_of_both_kinds() -> None:
    stable = symobs.compensator(plant(), control_poles="-2, -2", observer_poles="-10, -10").F_stable
    unstable = symobs.compensator(
        symobs.StateSpace(*FALLING), control_poles="-9, -5", observer_poles="-50, -60"
    ).F_stable
    assert (stable, unstable) == ("yes", "no")


def test_parameters_that_leave_it_open_are_not_cautioned() -> None:
    assert "Remark." not in page(symobs.observer(plant(), poles="-p, -q"))


@tabled
def test_a_mode_that_F_does_not_show_is_told(
    matrices: tuple[str, str, str], control: str, observer: str, stable: str, words: str
) -> None:
    design = symobs.compensator(symobs.StateSpace(*matrices), control_poles=control, observer_poles=observer)
    assert (design.F_stable, design.compensator_stable) == ("yes", stable)
    found = " ".join(page(design).split())
    assert ("is not a complete description of the compensator" in found) == bool(words)
    assert words in found


def test_a_compensator_that_F_shows_whole_is_stable_as_F_is() -> None:
    design = symobs.compensator(plant(), control_poles="-2, -2", observer_poles="-10, -10")
    assert (design.F_stable, design.compensator_stable) == ("yes", "yes")
    assert "complete description of the compensator" not in page(design)
