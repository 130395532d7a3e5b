"""What is true of a gain where the rank of its test drops, where no gain exists in general, or where it divides by 0."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.analysis.strata.strata import carried, common_zeros, strata
from symobs.design.pole_placement.multiple_outputs import SeveralOutputs

if TYPE_CHECKING:
    from symobs.design.gain.gain_design import GainDesign
    from symobs.exact import Scalar
    from symobs.result import Case
    from symobs.specification import DesiredPolynomial
    from symobs.system import StateSpace


def cases_of_gain(design: GainDesign) -> tuple[Case, ...]:
    """Return what is true of a given gain, or of one that was asked for, where it is not true in general."""
    return cases_of_given(design) if design.desired is None else cases_of(design, design.desired)


def cases_of(design: GainDesign, desired: DesiredPolynomial) -> tuple[Case, ...]:
    """Return the design on every stratum where its modes, its gain or whether there is one are others than in general."""
    plant, letter = design.plant, design.letter

    def solve(there: StateSpace, values: dict[str, Scalar]) -> GainDesign:
        found = type(design).of(
            there, desired.substitute(values), design.method, design.zero, decoupled=design.decoupled
        )
        own = design.answer[letter]
        if own is None or found.answer[letter] is None:
            return found
        try:  # the gain of the main line, where it is still there
            kept = own.substitute(values)
        except ZeroDivisionError:
            return found
        return found.with_answer(letter, kept) if there.admits(kept) else found

    if design.zero and design.answer[letter] is None and design.divides and plant.field.names:
        return common_zeros(plant, design.needed, solve) if design.needed else ()
    found = carried(plant, design.test.case_tree, solve)
    if design.pair.is_observable or design.answer[letter] is not None:
        return (*found, *strata(plant, chosen(design), solve))
    return (*found, *common_zeros(plant, design.existence, solve)) if design.existence else found


def cases_of_given(design: GainDesign) -> tuple[Case, ...]:
    """Return what a given gain does on the strata where other modes than in general are beyond any gain."""

    def solve(there: StateSpace, values: dict[str, Scalar]) -> GainDesign:
        return type(design).of_given(there, design.answer[design.letter].substitute(values))

    return carried(design.plant, design.test.case_tree, solve) if design.plant.field.names else ()


def chosen(design: GainDesign) -> tuple[Scalar, ...]:
    """Return what the gain divides by because it is this one of many: where it vanishes another one serves."""
    pair = design.pair
    if design.answer[design.letter] is None or (pair.is_observable and not isinstance(pair, SeveralOutputs)):
        return ()
    lost = {
        case.when[0].expression for case in design.test.case_tree if [c.operator for c in case.when].count("==") == 1
    }
    return tuple(c.expression for c in design.holds_where if c.kind == "claim" and c.expression not in lost)
