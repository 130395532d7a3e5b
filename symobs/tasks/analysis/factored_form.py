"""Rational functions as products of powers of their irreducible factors."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Factored, Scalar, factored, product_of
from symobs.formula.tree import Literal, Negative, Power, Product, Quotient
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from symobs.formula.tree import Formula
    from symobs.formula.tree.term import Term
    from symobs.proof.derivation.builder import Builder


def factored_form(page: Builder, value: Scalar) -> Term:
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


def over(numerator: Scalar, own: Scalar, polynomial: Factored) -> Factored:
    """Return numerator · own / Π factors with the desired factors in the denominator, none of them made monic."""
    unit, above = numerator.factors()
    sign = _sign(own)
    below = tuple((factor, -power) for factor, power in polynomial.factors)
    return Factored(unit * sign, (*above, (own * sign, 1), *below))


def _sign(polynomial: Scalar) -> int:
    """Return the sign that a polynomial is printed with, as a factor."""
    return -1 if sign_of(polynomial.factors()[0], {}) == "negative" else 1


def cancelled(numerator: Scalar, own: Scalar, polynomial: Factored, variable: str) -> Factored:
    """Return the same, with the parameters that `own` divides by cancelled against those in front of the numerator."""
    form = over(numerator, own, polynomial)
    if own.denominator.is_constant:
        return form
    unit, above = numerator.factors()
    whole = product_of(factor**power for factor, power in above if variable not in factor.names) * own
    number, below = whole.denominator.factors()
    rest = ((factor, power) for factor, power in above if variable in factor.names)
    sign = _sign(whole.numerator)
    parts = (*rest, (whole.numerator * sign, 1), *((factor, -power) for factor, power in below))
    return Factored(unit * sign / number, (*parts, *(f for f in form.factors if f[1] < 0 and variable in f[0].names)))
