"""Derivatives, values at an instant, and integrals of exact values that contain the time (trusted).

They need the values themselves, not residues: a claim with one of them is checked in the exact kernel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar
from symobs.exact.core.generators import derivative, substitute, symbols_in
from symobs.formula.tree.nodes import Integral
from symobs.ground.errors import WrongKind

if TYPE_CHECKING:
    from symobs.formula.tree.arithmetic import Arithmetic
    from symobs.formula.tree.nodes import Formula

TIME = "t"


def since_start(integrand: Formula, primitive: Formula, upper: Scalar) -> Integral:
    """Return the integral over t from 0 to `upper`."""
    return Integral(integrand, primitive, TIME, Scalar.of(0), upper)


def rate(value: Any, name: str, *, constant: bool) -> Any:
    """Return d/d(name) of a value, entry by entry."""
    if not constant and name not in symbols_in(exact(value)):
        raise WrongKind("a constant of a plant that does not vary has no derivative")
    return derivative(exact(value), name)


def at(value: Any, name: str, instant: Scalar) -> Any:
    """Return the value with the generator `name` replaced."""
    return substitute(exact(value), {name: instant})


def check_primitive(integrand: Any, primitive: Any, name: str, arithmetic: Arithmetic) -> None:
    """Raise `ArithmeticError` unless the derivative of the primitive is the integrand."""
    from symobs.formula.tree.arithmetic import agree  # noqa: PLC0415 - it stands on `evaluate`, which calls this

    if not agree(arithmetic.leaf(derivative(exact(primitive), name)), integrand, arithmetic):
        raise ArithmeticError("the primitive is another function's")


def exact(value: Any) -> Any:
    """Return an exact value; raises WrongKind for any other, such as a residue, which has no derivative."""
    if not isinstance(value, (Scalar, Matrix)):
        raise WrongKind(f"{type(value).__name__} is not an exact value")
    return value
