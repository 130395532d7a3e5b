"""Triangular systems of polynomial equations by lexicographic Gröbner bases of limited size."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flint import Ordering, fmpz_mpoly_vec

from symobs.exact.core.field import Field, context_of
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals.ideal import TERMS, TooLarge

if TYPE_CHECKING:
    from collections.abc import Sequence

#: The most polynomials of a basis, terms of one of them, and bits of a coefficient, before the work is given up.
LIMITS = (40, 120, 600)


def triangular(equations: Sequence[Scalar], unknowns: Sequence[str]) -> tuple[Scalar, ...]:
    """Return a basis of the ideal of equations from which the unknowns are eliminated one after the other.

    Polynomials free of all unknowns come first, then those in the last of them alone, and so on.  Raises `TooLarge`.
    """
    field = Field.of(())
    for equation in equations:
        field = field | equation.field
    others = [name for name in field.names if name not in unknowns]
    home = context_of((*unknowns, *others), Ordering.lex)
    moved = [field.lift(e.numerator.numerator_part, e.field).project_to_context(home) for e in equations if e]
    if any(polynomial.is_constant() for polynomial in moved):
        return (Scalar.of(1),)
    moved += [square.project_to_context(home) for square in field.relations]
    if sum(len(polynomial) for polynomial in moved) > TERMS:
        message = "the equations have too many terms"
        raise TooLarge(message)
    basis, complete = fmpz_mpoly_vec(moved, home).buchberger_naive(limits=LIMITS)
    if not complete:
        message = "the equations are too long to be eliminated"
        raise TooLarge(message)
    reduced = basis.autoreduction(groebner=True)  # type: ignore[attr-defined]
    back = (field.normal(polynomial.project_to_context(field.context)) for polynomial in reduced)
    found = [Scalar(field, polynomial, field.one) for polynomial in back if polynomial]
    order = {name: place for place, name in enumerate(unknowns)}
    return tuple(
        sorted(found, key=lambda p: (-min((order[n] for n in p.names if n in order), default=len(order)), p.size))
    )
