"""Decisions on conjunctions of inequalities: emptiness, implication, equivalence.

In turn: a rational point, tried exactly; a proof by products.  Where neither is found the answer is `undecided`.
"""

from __future__ import annotations

from dataclasses import field
from fractions import Fraction
from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.proof import Equivalence, Step
from symobs.stability.inequalities.simplify import (
    InequalitySystem,
    Simplified,
    cleared,
    failing_alone,
    nonempty_or_not,
    prove_value,
    simplify,
    split_into_factors,
    split_products,
)
from symobs.stability.inequalities.z3_backend import Resources, names_of
from symobs.system.conditions import sign_of, sign_where

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar
    from symobs.stability.inequalities.sample_points import Point


@dataclass
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


# Cases by the sign of a coefficient: a h₁ > 1 means h₁ > 1/a for a > 0, h₁ < 1/a for a < 0, and nothing for a = 0.


#: How many expressions have their sign split.
_DEEPEST = 3


@dataclass
class SignCase:
    """The conditions where some expressions without parameters have certain signs.

    `when` holds (expression, operator, 0), `signs` what is declared there, `substitution` what the equations put in
    place of a symbol, and `assumed` the expressions > 0 that are no symbols.
    """

    when: tuple[tuple[Scalar, str], ...]
    signs: Mapping[str, str]
    conditions: Simplified
    substitution: Mapping[str, Scalar] = field(default_factory=dict)
    assumed: tuple[Scalar, ...] = ()


def sign_cases(
    conditions: Sequence[Scalar], parameters: Sequence[str], signs: Mapping[str, str], *, ask: bool = True
) -> list[SignCase]:
    """Return the cases in which each coefficient of a linear parameter has a certain sign.

    One case without `when` where they have one already; at most three expressions are split one after the other.
    """
    start = SignCase((), dict(signs), simplify(conditions, signs, ask=ask))
    return _cases(start, parameters, _DEEPEST, ask=ask)


def _cases(case: SignCase, parameters: Sequence[str], depth: int, *, ask: bool) -> list[SignCase]:
    expression = _uncertain(case, parameters) if depth else None
    if expression is None:
        return [case]
    inside = [_where(case, expression, operator, ask=ask) for operator in _possible(expression, case.signs)]
    possible = [one for one in inside if decide_empty(one.assumed, one.signs).verdict != "yes"]
    return [found for one in possible for found in _cases(one, parameters, depth - 1, ask=ask)]


def _uncertain(case: SignCase, parameters: Sequence[str]) -> Scalar | None:
    """Return the simplest factor of uncertain sign of a coefficient without parameters."""
    found = []
    for value in case.conditions.positive:
        for name in parameters:
            if value.degree(name) != 1:
                continue
            lead = value.coefficients(name)[0]
            if lead.names.isdisjoint(parameters):
                found += [factor for factor, power in lead.factors()[1] if power % 2]
    certain = {"positive", "negative"}
    open_ = [f for f in found if sign_where(f, case.signs, case.assumed) not in certain]
    split = {expression for expression, _ in case.when}
    return min((f for f in open_ if f not in split), key=lambda f: (f.size, str(f)), default=None)


def _possible(expression: Scalar, signs: Mapping[str, str]) -> tuple[str, ...]:
    sign = sign_of(expression, signs)
    excluded = {"nonnegative": "<", "nonpositive": ">", "nonzero": "="}.get(sign)
    return tuple(operator for operator in (">", "<", "=") if operator != excluded)


def _where(case: SignCase, expression: Scalar, operator: str, *, ask: bool) -> SignCase:
    """Return the case with one more sign: declared of a symbol, else substituted, else assumed."""
    when = (*case.when, (expression, operator + "=" * (operator == "=")))
    signs, put, assumed = dict(case.signs), dict(case.substitution), case.assumed
    conditions = case.conditions.positive
    name = str(expression)
    if operator == "=":
        new, besides = _put(expression, signs)
        conditions, assumed = (tuple(v.substitute(new) for v in values) for values in (conditions, assumed))
        put = {**{n: value.substitute(new) for n, value in put.items()}, **new}
        assumed = (*assumed, *(v for v in besides if sign_of(v, signs) != "positive"))
    elif name in expression.names:
        signs[name] = "positive" if operator == ">" else "negative"
    else:
        assumed = (*assumed, expression if operator == ">" else -expression)
    return SignCase(when, signs, simplify(conditions, signs, beside=assumed, ask=ask), put, assumed)


def _put(expression: Scalar, signs: Mapping[str, str]) -> tuple[dict[str, Scalar], tuple[Scalar, ...]]:
    """Return the solution of an expression = 0 for one symbol, and the inequality of its declared sign.

    One whose coefficient is constant, of unknown sign if there is one; none where no symbol will do.
    """
    for name in sorted(expression.names, key=lambda n: (signs.get(n, "real") != "real", n)):
        sign = signs.get(name, "real")
        if expression.degree(name) == 1 and (sign in {"real", "positive", "negative"} or str(expression) == name):
            lead, rest = expression.coefficients(name)
            if lead.is_constant:
                value = -rest / lead
                return {name: value}, {"positive": (value,), "negative": (-value,)}.get(sign, ())
    return {}, ()
