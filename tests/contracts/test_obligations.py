"""What sentences owe is declared beside their words: nothing declared may be lost, and nothing unknown be declared.

The tables below hold what was declared when each sentence was written.  They may grow; a sentence leaves them only with
its words, or where its words no longer say so.
"""

from __future__ import annotations

import ast
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

from symobs.formula.phrases import ASSERTS, DEMANDS, PHRASES
from symobs.proof.derivation import check, wording_check
from symobs.proof.derivation.facts.properties import PREDICATES

if TYPE_CHECKING:
    from types import ModuleType

#: Obligation, and the sentences that owe it.
DEMANDED = {
    "applies_image": "mapped mapped_from_v",
    "counts_degree": "pair_remains some_on_circle",
    "counts_dominant": "pair_dominates",
    "counts_names": "crossing crossing_discrete crossing_infinite crossing_one crossing_one_discrete",
    "introduces_degree_one": "one_from_settling one_on_circle",
    "moves_by_margin": "moved_right",
    "needs_loop_stable": "compensator_unstable_alone compensator_unstable_low_alone minimal_unstable_alone",
    "needs_modes_stable": "yes_detectability yes_stabilizability",
    "needs_modes_unstable": "no_detectability no_stabilizability",
    "needs_pole_defective": "defective defective_instead",
    "needs_controllable": "no_fixed_modes_controllability pbh_yes_controllability yes_controllability",
    "needs_nonsingular": "steps_nonsingular_controllability steps_nonsingular_observability",
    "needs_observable": "no_fixed_modes_observability pbh_yes_observability yes_observability",
    "needs_rank_full": "no_feedforward_zero",
    "needs_uncontrollable": "pbh_no_controllability",
    "needs_unobservable": "pbh_no_observability",
    "says_decay": "decayed",
    "says_overshoot": "overshoot_held",
    "says_overshoot_above": "overshoot_close",
    "says_controllable": "full_rank_controllability generic_rank_controllability",
    "says_observable": "full_rank_observability generic_rank_observability",
    "says_rank_full": "case_stack_yes stack_yes",
    "says_rank_low": "case_stack stack_no",
    "says_uncontrollable": "generic_low_controllability",
    "says_uncontrollable_everywhere": "no_controllability",
    "says_unobservable": "generic_low_observability",
    "says_unobservable_everywhere": "no_observability",
    "scales_by_radius": "enlarged",
    "shares_kernel_controllability": "kernel_none_controllability",
    "shares_kernel_observability": "kernel_none kernel_shared",
    "spans_kernel": "steps_kernel_controllability steps_kernel_observability",
    "substitutes_law": "observer_closed observer_closed_matrix",
    "sums_powers": "finite_sum_is",
    "sets_margin": "sought_margin",
    "sets_radius": "sought_radius",
}

#: Properties, and the sentences that assert them.
ASSERTED = {
    "beyond": "beyond_continuous beyond_discrete",
    "beyond unstable": """
        grows_observer_continuous grows_observer_discrete grows_state_feedback_continuous
        grows_state_feedback_discrete
    """,
    "marginal": "marginal_continuous marginal_discrete",
    "marginal stable unstable": "drifts_state_feedback_continuous drifts_state_feedback_discrete",
    "marginal unstable": """
        stays_observer_continuous stays_observer_discrete stays_state_feedback_continuous
        stays_state_feedback_discrete
    """,
    "no_stable_compensator": "always_unstable no_stable_compensator",
    "not_polynomial": """
        case_no_observer case_no_state_feedback impossible_observer impossible_state_feedback
        integral_impossible reduced_impossible
    """,
    "polynomial": """
        case_other_observer case_other_state_feedback case_same_observer case_same_state_feedback
        case_survives_observer case_survives_state_feedback fixed_but_wanted_observer
        fixed_but_wanted_state_feedback loop_no_poles no_zero reduced_all_fixed reduced_not_unique
    """,
    "stable": """
        case_everywhere gramian_infinite_controllability gramian_infinite_observability only_stable
        stable_continuous stable_discrete
    """,
    "stable strictly_proper": "compensator_stable compensator_stable_low minimal_stable",
    "stable strictly_proper unstable": "compensator_unstable_alone compensator_unstable_low_alone minimal_unstable_alone",
    "strictly_proper": """
        compensator_proper compensator_stable_if integral_unassignable minimal_proper minimal_stable_if
        reduced_unassignable unassignable_observer unassignable_state_feedback
    """,
    "strictly_proper unstable": "compensator_unstable compensator_unstable_low minimal_unstable",
    "unstable": """
        gramian_diverges_controllability gramian_diverges_observability hides_continuous
        hides_discrete lasts_observer_continuous lasts_observer_discrete lasts_state_feedback_continuous
        lasts_state_feedback_discrete law_unstable_continuous law_unstable_discrete
        lowest_terms_unstable_continuous lowest_terms_unstable_discrete unstable_continuous
        unstable_discrete
    """,
}

OWED = [(key, obligation) for obligation, keys in DEMANDED.items() for key in keys.split()]
ASSERTING = [(key, properties) for properties, keys in ASSERTED.items() for key in keys.split()]


@pytest.mark.parametrize(("key", "obligation"), OWED)
def test_no_obligation_is_lost(key: str, obligation: str) -> None:
    assert DEMANDS.get(key) == obligation, f"{key!r} says {PHRASES.get(key)!r} and owes {obligation}"


@pytest.mark.parametrize(("key", "properties"), ASSERTING)
def test_no_property_is_lost(key: str, properties: str) -> None:
    assert set(properties.split()) <= set(ASSERTS.get(key, ())), f"{key!r} says {PHRASES.get(key)!r}"


def test_every_check_is_owed_by_a_sentence() -> None:
    assert set(DEMANDS.values()) == wording_check.OBLIGATIONS


def test_every_property_that_is_asserted_can_be_checked() -> None:
    assert {name for names in ASSERTS.values() for name in names} <= PREDICATES.keys()


def test_an_unknown_obligation_is_refused_with_its_phrase() -> None:
    with pytest.raises(ValueError, match=r"'full_rank': 'says_rank_ful'"):
        wording_check.require_known({**DEMANDS, "full_rank": "says_rank_ful"})


@pytest.mark.parametrize("module", [check, wording_check], ids=["check", "wording_check"])
def test_the_checker_knows_no_phrase(module: ModuleType) -> None:
    tree = ast.parse(Path(str(module.__file__)).read_text(encoding="utf-8"))
    assert not {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)} & PHRASES.keys()
