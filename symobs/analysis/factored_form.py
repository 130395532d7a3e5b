"""Rational functions as products of powers of their irreducible factors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Factored, Scalar, factored
from symobs.formula import Literal, Negative, Power, Product, Quotient

if TYPE_CHECKING:
    from symobs.derivation.builder import Page
    from symobs.formula import Formula
    from symobs.formula.term import Term


def factored_form(page: Page, value: Scalar) -> Term:
    """Return a scalar written as a product or quotient of its factors in the variable."""
    return page.term(formula_of_factored(factored(value, page.plant.variable, monic=False)))


def formula_of_factored(form: Factored) -> Formula:
    """Return the formula of a factored form: unit and powers, over powers."""
    above = [_power(f, p) for f, p in form.factors if p > 0]
    below = [_power(f, -p) for f, p in form.factors if p < 0]
    unit = form.unit
    if below and not unit.denominator.is_one:
        below.insert(0, Literal(unit.denominator))
        unit = unit.numerator
    negative = bool(above or below) and unit.is_constant and unit.fraction() < 0
    if negative:
        unit = -unit
    if not unit.is_one or not above:
        above.insert(0, Literal(unit))
    top = above[0] if len(above) == 1 else Product(tuple(above))
    whole = top if not below else Quotient(top, below[0] if len(below) == 1 else Product(tuple(below)))
    return Negative(whole) if negative else whole


def _power(factor: Scalar, exponent: int) -> Formula:
    return Literal(factor) if exponent == 1 else Power(Literal(factor), exponent)
