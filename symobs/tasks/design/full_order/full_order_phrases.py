"""Sentences and questions of full-order observers and state feedback."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "observer_equation": "The observer is a copy of the plant with a correction proportional to the output error:",
    "error_equation": "Irrespective of the input, the estimation error {error} satisfies",
    "feedthrough_cancels": "The feedthrough term cancels in the output error, which therefore does not depend on the input:",
    "deadbeat_error": "All observer poles are at the origin (deadbeat observer), so any initial error vanishes after finitely many steps: {gone}.",
    "observer_collected": "Collecting terms, we obtain the observer",
    "observer_collected_with_feedthrough": "Collecting terms, with $B - L D$ in place of $B$ to account for the feedthrough, we obtain the observer",
    "existence_ansatz": "Consider a linear system driven by the plant's input and output, with matrices to be determined:",
    "existence_error": "The error {error} then satisfies",
    "existence_choice": "For the error to be independent of state and input, the coefficients of both must vanish, which requires",
    "existence_left": "and the error dynamics reduce to",
    "existence_observer": "With the gain $H_x = L$ the observer is",
}

QUESTIONS: dict[str, str] = {
    "ask state_feedback": "Design state feedback.",
    "ask state_feedback poles": "Design state feedback with the poles {poles}.",
    "ask state_feedback poles=1": "Design state feedback with the pole {poles}.",
    "ask state_feedback polynomial": "Design state feedback with the characteristic polynomial {polynomial}.",
    "ask state_feedback K": "Find the characteristic polynomial of the loop with the feedback gain $K$.",
    "ask observer": "Design an observer.",
    "ask observer poles": "Design an observer with the poles {poles}.",
    "ask observer poles=1": "Design an observer with the pole {poles}.",
    "ask observer polynomial": "Design an observer with the characteristic polynomial {polynomial}.",
    "ask observer L": "Find the characteristic polynomial of the observer with the gain $L$.",
    "ask observer method=existence": "Which linear systems driven by the input and the output give an estimate whose error dynamics are autonomous?",
    "ask observer method=existence L": "Which linear systems driven by the input and the output give an estimate whose error dynamics are autonomous? Find the one with the gain $L$.",
    "ask observer method=existence poles": "Which linear systems driven by the input and the output give an estimate whose error dynamics are autonomous? Find the one with the poles {poles}.",
    "ask observer method=existence polynomial": "Which linear systems driven by the input and the output give an estimate whose error dynamics are autonomous? Find the one with the characteristic polynomial {polynomial}.",
    "also observer member=decoupled": "Among these gains, find one that decouples the output errors.",
    "also state_feedback member=decoupled": "Among these gains, find one that decouples the inputs.",
}

RESTS_ON: dict[str, str] = {
    "observer_equation": "observer",
    "existence_left": "existence",
    "error_equation": "error",
}

THEOREMS: dict[str, str] = {
    "observer": "luenberger1964",
    "error": "luenberger1971",
    "existence": "luenberger1971",
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

#: Phrases that go on with the sentence before them.
CONTINUES = ("existence_left",)
