"""Evaluation of printed equations: exact values or signals, or a `Misfit` of sizes."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations, islice, product
from typing import TYPE_CHECKING, TypeAlias

from symobs.applications.audit.equations import BEGIN, END, INSTANTS, krylov, text_of_value
from symobs.exact import Matrix, Scalar, rank, roots_of
from symobs.exact.algebraic.rounded_decimals import as_generator, decimals_in, polynomial_of
from symobs.exact.core.generators import derivative, function, identities, square_root, substitute
from symobs.exact.core.polynomial import product_of
from symobs.exact.linear_algebra.elimination import reduced_echelon
from symobs.exact.time_functions.antiderivative import antiderivative
from symobs.formula.expression import parse_poles
from symobs.formula.expression.names import FUNCTIONS
from symobs.formula.expression.syntax import SyntaxNode, exponent_of
from symobs.formula.tree import Apply, Environment, Letter, Literal, Relation, Signal
from symobs.formula.tree.term import Term, block
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, InputError
from symobs.proof.certificate.claims import EVALUATION_ERRORS, verify

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.audit.equations import Reading


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


class Unknown(Exception):
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
    if name == "obsv":
        if first.shape[1] != second.shape[0]:
            raise no_fit(f"{node.parts[0]} is {sized(first.shape)} and {node.parts[1]} is {sized(second.shape)}")
        return krylov(second.T, first.T).T
    if second.shape[0] != first.shape[0]:
        raise no_fit(f"{node.parts[0]} is {sized(first.shape)} and {node.parts[1]} is {sized(second.shape)}")
    if name == "ctrb":
        return krylov(first, second)
    reach = krylov(first, second)
    if second.shape[1] != 1 or rank(reach) < first.shape[0]:
        raise Misfit("place has one answer only for one input that reaches everything")
    reading.fails_where([reach.determinant()], f"{node} has not one answer")
    return _placed(first, reach, arguments[2][0, 0], environment.variable)


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
    reading.real_where(odd, f"sqrt({part})")
    for factor, power in factors:
        if power // 2 % 2:  # it stands before the root with an odd power
            alone = power % 2 and (odd / factor).is_constant
            known = (1 if (odd / factor).fraction() > 0 else -1) if alone else reading.sign_of_square(factor)
            root = root * known
    return root


def integrated(integrand: Matrix, name: str, ends: tuple[Scalar, Scalar]) -> Matrix | None:
    """Return an integral by a checked antiderivative, None if none is found."""
    whole = antiderivative(integrand, name)
    if whole is None or derivative(whole, name) != integrand:
        return None
    lower, upper = (substitute(whole, {name: end}) for end in ends)
    return upper - lower


# Sizes of values in printed equations, and equality of two sides.


@dataclass
class Flexible:
    """A multiple of the identity matrix of undetermined order; 0 is the zero matrix of any size."""

    factor: Scalar


Printed: TypeAlias = Term | Flexible


def shape(term: Term) -> tuple[int, int] | None:
    """Return rows and columns of a value or a signal, None for a number."""
    value = term.value
    if isinstance(value, Signal):
        return value.size, 1
    return value.shape if isinstance(value, Matrix) else None


def is_signal(printed: Printed) -> bool:
    """Return whether a value is made of signals."""
    return isinstance(printed, Term) and isinstance(printed.value, Signal)


def fitted(flexible: Flexible, like: Term) -> Term:
    """Return a multiple of the identity in the size of another value; raises Misfit unless that is square."""
    size = shape(like)
    if is_signal(like):
        raise no_fit("the identity matrix stands beside a signal")
    if size is None or size == (1, 1):
        return Term(Literal(flexible.factor), like.environment)
    if flexible.factor.is_zero:
        return Term(Literal(Matrix.zeros(*size)), like.environment)
    if size[0] != size[1]:
        raise no_fit(f"the identity matrix is square, but {sized(size)} stands beside it")
    return Term(Literal(Matrix.identity(size[0]) * flexible.factor), like.environment)


def kind_of(term: Term) -> str:
    """Return the size of a value in words."""
    size = shape(term)
    if size is not None and is_signal(term):
        return f"has {size[0]} component{'s' if size[0] > 1 else ''}"
    return f"is {sized(size)}"


def alike(left: Term, right: Term) -> bool:
    """Return whether two values can be added."""
    single = ((1, 1), None)
    if is_signal(left) != is_signal(right):
        return False
    return shape(left) == shape(right) or (shape(left) in single and shape(right) in single)


def common(left: Printed, right: Printed, environment: Environment) -> tuple[Term, Term]:
    """Return two sides in one size; raises Misfit where they have none."""
    if isinstance(left, Flexible) or isinstance(right, Flexible):
        if isinstance(left, Term):
            return left, fitted(right, left)  # type: ignore[arg-type]
        if isinstance(right, Term):
            return fitted(left, right), right
        return tuple(Term(Literal(side.factor), environment) for side in (left, right))  # type: ignore[return-value]
    if not alike(left, right) and (_is_zero(left) or _is_zero(right)):
        return (left, left - left) if _is_zero(right) else (right - right, right)
    if not alike(left, right):
        if is_signal(left) != is_signal(right) and (shape(left) or (1, 1)) == (shape(right) or (1, 1)):
            raise InputError("a signal has no value of its own", repair="print an equation between signals")
        raise no_fit(f"the left side {kind_of(left)}, the right side {kind_of(right)}")
    return left, right


def _is_zero(term: Term) -> bool:
    return isinstance(term.value, Scalar) and term.value.is_zero


def equal(left: Term, right: Term) -> bool:
    """Return whether two sides are equal, by a certificate."""
    environment = left.environment
    exact = [value for value in (left.value, right.value) if isinstance(value, (Scalar, Matrix))]
    meanings, relations = identities(exact)
    if meanings or relations:
        environment = Environment(environment.variable, coefficients=meanings, relations=relations)
        return bool(verify(Relation((Literal(exact[0]), Literal(exact[1])), ("=",)), environment)[0])
    return bool(verify(Relation((left.formula, right.formula), ("=",)), environment)[0])


#: So many primes may stand behind each other: derivatives, or transposes.
_MOST_PRIMES = 8


def value_of(node: SyntaxNode, reading: Reading) -> Printed:
    """Return the value of a tree; raises Misfit, Unknown and BudgetExceeded."""
    key = node.text if node.kind == "letter" else id(node)
    if reading.kept is not None and key in reading.kept:
        known: Printed = reading.kept[key][1]
        return known
    found = _value(node, reading)
    if isinstance(found, Term):
        _bounded(found)
        if node.parts and not is_signal(found):  # what stands around it need not evaluate its formula again
            found = Term(Literal(found.value), found.environment)
    if reading.kept is not None:
        reading.kept[key] = (node, found)
    return found


def _bounded(term: Term) -> None:
    value = term.value
    for part in value.coefficients.values() if isinstance(value, Signal) else (value,):
        if part.size > MOST_TERMS or max(part.lengths()) > MOST_BITS or max(part.degrees()) > MOST_DEGREE:
            raise too_large()


def _value(node: SyntaxNode, reading: Reading) -> Printed:
    parts = node.parts
    match node.kind:
        case "number":
            decimal = as_generator(node.text, node.places[0]) if reading.rounding and node.places else None
            assert isinstance(node.value, Scalar)  # noqa: S101 - an invariant of the grammar
            return Term(Literal(decimal or node.value), reading.environment)
        case "letter":
            return _letter(node.text, reading)
        case "sum":
            return _sum(parts, reading)
        case "negative":
            inner = value_of(parts[0], reading)
            return Flexible(-inner.factor) if isinstance(inner, Flexible) else -inner
        case "product":
            total = value_of(parts[0], reading)
            for i, part in enumerate(parts[1:], start=1):
                total = _times(total, value_of(part, reading), SyntaxNode("product", parts[:i]), part)
                if isinstance(total, Term):
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
    if name in environment.signs:
        return Term(Literal(Scalar.symbol(name)), environment)
    if environment.defines(name) and name != "s":
        return Term(Letter(name), environment)
    if name in {environment.variable, *INSTANTS}:
        return Term(Literal(Scalar.symbol(name)), environment)
    if name == "I":
        return Flexible(Scalar.of(1))
    raise Unknown(name)


def _sum(parts: Sequence[SyntaxNode], reading: Reading) -> Printed:
    found = [value_of(part, reading) for part in parts]
    terms = [(part, value) for part, value in zip(parts, found, strict=True) if isinstance(value, Term)]
    if not terms:
        return Flexible(sum((value.factor for value in found if isinstance(value, Flexible)), Scalar.of(0)))
    if any(isinstance(value, Flexible) for value in found) and all(shape(value) is None for _, value in terms):
        raise no_fit("a number stands beside the identity matrix")
    (head, first) = next(((part, value) for part, value in terms if shape(value) is not None), terms[0])
    total: Term | None = None
    for part, value in zip(parts, found, strict=True):
        term = fitted(value, first) if isinstance(value, Flexible) else value
        if not alike(term, first):
            raise no_fit(f"{_unsigned(head)} {kind_of(first)}, but {_unsigned(part)} {kind_of(term)}")
        total = term if total is None else total + term
    assert total is not None  # noqa: S101 - a sum has parts
    return total


def _unsigned(part: SyntaxNode) -> SyntaxNode:
    return part.parts[0] if part.kind == "negative" else part


def _times(left: Printed, right: Printed, before: SyntaxNode, behind: SyntaxNode) -> Printed:
    if isinstance(left, Flexible):
        if isinstance(right, Flexible):
            return Flexible(left.factor * right.factor)
        return right * left.factor if left.factor != Scalar.of(1) else right
    if isinstance(right, Flexible):
        if shape(left) is None:
            return Flexible(right.factor * left.value)
        return left * right.factor if right.factor != Scalar.of(1) else left
    if is_signal(left):
        if is_signal(right) or shape(right) not in (None, (1, 1)):
            raise Misfit(f"{before} is a signal; {behind} has to stand before it")
        return Term(Literal(right.scalar), right.environment) @ left
    first, second = shape(left), shape(right)
    if first is not None and second is not None and first[1] != second[0]:
        raise no_fit(f"{before} {kind_of(left)} and {behind} {kind_of(right)}")
    return left @ right


def _quotient(parts: Sequence[SyntaxNode], reading: Reading) -> Printed:
    above, below = (value_of(part, reading) for part in parts)
    if isinstance(below, Flexible) or is_signal(below) or shape(below) not in (None, (1, 1)):
        raise Misfit(f"{parts[1]} is no number to divide by")
    divisor = below.scalar
    if divisor.is_zero:
        raise Misfit(f"{parts[1]} is 0")
    reading.fails_where([divisor], f"{parts[1]} is 0")
    return Flexible(above.factor / divisor) if isinstance(above, Flexible) else above / below


def _power(base: SyntaxNode, exponent: int, reading: Reading) -> Printed:
    value = value_of(base, reading)
    if isinstance(value, Flexible):
        if exponent < 0:
            _require_inverse(base, value.factor, reading)
        return Flexible(value.factor**exponent)
    size = shape(value)
    if is_signal(value) or (size is not None and size[0] != size[1]):
        raise no_fit(f"{base} {kind_of(value)}: only square matrices have powers and inverses")
    if exponent < 0:
        if isinstance(value.value, Matrix):
            require_small(value.value)
        whole = value.scalar if size in (None, (1, 1)) else value.value.determinant()
        _require_inverse(base, whole, reading)
        value, exponent = value.inverse, -exponent
    if not exponent:
        return Term(Literal(Scalar.of(1) if size is None else Matrix.identity(size[0])), reading.environment)
    total: Term = value
    for _ in range(exponent - 1):
        total = total @ value
        _bounded(total)
    return total


def _require_inverse(base: SyntaxNode, determinant: Scalar, reading: Reading) -> None:
    if determinant.is_zero:
        raise Misfit(f"{base} has no inverse")
    reading.fails_where([determinant], f"{base} has no inverse")


def _at(function: SyntaxNode, argument: SyntaxNode, reading: Reading) -> Printed:
    """Return a function at its argument: P(0), φ(A); at its own variable, and at a time, it is itself."""
    value, variable = value_of(function, reading), reading.environment.variable
    varies = isinstance(value, Term) and not is_signal(value) and variable in value.value.names
    if argument.kind == "letter" and (argument.text == variable or (argument.text == "t" and not varies)):
        return value
    if not isinstance(value, Term) or not varies:
        raise Misfit(f"{function} is no function of {variable}")
    where = value_of(argument, reading)
    if isinstance(where, Flexible) or is_signal(where):
        raise Misfit(f"{argument} is no number here")
    if isinstance(where.value, Matrix) and where.value.shape != (1, 1):
        return _at_matrix(function, value, argument, where)
    try:
        found = value.value.substitute({variable: where.scalar})
        below = value.value.common_denominator().substitute({variable: where.scalar})
    except ZeroDivisionError:
        raise Misfit(f"{function}({argument}) has no value") from None
    if below.is_zero:
        raise Misfit(f"{function}({argument}) has no value")
    reading.fails_where([below], f"{function}({argument}) has no value")
    return Term(Literal(found), reading.environment)


def _at_matrix(function: SyntaxNode, value: Term, argument: SyntaxNode, where: Term) -> Term:
    polynomial = function.kind == "letter" and isinstance(value.value, Scalar)
    if not polynomial or not value.value.is_polynomial_in(where.environment.variable):
        raise Misfit(f"{function} is no polynomial, which alone has a value at a matrix")
    if where.value.shape[0] != where.value.shape[1]:
        raise no_fit(f"{argument} {kind_of(where)}, but a polynomial takes a square matrix")
    return Term(Apply(f"{function.text}_at", where.formula), where.environment)


def _primed(base: SyntaxNode, reading: Reading) -> Printed:
    inner, primes = base, 1
    while inner.kind == "primed":
        inner, primes = inner.parts[0], primes + 1
    if primes > _MOST_PRIMES:  # each derivative of a signal is longer than the one before
        raise Misfit(f"{primes} primes stand behind each other, more than {_MOST_PRIMES}")
    value = value_of(base, reading)
    if isinstance(value, Flexible):
        return value
    if not is_signal(value):
        return value if shape(value) is None else value.T
    rate = value.derivative
    try:
        rate.value  # noqa: B018 - whether there is one
    except EVALUATION_ERRORS:
        raise Misfit(f"the derivative of {base} is not known here") from None
    return rate


# -- blocks -----------------------------------------------------------------------------------------------------------


def _block(rows: Sequence[Sequence[SyntaxNode]], reading: Reading) -> Printed:
    found = [[value_of(entry, reading) for entry in row] for row in rows]
    found = [[_zero(value) for value in row] for row in found] if _in_blocks(found) else found
    heights: list[int | None] = [None] * len(rows)
    widths: list[int | None] = [None] * len(rows[0])
    for i, row in enumerate(found):
        for j, value in enumerate(row):
            if isinstance(value, Term):
                height, width = shape(value) or (1, 1)
                for sizes, index, size, what in ((heights, i, height, "row"), (widths, j, width, "column")):
                    if sizes[index] not in (None, size):
                        plural = f"{what}{'s' if size != 1 else ''}"
                        message = (
                            f"{rows[i][j]} has {size} {plural}, but another entry of its {what} has {sizes[index]}"
                        )
                        raise no_fit(message)
                    sizes[index] = size
    _spread(found, heights, widths)
    order = reading.environment.values["A"].shape[0] if "A" in reading.environment.values else 1  # type: ignore[union-attr]
    terms = []
    for i, row in enumerate(found):
        line = []
        for j, value in enumerate(row):
            room = (heights[i] or order, widths[j] or order)
            line.append(value if isinstance(value, Term) else _of_size(value, room, reading))
        terms.append(line)
    if any(is_signal(term) for line in terms for term in line) and not all(
        len(line) == 1 and is_signal(line[0]) for line in terms
    ):
        raise Misfit("signals are stacked in one column, with nothing else beside them")
    return block([list(line) for line in terms])


def _in_blocks(found: Sequence[Sequence[Printed]]) -> bool:
    """Return whether a bracket contains matrices, so that a number 0 denotes a zero matrix."""
    values = [value for row in found for value in row]
    return any(isinstance(value, Flexible) or shape(value) not in (None, (1, 1)) for value in values)


def _zero(value: Printed) -> Printed:
    if isinstance(value, Term) and isinstance(value.value, Scalar) and value.value.is_zero:
        return Flexible(Scalar.of(0))
    return value


def _spread(found: Sequence[Sequence[Printed]], heights: list[int | None], widths: list[int | None]) -> None:
    """Propagate sizes between block rows and columns through identity matrices, until nothing changes."""
    for _ in range(len(heights) + len(widths)):
        for i, row in enumerate(found):
            for j, value in enumerate(row):
                if isinstance(value, Flexible) and not value.factor.is_zero:
                    heights[i] = heights[i] or widths[j]
                    widths[j] = widths[j] or heights[i]


def _of_size(value: Flexible, size: tuple[int, int], reading: Reading) -> Term:
    if value.factor.is_zero:
        return Term(Literal(Matrix.zeros(*size)), reading.environment)
    if size[0] != size[1]:
        raise no_fit(f"the identity matrix stands where a {sized(size)} block belongs")
    return Term(Literal(Matrix.identity(size[0]) * value.factor), reading.environment)


# -- functions --------------------------------------------------------------------------------------------------------


def _call(node: SyntaxNode, reading: Reading) -> Printed:
    if node.text == "integral":
        return _integral(node.parts, reading)
    found = [value_of(part, reading) for part in node.parts]
    if node.text == "size":
        return _size(node.parts[0], found[0], reading)
    arguments = [_argument(part, value) for part, value in zip(node.parts, found, strict=True)]
    return Term(Literal(applied(node, arguments, reading)), reading.environment)


def _argument(part: SyntaxNode, value: Printed) -> Matrix:
    if isinstance(value, Flexible) or is_signal(value):
        raise Misfit(f"{part} is no matrix here")
    return value.value if isinstance(value.value, Matrix) else Matrix.of([[value.value]])


def _size(part: SyntaxNode, value: Printed, reading: Reading) -> Term:
    if isinstance(value, Flexible):
        raise Misfit(f"{part} has any size")
    return Term(Literal(Matrix.row(list(shape(value) or (1, 1)))), reading.environment)


def _integral(parts: Sequence[SyntaxNode], reading: Reading) -> Term:
    if parts[1].kind != "letter":
        raise Misfit(f"{parts[1]} is no time to integrate over")
    integrand, begin, end = (_argument(part, value_of(part, reading)) for part in (parts[0], *parts[2:]))
    found = integrated(integrand, parts[1].text, (begin[0, 0], end[0, 0]))
    if found is None:
        raise InputError(f"the integral of {parts[0]} has no closed form here", repair="leave the entry out")
    new = found.common_denominator() / integrand.common_denominator()
    reading.fails_where([new], f"the integral of {parts[0]} is another")
    return Term(Literal(found), reading.environment)


def as_printed(node: SyntaxNode, reading: Reading) -> Matrix | Scalar | None:
    """Return a printed value with decimals as generators, None if decimals are operands of a computation.

    They are compared where numbers, symbols, sums, products and quotients make up a number or the entries of one bracket.
    """
    if _written_as(node, reading) is None:
        return None
    found = value_of(node, replace(reading, rounding=True))
    return None if isinstance(found, Flexible) or is_signal(found) else found.value


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


def holds(left: SyntaxNode, right: SyntaxNode, reading: Reading) -> bool:
    """Return whether an equation holds; sizes that do not match make it false."""
    try:
        return equal(*common(value_of(left, reading), value_of(right, reading), reading.environment))
    except (Misfit, Unknown, *EVALUATION_ERRORS):  # InputError is a ValueError
        return False


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
