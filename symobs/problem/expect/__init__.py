"""Comparison of results with expected answers, as mathematics and not as text."""

from symobs.problem.expect.expectations import (
    applicable,
    available,
    found_in,
    met,
    mismatches,
    names_of,
    shown_value,
    unreadable,
)

__all__ = ["applicable", "available", "found_in", "met", "mismatches", "names_of", "shown_value", "unreadable"]
