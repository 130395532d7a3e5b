"""The first part of pages with estimated-state feedback: both gains, and the law solved for the input."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.tasks.analysis.page_parts import given
from symobs.tasks.design.compensator.minimal_order_compensator import MinimalOrderCompensator
from symobs.tasks.design.compensator.minimal_order_compensator_page import write_control_law
from symobs.tasks.design.full_order.observer import write_observer
from symobs.tasks.design.gain.gain_page import write_gain
from symobs.tasks.design.gain.gain_request import page_style
from symobs.tasks.design.gain.placement_problem import FEEDBACK, OBSERVER
from symobs.tasks.design.reduced_order.reduced_order_observer import ReducedOrderObserver
from symobs.tasks.design.reduced_order.reduced_order_observer_page import write_observer_of_rest

if TYPE_CHECKING:
    from symobs.proof.derivation.builder import Builder
    from symobs.tasks.design.compensator.output_feedback import OutputFeedback


def write_both_gains(page: Builder, loop: OutputFeedback) -> None:
    """Write the data, the feedback and the observer."""
    plant = page.plant
    given(page, ("control", loop.feedback.desired), ("observer", loop.estimator.desired))
    with page.section("state_feedback"):
        write_gain(page, loop.feedback, FEEDBACK, page_style("auto", plant, several=plant.inputs > 1))
    if isinstance(loop.estimator, ReducedOrderObserver):
        write_observer_of_rest(page, loop.estimator)
        return
    with page.section("observer"):
        write_gain(page, loop.estimator, OBSERVER, page_style("auto", plant, several=plant.outputs > 1))
        if loop.answer["L"] is not None:
            write_observer(page)


def is_ill_posed(page: Builder, loop: OutputFeedback) -> bool:
    """Write that the law cannot be solved for u although both gains exist; return whether this is the case."""
    if loop.exists or None in (loop.answer["K"], loop.answer["L"]) or not isinstance(loop, MinimalOrderCompensator):
        return False
    with page.section("compensator"):
        write_control_law(page, loop, large=False)
    return True
