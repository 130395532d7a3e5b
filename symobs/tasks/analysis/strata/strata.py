"""Strata: what becomes of a result where one irreducible factor of its existence condition vanishes.

Where the equations of a stratum can be solved for parameters the whole question is put again with these put in, and
elsewhere for the plant restricted to the stratum, whose claims hold modulo the equations.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from symobs.exact import TooLarge
from symobs.exact.core.generators import NotWritten, letters_outside
from symobs.ground.errors import CertificateRejected
from symobs.system.conditions import Condition, never_zero, vanishing_factors
from symobs.tasks.analysis.strata.loci import Region, loci
from symobs.tasks.analysis.strata.rank_cases import equations_of_locus, parametrised
from symobs.tasks.analysis.strata.rank_stratification import Node
from symobs.tasks.result import Case

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.exact import Scalar
    from symobs.system import StateSpace
    from symobs.tasks.result import Result

    #: Answers the question of a task for the plant of a stratum, given the values of the parameters that were put in.
    Solve: TypeAlias = Callable[[StateSpace, dict[str, Scalar]], Result]


class Place(NamedTuple):
    """A stratum on which nothing is asked yet: its conditions, and the values of parameters where it is solved for them.

    Where it is not `open` nothing can be told of it.
    """

    when: tuple[Condition, ...]
    values: dict[str, Scalar] | None
    is_open: bool = True


def strata(plant: StateSpace, existence: Iterable[Scalar], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of the factors of `existence` that can vanish; `solve` answers on the plant of the stratum.

    A case is undecided (its result is None) where its equations, or the claims of its answer, are beyond what can be
    checked.
    """
    found = solved(plant, places(plant, existence), solve)
    return tuple({frozenset(case.when): case for case in found}.values())


def places(plant: StateSpace, existence: Iterable[Scalar]) -> tuple[Place, ...]:
    """Return the strata where factors of `existence` vanish under the declared signs.

    Where a factor is linear in a parameter whose coefficient can vanish, there are two of it.
    """
    signs = plant.symbols.signs
    found: list[Place] = []
    region = region_of(plant)
    for factor in vanishing_factors(existence, signs):
        if factor in region.nonzero:
            continue
        linear = None if plant.equations else _linear(factor, signs)
        if linear is None:
            found += _below([factor], region)
            continue
        values, lead = linear
        zeros = region.vanishing(lead)
        when = (Condition("existence", factor, "=="), *(Condition("route", f) for f in zeros))
        found.append(Place(when, values))
        for f in zeros:
            found += _below([factor, f], region)
    return tuple({frozenset(place.when): place for place in found}.values())


def common_zeros(plant: StateSpace, equations: Iterable[Scalar], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of the strata where several polynomials vanish together."""
    return solved(plant, common_places(plant, equations), solve)


def common_places(plant: StateSpace, equations: Iterable[Scalar]) -> tuple[Place, ...]:
    """Return the strata where several polynomials vanish together."""
    return tuple(_below(equations, region_of(plant)))


def equations_of(place: Place) -> frozenset[Scalar]:
    """Return what vanishes on a stratum."""
    return frozenset(condition.expression for condition in place.when if condition.operator == "==")


def region_of(plant: StateSpace) -> Region:
    """Return the parameters of a plant: with their signs, on its stratum, where its denominators do not vanish."""
    m, signs = plant.matrices, plant.symbols.signs
    domain = vanishing_factors([part.common_denominator() for part in (m.A, m.B, m.C, m.D)], signs)
    return Region(
        signs, frozenset((*domain, *vanishing_factors((*plant.nonzero, *plant.apart), signs))), ideal=plant.ideal
    )


def _below(equations: Iterable[Scalar], region: Region) -> Iterator[Place]:
    """Yield the common zeros of equations, with the values of parameters where they can be solved for them."""
    for locus in loci(equations, region):
        when = equations_of_locus(locus)
        if locus.ideal is None:
            yield Place(when, {}, is_open=False)
        elif locus != region.whole:
            yield Place(when, parametrised(Node(locus, 0, ()), region))


def losses(cases: Iterable[Case], above: tuple[Scalar, ...] = ()) -> Iterator[tuple[Scalar, ...]]:
    """Yield the equations of the strata on which the answer is no or unknown, those inside of a case with its own."""
    for case in cases:
        equations = (*above, *(c.expression for c in case.when if c.operator == "=="))
        if case.result is None or case.result.verdict == "no":
            yield equations
        else:
            yield from losses(case.result.case_tree, equations)


def places_of(cases: Iterable[Case]) -> tuple[Place, ...]:
    """Return where the cases of a test are."""
    return tuple(
        Place(case.when, dict(case.substitution) or None)
        if case.result is not None
        else Place(case.when, {}, is_open=False)
        for case in cases
    )


def carried(plant: StateSpace, cases: Iterable[Case], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of a test with the answers of another task there."""
    return solved(plant, places_of(cases), solve)


def solved(plant: StateSpace, asked: Iterable[Place], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of some strata, each with the answer of a task there.

    All are answered before the strata of one of them are looked at: what may be found goes to the widest strata first.
    """

    def answer(place: Place) -> Result | None:
        if not place.is_open or plant.findings.are_over:
            return None
        return solve(_plant_on(place, plant), place.values or {})

    def with_strata(case: Case) -> Result | None:
        # Its own strata are made now, where what cannot be claimed on them can be left undecided.
        if case.result is not None and case.result.plant.equations:
            _ = case.result.case_tree
        return case.result

    found = [(place, case) for place in asked for case in _case(place, plant, partial(answer, place))]
    return tuple(each for place, case in found for each in _case(place, plant, partial(with_strata, case)))


def _case(place: Place, plant: StateSpace, find: Callable[[], Result | None]) -> Iterator[Case]:
    """Yield the case of a stratum with its result; none where the plant is undefined or the question is void."""
    when, values, _ = place
    try:
        yield Case(when, values or {}, find())
    except ZeroDivisionError:
        return
    except NotWritten:
        yield Case(when, values or {}, None)
    except (CertificateRejected, TooLarge):
        if values is not None and not plant.equations:
            raise
        yield Case(when, {}, None)


def _plant_on(place: Place, plant: StateSpace) -> StateSpace:
    """Return the plant of a stratum."""
    equations, others = ([c.expression for c in place.when if c.operator == sign] for sign in ("==", "!="))
    there = plant.restricted((), others)
    return plant.stratum(there.restricted(equations) if place.values is None else there.substitute(place.values))


def _linear(factor: Scalar, signs: Mapping[str, str]) -> tuple[dict[str, Scalar], Scalar] | None:
    """Return ({name: value}, leading coefficient) where a polynomial is linear in some parameter.

    A parameter whose coefficient never vanishes is preferred; the coefficient is returned because the solution covers
    the stratum only where it is not 0.
    """
    best = None
    for name in letters_outside(factor):
        if factor.degree(name) != 1:
            continue
        lead, constant = factor.coefficients(name)
        found = ({name: -constant / lead}, lead)
        if never_zero(lead, signs):
            return found
        best = best or found
    return best
