"""Facts a derivation may state besides equations: properties of matrices, rejected alternatives, restricted parameters."""

from __future__ import annotations

from contextlib import suppress
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NoReturn

from symobs.exact import Ideal, Matrix, Scalar, TooLarge, apart_from_zero, from_coefficients, remainder
from symobs.exact.algebraic.polynomial_roots import polynomial_of_roots
from symobs.exact.core.generators import all_roots, function_named, identities, stands_inside, substitute, symbols_named
from symobs.formula.tree import Conjunction, Environment, Exact, Relation, evaluate
from symobs.formula.tree.plain_text import plain_relation
from symobs.ground.errors import DerivationRejected, WrongKind
from symobs.proof.certificate.claims import as_scalar, verify
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.stability.criteria.stability import is_beyond, is_marginal, marginal_where, no_stable_compensator, stability
from symobs.system.conditions import never_zero, sign_of, vanishing_factors

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from symobs.exact import Root
    from symobs.formula.tree import HoldsExactlyWhere


# Properties that no equation states: stable, strictly proper, never zero (trusted).


def polynomial_of(value: Scalar, environment: Environment) -> Scalar:
    """Return a polynomial, and what is one where the relations hold, and of another rational function the denominator."""
    found = _divided(value, environment)
    return _lowered(found[0] if found is not None and found[1].is_zero else value.denominator, environment)


def _lowered(polynomial: Scalar, environment: Environment) -> Scalar:
    """Return a polynomial with the coefficients that it has where the relations hold, without those that vanish there.

    Raises `TooLarge` where that is not known of the first, and so not the degree.
    """
    coefficients = polynomial.coefficients(environment.variable)
    if not environment.relations:
        return polynomial
    try:
        ideal = Ideal.where(environment.relations)
        vanishing = (c.numerator in ideal and c.denominator not in ideal for c in coefficients)
        kept = [Scalar.of(0) if zero else _shorter(c, ideal) for c, zero in zip(coefficients, vanishing, strict=True)]
    except TooLarge:
        if not coefficients[0].is_constant:
            raise
        return polynomial
    return from_coefficients(kept, environment.variable) if any(kept) else polynomial


def _shorter(value: Scalar, ideal: Ideal) -> Scalar:
    """Return a value as the relations shorten it, not by square roots that it has not."""
    found = ideal.simplified(value)
    return value if all_roots(found) - all_roots(value) else found


def _divided(value: Scalar, environment: Environment) -> tuple[Scalar, Scalar] | None:
    """Return quotient and remainder of numerator and denominator where the relations hold; None if that is not known."""
    variable = environment.variable
    if value.is_polynomial_in(variable):
        return value, Scalar.of(0)
    if not environment.relations:
        return value, Scalar.of(1)  # in lowest terms a fraction stays one
    try:
        ideal = Ideal.where(environment.relations)
        if value.denominator.coefficients(variable)[0].numerator in ideal:
            return None
        quotient, rest = remainder(value.numerator, value.denominator, variable)
        return ideal.simplified(quotient), ideal.simplified(rest)
    except TooLarge:
        return None


def _never_divides(value: Scalar, environment: Environment) -> bool:
    """Return whether a rational function is a polynomial at no point: its remainder's coefficients never vanish together."""
    variable, apart = environment.variable, (*environment.nonzero, *environment.domain)
    rest = remainder(value.numerator, value.denominator, variable)[1].coefficients(variable)
    systems = value.denominator.coefficients(variable)[:1], [c.numerator for c in rest]
    try:
        return all(never_together_zero(s, environment.relations, environment.signs, apart) for s in systems)
    except TooLarge:
        return False


def _verdict(value: Scalar, environment: Environment, discrete: bool) -> str:  # noqa: FBT001
    """Return the verdict on a polynomial where the relations hold, or as it is written, whichever tells more."""
    variable, signs = environment.variable, environment.signs
    found = stability(polynomial_of(value, environment), variable, signs, discrete=discrete).verdict
    outer = value.denominator, value.coefficients(variable)[0]
    is_same = all(never_zero(part, signs) for part in outer)  # defined, and of the same degree
    return stability(value, variable, signs, discrete=discrete).verdict if found == "conditional" and is_same else found


def _degrees(value: Scalar, environment: Environment) -> tuple[int, int]:
    return value.degree(environment.variable), value.denominator.degree(environment.variable)


def are_roots(values: tuple[Root, ...], polynomial: Scalar, environment: Environment) -> bool:
    """Return whether these are the roots of a monic polynomial where the relations hold."""
    product = polynomial_of_roots(environment.variable, values)
    if product is None or product == polynomial:
        return product is not None
    try:
        ideal = Ideal.where(environment.relations)
        divides_by_zero = any(part.denominator in ideal for part in (product, polynomial))
        return not divides_by_zero and (product - polynomial).numerator in ideal
    except TooLarge:
        return False


def subjects(name: str, value: Any, variable: str) -> tuple[Scalar, ...]:
    """Return the subject of a property: a scalar, the entries of a matrix, or their common denominator.

    Raises TypeError for a matrix without poles: a constant matrix would be stable whatever its eigenvalues.
    """
    if name == "positive_definite":
        return leading_minors(value)
    if not isinstance(value, Matrix) or value.shape == (1, 1):
        only = as_scalar(value)
        if stands_inside(variable, only):
            reject(f"that the function {only} is {name}")
        return (only,)
    if name == "strictly_proper":
        return value.entries
    denominator = value.common_denominator()
    if name not in {"stable", "unstable"} or denominator.degree(variable) < 1:
        message = f"{name} is no property of this matrix"
        raise WrongKind(message)
    return (denominator,)


def leading_minors(value: Any) -> tuple[Scalar, ...]:
    """Return the leading principal minors of a symmetric matrix; raises `WrongKind` for another value."""
    if not isinstance(value, Matrix) or value != value.T:
        message = "what is positive definite is a symmetric matrix"
        raise WrongKind(message)
    return tuple(value.select(range(k), range(k)).determinant() for k in range(1, value.shape[0] + 1))


def needed(name: str, polynomial: Scalar, environment: Environment, discrete: bool) -> tuple[Scalar, ...]:  # noqa: FBT001
    """Return what must be positive for a polynomial to be stable, not negative for it to be marginal; nothing if unknown."""
    variable, signs = environment.variable, environment.signs
    if name == "positive_definite":
        return (polynomial,) if sign_of(polynomial, signs) != "positive" else ()
    if name == "marginal":
        return marginal_where(polynomial, variable, signs, discrete=discrete)
    return stability(polynomial, variable, signs, discrete=discrete).positive if name == "stable" else ()


def _has_sign_of(bound: Scalar, value: Scalar, signs: Mapping[str, str]) -> bool:
    """Return whether a value is a positive multiple of another wherever that is defined."""
    ratio, undefined = value / bound, vanishing_factors([bound.denominator], signs)
    if sign_of(ratio, signs) not in {"positive", "nonnegative"}:
        return False
    return {*vanishing_factors([ratio.numerator, ratio.denominator], signs)} <= {*undefined}


def is_criterion(
    name: str,
    polynomial: Scalar | tuple[Scalar, ...],
    said: Sequence[Scalar],
    environment: Environment,
    discrete: bool,  # noqa: FBT001
) -> bool:
    """Return whether the stated inequalities are those of the criterion, each up to a positive factor."""
    signs = environment.signs
    polynomials = polynomial if isinstance(polynomial, tuple) else (polynomial,)
    bounds = [bound for each in polynomials for bound in needed(name, each, environment, discrete)]
    if not said:
        return False
    same = [[_has_sign_of(bound, value, signs) for bound in bounds] for value in said]
    return all(map(any, same)) and all(map(any, zip(*same, strict=True)))


#: What each property asks of a scalar, of the environment, and of discrete time.
PREDICATES: dict[str, Callable[[Scalar, Environment, bool], bool]] = {
    "stable": lambda value, environment, discrete: _verdict(value, environment, discrete) == "yes",
    "unstable": lambda value, environment, discrete: _verdict(value, environment, discrete) == "no",
    "strictly_proper": lambda value, environment, _: _degrees(value, environment)[0] < _degrees(value, environment)[1],
    "polynomial": lambda value, environment, _: (_divided(value, environment) or (0, Scalar.of(1)))[1].is_zero,
    "not_polynomial": lambda value, environment, _: _never_divides(value, environment),
    "no_stable_compensator": lambda value, environment, discrete: (
        not discrete and no_stable_compensator(value, environment.variable, environment.signs)
    ),
    "marginal": lambda value, environment, discrete: is_marginal(
        value,
        environment.variable,
        environment.signs,
        discrete=discrete,
        apart=(*environment.nonzero, *environment.domain),
    ),
    "beyond": lambda value, environment, discrete: is_beyond(
        value, environment.variable, environment.signs, discrete=discrete
    ),
    "positive_definite": lambda value, environment, _: sign_of(value, environment.signs) == "positive",
    "never_zero": lambda value, environment, _: never_zero(value, environment.signs),
}


# Rejection of a line of a derivation.


BUG = "please report this: it is a bug of symobs"


def reject(line: str) -> NoReturn:
    """Raise `DerivationRejected`."""
    message = f"the line {line} is not true"
    raise DerivationRejected(message, repair=BUG, line=line)


# Restriction of an environment to a stratum, its substitution verified first (trusted).


def on_stratum(when: Relation | Conjunction, substitution: dict[str, Scalar], environment: Environment) -> Environment:
    """Return the environment on a stratum, after verifying that the substitution describes it.

    Without a substitution the single equation itself is what is known inside: that a polynomial of the parameters
    vanishes, or that λ is an eigenvalue.  Otherwise a single `when` has one factor that can vanish, linear in the one
    name put in: another equation would hold elsewhere too.  Of several equations and inequations it is verified that
    each value put in follows from them.
    """
    if not substitution and isinstance(when, Relation) and when.operators in {("<",), (">",), ("!=",)}:
        if when.operators == ("!=",):
            return environment  # it narrows, and nothing is put in: all stays true
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
        return _where_positive(left - right if when.operators == (">",) else right - left, environment)
    if not substitution and isinstance(when, Relation) and when.operators == ("=",):
        left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
        inside = replace(environment, relations=(*environment.relations, left - right), nonzero=())
        if Ideal.where(inside.relations).is_whole:
            reject(plain_relation(when, environment.variable))
        return _with_meaning(inside)
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
    named, vanishing = _in_common_base(named, replaced.values())
    moved = {name: value for name, value in named.items() if function_named(name) is not None}
    relations = tuple(value.substitute(moved).numerator for value in relations) if moved else relations
    inside = replace(
        environment,
        values=replaced,
        coefficients=named,
        nonzero=(),
        domain=domain,
        positive=positive,
        relations=tuple(dict.fromkeys((*relations, *vanishing))),
    )
    if isinstance(when, Conjunction):
        return _with_meaning(inside.with_relations(_left_of(when, substitution, environment)))
    left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in when.members)
    factors = [f for f, _ in (left - right).numerator.factors()[1] if not never_zero(f, environment.signs)]
    says_no_more = [f.degree(name) for f in factors for name in substitution] == [1] and when.operators == ("=",)
    if not says_no_more or verify(when, inside)[0] == "":
        reject(plain_relation(when, environment.variable))
    return inside


def _with_meaning(inside: Environment) -> Environment:
    """Return an environment without the letters whose values divide by 0 where its relations hold."""
    below = {name: value.common_denominator() for name, value in inside.values.items()}
    if all(value.is_constant for value in below.values()):
        return inside
    ideal = Ideal.where(inside.relations)
    kept = {n: v for n, v in inside.values.items() if below[n].is_constant or below[n].numerator not in ideal}
    return replace(inside, values=kept)


def _in_common_base(
    named: Mapping[str, Scalar], values: Iterable[Scalar | Matrix]
) -> tuple[dict[str, Scalar], tuple[Scalar, ...]]:
    """Return what generators stand for on a stratum, and what vanishes there, in functions that are independent there.

    e^{at/(a+1)} and e^{t/(a+1)} are powers of one exponential where a is a number.  Functions of symbols that stand for
    others there are none of the base.  Raises `NotWritten` where a common base would have too high a degree.
    """
    functions = {name: f.value for name in named if (f := function_named(name)) is not None}
    kept = {name: value for name, value in functions.items() if symbols_named(name).isdisjoint(named)}
    meanings, vanishing = identities([*kept.values(), *named.values(), *values])
    return {n: value.substitute(meanings) for n, value in named.items() if n not in kept} | meanings, vanishing


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


def difference_of(relation: Relation, environment: Environment) -> Scalar:
    """Return what is 0 exactly where both members are equal: their difference, of rows the sum of its squares."""
    left, right = (evaluate(member, environment, Exact(environment)) for member in relation.members)
    if isinstance(left, Matrix) and isinstance(right, Matrix) and left.shape[1] > 1:
        return sum((entry**2 for entry in (left - right).entries), Scalar.of(0))
    return as_scalar(left) - as_scalar(right)


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
        if relation.operators == ("=",):
            equations.append(difference_of(relation, environment).numerator)
        elif relation.operators == ("!=",):
            excluded.append(difference_of(relation, environment))
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


# Check that inequalities hold exactly where a polynomial has a property (trusted).


def is_exactly(
    fact: HoldsExactlyWhere, polynomial: Scalar | tuple[Scalar, ...], environment: Environment, *, discrete: bool
) -> bool:
    """Return whether a polynomial, or each leading minor of a matrix, has a property exactly where some inequalities hold.

    They are those that the criterion asks for, or proved to say the same; with one or two parameters by the region itself.
    """
    arithmetic, name = Exact(environment), fact.property.name
    said: list[tuple[Scalar, str]] = []
    for relation in fact.where:
        values = [as_scalar(evaluate(member, environment, arithmetic)) for member in relation.members]
        for (left, right), operator in zip(pairwise(values), relation.operators, strict=True):
            said.append((right - left if operator[0] == "<" else left - right, operator))
    allowed = {">", "<", "!="} if name in {"stable", "positive_definite"} else {">=", "<="}
    if not {operator for _, operator in said} <= allowed:
        return False
    positive = tuple(value**2 if operator == "!=" else value for value, operator in said)
    if is_criterion(name, polynomial, positive, environment, discrete):
        return True
    if name == "positive_definite" and isinstance(polynomial, tuple) and said:
        from symobs.stability.criteria.stability_conditions import say_the_same  # noqa: PLC0415 - only these pages pay for it

        bounds = [bound for each in polynomial for bound in needed(name, each, environment, discrete)]
        return say_the_same(bounds, positive, environment.signs)
    if name != "stable" or not said or isinstance(polynomial, tuple):
        return False
    from symobs.proof.derivation.region_check import holds_exactly, region_of  # noqa: PLC0415 - only pages of regions pay for it
    from symobs.stability.criteria.stability_conditions import is_stable_where  # noqa: PLC0415 - the same

    region = region_of(polynomial, environment, discrete=discrete)
    where = tuple((value, "!=" if operator == "!=" else ">") for value, operator in said)
    if region is not None and holds_exactly(region, where):
        return True
    return is_stable_where(polynomial, environment.variable, positive, environment.signs, discrete=discrete)
