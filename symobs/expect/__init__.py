"""Holding results against expected answers: compared as mathematics, never as text."""

from symobs.expect.expectations import applicable, mismatches, unreadable

__all__ = ["applicable", "mismatches", "unreadable"]
