"""Ideals: which polynomials vanish wherever some polynomials do.

An ideal stands for what is known to be 0: the equations of a stratum, the minimal polynomial of an eigenvalue, the
relation c² + s² = 1 of a cosine and a sine.  It is kept as a reduced Gröbner basis (Buchberger's algorithm of FLINT in
the graded reverse lexicographic order; with an eigenvalue in the lexicographic one), whose size is limited, since its
computation cannot be interrupted.
"""

from __future__ import annotations

from functools import cached_property, lru_cache
from itertools import product
from math import prod
from typing import TYPE_CHECKING

from flint import Ordering, fmpz_mat, fmpz_mpoly_vec

from symobs.exact.kernel.field import EIGENVALUE, Field, context_of
from symobs.exact.kernel.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from flint import fmpz_mpoly, fmpz_mpoly_ctx

#: The most polynomials of a basis, terms of one of them, and bits of a coefficient, before the work is given up.
LIMITS = (120, 600, 4_000)
#: The most terms that the generators may have together.
TERMS = 1_000
#: The most monomials among which a basis of the functions on finitely many points is looked for.
_MONOMIALS = 60
#: The most points that are written by the polynomial of one coordinate: beyond, its coefficients are long.
_FEW = 6


#: What the names of the coordinates of a vector begin with; no parameter's name begins so.
_UNIT = "_e"


class TooLarge(ArithmeticError):
    """A computation with polynomials went beyond the limits: nothing is known."""


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
            return self.within(field).remainder(value)
        moved = field.lift(value.numerator_part, value.field).project_to_context(self.home)
        return self._back(moved.reduction_primitive_part(self.basis))  # type: ignore[attr-defined]

    def within(self, field: Field) -> Ideal:
        """Return the ideal in a larger field: further generators leave a reduced basis of the same order what it is."""
        if (EIGENVALUE in field.position) != (EIGENVALUE in self.field.position):
            return _ideal(self.generators, field)
        home = _home(field)
        moved = [field.lift(g.numerator_part, g.field).project_to_context(home) for g in self.generators]
        return Ideal(field, fmpz_mpoly_vec(moved, home), home)

    def reduced_column(self, entries: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Return the normal forms of the entries of a vector, times one common rational number.

        Entries are polynomials.  They are reduced as the linear form Σ entryᵢ eᵢ in new generators, which keeps their
        proportions.
        """
        names = [f"{_UNIT}{index}" for index in range(len(entries))]
        form = sum((e * Scalar.symbol(n) for e, n in zip(entries, names, strict=True)), Scalar.of(0))
        rest = self.remainder(form)
        zeros = {name: Scalar.of(0) for name in names}
        return tuple(rest.substitute({**zeros, name: Scalar.of(1)}) for name in names)

    def __contains__(self, value: Scalar) -> bool:
        return self.remainder(value).is_zero

    def simplified(self, value: Scalar) -> Scalar:
        """Return a rational function that agrees with `value` wherever the ideal vanishes, in normal form.

        Where that would be longer, or divide by 0, the value stays as it is.
        """
        if not self.generators:
            return value
        above, below, one = self.reduced_column([value.numerator, value.denominator, Scalar.of(1)])
        if below.is_zero or one.is_zero:
            return value
        return above / below if above.size + below.size <= value.size else value

    @cached_property
    def _bounds(self) -> tuple[int, ...] | None:
        """The exponents at which each generator alone is a leading monomial; None where one never is."""
        leading = [polynomial.monoms()[0] for polynomial in self.basis]
        found = [_pure_power(leading, k) for k in range(len(self.home.names()))]
        return tuple(bound for bound in found if bound is not None) if found and None not in found else None

    @property
    def is_finite(self) -> bool:
        """Whether there are finitely many complex zeros."""
        return self._bounds is not None

    @cached_property
    def dimension(self) -> int | None:
        """How many complex zeros there are, each counted with its multiplicity; None where they are too many to be counted.

        As many monomials are divisible by no leading monomial of the basis.
        """
        if self._bounds is None or prod(self._bounds) > _MONOMIALS:
            return None
        leading = [polynomial.monoms()[0] for polynomial in self.basis]
        monomials = product(*map(range, self._bounds))
        return sum(not any(_divides(lead, powers) for lead in leading) for powers in monomials)

    def minimal_polynomial(self, name: str) -> Scalar:
        """Return the polynomial of least degree in one generator alone that lies in an ideal with finitely many zeros."""
        return self._dependence([Scalar.symbol(name) ** k for k in range((self.dimension or 0) + 1)])

    @cached_property
    def triangular(self) -> tuple[Scalar, ...] | None:
        """Other generators: a polynomial in one name, and every other name as a polynomial in it; None where there are none."""
        for name in reversed(self.field.names) if 0 < (self.dimension or 0) <= _FEW else ():
            powers = [Scalar.symbol(name) ** k for k in range(self.dimension or 0)]
            below = self.minimal_polynomial(name)
            if below.degree(name) == self.dimension:
                others = (Scalar.symbol(other) for other in self.field.names if other != name)
                return (below, *(self._dependence([*powers, other]) for other in others))
        return None

    def _dependence(self, values: Sequence[Scalar]) -> Scalar:
        """Return the combination of the first values, with rational coefficients, that lies in the ideal."""
        forms = [{part: coefficient for coefficient, part in form.each_term()} for form in self.reduced_column(values)]
        parts = list(dict.fromkeys(part for form in forms for part in form))
        reduced, below, rank = fmpz_mat([[int(form.get(part, 0)) for form in forms] for part in parts]).rref()
        last = next(k for k in range(len(forms)) if k >= rank or reduced[k, k] == 0)
        rest = (Scalar.of(int(reduced[k, last])) * values[k] for k in range(last))
        found = sum((-term for term in rest), Scalar.of(int(below)) * values[last])
        return found / found.factors()[0]

    def having(self, *others: Scalar) -> Ideal:
        """Return the ideal with further generators; raises `TooLarge`."""
        return Ideal.of((*self.generators, *others))

    def _back(self, polynomial: fmpz_mpoly) -> Scalar:
        return Scalar(self.field, polynomial.project_to_context(self.field.context), self.field.one)


def _pure_power(leading: Sequence[tuple[int, ...]], place: int) -> int | None:
    """Return the exponent of the one generator whose power is a leading monomial, None where none is."""
    return next((powers[place] for powers in leading if sum(powers) == powers[place]), None)


def _divides(lead: tuple[int, ...], powers: tuple[int, ...]) -> bool:
    return all(here <= there for here, there in zip(lead, powers, strict=True))


def apart_from_zero(value: Scalar) -> Scalar:
    """Return the polynomial 1 − w p, which has zeros exactly where p is not 0; w is a generator that belongs to p alone."""
    return 1 - Scalar.symbol(f"1/({value.numerator})") * value.numerator


def _home(field: Field) -> fmpz_mpoly_ctx:
    """Return the context of a basis: with an eigenvalue among the names, what does not speak of it is seen in the basis.

    It comes first in a lexicographic order, which eliminates it.
    """
    if EIGENVALUE not in field.position:
        return context_of(field.names, Ordering.degrevlex)
    others = (name for name in field.names if name != EIGENVALUE)
    return context_of((EIGENVALUE, *others), Ordering.lex)


@lru_cache(maxsize=512)
def _ideal(generators: tuple[Scalar, ...], field: Field | None = None) -> Ideal:
    for generator in generators:
        field = generator.field if field is None else field | generator.field
    field = field or Field.of(())
    home = _home(field)
    moved = [field.lift(g.numerator_part, g.field).project_to_context(home) for g in generators]
    if any(polynomial.is_constant() for polynomial in moved):
        return Ideal(field, fmpz_mpoly_vec([home.constant(1)], home), home)
    if len(moved) > 1 and sum(len(polynomial) for polynomial in moved) > TERMS:
        message = "the equations have too many terms"
        raise TooLarge(message)
    basis, complete = fmpz_mpoly_vec(moved, home).buchberger_naive(limits=LIMITS)
    if not complete:
        message = "the equations are too long to be decided"
        raise TooLarge(message)
    return Ideal(field, basis.autoreduction(groebner=True), home)  # type: ignore[attr-defined]
