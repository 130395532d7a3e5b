"""The functions of printed equations, with errors for sizes that do not match and costly arguments."""

from __future__ import annotations

from itertools import combinations, islice, product
from typing import TYPE_CHECKING

from symobs.applications.audit.equations.letter_values import BEGIN, END, krylov
from symobs.exact import Matrix, Scalar, rank
from symobs.exact.core.generators import derivative, function, square_root, substitute
from symobs.exact.core.polynomial import product_of
from symobs.exact.linear_algebra.elimination import reduced_echelon
from symobs.exact.time_functions.antiderivative import antiderivative
from symobs.formula.expression.names import FUNCTIONS
from symobs.ground.errors import BudgetExceeded

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.applications.audit.equations.reading import Reading
    from symobs.formula.expression.syntax_tree import SyntaxNode
    from symobs.formula.tree import Environment

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
