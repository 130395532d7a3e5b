"""Every sentence a derivation can say, in one place: the language of the prose lives here and nowhere else.

A phrase is plain text with slots in braces, filled by a formula or fact (set as mathematics) or by a word; between dollar
signs stand formulas in the letters of `notation` that only name things.  Steps name a phrase by its key; a step whose slots do not match its
phrase cannot be made.  `RESTS_ON` says which theorem a phrase appeals to, so that the page can name its source.
"""

from __future__ import annotations

import string

TITLES: dict[str, str] = {
    "given": "Given.",
    "observability": "Observability.",
    "controllability": "Controllability.",
    "characteristic_polynomial": "Characteristic polynomial.",
    "transfer_function": "Transfer function.",
    "state_feedback": "State feedback.",
    "observer": "Observer.",
    "compensator": "Compensator.",
    "closed_loop": "Closed loop.",
}

DATA: dict[str, str] = {
    "realised": "In controllable canonical form this is",
    "declared": "Throughout, {signs}.",
    "desired_poles": "The poles asked for are {poles}.",
    "desired_polynomial": "The polynomial asked for is {polynomial}.",
    "control_poles": "The control poles are to be {poles}.",
    "control_polynomial": "The control polynomial is to be {polynomial}.",
    "observer_poles": "The observer poles are to be {poles}.",
    "observer_polynomial": "The observer polynomial is to be {polynomial}.",
}

POLYNOMIALS: dict[str, str] = {
    "its_characteristic_polynomial": "The characteristic polynomial is",
    "its_roots": "Its roots are {roots}.",
    "its_transfer_function": "Adjugate over determinant gives",
    "cancelled": "A common factor cancelled: a realisation of order {order} has the same transfer function.",
    "its_poles": "The poles are {roots}.",
    "its_zeros": "The zeros are {roots}.",
    "stable_continuous": "All its roots lie in the open left half plane: it is stable.",
    "stable_discrete": "All its roots lie inside the unit circle: it is stable.",
    "unstable_continuous": "Not all its roots lie in the open left half plane: it is not stable.",
    "unstable_discrete": "Not all its roots lie inside the unit circle: it is not stable.",
    "stable_if_continuous": "All its roots lie in the open left half plane exactly where {where}.",
    "stable_if_discrete": "All its roots lie inside the unit circle exactly where {where}.",
}

RANK: dict[str, str] = {
    "observability_matrix": "The observability matrix is",
    "controllability_matrix": "The controllability matrix is",
    "yes_observability": "It has full rank, so the pair ($C$, $A$) is observable.",
    "yes_controllability": "It has full rank, so the pair ($A$, $B$) is controllable.",
    "full_rank_observability": "Since {rank}, the pair ($C$, $A$) is observable.",
    "full_rank_controllability": "Since {rank}, the pair ($A$, $B$) is controllable.",
    "generic_rank_observability": "In general {rank}, and the pair ($C$, $A$) is observable; the exceptions follow.",
    "generic_rank_controllability": "In general {rank}, and the pair ($A$, $B$) is controllable; the exceptions follow.",
    "case_rank": "There {rank}.",
    "undecided_case": "What is true where {when} vanishes is not decided here.",
    "undecided_together": "What is true where {when} and {other} vanish together is not decided here.",
    "provided_observability": "The pair ($C$, $A$) is observable exactly where this is not zero. From here on we assume {condition}.",
    "provided_controllability": "The pair ($A$, $B$) is controllable exactly where this is not zero. From here on we assume {condition}.",
    "no_observability": "Here {rank}, so the pair ($C$, $A$) is not observable.",
    "no_controllability": "Here {rank}, so the pair ($A$, $B$) is not controllable.",
    "kernel_observability": "A state in this direction is never seen at the output:",
    "kernel_controllability": "The input never moves the state along this direction:",
    "modes_observability": "The unobservable modes are {modes}.",
    "modes_controllability": "The uncontrollable modes are {modes}.",
}

GAINS: dict[str, str] = {
    "assignable_observer": "By the pole assignment theorem the poles of $A - L C$ can therefore be placed at will.",
    "assignable_state_feedback": "By the pole assignment theorem the poles of $A - B K$ can therefore be placed at will.",
    "asks_observer": "The observer poles ask for",
    "asks_state_feedback": "The control poles ask for",
    "coefficients": "with the coefficients",
    "already_canonical": "The pair ($A$, $B$) is already in controllable canonical form, with {chi}, so the gain is the difference of "
    "coefficients, constant first.",
    "open_observer": "We place them for the dual pair ($Aᵀ$, $Cᵀ$), whose controllability matrix is $Oᵀ$ and whose characteristic polynomial is",
    "open_state_feedback": "The characteristic polynomial of $A$ is",
    "canonical_observer": "The dual pair is brought to controllable canonical form by",
    "canonical_state_feedback": "The pair is brought to controllable canonical form by",
    "row_observer": "There the gain is the row of differences of coefficients, constant first. Carried back it is",
    "row_state_feedback": "There the gain is the row of differences of coefficients, constant first. Carried back it is",
    "last_column": "Ackermann's formula takes the last column of the inverse of the observability matrix,",
    "last_row": "Ackermann's formula takes the last row of the inverse of the controllability matrix,",
    "ackermann_observer": "and puts $A$ into the polynomial asked for:",
    "ackermann_state_feedback": "and puts $A$ into the polynomial asked for:",
    "as_required": "{check}, as required.",
    "fixed_but_wanted_observer": "No gain moves the unobservable modes {roots}, but they are among the poles asked for.",
    "fixed_but_wanted_state_feedback": "No gain moves the uncontrollable modes {roots}, but they are among the poles asked for.",
    "one_gain_observer": "A gain that places the others is",
    "one_gain_state_feedback": "A gain that places the others is",
    "family_observer": "It is not the only one: all of them are {gain}.",
    "family_state_feedback": "It is not the only one: all of them are {gain}.",
    "impossible_observer": "Every gain leaves the factor {fixed} in the polynomial of $A - L C$, and this factor does not divide "
    "{polynomial}: no gain places these poles.",
    "impossible_state_feedback": "Every gain leaves the factor {fixed} in the polynomial of $A - B K$, and this factor does not divide "
    "{polynomial}: no gain places these poles.",
    "gain_given_observer": "The observer gain is given,",
    "gain_given_state_feedback": "The feedback gain is given,",
    "closed_matrix": "which makes",
    "its_polynomial": "The characteristic polynomial is",
    "case_survives_observer": "There the pair ($C$, $A$) is not observable, but its fixed mode {modes} is among the poles asked for, so this $L$ "
    "still works; it is no longer the only one.",
    "case_survives_state_feedback": "There the pair ($A$, $B$) is not controllable, but its fixed mode {modes} is among the poles asked for, "
    "so this $K$ still works; it is no longer the only one.",
    "case_other_observer": "There the pair ($C$, $A$) is not observable, but its fixed mode {modes} is among the poles asked for. A gain that "
    "works there is",
    "case_other_state_feedback": "There the pair ($A$, $B$) is not controllable, but its fixed mode {modes} is among the poles asked for. "
    "A gain that works there is",
    "case_no_observer": "There the pair ($C$, $A$) is not observable, and its fixed mode {modes} is not among the poles asked for: no gain "
    "places them.",
    "case_no_state_feedback": "There the pair ($A$, $B$) is not controllable, and its fixed mode {modes} is not among the poles asked for: no "
    "gain places them.",
}

COMPENSATION: dict[str, str] = {
    "observer_equation": "The observer is a copy of the plant, corrected by the output error:",
    "error_equation": "Whatever the input, the error {error} then obeys",
    "observer_collected": "Collected and with the numbers put in, the observer reads",
    "separation": "By the separation principle the control law uses the estimate in place of the state:",
    "observer_closed": "Put into the observer, it leaves a system that is driven by $y$ alone,",
    "compensator_matrix": "with the matrix",
    "transfer_function_of_compensator": "Its transfer function from $y$ to $-u$ is",
    "compensator_stable": "It is strictly proper and stable.",
    "compensator_unstable": "It is strictly proper. By itself it is not stable, although the loop is.",
    "compensator_proper": "It is strictly proper.",
    "compensator_stable_if": "It is strictly proper, and by itself stable exactly where {where}.",
    "control_in_error": "In terms of the error,",
    "closed_loop_matrix": "so that plant and error together are block triangular,",
    "polynomial_splits": "and the polynomial of the loop is the product of the two that were asked for:",
    "estimate_coordinates": "In state and estimate the same loop reads",
    "plant_transfer": "As a transfer function the plant is",
    "return_path": "With $F$ in the return path,",
    "no_stable_compensator": "At a zero of $P$ in the right half-plane its characteristic polynomial is negative. No stable compensator can stabilise such a plant.",
    "with_coefficients": "where",
    "named_entries": "From here on we write its entries as",
    "loop_poles": "Its poles {poles} are those of the state feedback and those of the observer, as they must be.",
    "loop_polynomial": "Its denominator is the product of the two polynomials asked for, as it must be.",
    "defective": "The repeated pole {pole} is defective, {matrix}, so the transients contain its exponential times a power of time and are "
    "not bounded by a multiple of the exponential alone. With distinct poles they are.",
}

PHRASES: dict[str, str] = TITLES | DATA | POLYNOMIALS | RANK | GAINS | COMPENSATION

#: The properties that a phrase asserts: a step that says it must have them among its facts, and so have been checked.
ASSERTS: dict[str, tuple[str, ...]] = {
    "stable_continuous": ("stable",),
    "stable_discrete": ("stable",),
    "unstable_continuous": ("unstable",),
    "unstable_discrete": ("unstable",),
    "compensator_stable": ("strictly_proper", "stable"),
    "compensator_unstable": ("strictly_proper", "unstable"),
    "compensator_proper": ("strictly_proper",),
    "compensator_stable_if": ("strictly_proper",),
    "no_stable_compensator": ("no_stable_compensator",),
} | {
    f"{phrase}_{kind}": (fact,)
    for kind in ("observer", "state_feedback")
    for phrase, fact in (
        ("fixed_but_wanted", "polynomial"),
        ("case_survives", "polynomial"),
        ("case_other", "polynomial"),
        ("case_no", "not_polynomial"),
        ("impossible", "not_polynomial"),
    )
}

#: Phrases that name a value and claim nothing of it: in all others a value stands with what it is the value of.
NAMING = frozenset({"undecided_case", "undecided_together"})

#: The theorem (a key of `notation.THEOREMS`) that a phrase appeals to.
RESTS_ON: dict[str, str] = {
    "yes_observability": "observability_rank",
    "full_rank_observability": "observability_rank",
    "generic_rank_observability": "observability_rank",
    "provided_observability": "observability_rank",
    "no_observability": "observability_rank",
    "yes_controllability": "duality",
    "provided_controllability": "duality",
    "no_controllability": "duality",
    "assignable_observer": "observer_poles",
    "open_observer": "duality",
    "canonical_observer": "canonical_form",
    "canonical_state_feedback": "canonical_form",
    "already_canonical": "canonical_form",
    "last_column": "ackermann",
    "last_row": "ackermann",
    "observer_equation": "observer",
    "error_equation": "error",
    "separation": "separation",
    "transfer_function_of_compensator": "compensator",
    "closed_loop_matrix": "closed_loop",
}


def slots_of(key: str) -> frozenset[str]:
    """Return the names of the slots of a phrase."""
    return frozenset(name for _, name, _, _ in string.Formatter().parse(PHRASES[key]) if name)
