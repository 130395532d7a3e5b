"""Parameter values at which the advice changes: zeros on the axis or lost, modes that become unobservable."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.exact.core.generators import NotWritten, function_named
from symobs.ground.errors import InputError
from symobs.system.conditions import Condition, vanishing_factors
from symobs.tasks.analysis.rank.observability import Controllability, Observability
from symobs.tasks.analysis.strata.loci import loci
from symobs.tasks.analysis.strata.rank_cases import equations_of_locus
from symobs.tasks.analysis.strata.strata import carried, region_of, strata
from symobs.tasks.design.pole_advice.pole_candidates import OPEN, needed_of
from symobs.tasks.result import Case

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from symobs.exact import Scalar
    from symobs.system import StateSpace
    from symobs.tasks.design.pole_advice.advised_poles import AdvisedPoles


def cases_of(advice: AdvisedPoles) -> tuple[Case, ...]:
    """Return the advice where zeros are stable that need not be, and on the strata where zeros or modes are lost."""
    return (*_of_open_zeros(advice), *_of_strata(advice))


def existence_of(plant: StateSpace, numerator: Scalar) -> tuple[Condition, ...]:
    """Return the conditions for as many zeros as in general, and for a plant all of whose modes are seen and moved."""
    tests = [test.of(plant, "rank") for test in (Observability, Controllability)]
    found = [c for test in tests for c in test.holds_where if c.kind == "existence"]
    return tuple(dict.fromkeys((*(Condition("existence", f) for f in _lead(plant, numerator)), *found)))


def _lead(plant: StateSpace, numerator: Scalar) -> tuple[Scalar, ...]:
    return vanishing_factors([numerator.coefficients(plant.variable)[0]], plant.symbols.signs) if numerator else ()


def _of_open_zeros(advice: AdvisedPoles) -> Iterator[Case]:
    """Yield, for each factor whose roots are places for poles under conditions only, the advice under these.

    Within it the factors before stay unused: where those are stable too, their own case comes first.
    """
    taken = advice.taken
    opened = [factor for factor, _, reason in advice.zeros.unused if reason in OPEN]
    after = opened[opened.index(advice.passed) + 1 :] if advice.passed in opened else opened
    for factor in after:
        conditions = tuple(
            Condition("claim", value, ">")
            for value in needed_of(factor, advice.plant.symbols.signs, advice.answer["sigma"], advice.plant.variable)
        )
        try:
            there = type(advice).of(advice.plant, advice.request, advice.method, (*taken, factor))
        except InputError:  # a circle that square roots do not write
            yield Case(conditions, {}, None)
        else:
            yield Case(conditions, {}, there)


def _of_strata(advice: AdvisedPoles) -> tuple[Case, ...]:
    """Return the advice on every stratum where a zero is lost, or a mode is not seen or not moved."""
    if advice.taken:
        return ()  # they are those of the advice in general
    plant = advice.plant

    def solve(there: StateSpace, values: Mapping[str, Scalar]) -> AdvisedPoles:
        request, radius = advice.request, advice.request.radius
        moved = request if radius is None else replace(request, radius=radius.substitute(values))
        try:
            return type(advice).of(there, moved, advice.method)
        except InputError as error:
            raise NotWritten(str(error)) from error

    found = strata(plant, _lead(plant, advice.numerator), solve)
    for test in (Observability, Controllability):
        found += carried(plant, test.of(plant, "rank").case_tree, solve)
    found += tuple(_of_kept_modes(advice))
    return tuple({case.when: case for case in found}.values())


def _of_kept_modes(advice: AdvisedPoles) -> Iterator[Case]:
    """Yield where modes that no gain moves are among the poles after all: there nothing is decided here."""
    if advice.missed.is_one:
        return
    rest = advice.pair.divided(advice.answer["polynomial"].value)[1]
    left = [c.numerator for c in rest.coefficients(advice.plant.variable) if not c.is_zero]
    if not any(c.is_constant for c in left) and not any(function_named(name) for c in left for name in c.names):
        for locus in loci(left, region_of(advice.plant)):
            yield Case(equations_of_locus(locus), {}, None)
