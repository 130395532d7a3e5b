"""Simplification of lists of conditions, each with a proof of equivalence.

Each polynomial is freed of factors of certain sign; an even power says that its factor is not 0, and stays as its
square.  A product whose factors have certain signs where the others are positive is split.  What the others imply is
dropped.  Only where each that is left has a point at which it alone fails is the list called irredundant.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar
from symobs.exact.algebraic.rational_points import value_at
from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.factors import InequalitySystem, cleared, split_into_factors, split_products
from symobs.stability.inequalities.proof import ZERO, Equivalence, ProvedByZ3, Step
from symobs.stability.inequalities.proof_steps import contradiction, from_contradiction, is_product
from symobs.stability.inequalities.prover import prove, refute
from symobs.stability.inequalities.sample_points import (
    Point,
    find_point,
    holds_at,
    point_where_zero,
    respects,
)
from symobs.stability.inequalities.written_form import root_of_square
from symobs.stability.inequalities.z3_backend import Resources, point_by_z3
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

Signs: TypeAlias = "Mapping[str, str]"

#: Values of more terms keep their order; to write them out would take longer than it is worth.
_TOLD_APART = 100
_DOWN = {"negative", "nonpositive", "zero"}


@dataclass(frozen=True)
class Simplified:
    """An equivalent list.

    `positive` must be > 0, where f² stands for f ≠ 0; (0,) means nowhere.  `point` is one where all are positive, and
    `witnesses` are points at which one of them fails and the others hold.  `dropped` follow from the rest, by
    `products` or by `z3`.  What was given beside is in both lists of the equivalence.
    """

    positive: tuple[Scalar, ...]
    equivalence: Equivalence
    point: Point | None = None
    witnesses: tuple[tuple[Scalar, Point], ...] = ()
    dropped: tuple[tuple[Scalar, str], ...] = ()

    @property
    def verdict(self) -> str:
        """`yes` if no condition is left, `no` if they are contradictory, else `conditional`."""
        if not self.positive:
            return "yes"
        return "no" if self.positive == (ZERO,) else "conditional"

    @property
    def irredundant(self) -> bool:
        """Whether the list is proved irredundant."""
        return {value for value, _ in self.witnesses} == set(self.positive) or self.verdict == "no"

    @property
    def is_settled(self) -> bool:
        """Whether emptiness and redundancy are decided."""
        return self.verdict != "conditional" or (self.irredundant and self.point is not None)


def simplify(raw: Sequence[Scalar], signs: Signs, *, beside: Sequence[Scalar] = (), ask: bool = True) -> Simplified:
    """Return a short list equivalent to all of `raw` > 0 given all of `beside` > 0; with `ask` also by z3.

    A rational function is taken as numerator times denominator.
    """
    given, asked_of = (tuple(dict.fromkeys(map(cleared, values))) for values in (beside, raw))
    polynomials = tuple(dict.fromkeys((*asked_of, *given)))
    state = InequalitySystem(polynomials)
    for value in polynomials:
        if sign_of(value, signs) in _DOWN:
            return _nowhere(polynomials, (contradiction(value),))
        if value not in given:
            state = split_into_factors(state, value, signs)
    resources = Resources() if ask else Resources(0)
    point, impossible = nonempty_or_not(state.current, signs, resources)
    if impossible is not None:
        return _nowhere(polynomials, (*state.backward, *impossible))
    state = split_products(state, signs, given)
    state, witnesses, dropped = _without_implied(state, signs, given, resources)
    equivalence = Equivalence(polynomials, state.current, state.forward, state.backward)
    return Simplified(tuple(v for v in state.current if v not in given), equivalence, point, witnesses, dropped)


def _nowhere(raw: tuple[Scalar, ...], steps: Sequence[Step]) -> Simplified:
    forward = tuple(from_contradiction(value) for value in raw)
    return Simplified((ZERO,), Equivalence(raw, (ZERO,), forward, tuple(steps)))


def nonempty_or_not(
    positive: Sequence[Scalar], signs: Signs, resources: Resources
) -> tuple[Point | None, tuple[Step, ...] | None]:
    """Return a point where all are positive, or the steps to a contradiction, or neither; z3 spends resources."""
    point = find_point(positive, signs)
    if point is not None:
        return point, None
    steps = refute(positive, signs)
    if steps is not None:
        return None, steps
    answer, model = point_by_z3(positive, signs, resources=resources)
    if answer == "no":
        return None, (ProvedByZ3(ZERO, tuple(positive)),)
    good = bool(model) and respects(model, signs) and holds_at(positive, model)
    return (dict(model) if good else None), None


# -- what is implied ---------------------------------------------------------------------------------------------------


def _without_implied(
    state: InequalitySystem, signs: Signs, given: Sequence[Scalar], resources: Resources
) -> tuple[InequalitySystem, tuple[tuple[Scalar, Point], ...], tuple[tuple[Scalar, str], ...]]:
    """Drop implied conditions, the longest first; return points that prove the others necessary too."""
    witnesses, dropped = list[tuple[Scalar, Point]](), list[tuple[Scalar, str]]()
    open_ = (value for value in state.current if value not in given)
    for value in sorted(open_, key=lambda v: (-v.degrees()[0], -v.size, str(v) if v.size < _TOLD_APART else "")):
        others = state.without(value)
        point = failing_alone(value, others, signs)
        steps = prove_value(value, others, signs) if point is None else None
        if point is None and steps is None:
            point, steps = _asked(value, others, signs, resources)
        if steps is not None:
            state = state.replaced(value, (), steps)
            dropped.append((value, "z3" if any(isinstance(step, ProvedByZ3) for step in steps) else "products"))
        elif point is not None:
            witnesses.append((value, point))
    return state, tuple(witnesses), tuple(dropped)


def prove_value(value: Scalar, known: Sequence[Scalar], signs: Signs) -> tuple[Step, ...] | None:
    """Return steps from the known values to value > 0; of a square, to its root, of either sign."""
    root = root_of_square(value)
    for goal in (value,) if root is None else (root, -root):
        steps = prove(goal, known, signs)
        if steps is not None:
            return steps if root is None else (*steps, is_product(value, (goal, goal)))
    return None


def failing_alone(value: Scalar, others: Sequence[Scalar], signs: Signs) -> Point | None:
    """Return a rational point where the others are positive and a value is not, None if none was found."""
    names = sorted(value.names)
    if sign_of(value, signs) in _DOWN:
        return find_point(others, signs, names=names)
    root = root_of_square(value)
    if root is None:
        return find_point((*others, -value), signs, names=names)
    return point_where_zero(root, others, signs)


def _asked(
    value: Scalar, others: Sequence[Scalar], signs: Signs, resources: Resources
) -> tuple[Point | None, tuple[Step, ...] | None]:
    """Return the answer of z3: a point, checked exactly, or the step that there is none."""
    answer, model = point_by_z3(others, signs, not_above=value, resources=resources)
    if answer == "no":
        return None, (ProvedByZ3(value, tuple(others)),)
    fails = bool(model) and respects(model, signs) and holds_at(others, model) and value_at(value, model) <= 0
    return (dict(model) if fails else None), None
