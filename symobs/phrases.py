"""Every sentence a derivation can say, in one place: the language of the prose lives here and nowhere else.

A phrase is plain text with slots in braces; a slot is filled by a formula or fact (set as mathematics) or by a word.
Steps name a phrase by its key; a step whose slots do not match its phrase cannot be made.
"""

from __future__ import annotations

import string

PHRASES: dict[str, str] = {
    # titles
    "given": "Given.",
    "observability": "Observability.",
    "controllability": "Controllability.",
    "characteristic_polynomial": "Characteristic polynomial.",
    "transfer_function": "Transfer function.",
    "state_feedback": "State feedback.",
    "observer": "Observer.",
    "compensator": "Compensator.",
    "closed_loop": "Closed loop.",
    # data
    "realised": "We realise it in controllable canonical form.",
    "declared": "Throughout, {sign}.",
    "desired_poles": "The desired poles are {poles}.",
    "desired_polynomial": "The desired polynomial is {polynomial}.",
    "control_poles": "The control poles are to be {poles}.",
    "control_polynomial": "The control polynomial is to be {polynomial}.",
    "observer_poles": "The observer poles are to be {poles}.",
    "observer_polynomial": "The observer polynomial is to be {polynomial}.",
    # polynomials and transfer functions
    "its_characteristic_polynomial": "It is",
    "its_roots": "Its roots are {roots}.",
    "its_transfer_function": "Adjugate over determinant gives",
    "cancelled": "A common factor cancelled: a realisation of order {order} has the same transfer function.",
    "its_poles": "Its poles are {roots}.",
    "its_zeros": "Its zeros are {roots}.",
    # gains
    "assignable_observer": "So the poles of A − LC can be placed at will (Theorem 4.4).",
    "assignable_state_feedback": "So the poles of A − BK can be placed at will.",
    "asks_observer": "The observer poles ask for",
    "asks_state_feedback": "The control poles ask for",
    "coefficients": "with the coefficients",
    "already_canonical": "The pair (A, B) is already in controllable canonical form, with {chi}, so the gain is the difference of "
    "coefficients, constant first.",
    "difference_of_coefficients": "Hence",
    "open_observer": "We place them for the dual pair (Aᵀ, Cᵀ). The characteristic polynomial is",
    "open_state_feedback": "The characteristic polynomial is",
    "canonical_observer": "The transformation that brings the dual pair to controllable canonical form is",
    "canonical_state_feedback": "The transformation that brings the pair to controllable canonical form is",
    "inverse_of_V": "with {determinant} and",
    "row_observer": "The differences of coefficients, constant first, carried back by the inverse, give",
    "row_state_feedback": "The differences of coefficients, constant first, carried back by the inverse, give",
    "last_column": "Ackermann's formula needs the last column of the inverse of the observability matrix,",
    "last_row": "Ackermann's formula needs the last row of the inverse of the controllability matrix,",
    "ackermann_observer": "The gain is the desired polynomial at A times this column,",
    "ackermann_state_feedback": "The gain is this row times the desired polynomial at A,",
    "as_required": "{check}, as required.",
    "fixed_but_wanted_observer": "The unobservable modes {roots} stay whatever the gain is; they are among the poles asked for.",
    "fixed_but_wanted_state_feedback": "The uncontrollable modes {roots} stay whatever the gain is; they are among the poles "
    "asked for.",
    "one_gain_observer": "One gain that places the others is",
    "one_gain_state_feedback": "One gain that places the others is",
    "family_observer": "All of them are {gain}.",
    "family_state_feedback": "All of them are {gain}.",
    "impossible_observer": "Every gain leaves the factor {fixed} in the polynomial of A − LC, and it does not divide {polynomial}: no "
    "gain places these poles.",
    "impossible_state_feedback": "Every gain leaves the factor {fixed} in the polynomial of A − BK, and it does not divide "
    "{polynomial}: no gain places these poles.",
    "gain_given_observer": "The observer gain is given,",
    "gain_given_state_feedback": "The feedback gain is given,",
    "its_polynomial": "Its characteristic polynomial is",
    "stable_continuous": "All its roots lie in the open left half plane: stable.",
    "stable_discrete": "All its roots lie inside the unit circle: stable.",
    "unstable_continuous": "Not all its roots lie in the open left half plane: not stable.",
    "unstable_discrete": "Not all its roots lie inside the unit circle: not stable.",
    "stable_if_continuous": "All its roots lie in the open left half plane exactly where {where}.",
    "stable_if_discrete": "All its roots lie inside the unit circle exactly where {where}.",
    "case_survives_observer": "There the pair (C, A) is not observable, but the fixed mode {modes} is among the poles asked for, so this "
    "L still works (it is no longer the only one).",
    "case_survives_state_feedback": "There the pair (A, B) is not controllable, but the fixed mode {modes} is among the poles asked "
    "for, so this K still works (it is no longer the only one).",
    "case_other_observer": "There the pair (C, A) is not observable, but the fixed mode {modes} is among the poles asked for; one gain "
    "that works there is {gain}.",
    "case_other_state_feedback": "There the pair (A, B) is not controllable, but the fixed mode {modes} is among the poles asked for; "
    "one gain that works there is {gain}.",
    "case_no_observer": "There the pair (C, A) is not observable and its fixed mode {modes} is not among the poles asked for: no gain "
    "exists.",
    "case_no_state_feedback": "There the pair (A, B) is not controllable and its fixed mode {modes} is not among the poles asked for: no "
    "gain exists.",
    "undecided_observer": "What is true where {when} vanishes is not decided here.",
    "undecided_state_feedback": "What is true where {when} vanishes is not decided here.",
    # the observer itself
    "observer_equation": "The observer copies the plant and corrects it by the output error,",
    "error_equation": "so the error {error} obeys, whatever the input,",
    "observer_collected": "Collected, with these numbers,",
    # the compensator
    "separation": "By the separation principle the feedback uses the estimate,",
    "observer_closed": "so the observer, fed by the output only, becomes",
    "compensator_matrix": "where",
    "transfer_function_of_compensator": "Its transfer function from Y to −U, equation (4.25), is",
    "compensator_stable": "It is strictly proper and stable.",
    "compensator_unstable": "It is strictly proper, and it is not stable itself; the loop is.",
    "compensator_proper": "It is strictly proper.",
    "control_in_error": "With the estimation error, (4.27) and (4.28) are",
    "closed_loop_matrix": "and together with the error equation they give (4.29), whose matrix is block triangular,",
    "polynomial_splits": "so its polynomial is the product of those of the feedback and of the observer,",
    "estimate_coordinates": "In the coordinates of state and estimate the same loop reads",
    "plant_transfer": "The plant has the transfer function",
    "return_path": "With F in the return path of a negative feedback loop,",
    "loop_poles": "The poles {poles} are those of the state feedback and those of the observer, as they must be.",
    "defective": "The repeated pole {pole} is defective, since {matrix} is not zero: its exponential comes with a power of t, so the "
    "transients are not bounded by a multiple of the exponential alone. Distinct poles avoid this.",
    # rank tests
    "observability_matrix": "The observability matrix stacks the output and what its derivatives show of the state,",
    "controllability_matrix": "The controllability matrix collects what the input and its derivatives reach,",
    "yes_observability": "It has full rank, so the pair (C, A) is observable.",
    "yes_controllability": "It has full rank, so the pair (A, B) is controllable.",
    "full_rank_observability": "Since {rank}, the pair (C, A) is observable.",
    "full_rank_controllability": "Since {rank}, the pair (A, B) is controllable.",
    "provided_observability": "The pair (C, A) is observable only where {condition}, which we assume from here on.",
    "provided_controllability": "The pair (A, B) is controllable only where {condition}, which we assume from here on.",
    "no_observability": "Here {rank}, so the pair (C, A) is not observable.",
    "no_controllability": "Here {rank}, so the pair (A, B) is not controllable.",
    "kernel_observability": "A state in this direction is never seen at the output,",
    "kernel_controllability": "The input never moves the state along this row,",
    "modes_observability": "The unobservable modes are {modes}.",
    "modes_controllability": "The uncontrollable modes are {modes}.",
}


def slots_of(key: str) -> frozenset[str]:
    """Return the names of the slots of a phrase."""
    return frozenset(name for _, name, _, _ in string.Formatter().parse(PHRASES[key]) if name)
