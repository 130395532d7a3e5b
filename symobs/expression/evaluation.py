"""Second and third step: lark orders the tokens by a grammar, and the tree is computed from its leaves."""

from __future__ import annotations

import operator
from dataclasses import dataclass
from functools import cache
from math import isqrt
from typing import TYPE_CHECKING, Any

from lark import Lark, Token, UnexpectedToken
from lark.exceptions import VisitError
from lark.lexer import Lexer
from lark.visitors import Transformer_NonRecursive

from symobs.errors import BudgetExceeded, ShapeMismatch
from symobs.exact import Complex, Scalar, functions
from symobs.expression.budget import MOST_EXPONENT, Number, Parts, operation_size, power_size, work
from symobs.expression.plain import plain_rows
from symobs.expression.source import Source, shown
from symobs.expression.tokens import Tokeniser

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from typing import TypeAlias

    from symobs.expression.names import Scope

    Entry: TypeAlias = "Number | Grid"

MOST_CHARACTERS = 10_000
_SMALLER = "write something smaller, with a symbol in place of what is large"
EQUAL_ROWS = "give every row the same number of entries"

# A sign binds its power, -2^2 = -(2^2), and an exponent takes a sign, 2^-1; powers associate to the right.
GRAMMAR = r"""
row: sum (_COMMA sum)*
?sum: product | sum ADD product -> binary
?product: signed | product MULTIPLY signed -> binary
?signed: atom | ADD signed -> sign | atom POWER signed -> power
?atom: VALUE | _OPEN sum _CLOSE | LEFT row (_END row)* _RIGHT -> brackets | FUNCTION _OPEN sum _CLOSE -> call
%declare VALUE FUNCTION ADD MULTIPLY POWER LEFT _RIGHT _OPEN _CLOSE _COMMA _END
"""


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
        return _Evaluator(source, scope).transform(_parser().parse(Tokeniser(source, scope).run()))
    except UnexpectedToken as found:
        at_end = found.token.type == "$END"
        place = "at the end" if at_end else f'before "{shown(found.token)}"'
        position = len(text) if at_end else start(found.token)
        raise source.error(f'a number, a name or "(" is expected {place}', position, "write one there") from None
    except VisitError as wrapped:  # lark's wrapping of what the evaluator raised
        raise wrapped.orig_exc from None


class _Ready(Lexer):
    """Hands lark the tokens that are already made."""

    def __init__(self, _configuration: object) -> None:
        pass

    def lex(self, tokens: Any) -> Iterator[Token]:  # type: ignore[override]
        return iter(tokens)


@cache
def _parser() -> Lark:
    """Build the parser, once and only where a text is read: it takes longer than most texts."""
    return Lark(GRAMMAR, parser="lalr", lexer=_Ready, start="row", maybe_placeholders=False)


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


class _Evaluator(Transformer_NonRecursive[Token, "list[Entry]"]):
    """Computes a tree from its leaves: one method for each rule of the grammar, given the rule's parts.

    Invariant: no operation begins before `_spend` has bounded its result.
    """

    def __init__(self, source: Source, scope: Scope) -> None:
        super().__init__()
        self.source = source
        self.meter = scope.meter
        self.functions = scope.functions

    def VALUE(self, token: Token) -> Number:
        number: Number = token.value
        return number

    def row(self, entries: list[Entry]) -> list[Entry]:
        return entries

    def brackets(self, parts: tuple[Token, *tuple[list[Entry], ...]]) -> Entry:
        (left, *rows), unequal = parts, unequal_row(parts[1:])
        if unequal:
            raise self.source.error(unequal[0], start(left), EQUAL_ROWS, kind=ShapeMismatch, row=unequal[1])
        grid = Grid([[self._number(entry) for entry in row] for row in rows], start(left))
        return grid.rows[0][0] if grid.shape == (1, 1) else grid

    def binary(self, parts: tuple[Entry, Token, Entry]) -> Number:
        return self._combined(self._number(parts[0]), parts[1].value, self._number(parts[2]), parts[1])

    def sign(self, parts: tuple[Token, Entry]) -> Number:
        number = self._number(parts[1])
        return -number if parts[0].value == "-" else number

    def power(self, parts: tuple[Entry, Token, Entry]) -> Number:
        base, token, exponent = self._number(parts[0]), parts[1], self._exponent(self._number(parts[2]), parts[1])
        if isinstance(base, Complex):
            return self._complex_power(base, exponent, token)
        if exponent < 0:
            self._require_nonzero(base, token)
        self._spend(power_size(base, exponent), token)
        return base**exponent

    def call(self, parts: tuple[Token, Entry]) -> Number:
        """Return sqrt of the square of a rational number, the one call with a value in the field.

        Where functions of time are asked for, a function of a real argument is a generator of its own.
        """
        function, number = parts[0].value, self._number(parts[1])
        if self.functions:
            return self._function(function, number, parts[0])
        instead = "sqrt of the square of a rational number is possible; for other constants declare a symbol"
        if function != "sqrt":
            raise self.source.error(f"{function} has no exact value here", start(parts[0]), instead)
        if isinstance(number, Complex) or not number.is_constant or number.fraction() < 0:
            raise self.source.error("sqrt of this has no exact value here", start(parts[0]), instead)
        square = number.fraction()
        above, below = isqrt(square.numerator), isqrt(square.denominator)
        if (above**2, below**2) != (square.numerator, square.denominator):
            raise self.source.error(f"sqrt({shown(str(square))}) is not rational", start(parts[0]), instead)
        return Scalar.rational(above, below)

    def _function(self, name: str, argument: Number, token: Token) -> Scalar:
        if isinstance(argument, Complex):
            raise self.source.error(f"{name} of a complex number", start(token), "write it with sin and cos")
        if name != "sqrt":
            return functions.function(name, argument)
        if argument.is_constant and argument.fraction() < 0:
            raise self.source.error("sqrt of a negative number", start(token), "write sin and cos of a real argument")
        return argument if argument.is_zero else functions.square_root(argument)

    def _number(self, entry: Entry) -> Number:
        if isinstance(entry, Grid):
            message = "a matrix stands inside an expression or inside another matrix"
            raise self.source.error(message, entry.position, "write one pair of brackets around all rows: [1 0; 0 1]")
        return entry

    def _exponent(self, value: Number, token: Token) -> int:
        if isinstance(value, Complex) or not value.is_constant or value.fraction().denominator != 1:
            message = f"the exponent {shown(str(value))} is not an integer"
            raise self.source.error(message, start(token), "exponents are integers; write sqrt( ) for a root")
        exponent = int(value.fraction())
        if abs(exponent) > MOST_EXPONENT:
            message = f"the exponent is beyond {MOST_EXPONENT}"
            raise self.source.error(message, start(token), _SMALLER, kind=BudgetExceeded)
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
            raise self.source.error("division by zero", start(token), "write a denominator that is not 0")

    def _spend(self, sizes: Parts, token: Token, times: int = 1) -> None:
        excess = self.meter.charge(times * work(*sizes), sizes)
        if excess:
            raise self.source.error(f"this would build {excess}", start(token), _SMALLER, kind=BudgetExceeded)


def start(token: Token) -> int:
    """Return where a token begins in the text."""
    return token.start_pos or 0
