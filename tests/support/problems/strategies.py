"""Exact values and plants at random, for Hypothesis."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import permutations
from typing import TYPE_CHECKING, Any, TypeAlias

import sympy
from hypothesis import strategies as st

from symobs.exact import Matrix, Scalar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

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
