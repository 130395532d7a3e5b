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

OPENS = ("tracking_law", "tracking_errors", "tracking_errors_one")

RESTS_ON: dict[str, str] = {"tracking_law": "tracking"}
