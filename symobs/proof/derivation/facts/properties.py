"""Properties that no equation states: stable, strictly proper, never zero (trusted)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Ideal, Matrix, Scalar, TooLarge, from_coefficients, remainder
from symobs.exact.algebraic.polynomial_roots import polynomial_of_roots
from symobs.ground.errors import WrongKind
from symobs.proof.certificate.claims import as_scalar
from symobs.proof.certificate.pointwise import never_together_zero
from symobs.stability.criteria.stability import is_beyond, is_marginal, marginal_where, no_stable_compensator, stability
from symobs.system.conditions import never_zero, sign_of

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.exact import Root
    from symobs.formula.tree import Environment


def polynomial_of(value: Scalar, environment: Environment) -> Scalar:
    """Return a polynomial, and what is one where the relations hold, and of another rational function the denominator."""
    found = _divided(value, environment)
    return _lowered(found[0] if found is not None and found[1].is_zero else value.denominator, environment)


def _lowered(polynomial: Scalar, environment: Environment) -> Scalar:
    """Return a polynomial without the coefficients that vanish where the relations hold.

    Raises `TooLarge` where that is not known of the first, and so not the degree.
    """
    coefficients = polynomial.coefficients(environment.variable)
    if not environment.relations:
        return polynomial
    try:
        ideal = Ideal.where(environment.relations)
        kept = [c if c.numerator not in ideal or c.denominator in ideal else Scalar.of(0) for c in coefficients]
    except TooLarge:
        if not coefficients[0].is_constant:
            raise
        return polynomial
    return from_coefficients(kept, environment.variable) if any(kept) else polynomial


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
    polynomial = polynomial_of(value, environment)
    return stability(polynomial, environment.variable, environment.signs, discrete=discrete).verdict


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
    if not isinstance(value, Matrix) or value.shape == (1, 1):
        return (as_scalar(value),)
    if name == "strictly_proper":
        return value.entries
    denominator = value.common_denominator()
    if name not in {"stable", "unstable"} or denominator.degree(variable) < 1:
        message = f"{name} is no property of this matrix"
        raise WrongKind(message)
    return (denominator,)


def needed(name: str, polynomial: Scalar, environment: Environment, discrete: bool) -> tuple[Scalar, ...]:  # noqa: FBT001
    """Return what must be positive for a polynomial to be stable, not negative for it to be marginal; nothing if unknown."""
    variable, signs = environment.variable, environment.signs
    if name == "marginal":
        return marginal_where(polynomial, variable, signs, discrete=discrete)
    return stability(polynomial, variable, signs, discrete=discrete).positive if name == "stable" else ()


def is_criterion(
    name: str,
    polynomial: Scalar,
    said: Sequence[Scalar],
    environment: Environment,
    discrete: bool,  # noqa: FBT001
) -> bool:
    """Return whether the stated inequalities are those of the criterion, each up to a positive factor."""
    signs, bounds = environment.signs, needed(name, polynomial, environment, discrete)
    if not said:
        return False
    same = [[sign_of(value / bound, signs) == "positive" for bound in bounds] for value in said]
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
    "never_zero": lambda value, environment, _: never_zero(value, environment.signs),
}
