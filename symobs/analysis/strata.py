"""Strata: what becomes of a result where one irreducible factor of its existence condition vanishes.

A factor that is linear in some parameter is solved for it, and the whole question is put again on the stratum.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.conditions import Condition, never_zero, vanishing_factors
from symobs.method import Case

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from symobs.exact import Scalar
    from symobs.method import Result
    from symobs.system import StateSpace


def strata(
    plant: StateSpace,
    existence: Iterable[Scalar],
    solve: Callable[[StateSpace, dict[str, Scalar]], Result],
) -> tuple[Case, ...]:
    """Return one case for each factor of `existence` that can vanish; `solve` answers on the plant of the stratum.

    Where a factor is not linear in any parameter the case is undecided (its result is None); so is the part of a
    stratum where the coefficient of the parameter it was solved for vanishes.
    """
    signs = plant.symbols.signs
    found = []
    for factor in vanishing_factors(existence, signs):
        when: tuple[Condition, ...] = (Condition("existence", factor, "=="),)
        solution = solve_for_parameter(factor, signs)
        if solution is None:
            found.append(Case(when, {}, None))
            continue
        name, value, lead = solution
        if not never_zero(lead, signs):
            zeros = vanishing_factors([lead], signs)
            found += [Case((*when, Condition("route", f, "==")), {}, None) for f in zeros]
            when = (*when, *(Condition("route", f) for f in zeros))
        substitution = {name: value}
        try:
            found.append(Case(when, substitution, solve(plant.substitute(substitution), substitution)))
        except ZeroDivisionError:  # there is no plant, or nothing is asked for
            continue
    return tuple(found)


def solve_for_parameter(factor: Scalar, signs: Mapping[str, str]) -> tuple[str, Scalar, Scalar] | None:
    """Return (name, value, leading coefficient) that makes a polynomial vanish, where it is linear in some parameter.

    A parameter whose coefficient never vanishes is preferred; the coefficient is returned because the solution covers
    the stratum only where it is not 0.
    """
    best = None
    for name in sorted(factor.names):
        if factor.degree(name) != 1:
            continue
        lead, constant = factor.coefficients(name)
        found = (name, -constant / lead, lead)
        if never_zero(lead, signs):
            return found
        best = best or found
    return best
