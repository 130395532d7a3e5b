"""Cases of a gain: strata on which the rank drops, a gain exists exceptionally, or a denominator vanishes."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeVar

from symobs.exact import Ideal, Matrix, TooLarge
from symobs.system.conditions import Condition
from symobs.tasks.analysis.strata.strata import common_places, equations_of, places, places_of, solved
from symobs.tasks.design.pole_placement.multiple_outputs import MultiOutputPair

if TYPE_CHECKING:
    from symobs.exact import Scalar
    from symobs.system import StateSpace
    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.analysis.strata.strata import Place
    from symobs.tasks.design.gain.gain_design import GainDesign
    from symobs.tasks.design.gain.gain_kind import Places
    from symobs.tasks.result import Case, Result

Design = TypeVar("Design", bound="GainDesign")


def design_of(
    kind: type[Design],
    plant: StateSpace,
    desired: DesiredPolynomial,
    method_name: str = "ackermann",
    zero: Places = (),
    *,
    decoupled: bool = False,
) -> Design:
    """Return the design for a plant; on a stratum it is found once."""
    question = kind, desired, method_name, zero, decoupled
    found: Design = plant.once(question, lambda: kind.of(plant, desired, method_name, zero, decoupled=decoupled))
    return found


def half_of(kind: type[Design], plant: StateSpace, asked: DesiredPolynomial | Matrix) -> Design:
    """Return the design of a half of a compensator: with a given gain, or with a polynomial to assign."""
    return kind.of_given(plant, asked) if isinstance(asked, Matrix) else design_of(kind, plant, asked)


def cases_of_gain(design: GainDesign) -> tuple[Case, ...]:
    """Return the cases of a given or designed gain on strata where it differs from the generic one."""
    return cases_of_given(design) if design.desired is None else cases_of(design, design.desired)


def cases_of(design: GainDesign, desired: DesiredPolynomial) -> tuple[Case, ...]:
    """Return the design on every stratum where its modes, its gain or whether there is one are others than in general."""

    def solve(there: StateSpace, values: dict[str, Scalar]) -> GainDesign:
        asked = desired.substitute(values)
        found = design_of(type(design), there, asked, design.method, design.zero, decoupled=design.decoupled)
        return found.with_gains_of(design, values)

    return solved(design.plant, places_where(design), solve)


def places_where(design: GainDesign) -> tuple[Place, ...]:
    """Return the strata on which modes, gain or whether there is one are others than in general."""
    plant, gain = design.plant, design.answer[design.letter]
    if design.desired is None:
        return places_of(design.test.case_tree) if plant.field.names else ()
    if design.zero and gain is None and design.divides and plant.field.names:
        return common_places(plant, design.needed) if design.needed else ()
    found = places_of(design.test.case_tree)
    if design.pair.is_observable or gain is not None:
        return (*found, *places(plant, chosen(design)))
    return (*found, *common_places(plant, design.existence)) if design.existence else found


def places_beside(whole: Result, inner: GainDesign) -> tuple[Place, ...]:
    """Return the strata of a gain that is a part of another result, on which its own plant is defined."""
    known = {condition.expression for condition in whole.domain}
    apart = [Condition("domain", c.expression) for c in inner.domain if c.expression not in known]
    return tuple(
        place._replace(when=(*place.when, *(c for c in apart if _meets(place, c.expression))))
        for place in places_where(inner)
    )


def _meets(place: Place, value: Scalar) -> bool:
    """Return whether a value may vanish where the equations of a stratum hold."""
    try:
        return not Ideal.of((*equations_of(place), value)).is_whole
    except TooLarge:
        return True


def cases_of_given(design: GainDesign) -> tuple[Case, ...]:
    """Return the cases of a given gain on strata with other fixed modes than the generic ones."""

    def solve(there: StateSpace, values: dict[str, Scalar]) -> GainDesign:
        return type(design).of_given(there, design.answer[design.letter].substitute(values))

    return solved(design.plant, places_where(design), solve)


def chosen(design: GainDesign) -> tuple[Scalar, ...]:
    """Return the denominators due to the choice of one gain of a family: where they vanish another one exists."""
    pair = design.pair
    if design.answer[design.letter] is None or (pair.is_observable and not isinstance(pair, MultiOutputPair)):
        return ()
    lost = {
        case.when[0].expression for case in design.test.case_tree if [c.operator for c in case.when].count("==") == 1
    }
    return tuple(c.expression for c in design.holds_where if c.kind == "claim" and c.expression not in lost)
