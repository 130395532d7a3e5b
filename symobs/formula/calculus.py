"""Derivatives, values at an instant, and integrals of exact values that contain the time (trusted).

They need the values themselves, not residues: a claim with one of them is checked in the exact kernel.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar, derivative

if TYPE_CHECKING:
    from symobs.formula.evaluate import Arithmetic

TIME = "t"


def rate(value: Any, arithmetic: Arithmetic) -> Any:
    """Return d/dt of a value, entry by entry."""
    return derivative(value, TIME, _rates(arithmetic))


def at(value: Any, name: str, instant: Scalar, arithmetic: Arithmetic) -> Any:
    """Return the value with the generator `name` replaced; a function of t cannot be left behind at another time."""
    moving = _rates(arithmetic)
    if name == TIME and not moving.keys().isdisjoint(value.names):
        message = f"{', '.join(sorted(moving.keys() & value.names))} depends on t too"
        raise TypeError(message)
    return value.substitute({name: arithmetic.leaf(instant)})


def integral(integrand: Any, primitive: Any, name: str, limits: tuple[Scalar, Scalar], arithmetic: Arithmetic) -> Any:
    """Return primitive(upper) − primitive(lower), after holding the primitive's derivative to the integrand."""
    slope = derivative(primitive, name, _rates(arithmetic) if name == TIME else {})
    if not arithmetic.equal(slope, integrand):
        message = "the primitive is another function's"
        raise ArithmeticError(message)
    lower, upper = (at(primitive, name, limit, arithmetic) for limit in limits)
    return upper - lower


def _rates(arithmetic: Arithmetic) -> Any:
    """Return the rates that exact arithmetic knows; any other arithmetic has no derivatives."""
    rates = getattr(arithmetic, "rates", None)
    if rates is None:
        message = "only exact values have a derivative"
        raise TypeError(message)
    return rates
