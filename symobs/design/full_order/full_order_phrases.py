"""Observers of full order, and what is asked of them and of state feedback."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "observer_equation": "The observer is a copy of the plant, corrected by the output error:",
    "error_equation": "Whatever the input, the error {error} then obeys",
    "feedthrough_cancels": "The output error does not contain the input, since the feedthrough cancels in it:",
    "deadbeat_error": "All poles lie at the origin, so the error is gone after finitely many steps, whatever it was: {gone}.",
    "observer_collected": "Collected, the observer reads",
    "observer_collected_with_feedthrough": "Collected, with $B - L D$ in place of $B$ so that the feedthrough does cancel, the observer reads",
    "existence_ansatz": "Let a linear system be driven by what is known, with matrices still to be determined:",
    "existence_error": "Then {error} obeys",
    "existence_choice": "It is to vanish whatever state and input are. So both must go, which leaves no choice but",
    "existence_left": "and of the error there remains",
    "existence_observer": "With $H_x = L$ the observer is",
}

QUESTIONS: dict[str, str] = {
    "ask state_feedback": "Design state feedback.",
    "ask state_feedback poles": "Design state feedback with the poles {poles}.",
    "ask state_feedback poles=1": "Design state feedback with the pole {poles}.",
    "ask state_feedback polynomial": "Design state feedback with the characteristic polynomial {polynomial}.",
    "ask state_feedback K": "Find the characteristic polynomial of the loop with the feedback gain $K$.",
    "ask state_feedback K poles": "Does the feedback gain $K$ give the poles {poles}?",
    "ask observer": "Design an observer.",
    "ask observer poles": "Design an observer with the poles {poles}.",
    "ask observer poles=1": "Design an observer with the pole {poles}.",
    "ask observer polynomial": "Design an observer with the characteristic polynomial {polynomial}.",
    "ask observer L": "Find the characteristic polynomial of the observer with the gain $L$, and the observer itself.",
    "ask observer method=existence": "Which linear systems, driven by the input and the output, estimate the state with an error that does not depend on "
    "them?",
    "ask observer method=existence L": "Which linear systems, driven by the input and the output, estimate the state with an error that does not depend on "
    "them? Find the one with the gain $L$.",
    "ask observer method=existence poles": "Which linear systems, driven by the input and the output, estimate the state with an error that does not "
    "depend on them? Find the one with the poles {poles}.",
    "ask observer method=existence polynomial": "Which linear systems, driven by the input and the output, estimate the state with an error that does not "
    "depend on them? Find the one with the characteristic polynomial {polynomial}.",
    "also observer member=decoupled": "Of the gains that do that, find one for which every output obeys an equation of its own.",
    "also state_feedback member=decoupled": "Of the gains that do that, find one for which every input moves a part of its own.",
}

RESTS_ON: dict[str, str] = {
    "observer_equation": "observer",
    "existence_left": "existence",
    "error_equation": "error",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "observer": ("full-order observer", "S0, (4.18)-(4.20)"),
    "error": ("error equation", "S0, (4.19)"),
    "existence": ("existence of an asymptotic observer", "S4"),
}

OPENS = (
    "observer_equation",
    "existence_observer",
)

FIGURES: dict[str, dict[str, object]] = {
    "observer_copy": {
        "grid": """
        .  .  .  w  C   .  .  .
        y  e  L  .  .   .  .  .
        .  D  .  .  .   .  .  .
        u  b  B  j  ∫x  a  c  x
        .  .  .  .  A   .  .  .
        """,
        "routes": (
            "u > b > B > j > ∫x > a > c > x",
            "y > e > L -| j",
            "c |- C > w -|[U] e",
            "a |- A -| j",
            "b > D > e",
        ),
        "signals": {"u": "u", "y": "y", "x": "x_hat", "w": "y_hat"},
        "optional": ("B", "D"),
    },
    "observer_closed": {
        "grid": """
        y  L  .  .   .  .
        u  B  j  ∫x  a  x
        .  .  .  A   .  .
        """,
        "routes": (
            "u > B > j > ∫x > a > x",
            "y > L -| j",
            "a |- A -| j",
        ),
        "signals": {"u": "u", "y": "y", "x": "x_hat"},
        "optional": ("B",),
    },
}
