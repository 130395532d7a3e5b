"""Questions about regions given by conjunctions: empty, one inside the other, the same.

In turn: a rational point, tried exactly; a proof by products; z3; qepcad.  Each of them ends, and where none of them
answers the answer is `undecided`.
"""

from __future__ import annotations

from dataclasses import dataclass
from time import monotonic
from typing import TYPE_CHECKING

from symobs.region.external import none_by_cells
from symobs.region.points import Point, find_point
from symobs.region.proof import ZERO, Equivalence, Step
from symobs.region.simplify import TOGETHER, asked, failing_alone, in_parts, nonempty_or_not, prove_value
from symobs.region.state import State

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar


@dataclass(frozen=True, slots=True)
class Decision:
    """`yes`, `no` or `undecided`, with the steps that prove a yes or the point that proves a no, unless `by` says who."""

    verdict: str
    point: Point | None = None
    steps: tuple[Step, ...] = ()
    by: str = ""


_UNDECIDED = Decision("undecided")


def decide_empty(conditions: Sequence[Scalar], signs: Mapping[str, str], *, ask: bool = True) -> Decision:
    """Tell whether the conditions, each > 0, hold nowhere; the steps of a yes lead from them to 0 > 0."""
    state = _parts_of(conditions, signs)
    point, steps = nonempty_or_not(state.current, signs, monotonic() + TOGETHER if ask else 0.0)
    if point is not None:
        return Decision("no", point=_with_all_names(point, conditions, signs), by="point")
    if steps is not None:
        return Decision("yes", steps=(*state.backward, *steps), by="proof")
    if not ask:
        return _UNDECIDED
    return _by_cells(none_by_cells(state.current, signs))


def implies(conditions: Sequence[Scalar], other: Scalar, signs: Mapping[str, str], *, ask: bool = True) -> Decision:
    """Tell whether other > 0 wherever all conditions are > 0; a point of a no is one where they are and it is not."""
    state = _parts_of(conditions, signs)
    wanted = in_parts(State((_cleared(other),)), _cleared(other), signs)
    until = monotonic() + TOGETHER if ask else 0.0
    steps = state.backward
    for part in wanted.current:
        point = failing_alone(part, state.current, signs)
        found = prove_value(part, state.current, signs) if point is None else None
        if point is None and found is None and ask:
            point, found = asked(part, state.current, signs, until)
        if point is not None:
            return Decision("no", point=_with_all_names(point, (*conditions, other), signs), by="point")
        if found is None:
            cells = none_by_cells(state.current, signs, not_above=part) if ask else "maybe"
            if cells != "yes":
                return _by_cells(cells)
            return _rest_by_cells(conditions, other, signs)
        steps = (*steps, *found)
    return Decision("yes", steps=(*steps, *wanted.forward), by="proof")


def same_region(
    first: Sequence[Scalar], second: Sequence[Scalar], signs: Mapping[str, str], *, ask: bool = True
) -> Decision:
    """Tell whether two lists of conditions > 0 hold at the same points; a point of a no lies in one region only."""
    by, steps, open_ = "proof", list[Step](), False
    for given, wanted in ((first, second), (second, first)):
        for other in wanted:
            found = implies(given, other, signs, ask=ask)
            if found.verdict == "no":
                return found
            open_ = open_ or found.verdict == "undecided"
            by = found.by if found.by == "qepcad" else by
            steps += found.steps
    return _UNDECIDED if open_ else Decision("yes", steps=tuple(steps) if by == "proof" else (), by=by)


def equivalence_of(raw: Sequence[Scalar], said: Sequence[Scalar], signs: Mapping[str, str]) -> Equivalence | None:
    """Return the proof that two lists of conditions hold at the same points, without z3; None where none is found."""
    directions = []
    for given, wanted in ((said, raw), (raw, said)):
        found = [implies(given, other, signs, ask=False) for other in wanted]
        if any(decision.verdict != "yes" for decision in found):
            return None
        directions.append(tuple(step for decision in found for step in decision.steps))
    return Equivalence(tuple(raw), tuple(said), *directions)
