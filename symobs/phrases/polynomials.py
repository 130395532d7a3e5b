"""Characteristic polynomials, transfer functions, stability."""

from __future__ import annotations

PHRASES: dict[str, str] = {
    "its_characteristic_polynomial": "The characteristic polynomial is",
    "its_roots": "Its roots are {roots}.",
    "its_transfer_matrix": "The transfer function is a matrix,",
    "its_transfer_function": "Adjugate over determinant gives",
    "cancelled": "A common factor cancelled: a realisation of order {order} has the same transfer function.",
    "its_poles": "The poles are {roots}.",
    "nothing_cancels": "In general no pole cancels a zero and the numerator keeps its degree. From here on we assume {condition}.",
    "its_zeros": "The zeros are {roots}.",
    "stable_continuous": "All roots lie in the open left half plane: the polynomial is stable.",
    "stable_discrete": "All roots lie inside the unit circle: the polynomial is stable.",
    "unstable_continuous": "Not all roots lie in the open left half plane: the polynomial is not stable.",
    "unstable_discrete": "Not all roots lie inside the unit circle: the polynomial is not stable.",
    "stable_if_continuous": "All roots of this polynomial lie in the open left half plane exactly where {where}.",
    "stable_if_discrete": "All roots of this polynomial lie inside the unit circle exactly where {where}.",
}

ASSERTS: dict[str, tuple[str, ...]] = {
    "stable_continuous": ("stable",),
    "stable_discrete": ("stable",),
    "unstable_continuous": ("unstable",),
    "unstable_discrete": ("unstable",),
}
