"""The observer, the compensator and the loop."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "in_components": "Component by component these are the equations",
    "right_estimate_stays": "An estimate that is right stays right: {consistent}.",
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
    "polynomial_splits_given": "and the polynomial of the loop is the product of the two:",
    "loop_unstable_continuous": "Not all poles of the loop lie in the open left half-plane: with these gains it is unstable.",
    "loop_unstable_discrete": "Not all poles of the loop lie inside the unit circle: with these gains it is unstable.",
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
    "loop_polynomial_divides_given": "The denominator divides the product of the two polynomials, as it must.",
    "loop_polynomial_given": "The denominator is the product of the two polynomials, as it must be.",
    "defective": "The repeated pole {pole} is defective, {matrix}, so the transients contain its exponential times a power of time and are not bounded by a multiple of the exponential alone.",
    "defective_instead": "The repeated pole {pole} is defective, {matrix}, so the transients contain its exponential times a power of time and are not bounded by a multiple of the exponential alone. With distinct poles they are, for example with {instead}.",
    "side_by_side": "Placing the poles of observer and state feedback.",
    "left_observer": "Observer",
    "right_state_feedback": "State feedback",
    "test_observer": "The dual pair ($Aᵀ$, $Cᵀ$)§ has the controllability matrix",
    "test_state_feedback": "The pair ($A$, $B$) has the controllability matrix",
    "any_observer": "So the eigenvalues of $Aᵀ - Cᵀ Lᵀ$ can be placed at will§.",
    "any_state_feedback": "So the eigenvalues of $A - B K$ can be placed at will§.",
    "gain_observer": "Ackermann's formula§ for the dual pair gives",
    "gain_state_feedback": "Ackermann's formula§ gives",
    "transposed_back": "Transposition changes no determinant, so what holds on the left for $Aᵀ - Cᵀ Lᵀ$ holds for $A - L C$,",
    "gain_transposed": "and the observer gain is",
}

QUESTIONS: dict[str, str] = {
    "ask compensator": "Design a compensator of state feedback and an observer of full order, and close the loop with it.",
    "ask compensator observer=full": "Design a compensator of state feedback and an observer of full order, and close the loop with it.",
    "ask compensator K L": "Close the loop with the feedback gain $K$ and an observer of full order with the gain $L$, and find its poles.",
    "ask compensator K": "Close the loop with the feedback gain $K$ and an observer of full order.",
    "ask compensator L": "Close the loop with state feedback and an observer of full order with the gain $L$.",
    "ask compensator observer=minimal": "Design a compensator of state feedback and an observer of minimal order, and close the loop with it.",
}

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
    "loop_unstable_continuous": ("unstable",),
    "loop_unstable_discrete": ("unstable",),
    "no_stable_compensator": ("no_stable_compensator",),
}

DEMANDS: dict[str, str] = {
    "compensator_unstable_alone": "needs_loop_stable",
    "compensator_unstable_low_alone": "needs_loop_stable",
    "defective": "needs_pole_defective",
    "defective_instead": "needs_pole_defective",
}

RESTS_ON: dict[str, str] = {
    "separation": "separation",
    "transfer_function_of_compensator": "compensator",
    "closed_loop_matrix": "closed_loop",
    "similar_loops": "similarity",
    "compensator_stable_low": "hurwitz",
    "compensator_unstable_low": "hurwitz",
    "compensator_unstable_low_alone": "hurwitz",
    "test_observer": "duality",
    "any_observer": "state_feedback_poles",
    "any_state_feedback": "state_feedback_poles",
    "gain_observer": "ackermann",
    "gain_state_feedback": "ackermann",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "similarity": ("from estimate to error", "S1, slide at 28:08"),
    "compensator": ("compensator in transfer form", "S0, (4.25)"),
    "hurwitz": ("Hurwitz's criterion", "A. Hurwitz, Math. Ann. 46 (1895), 273-284"),
    "closed_loop": ("closed loop in state and error", "S0, (4.26)-(4.29)"),
}

#: A new thought begins here.
OPENS = ()

EXPLAINS = ("similar_loops",)

#: Titles of sections whose sections stand side by side, a step with a sentence beginning a row.
BESIDE = ("side_by_side",)

SPELLS_OUT = (
    "named_entries",
    "with_coefficients",
)

FIGURES: dict[str, dict[str, object]] = {
    "loop": {
        "grid": """
        r  u  P  y'  y
        .  .  F  .   .
        """,
        "routes": (
            "r > u > P > y' > y",
            "y' |- F -| u",
        ),
        "signals": {"r": "r_in", "u": "u", "y": "y"},
        "letters": {"P": "P", "F": "F"},
        "response": True,
    },
    "unity_loop": {
        "grid": """
        r  e  F  u  P  y'  y
        .  .  .  c  .  .   .
        """,
        "routes": (
            "r > e > F > u > P > y' > y",
            "y' |- c -|[U] e",
        ),
        "signals": {"r": "r_in", "u": "u", "y": "y"},
        "letters": {"P": "P", "F": "F"},
        "response": True,
    },
    "observer_compensator": {
        "grid": """
        .  .   .   A   .   .  .   .  .
        .  B   j   ∫x  a   .  C   y'  y
        .  .   .   L   .   .  .   e   .
        u  B'  j'  ∫w  a'  k  C'  v   .
        .  .   .   A'  .   .  .   .   .
        c  .   .   K   .   .  .   .   .
        """,
        "routes": (
            "u |- B > j > ∫x > a > C > y' > y",
            "a |- A -| j",
            "u > B' > j' > ∫w > a' > k > C' > v >[U] e",
            "a' |- A' -| j'",
            "y' > e > L -| j'",
            "k |- K > c > u",
        ),
        "signals": {"u": "u", "y": "y", "x": "x", "w": "x_hat", "v": "y_hat"},
    },
    "observer_controller": {
        "grid": """
        .  .  .  Plant  .  .  y'  y
        .  .  .  A      .  .  .   .
        u  K  a  ∫x     j  L  .   .
        .  .  .  B      .  .  .   .
        """,
        "routes": (
            "u |- Plant > y' > y",
            "y' |- L > j > ∫x > a > K > u",
            "a |- A -| j",
            "u |- B -| j",
        ),
        "signals": {"u": "u", "y": "y", "x": "x_hat"},
    },
}
