"""Characteristic polynomials, transfer functions, stability."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "its_characteristic_polynomial": "The characteristic polynomial is",
    "its_roots": "Its <only root is|roots are> {roots}.",
    "its_transfer_matrix": "The transfer function is a matrix,",
    "its_transfer_function": "Writing the inverse as adjugate over determinant gives",
    "cancelled": "After cancellation of a common factor: a realisation of order {order} has the same transfer function.",
    "lowest_provided": "These are its poles and zeros provided that {condition}.",
    "no_pole_lost": "No pole–zero cancellation occurs provided that {condition}.",
    "lowest_there": "In lowest terms",
    "static_there": "In this case the transfer function reduces to a constant:",
    "no_zero": "It has no zeros.",
    "its_poles": "The <only pole is|poles are> {roots}.",
    "its_zeros": "The <only zero is|zeros are> {roots}.",
    "stable_continuous": "All roots lie in the open left half-plane: the polynomial is stable (Hurwitz).",
    "stable_discrete": "All roots lie inside the unit circle: the polynomial is stable.",
    "unstable_continuous": "Not all roots lie in the open left half-plane: the polynomial is not stable.",
    "unstable_discrete": "Not all roots lie inside the unit circle: the polynomial is not stable.",
    "stable_if_continuous": "All roots of this polynomial lie in the open left half-plane if and only if {where}.",
    "stable_if_discrete": "All roots of this polynomial lie inside the unit circle if and only if {where}.",
}

QUESTIONS: dict[str, str] = {
    "ask characteristic_polynomial": "Find the characteristic polynomial of $A$.",
    "ask transfer_function": "Find the transfer function of the plant in lowest terms.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "no_zero": ("polynomial",),
    "stable_continuous": ("stable",),
    "stable_discrete": ("stable",),
    "unstable_continuous": ("unstable",),
    "unstable_discrete": ("unstable",),
}

DEMANDS: dict[str, str] = {
    "its_roots": "eigenvalues_of A",
    "its_poles": "poles_of P",
    "its_zeros": "zeros_of P",
    "no_zero": "zeros_of P",
    "stable_continuous": "shown",
    "stable_discrete": "shown",
    "unstable_continuous": "shown",
    "unstable_discrete": "shown",
    "stable_if_continuous": "shown",
    "stable_if_discrete": "shown",
}
