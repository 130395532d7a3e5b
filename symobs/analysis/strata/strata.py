"""Strata: what becomes of a result where one irreducible factor of its existence condition vanishes.

Where the equations of a stratum can be solved for parameters the whole question is put again with these put in, and
elsewhere for the plant restricted to the stratum, whose claims hold modulo the equations.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from symobs.analysis.strata.loci import Region, loci
from symobs.analysis.strata.rank_cases import parametrised, undecided_conditions
from symobs.analysis.strata.rank_stratification import Node
from symobs.conditions import Condition, never_zero, vanishing_factors
from symobs.errors import CertificateRejected
from symobs.exact import TooLarge
from symobs.exact.kernel.generators import NotWritten
from symobs.result import Case

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from symobs.exact import Scalar
    from symobs.result import Result
    from symobs.system import StateSpace

    #: Answers the question of a task for the plant of a stratum, given the values of the parameters that were put in.
    Solve: TypeAlias = Callable[[StateSpace, dict[str, Scalar]], Result]


def strata(plant: StateSpace, existence: Iterable[Scalar], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of the factors of `existence` that can vanish; `solve` answers on the plant of the stratum.

    Where a factor is linear in a parameter whose coefficient can vanish, there are two cases of it.  A case is undecided
    (its result is None) where its equations, or the claims of its answer, are beyond what can be checked.
    """
    signs = plant.symbols.signs
    found: list[Case] = []
    region = region_of(plant)
    for factor in vanishing_factors(existence, signs):
        if factor in region.nonzero:
            continue
        linear = None if plant.equations else _linear(factor, signs)
        if linear is None:
            found += _below([factor], region, plant, solve)
            continue
        values, lead = linear
        zeros = region.vanishing(lead)
        when = (Condition("existence", factor, "=="), *(Condition("route", f) for f in zeros))
        found += _case(when, values, plant, solve)
        for f in zeros:
            found += _below([factor, f], region, plant, solve)
    return tuple({frozenset(case.when): case for case in found}.values())


def common_zeros(plant: StateSpace, equations: Iterable[Scalar], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of the strata where several polynomials vanish together."""
    return tuple(_below(equations, region_of(plant), plant, solve))


def equations_of(case: Case) -> tuple[Scalar, ...]:
    """Return what vanishes where a case holds."""
    return tuple(condition.expression for condition in case.when if condition.operator == "==")


def region_of(plant: StateSpace) -> Region:
    """Return the parameters of a plant: with their signs, on its stratum, where its denominators do not vanish."""
    m, signs = plant.matrices, plant.symbols.signs
    domain = vanishing_factors([part.common_denominator() for part in (m.A, m.B, m.C, m.D)], signs)
    return Region(
        signs, frozenset((*domain, *vanishing_factors((*plant.nonzero, *plant.apart), signs))), ideal=plant.ideal
    )


def _below(equations: Iterable[Scalar], region: Region, plant: StateSpace, solve: Solve) -> Iterator[Case]:
    """Yield the cases of the common zeros of equations, with parameters put in where they can be solved for them."""
    for locus in loci(equations, region):
        when = undecided_conditions(locus)
        if locus.ideal is None:
            yield Case(when, {}, None)
        elif locus != region.whole:
            yield from _case(when, parametrised(Node(locus, 0, ()), region), plant, solve)


def carried(plant: StateSpace, cases: Iterable[Case], solve: Solve) -> tuple[Case, ...]:
    """Return the cases of a test with the answers of another task there."""
    found: list[Case] = []
    for case in cases:
        values = dict(case.substitution) or None
        found += _case(case.when, values, plant, solve) if case.result is not None else [case]
    return tuple(found)


def _case(
    when: tuple[Condition, ...], values: dict[str, Scalar] | None, plant: StateSpace, solve: Solve
) -> Iterator[Case]:
    """Yield a case; none where there is no plant, or nothing is asked for."""
    try:
        equations, others = ([c.expression for c in when if c.operator == sign] for sign in ("==", "!="))
        there = plant.restricted((), others)
        there = there.restricted(equations) if values is None else there.substitute(values)
        found = solve(there, values or {})
        if there.equations:  # its own strata are made now, where what cannot be claimed on them can be left undecided
            _ = found.case_tree
        yield Case(when, values or {}, found)
    except ZeroDivisionError:
        return
    except NotWritten:
        yield Case(when, values or {}, None)
    except (CertificateRejected, TooLarge):
        if values is not None and not plant.equations:
            raise
        yield Case(when, {}, None)


def _linear(factor: Scalar, signs: Mapping[str, str]) -> tuple[dict[str, Scalar], Scalar] | None:
    """Return ({name: value}, leading coefficient) where a polynomial is linear in some parameter.

    A parameter whose coefficient never vanishes is preferred; the coefficient is returned because the solution covers
    the stratum only where it is not 0.
    """
    best = None
    for name in sorted(factor.names):
        if factor.degree(name) != 1:
            continue
        lead, constant = factor.coefficients(name)
        found = ({name: -constant / lead}, lead)
        if never_zero(lead, signs):
            return found
        best = best or found
    return best
