"""Conventions: the letters and signs in which a page is written, input is read, and answers are expected."""

from symobs.convention.builtin import convention_named, conventions
from symobs.convention.convention import OF_REDUCED_ORDER, STANDARD, Convention

__all__ = ["OF_REDUCED_ORDER", "STANDARD", "Convention", "convention_named", "conventions"]
