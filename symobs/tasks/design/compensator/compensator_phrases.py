"""The observer, the compensator and the loop."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "in_components": "Componentwise,",
    "right_estimate_stays": "If the estimate is exact at one instant, it remains exact: {consistent}.",
    "separation": "By the separation principle§, the state in the control law is replaced by its estimate:",
    "observer_closed": "Substituting {law:number} into {rate:number} gives a system of the plant's order, driven by $y$ alone,",
    "observer_closed_matrix": "Substituting {law:number} into {rate:number} gives a system of the plant's order, driven by $y$ alone, with the matrix",
    "compensator_matrix": "with the matrix",
    "compensator_written": "Hence the compensator is",
    "transfer_function_of_compensator": "The compensator has the transfer function, from $y$ to $-u$,",
    "compensator_stable": "It is strictly proper and stable.",
    "compensator_stable_low": "It is strictly proper and stable, since all coefficients of {polynomial} are positive§.",
    "compensator_unstable": "It is strictly proper, but the compensator itself is not stable.",
    "compensator_unstable_alone": "It is strictly proper. The compensator itself is not stable, although the closed loop is.",
    "compensator_unstable_low": "It is strictly proper, but the compensator itself is not stable, since not all coefficients of {polynomial} are positive§.",
    "compensator_unstable_low_alone": "It is strictly proper. The compensator itself is not stable, since not all coefficients of {polynomial} are positive§, although the closed loop is stable.",
    "compensator_proper": "It is strictly proper.",
    "compensator_stable_if": "It is strictly proper, and the compensator itself is stable if and only if {where}.",
    "closed_loop_matrix": "In terms of the estimation error, {control} and {rate}, so that the closed-loop system matrix in state and error is block triangular,",
    "polynomial_splits": "and the closed-loop characteristic polynomial is the product of the two desired polynomials:",
    "estimate_coordinates": "By the change of coordinates {turned}, the closed loop in terms of state and estimate is",
    "unity_feedback": "With $F$ in the forward path and unity feedback, the transfer function from the reference to the output has the same denominator but a different numerator,",
    "plant_transfer": "The transfer function of the plant is",
    "return_path": "With $F$ in negative feedback, the closed-loop transfer function is",
    "return_difference": "With $F$ in negative feedback, the return difference and the closed-loop transfer function are",
    "no_stable_compensator": "At a real zero of $P$ in the right half-plane the characteristic polynomial is negative: the plant lacks the parity interlacing property and cannot be stabilised by a stable compensator.",
    "with_coefficients": "where",
    "loop_matrix_poles": "The poles of its entries are control poles or observer poles.",
    "loop_poles_left": "The poles {poles} are control or observer poles, as expected; cancellation removes {lost}.",
    "loop_pole_left": "The only pole, {poles}, is a control or observer pole, as expected; cancellation removes {lost}.",
    "loop_no_poles": "It has no poles: all control and observer poles, {lost}, cancel.",
    "loop_polynomial_divides": "The denominator divides the product of the two desired polynomials, as expected.",
    "loop_polynomial": "The denominator is the product of the two desired polynomials, as expected.",
    "defective": "Since {matrix}, the repeated pole {pole} gives transients with {times} beside {mode}.",
    "defective_instead": "Since {matrix}, the repeated pole {pole} gives transients with {times} beside {mode}. Distinct poles avoid this, for example {instead}.",
    "side_by_side": "Pole placement for observer and state feedback.",
    "polynomial_splits_given": "and the closed-loop characteristic polynomial is the product of the two:",
    "loop_unstable_continuous": "Not all closed-loop poles lie in the open left half-plane: with these gains the closed loop is unstable.",
    "loop_unstable_discrete": "Not all closed-loop poles lie inside the unit circle: with these gains the closed loop is unstable.",
    "loop_polynomial_divides_given": "The denominator divides the product of the two polynomials, as expected.",
    "loop_polynomial_given": "The denominator is the product of the two polynomials, as expected.",
    "left_observer": "Observer",
    "right_state_feedback": "State feedback",
    "test_observer": "The dual pair ($Aᵀ$, $Cᵀ$)§ has the controllability matrix",
    "test_state_feedback": "The pair ($A$, $B$) has the controllability matrix",
    "any_observer": "Hence the eigenvalues of $Aᵀ - Cᵀ Lᵀ$ can be assigned arbitrarily§, complex ones in conjugate pairs.",
    "any_state_feedback": "Hence the eigenvalues of $A - B K$ can be assigned arbitrarily§, complex ones in conjugate pairs.",
    "gain_observer": "Ackermann's formula§ for the dual pair gives",
    "gain_state_feedback": "Ackermann's formula§ gives",
    "transposed_back": "A matrix and its transpose have the same characteristic polynomial, so the result for $Aᵀ - Cᵀ Lᵀ$ in the left column holds for $A - L C$,",
    "gain_transposed": "and the observer gain is",
}

QUESTIONS: dict[str, str] = {
    "ask compensator": "Design an observer-based compensator (state feedback with a full-order observer).",
    "ask compensator observer=full": "Design an observer-based compensator (state feedback with a full-order observer).",
    "ask compensator observer=minimal": "Design an observer-based compensator (state feedback with a reduced-order observer).",
    "ask compensator method=minimal_order": "Design an observer-based compensator (state feedback with a reduced-order observer).",
    "ask compensator K L": "Close the loop with the feedback gain $K$ and a full-order observer with the gain $L$.",
    "ask compensator K": "Close the loop with the feedback gain $K$ and a full-order observer.",
    "ask compensator L": "Close the loop with state feedback and a full-order observer with the gain $L$.",
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
    "compensator_stable": "about F",
    "compensator_stable_low": "about F",
    "compensator_unstable": "about F",
    "compensator_unstable_low": "about F",
    "compensator_proper": "about F",
    "compensator_stable_if": "about F",
    "compensator_unstable_alone": "about F strictly_proper unstable, loop stable",
    "compensator_unstable_low_alone": "about F strictly_proper unstable, loop stable",
    "defective": "pole_defective",
    "defective_instead": "pole_defective",
    "observer_closed": "substitutes_law",
    "observer_closed_matrix": "substitutes_law",
    "no_stable_compensator": "about P",
    "any_observer": "observable C A",
    "any_state_feedback": "observable Bᵀ Aᵀ",
    "loop_unstable_continuous": "loop unstable",
    "loop_unstable_discrete": "loop unstable",
}

RESTS_ON: dict[str, str] = {
    "separation": "separation",
    "transfer_function_of_compensator": "compensator",
    "closed_loop_matrix": "closed_loop",
    "no_stable_compensator": "parity_interlacing",
    "compensator_stable_low": "hurwitz",
    "compensator_unstable_low": "hurwitz",
    "compensator_unstable_low_alone": "hurwitz",
    "test_observer": "duality",
    "any_observer": "state_feedback_poles",
    "any_state_feedback": "state_feedback_poles",
    "gain_observer": "ackermann",
    "gain_state_feedback": "ackermann",
}

THEOREMS: dict[str, str] = {
    "compensator": "kailath1980, ch. 4",
    "hurwitz": "hurwitz1895",
    "closed_loop": "luenberger1971",
}

NAMING = (
    "defective",
    "defective_instead",
)

#: Titles of sections whose sections stand side by side, a step with a sentence beginning a row.
BESIDE = ("side_by_side",)

SPELLS_OUT = ("with_coefficients",)

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

#: Phrases that go on with the sentence before them.
CONTINUES = (
    "compensator_matrix",
    "polynomial_splits",
    "with_coefficients",
    "polynomial_splits_given",
    "gain_transposed",
)
