"""Feedforward for unit gain at rest."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "feedforward_law": "A reference input $v_r$ is added to the control law:",
    "feedforward_loop": "State, error and output then satisfy",
    "feedforward_state": "State and output then satisfy",
    "feedforward_state_polynomial": "The closed-loop characteristic polynomial is",
    "feedforward_state_response": "The transfer function from $v_r$ to $y$ is",
    "feedforward_polynomial": "The error dynamics are autonomous and not driven by $v_r$, and the closed-loop characteristic polynomial is",
    "feedforward_assumed": "A DC gain is defined, and some $F_v$ makes it one, provided that {condition}.",
    "gain_at_rest": "For constant $v_r$ the steady-state output is $G_0 F_v v_r$ with the DC gain",
    "feedforward_gain": "For the steady-state output to equal $v_r$,",
    "feedforward_smallest": "There are more inputs than outputs. The $F_v$ of smallest norm for which the steady-state output equals $v_r$ is",
    "feedforward_response": "The error is not excited by $v_r$, so the observer poles do not appear in the transfer function from $v_r$ to $y$:",
    "no_rest": "For {state} one has {still}: this state is an equilibrium of the closed loop, as is 0. The steady state, if there is one, therefore depends on the initial state, and no DC gain is defined.",
    "no_feedforward_single": "The steady-state output is zero for every constant input: the plant has a zero at zero frequency, which state feedback cannot move. No such $F_v$ exists.",
    "no_feedforward_zero": "With {row}, {vanishes}, so the steady-state outputs cannot be assigned independently: the plant has a zero at zero frequency, which state feedback cannot move. No such $F_v$ exists.",
    "no_feedforward_low": "With {row}, {vanishes}, so the steady-state outputs cannot be assigned independently: {rank}, which is less than the number of outputs. No such $F_v$ exists.",
    "no_feedforward_none": "The transfer function of the plant is zero, so the input does not affect the output. No such $F_v$ exists.",
}

QUESTIONS: dict[str, str] = {
    "ask feedforward": "Design state feedback and a feedforward gain that gives the closed loop unit DC gain.",
    "ask feedforward K": "With the feedback gain $K$, find the feedforward gain that gives the closed loop unit DC gain.",
    "ask feedforward observer_poles": "Design state feedback, a full-order observer with the poles {observer_poles}, and a feedforward gain that gives the closed loop unit DC gain.",
    "ask feedforward observer_poles=1": "Design state feedback, an observer with the pole {observer_poles}, and a feedforward gain that gives the closed loop unit DC gain.",
    "ask feedforward observer_polynomial": "Design state feedback, a full-order observer with the characteristic polynomial {observer_polynomial}, and a feedforward gain that gives the closed loop unit DC gain.",
    "ask feedforward observer=full": "Design state feedback, a full-order observer, and a feedforward gain that gives the closed loop unit DC gain.",
    "ask feedforward observer=minimal": "Design state feedback, a reduced-order observer, and a feedforward gain that gives the closed loop unit DC gain.",
}

DEMANDS: dict[str, str] = {
    "no_feedforward_single": "zero G_0",
    "no_feedforward_zero": "needs_rank_full, annuls w_0 G_0",
    "no_feedforward_low": "annuls w_0 G_0",
    "no_feedforward_none": "no_effect C A B, no_feedthrough",
}

RESTS_ON: dict[str, str] = {
    "feedforward_gain": "feedforward",
    "feedforward_smallest": "feedforward",
}

THEOREMS: dict[str, str] = {
    "feedforward": "chen1999, ch. 8",
}

OPENS = ("feedforward_law",)

FIGURES: dict[str, dict[str, object]] = {
    "state_feedforward": {
        "grid": """
        v  F  u  Plant  y
        .  .  K  x      .
        """,
        "routes": (
            "v > F > u > Plant > y",
            "Plant > x > K > u",
        ),
        "signals": {"v": "v_r", "u": "u", "y": "y", "x": "x"},
    },
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
