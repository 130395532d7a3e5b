"""Observability and controllability."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "observability_matrix": "The observability matrix is",
    "controllability_matrix": "The controllability matrix is",
    "yes_observability": "Hence $O$ has full rank and ($C$, $A$) is observable.",
    "yes_controllability": "Hence $Ctr$ has full rank and ($A$, $B$) is controllable.",
    "full_rank_observability": "Since {rank}, the pair ($C$, $A$) is observable.",
    "full_rank_controllability": "Since {rank}, the pair ($A$, $B$) is controllable.",
    "generic_rank_observability": "For generic parameter values {rank}, and the pair ($C$, $A$) is observable; the exceptions follow.",
    "generic_rank_controllability": "For generic parameter values {rank}, and the pair ($A$, $B$) is controllable; the exceptions follow.",
    "repair_one_observability": "The pair becomes observable if {states} is also measured.",
    "repair_several_observability": "The pair becomes observable if {states} are also measured.",
    "repair_one_controllability": "The pair becomes controllable if {states} is also actuated.",
    "repair_several_controllability": "The pair becomes controllable if {states} are also actuated.",
    "case_rank": "In this case {rank}.",
    "case_zero": "In this case the matrix is zero.",
    "kernel_basis_observability": "These columns span the unobservable subspace:",
    "kernel_basis_controllability": "These columns span the orthogonal complement of the controllable subspace:",
    "long_observability": "Its determinant has {count} terms and is not displayed. The pair ($C$, $A$) is observable if and only if it is nonzero.",
    "long_controllability": "Its determinant has {count} terms and is not displayed. The pair ($A$, $B$) is controllable if and only if it is nonzero.",
    "undecided_long": "The case in which a factor of {count} terms vanishes is not decided here.",
    "undecided_many": "The case in which {when} and further polynomials ({count}) vanish simultaneously is not decided here.",
    "undecided_rank": "The case in which the rank is below its generic value is not decided here: the minors are too long to display.",
    "undecided_case": "The case in which {when} vanishes is not decided here.",
    "undecided_apart": "Not everything is decided here where {when} does not vanish.",
    "undecided_positive": "Not everything is decided here where {when} is positive.",
    "undecided_together": "The case in which {when} and {other} vanish simultaneously is not decided here.",
    "provided_observability": "The pair ($C$, $A$) is observable if and only if this determinant is nonzero§. What follows holds for {condition}; the remaining cases are treated at the end.",
    "provided_controllability": "The pair ($A$, $B$) is controllable if and only if this determinant is nonzero§. What follows holds for {condition}; the remaining cases are treated at the end.",
    "outside_drops": "What follows holds for {condition}.",
    "no_observability": "Here {rank}, so the pair ($C$, $A$) is not observable.",
    "no_controllability": "Here {rank}, so the pair ($A$, $B$) is not controllable.",
    "generic_low_observability": "For generic parameter values {rank}, and for no values is it larger, so the pair ($C$, $A$) is not observable.",
    "generic_low_controllability": "For generic parameter values {rank}, and for no values is it larger, so the pair ($A$, $B$) is not controllable.",
    "kernel_observability": "The following vector lies in the unobservable subspace:",
    "kernel_controllability": "The following vector is orthogonal to the controllable subspace:",
    "kernel_several_observability": "The following vectors lie in the unobservable subspace:",
    "kernel_several_controllability": "The following vectors are orthogonal to the controllable subspace:",
    "modes_observability": "The unobservable <mode is|modes are> {modes}.",
    "modes_controllability": "The uncontrollable <mode is|modes are> {modes}.",
}

QUESTIONS: dict[str, str] = {
    "ask observability": "Is the pair ($C$, $A$) observable?",
    "ask controllability": "Is the pair ($A$, $B$) controllable?",
}

DEMANDS: dict[str, str] = {
    "yes_observability": "observable C A",
    "yes_controllability": "observable Bᵀ Aᵀ",
    "full_rank_observability": "says_observable_everywhere C A",
    "full_rank_controllability": "says_observable_everywhere Bᵀ Aᵀ",
    "generic_rank_observability": "says_observable C A",
    "generic_rank_controllability": "says_observable Bᵀ Aᵀ",
    "no_observability": "says_unobservable_everywhere C A",
    "no_controllability": "says_unobservable_everywhere Bᵀ Aᵀ",
    "generic_low_observability": "says_unobservable C A",
    "generic_low_controllability": "says_unobservable Bᵀ Aᵀ",
    "kernel_observability": "unseen C A",
    "kernel_controllability": "unseen Bᵀ Aᵀ",
    "kernel_several_observability": "unseen C A",
    "kernel_several_controllability": "unseen Bᵀ Aᵀ",
    "kernel_basis_observability": "spans_unseen C A",
    "kernel_basis_controllability": "spans_unseen Bᵀ Aᵀ",
    "repair_one_observability": "repairs C A",
    "repair_one_controllability": "repairs Bᵀ Aᵀ",
    "repair_several_observability": "repairs C A",
    "repair_several_controllability": "repairs Bᵀ Aᵀ",
    "case_zero": "zero O Ctr",
    "modes_observability": "modes C A N X",
    "modes_controllability": "modes Bᵀ Aᵀ N_K X_K N X",
    "observability_matrix": "tests C A",
    "controllability_matrix": "tests Bᵀ Aᵀ",
}

RESTS_ON: dict[str, str] = {
    "yes_observability": "observability_rank",
    "full_rank_observability": "observability_rank",
    "generic_rank_observability": "observability_rank",
    "provided_observability": "observability_rank",
    "no_observability": "observability_rank",
    "yes_controllability": "controllability_rank",
    "full_rank_controllability": "controllability_rank",
    "generic_rank_controllability": "controllability_rank",
    "provided_controllability": "controllability_rank",
    "no_controllability": "controllability_rank",
    "generic_low_observability": "observability_rank",
    "generic_low_controllability": "controllability_rank",
}

THEOREMS: dict[str, str] = {
    "observability_rank": "kalman1963; kailath1980, ch. 2",
    "controllability_rank": "kalman1963a",
}

NAMING = (
    "undecided_case",
    "undecided_apart",
    "undecided_positive",
    "undecided_together",
    "undecided_many",
)
