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
from symobs.proof.derivation.facts import PREDICATES

if TYPE_CHECKING:
    from types import ModuleType

#: Obligations, and the sentences that owe them.
DEMANDED = {
    "about F": """
        compensator_proper compensator_stable compensator_stable_if compensator_stable_low
        compensator_unstable compensator_unstable_low
    """,
    "about F stable": "minimal_stable minimal_stable_if",
    "about F strictly_proper unstable, loop stable": "compensator_unstable_alone compensator_unstable_low_alone",
    "about F unstable": "minimal_unstable",
    "about F unstable, loop stable": "minimal_unstable_alone",
    "about P": "no_stable_compensator",
    "about chi_K stable, exceeds A B Q_x R_u N_x P_r K_r": "optimal_rounded_feedback",
    "about chi_L stable, exceeds Aᵀ Cᵀ Q_x V_n N_x P_r L_rᵀ": "optimal_rounded_filter",
    "about P_l positive_definite": "lyapunov_definite lyapunov_definite_if",
    "about phi_c": "integral_rest_stable regulation_reached",
    "about phi_c unstable marginal, continuous_time": "drifts_state_feedback_continuous",
    "about phi_c unstable marginal, discrete_time": "drifts_state_feedback_discrete",
    "about phi_c, continuous_time": """
        grows_state_feedback_continuous lasts_servo_continuous lasts_state_feedback_continuous
        stays_state_feedback_continuous
    """,
    "about phi_c, discrete_time": """
        grows_state_feedback_discrete lasts_servo_discrete lasts_state_feedback_discrete
        stays_state_feedback_discrete
    """,
    "about phi_o, continuous_time": "grows_observer_continuous lasts_observer_continuous stays_observer_continuous",
    "about phi_o, discrete_time": "grows_observer_discrete lasts_observer_discrete stays_observer_discrete",
    "annuls w_0 C": "outputs_dependent",
    "annuls w_0 G_0": "no_feedforward_low",
    "annuls w_d B": "tracking_impossible_one",
    "annuls w_d B A−A_ref": "tracking_impossible",
    "annuls w_d Ctr d_r": "energy_unreachable",
    "applies_image": "mapped mapped_from_v",
    "blocked S_w": "regulation_rank",
    "blocked_there S_w": "regulation_zeros",
    "bounded X mu": "semisimple",
    "chained X mu": "grows",
    "continuous_time": """
        asks_detectability_continuous asks_stabilizability_continuous beyond_continuous equilibrium_continuous
        hides_continuous integral_state_continuous kalman_noise_continuous kalman_noise_through_continuous
        lowest_terms_unstable_continuous lqr_cost_continuous lqr_cost_cross_continuous marginal_continuous
        nonlinear_continuous sought_continuous
    """,
    "continuous_time, of_pairs A, ends !=, continuous_time": "lyapunov_regular_continuous",
    "continuous_time, of_pairs A, ends =, continuous_time": "lyapunov_singular_continuous",
    "continuous_time, optimal A B Q_x R_u N_x P_x K chi_K, zero N_x, single Bᵀ": "optimal_margins",
    "continuous_time, refutes_lyapunov A Q_l X_l, continuous_time": "lyapunov_impossible_continuous",
    "counts_degree": "pair_remains some_on_circle",
    "counts_dominant": "pair_dominates",
    "counts_names": "crossing crossing_infinite crossing_one",
    "counts_names, discrete_time": "crossing_discrete crossing_one_discrete",
    "counts_steps": "gramian_steps",
    "dimension Bᵀ Aᵀ": "dimension_state_feedback",
    "dimension C A": "dimension_observer",
    "encloses A B Q_x R_u N_x P_r K_r": "optimal_feedback_enclosed",
    "encloses Aᵀ Cᵀ Q_x V_n N_x P_r L_rᵀ": "optimal_filter_enclosed",
    "free_parts C A": "family_hidden_observer",
    "free_parts Bᵀ Aᵀ": "family_hidden_state_feedback",
    "on_boundary Q_N A_N N X": "optimal_on_boundary",
    "on_boundary Q_x Aᵀ N_K X_K": "optimal_filter_on_boundary",
    "optimal A B Q_x R_u N_x P_x K chi_K": "optimal_feedback_found",
    "optimal Aᵀ Cᵀ Q_x V_n N_x P_x Lᵀ chi_L": "optimal_filter_found",
    "shared_roots A phi_o": "spectra_meet_observer",
    "shared_roots A phi_c": "spectra_meet_state_feedback",
    "of_damping": "pattern_damping",
    "finding, discrete_time": "cells_decide_discrete",
    "fixes C A N X phi_o, misses X phi_o": "impossible_roots_observer",
    "fixes Bᵀ Aᵀ N_K X_K phi_c, misses X_K phi_c": "impossible_roots_state_feedback",
    "modes_unstable Bᵀ Aᵀ N_K X_K mu": "never_converges_state_feedback optimal_not_stabilizable",
    "splits c_even p_s": "optimal_factor",
    "unseen C A, of_low_rank": "pbh_low_observability",
    "unseen Bᵀ Aᵀ, of_low_rank": "pbh_low_controllability",
    "discrete_time": """
        asks_detectability_discrete asks_stabilizability_discrete beyond_discrete equilibrium_discrete
        hides_discrete integral_state_discrete kalman_noise_discrete kalman_noise_through_discrete
        lowest_terms_unstable_discrete lqr_cost_cross_discrete lqr_cost_discrete marginal_discrete
        nonlinear_discrete sought_discrete
    """,
    "discrete_time, of_pairs A, ends !=, discrete_time": "lyapunov_regular_discrete",
    "discrete_time, of_pairs A, ends =, discrete_time": "lyapunov_singular_discrete",
    "discrete_time, refutes_lyapunov A Q_l X_l, discrete_time": "lyapunov_impossible_discrete",
    "duals Bᵀ Aᵀ C_dual A_dual": "dual_ranks_controlling",
    "duals C A B_dualᵀ A_dualᵀ": "dual_ranks_observing",
    "eigenvalues_of A": "eigenvalues its_roots open_eigenvalues_observer open_eigenvalues_state_feedback",
    "eigenvalues_of A_22, spectrum A_22": "mere_copy_grows",
    "exactly Bᵀ Aᵀ N X": "exactly_there_stabilizability",
    "exactly C A N X": "exactly_there_detectability",
    "exhausts Bᵀ Aᵀ N_K X_K phi_c": "no_others_state_feedback",
    "exhausts C A N X phi_o": "no_others_observer",
    "finding": """
        box_bounded box_unbounded cells_decide connected_bounded connected_unbounded curve_missing hole
        number_is_root pieces numbers_are_roots point_missing region_empty region_everywhere
        values_decide zero_decides zeros_decide
        routh_changes routh_changes_axis routh_criterion_negative routh_criterion_positive
        routh_criterion_where routh_divides routh_epsilon routh_misleads routh_negative routh_not_stable
        routh_positive routh_zero_row
    """,
    "fixes A_12 A_22 N_2 X_2 phi_o": "reduced_impossible reduced_not_unique reduced_unassignable",
    "fixes A_12 A_22 N_2 X_2 phi_o, exhausts A_12 A_22 N_2 X_2 phi_o": "reduced_all_fixed",
    "fixes B_hatᵀ A_hatᵀ N_K X_K phi_c": "integral_impossible integral_unassignable",
    "fixes Bᵀ Aᵀ N_K X_K phi_c": """
        case_no_state_feedback case_other_state_feedback case_same_state_feedback case_survives_state_feedback
        fixed_but_wanted_state_feedback impossible_state_feedback unassignable_state_feedback
    """,
    "fixes C A N X phi_o": """
        case_no_observer case_other_observer case_same_observer case_survives_observer
        fixed_but_wanted_observer impossible_observer modes_missed unassignable_observer
    """,
    "fixes C A_T N X phi_o": "uio_impossible uio_unassignable uio_zeros_desired",
    "fixes C_hat A_hat N X phi_o": "disturbance_fixed disturbance_impossible disturbance_unassignable",
    "introduces_degree_one": "one_from_settling one_on_circle",
    "is A_dual Aᵀ": "dual_positive",
    "is_characteristic chi A": "lyapunov_polynomial",
    "is_constant b_P": "no_zeros",
    "is_constant phi_r": "none_remains",
    "is_constant phi_z": "no_zeros_taken",
    "is_negative A_dual Aᵀ": "dual_negative",
    "loop unstable, continuous_time": "loop_unstable_continuous",
    "loop unstable, discrete_time": "loop_unstable_discrete",
    "lower_rank C E_d": "uio_not_decoupled uio_not_decoupled_along",
    "minors P_l": "lyapunov_minors lyapunov_not_definite",
    "modes Bᵀ Aᵀ N X": "fixed_modes_controllability on_kernel_controllability",
    "modes Bᵀ Aᵀ N_K X_K N X": "modes_controllability",
    "modes C A N X": "fixed_modes_observability modes_observability on_kernel_observability",
    "modes_stable Bᵀ Aᵀ N X mu": "yes_stabilizability",
    "modes_stable C A N X mu": "yes_detectability",
    "modes_stable C A_T N X mu": "uio_zeros_stable",
    "modes_unstable Bᵀ Aᵀ N X mu": "no_stabilizability",
    "modes_unstable C A N X mu": "no_detectability optimal_not_detectable",
    "modes_unstable C A_T N X mu": "uio_zeros_unstable",
    "moves_by_margin": "moved_right",
    "needs_rank_full, annuls w_0 G_0": "no_feedforward_zero",
    "no_effect C A B": "nothing_remains",
    "no_effect C A B, no_feedthrough": "no_feedforward_none no_response",
    "no_gain": "impossible_zero impossible_zero_unless",
    "nonsingular M": "kernel_none_of_sum",
    "nonsingular W": "gramian_regular steps_nonsingular_controllability steps_nonsingular_observability",
    "not_unique A_12 A_22": "one_of_several",
    "not_unique B_hatᵀ A_hatᵀ": "integral_family",
    "not_unique Bᵀ Aᵀ": "family_state_feedback",
    "not_unique C A": "family_observer",
    "not_unique C A_T": "uio_family",
    "not_unique C_hat A_hat": "disturbance_family",
    "observable B_hatᵀ A_hatᵀ, continuous_time": "integral_possible_origin",
    "observable B_hatᵀ A_hatᵀ, discrete_time": "integral_possible_one",
    "observable Bᵀ Aᵀ": """
        any_state_feedback assignable_state_feedback no_fixed_modes_controllability pbh_yes_controllability
        yes_controllability
    """,
    "observable Bᵀ Aᵀ, canonical": "already_canonical",
    "observable C A": """
        any_observer assignable_observer frozen_instant frozen_misled_yes initial_found
        no_fixed_modes_observability pbh_yes_observability samples_found stack_yes_if yes_observability
    """,
    "observable C_hat A_hat": "disturbance_zeros_model",
    "one_rank C E_d": "uio_decoupled",
    "pole_defective": "defective defective_instead",
    "poles_of P": "its_poles",
    "poles_of phi_c": "control_pole control_poles control_polynomial",
    "poles_of phi_o": "observer_pole observer_poles observer_polynomial",
    "has_margins chi_cl chi_o": "margins_any_phase margins_are",
    "is chi_cl chi_o": "margins_no_loop",
    "about chi_cl": "margins_none margins_stable",
    "loop stable": "regulation_reached_estimated",
    "refutes_regulator": "regulation_impossible",
    "refutes_regulator E_d": "regulation_impossible_E",
    "repairs Bᵀ Aᵀ": "repair_one_controllability repair_several_controllability",
    "repairs C A": "repair_one_observability repair_several_observability",
    "reverses chi_r chi": "lyapunov_reversed",
    "says_decay": "decayed",
    "says_observable Bᵀ Aᵀ": "generic_rank_controllability",
    "says_observable C A": "case_stack_yes generic_rank_observability stack_yes",
    "says_observable_everywhere A_12 A_22": "first_part_measures",
    "says_observable_everywhere Bᵀ Aᵀ": "full_rank_controllability",
    "says_observable_everywhere C A": "full_rank_observability",
    "says_observable_everywhere C A_T": "uio_observable",
    "says_observable_everywhere C_hat A_hat": "disturbance_observable",
    "says_overshoot": "overshoot_held",
    "says_overshoot_above": "overshoot_close",
    "says_rank_full, observable C_hat A_hat, continuous_time": "disturbance_zeros_origin",
    "says_rank_full, observable C_hat A_hat, discrete_time": "disturbance_zeros_one",
    "says_rank_low, unobservable C_hat A_hat, continuous_time": "disturbance_blocked_origin",
    "says_rank_low, unobservable C_hat A_hat, discrete_time": "disturbance_blocked_one",
    "says_regular_at C A": "stack_yes_at stack_yes_on",
    "says_unobservable Bᵀ Aᵀ": "generic_low_controllability integral_uncontrollable",
    "says_unobservable C A": "case_stack generic_low_observability stack_no",
    "says_unobservable_everywhere Bᵀ Aᵀ": "no_controllability",
    "says_unobservable_everywhere C A": "no_observability",
    "scales_by_radius": "enlarged",
    "seen Bᵀ Aᵀ N_K X_K": "gramian_diverges_controllability gramian_infinite_controllability",
    "seen C A N X": "gramian_diverges_observability gramian_infinite_observability",
    "sets_margin": "sought_margin wanted_margin",
    "sets_meaning": "means_lyapunov",
    "sets_radius": "sought_radius wanted_radius",
    "shares_kernel Bᵀ Aᵀ, nonsingular M": "kernel_none_controllability",
    "shares_kernel C A": "kernel_shared",
    "shares_kernel C A, nonsingular M": "kernel_none",
    "shown, continuous_time": "stable_continuous stable_if_continuous unstable_continuous",
    "shown, discrete_time": "stable_discrete stable_if_discrete unstable_discrete",
    "single Bᵀ": "one_gain_only_state_feedback row_reduced_unique_state_feedback",
    "single C": "one_gain_only_observer row_reduced_unique_observer",
    "solves W lam_e d_r": "energy_multiplier",
    "solves W lam_e d_r, continuous_time": "energy_input energy_spent",
    "solves W lam_e d_r, discrete_time": "energy_sequence",
    "solves_homogeneous A N_l": "lyapunov_added lyapunov_one_of_many",
    "solves_lyapunov P_l Q_l A": "lyapunov_stable lyapunov_stable_if lyapunov_unstable",
    "spans_kernel": "steps_kernel_controllability steps_kernel_observability",
    "spans_unseen Bᵀ Aᵀ": "kernel_basis_controllability",
    "spans_unseen C A": "kernel_basis_observability",
    "spectrum A": "only_stable",
    "spectrum A_22": "mere_copy_fails",
    "spectrum A_c, continuous_time": "law_unstable_continuous",
    "spectrum A_c, discrete_time": "law_unstable_discrete",
    "spectrum X": "marginal_if",
    "substitutes_law": "observer_closed observer_closed_matrix",
    "sums_powers": "finite_sum_is",
    "tests B_dualᵀ A_dualᵀ": "dual_controllability",
    "tests Bᵀ Aᵀ": "controllability_matrix plant_controllability",
    "tests C A": "observability_matrix plant_observability",
    "tests C_dual A_dual": "dual_observability",
    "unobservable B_hatᵀ A_hatᵀ": "integral_blocked",
    "unobservable Bᵀ Aᵀ": "pbh_no_controllability",
    "unobservable C A": "frozen_misled_no initial_not_unique pbh_no_observability x0_not_unique",
    "unseen Bᵀ Aᵀ": "kernel_controllability kernel_several_controllability",
    "unseen C A": "kernel_observability kernel_several_observability",
    "vanishes C Phi v": "gramian_singular never_seen_start",
    "vanishes C exp_At v": "kernel_unseen kernel_unseen_several",
    "zero G_0": "no_feedforward_single",
    "zero K_d": "tracking_no_feedforward",
    "zero O Ctr": "case_zero",
    "zeros_of P": "its_zeros no_zero",
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
    "positive_definite": "lyapunov_definite lyapunov_stable_if",
    "positive_definite stable": "lyapunov_stable",
    "positive_definite unstable": "lyapunov_unstable",
    "polynomial": """
        case_other_observer case_other_state_feedback case_same_observer case_same_state_feedback
        case_survives_observer case_survives_state_feedback fixed_but_wanted_observer
        fixed_but_wanted_state_feedback loop_no_poles no_zero reduced_all_fixed reduced_not_unique
    """,
    "stable": """
        case_everywhere gramian_infinite_controllability gramian_infinite_observability only_stable
        margins_stable optimal_feedback_found optimal_filter_found optimal_rounded_feedback optimal_rounded_filter
        regulation_reached regulation_reached_estimated
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
        gramian_diverges_controllability gramian_diverges_observability hides_continuous hides_discrete
        lasts_observer_continuous lasts_observer_discrete lasts_state_feedback_continuous
        lasts_state_feedback_discrete law_unstable_continuous law_unstable_discrete
        lowest_terms_unstable_continuous lowest_terms_unstable_discrete optimal_not_detectable
        optimal_not_stabilizable unstable_continuous unstable_discrete
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
    owed = {name for text in DEMANDS.values() for name, *_ in wording_check.obligations(text)}
    assert owed == wording_check.OBLIGATIONS


def test_every_property_that_is_asserted_can_be_checked() -> None:
    assert {name for names in ASSERTS.values() for name in names} <= PREDICATES.keys()


def test_an_unknown_obligation_is_refused_with_its_phrase() -> None:
    with pytest.raises(ValueError, match=r"'full_rank': 'says_rank_ful'"):
        wording_check.require_known({**DEMANDS, "full_rank": "says_rank_ful"})


@pytest.mark.parametrize("module", [check, wording_check], ids=["check", "wording_check"])
def test_the_checker_knows_no_phrase(module: ModuleType) -> None:
    tree = ast.parse(Path(str(module.__file__)).read_text("utf-8"))
    assert not {node.value for node in ast.walk(tree) if isinstance(node, ast.Constant)} & PHRASES.keys()
