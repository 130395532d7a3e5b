"""Results as Python shows them: the answer in `repr`, the pictures of the page in `plot`, margins of one type."""

from __future__ import annotations

import pytest

import symobs
from symobs.ground.errors import UsageError
from tests.kit import SERVO, tabled


@tabled
def test_repr_shows_what_answers_the_task(call: str, said: str) -> None:
    servo = 'symobs.StateSpace("[0 1; 0 -1]", "[0; 1]", "[1 0]")'
    assert repr(eval(call, {"symobs": symobs, "servo": eval(servo, {"symobs": symobs})})) == said  # noqa: S307 - ours


def test_what_is_long_is_cut_or_counted() -> None:
    long = symobs.StateSpace([[f"a{i}{j}" for j in range(3)] for i in range(3)], ["1", "2", "3"], ["1", "2", "3"])
    assert "<" in repr(symobs.state_feedback(long, poles="-1, -2, -3"))
    assert repr(symobs.response(SERVO, input="1+t+t^2+t^3+t^4+t^5+t^6+t^7+t^8+t^9")).count("…") == 1


def test_a_plot_is_a_figure_with_every_picture_of_the_page() -> None:
    pytest.importorskip("matplotlib")
    region = symobs.stability_region(polynomial="s^2 + h1*s + h2", parameters=["h1", "h2"])
    assert len(region.plot().axes) == region.to("html").count("<figure") == 1
    with pytest.raises(UsageError, match="no picture of observability"):
        symobs.observability(SERVO).plot()


def test_margins_of_a_design_and_of_a_plant_are_one_type() -> None:
    poles = {"control_poles": "-2, -2", "observer_poles": "-10, -10"}
    of_design, of_plant = symobs.margins(symobs.compensator(SERVO, **poles)), symobs.margins(SERVO, **poles)
    assert type(of_design) is type(of_plant)
    assert dict(of_design) == dict(of_plant)
    assert of_design["gain_up"] == of_design.gain_up
    assert of_design.to("text") == of_plant.to("text")
