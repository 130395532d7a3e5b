"""Tracking of a reference."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "reference": "The state is to follow a reference that obeys",
    "tracking_law": "The reference enters the control law twice, beside the estimate and by itself:",
    "tracking_error": "The error {error} then obeys",
    "tracking_condition": "The reference leaves the error alone where",
    "tracking_condition_one": "Along the trajectory from {start}, which stays in the span of the columns of",
    "tracking_condition_then": "the reference leaves the error alone where",
    "tracking_solved": "which is so with",
    "tracking_impossible": "With {row} the product {annuls}, but {left}. So no $K_d$ can make $B K_d$ equal to $A - A_ref$: the plant cannot follow this reference.",
    "tracking_impossible_one": "With {row} the product {annuls}, but {left}. So no $K_d$ serves: the plant cannot follow this trajectory.",
    "tracking_errors": "Tracking and estimation error together obey",
    "tracking_errors_one": "On this trajectory tracking and estimation error together obey a linear equation with the matrix",
    "tracking_polynomial": "with the polynomial",
}

QUESTIONS: dict[str, str] = {
    "ask tracking": "Let the state follow the states $x_d$ of its own unforced motion, by state feedback and an observer of minimal order.",
    "ask tracking reference_matrix": "Let the state follow every reference $x_d$, by state feedback and an observer of minimal order. Is that possible?",
    "ask tracking reference_matrix reference_start": "Let the state follow the reference $x_d$ from the initial state given, by state feedback and an observer of "
    "minimal order. Is that possible?",
    "also tracking observer=full": "The observer is to have full order.",
}

RESTS_ON: dict[str, str] = {
    "tracking_law": "tracking",
}

THEOREMS: dict[str, tuple[str, str]] = {
    "tracking": ("tracking of a reference", "S2"),
}

OPENS = (
    "tracking_law",
    "tracking_errors",
    "tracking_errors_one",
)

FIGURES: dict[str, dict[str, object]] = {
    "tracking_loop": {
        "grid": """
        .   .  .  Kd .  .  .         .   .
        ∫r  a  e  K  u  b  Plant     y'  y
        Ad  .  .  .  .  .  Observer  .   .
        .   .  .  c  .  .  x         .   .
        """,
        "routes": (
            "∫r > a > e > K > u > b > Plant > y' > y",
            "a |- Ad > ∫r",
            "a |- Kd -| u",
            "b |- Observer",
            "y' |- Observer",
            "Observer > x > c -|[U] e",
        ),
        "signals": {"r": "x_d", "u": "u", "y": "y", "x": "x_hat"},
    },
}
