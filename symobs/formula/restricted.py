"""Exact values where some polynomials vanish: on a stratum, at an eigenvalue, with c² + s² = 1."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Ideal, Matrix, Scalar
from symobs.formula.evaluate import Exact

if TYPE_CHECKING:
    from symobs.formula.evaluate import Environment


class Restricted(Exact):
    """The exact kernel, with two values equal where their difference lies in the ideal of the relations.

    Nothing may be divided by what vanishes there: cancelling would hide it.  A rank has no meaning on an ideal that
    need not be prime, so it is none of the functions here; minors and kernels say the same.
    """

    def __init__(self, environment: Environment) -> None:
        """Raise `TooLarge` where the relations are too long to be decided."""
        super().__init__(environment)
        self.ideal = Ideal.of(environment.relations)

    def leaf(self, value: Scalar | Matrix) -> Scalar | Matrix:
        """Refuse a value that has no meaning here."""
        found: Scalar | Matrix = super().leaf(value)
        self._meaningful(found)
        return found

    def invert(self, value: Any) -> Any:
        """Refuse to divide by what vanishes here."""
        found = super().invert(value)
        self._meaningful(found)
        return found

    def apply(self, function: str, value: Matrix) -> Any:
        """Return det or adj of a matrix, or the value at t = 0."""
        if function == "rank":
            message = "a rank on a stratum is shown by minors and kernels"
            raise TypeError(message)
        return super().apply(function, value)

    def equal(self, left: Any, right: Any) -> bool:
        """Tell whether two values agree wherever the relations hold."""
        if isinstance(left, Matrix) != isinstance(right, Matrix):
            return False
        difference = left - right
        entries = difference.entries if isinstance(difference, Matrix) else (difference,)
        return all(entry in self.ideal for entry in entries)

    def _meaningful(self, value: Scalar | Matrix) -> None:
        below = value.common_denominator()
        if not below.is_constant and below in self.ideal:
            message = f"{below} vanishes here"
            raise ZeroDivisionError(message)
