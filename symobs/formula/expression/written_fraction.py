"""Unreduced fractions: numerator and denominator with their common factors, as written."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Scalar
from symobs.formula.expression.evaluation import Evaluator, MatrixRows, trees_of
from symobs.formula.expression.names import Scope
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from symobs.formula.expression.names import Names
    from symobs.formula.expression.source import Number
    from symobs.formula.expression.syntax import SyntaxNode

_ONE = Scalar.of(1)


@dataclass
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
    ((found,),) = parse_fractions(text, names, variable=variable, where=where)
    return found


def parse_fractions(text: str, names: Names, *, variable: str, where: str) -> list[list[tuple[Scalar, Scalar] | None]]:
    """Return the same of every entry of a matrix; of a text without brackets that of its one entry."""
    scope = Scope.of(names, variable, where, functions=True)
    source, (tree,) = trees_of(text, scope, where)
    found: Any = _Written(source, scope).entry(tree)
    rows = found.rows if isinstance(found, MatrixRows) else [[found]]
    return [[_parts(_fraction(entry)) for entry in row] for row in rows]


def _parts(fraction: Fraction) -> tuple[Scalar, Scalar] | None:
    above, below = fraction.above, fraction.below
    if not isinstance(above, Scalar) or not isinstance(below, Scalar):
        return None
    return above, below


def _fraction(value: Any) -> Fraction:
    return value if isinstance(value, Fraction) else Fraction(value, _ONE)


class _Written(Evaluator):
    """Arithmetic of unreduced fractions within the budget."""

    def _combined(self, left: Any, place: int, right: Any, sign: str) -> Any:
        one, other = _fraction(left), _fraction(right)
        if sign == "*":
            return Fraction(self._of(one.above, "*", other.above, place), self._of(one.below, "*", other.below, place))
        if sign == "/":
            if isinstance(other.above, Scalar):
                self._require_nonzero(other.above, place)
            return Fraction(self._of(one.above, "*", other.below, place), self._of(one.below, "*", other.above, place))
        ratio = self._of(one.below, "/", other.below, place)
        if isinstance(ratio, Complex):
            mine, theirs = other.below, one.below
        else:
            mine, theirs = ratio.denominator, ratio.numerator
        left, right = self._of(one.above, "*", mine, place), self._of(other.above, "*", theirs, place)
        return Fraction(self._of(left, sign, right, place), self._of(one.below, "*", mine, place))

    def _of(self, left: Number, sign: str, right: Number, place: int) -> Number:
        return super()._combined(left, place, right, sign)

    def _power(self, base: Any, place: int, value: Any) -> Any:
        exponent, fraction = self._exponent(self._reduced(value, place), place), _fraction(base)
        above, below = (
            super(_Written, self)._power(part, place, Scalar.of(abs(exponent)))
            for part in (fraction.above, fraction.below)
        )
        if exponent >= 0:
            return Fraction(_value_of(above), _value_of(below))
        if isinstance(above, Scalar):
            self._require_nonzero(above, place)
        return Fraction(_value_of(below), _value_of(above))

    def _call(self, call: SyntaxNode, number: Any) -> Any:
        return super()._call(call, self._reduced(number, call.places[0]))

    def _reduced(self, number: Any, place: int) -> Number:
        found = _fraction(number)
        return self._of(found.above, "/", found.below, place)


def _value_of(part: Any) -> Number:
    """Return a power of a polynomial, which the powers of complex ones come back as fractions of."""
    return part.above if isinstance(part, Fraction) else part
