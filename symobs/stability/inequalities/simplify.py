"""Simplification of lists of conditions, each with a proof of equivalence.

Each polynomial is freed of factors of certain sign; an even power says that its factor is not 0, and stays as its
square.  A product whose factors have certain signs where the others are positive is split.  What the others imply is
dropped.  Only where each that is left has a point at which it alone fails is the list called irredundant.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import combinations, product
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar, product_of
from symobs.exact.algebraic.root_location import value_at
from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.proof import ZERO, Combined, Equivalence, ProvedByZ3, Step
from symobs.stability.inequalities.prover import (
    UNIT,
    by_signs,
    contradiction,
    from_contradiction,
    is_product,
    is_quotient,
    prove,
    prove_by_opposite,
    refute,
)
from symobs.stability.inequalities.sample_points import (
    Point,
    find_point,
    find_points,
    holds_at,
    point_where_zero,
    respects,
)
from symobs.stability.inequalities.z3_backend import Resources, names_of, point_by_z3
from symobs.system.conditions import FACTORED_UP_TO, sign_of, sign_where

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence


# Factorisation of the conditions of a list, with the proof steps in both directions.


def cleared(value: Scalar) -> Scalar:
    """Return a polynomial of the same sign as a rational function."""
    return value.numerator * value.denominator


@dataclass
class InequalitySystem:
    """A list of conditions, the steps from it to the original list, and the steps from the original list to it."""

    current: tuple[Scalar, ...]
    forward: tuple[Step, ...] = ()
    backward: tuple[Step, ...] = ()

    def replaced(
        self, old: Scalar, new: Sequence[Scalar], forward: Sequence[Step], backward: Sequence[Step] = ()
    ) -> InequalitySystem:
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
        """Return the other conditions."""
        return tuple(other for other in self.current if other != value)


def split_into_factors(state: InequalitySystem, value: Scalar, signs: Mapping[str, str]) -> InequalitySystem:
    """Replace a value by its factors of uncertain sign, without squares and factors that are never negative."""
    if sign_of(value, signs) == "positive":
        return state.replaced(value, (), (by_signs(value),))
    if value.is_constant or value.size > FACTORED_UP_TO:
        return state
    unit, factors = value.factors()
    odd, even, weak = Scalar.of(1 if sign_of(unit, {}) == "positive" else -1), list[Scalar](), list[Scalar]()
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
    forward.append(Combined(value, UNIT, ((certain, (*known, *above)),)))
    backward = [is_quotient(odd, value, (), value / odd)] if above else []
    backward += [is_quotient(part, value, above, value / odd / part) for part in [*even, *weak]]
    new = (*above, *even, *weak)
    return state if new == (value,) else state.replaced(value, new, forward, backward)


def _odd_factors(value: Scalar) -> tuple[Scalar, ...]:
    """Return the odd factors of a product; nothing for a square or a long polynomial."""
    if value.size > FACTORED_UP_TO:
        return ()
    factors = value.factors()[1]
    return tuple(factor for factor, _ in factors) if all(power == 1 for _, power in factors) else ()


def split_products(state: InequalitySystem, signs: Mapping[str, str], given: Sequence[Scalar] = ()) -> InequalitySystem:
    """Split products as long as the other conditions imply the sign of a factor."""
    waiting = _products(state, given)
    while waiting:
        split = _split_one(state, waiting.pop(), signs)
        if split is not None:
            state, waiting = split, _products(split, given)
    return state


def _products(state: InequalitySystem, given: Sequence[Scalar]) -> list[Scalar]:
    return [value for value in state.current if value not in given and len(_odd_factors(value)) > 1]


def _split_one(state: InequalitySystem, value: Scalar, signs: Mapping[str, str]) -> InequalitySystem | None:
    others, points = state.without(value), find_points(state.current, signs)
    either = [sign * factor for factor in _odd_factors(value) for sign in (1, -1)]
    oriented = [factor for factor in either if all(value_at(factor, point) > 0 for point in points)]
    for factor in oriented:
        lemma = prove(factor, others, signs)
        if lemma is not None:
            rest = value / factor
            forward = (*lemma, is_product(value, (factor, rest)))
            return state.replaced(value, (rest,), forward, (*lemma, is_quotient(rest, value, (factor,))))
    for factor in oriented:
        lemma = prove_by_opposite(factor, value, others, signs)
        if lemma is not None:
            rest = value / factor
            backward = (*lemma, is_quotient(rest, value, (factor,)))
            return state.replaced(value, (factor, rest), (is_product(value, (factor, rest)),), backward)
    return None


# Inequalities as they are printed: solved for a parameter, squares as inequations.


#: Coefficients and conditions of more terms are not held against each other.
_COMPARED_UP_TO = 12
#: A condition of more terms is not solved.
_SOLVED_UP_TO = 200


def as_inequality(
    positive: Scalar, signs: Mapping[str, str], parameters: Sequence[str] = (), beside: Sequence[Scalar] = ()
) -> tuple[Scalar, str, Scalar]:
    """Return value > 0 solved for a name: h₁ < 1, h₂ > −b, h₁ > (h₂² + 9)/(3 h₂), and a square as f ≠ 0.

    The name stands in it with a coefficient of certain sign, by the declared signs or where `beside` are positive.
    Parameters are preferred, then names of unknown sign, then a coefficient ±1.
    """
    root = root_of_square(positive)
    if root is not None:
        left, _, right = as_inequality(root, signs, parameters)
        return left, "!=", right
    found, short = [], [value for value in beside if value.size <= _COMPARED_UP_TO]
    for name in positive.names if positive.size <= _SOLVED_UP_TO else ():
        if positive.degree(name) != 1 or not positive.is_polynomial_in(name):
            continue
        lead = positive.coefficients(name)[0]
        sign = sign_where(lead, signs, short if lead.size <= _COMPARED_UP_TO else ())
        if sign in {"positive", "negative"}:
            rank = (name not in parameters, signs.get(name, "real") != "real", not (lead**2).is_one, lead.size, name)
            found.append((rank, sign))
    if not found:
        return positive, ">", Scalar.of(0)
    (*_, name), sign = min(found)
    lead, rest = positive.coefficients(name)
    return Scalar.symbol(name), ">" if sign == "positive" else "<", -rest / lead


def root_of_square(positive: Scalar) -> Scalar | None:
    """Return f of a square f², whose inequality is f ≠ 0."""
    if positive.size > FACTORED_UP_TO or positive.is_constant:
        return None
    unit, factors = positive.factors()
    if not unit.is_one or any(power != 2 for _, power in factors):
        return None
    return product_of(factor for factor, _ in factors)


Signs: TypeAlias = "Mapping[str, str]"
#: Values of more terms keep their order; to write them out would take longer than it is worth.
_TOLD_APART = 100
_DOWN = {"negative", "nonpositive", "zero"}


@dataclass
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
    """Return steps from the known values to value > 0; of a square, to its root, of either sign, or what it divides."""
    root = root_of_square(value)
    for each in known:
        cofactor = each / root if root is not None and each.size <= FACTORED_UP_TO else ZERO
        if not cofactor.is_zero and cofactor.denominator.is_constant:
            return (Combined(value, ((cofactor**2, ()),), ((Scalar.of(1), (each, each)),)),)
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
    found = find_point((*others, -value), signs, names=names) if root is None else point_where_zero(root, others, signs)
    return _point_at_an_end(value, others, signs) if found is None else found


#: Of more letters that may be 0 not all choices are looked at.
_ENDS = 4


def _point_at_an_end(value: Scalar, others: Sequence[Scalar], signs: Signs) -> Point | None:
    """Return a point where the others are positive and a value is not, at which letters are 0 whose signs end there."""
    ends = sorted(name for name in value.names if signs.get(name) in {"nonnegative", "nonpositive"})
    for count in range(1, len(ends) + 1) if len(ends) <= _ENDS else ():
        for chosen in combinations(ends, count):
            zeros = dict.fromkeys(chosen, ZERO)
            left = tuple(other.substitute(zeros) for other in others)
            if sign_of(value.substitute(zeros), signs) in _DOWN and not any(sign_of(v, signs) in _DOWN for v in left):
                names = sorted(names_of((value, *others)) - zeros.keys())
                point = find_point(tuple(v for v in left if not v.is_constant), signs, names=names)
                if point is not None:
                    return {**point, **dict.fromkeys(chosen, Fraction(0))}
    return None


def _asked(
    value: Scalar, others: Sequence[Scalar], signs: Signs, resources: Resources
) -> tuple[Point | None, tuple[Step, ...] | None]:
    """Return the answer of z3: a point, checked exactly, or the step that there is none."""
    answer, model = point_by_z3(others, signs, not_above=value, resources=resources)
    if answer == "no":
        return None, (ProvedByZ3(value, tuple(others)),)
    fails = bool(model) and respects(model, signs) and holds_at(others, model) and value_at(value, model) <= 0
    return (dict(model) if fails else None), None


# Conditions as bounds of the parameters: h₁ < 1, h₂ > −b, and their box if they are uncoupled.


#: A longer condition is left as it is where its coefficients have no sign of their own.
_HELPED_UP_TO = 60


def solved(
    positive: Sequence[Scalar],
    signs: Mapping[str, str],
    parameters: Sequence[str] = (),
    beside: Sequence[Scalar] = (),
) -> list[tuple[Scalar, str, Scalar]]:
    """Return each condition > 0 as (left, operator, right), solved for a parameter if it is linear in one.

    Its coefficient has a certain sign by the declared signs, or where `beside` and the other conditions are positive.
    """
    found = {value: as_inequality(value, signs, parameters) for value in positive}
    wanted = [value for value in positive if not _is_solved(found[value], signs, parameters)]
    plain = list(positive)  # what is said without the help of a condition that is itself said with help
    for value in wanted:
        others = [*beside, *(other for other in plain if other != value)]
        helped = _with_help(value, signs, parameters, others)
        if helped is not None:
            found[value] = helped
            plain.remove(value)
    return [found[value] for value in positive]


def _is_solved(relation: tuple[Scalar, str, Scalar], signs: Mapping[str, str], parameters: Sequence[str]) -> bool:
    name = str(relation[0])
    return relation[1] == "!=" or name in parameters or (not parameters and name in relation[0].names - set(signs))


def _with_help(
    value: Scalar, signs: Mapping[str, str], parameters: Sequence[str], others: Sequence[Scalar]
) -> tuple[Scalar, str, Scalar] | None:
    if value.size > _HELPED_UP_TO:
        return None
    relation = as_inequality(value, signs, parameters, others)
    if _is_solved(relation, signs, parameters):
        return relation
    for name in sorted(value.names.intersection(parameters) or value.names - set(signs)):
        if value.degree(name) == 1:
            lead, rest = value.coefficients(name)
            for sign, operator in ((1, ">"), (-1, "<")):
                if prove(sign * lead, others, signs) is not None:
                    return Scalar.symbol(name), operator, -rest / lead
    return None


@dataclass
class IntervalBox:
    """A product of open intervals: a parameter lies above all its `lower` and below all its `upper` bounds.

    It is convex, so in one piece, and not empty exactly where all of `needs` are > 0; `sample` is a point of it, None
    where none was proven to be one.
    """

    lower: Mapping[str, tuple[Scalar, ...]]
    upper: Mapping[str, tuple[Scalar, ...]]
    needs: tuple[Scalar, ...]
    sample: Mapping[str, Scalar] | None

    @property
    def bounded(self) -> bool:
        """Whether every parameter has bounds on both sides."""
        return all(self.lower[name] and self.upper[name] for name in self.lower)


def box(conditions: Sequence[Scalar], parameters: Sequence[str], signs: Mapping[str, str]) -> IntervalBox | None:
    """Return the box of the conditions > 0, None if one of them is nonlinear or couples parameters."""
    lower: dict[str, list[Scalar]] = {name: [] for name in parameters}
    upper: dict[str, list[Scalar]] = {name: [] for name in parameters}
    needs = []
    for value in conditions:
        inside = [name for name in parameters if name in value.names]
        if not inside:
            needs.append(value)
            continue
        (name, *others) = inside
        bound = None if others else _bound(value, name, signs)
        if bound is None:
            return None
        (lower if bound[0] == ">" else upper)[name].append(bound[1])
    for name in parameters:
        lower[name] += [ZERO] * (signs.get(name) == "positive")
        upper[name] += [ZERO] * (signs.get(name) == "negative")
        if signs.get(name, "real") not in {"positive", "negative", "real"}:
            return None
        needs += [high - low for low, high in product(lower[name], upper[name])]
    open_ = tuple(dict.fromkeys(value for value in needs if sign_of(value, signs) != "positive"))
    found = {name: _between(lower[name], upper[name], signs) for name in parameters}
    sample = {name: value for name, value in found.items() if value is not None}
    proven = len(sample) == len(found) and all(_holds(value, sample, open_, signs) for value in conditions)
    below, above = ({name: tuple(dict.fromkeys(v)) for name, v in side.items()} for side in (lower, upper))
    return IntervalBox(below, above, open_, sample if proven else None)


def _bound(value: Scalar, name: str, signs: Mapping[str, str]) -> tuple[str, Scalar] | None:
    if value.degree(name) != 1 or not value.is_polynomial_in(name):
        return None
    lead, rest = value.coefficients(name)
    operator = {"positive": ">", "negative": "<"}.get(sign_of(lead, signs))
    return None if operator is None else (operator, -rest / lead)


def _between(lower: Sequence[Scalar], upper: Sequence[Scalar], signs: Mapping[str, str]) -> Scalar | None:
    """Return a value above all lower and below all upper bounds, if the signs order them."""
    below, above = _greatest(lower, signs), _greatest([-value for value in upper], signs)
    if (lower and below is None) or (upper and above is None):
        return None
    if below is not None and above is not None:
        return (below - above) / 2
    if below is not None:
        return ZERO if sign_of(-below, signs) == "positive" else below + 1
    if above is not None:
        return ZERO if sign_of(-above, signs) == "positive" else -above - 1
    return ZERO


def _greatest(values: Sequence[Scalar], signs: Mapping[str, str]) -> Scalar | None:
    weak = {"positive", "nonnegative", "zero"}
    return next((v for v in values if all(sign_of(v - other, signs) in weak for other in values)), None)


def _holds(value: Scalar, sample: Mapping[str, Scalar], needs: Sequence[Scalar], signs: Mapping[str, str]) -> bool:
    """Return whether a condition holds at a symbolic point where the needs are positive."""
    there = value.substitute(sample)
    return sign_of(there, signs) == "positive" or any(sign_of(there / need, signs) == "positive" for need in needs)
