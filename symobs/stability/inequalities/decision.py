"""Decisions on conjunctions of inequalities: emptiness, implication, equivalence.

In turn: a rational point, tried exactly; a proof by products.  Where neither is found the answer is `undecided`.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.factors import InequalitySystem, cleared, split_into_factors, split_products
from symobs.stability.inequalities.proof import Equivalence, Step
from symobs.stability.inequalities.simplify import failing_alone, nonempty_or_not, prove_value
from symobs.stability.inequalities.z3_backend import Resources, names_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar
    from symobs.stability.inequalities.sample_points import Point


@dataclass(frozen=True)
class Decision:
    """A decision, `yes`, `no` or `undecided`, with the proof of a yes or the point that refutes it."""

    verdict: str
    point: Point | None = None
    steps: tuple[Step, ...] = ()


_UNDECIDED = Decision("undecided")


def decide_empty(conditions: Sequence[Scalar], signs: Mapping[str, str]) -> Decision:
    """Decide whether the conditions, each > 0, are contradictory; a yes has the steps from them to 0 > 0."""
    state = _in_parts(conditions, signs)
    point, steps = nonempty_or_not(state.current, signs, Resources(0))
    if point is not None:
        return Decision("no", point=_completed(point, conditions, signs))
    return _UNDECIDED if steps is None else Decision("yes", steps=(*state.backward, *steps))


def implies(conditions: Sequence[Scalar], other: Scalar, signs: Mapping[str, str]) -> Decision:
    """Decide whether the conditions, each > 0, imply other > 0; a no has a counterexample."""
    state, wanted = _in_parts(conditions, signs, split=True), _in_parts((other,), signs)
    found = [_follows(part, state.current, signs) for part in wanted.current]
    for decision in found:
        if decision.point is not None:
            return Decision("no", point=_completed(decision.point, (*conditions, other), signs))
    if any(decision.verdict != "yes" for decision in found):
        return _UNDECIDED
    steps = (*state.backward, *(step for decision in found for step in decision.steps), *wanted.forward)
    return Decision("yes", steps=steps)


def equivalence_of(raw: Sequence[Scalar], said: Sequence[Scalar], signs: Mapping[str, str]) -> Equivalence | None:
    """Return a proof that two lists of conditions are equivalent, None if none is found.

    Rational functions stand in it as numerator times denominator.
    """
    raw, said = tuple(map(cleared, raw)), tuple(map(cleared, said))
    forward = [implies(said, other, signs) for other in raw]
    backward = [implies(raw, other, signs) for other in said]
    if any(decision.verdict != "yes" for decision in (*forward, *backward)):
        return None
    there, back = (tuple(step for decision in found for step in decision.steps) for found in (forward, backward))
    return Equivalence(raw, said, there, back)


def _in_parts(values: Sequence[Scalar], signs: Mapping[str, str], *, split: bool = False) -> InequalitySystem:
    state = InequalitySystem(tuple(dict.fromkeys(map(cleared, values))))
    for value in state.current:
        state = split_into_factors(state, value, signs)
    return split_products(state, signs) if split else state


def _follows(part: Scalar, known: Sequence[Scalar], signs: Mapping[str, str]) -> Decision:
    point = failing_alone(part, known, signs)
    if point is not None:
        return Decision("no", point=point)
    steps = prove_value(part, known, signs)
    return _UNDECIDED if steps is None else Decision("yes", steps=steps)


def _completed(point: Point, values: Sequence[Scalar], signs: Mapping[str, str]) -> Point:
    """Return the point completed by values for names that do not occur."""
    missing = {name for name in names_of(values) if name not in point}
    usual = {name: Fraction(-1 if signs.get(name) in {"negative", "nonpositive"} else 1) for name in missing}
    return {**point, **usual}
