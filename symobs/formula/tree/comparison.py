"""Equality of two values in any arithmetic."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.formula.tree.arithmetic import Signal, add, scalar, times

if TYPE_CHECKING:
    from symobs.formula.tree.arithmetic import Arithmetic


def agree(left: Any, right: Any, arithmetic: Arithmetic) -> bool:
    """Return whether two values are equal, reading 1×1 matrices as scalars and missing signals as 0."""
    if isinstance(left, Signal) and isinstance(right, Signal):
        difference = add(left, times(arithmetic.leaf(Scalar.of(-1)), right, arithmetic), arithmetic)
        return all(
            arithmetic.equal(value, arithmetic.leaf(Matrix.zeros(*arithmetic.shape(value))))  # type: ignore[misc]
            for value in difference.coefficients.values()
        )
    left, right = _alike(left, right, arithmetic)
    return left is not None and arithmetic.equal(left, right)


def differ(left: Any, right: Any, arithmetic: Arithmetic) -> bool:
    """Return whether two values of one kind and shape differ; False if they are not comparable."""
    left, right = _alike(left, right, arithmetic)
    return left is not None and not arithmetic.equal(left, right)


def _alike(left: Any, right: Any, arithmetic: Arithmetic) -> tuple[Any, Any]:
    """Return two values in one kind and shape, 1×1 matrices as scalars; (None, None) if that is impossible."""
    if isinstance(left, Signal) or isinstance(right, Signal):
        return None, None
    if arithmetic.shape(left) != arithmetic.shape(right):
        left, right = scalar(left, arithmetic), scalar(right, arithmetic)
        if arithmetic.shape(left) != arithmetic.shape(right):
            return None, None
    return left, right
