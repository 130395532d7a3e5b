"""Third step: evaluation of the tree with exact values."""

from __future__ import annotations

import re
from itertools import chain
from math import floor, prod
from operator import add, mul, sub, truediv
from typing import TYPE_CHECKING, Any

from symobs.exact import Complex, Field, Scalar
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.algebraic.real_algebraic import root_of_fraction
from symobs.exact.algebraic.rounded_decimals import root_in_field, written_out
from symobs.exact.core import generators
from symobs.exact.core.generators import PI
from symobs.exact.time_functions.matrix_power import PowerOf
from symobs.formula.expression.names import FUNCTIONS, NAME, refusal
from symobs.formula.expression.source import (
    MOST_EXPONENT,
    Number,
    Parts,
    Source,
    operation_size,
    power_size,
    shown,
    work,
)
from symobs.formula.expression.syntax import operands_first, parse
from symobs.formula.expression.tokenizer import LEADING_ZERO, Tokeniser
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from fractions import Fraction
    from typing import TypeAlias

    from symobs.formula.expression.names import Scope
    from symobs.formula.expression.syntax import SyntaxNode

    Entry: TypeAlias = "Number | MatrixRows"


# The fast path for plain texts: numbers and names with signs, products and quotients, and a+bi, without spaces.
#
# It reads a text or leaves it alone: whatever is wrong, or could mean something else, is for the grammar to say.


_NUMBER = r"[0-9]{1,18}(?:\.[0-9]{1,18})?"
_ATOM = rf"(?:[A-Za-z][A-Za-z0-9_]*|{_NUMBER})"
_CELL = re.compile(rf"[+-]?{_ATOM}(?:[*/]{_ATOM}){{0,8}}")
_SIGNED = rf"[+-]?{_NUMBER}(?:/{_NUMBER})?"
#: A real part, if any, and an imaginary one: -1+3/2i.
_COMPLEX = re.compile(rf"(?:({_SIGNED})(?=[+-]))?([+-]?)({_NUMBER}(?:/{_NUMBER})?)?([A-Za-z])")
_ATOMS = re.compile(rf"([*/+-]?)({_ATOM})")
_MOST_NAMES = 100


def plain_rows(text: str, scope: Scope) -> tuple[list[list[Number]], bool] | None:
    """Return rows of entries, and whether they are in brackets; None if the text is not plain."""
    inside = text.strip(" ")
    if (scope.rounding and "." in inside) or LEADING_ZERO.search(inside):
        return None
    bracketed = inside[:1] == "[" and inside[-1:] == "]"
    if bracketed:
        lines = [line.split() for line in inside[1:-1].split(";")]
    else:
        lines = [[cell.strip(" ") for cell in inside.split(",")]]
    if "\n" in inside or "\r" in inside or len({len(line) for line in lines}) != 1 or not lines[0]:
        return None
    if not all(map(_CELL.fullmatch, chain.from_iterable(lines))):
        return None if bracketed else _complex_numbers(lines[0], scope)
    names = set(NAME.findall(inside))
    if len(names) > _MOST_NAMES or not all(_is_symbol(name, scope) for name in names):
        return None
    field = Field.of(names) if scope.context is None else scope.context
    known = {name: Scalar.generator(field, name) for name in names}
    try:
        return [[known.get(cell) or _value(_ATOMS.findall(cell), known) for cell in line] for line in lines], bracketed
    except ZeroDivisionError:
        return None


def _complex_numbers(cells: list[str], scope: Scope) -> tuple[list[list[Number]], bool] | None:
    """Return one row of numbers, some of them complex."""
    found: list[Number] = []
    for cell in cells:
        if _CELL.fullmatch(cell) and not NAME.search(cell):
            real, sign, size, unit = cell, "", "0", "i"
        elif parts := _COMPLEX.fullmatch(cell):
            real, sign, size, unit = parts[1] or "0", parts[2], parts[3] or "1", parts[4]
        else:
            return None
        if not scope.is_imaginary_unit(unit):
            return None
        try:
            values = [_value(_ATOMS.findall(text), {}) for text in (real, sign + size)]
        except ZeroDivisionError:
            return None
        found.append(Complex(*values) if values[1] else values[0])
    return [found], False


def _is_symbol(name: str, scope: Scope) -> bool:
    """Return whether a name is declared, or may be a symbol where every name may."""
    if name in FUNCTIONS or scope.is_imaginary_unit(name) or refusal(name) or (scope.poles and scope.unit_first(name)):
        return False
    return scope.names is None or (scope.declares(name) and scope.constant(name) is None)


def _value(cell: list[tuple[str, str]], known: dict[str, Scalar]) -> Scalar:
    """Return ± a * b / c …, from the left."""
    values = [known[atom] if atom in known else _number(atom) for _, atom in cell]
    total = -values[0] if cell[0][0] == "-" else values[0]
    for (operator, _), value in zip(cell[1:], values[1:], strict=True):
        total = total / value if operator == "/" else total * value
    return total


def _number(text: str) -> Scalar:
    whole, _, decimals = text.partition(".")
    return Scalar.rational(int(whole + decimals), 10 ** len(decimals))


MOST_CHARACTERS = 10_000
#: The highest degree of a root of a number.
_MOST_DEGREE = 12
_SMALLER = "write something smaller, with a symbol in place of what is large"


def read(text: str, scope: Scope, where: str) -> list[Entry]:
    """Return the comma-separated entries of a text; raises ExpressionError, BudgetExceeded, ShapeMismatch."""
    source = Source(text, where)
    if len(text) > MOST_CHARACTERS:
        message = f"the expression has {len(text)} characters, more than {MOST_CHARACTERS}"
        raise source.error(message, 0, _SMALLER, kind=BudgetExceeded)
    plain = plain_rows(text, scope)
    if plain is not None:
        rows, bracketed = plain
        is_matrix = bracketed and (len(rows), len(rows[0])) != (1, 1)
        return [MatrixRows(rows, text.index("["))] if is_matrix else list(rows[0])
    source, trees = trees_of(text, scope, where)
    evaluator = Evaluator(source, scope)
    return [evaluator.entry(tree) for tree in trees]


def trees_of(text: str, scope: Scope, where: str) -> tuple[Source, tuple[SyntaxNode, ...]]:
    """Return the trees of a text's entries, and where they stand."""
    source = Source(text, where)
    return source, parse(Tokeniser(source, scope).run(), source)


@dataclass
class MatrixRows:
    """The rows of a matrix, all of one length, and where its bracket opens."""

    rows: Sequence[Sequence[Number]]
    position: int

    @property
    def shape(self) -> tuple[int, int]:
        """The number of rows and of columns."""
        return len(self.rows), len(self.rows[0])


_OPERATIONS: dict[str, Callable[[Any, Any], Any]] = {
    "+": add,
    "-": sub,
    "*": mul,
    "/": truediv,
}


#: What one operation with complex numbers takes of operations with scalars.
_SCALAR_OPERATIONS = 12


def _degree_of_root(base: Scalar, exponent: Number) -> int:
    """Return q where a positive number is raised to p/q, of a low degree; else 0."""
    if isinstance(exponent, Complex) or not (exponent.is_constant and base.is_constant) or base.fraction() <= 0:
        return 0
    degree = exponent.fraction().denominator
    return degree if 1 < degree <= _MOST_DEGREE and abs(exponent.fraction().numerator) <= _MOST_DEGREE else 0


def _times_halved(exponent: Number) -> int:
    """Return n where an exponent is p/2ⁿ with an odd p and n from 1 to 4, else 0."""
    if not isinstance(exponent, Scalar) or not exponent.is_constant:
        return 0
    denominator = exponent.fraction().denominator
    return denominator.bit_length() - 1 if denominator in {2, 4, 8, 16} else 0


class Evaluator:
    """Evaluation of a tree on a stack.  Invariant: no operation begins before `_spend` has bounded its result."""

    def __init__(self, source: Source, scope: Scope) -> None:
        self.source = source
        self.meter = scope.meter
        self.functions, self.roots = scope.functions, scope.roots
        self.instant = "k" if scope.functions and scope.variable == "k" else ""
        self.names = scope.names or {}

    def entry(self, tree: SyntaxNode) -> Entry:
        """Return the value of a tree."""
        stack: list[Any] = []
        for node in operands_first(tree):
            start = len(stack) - len(node.parts)
            stack[start:] = [self._value(node, stack[start:])]
        (found,) = stack
        if PI in self.source.text and not self.functions:
            self._require_no_pi(found)
        return found  # type: ignore[no-any-return]

    def _require_no_pi(self, entry: Entry) -> None:
        """Raise ExpressionError where π is left: only as part of an argument it may be one of a number in the field."""
        numbers = [number for row in entry.rows for number in row] if isinstance(entry, MatrixRows) else [entry]
        parts = (part for number in numbers for part in (Complex.of(number).real, Complex.of(number).imaginary))
        if any(PI in part.names for part in parts):
            instead = "declare a symbol for it; cos(pi/6) and the like have square roots for their values"
            raise self.source.error('"pi" is no algebraic number', self.source.text.index(PI), instead)

    def _value(self, node: SyntaxNode, parts: list[Any]) -> Any:
        """Return the value of a node, given the values of its parts."""
        match node.kind:
            case "number":
                return node.value
            case "row":
                return parts
            case "block":
                grid = MatrixRows([[self._number(entry) for entry in row] for row in parts], node.places[0])
                return grid.rows[0][0] if grid.shape == (1, 1) else grid
            case "sum" | "product":
                sign = "+" if node.kind == "sum" else "*"
                total = parts[0]
                for part, place in zip(parts[1:], node.places, strict=True):
                    total = self._joined(total, place, part, sign)
                return total
            case "negative" if isinstance(parts[0], MatrixRows):
                return self._joined(Scalar.of(-1), node.places[0], parts[0], "*")
            case "quotient":
                return self._joined(parts[0], node.places[0], parts[1], "/")
        numbers = [self._number(part) for part in parts]
        match node.kind:
            case "negative":
                return -numbers[0]
            case "power":
                return self._power(numbers[0], node.places[0], numbers[1])
            case _:
                return self._call(node, numbers[0])

    def _joined(self, left: Entry, place: int, right: Entry, sign: str) -> Entry:
        """Return the result of one operation with numbers, or of a matrix and a number that multiplies or divides it."""
        if isinstance(left, MatrixRows) and sign in "*/" and not isinstance(right, MatrixRows):
            rows = [[self._combined(entry, place, right, sign) for entry in row] for row in left.rows]
            return MatrixRows(rows, left.position)
        if isinstance(right, MatrixRows) and sign == "*" and not isinstance(left, MatrixRows):
            return self._joined(right, place, left, sign)
        return self._combined(self._number(left), place, self._number(right), sign)

    def _power(self, base: Number, place: int, value: Number) -> Number:
        value = written_out(value) if isinstance(value, Scalar) else value  # an exponent is exact
        if self.functions and isinstance(base, Scalar) and (degree := _degree_of_root(base, value)):
            return root_of_fraction(base.fraction(), degree) ** int(Complex.of(value).real.fraction() * degree)
        if self.functions and isinstance(base, Scalar) and not base.is_constant and (times := _times_halved(value)):
            return self._power_of_root(base, place, Complex.of(value).real.fraction(), times)
        if self.instant and isinstance(value, Scalar) and self.instant in value.names:
            return self._power_in_steps(base, place, value)
        exponent = self._exponent(value, place)
        if isinstance(base, Complex):
            return self._complex_power(base, exponent, place)
        if exponent < 0:
            self._require_nonzero(base, place)
        self._spend(power_size(base, exponent), place)
        return base**exponent

    def _power_of_root(self, base: Scalar, place: int, exponent: Fraction, times: int) -> Number:
        """Return x^(p/2ⁿ) as x to a whole power, times powers of √x, √√x and so on."""
        found, root = self._power(base, place, Scalar.of(floor(exponent))), base
        binary = int((exponent - floor(exponent)) * 2**times)
        for step in range(1, times + 1):
            root = self._function("sqrt", place, root)
            if binary >> (times - step) & 1:
                found = self._combined(found, place, root, "*")
        return found

    def _power_in_steps(self, base: Number, place: int, value: Scalar) -> Number:
        """Return λ to the power m k + n, with numbers m and n, as a function of k."""
        slope, *rest = value.coefficients(self.instant)
        if len(rest) != 1 or isinstance(base, Complex) or self.instant in base.names:
            instead = "write λ**(m*k + n) with numbers m and n, and a real λ without k"
            raise self.source.error(f"the exponent {shown(str(value))} is no number of steps", place, instead)
        base = written_out(base)  # λᵏ of a rounded λ rounds nothing
        often, beyond = self._power(base, place, slope), self._power(base, place, rest[0])
        return self._combined(PowerOf.of("power", often), place, beyond, "*")  # type: ignore[arg-type]

    def _call(self, call: SyntaxNode, number: Number) -> Number:
        """Return the value of a call: sqrt of a number, cos and sin of a multiple of π.

        Where functions of time are asked for, a function of a real argument is a generator of its own.
        """
        function, place = call.text, call.places[0]
        if function == "sqrt" and (self.roots or not self.functions):
            return self._root(place, number)
        if self.functions:
            return self._function(function, place, number)
        turns = isinstance(number, Scalar) and (number.is_zero or number.names == {PI})
        if function in {"cos", "sin", "tan"} and turns and (number / Scalar.symbol(PI)).is_constant:  # type: ignore[operator]
            return self._function(function, place, number)
        instead = "roots of rational numbers, and cos and sin of pi/6, pi/4, pi/3, are possible; or declare a symbol"
        raise self.source.error(f"{function} has no exact value here", place, instead)

    def _root(self, place: int, number: Number) -> Number:
        """Return √number: of a number its value in a field with roots of primes, of others only where `roots` are read."""
        if isinstance(number, Complex):
            raise self.source.error("sqrt of a complex number", place, "write its real and imaginary part")
        if number.is_constant and number.fraction() < 0:
            return Complex(Scalar.of(0), generators.square_root(-number))
        if number.is_zero:
            return number
        known = root_in_field(number)
        if known is not None:
            return known
        instead = "sqrt of a rational number is possible; for other constants declare a symbol"
        if not self.roots:
            raise self.source.error("sqrt of this has no exact value here", place, instead)
        return self._square_root(place, number)

    def _function(self, name: str, place: int, argument: Number) -> Scalar:
        if isinstance(argument, Complex):
            raise self.source.error(f"{name} of a complex number", place, "write it with sin and cos")
        try:
            if name != "sqrt":
                return generators.function(name, argument)
            if argument.is_zero:
                return argument
            known = root_in_field(argument) if is_number(argument) else None
            return self._square_root(place, argument) if known is None else known
        except generators.NotWritten as error:
            raise self.source.error(str(error), place, "declare a symbol for it") from None
        except ZeroDivisionError:
            fault = "sqrt of a negative number" if name == "sqrt" else f"{name} has no value there"
            raise self.source.error(fault, place, "write what is real") from None

    def _square_root(self, place: int, radicand: Scalar) -> Scalar:
        """Return the root that is not negative: sqrt(a^2) is a or -a, decided by the signs of what stands in a."""
        unit, factors = radicand.factors()
        front = 1
        odd = [factor for factor, power in factors if power % 2]
        for factor, power in factors:
            if power % 4 < 2:  # an even power of it stands before the root
                continue
            side = self._side(factor)
            if odd == [factor] and unit.is_constant:  # which is real for one sign of it alone
                side = 1 if unit.fraction() > 0 else -1
            if not side:
                message = f"sqrt of a square: {shown(str(factor))} may be negative"
                raise self.source.error(message, place, "write it without sqrt, or declare the symbol positive")
            front *= side
        return generators.square_root(radicand) * front

    def _side(self, factor: Scalar) -> int:
        """Return the side of 0 on which a factor lies by the signs of its terms: 1, -1, or 0 where they do not say."""
        sides = set()
        for coefficient, powers in factor.terms():
            odd = [self._side_of(name) for name, power in powers if power % 2]
            sides.add(prod(odd, start=1 if coefficient > 0 else -1))
        return sides.pop() if len(sides) == 1 else 0

    def _side_of(self, name: str) -> int:
        found = generators.function_named(name)
        if found is not None:
            return int(found.kind in {"sqrt", "exp", "cosh"})
        sign = self.names.get(name)
        return int(sign in {"positive", "nonnegative"}) - int(sign in {"negative", "nonpositive"})

    def _number(self, entry: Entry) -> Number:
        if isinstance(entry, MatrixRows):
            message = "a matrix stands inside an expression or inside another matrix"
            raise self.source.error(message, entry.position, "write one pair of brackets around all rows: [1 0; 0 1]")
        return entry

    def _exponent(self, value: Number, place: int) -> int:
        if isinstance(value, Complex) or not value.is_constant or value.fraction().denominator != 1:
            message = f"the exponent {shown(str(value))} is not an integer"
            is_half = not isinstance(value, Complex) and value.is_constant and value.fraction().denominator == 2
            instead = "write sqrt( ) for a root" if is_half else "declare a symbol for it"
            raise self.source.error(message, place, f"exponents are integers; {instead}")
        exponent = int(value.fraction())
        if abs(exponent) > MOST_EXPONENT:
            raise self.source.error(f"the exponent is beyond {MOST_EXPONENT}", place, _SMALLER, kind=BudgetExceeded)
        return exponent

    def _combined(self, left: Number, place: int, right: Number, sign: str) -> Number:
        """Return the result of one operation."""
        if sign == "/":
            self._require_nonzero(right, place)
        sizes = operation_size(sign, left, right)
        if isinstance(left, Scalar) and isinstance(right, Scalar):
            self._spend(sizes, place)
            real: Scalar = _OPERATIONS[sign](left, right)
            return real
        self._spend(sizes, place, _SCALAR_OPERATIONS)
        result: Complex = _OPERATIONS[sign](Complex.of(left), Complex.of(right))
        return result.real if result.is_real else result

    def _complex_power(self, base: Number, exponent: int, place: int) -> Number:
        if exponent < 0:
            base, exponent = self._combined(Scalar.of(1), place, base, "/"), -exponent
        power: Number = Scalar.of(1)
        for digit in f"{exponent:b}":
            power = self._combined(power, place, power, "*")
            if digit == "1":
                power = self._combined(power, place, base, "*")
        return power

    def _require_nonzero(self, value: Number, place: int) -> None:
        if isinstance(value, Scalar) and value.is_zero:
            raise self.source.error("division by zero", place, "write a denominator that is not 0")

    def _spend(self, sizes: Parts, place: int, times: int = 1) -> None:
        excess = self.meter.charge(times * work(*sizes), sizes)
        if excess:
            raise self.source.error(f"this would build {excess}", place, _SMALLER, kind=BudgetExceeded)
