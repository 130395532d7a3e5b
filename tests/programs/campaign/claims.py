"""What an answer claims, task by task, in terms any system can be told: written from the contract, not from our code.

A problem and an answer come here as texts, with parameters or with numbers in their place; one branch at a time.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from tests.programs.campaign import claims_in_time, claims_of_designs, claims_of_plants
from tests.programs.campaign.branch import Branch

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.programs.campaign.algebra import Claim
    from tests.programs.campaign.asked import Tables


def claims(problem: Tables, answer: Tables) -> list[Claim]:
    """Return what a branch claims; none where it claims nothing that is put here."""
    if answer["verdict"] == "undecided":
        return []
    return list(_CLAIMS[problem["task"]](Branch(problem, answer)))


_CLAIMS: dict[str, Callable[[Branch], Iterator[Claim]]] = {
    "observability": claims_of_plants.observability,
    "controllability": claims_of_plants.observability,
    "detectability": claims_of_plants.modes,
    "stabilizability": claims_of_plants.modes,
    "pbh": claims_of_plants.modes,
    "characteristic_polynomial": claims_of_plants.characteristic_polynomial,
    "transfer_function": claims_of_plants.transfer_function,
    "canonical_form": claims_of_plants.canonical_form,
    "dual": claims_of_plants.dual,
    "decomposition": claims_of_plants.decomposition,
    "state_feedback": claims_of_designs.gain,
    "observer": claims_of_designs.gain,
    "reduced_order_observer": claims_of_designs.reduced_order_observer,
    "compensator": claims_of_designs.compensator,
    "feedforward": claims_of_designs.feedforward,
    "tracking": claims_of_designs.tracking,
    "integral_action": claims_of_designs.integral_action,
    "unknown_input_observer": claims_of_designs.unknown_input_observer,
    "disturbance_observer": claims_of_designs.disturbance_observer,
    "matrix_exponential": claims_in_time.matrix_exponential,
    "gramian": claims_in_time.gramian,
    "time_varying_observability": claims_in_time.time_varying,
    "initial_state": claims_in_time.initial_state,
    "initial_state_covariance": claims_in_time.initial_state_covariance,
    "pole_advice": claims_in_time.pole_advice,
    "stability_region": claims_in_time.stability_region,
}
