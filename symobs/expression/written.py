"""A fraction as it is written: numerator and denominator with what they have in common, which values do not show."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Scalar
from symobs.expression.evaluation import Evaluator, steps_of
from symobs.expression.names import Scope
from symobs.record import dataclass

if TYPE_CHECKING:
    from symobs.expression.budget import Number
    from symobs.expression.names import Names
    from symobs.expression.tokens import Token

_ONE = Scalar.of(1)


@dataclass(frozen=True)
class Fraction:
    """above / below, neither of which is reduced by the other; both are polynomials."""

    above: Number
    below: Number

    def __neg__(self) -> Fraction:
        return Fraction(-self.above, self.below)


def parse_fraction(text: str, names: Names, *, variable: str, where: str) -> tuple[Scalar, Scalar] | None:
    """Return numerator and denominator of a text as they are written, brought over the least common denominator of sums.

    None where they are complex or no polynomials in every name.  Raises what `parse_scalar` raises.
    """
    scope = Scope.of(names, variable, where)
    source, steps = steps_of(text, scope, where)
    (entry,) = _Written(source, scope).entries(steps)
    found = _fraction(entry)
    above, below = found.above, found.below
    if not isinstance(above, Scalar) or not isinstance(below, Scalar):
        return None
    return above, below


def _fraction(value: Any) -> Fraction:
    return value if isinstance(value, Fraction) else Fraction(value, _ONE)


class _Written(Evaluator):
    """Computes with fractions that are not reduced; every operation on their parts is charged for."""

    def _combined(self, left: Any, token: Token, right: Any, sign: str = "") -> Any:
        one, other, sign = _fraction(left), _fraction(right), sign or token
        if sign == "*":
            return Fraction(self._of(one.above, "*", other.above, token), self._of(one.below, "*", other.below, token))
        if sign == "/":
            if isinstance(other.above, Scalar):
                self._require_nonzero(other.above, token)
            return Fraction(self._of(one.above, "*", other.below, token), self._of(one.below, "*", other.above, token))
        ratio = self._of(one.below, "/", other.below, token)
        if isinstance(ratio, Complex):
            mine, theirs = other.below, one.below
        else:
            mine, theirs = ratio.denominator, ratio.numerator
        left, right = self._of(one.above, "*", mine, token), self._of(other.above, "*", theirs, token)
        return Fraction(self._of(left, sign, right, token), self._of(one.below, "*", mine, token))

    def _of(self, left: Number, sign: str, right: Number, token: Token) -> Number:
        return super()._combined(left, token, right, sign)

    def _power(self, base: Any, token: Token, value: Any) -> Any:
        exponent, fraction = self._exponent(self._value(value, token), token), _fraction(base)
        above, below = (
            super(_Written, self)._power(part, token, Scalar.of(abs(exponent)))
            for part in (fraction.above, fraction.below)
        )
        if exponent >= 0:
            return Fraction(_value_of(above), _value_of(below))
        if isinstance(above, Scalar):
            self._require_nonzero(above, token)
        return Fraction(_value_of(below), _value_of(above))

    def _call(self, function: Token, number: Any) -> Any:
        return super()._call(function, self._value(number, function))

    def _value(self, number: Any, token: Token) -> Number:
        found = _fraction(number)
        return self._of(found.above, "/", found.below, token)


def _value_of(part: Any) -> Number:
    """Return a power of a polynomial, which the powers of complex ones come back as fractions of."""
    return part.above if isinstance(part, Fraction) else part
