"""Claims and their certificates: the check every result must pass (trusted).

A claim is a relation between two formulas in an environment: `det(sI − A + LC) = φ(s)`.  Checking it needs products
and a comparison, never the method that met it.  Small claims are evaluated exactly.  Large ones are evaluated at
random points modulo random primes of one word; the probability that a false one passes is bounded by following degrees and
heights through the same formulas, and the bound is part of the certificate.  Points and primes come from a generator
seeded by the SHA-256 of the claim, so runs repeat.
"""

from __future__ import annotations

import hashlib
import itertools
import random
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar, TooLarge, is_rounding
from symobs.exact.core.generators import NotWritten, function_named, symbols_named
from symobs.exact.core.modular import POINT_BITS, PRIME_BITS, PRIMES_BELOW, Point, VanishingDenominator, squares_of
from symobs.formula.tree import (
    Apply,
    Decimals,
    Environment,
    Exact,
    Formula,
    Letter,
    Literal,
    Modular,
    ModuloIdeal,
    Relation,
    agree,
    children,
    derived_by,
    differ,
    divisors,
    evaluate,
    is_of_instants,
    is_rational,
)
from symobs.formula.tree.calculus import TIME
from symobs.formula.tree.plain_text import plain_relation
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import CertificateRejected, NotShown, Undecided, WrongKind
from symobs.proof.certificate.pointwise import Bounds, Pointwise, SizeBound, never_together_zero
from symobs.system.conditions import sign_where, vanishing_factors
from symobs.system.reading import is_identity

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

#: Claims whose values have at most this many terms are checked exactly.
EXACT_UP_TO = 60
#: The error bound every certificate at random points stays below.
ERROR_GOAL = 2.0**-50
_DRAWS = 20
#: What evaluation raises where a formula makes no sense: shapes or kinds that do not fit, division by zero, a missing
#: letter.  An AttributeError, a TypeError of Python's own or a failed assertion is a bug, and stays one.
EVALUATION_ERRORS = (ArithmeticError, LookupError, RecursionError, ValueError)
#: What evaluation raises where it gives up: the truth of the formula is undecided.
BEYOND_LIMITS = (NotShown, NotWritten, TooLarge)
#: What reading an answer or a step of any kind whatever may raise: it is refused, with this as the cause.
UNREADABLE = (*EVALUATION_ERRORS, AssertionError, AttributeError, TypeError)
#: What a random point can decide: equal, and not identically equal.  `!=` is more: different at every point.
_AT_POINTS = {"=", "!=="}


@dataclass
class Claim:
    """A relation that must hold in an environment; `says` are words before it in its printed text."""

    relation: Relation
    environment: Environment
    says: str = ""

    def __str__(self) -> str:
        relation = plain_relation(self.relation, self.environment.variable)
        return f"{self.says}: {relation}" if self.says else relation


@dataclass
class Statement:
    """A claim other than an equation: `shown` returns the proof method, "" if the claim is false."""

    says: str
    shown: Callable[[], str]

    def __str__(self) -> str:
        return self.says


@dataclass
class Certificate:
    """A checked claim: the method, and a bound for the probability of accepting a false one."""

    claim: str
    how: str
    bound: str


def check(claim: Claim | Statement) -> Certificate:
    """Return the certificate of a claim, or raise `CertificateRejected`."""
    if isinstance(claim, Statement):
        how, error, says = claim.shown(), 0.0, claim.says
    else:
        (how, error), says = verify(claim.relation, claim.environment), str(claim)
    if how == "":
        if isinstance(claim, Claim) and not can_be_shown(claim.relation, claim.environment):
            raise Undecided(f"whether {says} is undecided: it is beyond the limits of a check", claim=says)
        raise CertificateRejected(f"the claim {says} does not hold", claim=says)
    return Certificate(says, how, "0" if error == 0 else f"{error:.1e}")


def check_all(claims: Iterable[Claim | Statement], relations: tuple[Scalar, ...] = ()) -> tuple[Certificate, ...]:
    """Return the certificates of all claims, where `relations` hold too."""
    return tuple(check(c if isinstance(c, Statement) else _under(c, relations)) for c in claims)


def _under(claim: Claim, relations: tuple[Scalar, ...]) -> Claim:
    return Claim(claim.relation, claim.environment.with_relations(relations), claim.says)


def verify(relation: Relation, environment: Environment) -> tuple[str, float]:
    """Return the method of proof of a relation and its error bound; ("", 0) if it is false or undefined.

    An equation that holds with the named coefficients free holds whatever they stand for, so that is tried first.
    """
    try:
        return _verified(relation, environment)
    except EVALUATION_ERRORS:
        return "", 0.0


def can_be_shown(relation: Relation, environment: Environment) -> bool:
    """Return whether `verify` can decide a relation: no rank or basis in it is too large."""
    try:
        _verified(relation, environment)
    except BEYOND_LIMITS:
        return False
    except EVALUATION_ERRORS:
        return True
    return True


def _verified(relation: Relation, environment: Environment) -> tuple[str, float]:
    leaves = _distinct(relation, environment)
    if environment.relations and (found := _in_general(relation, environment, leaves))[0]:
        return found
    if _needs_values(relation, environment, leaves):
        return ("exact", 0.0) if _holds_exactly(relation, environment) else ("", 0.0)
    free = replace(environment, coefficients={}) if environment.coefficients else environment
    pointwise = not set(relation.operators) <= _AT_POINTS
    exactly = pointwise or sum(leaf.size for leaf in leaves) <= EXACT_UP_TO
    if exactly and (free is environment or "!==" not in relation.operators) and _holds_exactly(relation, free):
        return "exact", 0.0
    if exactly and (pointwise or not environment.coefficients):
        return "", 0.0
    return _holds_at_points(relation, environment, leaves)


def _in_general(relation: Relation, environment: Environment, leaves: Sequence[Scalar | Matrix]) -> tuple[str, float]:
    """Return how an equation is shown without the relations; ("", 0) where it does not hold so.

    An equation that holds in general holds where the relations do, if everything in it has a meaning there: no denominator
    of a value vanishes, and nothing is divided by what does.
    """
    general = replace(environment, relations=())
    if set(relation.operators) != {"="} or environment.coefficients or environment.signals:
        return "", 0.0
    if not all(map(is_rational, relation.members)) or _needs_values(relation, general, leaves):
        return "", 0.0  # a rank, say, may be another on a stratum than in general
    if sum(leaf.size for leaf in leaves) <= EXACT_UP_TO:
        found = ("exact", 0.0) if _holds_exactly(relation, general) else ("", 0.0)
    else:
        found = _holds_at_points(relation, general, leaves)
    return found if found[0] and _has_meaning(relation, environment, leaves) else ("", 0.0)


def _has_meaning(relation: Relation, environment: Environment, leaves: Sequence[Scalar | Matrix]) -> bool:
    """Return whether no denominator of a value, and nothing that is divided by, vanishes where the relations hold."""
    arithmetic = ModuloIdeal(environment)
    below = [leaf.common_denominator() for leaf in leaves]
    for divisor in (part for member in relation.members for part in divisors(member)):
        value = evaluate(divisor, environment, arithmetic)
        below.append(value.determinant() if isinstance(value, Matrix) else value)
    return all(value.is_constant or value not in arithmetic.ideal for value in below)


def _needs_values(relation: Relation, environment: Environment, leaves: Sequence[Scalar | Matrix]) -> bool:
    """Return whether exact values are needed: residues cannot decide functions of time, nor relations."""
    if environment.relations:
        return True
    meanings = [formula for formula in environment.signals.values() if formula is not None]
    if relation.is_of_instants or any(map(is_of_instants, meanings)):
        return True
    by = relation.derived_by.union(*map(derived_by, meanings))
    if by - {TIME} or (by and environment.variable == TIME):  # a constant, too, has a derivative, which no residue has
        return True
    if not by:
        return False
    values = (*leaves, *environment.coefficients.values())
    return any(TIME in symbols_named(name) for value in values for name in value.field.names)


def _holds_exactly(relation: Relation, environment: Environment) -> bool:
    on_stratum = not all(map(_is_of_angle, environment.relations))
    arithmetic = Pointwise(environment, everywhere=on_stratum) if environment.relations else Exact(environment)
    values = [evaluate(member, environment, arithmetic) for member in relation.members]
    return all(
        _compare(left, operator, right, environment, arithmetic)
        for left, operator, right in zip(values[:-1], relation.operators, values[1:], strict=True)
    )


def _is_of_angle(relation: Scalar) -> bool:
    """Return whether a relation is cos² θ + sin² θ = 1: beside such ones, which are prime, a rank is the generic one."""
    kinds = {found.kind for name in relation.names if (found := function_named(name)) is not None}
    return kinds <= {"cos", "sin"} and is_identity(relation)


def _compare(left: Any, operator: str, right: Any, environment: Environment, arithmetic: Exact) -> bool:
    if operator == "=":
        return agree(left, right, arithmetic)
    if operator == "!==":
        return differ(left, right, arithmetic)
    if operator == "~":  # the rows span the same space
        several = (left, right, arithmetic.block([[left], [right]]))
        return len({arithmetic.apply("rank", matrix) for matrix in several}) == 1
    if operator == "≈":
        return _is_rounding(left, right)
    if operator == "!=":
        difference = left - right
        entries = difference.entries if isinstance(difference, Matrix) else (difference,)
        sure = any(_excluded_from_zero(entry, environment) for entry in entries)
        known = *environment.nonzero, *environment.domain
        return sure or never_together_zero(entries, environment.relations, environment.signs, known)
    sign = sign_where(as_scalar(left) - as_scalar(right), environment.signs, environment.positive)
    return (
        sign
        in {
            ">": ("positive",),
            ">=": ("positive", "nonnegative", "zero"),
            "<": ("negative",),
            "<=": ("negative", "nonpositive", "zero"),
        }[operator]
    )


def _is_rounding(exact: Any, shown: Any) -> bool:
    """Return whether every entry rounds to the printed decimals."""
    if not isinstance(exact, Matrix):
        return is_rounding(exact, as_scalar(shown))
    if not isinstance(shown, Matrix) or exact.shape != shown.shape:
        return False
    return all(is_rounding(entry, near) for entry, near in zip(exact.entries, shown.entries, strict=True))


def as_scalar(value: Any) -> Scalar:
    """Return the entry of a 1×1 matrix, or a scalar; raises `WrongKind` for any other value."""
    if isinstance(value, Matrix) and value.shape == (1, 1):
        (value,) = value.entries
    if not isinstance(value, Scalar):
        raise WrongKind(f"{type(value).__name__} is not a scalar")
    return value


def _excluded_from_zero(value: Scalar, environment: Environment) -> bool:
    """Return whether signs and stated conditions imply that a value is nonzero, factor by factor.

    The factors are those over the numbers of the conditions: where k − √2 and k + √2 are not 0, k² − 2 is not.
    """
    known = {*environment.nonzero, *environment.domain}
    for factor in known:
        value = value.within(value.field | factor.field.numbers)
    return not value.is_zero and known.issuperset(vanishing_factors([value], environment.signs))


def _holds_at_points(
    relation: Relation, environment: Environment, leaves: Sequence[Scalar | Matrix]
) -> tuple[str, float]:
    generator = random.Random(_seed(relation, environment, leaves))  # noqa: S311 - repeatable by design
    error, points = 1.0, 0
    names = {environment.variable}.union(*(leaf.field.names for leaf in [*leaves, *environment.coefficients.values()]))
    roots = len(squares_of(names))
    draws = _DRAWS << roots  # one prime in 2^k has roots of k numbers
    for _ in range(draws):
        try:
            arithmetic = Modular(environment, Point(names, generator))
            if not _holds_at(relation, environment, arithmetic):
                return "", 0.0
        except (VanishingDenominator, ZeroDivisionError):
            continue
        points += 1
        error *= _error_bound(relation, environment, arithmetic, draws << roots if roots else 1)
        if error <= ERROR_GOAL:
            return f"at {points} random point{'s' if points > 1 else ''} modulo {PRIME_BITS}-bit primes", error
    return "", 0.0


def _holds_at(relation: Relation, environment: Environment, arithmetic: Modular) -> bool:
    values = [evaluate(member, environment, arithmetic) for member in relation.members]
    return all(
        agree(left, right, arithmetic) if operator == "=" else differ(left, right, arithmetic)
        for left, operator, right in zip(values[:-1], relation.operators, values[1:], strict=True)
    )


def _error_bound(relation: Relation, environment: Environment, arithmetic: Modular, share: int = 1) -> float:
    """Return a bound for the probability that a false relation passes at a random point modulo a random prime.

    Beside k roots the integer that a prime must not divide is a norm, of 2ᵏ times the bits; and no prime among all that
    may have been drawn may divide it: `share` is the number of draws times 2ᵏ.
    """
    bounds = Bounds(environment, arithmetic)
    total = 0.0
    sizes = [evaluate(member, environment, bounds) for member in relation.members]
    for left, right in itertools.pairwise(sizes):
        for first, second in _paired(left, right):
            degree = max(first.above + second.below, second.above + first.below)
            bits = 1 + max(first.above_bits + second.below_bits, second.above_bits + first.below_bits)
            total += degree / 2.0**POINT_BITS + share * bits / (PRIME_BITS - 1) / PRIMES_BELOW
    return min(total, 0.5)


def _paired(left: Any, right: Any) -> list[tuple[SizeBound, SizeBound]]:
    if isinstance(left, SizeBound) and isinstance(right, SizeBound):
        return [(left, right)]
    zero = SizeBound(0, 0, 0, 0)
    names = {*left.coefficients, *right.coefficients}
    return [(left.coefficients.get(name, zero), right.coefficients.get(name, zero)) for name in names]


def _leaves(formula: Formula, environment: Environment, seen: set[str]) -> Iterable[Scalar | Matrix]:
    """Yield the exact values in a formula, and once in the definition and dynamics of each signal."""
    match formula:
        case Letter(name) if name in environment.signals:
            if name not in seen:
                seen.add(name)
                for other in (environment.signals[name], environment.dynamics.get(name)):
                    if other is not None:
                        yield from _leaves(other, environment, seen)
        case Letter(name) if name != "s":
            yield environment.values[name]
        case Literal(value) | Decimals(value):
            yield value
        case _:
            if isinstance(formula, Apply) and formula.function.endswith("_at"):
                yield environment.values[formula.function.removesuffix("_at")]
            for part in children(formula):
                yield from _leaves(part, environment, seen)


def _distinct(relation: Relation, environment: Environment) -> list[Scalar | Matrix]:
    seen: set[str] = set()
    leaves = {id(leaf): leaf for member in relation.members for leaf in _leaves(member, environment, seen)}
    return list(leaves.values())


def _seed(relation: Relation, environment: Environment, leaves: Sequence[Scalar | Matrix]) -> int:
    digest = hashlib.sha256(plain_relation(relation, environment.variable).encode())
    for leaf in leaves:
        digest.update(leaf.fingerprint().encode())
    return int.from_bytes(digest.digest())
