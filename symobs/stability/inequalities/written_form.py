"""Inequalities as they are printed: solved for a parameter, squares as inequations."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.exact import Scalar, product_of
from symobs.system.conditions import FACTORED_UP_TO, sign_where

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


#: Coefficients and conditions of more terms are not held against each other.
_COMPARED_UP_TO = 12


#: A condition of more terms is not solved.
_SOLVED_UP_TO = 200


def as_inequality(
    positive: Scalar, signs: Mapping[str, str], parameters: Sequence[str] = (), beside: Sequence[Scalar] = ()
) -> tuple[Scalar, str, Scalar]:
    """Return value > 0 solved for a name: h₁ < 1, h₂ > −b, h₁ > (h₂² + 9)/(3 h₂), and a square as f ≠ 0.

    The name stands in it with a coefficient of certain sign, by the declared signs or where `beside` are positive.
    Parameters are preferred, then names of unknown sign, then a coefficient ±1.
    """
    root = root_of_square(positive)
    if root is not None:
        left, _, right = as_inequality(root, signs, parameters)
        return left, "!=", right
    found, short = [], [value for value in beside if value.size <= _COMPARED_UP_TO]
    for name in positive.names if positive.size <= _SOLVED_UP_TO else ():
        if positive.degree(name) != 1 or not positive.is_polynomial_in(name):
            continue
        lead = positive.coefficients(name)[0]
        sign = sign_where(lead, signs, short if lead.size <= _COMPARED_UP_TO else ())
        if sign in {"positive", "negative"}:
            rank = (name not in parameters, signs.get(name, "real") != "real", not (lead**2).is_one, lead.size, name)
            found.append((rank, sign))
    if not found:
        return positive, ">", Scalar.of(0)
    (*_, name), sign = min(found)
    lead, rest = positive.coefficients(name)
    return Scalar.symbol(name), ">" if sign == "positive" else "<", -rest / lead


def root_of_square(positive: Scalar) -> Scalar | None:
    """Return f of a square f², whose inequality is f ≠ 0."""
    if positive.size > FACTORED_UP_TO or positive.is_constant:
        return None
    unit, factors = positive.factors()
    if not unit.is_one or any(power != 2 for _, power in factors):
        return None
    return product_of(factor for factor, _ in factors)
