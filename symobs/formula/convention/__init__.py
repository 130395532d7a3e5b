"""Conventions: the letters and signs of pages, of input, and of expected answers."""

from symobs.formula.convention.convention import OF_REDUCED_ORDER, STANDARD, Convention, convention_named, conventions

__all__ = ["OF_REDUCED_ORDER", "STANDARD", "Convention", "convention_named", "conventions"]
