"""Evaluation of printed equations: exact values or signals, or a `Misfit` of sizes."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, islice, product
from typing import TYPE_CHECKING, TypeAlias

from symobs.applications.audit.differences import as_matrix
from symobs.applications.audit.equations import BEGIN, END, INSTANTS, krylov, text_of_value
from symobs.exact import Matrix, Scalar, TooLarge, rank, roots_of
from symobs.exact.algebraic.real_algebraic import RealNumber, roots_of_scalar
from symobs.exact.algebraic.rounded_decimals import as_generator, decimals_in, polynomial_of
from symobs.exact.core.generators import (
    derivative,
    function,
    functions_in,
    square_root,
    substitute,
)
from symobs.exact.core.polynomial import product_of
from symobs.exact.linear_algebra.elimination import reduced_echelon
from symobs.exact.time_functions.antiderivative import antiderivative
from symobs.formula.expression import parse_poles
from symobs.formula.expression.names import FUNCTIONS
from symobs.formula.expression.syntax import SyntaxNode, exponent_of
from symobs.formula.tree import (
    Apply,
    Block,
    Derivative,
    Environment,
    Exact,
    Letter,
    Literal,
    Product,
    Signal,
    Sum,
    agree,
    evaluate,
)
from symobs.formula.tree.arithmetic import add, scalar, times
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, InputError, OpenEquality
from symobs.problem.agreement import equal_by_form, functions_agree, in_form_of
from symobs.proof.certificate.claims import EVALUATION_ERRORS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.applications.audit.equations import Reading
    from symobs.formula.tree import Formula


# The functions of printed equations, with errors for sizes that do not match and costly arguments.


MOST_TERMS = 5_000
MOST_BITS = 10_000
MOST_DEGREE = 1_000
MOST_ORDER = 20
#: A matrix of more rows has an inverse here only if it has no more symbols than this.
MOST_GENERIC = 6
#: So many minors of a matrix are looked at for where its rank is less.
MOST_MINORS = 60


class Misfit(Exception):
    """A printed expression without a value: sizes do not match, or a matrix has no inverse."""


class Unknown(Misfit):
    """An unknown letter."""

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self.name = name


def no_fit(message: str) -> Misfit:
    """Return the misfit of two sizes."""
    return Misfit(f"the sizes do not fit: {message}")


def too_large() -> BudgetExceeded:
    """Return the error for an expression beyond the limits."""
    return BudgetExceeded("what is printed would build something too large", repair="print something smaller")


def require_small(matrix: Matrix) -> None:
    """Raise BudgetExceeded for a matrix whose determinant or inverse is too costly."""
    order = max(matrix.shape)
    if order > MOST_ORDER or (order > MOST_GENERIC and len(matrix.names) > MOST_GENERIC):
        raise too_large()


def sized(size: tuple[int, int] | None) -> str:
    """Return rows and columns as text."""
    return "a number" if size is None else f"{size[0]}x{size[1]}"


def applied(node: SyntaxNode, arguments: Sequence[Matrix], reading: Reading) -> Scalar | Matrix:
    """Return the value of a function of matrices; raises Misfit and BudgetExceeded."""
    name, first, environment = node.text, arguments[0], reading.environment
    for argument in arguments:
        require_small(argument)
    if name in FUNCTIONS:
        return _function(name, node.parts[0], first, reading)
    square = {"det", "adj", "trace", "eigenvalues", "ctrb", "place"}
    matrix, part = (arguments[1], node.parts[1]) if name == "obsv" else (first, node.parts[0])
    if name in square | {"obsv"} and matrix.shape[0] != matrix.shape[1]:
        raise no_fit(f"{part} is {sized(matrix.shape)}, but {name} takes a square matrix")
    match name:
        case "det":
            return first.determinant()
        case "adj":
            return first.adjugate()
        case "trace":
            return sum((first[i, i] for i in range(first.shape[0])), Scalar.of(0))
        case "eigenvalues":
            if environment.variable in first.names:
                raise Misfit(f"{part} is no constant matrix")
            return first.characteristic_polynomial(environment.variable)
        case "rank":
            reading.fails_where(_minors(first, order := rank(first)), f"{node} is less")
            return Scalar.of(order)
        case "rref":
            reduced = row_reduced(first)
            for values in (_minors(first, rank(first)), [reduced.common_denominator()]):
                reading.fails_where(values, f"{node} is another")
            return reduced
        case "Phi":
            return _transition([matrix[0, 0] for matrix in arguments], environment)
    second = arguments[1]
    A, B = (second.T, first.T) if name == "obsv" else (first, second)
    if B.shape[0] != A.shape[0]:
        raise no_fit(f"{node.parts[0]} is {sized(first.shape)} and {node.parts[1]} is {sized(second.shape)}")
    reach = krylov(A, B)
    if name != "place":
        return reach.T if name == "obsv" else reach
    if second.shape[1] != 1 or rank(reach) < first.shape[0]:
        raise Misfit("place has one answer only for one input that reaches everything")
    reading.fails_where([reach.determinant()], f"{node} has not one answer")
    polynomial, variable = _number(node.parts[2], arguments[2]), environment.variable
    coefficients = polynomial.coefficients(variable) if polynomial.is_polynomial_in(variable) else []
    if len(coefficients) != first.shape[0] + 1 or not coefficients[0].is_one:
        raise Misfit(f"{node.parts[2]} is no polynomial of degree {first.shape[0]} that begins with 1")
    return _placed(first, reach, polynomial, variable)


def _number(part: SyntaxNode, value: Matrix) -> Scalar:
    if value.shape != (1, 1):
        raise Misfit(f"{part} is {sized(value.shape)}, where a number belongs")
    return value[0, 0]


def _minors(matrix: Matrix, order: int) -> list[Scalar]:
    """Return minors of an order that vanish together only where the rank is less; of many, only the first ones."""
    chosen = product(*(combinations(range(size), order) for size in matrix.shape))
    return [matrix.select(*minor).determinant() for minor in islice(chosen, MOST_MINORS)] if order else [Scalar.of(1)]


def row_reduced(matrix: Matrix) -> Matrix:
    """Return the reduced row-echelon form, with its zero rows."""
    reduced = reduced_echelon(matrix)[1]
    missing = matrix.shape[0] - reduced.shape[0]
    return Matrix.block([[reduced], [Matrix.zeros(missing, matrix.shape[1])]]) if missing else reduced


def _placed(A: Matrix, reach: Matrix, polynomial: Scalar, variable: str) -> Matrix:
    """Return the row K with det(sI - A + BK) = φ, by Ackermann's formula."""
    total = Matrix.zeros(*A.shape)
    for coefficient in polynomial.coefficients(variable):
        total = total @ A + Matrix.identity(A.shape[0]) * coefficient
    return Matrix.unit(A.shape[0], A.shape[0] - 1).T @ reach.inverse() @ total


def _transition(instants: Sequence[Scalar], environment: Environment) -> Matrix:
    kept = environment.values.get("Phi_")
    if not isinstance(kept, Matrix):
        raise Unknown("Phi")
    end, begin = instants
    return substitute(kept, {END: end, BEGIN: begin})


def _function(name: str, part: SyntaxNode, argument: Matrix, reading: Reading) -> Scalar:
    """Return exp, sin, … of a number: its value in the field, or a generator."""
    if name == "exp" and argument.shape[0] == argument.shape[1] > 1:
        raise BudgetExceeded("the exponential of a matrix is not evaluated here", repair="print its entries")
    if argument.shape != (1, 1):
        raise Misfit(f"{part} is {sized(argument.shape)}, but {name} takes a number")
    number = argument[0, 0]
    if name != "sqrt":
        try:
            return function(name, number)
        except ZeroDivisionError:
            raise Misfit(f"{name}({part}) has no value") from None
    if number.is_constant and number.fraction() < 0:
        raise Misfit(f"{part} is negative: its square root is not real")
    return number if number.is_zero else _root(part, number, reading)


def _root(part: SyntaxNode, radicand: Scalar, reading: Reading) -> Scalar:
    """Return the nonnegative root: of f² it is f or -f, by the sign of f."""
    unit, factors = radicand.factors()
    odd = product_of([unit, *(factor for factor, power in factors if power % 2)])
    try:
        root = square_root(radicand)
    except ZeroDivisionError:
        raise Misfit(f"sqrt({part}) is not real") from None
    if reading.where.sign(odd) == "negative":
        raise Misfit(f"sqrt({part}) is not real")
    reading.real_where(odd, f"sqrt({part})")
    for factor, power in factors:
        if power // 2 % 2:  # it stands before the root with an odd power
            alone = power % 2 and (odd / factor).is_constant
            known = (1 if (odd / factor).fraction() > 0 else -1) if alone else reading.sign_of_square(factor)
            root = root * known
    return root


# Values of printed equations: their sizes, and the equality of two sides.


@dataclass
class Flexible:
    """A multiple of the identity matrix of undetermined order; 0 is the zero matrix of any size."""

    factor: Scalar


Printed: TypeAlias = Scalar | Matrix | Signal | Flexible


class _Certified(Exact):
    """The exact kernel, where values are equal by a certificate."""

    def equal(self, left: Scalar | Matrix, right: Scalar | Matrix) -> bool:
        return equal_by_form(left, right)


KERNEL = _Certified(Environment())
#: The sizes of a number.
SINGLE = ((1, 1), None)


def shape(value: Printed) -> tuple[int, int] | None:
    """Return rows and columns of a value or a signal, None for a number."""
    return (value.size, 1) if isinstance(value, Signal) else value.shape if isinstance(value, Matrix) else None


def formula_of(value: Printed) -> Formula:
    """Return a value or a signal written out."""
    if isinstance(value, Signal):
        return Sum(tuple(Product((Literal(part), Letter(name))) for name, part in value.coefficients.items()))
    return Literal(value)  # type: ignore[arg-type]


def scaled(value: Printed, factor: Scalar) -> Printed:
    """Return a multiple of a value."""
    found: Printed = Flexible(value.factor * factor) if isinstance(value, Flexible) else times(factor, value, KERNEL)
    return found


def fitted(value: Printed, like: Printed) -> Printed:
    """Return a value in the size of another one if its own is undetermined; raises Misfit for I beside a signal."""
    if not isinstance(value, Flexible) or isinstance(like, Flexible):
        return value
    if value.factor.is_zero:
        return scaled(like, value.factor)
    if isinstance(like, Signal):
        raise no_fit("the identity matrix stands beside a signal")
    size = shape(like)
    return value.factor if size in SINGLE else _of_size(value, size)


def kind_of(value: Printed) -> str:
    """Return the size of a value in words."""
    if isinstance(value, Signal):
        return f"has {value.size} component{'s' if value.size > 1 else ''}"
    return f"is {sized(shape(value))}"


def alike(left: Printed, right: Printed) -> bool:
    """Return whether two values can be added."""
    if isinstance(left, Signal) != isinstance(right, Signal):
        return False
    return shape(left) == shape(right) or (shape(left) in SINGLE and shape(right) in SINGLE)


def common(left: Printed, right: Printed) -> tuple[Printed, Printed]:
    """Return two sides in one size; raises Misfit where they have none."""
    if not alike(left, right):
        left, right = _of_any_size(left), _of_any_size(right)
    left, right = fitted(left, right), fitted(right, left)
    if isinstance(left, Flexible) and isinstance(right, Flexible):
        return left.factor, right.factor
    if not alike(left, right):
        if isinstance(left, Signal) != isinstance(right, Signal) and (shape(left) or (1, 1)) == (
            shape(right) or (1, 1)
        ):
            raise InputError("a signal has no value of its own", repair="print an equation between signals")
        raise no_fit(f"the left side {kind_of(left)}, the right side {kind_of(right)}")
    return left, right


def _of_any_size(value: Printed) -> Printed:
    """Return the number 0 as a zero matrix of any size, and any other value as it is."""
    return Flexible(value) if isinstance(value, Scalar) and value.is_zero else value


def equal(left: Printed, right: Printed, signs: Mapping[str, str]) -> bool:
    """Return whether two sides of one size are equal for letters with these signs; raises OpenEquality where it is open."""
    if agree(left, right, KERNEL):
        return True
    if (
        not isinstance(left, (Scalar, Matrix))
        or type(left) is not type(right)
        or decimals_in(left)
        or decimals_in(right)
    ):
        return False
    try:
        return functions_agree(left, right, signs)
    except TooLarge as error:
        raise OpenEquality(str(error)) from error


def in_form(printed: Printed, right: Printed, signs: Mapping[str, str]) -> Printed:
    """Return a printed value whose entries are written as the right ones that they equal, so that the others alone differ."""
    if not isinstance(printed, (Scalar, Matrix)) or not functions_in([printed]) or decimals_in(printed):
        return printed
    return in_form_of(printed, right, signs)[0]


#: So many primes may stand behind each other: derivatives, or transposes.
_MOST_PRIMES = 8


def value_of(node: SyntaxNode, reading: Reading) -> Printed:
    """Return the value of a tree; raises Misfit, Unknown and BudgetExceeded."""
    key = node.text if node.kind == "letter" else id(node)
    if reading.kept is not None and key in reading.kept:
        known: Printed = reading.kept[key][1]
        return known
    found = _value(node, reading)
    _bounded(found)
    if reading.kept is not None:
        reading.kept[key] = (node, found)
    return found


def _bounded(value: Printed) -> None:
    whole = value.factor if isinstance(value, Flexible) else value
    for part in whole.coefficients.values() if isinstance(whole, Signal) else (whole,):
        if part.size > MOST_TERMS or max(part.lengths()) > MOST_BITS or max(part.degrees()) > MOST_DEGREE:
            raise too_large()


def _value(node: SyntaxNode, reading: Reading) -> Printed:
    parts = node.parts
    match node.kind:
        case "number":
            decimal = as_generator(node.text, node.places[0]) if reading.rounding and node.places else None
            assert isinstance(node.value, Scalar)  # noqa: S101 - an invariant of the grammar
            return decimal or node.value
        case "letter":
            return _letter(node.text, reading)
        case "sum":
            return _sum(parts, reading)
        case "negative":
            return scaled(value_of(parts[0], reading), Scalar.of(-1))
        case "product":
            total = value_of(parts[0], reading)
            for i, part in enumerate(parts[1:], start=1):
                total = _times(total, value_of(part, reading), SyntaxNode("product", parts[:i]), part)
                _bounded(total)
            return total
        case "quotient":
            return _quotient(parts, reading)
        case "power":
            return _power(parts[0], exponent_of(node) or 0, reading)
        case "at":
            return _at(parts[0], parts[1], reading)
        case "primed":
            return _primed(parts[0], reading)
        case "block":
            return _block([row.parts for row in parts], reading)
        case _:
            return _call(node, reading)


def _letter(name: str, reading: Reading) -> Printed:
    environment = reading.environment
    known = name in environment.values or name in environment.signals
    if name in environment.signs or (name in {environment.variable, *INSTANTS} and not known):
        return Scalar.symbol(name)
    if known:
        return _evaluated(Letter(name), reading)
    if name == "I":
        return Flexible(Scalar.of(1))
    raise Unknown(name)


def _evaluated(formula: Formula, reading: Reading) -> Printed:
    found: Printed = evaluate(formula, reading.environment, KERNEL)
    return found


def _sum(parts: Sequence[SyntaxNode], reading: Reading) -> Printed:
    found = [(part, value_of(part, reading)) for part in parts]
    fixed = [(part, value) for part, value in found if not isinstance(value, Flexible)]
    if fixed and len(fixed) < len(found) and all(isinstance(value, Scalar) for _, value in fixed):
        raise no_fit("a number stands beside the identity matrix")
    head, first = next(((part, value) for part, value in fixed if shape(value)), (fixed or found)[0])
    total = scaled(first, Scalar.of(0))
    for part, value in found:
        term = fitted(value, first)
        if not alike(term, first):
            raise no_fit(f"{_unsigned(head)} {kind_of(first)}, but {_unsigned(part)} {kind_of(term)}")
        both = isinstance(total, Flexible) and isinstance(term, Flexible)
        total = Flexible(total.factor + term.factor) if both else add(total, term, KERNEL)  # type: ignore[union-attr]
    return total


def _unsigned(part: SyntaxNode) -> SyntaxNode:
    return part.parts[0] if part.kind == "negative" else part


def _times(left: Printed, right: Printed, before: SyntaxNode, behind: SyntaxNode) -> Printed:
    for one, other in ((left, right), (right, left)):
        if isinstance(one, Flexible):
            return Flexible(one.factor * other) if isinstance(other, Scalar) else scaled(other, one.factor)
    if isinstance(left, Signal):
        if isinstance(right, Signal) or shape(right) not in SINGLE:
            raise Misfit(f"{before} is a signal; {behind} has to stand before it")
        return scaled(left, scalar(right, KERNEL))
    first, second = shape(left), shape(right)
    if first is not None and second is not None and first[1] != second[0]:
        raise no_fit(f"{before} {kind_of(left)} and {behind} {kind_of(right)}")
    found: Printed = times(left, right, KERNEL)
    return found


def _quotient(parts: Sequence[SyntaxNode], reading: Reading) -> Printed:
    above, below = (value_of(part, reading) for part in parts)
    if isinstance(below, (Flexible, Signal)) or shape(below) not in SINGLE:
        raise Misfit(f"{parts[1]} is no number to divide by")
    divisor = scalar(below, KERNEL)
    _require_nonzero(divisor, f"{parts[1]} is 0", reading)
    return scaled(above, 1 / divisor)


def _require_nonzero(value: Scalar, says: str, reading: Reading) -> None:
    """Raise Misfit if a value is 0, and note that something fails where it is."""
    if value.is_zero:
        raise Misfit(says)
    reading.fails_where([value], says)


def _power(base: SyntaxNode, exponent: int, reading: Reading) -> Printed:
    value = value_of(base, reading)
    inner, size = value.factor if isinstance(value, Flexible) else value, shape(value)
    if isinstance(inner, Signal) or (size is not None and size[0] != size[1]):
        raise no_fit(f"{base} {kind_of(value)}: only square matrices have powers and inverses")
    if exponent < 0:
        if isinstance(inner, Matrix):
            require_small(inner)
        whole = inner.determinant() if isinstance(inner, Matrix) else inner
        _require_nonzero(whole, f"{base} has no inverse", reading)
        inner, exponent = KERNEL.invert(inner), -exponent
    total: Printed = Scalar.of(1) if size is None else Matrix.identity(size[0])
    for _ in range(exponent):
        total = times(total, inner, KERNEL)
        _bounded(total)
    return Flexible(total) if isinstance(value, Flexible) else total  # type: ignore[arg-type]


def _at(function: SyntaxNode, argument: SyntaxNode, reading: Reading) -> Printed:
    """Return a function at its argument: P(0), φ(A); at its own variable, and at a time, it is itself."""
    value, variable = value_of(function, reading), reading.environment.variable
    varies = isinstance(value, (Scalar, Matrix)) and variable in value.names
    if argument.kind == "letter" and (argument.text == variable or (argument.text == "t" and not varies)):
        return value
    if not isinstance(value, (Scalar, Matrix)) or not varies:
        raise Misfit(f"{function} is no function of {variable}")
    where = value_of(argument, reading)
    if isinstance(where, (Flexible, Signal)):
        raise Misfit(f"{argument} is no number here")
    if shape(where) in SINGLE:
        instant = {variable: scalar(where, KERNEL)}
        says = f"{function}({argument}) has no value"
        _require_nonzero(value.common_denominator().substitute(instant), says, reading)
        return value.substitute(instant)
    if function.kind != "letter" or not isinstance(value, Scalar) or not value.is_polynomial_in(variable):
        raise Misfit(f"{function} is no polynomial, which alone has a value at a matrix")
    if where.shape[0] != where.shape[1]:  # type: ignore[union-attr]
        raise no_fit(f"{argument} {kind_of(where)}, but a polynomial takes a square matrix")
    return _evaluated(Apply(f"{function.text}_at", Literal(where)), reading)


def _primed(base: SyntaxNode, reading: Reading) -> Printed:
    inner, primes = base, 1
    while inner.kind == "primed":
        inner, primes = inner.parts[0], primes + 1
    if primes > _MOST_PRIMES:  # each derivative of a signal is longer than the one before
        raise Misfit(f"{primes} primes stand behind each other, more than {_MOST_PRIMES}")
    value = value_of(base, reading)
    if not isinstance(value, Signal):
        return value.T if isinstance(value, Matrix) else value
    try:
        return _evaluated(Derivative(formula_of(value)), reading)
    except EVALUATION_ERRORS:
        raise Misfit(f"the derivative of {base} is not known here") from None


def _block(rows: Sequence[Sequence[SyntaxNode]], reading: Reading) -> Printed:
    found = [[value_of(entry, reading) for entry in row] for row in rows]
    if any(isinstance(value, Flexible) or shape(value) not in SINGLE for row in found for value in row):
        found = [[_of_any_size(value) for value in row] for row in found]
    places = [((i, j), value) for i, row in enumerate(found) for j, value in enumerate(row)]
    sizes: dict[tuple[str, int], int] = {}
    for (i, j), value in places:
        for key, size in zip((("row", i), ("column", j)), shape(value) or (1, 1), strict=True):
            if not isinstance(value, Flexible) and sizes.setdefault(key, size) != size:
                plural = f"{key[0]}{'s' if size != 1 else ''}"
                raise no_fit(f"{rows[i][j]} has {size} {plural}, but another entry of its {key[0]} has {sizes[key]}")
    for _ in (*rows, *rows[0]):  # a multiple of I is square: what is known of its row is known of its column
        for (i, j), value in places:
            known = sizes.get(("row", i)) or sizes.get(("column", j))
            if isinstance(value, Flexible) and not value.factor.is_zero and known:
                sizes = {("row", i): known, ("column", j): known, **sizes}
    order = shape(reading.environment.values.get("A", Scalar.of(1))) or (1,)
    for (i, j), value in places:
        if isinstance(value, Flexible):
            found[i][j] = _of_size(value, (sizes.get(("row", i), order[0]), sizes.get(("column", j), order[0])))
    stacked = [len(row) == 1 and isinstance(row[0], Signal) for row in found]
    if any(isinstance(value, Signal) for _, value in places) and not all(stacked):
        raise Misfit("signals are stacked in one column, with nothing else beside them")
    return _evaluated(Block(tuple(tuple(map(formula_of, row)) for row in found)), reading)


def _of_size(value: Flexible, size: tuple[int, int]) -> Matrix:
    """Return the multiple of the identity, or the zero matrix, of a size; raises Misfit for I that is not square."""
    if value.factor.is_zero:
        return Matrix.zeros(*size)
    if size[0] != size[1]:
        raise no_fit(f"the identity matrix stands where a {sized(size)} matrix belongs")
    return Matrix.identity(size[0]) * value.factor


# -- functions --------------------------------------------------------------------------------------------------------


def _call(node: SyntaxNode, reading: Reading) -> Printed:
    if node.text == "integral":
        return _integral(node.parts, reading)
    found = [value_of(part, reading) for part in node.parts]
    if node.text == "size":
        if isinstance(found[0], Flexible):
            raise Misfit(f"{node.parts[0]} has any size")
        return Matrix.row(list(shape(found[0]) or (1, 1)))
    return applied(node, list(map(_argument, node.parts, found)), reading)


def _argument(part: SyntaxNode, value: Printed) -> Matrix:
    if isinstance(value, (Flexible, Signal)):
        raise Misfit(f"{part} is no matrix here")
    return as_matrix(value)


def _integral(parts: Sequence[SyntaxNode], reading: Reading) -> Matrix:
    if parts[1].kind != "letter":
        raise Misfit(f"{parts[1]} is no time to integrate over")
    integrand, begin, end = (_argument(part, value_of(part, reading)) for part in (parts[0], *parts[2:]))
    name = parts[1].text
    whole = antiderivative(integrand, name)
    if whole is None or derivative(whole, name) != integrand:
        raise InputError(f"the integral of {parts[0]} has no closed form here", repair="leave the entry out")
    ends = [_number(part, end) for part, end in zip(parts[2:], (begin, end), strict=True)]
    if _may_have_pole(integrand.common_denominator(), name, ends):
        raise InputError(f"the integrand {parts[0]} may have a pole between the ends", repair="leave the entry out")
    found = substitute(whole, {name: ends[1]}) - substitute(whole, {name: ends[0]})
    new = found.common_denominator() / integrand.common_denominator()
    reading.fails_where([new], f"the integral of {parts[0]} is another")
    return found


def _may_have_pole(below: Scalar, name: str, ends: Sequence[Scalar]) -> bool:
    """Return whether a denominator may vanish between two numbers."""
    if name not in below.names:
        return False
    if below.names != {name} or any(end.names for end in ends):
        return True
    low, high = sorted(end.fraction() for end in ends)
    return any(not (root < RealNumber.of(low) or RealNumber.of(high) < root) for root in roots_of_scalar(below, name))


def as_printed(node: SyntaxNode, reading: Reading) -> Matrix | Scalar | None:
    """Return a printed value with decimals as generators, None if decimals are operands of a computation.

    They are compared where numbers, symbols, sums, products and quotients make up a number or the entries of one bracket.
    """
    if _written_as(node, reading) is None:
        return None
    found = value_of(node, replace(reading, rounding=True))
    return None if isinstance(found, (Flexible, Signal)) else found


def _written_as(node: SyntaxNode, reading: Reading) -> str | None:
    """Return `number` or `block` for a value that is written out, None for what refers to other values."""
    plain = {*reading.environment.signs, reading.environment.variable, *INSTANTS}
    kinds = [_written_as(part, reading) for part in node.parts]
    match node.kind:
        case "number":
            return "number"
        case "letter":
            return "number" if node.text in plain else None
        case "negative" | "primed" | "sum":
            return kinds[0] if len(set(kinds)) == 1 else None
        case "product":
            return None if None in kinds or kinds.count("block") > 1 else "block" if "block" in kinds else "number"
        case "quotient" | "power":
            return kinds[0] if kinds[1] == "number" and (kinds[0] == "number" or node.kind == "quotient") else None
        case "row" | "block":
            return node.kind if set(kinds) == {"row" if node.kind == "block" else "number"} else None
        case _:
            return None


def is_rounded(node: SyntaxNode, reading: Reading) -> bool:
    """Return whether a side is a value written out with decimals."""
    value = as_printed(node, reading)
    return value is not None and bool(decimals_in(value))


# `eigenvalues(X) = [-1, -2]`: lists of numbers, compared by the polynomial whose roots they are.


def spectral(left: SyntaxNode, right: SyntaxNode, variable: str) -> tuple[SyntaxNode, SyntaxNode]:
    """Return both sides, a list of eigenvalues replaced by the polynomial with these roots."""
    if is_spectrum(left) and right.kind == "block":
        return left, _polynomial(right, variable)
    if is_spectrum(right) and left.kind == "block":
        return _polynomial(left, variable), right
    return left, right


def is_spectrum(node: SyntaxNode) -> bool:
    """Return whether a node is `eigenvalues(X)`."""
    return node.kind == "call" and node.text == "eigenvalues"


def _polynomial(node: SyntaxNode, variable: str) -> SyntaxNode:
    try:
        roots = parse_poles(str(node), functions=True, rounding=True)
    except InputError:
        raise Misfit(f"{node} is no list of numbers") from None
    try:
        return SyntaxNode("number", text=str(node), value=polynomial_of(roots, variable))
    except ValueError:
        raise Misfit(f"{node} lacks a complex conjugate") from None


def spectrum_text(spectrum: SyntaxNode, polynomial: Scalar, variable: str) -> str:
    """Return the equation of the eigenvalues, or of their polynomial if they have no short form."""
    roots = [str(root) for root in roots_of(polynomial, variable)]
    if not any("CRootOf" in root for root in roots):
        return f"{spectrum} = [{', '.join(root.replace(' ', '') for root in roots)}]".replace("**", "^")
    pencil = SyntaxNode("sum", (SyntaxNode("letter", text=f"{variable} I"), SyntaxNode("negative", spectrum.parts)))
    return f"{SyntaxNode('call', (pencil,), text='det')} = {text_of_value(polynomial)}"
