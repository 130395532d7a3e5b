"""Third step: the steps are computed with exact values."""

from __future__ import annotations

import operator
import re
from math import isqrt
from typing import TYPE_CHECKING, Any

from symobs.errors import BudgetExceeded, ShapeMismatch
from symobs.exact import Complex, Scalar, functions
from symobs.expression.budget import MOST_EXPONENT, Number, Parts, operation_size, power_size, work
from symobs.expression.ordering import postfix
from symobs.expression.plain import plain_rows
from symobs.expression.source import Source, shown
from symobs.expression.tokens import Tokeniser
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import TypeAlias

    from symobs.expression.names import Scope
    from symobs.expression.ordering import Step
    from symobs.expression.tokens import Token

    Entry: TypeAlias = "Number | Grid"

MOST_CHARACTERS = 10_000
_SMALLER = "write something smaller, with a symbol in place of what is large"
EQUAL_ROWS = "give every row the same number of entries"
#: Outside brackets `2 g` is a product, inside it is two entries.
_SPACED_PRODUCT = re.compile(r"([0-9]) +([A-Za-z(])")


def read(text: str, scope: Scope, where: str) -> list[Entry]:
    """Return the entries of a text, set apart by commas; raises ExpressionError, BudgetExceeded, ShapeMismatch."""
    source = Source(text, where)
    if len(text) > MOST_CHARACTERS:
        message = f"the expression has {len(text)} characters, more than {MOST_CHARACTERS}"
        raise source.error(message, 0, _SMALLER, kind=BudgetExceeded)
    plain = plain_rows(text, scope)
    if plain is not None:
        rows, bracketed = plain
        return [Grid(rows, text.index("["))] if bracketed and (len(rows), len(rows[0])) != (1, 1) else list(rows[0])
    return Evaluator(source, scope).entries(_steps(source, scope))


def steps_of(text: str, scope: Scope, where: str) -> tuple[Source, list[Step]]:
    """Return the steps that compute a text which `read` has read."""
    source = Source(text, where)
    return source, _steps(source, scope)


def _steps(source: Source, scope: Scope) -> list[Step]:
    return postfix(Tokeniser(source, scope).run(), source)


@dataclass(frozen=True)
class Grid:
    """The rows of a matrix, all of one length, and where its bracket opens."""

    rows: Sequence[Sequence[Number]]
    position: int

    @property
    def shape(self) -> tuple[int, int]:
        """The number of rows and of columns."""
        return len(self.rows), len(self.rows[0])


def unequal_row(rows: Sequence[Sequence[object]]) -> tuple[str, int] | None:
    """Return what to say of the first row whose length is not that of row 1, and its number."""
    for number, row in enumerate(rows, start=1):
        if len(row) != len(rows[0]):
            entries = "1 entry" if len(row) == 1 else f"{len(row)} entries"
            return f"row {number} has {entries}, but row 1 has {len(rows[0])}", number
    return None


_OPERATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "+": operator.add,
    "-": operator.sub,
    "*": operator.mul,
    "/": operator.truediv,
}
#: What one operation with complex numbers takes of operations with scalars.
_SCALAR_OPERATIONS = 12


class Evaluator:
    """Computes steps on a stack.  Invariant: no operation begins before `_spend` has bounded its result."""

    def __init__(self, source: Source, scope: Scope) -> None:
        self.source = source
        self.meter = scope.meter
        self.functions = scope.functions
        self.names = scope.names or {}

    def entries(self, steps: Sequence[Step]) -> list[Entry]:
        """Return the entries that the steps leave."""
        stack: list[Entry] = []
        for kind, token, rows in steps:
            if kind == "VALUE":
                stack.append(token.value)  # type: ignore[arg-type]  # the tokeniser gave it one
            elif kind == "LEFT":
                stack[len(stack) - sum(rows) :] = [self._matrix(stack[len(stack) - sum(rows) :], rows, token)]
            elif kind == "sign":
                operand = self._number(stack.pop())
                stack.append(-operand if token == "-" else operand)  # noqa: S105 - a token of the text
            elif kind == "FUNCTION":
                stack.append(self._call(token, self._number(stack.pop())))
            else:
                right, left = stack.pop(), self._number(stack.pop())
                operation = self._power if kind == "POWER" else self._combined
                stack.append(operation(left, token, self._number(right)))
        return stack

    def _matrix(self, entries: Sequence[Entry], lengths: Sequence[int], left: Token) -> Entry:
        following = iter(entries)
        rows = [[next(following) for _ in range(length)] for length in lengths]
        unequal = unequal_row(rows)
        if unequal:
            spaced = _SPACED_PRODUCT.search(self.source.text)
            meant = f"; a space sets entries apart, so write {spaced[1]}*{spaced[2]}… for a product" if spaced else ""
            raise self.source.error(unequal[0], left.start, EQUAL_ROWS + meant, kind=ShapeMismatch, row=unequal[1])
        grid = Grid([[self._number(entry) for entry in row] for row in rows], left.start)
        return grid.rows[0][0] if grid.shape == (1, 1) else grid

    def _power(self, base: Number, token: Token, value: Number) -> Number:
        exponent = self._exponent(value, token)
        if isinstance(base, Complex):
            return self._complex_power(base, exponent, token)
        if exponent < 0:
            self._require_nonzero(base, token)
        self._spend(power_size(base, exponent), token)
        return base**exponent

    def _call(self, function: Token, number: Number) -> Number:
        """Return sqrt of the square of a rational number, the one call with a value in the field.

        Where functions of time are asked for, a function of a real argument is a generator of its own.
        """
        if self.functions:
            return self._function(function, number)
        instead = "sqrt of the square of a rational number is possible; for other constants declare a symbol"
        if function != "sqrt":
            raise self.source.error(f"{function} has no exact value here", function.start, instead)
        if isinstance(number, Complex) or not number.is_constant or number.fraction() < 0:
            raise self.source.error("sqrt of this has no exact value here", function.start, instead)
        square = number.fraction()
        above, below = isqrt(square.numerator), isqrt(square.denominator)
        if (above**2, below**2) != (square.numerator, square.denominator):
            raise self.source.error(f"sqrt({shown(str(square))}) is not rational", function.start, instead)
        return Scalar.rational(above, below)

    def _function(self, name: Token, argument: Number) -> Scalar:
        if isinstance(argument, Complex):
            raise self.source.error(f"{name} of a complex number", name.start, "write it with sin and cos")
        try:
            if name != "sqrt":
                return functions.function(str(name), argument)
            return argument if argument.is_zero else functions.square_root(self._with_one_root(name, argument))
        except functions.NotWritten as error:
            raise self.source.error(str(error), name.start, "declare a symbol for it") from None
        except ZeroDivisionError:
            instead = "write sin and cos of a real argument"
            raise self.source.error("sqrt of a negative number", name.start, instead) from None

    def _with_one_root(self, name: Token, radicand: Scalar) -> Scalar:
        """Return the radicand; sqrt(a^2) is a or -a, which only the sign of a can tell."""
        for factor, power in radicand.factors()[1]:
            if power % 4 == 2 and self.names.get(str(factor)) not in {"positive", "nonnegative"}:
                message = f"sqrt of a square: {shown(str(factor))} may be negative"
                raise self.source.error(message, name.start, "write it without sqrt, or declare the symbol positive")
        return radicand

    def _number(self, entry: Entry) -> Number:
        if isinstance(entry, Grid):
            message = "a matrix stands inside an expression or inside another matrix"
            raise self.source.error(message, entry.position, "write one pair of brackets around all rows: [1 0; 0 1]")
        return entry

    def _exponent(self, value: Number, token: Token) -> int:
        if isinstance(value, Complex) or not value.is_constant or value.fraction().denominator != 1:
            message = f"the exponent {shown(str(value))} is not an integer"
            raise self.source.error(message, token.start, "exponents are integers; write sqrt( ) for a root")
        exponent = int(value.fraction())
        if abs(exponent) > MOST_EXPONENT:
            message = f"the exponent is beyond {MOST_EXPONENT}"
            raise self.source.error(message, token.start, _SMALLER, kind=BudgetExceeded)
        return exponent

    def _combined(self, left: Number, token: Token, right: Number, sign: str = "") -> Number:
        """Return the result of one operation; `sign` says which where the token does not."""
        sign = sign or token
        if sign == "/":
            self._require_nonzero(right, token)
        sizes = operation_size(sign, left, right)
        if isinstance(left, Scalar) and isinstance(right, Scalar):
            self._spend(sizes, token)
            real: Scalar = _OPERATIONS[sign](left, right)
            return real
        self._spend(sizes, token, _SCALAR_OPERATIONS)
        result: Complex = _OPERATIONS[sign](Complex.of(left), Complex.of(right))
        return result.real if result.is_real else result

    def _complex_power(self, base: Number, exponent: int, token: Token) -> Number:
        if exponent < 0:
            base, exponent = self._combined(Scalar.of(1), token, base, "/"), -exponent
        power: Number = Scalar.of(1)
        for digit in f"{exponent:b}":
            power = self._combined(power, token, power, "*")
            if digit == "1":
                power = self._combined(power, token, base, "*")
        return power

    def _require_nonzero(self, value: Number, token: Token) -> None:
        if isinstance(value, Scalar) and value.is_zero:
            raise self.source.error("division by zero", token.start, "write a denominator that is not 0")

    def _spend(self, sizes: Parts, token: Token, times: int = 1) -> None:
        excess = self.meter.charge(times * work(*sizes), sizes)
        if excess:
            raise self.source.error(f"this would build {excess}", token.start, _SMALLER, kind=BudgetExceeded)
