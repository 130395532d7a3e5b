"""Steps of a proof that a value is positive, in their usual forms: by signs, of a product, of a quotient, by contradiction."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.stability.inequalities.proof import ONE, ZERO, Combined, Product

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact import Scalar

UNIT: tuple[Product, ...] = ((ONE, ()),)


def by_signs(value: Scalar) -> Combined:
    """Return the step for a value positive by the declared signs."""
    return Combined(value, UNIT, ((value, ()),))


def is_product(value: Scalar, factors: Sequence[Scalar]) -> Combined:
    """Return the step for a product of known values."""
    return Combined(value, UNIT, ((ONE, tuple(factors)),))


def is_quotient(value: Scalar, product: Scalar, factors: Sequence[Scalar], coefficient: Scalar = ONE) -> Combined:
    """Return the step for a quotient of a known value by known factors and a coefficient of known sign."""
    return Combined(value, ((coefficient, tuple(factors)),), ((ONE, (product,)),))


def contradiction(value: Scalar) -> Combined:
    """Return the step to 0 > 0 from value > 0 for a value that is never positive."""
    return Combined(ZERO, (), ((ONE, (value,)), (-value, ())))


def from_contradiction(value: Scalar) -> Combined:
    """Return the step from 0 > 0 to anything."""
    return Combined(value, (), ((ONE, (ZERO,)),))
