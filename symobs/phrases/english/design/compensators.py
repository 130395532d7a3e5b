"""The observer, the compensator and the loop."""

from __future__ import annotations

_DEFECTIVE = (
    "The repeated pole {pole} is defective, {matrix}, so the transients contain its exponential times a power of time and are "
    "not bounded by a multiple of the exponential alone."
)

PHRASES: dict[str, str] = {
    "observer_equation": "The observer is a copy of the plant, corrected by the output error:",
    "error_equation": "Whatever the input, the error {error} then obeys",
    "feedthrough_cancels": "The output error does not contain the input, since the feedthrough cancels in it:",
    "deadbeat_error": "All poles lie at the origin, so the error is gone after finitely many steps, whatever it was: {gone}.",
    "observer_collected": "Collected, the observer reads",
    "observer_collected_with_feedthrough": "Collected, with $B - L D$ in place of $B$ so that the feedthrough does cancel, the observer reads",
    "in_components": "Component by component these are the equations",
    "right_estimate_stays": "An estimate that is right stays right: {consistent}.",
    "existence_ansatz": "Let a linear system be driven by what is known, with matrices still to be determined:",
    "existence_error": "Then {error} obeys",
    "existence_choice": "It is to vanish whatever state and input are. So both must go, which leaves no choice but",
    "existence_left": "and of the error there remains",
    "existence_observer": "With $H_x = L$ the observer is",
    "separation": "By the separation principle§ the control law uses the estimate in place of the state:",
    "observer_closed": "Put into the observer, it leaves a system of the order of the plant that is driven by $y$ alone,",
    "compensator_matrix": "with the matrix",
    "compensator_written": "Written out, the compensator is",
    "transfer_function_of_compensator": "Its transfer function from $y$ to $-u$ is",
    "compensator_stable": "It is strictly proper and stable.",
    "compensator_stable_low": "It is strictly proper, and stable by itself because all coefficients of {polynomial} are positive§.",
    "compensator_unstable": "It is strictly proper, but by itself it is not stable.",
    "compensator_unstable_alone": "It is strictly proper. By itself it is not stable, although the loop is.",
    "compensator_unstable_low": "It is strictly proper, but by itself not stable, since not all coefficients of {polynomial} are positive§.",
    "compensator_unstable_low_alone": "It is strictly proper. By itself it is not stable, since not all coefficients of {polynomial} are positive§, "
    "although the loop is.",
    "compensator_proper": "It is strictly proper.",
    "compensator_stable_if": "It is strictly proper, and by itself stable exactly where {where}.",
    "control_in_error": "In terms of the error,",
    "closed_loop_matrix": "so that plant and error together are block triangular,",
    "polynomial_splits": "and the polynomial of the loop is the product of the two that were asked for:",
    "estimate_coordinates": "In state and estimate the same loop reads",
    "unity_feedback": "With $F$ before the plant and unity feedback the reference acts on the output through another numerator,",
    "similar_loops": "The two matrices are similar through {turned}.",
    "plant_transfer": "As a transfer function the plant is",
    "return_path": "With $F$ in the return path, where the minus sign of the control law stands at the summing junction, the loop is",
    "return_difference": "With $F$ in the return path, where the minus sign of the control law stands at the summing junction, the loop has the "
    "return difference",
    "loop_after": "and therefore the transfer function",
    "no_stable_compensator": "At a zero of $P$ in the right half-plane its characteristic polynomial is negative. No stable compensator can stabilise such a plant.",
    "with_coefficients": "where",
    "named_entries": "From here on we write its entries as",
    "loop_poles": "The poles {poles} are those of the state feedback and those of the observer, as they must be.",
    "loop_matrix_poles": "The poles of its entries are among those of the state feedback and those of the observer.",
    "loop_poles_left": "The poles {poles} are among those of the state feedback and of the observer, as they must be; what cancels is {lost}.",
    "loop_pole_left": "The only pole, {poles}, is among those of the state feedback and of the observer, as it must be; what cancels is {lost}.",
    "loop_no_poles": "It has no poles: those of the state feedback and of the observer, {lost}, all cancel.",
    "loop_polynomial_divides": "The denominator divides the product of the two polynomials asked for, as it must.",
    "loop_polynomial": "The denominator is the product of the two polynomials asked for, as it must be.",
    "defective": _DEFECTIVE,
    "defective_instead": _DEFECTIVE + " With distinct poles they are, for example with {instead}.",
}

DEMANDS: dict[str, str] = {
    "compensator_unstable_alone": "needs_loop_stable",
    "compensator_unstable_low_alone": "needs_loop_stable",
    "defective": "needs_pole_defective",
    "defective_instead": "needs_pole_defective",
}

#: A new thought begins here.
OPENS = ("observer_equation", "existence_observer")

ASSERTS: dict[str, tuple[str, ...]] = {
    "compensator_stable": ("strictly_proper", "stable"),
    "compensator_unstable": ("strictly_proper", "unstable"),
    "compensator_unstable_alone": ("strictly_proper", "unstable", "stable"),
    "compensator_stable_low": ("strictly_proper", "stable"),
    "compensator_unstable_low": ("strictly_proper", "unstable"),
    "compensator_unstable_low_alone": ("strictly_proper", "unstable", "stable"),
    "compensator_proper": ("strictly_proper",),
    "compensator_stable_if": ("strictly_proper",),
    "loop_no_poles": ("polynomial",),
    "no_stable_compensator": ("no_stable_compensator",),
}

RESTS_ON: dict[str, str] = {
    "observer_equation": "observer",
    "existence_left": "existence",
    "error_equation": "error",
    "separation": "separation",
    "transfer_function_of_compensator": "compensator",
    "closed_loop_matrix": "closed_loop",
    "similar_loops": "similarity",
    "compensator_stable_low": "hurwitz",
    "compensator_unstable_low": "hurwitz",
    "compensator_unstable_low_alone": "hurwitz",
}

SPELLS_OUT = ("named_entries", "with_coefficients")

EXPLAINS = ("similar_loops",)
