"""Comparison of results with expected answers, as mathematics and not as text."""

from symobs.expect.expectations import applicable, mismatches, unreadable

__all__ = ["applicable", "mismatches", "unreadable"]
