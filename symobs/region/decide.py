"""Questions about regions given by conjunctions: empty, one inside the other, the same.

In turn: a rational point, tried exactly; a proof by products; z3; qepcad.  Each of them ends, and where none of them
answers the answer is `undecided`.
"""

from __future__ import annotations

from fractions import Fraction
from time import monotonic
from typing import TYPE_CHECKING

from symobs.record import dataclass
from symobs.region.external import names_of, none_by_cells
from symobs.region.parts import State, cleared, in_parts, split_products
from symobs.region.proof import Equivalence, Step
from symobs.region.simplify import TOGETHER, asked, failing_alone, nonempty_or_not, prove_value

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar
    from symobs.region.points import Point


@dataclass(frozen=True)
class Decision:
    """`yes`, `no` or `undecided`, with the steps that prove a yes or the point that proves a no, unless `by` says who."""

    verdict: str
    point: Point | None = None
    steps: tuple[Step, ...] = ()
    by: str = ""


_UNDECIDED = Decision("undecided")


def decide_empty(conditions: Sequence[Scalar], signs: Mapping[str, str], *, ask: bool = True) -> Decision:
    """Tell whether the conditions, each > 0, hold nowhere; the steps of a yes lead from them to 0 > 0.

    Only with `ask` are z3 and qepcad asked.
    """
    state = _in_parts(conditions, signs)
    point, steps = nonempty_or_not(state.current, signs, monotonic() + TOGETHER if ask else 0.0)
    if point is not None:
        return Decision("no", point=_completed(point, conditions, signs), by="point")
    if steps is not None:
        return Decision("yes", steps=(*state.backward, *steps), by="proof")
    return _by_cells(none_by_cells(state.current, signs)) if ask else _UNDECIDED


def implies(conditions: Sequence[Scalar], other: Scalar, signs: Mapping[str, str], *, ask: bool = True) -> Decision:
    """Tell whether other > 0 wherever all conditions are > 0; a point of a no is one where they are and it is not."""
    state, wanted = _in_parts(conditions, signs, split=True), _in_parts((other,), signs)
    until = monotonic() + TOGETHER if ask else 0.0
    found = [_follows(part, state.current, signs, until) for part in wanted.current]
    for decision in found:
        if decision.point is not None:
            return Decision("no", point=_completed(decision.point, (*conditions, other), signs), by="point")
    verdicts = {decision.verdict for decision in found}
    if verdicts != {"yes"} and found:
        return Decision("no", by="qepcad") if "no" in verdicts else _UNDECIDED
    if any(decision.by == "qepcad" for decision in found):
        return Decision("yes", by="qepcad")
    steps = (*state.backward, *(step for decision in found for step in decision.steps), *wanted.forward)
    return Decision("yes", steps=steps, by="proof")


def same_region(
    first: Sequence[Scalar], second: Sequence[Scalar], signs: Mapping[str, str], *, ask: bool = True
) -> Decision:
    """Tell whether two lists of conditions > 0 hold at the same points; a point of a no lies in one region only.

    `equivalence_of` gives the proof of a yes.
    """
    found = [implies(first, other, signs, ask=ask) for other in second]
    found += [implies(second, other, signs, ask=ask) for other in first]
    for verdict in ("no", "undecided"):
        for decision in found:
            if decision.verdict == verdict:
                return decision
    return Decision("yes", by="qepcad" if any(decision.by == "qepcad" for decision in found) else "proof")


def equivalence_of(
    raw: Sequence[Scalar], said: Sequence[Scalar], signs: Mapping[str, str], *, ask: bool = False
) -> Equivalence | None:
    """Return the proof that two lists of conditions hold at the same points; None where none is found.

    Rational functions stand in it as numerator times denominator.
    """
    raw, said = tuple(map(cleared, raw)), tuple(map(cleared, said))
    forward = [implies(said, other, signs, ask=ask) for other in raw]
    backward = [implies(raw, other, signs, ask=ask) for other in said]
    if any(decision.verdict != "yes" or decision.by == "qepcad" for decision in (*forward, *backward)):
        return None
    there, back = (tuple(step for decision in found for step in decision.steps) for found in (forward, backward))
    return Equivalence(raw, said, there, back)


def _in_parts(values: Sequence[Scalar], signs: Mapping[str, str], *, split: bool = False) -> State:
    state = State(tuple(dict.fromkeys(map(cleared, values))))
    for value in state.current:
        state = in_parts(state, value, signs)
    return split_products(state, signs) if split else state


def _follows(part: Scalar, known: Sequence[Scalar], signs: Mapping[str, str], until: float) -> Decision:
    point = failing_alone(part, known, signs)
    steps = prove_value(part, known, signs) if point is None else None
    if point is None and steps is None and monotonic() < until:
        point, steps = asked(part, known, signs, until)
    if point is not None:
        return Decision("no", point=point, by="point")
    if steps is not None:
        return Decision("yes", steps=steps, by="proof")
    return _by_cells(none_by_cells(known, signs, not_above=part)) if until else _UNDECIDED


def _by_cells(answer: str) -> Decision:
    return _UNDECIDED if answer == "maybe" else Decision(answer, by="qepcad")


def _completed(point: Point, values: Sequence[Scalar], signs: Mapping[str, str]) -> Point:
    """Return the point with values for names that play no part."""
    missing = {name for name in names_of(values) if name not in point}
    usual = {name: Fraction(-1 if signs.get(name) in {"negative", "nonpositive"} else 1) for name in missing}
    return {**point, **usual}
