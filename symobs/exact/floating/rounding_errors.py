"""Values of exact functions at arrays of points with ten certain digits, also where their terms cancel.

Beside the value of a numerator or denominator in double precision stands a bound of its rounding error. It is found for
the largest values of a block of points first, then for single points where that bound is too coarse; what is still
uncertain is found in rational numbers, or in enclosures where functions occur.
"""

from __future__ import annotations

from decimal import Decimal
from sys import float_info
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from flint import arb, fmpq

from symobs.exact.algebraic.enclosure import _generator, is_number, polynomial_ball
from symobs.exact.core.generators import PI, NotWritten, function_named, substitute
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.exact.floating.sampled import (
    _BITS,
    BLOCK,
    ArrayFunction,
    Nested,
    Polynomial,
    _double,
    at_points,
    evaluated,
    nearest_double,
    nested,
    shortest,
    sizes,
)
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from fractions import Fraction

    _Terms: TypeAlias = list[tuple[int, tuple[tuple[str, int], ...]]]


#: A value is certain if its error, in units of 2⁻⁵³, is below this multiple of it: 2¹⁹⁻⁵³ is 6 · 10⁻¹¹. With fewer
#: units many points beside the zeros of a polynomial are uncertain, each of which takes as long as a thousand others.
_CERTAIN = 2.0**19
#: Bits that are enough where terms cancel twice, as in e^(−k) − 1 + k, at the smallest double.
_MOST_BITS = 8192
#: The largest double.
_LARGEST = arb(float_info.max)
#: The functions with enclosures at a point; all others are sums over roots, which are rounded from enclosures.
_ENCLOSED = {"sqrt", "exp", "cos", "sin", "cosh", "sinh"}


class CertainFunction(ArrayFunction):
    """Some exact values as a function of arrays, with ten digits at least."""

    def __init__(self, values: Sequence[Scalar]) -> None:
        """Nest numerators and denominators; raises `InputError` where a coefficient has no double."""
        super().__init__(values)
        self.values = list(values)
        self.exact: dict[Scalar, tuple[_Terms, _Terms]] = {}
        places = {part: place for place, part in enumerate(dict.fromkeys(p for pair in self.fractions for p in pair))}
        self.summed = [Summed.of(part) for part in places]
        self.pairs = [(places[above], places[below]) for above, below in self.fractions]

    def __call__(self, points: Mapping[str, Any]) -> Any:
        """Return an array with one row for each value; `points` has flat arrays of one length by name."""
        import numpy as np

        with np.errstate(all="ignore"):
            known = {name: at_points(name, points) for name in self.names}
            errors = {name: errors_at(name, known[name], points) for name in self.names}
            count = max((len(array) for array in points.values()), default=1)
            found = np.empty((len(self.fractions), count))
            for start in range(0, count, BLOCK):
                block = slice(start, min(start + BLOCK, count))
                self._fill(found[:, block], _part(known, block), _part(errors, block), _part(points, block))
        return found

    def _fill(self, found: Any, here: dict[str, Any], errors: dict[str, Any], points: dict[str, Any]) -> None:
        """Write the values at a block of points."""
        import numpy as np

        largest = {name: (np.max(np.abs(here[name])), np.max(errors[name])) for name in self.names}
        positive = {name for name in self.names if function_named(name) is None and np.min(here[name]) >= 0}
        parts = list[Any]([None] * len(self.summed))  # entries of one matrix share their denominator
        for value, pair, into in zip(self.values, self.pairs, found, strict=True):
            for place in pair:
                if parts[place] is None:
                    parts[place] = self.summed[place].at_block(here, errors, largest, positive, len(into))
            (above, *doubtful), (below, *others) = (parts[place] for place in pair)
            np.divide(above, below, out=into)
            uncertain = ~np.isfinite(into)
            if not into.all():  # nor is 0 certain where the denominator is too large
                uncertain |= (into == 0) & (above != 0)
            for points_of_doubt in (*doubtful, *others):
                uncertain[points_of_doubt] = True
            for index in np.flatnonzero(uncertain):
                into[index] = self._certain(value, {name: array[index] for name, array in points.items()}, into[index])

    def _certain(self, value: Scalar, point: Mapping[str, float], otherwise: float) -> float:
        """Return the double nearest to a value at a point, nan at a pole, and `otherwise` where it is too large."""
        if any(function_named(name) is not None or name == PI for name in value.names):
            return enclosed_value(value, {name: shortest(number) for name, number in point.items()}, otherwise)
        if value not in self.exact:
            self.exact[value] = list(value.numerator.each_term()), list(value.denominator.each_term())
        numbers = {name: fmpq(*Decimal(repr(float(point[name]))).as_integer_ratio()) for name in value.names}
        above, below = (_total(terms, numbers) for terms in self.exact[value])
        if below == 0:
            return float("nan")
        try:
            return int((above / below).p) / int((above / below).q)
        except OverflowError:
            return otherwise


def _part(arrays: Mapping[str, Any], block: slice) -> dict[str, Any]:
    return {name: values[block] if getattr(values, "ndim", 0) else values for name, values in arrays.items()}


class Summed(NamedTuple):
    """A nested polynomial and what its rounding errors depend on.

    `safe` are symbols for whose nonnegative values nothing cancels, None where there are none, or functions beside them;
    `operations` is the largest ratio of `error` and size where there are no functions.
    """

    polynomial: Polynomial
    names: frozenset[str]
    safe: frozenset[str] | None
    operations: int

    @classmethod
    def of(cls, polynomial: Polynomial) -> Summed:
        """Return what the rounding errors of a polynomial depend on."""
        names, signs = set[str](), list[bool]()
        left: list[Polynomial] = [polynomial]
        while left:
            part = left.pop()
            if isinstance(part, Nested):
                names.add(part.name)
                left += [part.high, part.low]
            elif part:
                signs.append(part > 0)
        safe = frozenset(names) if len(set(signs)) < 2 else None
        safe = frozenset() if len(signs) < 2 else safe
        plain = all(function_named(name) is None for name in names)
        return cls(polynomial, frozenset(names), safe if plain else None, _operations(polynomial) if plain else 0)

    def at_block(self, here: Any, errors: Any, largest: Any, positive: set[str], count: int) -> tuple[Any, ...]:
        """Return the values at a block of points, and the points where they are uncertain if there may be any."""
        value = evaluated(self.polynomial, here)
        if self.safe is not None and self.safe <= positive:
            return (value,)
        return value, self.uncertain(value, here, errors, largest, count)

    def uncertain(self, value: Any, here: Any, errors: Any, largest: Any, count: int) -> Any:
        """Return the points where the error may be too large, from its bound at the largest values first."""
        import numpy as np

        size = np.abs(value)
        scales, passed = ({name: largest[name][i] for name in self.names} for i in (0, 1))
        least = error(self.polynomial, scales, passed)[1] / _CERTAIN
        certain = size >= least
        if np.all(certain):
            return np.zeros(0, dtype=int)
        where = np.flatnonzero(~np.broadcast_to(certain, (count,)))
        part: Any = where if 2 * len(where) < count else np.s_[:]  # a slice copies nothing
        few = {name: np.abs(_part_of(here[name], part)) for name in self.names}
        if self.operations:
            bound = self.operations * sizes(self.polynomial, few)
        else:
            bound = error(self.polynomial, few, {name: _part_of(errors[name], part) for name in few})[1]
        found = ~(_part_of(size, part) * _CERTAIN >= bound)
        return where[np.broadcast_to(found, where.shape)] if part is where else np.broadcast_to(found, (count,))


def _part_of(values: Any, where: Any) -> Any:
    return values[where] if getattr(values, "ndim", 0) else values


def _operations(polynomial: Polynomial) -> int:
    """Return the largest ratio of `error` and size of a polynomial in symbols alone."""
    if not isinstance(polynomial, Nested):
        return 1
    high, _, power, low = polynomial
    own = _operations(high) + 1 + power
    return own if low == 0.0 else max(own, _operations(low)) + 1


def error(polynomial: Polynomial, scales: Mapping[str, Any], errors: Mapping[str, Any]) -> tuple[Any, Any]:
    """Return Σ |c| Π |x|^k and, in units of 2⁻⁵³, the error of the nested form: it grows with scales and errors."""
    if not isinstance(polynomial, Nested):
        return abs(polynomial), abs(polynomial)
    high, name, power, low = polynomial
    size, wrong = error(high, scales, errors)
    below = scales[name] ** (power - 1) if power > 1 else 1.0
    wrong = below * (wrong * scales[name] + size * (scales[name] + power * errors[name]))
    size = size * below * scales[name]
    if low == 0.0:
        return size, wrong
    other, other_wrong = error(low, scales, errors)
    size = size + other
    return size, wrong + other_wrong + size


def errors_at(name: str, value: Any, points: Mapping[str, Any]) -> Any:
    """Return the error of a generator in units of 2⁻⁵³: that of its rounding, and that of its argument passed on."""
    import numpy as np

    size, function = np.abs(value), function_named(name)
    if function is None or function.kind not in _ENCLOSED or is_number(function.argument):
        return size
    own = {each: at_points(each, points) for each in function.argument.names}
    passed = {each: errors_at(each, own[each], points) for each in own}
    scales = {each: np.abs(values) for each, values in own.items()}
    parts = [nested(function.argument.numerator), nested(function.argument.denominator)]
    (_, above), (_, below) = (error(part, scales, passed) for part in parts)
    top, bottom = (np.abs(evaluated(part, own)) for part in parts)
    moved = above / bottom + top / bottom * (1 + below / bottom)
    match function.kind:
        case "sqrt":
            return size + moved / (2 * size)
        case "exp" | "cosh":
            return size * (1 + moved)
        case "sin":
            return size + moved
        case "cos":
            return size + moved * np.minimum(moved, 1)
    return size + (size + 1) * moved


# What is uncertain in double precision.


def enclosed_value(value: Scalar, point: Mapping[str, Fraction], otherwise: float) -> float:
    """Return the double nearest to a value with functions at a point, nan at a pole, `otherwise` where it is too large."""
    try:
        for bits in (*_BITS, _MOST_BITS):
            with Precision(bits):
                ball = _ball_at(value, point)
                if not ball.is_finite():
                    continue
                if ball.abs_lower() > _LARGEST:
                    return otherwise
                found = _double(ball) if ball.abs_upper() < _LARGEST else None
            if found is not None:
                return found
    except (ArithmeticError, ValueError):
        pass
    try:
        return nearest_double(substitute(value, {name: Scalar.of(number) for name, number in point.items()}))
    except (ArithmeticError, ValueError, InputError):
        return float("nan")


def _total(terms: _Terms, numbers: Mapping[str, fmpq]) -> fmpq:
    """Return the value of a polynomial at rational numbers."""
    total = fmpq(0)
    for coefficient, powers in terms:
        term = fmpq(coefficient)
        for name, power in powers:
            term *= numbers[name] ** power
        total += term
    return total


def _ball_at(value: Scalar, point: Mapping[str, Fraction]) -> arb:
    """Return an enclosure of a value at a point, at the precision in use; raises `NotWritten` for sums over roots."""
    names = {name: _generator_at(name, point) for name in value.names}
    above, below = (polynomial_ball(part, names) for part in (value.numerator, value.denominator))
    return above / below


def _generator_at(name: str, point: Mapping[str, Fraction]) -> arb:
    function = function_named(name)
    if function is None:
        return arb.pi() if name == PI else arb(point[name].numerator) / point[name].denominator
    if is_number(function.argument):
        return _generator(name)
    if function.kind not in _ENCLOSED:
        raise NotWritten(name)
    enclosed: arb = getattr(_ball_at(function.argument, point), function.kind)()
    return enclosed
