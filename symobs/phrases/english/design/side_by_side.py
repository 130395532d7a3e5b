"""Observer and state feedback side by side."""

from __future__ import annotations

PHRASES: dict[str, str] = {
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

#: Titles of sections whose sections stand side by side, a step with a sentence beginning a row.
BESIDE = ("side_by_side",)

RESTS_ON: dict[str, str] = {
    "test_observer": "duality",
    "any_observer": "state_feedback_poles",
    "any_state_feedback": "state_feedback_poles",
    "gain_observer": "ackermann",
    "gain_state_feedback": "ackermann",
}
