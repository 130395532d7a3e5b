"""Functions of time: the matrix exponential, Gramians, initial states and their covariance."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "matrix_exponential": "Matrix exponential.",
    "exponential_modes": "The characteristic polynomial decides which functions of time occur:",
    "exponential_sum": "Each of its roots brings its functions, with constant matrices that the derivatives at $t=0$ determine:",
    "exponential_here": "Here",
    "root_named": "where {root}.",
    "exponential_rate": "The check is the equation that defines it,",
    "exponential_start": "Its derivative is $A$ times itself, and at the start it is the identity, {start}.",
    "branch_under": "There the mode oscillates.",
    "branch_over": "There the mode does not oscillate.",
    "branch_equal": "There the root is double.",
    "no_closed_form": "The factor {factor} of degree {degree} cannot be reduced over the field of the data, so its roots, and "
    "the functions of time that belong to them, have no closed form here. Which exponentials occur is not decided.",
    "too_many_states": "With {order} states the exponential is longer than what is computed here. It is not decided.",
}

RESTS_ON: dict[str, str] = {"exponential_sum": "exponential"}

NAMING = ("no_closed_form",)
