"""Ideals: which polynomials vanish wherever some polynomials do.

An ideal stands for what is known to be 0: the equations of a stratum, the minimal polynomial of an eigenvalue, the
relation c² + s² = 1 of a cosine and a sine.  It is kept as a reduced Gröbner basis (Buchberger's algorithm of FLINT in
the graded reverse lexicographic order), whose size is limited, since its computation cannot be interrupted.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from typing import TYPE_CHECKING

from flint import Ordering, fmpz_mpoly_ctx, fmpz_mpoly_vec

from symobs.exact.field import Field
from symobs.exact.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable

    from flint import fmpz_mpoly

#: The most polynomials of a basis, terms of one of them, and bits of a coefficient, before the work is given up.
LIMITS = (120, 600, 4_000)


class TooLarge(ArithmeticError):
    """A Gröbner basis went beyond the limits: nothing is known about the ideal."""


class Ideal:
    """The ideal that polynomials generate in Q[names]; of a rational function the numerator counts."""

    def __init__(self, field: Field, basis: fmpz_mpoly_vec, home: fmpz_mpoly_ctx) -> None:
        """Take a reduced Gröbner basis as it is."""
        self.field = field
        self.basis = basis
        self.home = home

    @staticmethod
    def of(generators: Iterable[Scalar]) -> Ideal:
        """Return the ideal of polynomials; raises `TooLarge` where its basis is."""
        return _ideal(tuple(dict.fromkeys(g.numerator for g in generators if not g.is_zero)))

    @cached_property
    def generators(self) -> tuple[Scalar, ...]:
        """The reduced Gröbner basis."""
        return tuple(self._back(polynomial) for polynomial in self.basis)

    @property
    def is_whole(self) -> bool:
        """Whether 1 lies in the ideal: its polynomials have no common zero, not even a complex one."""
        return any(polynomial.is_constant() for polynomial in self.basis)

    def remainder(self, value: Scalar) -> Scalar:
        """Return the normal form of a numerator up to a nonzero rational factor; 0 exactly for members."""
        if not self.generators:
            return value.numerator
        field = self.field | value.field
        if field is not self.field:
            return _ideal(self.generators, field).remainder(value)
        moved = field.lift(value.numerator_part, value.field).project_to_context(self.home)
        return self._back(moved.reduction_primitive_part(self.basis))  # type: ignore[attr-defined]

    def __contains__(self, value: Scalar) -> bool:
        return self.remainder(value).is_zero

    def having(self, *others: Scalar) -> Ideal:
        """Return the ideal with further generators; raises `TooLarge`."""
        return Ideal.of((*self.generators, *others))

    def _back(self, polynomial: fmpz_mpoly) -> Scalar:
        return Scalar(self.field, polynomial.project_to_context(self.field.context), self.field.one)


@lru_cache(maxsize=512)
def _ideal(generators: tuple[Scalar, ...], field: Field | None = None) -> Ideal:
    for generator in generators:
        field = generator.field if field is None else field | generator.field
    field = field or Field.of(())
    home = fmpz_mpoly_ctx.get(field.names, Ordering.degrevlex)
    moved = [field.lift(g.numerator_part, g.field).project_to_context(home) for g in generators]
    if any(polynomial.is_constant() for polynomial in moved):
        return Ideal(field, fmpz_mpoly_vec([home.constant(1)], home), home)
    basis, complete = fmpz_mpoly_vec(moved, home).buchberger_naive(limits=LIMITS)
    if not complete:
        message = "the equations are too long to be decided"
        raise TooLarge(message)
    return Ideal(field, basis.autoreduction(groebner=True), home)  # type: ignore[attr-defined]
