"""Observability and controllability."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "observability_matrix": "The observability matrix is",
    "controllability_matrix": "The controllability matrix is",
    "yes_observability": "It has full rank, so the pair ($C$, $A$) is observable.",
    "yes_controllability": "It has full rank, so the pair ($A$, $B$) is controllable.",
    "full_rank_observability": "Since {rank}, the pair ($C$, $A$) is observable.",
    "full_rank_controllability": "Since {rank}, the pair ($A$, $B$) is controllable.",
    "generic_rank_observability": "In general {rank}, and the pair ($C$, $A$) is observable; the exceptions follow.",
    "generic_rank_controllability": "In general {rank}, and the pair ($A$, $B$) is controllable; the exceptions follow.",
    "repair_one_observability": "It becomes observable when {states} is measured as well.",
    "repair_several_observability": "It becomes observable when {states} are measured as well.",
    "repair_one_controllability": "It becomes controllable when {states} is actuated as well.",
    "repair_several_controllability": "It becomes controllable when {states} are actuated as well.",
    "case_rank": "There {rank}.",
    "case_zero": "There the matrix is zero.",
    "kernel_basis_observability": "States in the span of these columns are never seen at the output:",
    "kernel_basis_controllability": "The input never moves the state along these directions:",
    "long_observability": "Its determinant has {count} terms and is not written out. The pair ($C$, $A$) is observable exactly where it is not zero.",
    "long_controllability": "Its determinant has {count} terms and is not written out. The pair ($A$, $B$) is controllable exactly where it is not zero.",
    "undecided_long": "What is true where a factor of {count} terms vanishes is not decided here.",
    "undecided_many": "What is true where {when} and {count} further polynomials vanish together is not decided here.",
    "undecided_rank": "Where the rank is lower than in general is not decided here: the minors are too long to be written down.",
    "undecided_case": "What is true where {when} vanishes is not decided here.",
    "undecided_together": "What is true where {when} and {other} vanish together is not decided here.",
    "provided_observability": "The pair ($C$, $A$) is observable exactly where this is not zero§. From here on we assume {condition}.",
    "provided_controllability": "The pair ($A$, $B$) is controllable exactly where this is not zero§. From here on we assume {condition}.",
    "no_observability": "Here {rank}, so the pair ($C$, $A$) is not observable.",
    "no_controllability": "Here {rank}, so the pair ($A$, $B$) is not controllable.",
    "generic_low_observability": "In general {rank}, and nowhere more, so the pair ($C$, $A$) is not observable.",
    "generic_low_controllability": "In general {rank}, and nowhere more, so the pair ($A$, $B$) is not controllable.",
    "kernel_observability": "A state in this direction is never seen at the output:",
    "kernel_controllability": "The input never moves the state along this direction:",
    "modes_observability": "The unobservable <mode is|modes are> {modes}.",
    "modes_controllability": "The uncontrollable <mode is|modes are> {modes}.",
}

QUESTIONS: dict[str, str] = {
    "ask observability": "Is the pair ($C$, $A$) observable?",
    "ask controllability": "Is the pair ($A$, $B$) controllable?",
}

DEMANDS: dict[str, str] = {
    "yes_observability": "needs_rank_full",
    "yes_controllability": "needs_rank_full",
    "full_rank_observability": "says_rank_full",
    "full_rank_controllability": "says_rank_full",
    "generic_rank_observability": "says_rank_full",
    "generic_rank_controllability": "says_rank_full",
    "no_observability": "says_rank_low_everywhere",
    "no_controllability": "says_rank_low_everywhere",
    "generic_low_observability": "says_rank_low",
    "generic_low_controllability": "says_rank_low",
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

THEOREMS: dict[str, tuple[str, str]] = {
    "observability_rank": ("rank test for observability", "S0, Theorem 4.2"),
    "controllability_rank": ("rank test for controllability", "S0, Theorem 2.2, dual to Theorem 4.2"),
}

NAMING = (
    "undecided_case",
    "undecided_together",
    "undecided_many",
)
