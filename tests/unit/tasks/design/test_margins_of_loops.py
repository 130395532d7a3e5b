"""Margins as a task: loops of designs and controllers against roots and minima in floating point."""

from __future__ import annotations

from typing import Any

import pytest

import symobs
from symobs import StateSpace
from symobs.ground.errors import InputError
from tests.kit import SERVO, tabled


def test_the_task_finds_what_the_function_does() -> None:
    for design, asked in (
        (symobs.state_feedback(SERVO, poles="-2, -3"), {"poles": "-2, -3"}),
        (symobs.observer(SERVO, poles="-2, -3"), {"observer_poles": "-2, -3"}),
        (
            symobs.compensator(SERVO, control_poles="-1, -2", observer_poles="-3", observer="minimal"),
            {"control_poles": "-1, -2", "observer_poles": "-3", "observer": "minimal"},
        ),
    ):
        found: Any = symobs.margins(SERVO, **asked)
        known = symobs.margins(design)
        assert {name: getattr(found, name) for name in known} == dict(known)
        assert found.verdict == "yes"


def test_what_is_no_single_loop_of_numbers_is_told() -> None:
    assert symobs.margins(SERVO, poles="-2, 1").verdict == "no"
    found: Any = symobs.margins(StateSpace("[0 1; 0 -b]", "[0; 1]", "[1 0]"), poles="-2, -3")
    assert found.verdict == "undecided"
    assert "The margins are not found here" in found.to("text")
    assert symobs.margins(StateSpace("[1 0; 0 2]", "[1; 0]"), poles="-2, -3").verdict == "no"  # unassignable


@tabled
def test_what_is_no_single_loop_is_refused(plant: dict[str, Any], asked: dict[str, str], said: str) -> None:
    with pytest.raises(InputError, match=said):
        symobs.margins(StateSpace(**plant), **asked)


def test_margins_have_values_a_page_with_any_observer_and_answers_in_digits() -> None:
    plant = symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]", symbols={"k": "positive"})
    there: Any = symobs.margins(plant, K="[k 1]")
    assert there.at(k=2).gain_down == 0  # 1 + g (2 + s)/(s (s + 1)) has no roots on the right for g > 0
    minimal: Any = symobs.margins(plant, control_poles="-1, -2", observer_poles="-3", observer="minimal")
    assert "Margins" in minimal.to("text")
    problem = 'task = "margins"\n[plant]\nA = "[0 1; 0 -1]"\nB = "[0; 1]"\n[specification]\nK = "[1 1]"\n'
    angle = float(there.at(k=1).phase_deg)
    for answer, verdict in ((f"{angle:.3f}", "right"), (f"{angle + 1:.3f}", "wrong")):
        report = symobs.check(problem, {"gain_down": "0", "gain_up": "oo", "phase_deg": answer})
        assert [part.verdict for part in report.parts if part.letter == "phase_deg"] == [verdict]
