"""Lists of polynomials that must be positive, made short: every list returned is equivalent, with a proof.

Each polynomial is freed of factors of certain sign; an even power says that its factor is not 0, and stays as its
square.  A product whose factors have certain signs where the others are positive is split.  What the others imply is
dropped.  Only where each that is left has a point at which it alone fails is the list called irredundant.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from time import monotonic
from typing import TYPE_CHECKING, TypeAlias

from symobs.conditions import FACTORED_UP_TO, never_zero, sign_of
from symobs.exact import Scalar, product_of
from symobs.region.external import QUESTION, point_by_z3
from symobs.region.points import Point, find_point, find_points, holds_at, point_where_zero, respects, value_at
from symobs.region.proof import (
    ZERO,
    Asked,
    Combined,
    Equivalence,
    Step,
    by_signs,
    contradiction,
    from_contradiction,
    is_product,
    is_quotient,
)
from symobs.region.prover import prove, prove_by_opposite, refute
from symobs.stability import root_of_square

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

Signs: TypeAlias = "Mapping[str, str]"

#: Seconds that all questions to z3 about one list may take together.
TOGETHER = 6.0
_DOWN = {"negative", "nonpositive", "zero"}


@dataclass(frozen=True, slots=True)
class Simplified:
    """An equivalent list.

    `positive` must be > 0, where f² stands for f ≠ 0; (0,) means nowhere.  `point` is one where all are positive, and
    `witnesses` are points at which one of them fails and the others hold.
    """

    positive: tuple[Scalar, ...]
    equivalence: Equivalence
    point: Point | None = None
    witnesses: tuple[tuple[Scalar, Point], ...] = ()

    @property
    def verdict(self) -> str:
        """`yes` where nothing is left to ask, `no` where all cannot be positive together, else `conditional`."""
        if not self.positive:
            return "yes"
        return "no" if self.positive == (ZERO,) else "conditional"

    @property
    def irredundant(self) -> bool:
        """Whether it is proven that none of the list can be left out."""
        return {value for value, _ in self.witnesses} == set(self.positive) or self.verdict == "no"

    @property
    def is_settled(self) -> bool:
        """Whether neither emptiness nor redundance is open."""
        return self.verdict != "conditional" or (self.irredundant and self.point is not None)


def simplify(raw: Sequence[Scalar], signs: Signs, *, ask: bool = True) -> Simplified:
    """Return a short list equivalent to all of `raw` > 0; with `ask`, z3 is asked about what stays open.

    A rational function is taken as numerator times denominator.
    """
    cleared = tuple(dict.fromkeys(value.numerator * value.denominator for value in raw))
    state = _State(cleared)
    for value in cleared:
        if sign_of(value, signs) in _DOWN:
            return _nowhere(cleared, (contradiction(value),))
        state = _in_parts(state, value, signs)
    until = monotonic() + TOGETHER if ask else 0.0
    point, impossible = nonempty_or_not(state.current, signs, until)
    if impossible is not None:
        return _nowhere(cleared, (*state.backward, *impossible))
    state = _split(state, signs)
    state, witnesses = _without_implied(state, signs, until)
    equivalence = Equivalence(cleared, state.current, state.forward, state.backward)
    return Simplified(state.current, equivalence, point, witnesses)


@dataclass(frozen=True, slots=True)
class _State:
    """The list as it stands, the steps from it to the first one, and the steps from the first one to it."""

    current: tuple[Scalar, ...]
    forward: tuple[Step, ...] = ()
    backward: tuple[Step, ...] = ()

    def with_(
        self, old: Scalar, new: Sequence[Scalar], forward: Sequence[Step], backward: Sequence[Step] = ()
    ) -> _State:
        """Replace one value: `forward` leads back to it from the new list, `backward` from it to the new values."""
        place = self.current.index(old)
        current = dict.fromkeys((*self.current[:place], *new, *self.current[place + 1 :]))
        return replace(
            self,
            current=tuple(current),
            forward=(*forward, *self.forward),
            backward=(*self.backward, *backward),
        )

    def without(self, value: Scalar) -> tuple[Scalar, ...]:
        """Return the others."""
        return tuple(other for other in self.current if other != value)


def _nowhere(raw: tuple[Scalar, ...], steps: Sequence[Step]) -> Simplified:
    forward = tuple(from_contradiction(value) for value in raw)
    return Simplified((ZERO,), Equivalence(raw, (ZERO,), forward, tuple(steps)))


def nonempty_or_not(
    positive: Sequence[Scalar], signs: Signs, until: float
) -> tuple[Point | None, tuple[Step, ...] | None]:
    """Return a point where all are positive, or the steps to a contradiction, or neither; z3 is asked before `until`."""
    point = find_point(positive, signs)
    if point is not None:
        return point, None
    steps = refute(positive, signs)
    if steps is not None or monotonic() >= until:
        return None, steps
    answer, model = point_by_z3(positive, signs, milliseconds=_left(until))
    if answer == "no":
        return None, (Asked(ZERO, tuple(positive)),)
    good = bool(model) and respects(model, signs) and holds_at(positive, model)
    return (dict(model) if good else None), None


def _left(until: float) -> int:
    return max(1, min(QUESTION, int(1000 * (until - monotonic()))))


# -- factors ---------------------------------------------------------------------------------------------------------


def _in_parts(state: _State, value: Scalar, signs: Signs) -> _State:
    """Replace a value by what of it is open: a product of odd powers, squares, and factors that are never negative."""
    if sign_of(value, signs) == "positive":
        return state.with_(value, (), (by_signs(value),))
    if value.size > FACTORED_UP_TO:
        return state
    unit, factors = value.factors()
    odd, even, weak = Scalar.of(1 if unit.fraction() > 0 else -1), list[Scalar](), list[Scalar]()
    forward, known = list[Step](), list[Scalar]()
    for factor, power in factors:
        sign = sign_of(factor, signs)
        if sign in {"negative", "nonpositive"} and power % 2:
            odd = -odd
        if sign in {"positive", "negative"} or (power % 2 == 0 and sign == "nonzero"):
            continue
        if sign in {"nonnegative", "nonpositive"}:
            weak.append(factor if sign == "nonnegative" else -factor)
            known += [weak[-1]] * power
        elif power % 2:
            odd = odd * factor
            known += [factor**2] * (power // 2)
        else:
            even.append(factor**2)
            known += [factor**2] * (power // 2)
    for square in {factor for factor in known if factor not in even and factor not in weak}:
        rest = odd * odd / square
        forward.append(Combined(square, ((rest, ()),), ((Scalar.of(1), (odd, odd)),)))
    above = () if odd.is_one else (odd,)
    certain = value / product_of([*known, *above])
    forward.append(Combined(value, ((Scalar.of(1), ()),), ((certain, (*known, *above)),)))
    backward = [is_quotient(odd, value, (), value / odd)] if above else []
    backward += [is_quotient(part, value, above, value / odd / part) for part in [*even, *weak]]
    new = (*above, *even, *weak)
    return state if new == (value,) else state.with_(value, new, forward, backward)


def _odd_factors(value: Scalar) -> tuple[Scalar, ...]:
    """Return the factors of a product without squares; nothing of a square and of a long polynomial."""
    if value.size > FACTORED_UP_TO:
        return ()
    factors = value.factors()[1]
    return tuple(factor for factor, _ in factors) if all(power == 1 for _, power in factors) else ()


def _split(state: _State, signs: Signs) -> _State:
    """Split products as long as the others settle the sign of a factor."""
    waiting = [value for value in state.current if len(_odd_factors(value)) > 1]
    while waiting:
        value = waiting.pop()
        split = _split_one(state, value, signs)
        if split is not None:
            state = split
            waiting = [value for value in state.current if len(_odd_factors(value)) > 1]
    return state


def _split_one(state: _State, value: Scalar, signs: Signs) -> _State | None:
    others, points = state.without(value), find_points(state.current, signs)
    either = [sign * factor for factor in _odd_factors(value) for sign in (1, -1)]
    oriented = [factor for factor in either if all(value_at(factor, point) > 0 for point in points)]
    for factor in oriented:
        lemma = prove(factor, others, signs)
        if lemma is not None:
            rest = value / factor
            forward = (*lemma, is_product(value, (factor, rest)))
            return state.with_(value, (rest,), forward, (*lemma, is_quotient(rest, value, (factor,))))
    for factor in oriented:
        lemma = prove_by_opposite(factor, value, others, signs)
        if lemma is not None:
            rest = value / factor
            backward = (*lemma, is_quotient(rest, value, (factor,)))
            return state.with_(value, (factor, rest), (is_product(value, (factor, rest)),), backward)
    return None


# -- what is implied ---------------------------------------------------------------------------------------------------


def _without_implied(state: _State, signs: Signs, until: float) -> tuple[_State, tuple[tuple[Scalar, Point], ...]]:
    """Drop what the others imply, the longest first; return the points which show that the rest is needed."""
    witnesses = []
    for value in sorted(state.current, key=lambda v: (-v.degrees()[0], -v.size, str(v) if v.size < 100 else "")):
        others = state.without(value)
        point = _failing_alone(value, others, signs)
        steps = prove_value(value, others, signs) if point is None else None
        if point is None and steps is None and monotonic() < until:
            point, steps = _asked(value, others, signs, until)
        if steps is not None:
            state = state.with_(value, (), steps)
        elif point is not None:
            witnesses.append((value, point))
    return state, tuple(witnesses)


def prove_value(value: Scalar, known: Sequence[Scalar], signs: Signs) -> tuple[Step, ...] | None:
    """Return steps from the known values to value > 0; of a square, to its root, of either sign."""
    root = root_of_square(value)
    for goal in (value,) if root is None else (root, -root):
        steps = prove(goal, known, signs)
        if steps is not None:
            return steps if root is None else (*steps, is_product(value, (goal, goal)))
    return None


def _failing_alone(value: Scalar, others: Sequence[Scalar], signs: Signs) -> Point | None:
    names = sorted(value.names)
    root = root_of_square(value)
    if root is None:
        return find_point((*others, -value), signs, names=names)
    return point_where_zero(root, others, signs)


def _asked(
    value: Scalar, others: Sequence[Scalar], signs: Signs, until: float
) -> tuple[Point | None, tuple[Step, ...] | None]:
    answer, model = point_by_z3(others, signs, not_above=value, milliseconds=_left(until))
    if answer == "no":
        return None, (Asked(value, tuple(others)),)
    fails = bool(model) and respects(model, signs) and holds_at(others, model) and value_at(value, model) <= 0
    return (dict(model) if fails else None), None


def is_needed(value: Scalar, others: Sequence[Scalar], point: Point, signs: Signs) -> bool:
    """Tell whether a point shows that a value does not follow from others (trusted)."""
    return respects(point, signs) and holds_at(others, point) and value_at(value, point) <= 0
