"""Loci: the common zeros of polynomials as a union of few and simple systems of equations.

The parameters are real, have their declared signs, and keep the denominators of the plant from 0.  What cannot vanish
there is struck out of every equation before a Gröbner basis is computed, an equation that factors branches, a sum that
cannot vanish but term by term is replaced by its terms, and systems without a solution are dropped.
"""

from __future__ import annotations

import math
from contextlib import suppress
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact import EIGENVALUE, Ideal, Scalar, TooLarge, resultant
from symobs.exact.ideals import FEW
from symobs.ground.dataclass import dataclass
from symobs.system.conditions import FACTORED_UP_TO, SumOfSquares, real_consequences, sign_of, vanishing_factors

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

    from symobs.exact.ideals import QuotientRing

#: The most systems that one question may branch into, and terms of the equations of a system that is worked on.
_BRANCHES = 100
_TERMS = 1_000
#: The most terms of all the systems together that are worked on in one region.
_WORK = 30_000
#: The most terms of a sum of squares, before it is multiplied out.
_SQUARED = 2_000
#: The most meetings of two curves that are eliminated at once.
_MEETINGS = 150
#: How many linear forms are tried to tell points apart, and the name one goes by.
_FORMS, _FORM = 6, "_form"


class EliminationBudget:
    """The terms of equations that may still be worked on."""

    def __init__(self) -> None:
        """Start with all of them."""
        self.left = _WORK

    def spent(self, equations: tuple[Scalar, ...]) -> bool:
        """Charge the size of a system; return whether it is too long or the budget is spent."""
        size = sum(equation.size for equation in equations)
        self.left -= size
        return self.left < 0 or (len(equations) > 1 and size > _TERMS)


@dataclass
class Region:
    """The parameters that are considered: real, with declared signs, on a locus, and none of `nonzero` vanishes."""

    signs: Mapping[str, str]
    nonzero: frozenset[Scalar] = frozenset()
    work: EliminationBudget = field(default_factory=EliminationBudget, compare=False)
    ideal: Ideal | None = None

    @cached_property
    def whole(self) -> Locus:
        """All of them, as a locus."""
        return EVERYWHERE if self.ideal is None else Locus.of(self.ideal)

    def vanishing(self, value: Scalar) -> tuple[Scalar, ...]:
        """Return the distinct irreducible factors of a numerator that can be 0 here."""
        return tuple(f for f in vanishing_factors([value], self.signs) if f not in self.nonzero)

    def simplest_first(self, values: Iterable[Scalar]) -> list[Scalar]:
        """Sort polynomials so that those with few factors, which others contain, come first."""
        return sorted(values, key=lambda value: (len(self.vanishing(value)), value.size))


@dataclass
class Locus:
    """The common zeros of some polynomials in a region; none of it is known where there is no ideal."""

    equations: tuple[Scalar, ...]
    ideal: Ideal | None = field(default=None, compare=False)

    @staticmethod
    def of(ideal: Ideal) -> Locus:
        """Return the locus of an ideal: its equations are the reduced basis, or shorter ones where it is a few points.

        Leading coefficients are positive.
        """
        basis = ideal.generators
        if EIGENVALUE not in ideal.field.position and (by_coordinate := ideal.by_coordinate):
            if (ideal.dimension or 0) > FEW:
                ideal = Ideal.of(by_coordinate)
            basis = min(ideal.generators, by_coordinate, key=lambda equations: sum(e.size for e in equations))
        positive = [g if sign_of(g.factors()[0], {}) == "positive" else -g for g in basis]
        return Locus(tuple(sorted(positive, key=_simplicity)), ideal)

    def lies_in(self, other: Locus) -> bool:
        """Return whether the equations of another locus follow from those of this one.

        Raises `TooLarge` where that is not decided; where there is no ideal, only equations of its own are seen to.
        """
        if self.ideal is None:
            return set(other.equations) <= set(self.equations)
        return all(equation in self.ideal for equation in other.equations)

    @cached_property
    def distance(self) -> Scalar:
        """A polynomial that is 0 exactly on the locus: its equation, or the sum of the squares of its equations.

        Raises `TooLarge` where that is too long.
        """
        if len(self.equations) > 1 and sum(equation.size**2 for equation in self.equations) > _SQUARED:
            raise TooLarge("the squares of the equations are too long")
        return distance_from(self.equations)


def distance_from(equations: tuple[Scalar, ...]) -> Scalar:
    """Return a polynomial that is 0 exactly where some equations hold: the only one, or the sum of their squares."""
    return SumOfSquares.of_parts(equations)


EVERYWHERE = Locus((), Ideal.of(()))


def _simplicity(value: Scalar) -> tuple[int, int, str]:
    return sum(value.degrees()), value.size, str(value) if value.size <= FACTORED_UP_TO else ""


def loci(equations: Iterable[Scalar], region: Region) -> tuple[Locus, ...]:
    """Return the common zeros of polynomials in a region as loci, none of which is seen to lie in another."""
    budget = iter(range(_BRANCHES))
    numerators = (equation.numerator for equation in equations)
    return maximal(_branches((*numerators, *region.whole.equations), region, budget))


def maximal(found: Iterable[Locus]) -> tuple[Locus, ...]:
    """Return the loci that are not seen to lie in another one, the simplest first."""
    kept: list[Locus] = []
    for locus in sorted(dict.fromkeys(found), key=lambda each: (len(each.equations), *_sizes(each))):
        with suppress(TooLarge):  # a locus too many does no harm
            if any(locus.lies_in(other) for other in kept):
                continue
        kept.append(locus)
    return tuple(kept)


def _sizes(locus: Locus) -> tuple[int, str]:
    total = sum(equation.size for equation in locus.equations)
    return total, str(locus.equations) if total <= FACTORED_UP_TO else ""


def _branches(equations: tuple[Scalar, ...], region: Region, budget: Iterator[int]) -> Iterator[Locus]:
    """Yield the loci of a system, branching at the first equation that has several factors."""
    if region.work.spent(equations):
        yield Locus(equations)
        return
    simple: list[Scalar] = []
    for index, equation in enumerate(equations):
        if equation.is_zero:
            continue
        factors = region.vanishing(equation)
        if any(factor in simple for factor in factors):
            continue
        factors = tuple(factor for factor in factors if not any(_are_apart(factor, other) for other in simple))
        if not factors:
            return
        if len(factors) == 1:
            simple.append(factors[0])
            continue
        for factor in factors:
            if next(budget, None) is None:
                yield Locus((*simple, factor, *equations[index + 1 :]))
                return
            yield from _branches((*simple, factor, *equations[index + 1 :]), region, budget)
        return
    if any(equation.size > FACTORED_UP_TO for equation in simple):
        yield Locus(tuple(simple))
        return
    try:
        ideal = Ideal.of(simple)
        if ideal.is_whole or any(value in ideal for value in region.nonzero):
            return
        parts = _parts(ideal, region)
        news = () if parts else _news(ideal, region)
    except TooLarge:
        if (eliminated := _eliminated(simple)) is not None:
            yield from _branches((eliminated, *simple), region, budget)
        else:
            yield Locus(tuple(simple))
        return
    if parts:
        for part in parts:
            yield from _branches(part, region, budget)
    elif news:
        yield from _branches((*news, *ideal.generators), region, budget)
    elif ideal.is_finite and ideal.dimension is None:  # among so many points some may be others than the most
        yield Locus(tuple(simple))
    else:
        yield Locus.of(ideal)


def _are_apart(factor: Scalar, other: Scalar) -> bool:
    """Return whether two irreducible polynomials are different ones in the same single name: they have no zero in common."""
    if len(factor.names) != 1 or factor.names != other.names or factor.field.roots or other.field.roots:
        return False
    return factor not in {other, -other} and max(factor.size, other.size) <= FACTORED_UP_TO


def _eliminated(equations: list[Scalar]) -> Scalar | None:
    """Return a polynomial in one name that vanishes where curves in the plane meet; None where there is one, or for others."""
    names = sorted(frozenset[str]().union(*(equation.names for equation in equations)))
    if len(names) != 2 or any(len(equation.names) < 2 or equation.field.roots for equation in equations):
        return None
    one, other, *_ = sorted(equations, key=lambda equation: sum(equation.degrees()))
    bound = one.degree(names[0]) * other.degree(names[1]) + one.degree(names[1]) * other.degree(names[0])
    return resultant(one, other, names[1]) if EIGENVALUE not in names and bound <= _MEETINGS else None


def _news(ideal: Ideal, region: Region) -> tuple[Scalar, ...]:
    """Return products and polynomials that vanish with the ideal, but are not seen to by its basis."""
    news: list[Scalar] = []
    for generator in ideal.generators:
        factors = region.vanishing(generator)
        stripped = math.prod(factors, start=Scalar.of(1))
        consequences = real_consequences(generator, region.signs)
        found = [value for value in (stripped, *consequences) if value not in ideal]
        if len(factors) > 1 and not found:
            found = [stripped]
        news += found
    return tuple(news) or _coordinates(ideal, region)


def _parts(ideal: Ideal, region: Region) -> tuple[tuple[Scalar, ...], ...]:
    """Return systems of equations for the parts of many points that a coordinate tells apart; none where it is one part."""
    quotient = ideal.quotient
    if EIGENVALUE in ideal.field.position or quotient is None or quotient.dimension <= FEW:
        return ()
    for name in ideal.field.names:
        found = quotient.minimal_polynomial(Scalar.symbol(name), name)
        zeros = region.vanishing(found)
        if zeros in {(found,), (-found,)}:
            continue
        systems = (quotient.by_coordinate(name, factor, found) or (factor, *ideal.generators) for factor in zeros)
        return tuple(systems) or ((Scalar.of(1),),)
    return ()


def _coordinates(ideal: Ideal, region: Region) -> tuple[Scalar, ...]:
    """Return univariate polynomials that separate finitely many points or simplify them.

    Where such a polynomial has several factors the points branch, and a rational point is left with its coordinates.  Points
    that no coordinate tells apart a sum of multiples of two does.
    """
    quotient = ideal.quotient
    if EIGENVALUE in ideal.field.position or quotient is None or not quotient.dimension:
        return ()
    for name in ideal.field.names:
        found = quotient.minimal_polynomial(Scalar.symbol(name), name)
        stripped = math.prod(region.vanishing(found), start=Scalar.of(1))
        if stripped not in ideal or len(region.vanishing(found)) > 1:
            return (stripped,)
        if found.degree(name) == ideal.dimension:
            return ()
    return _apart(ideal, quotient)


def _apart(ideal: Ideal, quotient: QuotientRing) -> tuple[Scalar, ...]:
    """Return, of points that no coordinate tells apart, a polynomial in a linear form that has several factors, if any has."""
    names = ideal.field.names
    for multiple in range(1, _FORMS + 1):
        form = sum((multiple**k * Scalar.symbol(name) for k, name in enumerate(names)), Scalar.of(0))
        found = quotient.minimal_polynomial(form, _FORM)
        factors = vanishing_factors([found], {_FORM: "real"})
        if len(factors) != 1 or factors[0].degree(_FORM) < found.degree(_FORM):
            return (math.prod((factor.substitute({_FORM: form}) for factor in factors), start=Scalar.of(1)),)
        if found.degree(_FORM) == ideal.dimension:
            return ()
    return ()
