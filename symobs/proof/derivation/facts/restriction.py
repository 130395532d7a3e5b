"""Restriction of an environment to a stratum, its substitution verified first (trusted)."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from symobs.exact import Ideal, Scalar, apart_from_zero
from symobs.exact.core.generators import substitute
from symobs.formula.tree import Conjunction, Environment, Exact, Relation, evaluate
from symobs.formula.tree.plain_text import plain_relation
from symobs.proof.certificate.claims import as_scalar, verify
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.proof.derivation.facts.rejection import reject
from symobs.system.conditions import never_zero, vanishing_factors

if TYPE_CHECKING:
    from collections.abc import Mapping


def on_stratum(when: Relation | Conjunction, substitution: dict[str, Scalar], environment: Environment) -> Environment:
    """Return the environment on a stratum, after verifying that the substitution describes it.

    Without a substitution the single equation itself is what is known inside: that a polynomial of the parameters
    vanishes, or that λ is an eigenvalue.  Otherwise a single `when` has one factor that can vanish, linear in the one
    name put in: another equation would hold elsewhere too.  Of several equations and inequations it is verified that
    each value put in follows from them.
    """
    if not substitution and isinstance(when, Relation) and when.operators in {("<",), (">",), ("!=",)}:
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
        if when.operators == ("!=",):
            return environment  # it narrows, and nothing is put in: all stays true
        return _where_positive(left - right if when.operators == (">",) else right - left, environment)
    if not substitution and isinstance(when, Relation) and when.operators == ("=",):
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
        inside = replace(environment, relations=(*environment.relations, left - right), nonzero=())
        return (
            inside if not Ideal.where(inside.relations).is_whole else reject(plain_relation(when, environment.variable))
        )
    named, lost = dict(substitution), set[str]()
    for name, value in environment.coefficients.items():
        try:
            named[name] = _there(value, substitution, lost)
        except ZeroDivisionError:
            lost.add(name)
    replaced = {}
    for name, known in environment.values.items():
        with suppress(ZeroDivisionError):  # the letter means nothing on this stratum
            replaced[name] = _there(known, substitution, lost)
    positive = _known_there(environment.positive, substitution)
    relations = tuple(value.numerator for value in _known_there(environment.relations, substitution) if value)
    domain = vanishing_factors(_known_there(environment.domain, substitution), environment.signs)
    inside = replace(
        environment,
        values=replaced,
        coefficients=named,
        nonzero=(),
        domain=domain,
        positive=positive,
        relations=relations,
    )
    if isinstance(when, Conjunction):
        return inside.with_relations(_left_of(when, substitution, environment))
    left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
    factors = [f for f, _ in (left - right).numerator.factors()[1] if not never_zero(f, environment.signs)]
    says_no_more = [f.degree(name) for f in factors for name in substitution] == [1] and when.operators == ("=",)
    if not says_no_more or verify(when, inside)[0] == "":
        reject(plain_relation(when, environment.variable))
    return inside


def _where_positive(value: Scalar, environment: Environment) -> Environment:
    """Return the environment where a value is positive: of a symbol, or of minus a symbol, it is a sign."""
    told = (("positive", value), ("negative", -value))
    signs = {str(symbol): sign for sign, symbol in told if str(symbol) in symbol.names}
    return replace(environment, positive=(*environment.positive, value), signs={**environment.signs, **signs})


def _there(value: Any, substitution: Mapping[str, Scalar], lost: set[str]) -> Any:
    """Return a value on a stratum; raises ZeroDivisionError where it has none, or rests on what has none."""
    if lost.intersection(value.names):
        raise ZeroDivisionError
    return substitute(value, substitution)


def _known_there(values: tuple[Scalar, ...], substitution: Mapping[str, Scalar]) -> tuple[Scalar, ...]:
    """Return values on a stratum, without those that mean nothing there: of these nothing is known any more."""
    found = []
    for value in values:
        with suppress(ZeroDivisionError):
            found.append(substitute(value, substitution))
    return tuple(found)


def _left_of(when: Conjunction, substitution: dict[str, Scalar], environment: Environment) -> tuple[Scalar, ...]:
    """Return what of the equations (1 − w p = 0 for an inequation of p) is left when parameters are put in.

    What is said of the stratum is held to them, and so to each of its points.
    """
    equations: list[Scalar] = []
    excluded: list[Scalar] = []
    for relation in when.relations:
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in relation.members)
        if relation.operators == ("=",):
            equations.append((left - right).numerator)
        elif relation.operators == ("!=",):
            excluded.append(left - right)
        else:
            reject(plain_relation(relation, environment.variable))
    relations = [apart_from_zero(value) for value in excluded]
    known = Ideal.where((*equations, *relations, *environment.relations))
    if known.is_whole or never_together_zero(equations, (*relations, *environment.relations), environment.signs):
        reject(f"that {' and '.join(plain_relation(r, environment.variable) for r in when.relations)} can be")
    for name, value in substitution.items():
        rest = Scalar.symbol(name) * value.denominator - value.numerator
        solved = rest in known or never_together_zero(
            equations, (apart_from_zero(rest), *relations, *environment.relations), environment.signs
        )
        if not solved or not never_together_zero([value.denominator], (*equations, *relations), environment.signs):
            reject(f"{name} = {value}")
    left_over = [equation.substitute(substitution).numerator for equation in equations]
    return (*(value for value in left_over if value), *(apart_from_zero(v.substitute(substitution)) for v in excluded))
