"""Exact values and plants at random, and the plain arithmetic of fractions by which results are judged.

The arithmetic here is written without symobs and without FLINT: lists of rows of `Fraction`, polynomials as lists of
coefficients with the highest power first.  Only `value_at` and `matrix_at` read kernel values, term by term.
"""

from __future__ import annotations

import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations
from math import lcm
from typing import Any, TypeAlias

import sympy
from hypothesis import strategies as st

from symobs.exact import Matrix, Scalar

Rows: TypeAlias = list[list[Fraction]]
Polynomial: TypeAlias = list[Fraction]
Point: TypeAlias = Mapping[str, Fraction]

# -- the same value twice: in the kernel and in SymPy ------------------------------------------------------------------


@dataclass(frozen=True)
class Twin:
    """One value, built by the same steps in the kernel and in SymPy."""

    scalar: Scalar
    expression: Any


def twin_symbol(name: str) -> Twin:
    return Twin(Scalar.symbol(name), sympy.Symbol(name))


def twin_number(number: Fraction | int) -> Twin:
    fraction = Fraction(number)
    return Twin(Scalar.of(fraction), sympy.Rational(fraction.numerator, fraction.denominator))


def combined(operation: Callable[..., Any], *parts: Twin) -> Twin:
    return Twin(operation(*(p.scalar for p in parts)), operation(*(p.expression for p in parts)))


small_fractions = st.builds(Fraction, st.integers(-6, 6), st.integers(1, 4))
#: Beyond the 2³¹ at which FLINT's factorisation over the integers gives up.
large_integers = st.integers(2**31, 2**70) | st.integers(-(2**70), -(2**31))


@st.composite
def polynomials(
    draw: st.DrawFn,
    names: Sequence[str] = ("a", "b", "s"),
    coefficients: st.SearchStrategy[Any] = small_fractions,
    degree: int = 2,
    most: int = 4,
) -> Twin:
    """A polynomial with at most `most` terms, each of degree at most `degree` in every name."""
    terms = draw(st.lists(st.tuples(coefficients, st.tuples(*(st.integers(0, degree) for _ in names))), max_size=most))
    total = twin_number(0)
    for coefficient, exponents in terms:
        term = twin_number(coefficient)
        for name, exponent in zip(names, exponents, strict=True):
            power = combined(lambda base, n=exponent: base**n, twin_symbol(name))
            term = combined(lambda x, y: x * y, term, power)
        total = combined(lambda x, y: x + y, total, term)
    return total


@st.composite
def rational_functions(draw: st.DrawFn, names: Sequence[str] = ("a", "b", "s"), degree: int = 2) -> Twin:
    """A quotient of two polynomials, not in lowest terms on purpose."""
    over, under, common = (draw(polynomials(names, degree=degree, most=3)) for _ in range(3))
    if under.scalar.is_zero or common.scalar.is_zero:
        return over
    return combined(lambda x, y, c: (x * c) / (y * c), over, under, common)


@st.composite
def matrices(draw: st.DrawFn, rows: int, columns: int, entries: st.SearchStrategy[Twin]) -> tuple[Matrix, Any]:
    """A matrix in the kernel and the same in SymPy; both may have no row or no column."""
    table = [[draw(entries) for _ in range(columns)] for _ in range(rows)]
    kernel = Matrix.of([[entry.scalar for entry in row] for row in table], columns)
    return kernel, sympy.Matrix(rows, columns, [entry.expression for row in table for entry in row])


numeric_entries: st.SearchStrategy[Twin] = small_fractions.map(twin_number)
parametric_entries: st.SearchStrategy[Twin] = numeric_entries | polynomials(("a", "b"), degree=1, most=2)
fraction_entries: st.SearchStrategy[Twin] = parametric_entries | rational_functions(("a",), degree=1)

# -- plants ------------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Sample:
    """A plant with one input and one output as rows of texts, and desired poles for it."""

    kind: str
    A: list[list[str]]
    B: list[list[str]]
    C: list[list[str]]
    poles: list[str]
    names: tuple[str, ...] = ()

    @property
    def order(self) -> int:
        return len(self.A)


Table: TypeAlias = list[list[int]]


def _times(left: Table, right: Table) -> Table:
    return [
        [sum(a * b for a, b in zip(row, column, strict=True)) for column in zip(*right, strict=True)] for row in left
    ]


def identity(order: int) -> Table:
    return [[int(i == j) for j in range(order)] for i in range(order)]


@st.composite
def unimodular(draw: st.DrawFn, order: int) -> tuple[Table, Table]:
    """An integer matrix of determinant 1 and its inverse: a product of shears."""
    T, inverse = identity(order), identity(order)
    pairs = list(permutations(range(order), 2))
    for i, j in draw(st.lists(st.sampled_from(pairs), max_size=4)) if pairs else []:
        factor = draw(st.sampled_from([-2, -1, 1, 2]))
        shear, back = identity(order), identity(order)
        shear[i][j], back[i][j] = factor, -factor
        T, inverse = _times(shear, T), _times(inverse, back)
    return T, inverse


@st.composite
def pole_lists(draw: st.DrawFn, order: int) -> list[str]:
    """Real, repeated and conjugate poles, as many as the order."""
    poles: list[str] = []
    while len(poles) < order:
        real = draw(st.integers(-4, 1))
        if order - len(poles) >= 2 and draw(st.booleans()):
            imaginary = draw(st.integers(1, 3))
            poles += [f"{real}+{imaginary}i", f"{real}-{imaginary}i"]
        else:
            poles.append(str(real))
    return poles


def _blocks(draw: st.DrawFn, order: int) -> Table:
    """Jordan blocks and rotations down the diagonal: repeated, defective and complex eigenvalues."""
    A = [[0] * order for _ in range(order)]
    position = 0
    while position < order:
        value = draw(st.integers(-2, 1))
        size = draw(st.integers(1, order - position))
        if size == 2 and draw(st.booleans()):
            turn = draw(st.integers(1, 2))
            A[position][position] = A[position + 1][position + 1] = value
            A[position][position + 1], A[position + 1][position] = turn, -turn
        else:
            for k in range(position, position + size):
                A[k][k] = value
                if k + 1 < position + size:
                    A[k][k + 1] = 1
        position += size
    return A


def _hide(A: Table, C: Table, hidden: int) -> None:
    """Cut the first states off from the output, and make their block triangular, so that its modes are integers."""
    for i, row in enumerate(A):
        for j in range(hidden):
            if i >= hidden or i > j:
                row[j] = 0
    C[0][:hidden] = [0] * hidden


KINDS = ("dense", "hidden", "defective", "parametric")


@st.composite
def plants(draw: st.DrawFn, kinds: Sequence[str] = KINDS, largest: int = 4) -> Sample:
    """A plant of one of the kinds.

    dense: any small integers.  hidden: unobservable and uncontrollable states behind a change of coordinates, some of
    whose modes are among the poles.  defective: Jordan blocks and rotations behind one.  parametric: one or two of the
    entries are expressions in `a` and `b`, of order 3 at most.
    """
    kind = draw(st.sampled_from(kinds))
    order = draw(st.integers(2 if kind == "hidden" else 1, min(largest, 3) if kind == "parametric" else largest))
    digits = st.integers(-2, 2)
    A = [[draw(digits) for _ in range(order)] for _ in range(order)]
    B, C = [[draw(digits)] for _ in range(order)], [[draw(digits) for _ in range(order)]]
    poles = draw(pole_lists(order))
    if kind == "hidden":
        hidden = draw(st.integers(1, order - 1))
        _hide(A, C, hidden)
        if draw(st.booleans()):
            poles = [*(str(A[j][j]) for j in range(hidden)), *draw(pole_lists(order - hidden))]
        if draw(st.booleans()):
            B = [row if i < hidden else [0] for i, row in enumerate(B)]
    if kind == "defective":
        A = _blocks(draw, order)
    if kind in {"hidden", "defective"}:
        T, inverse = draw(unimodular(order))
        A, B, C = _times(_times(T, A), inverse), _times(T, B), _times(C, inverse)
    a_text, b_text, c_text = ([[str(x) for x in row] for row in table] for table in (A, B, C))
    names: tuple[str, ...] = ()
    if kind == "parametric":
        forms = ["a", "a + 1", "-b", "2*a - b", "a*b", "1/a"]
        for _ in range(draw(st.integers(1, 2))):
            target, rows, columns = draw(
                st.sampled_from([(a_text, order, order), (b_text, order, 1), (c_text, 1, order)])
            )
            row, column = draw(st.integers(0, rows - 1)), draw(st.integers(0, columns - 1))
            target[row][column] = draw(st.sampled_from(forms))
        if draw(st.booleans()):
            poles[-1:] = ["-p"] if "i" not in poles[-1] else poles[-1:]
        names = ("a", "b", "p")
    return Sample(kind, a_text, b_text, c_text, poles, names)


# -- kernel values at a point ------------------------------------------------------------------------------------------


def _polynomial_at(polynomial: Scalar, numerators: Mapping[str, int], denominator: int) -> Fraction:
    """Evaluate by integers over one denominator: Σ c Π (xᵢ/q)^eᵢ = Σ c Π xᵢ^eᵢ q^(d − Σ eᵢ) / q^d."""
    terms = polynomial.terms()
    degree = max((sum(power for _, power in powers) for _, powers in terms), default=0)
    total = 0
    for coefficient, powers in terms:
        value, used = coefficient, 0
        for name, power in powers:
            value *= numerators[name] ** power
            used += power
        total += value * denominator ** (degree - used)
    return Fraction(total, denominator**degree)


def value_at(scalar: Scalar, point: Point) -> Fraction:
    """Evaluate a kernel scalar term by term; raises ZeroDivisionError where its denominator vanishes."""
    common = lcm(*(value.denominator for value in point.values()))
    numerators = {name: int(value * common) for name, value in point.items()}
    return _polynomial_at(scalar.numerator, numerators, common) / _polynomial_at(scalar.denominator, numerators, common)


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


# -- plain arithmetic --------------------------------------------------------------------------------------------------


def multiply(left: Sequence[Sequence[Fraction]], right: Sequence[Sequence[Fraction]]) -> Rows:
    columns = list(zip(*right, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction(0)) for column in columns] for row in left]


def subtract(left: Rows, right: Rows) -> Rows:
    return [[a - b for a, b in zip(p, q, strict=True)] for p, q in zip(left, right, strict=True)]


def faddeev_leverrier(A: Rows) -> tuple[Polynomial, list[Rows]]:
    """Return the coefficients of det(sI − A) and of adj(sI − A), highest power first."""
    order = len(A)
    coefficients, adjugates = [Fraction(1)], []
    M: Rows = [[Fraction(0)] * order for _ in range(order)]
    for k in range(1, order + 1):
        M = [[e + (coefficients[-1] if i == j else 0) for j, e in enumerate(row)] for i, row in enumerate(M)]
        adjugates.append(M)
        M = multiply(A, M)
        coefficients.append(-sum((M[i][i] for i in range(order)), Fraction(0)) / k)
    return coefficients, adjugates


def characteristic(A: Rows) -> Polynomial:
    return faddeev_leverrier(A)[0]


def eliminated(rows: Sequence[Sequence[Fraction]]) -> tuple[list[int], Rows]:
    """Return the pivot columns and the reduced rows."""
    work = [list(row) for row in rows]
    pivots: list[int] = []
    for column in range(len(work[0]) if work else 0):
        found = next((i for i in range(len(pivots), len(work)) if work[i][column]), None)
        if found is None:
            continue
        rank = len(pivots)
        work[rank], work[found] = work[found], work[rank]
        work[rank] = [entry / work[rank][column] for entry in work[rank]]
        for i, row in enumerate(work):
            if i != rank and row[column]:
                work[i] = [x - row[column] * y for x, y in zip(row, work[rank], strict=True)]
        pivots.append(column)
    return pivots, work[: len(pivots)]


def rank_of(rows: Sequence[Sequence[Fraction]]) -> int:
    return len(eliminated(rows)[0])


def observability_rows(A: Rows, C: Rows) -> Rows:
    rows, block = list(C), C
    for _ in range(len(A) - 1):
        block = multiply(block, A)
        rows += block
    return rows


def transposed(rows: Rows) -> Rows:
    return [list(column) for column in zip(*rows, strict=True)]


def assignable(A: Rows, C: Rows, phi: Polynomial) -> bool:
    """Tell whether some l has det(sI − A + l c) = φ(s).

    det(sI − A + l c) = χ(s) + c adj(sI − A) l, so this is a linear system: φ − χ among the combinations of the n
    polynomials c adj(sI − A).
    """
    chi, adjugates = faddeev_leverrier(A)
    spanned = transposed([multiply(C, part)[0] for part in adjugates])
    wanted = [x - y for x, y in zip(phi, chi, strict=True)][1:]
    return rank_of(spanned) == rank_of([*spanned, wanted])


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
