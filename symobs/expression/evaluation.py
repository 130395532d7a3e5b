"""Third step: what the ordered tokens come to, in exact values."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from math import isqrt
from typing import TYPE_CHECKING, Any

from symobs.errors import BudgetExceeded, ShapeMismatch
from symobs.exact import Complex, Scalar, functions
from symobs.expression.budget import MOST_EXPONENT, Number, Parts, operation_size, power_size, work
from symobs.expression.order import Unexpected, in_order
from symobs.expression.plain import plain_rows
from symobs.expression.source import Source, shown
from symobs.expression.tokens import Tokeniser

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from typing import TypeAlias

    from symobs.expression.names import Scope
    from symobs.expression.tokens import Token

    Entry: TypeAlias = "Number | Grid"

MOST_CHARACTERS = 10_000
_SMALLER = "write something smaller, with a symbol in place of what is large"
EQUAL_ROWS = "give every row the same number of entries"


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
    try:
        ordered = in_order(Tokeniser(source, scope).run())
    except Unexpected as found:
        place = "at the end" if found.token is None else f'before "{shown(found.token)}"'
        position = len(text) if found.token is None else found.token.start_pos
        raise source.error(f'a number, a name or "(" is expected {place}', position, "write one there") from None
    return _Evaluator(source, scope).run(ordered)


@dataclass(frozen=True, slots=True)
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


class _Evaluator:
    """Computes the entries of a text: operands are laid on a stack, operations take them from it.

    Invariant: no operation begins before `_spend` has bounded its result.
    """

    def __init__(self, source: Source, scope: Scope) -> None:
        self.source = source
        self.meter = scope.meter
        self.functions = scope.functions

    def run(self, ordered: Sequence[tuple[str, Token]]) -> list[Entry]:
        """Return what stands between the commas outside brackets."""
        stack: list[Any] = []
        rows: list[list[list[Entry]]] = [[[]]]
        for kind, token in ordered:
            match kind:
                case "VALUE":
                    stack.append(token.value)
                case "ADD" | "MULTIPLY":
                    right, left = stack.pop(), stack.pop()
                    stack.append(self._combined(self._number(left), token, self._number(right), token))
                case "SIGN":
                    number = self._number(stack.pop())
                    stack.append(-number if token.startswith("-") else number)
                case "POWER":
                    exponent, base = stack.pop(), stack.pop()
                    stack.append(self.power(base, token, exponent))
                case "FUNCTION":
                    stack.append(self.call(token, stack.pop()))
                case "LEFT":
                    rows.append([[]])
                    stack.append(token)
                case _:
                    rows[-1][-1].append(stack.pop())
                    if kind == "_END":
                        rows[-1].append([])
                    elif kind == "_RIGHT":
                        stack.append(self.brackets(stack.pop(), rows.pop()))
        return [*rows[0][0], stack.pop()]

    def brackets(self, left: Token, rows: list[list[Entry]]) -> Entry:
        unequal = unequal_row(rows)
        if unequal:
            raise self.source.error(unequal[0], left.start_pos, EQUAL_ROWS, kind=ShapeMismatch, row=unequal[1])
        grid = Grid([[self._number(entry) for entry in row] for row in rows], left.start_pos)
        return grid.rows[0][0] if grid.shape == (1, 1) else grid

    def power(self, below: Entry, token: Token, above: Entry) -> Number:
        base, exponent = self._number(below), self._exponent(self._number(above), token)
        if isinstance(base, Complex):
            return self._complex_power(base, exponent, token)
        if exponent < 0:
            self._require_nonzero(base, token)
        self._spend(power_size(base, exponent), token)
        return base**exponent

    def call(self, token: Token, argument: Entry) -> Number:
        """Return sqrt of the square of a rational number, the one call with a value in the field.

        Where functions of time are asked for, a function of a real argument is a generator of its own.
        """
        function, number = str(token), self._number(argument)
        if self.functions:
            return self._function(function, number, token)
        instead = "sqrt of the square of a rational number is possible; for other constants declare a symbol"
        if function != "sqrt":
            raise self.source.error(f"{function} has no exact value here", token.start_pos, instead)
        if isinstance(number, Complex) or not number.is_constant or number.fraction() < 0:
            raise self.source.error("sqrt of this has no exact value here", token.start_pos, instead)
        square = number.fraction()
        above, below = isqrt(square.numerator), isqrt(square.denominator)
        if (above**2, below**2) != (square.numerator, square.denominator):
            raise self.source.error(f"sqrt({shown(str(square))}) is not rational", token.start_pos, instead)
        return Scalar.rational(above, below)

    def _function(self, name: str, argument: Number, token: Token) -> Scalar:
        if isinstance(argument, Complex):
            raise self.source.error(f"{name} of a complex number", token.start_pos, "write it with sin and cos")
        if name != "sqrt":
            return functions.function(name, argument)
        if argument.is_constant and argument.fraction() < 0:
            raise self.source.error(
                "sqrt of a negative number", token.start_pos, "write sin and cos of a real argument"
            )
        return argument if argument.is_zero else functions.square_root(argument)

    def _number(self, entry: Entry) -> Number:
        if isinstance(entry, Grid):
            message = "a matrix stands inside an expression or inside another matrix"
            raise self.source.error(message, entry.position, "write one pair of brackets around all rows: [1 0; 0 1]")
        return entry

    def _exponent(self, value: Number, token: Token) -> int:
        if isinstance(value, Complex) or not value.is_constant or value.fraction().denominator != 1:
            message = f"the exponent {shown(str(value))} is not an integer"
            raise self.source.error(message, token.start_pos, "exponents are integers; write sqrt( ) for a root")
        exponent = int(value.fraction())
        if abs(exponent) > MOST_EXPONENT:
            message = f"the exponent is beyond {MOST_EXPONENT}"
            raise self.source.error(message, token.start_pos, _SMALLER, kind=BudgetExceeded)
        return exponent

    def _combined(self, left: Number, sign: str, right: Number, token: Token) -> Number:
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
            base, exponent = self._combined(Scalar.of(1), "/", base, token), -exponent
        power: Number = Scalar.of(1)
        for digit in f"{exponent:b}":
            power = self._combined(power, "*", power, token)
            if digit == "1":
                power = self._combined(power, "*", base, token)
        return power

    def _require_nonzero(self, value: Number, token: Token) -> None:
        if isinstance(value, Scalar) and value.is_zero:
            raise self.source.error("division by zero", token.start_pos, "write a denominator that is not 0")

    def _spend(self, sizes: Parts, token: Token, times: int = 1) -> None:
        excess = self.meter.charge(times * work(*sizes), sizes)
        if excess:
            raise self.source.error(f"this would build {excess}", token.start_pos, _SMALLER, kind=BudgetExceeded)
