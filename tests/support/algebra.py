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
from mpmath.ctx_mp import MPContext

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
                return functions[name](*(arguments if name in TREES else map(value, arguments)))
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


def adjugate(table: Rows) -> Rows:
    def cofactor(i: int, j: int) -> Fraction:
        minor = [[x for b, x in enumerate(row) if b != i] for a, row in enumerate(table) if a != j]
        return -determinant(minor) if (i + j) % 2 else determinant(minor)

    return [[cofactor(i, j) for j in range(len(table))] for i in range(len(table))]


# -- numbers that move ---------------------------------------------------------------------------------------------------
#
# Taylor coefficients in one generator, exact where they can be, else with 60 digits.  Functions follow from their
# differential equations, so a derivative is a shift of coefficients and nothing is known of the kernel's rules.

CONTEXT = MPContext()
CONTEXT.dps = 60
#: Values that differ by less, beside their size, are equal: sums of what random points make lose far fewer digits.
TOLERANCE = CONTEXT.mpf(10) ** -30


def digits(value: Any) -> Any:
    """Return an exact number with 60 digits, any other as it is."""
    return CONTEXT.mpf(value.numerator) / value.denominator if isinstance(value, (int, Fraction)) else value


class Series(Fraction):
    """Σ parts[k] hᵏ, cut off; a constant where there is one part."""

    parts: list[Any]

    @classmethod
    def make(cls, parts: Sequence[Any]) -> Fraction:
        """Return the series; an exact constant is a fraction."""
        if len(parts) == 1 and isinstance(parts[0], (int, Fraction)):
            return Fraction(parts[0])
        found = super().__new__(cls, 0)
        found.parts = list(parts)
        return found

    @classmethod
    def moving(cls, value: Any, length: int) -> Fraction:
        """Return value + h."""
        return cls.make([value, Fraction(1), *([Fraction(0)] * (length - 2))])

    def __add__(self, other: Any) -> Any:
        return self.make([_sum(a, b) for a, b in _pairs(self, other)])

    def __mul__(self, other: Any) -> Any:
        pairs = _pairs(self, other)
        return self.make(
            [_total(_product(pairs[i][0], pairs[k - i][1]) for i in range(k + 1)) for k in range(len(pairs))]
        )

    def __truediv__(self, other: Any) -> Any:
        return _quotient(self, other)

    def __rtruediv__(self, other: Any) -> Any:
        return _quotient(other, self)

    def __pow__(self, exponent: Any) -> Any:
        total: Any = Fraction(1)
        for _ in range(exponent):
            total = total * self
        return total

    def __neg__(self) -> Any:
        return self * Fraction(-1)

    def __sub__(self, other: Any) -> Any:
        return self + Fraction(-1) * other

    def __rsub__(self, other: Any) -> Any:
        return -self + other

    __radd__, __rmul__ = __add__, __mul__

    def __bool__(self) -> bool:
        return self != Fraction(0)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, (int, Fraction)) and all(_near(a, b) for a, b in _pairs(self, other))

    def __repr__(self) -> str:
        return f"Series({', '.join(CONTEXT.nstr(digits(part), 10) for part in self.parts)})"

    __hash__ = None  # type: ignore[assignment]


#: A number no fraction is; its name means nothing else.
PI = Series.make([+CONTEXT.pi])


def _pairs(left: Any, right: Any) -> list[tuple[Any, Any]]:
    """Return the coefficients beside each other, those of a constant filled up with zeros."""
    a, b = (list(value.parts) if isinstance(value, Series) else [Fraction(value)] for value in (left, right))
    length = max(len(a), len(b))
    assert {len(a), len(b)} <= {1, length}, "both are series in one generator"
    a, b = ([*part, *([Fraction(0)] * (length - len(part)))] for part in (a, b))
    return list(zip(a, b, strict=True))


def _sum(a: Any, b: Any) -> Any:
    return a + b if isinstance(a, Fraction) and isinstance(b, Fraction) else digits(a) + digits(b)


def _product(a: Any, b: Any) -> Any:
    return a * b if isinstance(a, Fraction) and isinstance(b, Fraction) else digits(a) * digits(b)


def _total(values: Any) -> Any:
    total: Any = Fraction(0)
    for value in values:
        total = _sum(total, value)
    return total


def _near(a: Any, b: Any) -> bool:
    if isinstance(a, Fraction) and isinstance(b, Fraction):
        return bool(a == b)
    a, b = digits(a), digits(b)
    return bool(abs(a - b) <= TOLERANCE * (1 + abs(a) + abs(b)))


def _quotient(above: Any, below: Any) -> Any:
    pairs = _pairs(above, below)
    lead = pairs[0][1]
    if _near(lead, Fraction(0)):
        raise ZeroDivisionError
    found: list[Any] = []
    for k, (part, _) in enumerate(pairs):
        rest = _sum(part, _product(Fraction(-1), _total(_product(found[i], pairs[k - i][1]) for i in range(k))))
        found.append(
            rest / lead if isinstance(rest, Fraction) and isinstance(lead, Fraction) else digits(rest) / digits(lead)
        )
    return Series.make(found)


def rate(value: Any) -> Any:
    """Return the derivative of a number, or of every number in a table."""
    if isinstance(value, list):
        return [rate(entry) for entry in value]
    if not isinstance(value, Series) or len(value.parts) == 1:
        return Fraction(0)
    return Series.make([_product(part, Fraction(k)) for k, part in enumerate(value.parts) if k])


#: kind → its value at a number, its derivative as (sign, kind).
_FUNCTIONS: dict[str, tuple[Callable[[Any], Any], tuple[int, str]]] = {
    "exp": (CONTEXT.exp, (1, "exp")),
    "sin": (CONTEXT.sin, (1, "cos")),
    "cos": (CONTEXT.cos, (-1, "sin")),
    "sinh": (CONTEXT.sinh, (1, "cosh")),
    "cosh": (CONTEXT.cosh, (1, "sinh")),
}


def applied(kind: str, argument: Any) -> Any:
    """Return exp, cos, sin, cosh, sinh or sqrt of a number: f(a)' = f'(a) a', coefficient by coefficient."""
    parts = argument.parts if isinstance(argument, Series) else [argument]
    if kind == "sqrt":
        assert len(parts) == 1, "a root of what moves is not written"
        return Series.make([CONTEXT.sqrt(digits(parts[0]))])
    found: dict[str, list[Any]] = {}
    for name in dict.fromkeys((kind, _FUNCTIONS[kind][1][1])):
        at_zero = Fraction(0 if name in {"sin", "sinh"} else 1)
        exact = isinstance(parts[0], (int, Fraction)) and parts[0] == 0
        found[name] = [at_zero if exact else _FUNCTIONS[name][0](digits(parts[0]))]
    for k in range(1, len(parts)):
        new = {}
        for name in found:
            sign, other = _FUNCTIONS[name][1]
            whole = _total(_product(parts[i] * i, found[other][k - i]) for i in range(1, k + 1))
            new[name] = _product(whole, Fraction(sign, k))
        for name, part in new.items():
            found[name].append(part)
    return Series.make(found[kind])


def root_sum(polynomial: Sequence[Fraction], power: int, argument: Any) -> Any:
    """Return Σ λᵖ e^{λa} / q′(λ) over the roots λ of q, highest coefficient of q first; its derivative has the power p + 1."""
    parts = argument.parts if isinstance(argument, Series) else [argument]
    roots = CONTEXT.polyroots([digits(c) for c in polynomial], maxsteps=500, extraprec=400)
    degree = len(polynomial) - 1
    slope = [digits(c) * (degree - k) for k, c in enumerate(polynomial[:-1])]
    rows: list[list[Any]] = []
    for further in reversed(range(len(parts))):
        terms = (r ** (power + further) * CONTEXT.exp(r * digits(parts[0])) / CONTEXT.polyval(slope, r) for r in roots)
        row = [CONTEXT.re(sum(terms))]
        for k in range(1, len(parts) - further):
            whole = _total(_product(parts[i] * i, rows[-1][k - i]) for i in range(1, k + 1))
            row.append(_product(whole, Fraction(1, k)))
        rows.append(row)
    return Series.make(rows[-1])
