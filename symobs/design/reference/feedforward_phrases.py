"""Feedforward for unit gain at rest."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "feedforward_law": "A new input $v_r$ is added to the control law:",
    "feedforward_loop": "State, error and output then obey",
    "feedforward_polynomial": "The error obeys an equation of its own, which $v_r$ does not enter, and the polynomial of the whole loop is",
    "gain_at_rest": "With a constant input in place of $F_v v_r$ the output in the state of rest is this input times",
    "feedforward_gain": "For the output to equal $v_r$ at rest,",
    "feedforward_smallest": "There are more inputs than outputs. The smallest $F_v$ for which the output equals $v_r$ at rest is",
    "feedforward_response": "From $v_r$ to $y$ the error has no part, so the modes of the observer do not appear:",
    "no_rest": "With {state} one has {still}: the loop stays in this state as well as in 0. So where it comes to rest, if it does, depends on its start, "
    "and nothing is asked of the output at rest.",
    "no_feedforward_single": "At rest the output is zero whatever the input is: the plant has a zero there, which feedback does not move. There is no such $F_v$.",
    "no_feedforward_zero": "With {row} the product {vanishes}, so the outputs at rest cannot be set one by one: the plant has a zero there, which feedback "
    "does not move. There is no such $F_v$.",
    "no_feedforward_low": "With {row} the product {vanishes}, so the outputs at rest cannot be set one by one: {rank}, and there are more outputs. "
    "There is no such $F_v$.",
    "no_feedforward_none": "The transfer function of the plant is zero, so no input moves the output, at rest or not. There is no such $F_v$.",
}

QUESTIONS: dict[str, str] = {
    "ask feedforward": "Design state feedback, an observer of full order, and a feedforward gain for which the output at rest equals the new input.",
    "ask feedforward observer=full": "Design state feedback, an observer of full order, and a feedforward gain for which the output at rest equals the new "
    "input.",
    "ask feedforward observer=minimal": "Design state feedback, an observer of minimal order, and a feedforward gain for which the output at rest equals the "
    "new input.",
}

DEMANDS: dict[str, str] = {
    "no_feedforward_zero": "needs_rank_full",
}

RESTS_ON: dict[str, str] = {
    "feedforward_gain": "feedforward",
    "feedforward_smallest": "feedforward",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "feedforward": ("feedforward for unit gain at rest", "S3, section G and (12)"),
}

OPENS = ("feedforward_law",)

FIGURES: dict[str, dict[str, object]] = {
    "estimated_state_feedback": {
        "grid": """
        v  F  u  b  Plant     y'  y
        .  .  .  .  Observer  .   .
        .  .  .  K  x         .   .
        """,
        "routes": (
            "v > F > u > b > Plant > y' > y",
            "b |- Observer",
            "y' |- Observer",
            "Observer > x > K -| u",
        ),
        "signals": {"v": "v_r", "u": "u", "y": "y", "x": "x_hat"},
        "optional": ("F",),
    },
}
