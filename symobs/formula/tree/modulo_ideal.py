"""Exact arithmetic modulo an ideal: on a stratum, at an eigenvalue, with c² + s² = 1."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs.exact import EIGENVALUE, AlgebraicExtension, Ideal, Matrix, Scalar
from symobs.formula.tree.evaluate import Exact
from symobs.ground.errors import NotShown

if TYPE_CHECKING:
    from symobs.formula.tree.evaluate import Environment


class ModuloIdeal(Exact):
    """The exact arithmetic modulo the ideal of the relations.

    Nothing may be divided by what vanishes there: cancelling would hide it.  A rank has a meaning where one irreducible
    polynomial vanishes, which leaves a field; on other ideals minors and kernels say the same.
    """

    def __init__(self, environment: Environment) -> None:
        """Keep the relations."""
        super().__init__(environment)
        self.relations = environment.relations

    @cached_property
    def ideal(self) -> Ideal:
        """The ideal of the relations; raises `TooLarge`."""
        return Ideal.where(self.relations)

    def leaf(self, value: Scalar | Matrix) -> Scalar | Matrix:
        """Raise ZeroDivisionError for a value whose denominator vanishes here."""
        found: Scalar | Matrix = super().leaf(value)
        self._meaningful(found)
        return found

    def invert(self, value: Any) -> Any:
        """Return the inverse; raises ZeroDivisionError for a value that vanishes here."""
        found = super().invert(value)
        self._meaningful(found)
        return found

    def apply(self, function: str, value: Matrix) -> Any:
        """Return det or adj of a matrix, and its rank in the field of one irreducible relation."""
        if function != "rank":
            return super().apply(function, value)
        generators = self.ideal.generators
        field = (
            self.ideal.field | value.field
        )  # what is irreducible over Q may not be so beside the roots of the values
        factors = generators[0].within(field).factors()[1] if len(generators) == 1 else ()
        if len(factors) != 1 or factors[0][1] != 1:
            message = "a rank on a stratum is shown by minors and kernels"
            raise NotShown(message)
        roots = {field.names[index] for index, _ in field.roots}
        name = max(factors[0][0].names - roots, key=lambda name: (name == EIGENVALUE, name))
        return Scalar.of(len(AlgebraicExtension(generators[0], name).echelon(value)[0]))

    def equal(self, left: Any, right: Any) -> bool:
        """Return whether two values agree wherever the relations hold."""
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
