"""Cases by the sign of a coefficient: a h₁ > 1 means h₁ > 1/a for a > 0, h₁ < 1/a for a < 0, and nothing for a = 0."""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING

from symobs.ground.dataclass import dataclass
from symobs.stability.inequalities.decision import decide_empty
from symobs.stability.inequalities.simplify import Simplified, simplify
from symobs.system.conditions import sign_of, sign_where

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact import Scalar

#: How many expressions have their sign split.
_DEEPEST = 3


@dataclass(frozen=True)
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
