"""Theorems that the sentences of several tasks rest on."""

from __future__ import annotations

THEOREMS: dict[str, tuple[str, str]] = {
    "duality": ("duality", "S0, Theorem 4.1"),
    "state_feedback_poles": (
        "pole assignment for state feedback",
        "W. M. Wonham, IEEE Trans. Autom. Control 12 (1967), 660-665",
    ),
    "canonical_form": ("placement through canonical form", "S0, Example 4.1"),
    "ackermann": ("Ackermann's formula", "J. Ackermann, Regelungstechnik 20 (1972), 297-300"),
    "separation": ("separation principle", "S0, (4.23)-(4.24)"),
}
