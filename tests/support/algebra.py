"""The algebra by which answers are judged: of symobs nothing takes part but the terms of its values.

Matrices are lists of rows of numbers of one kind (`Fraction`, or those of `series`), polynomials are lists of coefficients
with the highest power first.  Texts are read by Python's own grammar and never evaluated by it.
"""

from __future__ import annotations

import ast
import operator
import random
import re
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from functools import cache, lru_cache
from math import lcm, prod
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import fmpq, fmpq_mat

if TYPE_CHECKING:
    from symobs.exact import Matrix, Scalar

Rows: TypeAlias = list[list[Fraction]]
Polynomial: TypeAlias = list[Fraction]
Point: TypeAlias = Mapping[str, Fraction]
Function: TypeAlias = Callable[..., Any]

# -- texts -------------------------------------------------------------------------------------------------------------


class Unreadable(ValueError):
    """A text that is no expression in the names and functions given."""


_OPERATIONS: dict[type[ast.AST], Function] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.USub: operator.neg,
    ast.UAdd: operator.pos,
}
COMPARED: dict[str, Callable[[Any, Any], bool]] = {
    "==": operator.eq,
    "!=": operator.ne,
    "<": operator.lt,
    "<=": operator.le,
    ">": operator.gt,
    ">=": operator.ge,
}
_RELATION = re.compile(r"(.*?)\s*(==|!=|<=|>=|<|>)\s*(.*)", re.DOTALL)


@cache
def parsed(text: str) -> ast.expr:
    """Return the tree of an expression; ^ is a power."""
    try:
        return ast.parse(text.replace("^", "**").strip(), mode="eval").body
    except (SyntaxError, RecursionError, ValueError) as error:
        raise Unreadable(text[:80]) from error


#: Functions whose arguments are given as trees: they have a variable of their own.
TREES = {"CRootOf", "RootSum"}


def evaluated(
    text: object, names: Mapping[str, Any], functions: Mapping[str, Function] | None = None, number: Function = Fraction
) -> Any:
    """Return the value of an expression, or of its tree, of the kind of its names."""

    def value(node: ast.expr) -> Any:
        match node:
            case ast.Constant(value=int(whole)):
                return number(whole)
            case ast.Name(id=name) if name in names:
                return names[name]
            case ast.UnaryOp(op=sign, operand=inner) if type(sign) in _OPERATIONS:
                return _OPERATIONS[type(sign)](value(inner))
            case ast.BinOp(left=left, op=ast.Pow(), right=right):
                exponent = evaluated(right, {})
                return value(left) ** (int(exponent) if exponent.denominator == 1 else number(exponent))
            case ast.BinOp(left=left, op=sign, right=right) if type(sign) in _OPERATIONS:
                return _OPERATIONS[type(sign)](value(left), value(right))
            case ast.Call(func=ast.Name(id=name), args=arguments) if functions and name in functions:
                function = functions[name]
                return function(*(arguments if name in TREES else map(value, arguments)))
        raise Unreadable(ast.unparse(node)[:80])

    return value(text if isinstance(text, ast.expr) else parsed(str(text)))


def sides(relation: str) -> tuple[str, str, str]:
    """Return left side, operator and right side of `expr op expr`."""
    found = _RELATION.fullmatch(relation)
    if found is None:
        raise Unreadable(relation)
    left, how, right = found.groups()
    return left, how, right


def holds(relation: str, point: Mapping[str, Any], functions: Mapping[str, Function] | None = None) -> bool:
    """Tell whether a relation of an answer holds at a point."""
    if relation in {"True", "False"}:
        return relation == "True"
    left, how, right = sides(relation)
    return bool(COMPARED[how](evaluated(left, point, functions), evaluated(right, point, functions)))


# -- kernel values at a point ------------------------------------------------------------------------------------------

Term: TypeAlias = tuple[int, tuple[tuple[str, int], ...], int]


@lru_cache(maxsize=4096)
def _terms(scalar: Scalar) -> tuple[list[Term], list[Term], int]:
    """Return the terms of numerator and denominator, each filled up to one degree, and that degree."""
    parts = [part.terms() for part in (scalar.numerator, scalar.denominator)]
    degree = max((sum(power for _, power in powers) for part in parts for _, powers in part), default=0)
    above, below = ([(c, powers, degree - sum(power for _, power in powers)) for c, powers in part] for part in parts)
    return above, below, degree


def value_at(scalar: Scalar, point: Point) -> Fraction:
    """Evaluate a kernel scalar term by term; raises ZeroDivisionError where its denominator vanishes.

    In integers over one denominator q: Σ c Π (xᵢ/q)^eᵢ = Σ c Π xᵢ^eᵢ q^(d − Σ eᵢ) / q^d.
    """
    if scalar.is_constant:
        return scalar.fraction()
    above, below, degree = _terms(scalar)
    common = lcm(*(value.denominator for value in point.values()))
    bases = {name: value.numerator * (common // value.denominator) for name, value in point.items()}
    powers = {name: [base**k for k in range(degree + 1)] for name, base in bases.items() if name in scalar.names}
    filling = [common**k for k in range(degree + 1)]
    top, bottom = (
        sum(
            prod([powers[name][k] for name, k in names], start=coefficient * filling[rest])
            for coefficient, names, rest in part
        )
        for part in (above, below)
    )
    return Fraction(top, bottom)


def matrix_at(matrix: Matrix, point: Point) -> Rows:
    return [[value_at(entry, point) for entry in row] for row in matrix.rows]


def coefficients_at(scalar: Scalar, variable: str, point: Point) -> Polynomial:
    """Evaluate the coefficients of a polynomial in one variable, highest power first."""
    return [value_at(coefficient, point) for coefficient in scalar.coefficients(variable)]


def seeded(seed: object) -> random.Random:
    """A generator that draws the same in every run."""
    return random.Random(str(seed))  # noqa: S311 - test points, no secrets


def random_fraction(generator: random.Random, sign: str = "real") -> Fraction:
    """Draw a small rational number that has the declared sign."""
    value = Fraction(generator.randint(-40, 40), generator.randint(1, 9))
    if sign in {"positive", "negative", "nonzero"} and not value:
        value = Fraction(1, generator.randint(1, 9))
    if sign in {"positive", "nonnegative"}:
        return abs(value)
    return -abs(value) if sign in {"negative", "nonpositive"} else value


def has_sign(value: Fraction, sign: str) -> bool:
    """Tell whether a number has a declared sign."""
    return {
        "positive": value > 0,
        "negative": value < 0,
        "nonnegative": value >= 0,
        "nonpositive": value <= 0,
        "nonzero": value != 0,
        "zero": value == 0,
        "real": True,
    }[sign]


# -- plain arithmetic --------------------------------------------------------------------------------------------------


def multiply(left: Sequence[Sequence[Any]], right: Sequence[Sequence[Any]]) -> Rows:
    columns = list(zip(*right, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in left]


def subtract(left: Rows, right: Rows) -> Rows:
    return [[a - b for a, b in zip(p, q, strict=True)] for p, q in zip(left, right, strict=True)]


def plus(left: Sequence[Sequence[Any]], right: Sequence[Sequence[Any]]) -> Rows:
    return [[a + b for a, b in zip(p, q, strict=True)] for p, q in zip(left, right, strict=True)]


def identity(order: int) -> Rows:
    return [[Fraction(i == j) for j in range(order)] for i in range(order)]


def characteristic(A: Rows) -> Polynomial:
    """Return det(sI − A)."""
    found = fmpq_mat([[fmpq(entry.numerator, entry.denominator) for entry in row] for row in A]).charpoly()
    return [Fraction(int(c.p), int(c.q)) for c in reversed(found.coeffs())]


def response(A: Rows, B: Rows, C: Rows, s: Fraction) -> Rows:
    """Return C (sI − A)⁻¹ B at a number s."""
    return multiply(C, multiply(inverse(pencil(s, A)), B))


def pencil(s: Fraction, A: Rows) -> Rows:
    """Return s I − A."""
    return [[(s if i == j else 0) - entry for j, entry in enumerate(row)] for i, row in enumerate(A)]


def eliminate(table: Sequence[Sequence[Any]], width: int | None = None) -> tuple[list[int], Any, Rows]:
    """Return the pivots among the first columns, the determinant of these, and the rows reduced by Gauss and Jordan."""
    work, pivots, determinant = [list(row) for row in table], list[int](), Fraction(1)
    for column in range((len(work[0]) if work else 0) if width is None else width):
        rank = len(pivots)
        pivot = next((i for i in range(rank, len(work)) if work[i][column]), None)
        if pivot is None:
            determinant = Fraction(0)
            continue
        if pivot != rank:
            work[rank], work[pivot], determinant = work[pivot], work[rank], -determinant
        lead = work[rank][column]
        determinant *= lead
        work[rank] = [entry / lead for entry in work[rank]]
        for i, row in enumerate(work):
            if i != rank and row[column]:
                work[i] = [a - row[column] * b for a, b in zip(row, work[rank], strict=True)]
        pivots.append(column)
    return pivots, determinant, work


def rank_of(table: Sequence[Sequence[Any]]) -> int:
    return len(eliminate(table)[0])


def determinant(table: Rows) -> Fraction:
    return eliminate(table, len(table))[1]  # type: ignore[no-any-return]


def inverse(table: Rows) -> Rows:
    order = len(table)
    pivots, _, work = eliminate([row + unit for row, unit in zip(table, identity(order), strict=True)], order)
    if len(pivots) < order:
        raise ZeroDivisionError
    return [row[order:] for row in work]


def independent(table: Rows) -> Rows:
    """Return the first rows that are independent, as many as there are."""
    return [table[k] for k in eliminate(transposed(table))[0]] if table else []


def observability_rows(A: Rows, C: Rows) -> Rows:
    rows, block = list(C), C
    for _ in range(len(A) - 1):
        block = multiply(block, A)
        rows += block
    return rows


def transposed(rows: Rows) -> Rows:
    return [list(column) for column in zip(*rows, strict=True)]


def hidden(A: Rows, C: Rows) -> Polynomial:
    """Return the characteristic polynomial of A on the kernel of 𝒪, by a basis that is the identity on the free rows."""
    pivots, _, reduced = eliminate(observability_rows(A, C))
    free = [j for j in range(len(A)) if j not in pivots]
    N = [[Fraction(int(i == j)) for j in free] for i in range(len(A))]
    for pivot, row in zip(pivots, reduced, strict=False):
        N[pivot] = [-row[j] for j in free]
    moved = multiply(A, N) if free else []
    return characteristic([moved[i] for i in free]) if free else [Fraction(1)]


def divided(whole: Polynomial, part: Polynomial) -> tuple[Polynomial, Polynomial]:
    """Return quotient and remainder by a monic polynomial."""
    rest, found = list(whole), []
    while len(rest) >= len(part):
        found.append(rest[0])
        shifted = [rest[0] * c for c in part] + [Fraction(0)] * (len(rest) - len(part))
        rest = [x - y for x, y in zip(rest, shifted, strict=True)][1:]
    return found, rest


def divides(divisor: Polynomial, polynomial: Polynomial) -> bool:
    """Tell whether a monic polynomial divides another."""
    return not any(divided(polynomial, divisor)[1])


def assignable(A: Rows, C: Rows, phi: Polynomial) -> bool:
    """Tell whether some L has det(sI − A + L C) = φ(s): what the outputs do not show must divide φ."""
    return divides(hidden(A, C), phi)


def is_stable(polynomial: Polynomial, *, discrete: bool) -> bool:
    """Tell whether a polynomial keeps its degree and has all roots in Re s < 0 (|z| < 1)."""
    return bool(polynomial[0]) and (is_schur if discrete else is_hurwitz)(list(polynomial))


def is_hurwitz(polynomial: Polynomial) -> bool:
    """Tell whether every root lies in Re s < 0, by the first column of Routh's scheme."""
    positive = [c / polynomial[0] for c in polynomial]
    above, below = positive[0::2], positive[1::2]
    while below:
        if below[0] <= 0:
            return False
        padded = below + [Fraction(0)] * (len(above) - len(below))
        above, below = (
            below,
            [
                above[k + 1] - above[0] / below[0] * (padded[k + 1] if k + 1 < len(padded) else 0)
                for k in range(len(above) - 1)
            ],
        )
    return True


def is_schur(polynomial: Polynomial) -> bool:
    """Tell whether every root lies in |z| < 1, by the recursion of Schur and Cohn."""
    while len(polynomial) > 1:
        first, last = polynomial[0], polynomial[-1]
        if abs(last) >= abs(first):
            return False
        polynomial = [first * x - last * y for x, y in zip(polynomial, reversed(polynomial), strict=True)][:-1]
    return True


def product(factors: Sequence[Polynomial]) -> Polynomial:
    total = [Fraction(1)]
    for factor in factors:
        longer = [Fraction(0)] * (len(total) + len(factor) - 1)
        for i, x in enumerate(total):
            for j, y in enumerate(factor):
                longer[i + j] += x * y
        total = longer
    return total


def at_number(polynomial: Polynomial, s: Fraction) -> Fraction:
    value = Fraction(0)
    for coefficient in polynomial:
        value = value * s + coefficient
    return value
