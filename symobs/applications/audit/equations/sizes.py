"""Sizes of values in printed equations, and equality of two sides."""

from __future__ import annotations

from typing import TypeAlias

from symobs.applications.audit.equations.matrix_functions import no_fit, sized
from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import identities
from symobs.formula.tree import Environment, Literal, Relation, Signal
from symobs.formula.tree.term import Term
from symobs.ground.dataclass import dataclass
from symobs.proof.certificate.claims import verify


@dataclass(frozen=True)
class Flexible:
    """A multiple of the identity matrix of undetermined order; 0 is the zero matrix of any size."""

    factor: Scalar


Printed: TypeAlias = Term | Flexible


def shape(term: Term) -> tuple[int, int] | None:
    """Return rows and columns of a value or a signal, None for a number."""
    value = term.value
    if isinstance(value, Signal):
        return value.size, 1
    return value.shape if isinstance(value, Matrix) else None


def is_signal(printed: Printed) -> bool:
    """Return whether a value is made of signals."""
    return isinstance(printed, Term) and isinstance(printed.value, Signal)


def fitted(flexible: Flexible, like: Term) -> Term:
    """Return a multiple of the identity in the size of another value; raises Misfit unless that is square."""
    size = shape(like)
    if is_signal(like):
        raise no_fit("the identity matrix stands beside a signal")
    if size is None or size == (1, 1):
        return Term(Literal(flexible.factor), like.environment)
    if flexible.factor.is_zero:
        return Term(Literal(Matrix.zeros(*size)), like.environment)
    if size[0] != size[1]:
        raise no_fit(f"the identity matrix is square, but {sized(size)} stands beside it")
    return Term(Literal(Matrix.identity(size[0]) * flexible.factor), like.environment)


def kind_of(term: Term) -> str:
    """Return the size of a value in words."""
    size = shape(term)
    if size is not None and is_signal(term):
        return f"has {size[0]} component{'s' if size[0] > 1 else ''}"
    return f"is {sized(size)}"


def alike(left: Term, right: Term) -> bool:
    """Return whether two values can be added."""
    single = ((1, 1), None)
    if is_signal(left) != is_signal(right):
        return False
    return shape(left) == shape(right) or (shape(left) in single and shape(right) in single)


def common(left: Printed, right: Printed, environment: Environment) -> tuple[Term, Term]:
    """Return two sides in one size; raises Misfit where they have none."""
    if isinstance(left, Flexible) or isinstance(right, Flexible):
        if isinstance(left, Term):
            return left, fitted(right, left)  # type: ignore[arg-type]
        if isinstance(right, Term):
            return fitted(left, right), right
        return tuple(Term(Literal(side.factor), environment) for side in (left, right))  # type: ignore[return-value]
    if not alike(left, right) and (_is_zero(left) or _is_zero(right)):
        return (left, left - left) if _is_zero(right) else (right - right, right)
    if not alike(left, right):
        raise no_fit(f"the left side {kind_of(left)}, the right side {kind_of(right)}")
    return left, right


def _is_zero(term: Term) -> bool:
    return isinstance(term.value, Scalar) and term.value.is_zero


def equal(left: Term, right: Term) -> bool:
    """Return whether two sides are equal, by a certificate."""
    environment = left.environment
    exact = [value for value in (left.value, right.value) if isinstance(value, (Scalar, Matrix))]
    meanings, relations = identities(exact)
    if meanings or relations:
        environment = Environment(environment.variable, coefficients=meanings, relations=relations)
        return bool(verify(Relation((Literal(exact[0]), Literal(exact[1])), ("=",)), environment)[0])
    return bool(verify(Relation((left.formula, right.formula), ("=",)), environment)[0])
