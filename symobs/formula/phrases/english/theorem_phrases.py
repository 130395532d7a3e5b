"""Theorems that the sentences of several tasks rest on."""

from __future__ import annotations

THEOREMS: dict[str, str] = {
    "duality": "kalman1960",
    "state_feedback_poles": "wonham1967",
    "canonical_form": "bass1965; kailath1980, ch. 3",
    "ackermann": "ackermann1972",
    "parity_interlacing": "youla1974",
    "separation": "luenberger1964; kailath1980, ch. 4",
}
