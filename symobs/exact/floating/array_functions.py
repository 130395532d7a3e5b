"""Exact values as functions of NumPy arrays: numerator and denominator by nested multiplication, in double precision.

A polynomial is nested once, p = q xᵏ + r with the generator x that most of its terms contain, and evaluated at blocks of
points that stay in the processor's cache.  NumPy is imported by whoever brings arrays.
"""

from __future__ import annotations

from collections import Counter
from fractions import Fraction
from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from symobs.exact.algebraic.enclosure import decimal, is_number
from symobs.exact.core.generators import PI, function_named
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact.core.scalar import Scalar

#: Points that are evaluated together: a few arrays of this length fit into the cache of a processor.
BLOCK = 1 << 14
Term: TypeAlias = tuple[float, dict[str, int]]


class Nested(NamedTuple):
    """q xᵏ + r."""

    high: Polynomial
    name: str
    power: int
    low: Polynomial


Polynomial: TypeAlias = "Nested | float"


class ArrayFunction:
    """Some exact values as a function of arrays, one for each name; functions such as exp(−2a) are evaluated, too."""

    def __init__(self, values: Sequence[Scalar]) -> None:
        """Nest numerators and denominators; raises `InputError` where a coefficient has no double."""
        self.fractions = [(nested(value.numerator), nested(value.denominator)) for value in values]
        self.names = sorted({name for value in values for name in value.names})

    def __call__(self, points: Mapping[str, Any]) -> Any:
        """Return an array with one row for each value; `points` has flat arrays of one length by name."""
        import numpy as np

        known = {name: at_points(name, points) for name in self.names}
        count = max((len(array) for array in points.values()), default=1)
        found = np.empty((len(self.fractions), count))
        with np.errstate(all="ignore"):
            for start in range(0, count, BLOCK):
                block = slice(start, min(start + BLOCK, count))
                here = {name: values[block] if np.ndim(values) else values for name, values in known.items()}
                for (above, below), into in zip(self.fractions, found, strict=True):
                    top = evaluated(above, here)
                    into[block] = top if below == 1.0 else top / evaluated(below, here)
        return found


def at_points(name: str, points: Mapping[str, Any]) -> Any:
    """Return the values of a generator: those of its own symbol, or a function of them."""
    import numpy as np

    function = function_named(name)
    if function is None:
        return pi if name == PI else points[name]
    argument: Scalar = function.argument
    if is_number(argument) or function.kind == "CRootOf":
        return decimal(_symbol(name))
    return getattr(np, function.kind)(ArrayFunction([argument])(points)[0])


def _symbol(name: str) -> Scalar:
    from symobs.exact.core.scalar import Scalar  # noqa: PLC0415 - for annotations above

    return Scalar.symbol(name)


def nested(polynomial: Scalar) -> Polynomial:
    """Return a polynomial as q xᵏ + r, and q and r likewise."""
    try:
        return _nested([(float(coefficient), dict(powers)) for coefficient, powers in polynomial.each_term()])
    except OverflowError:
        message = "a coefficient is larger than any floating-point number"
        raise InputError(message, repair="evaluate exactly with .at(...), or write the data in other units") from None


def _nested(terms: list[Term]) -> Polynomial:
    """Return the nested form of Σ c Π x^k."""
    shared = Counter(name for _, powers in terms for name in powers)
    if not shared:
        return sum((coefficient for coefficient, _ in terms), 0.0)
    name = max(shared, key=lambda each: (shared[each], each))
    having = [(coefficient, powers) for coefficient, powers in terms if name in powers]
    rest = [(coefficient, powers) for coefficient, powers in terms if name not in powers]
    least = min(powers[name] for _, powers in having)
    lowered = [
        (coefficient, {other: power - least * (other == name) for other, power in powers.items()})
        for coefficient, powers in having
    ]
    kept = [
        (coefficient, {other: power for other, power in powers.items() if power}) for coefficient, powers in lowered
    ]
    return Nested(_nested(kept), name, least, _nested(rest) if rest else 0.0)


def evaluated(polynomial: Polynomial, points: Mapping[str, Any]) -> Any:
    """Return the values of a nested polynomial."""
    if not isinstance(polynomial, Nested):
        return polynomial
    high, name, power, low = polynomial
    factor = points[name] if power == 1 else points[name] ** power
    value = factor if high == 1.0 else evaluated(high, points) * factor
    return value if low == 0.0 else value + evaluated(low, points)


def sizes(polynomial: Polynomial, points: Mapping[str, Any]) -> Any:
    """Return Σ |c| Π |x|^k, the scale of the rounding errors."""
    if not isinstance(polynomial, Nested):
        return abs(polynomial)
    high, name, power, low = polynomial
    return sizes(high, points) * abs(points[name]) ** power + sizes(low, points)


def shortest(value: float) -> Fraction:
    """Return the shortest decimal that names a double."""
    return Fraction(repr(float(value)))
