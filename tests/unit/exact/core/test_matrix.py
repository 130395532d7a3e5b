"""Matrices of the kernel: arithmetic, determinants, solving, rank and kernel, transfer functions, against SymPy."""

from __future__ import annotations

import pickle
from fractions import Fraction
from typing import Any

import pytest
import sympy
from hypothesis import given, settings
from hypothesis import strategies as st

from symobs.exact import (
    Field,
    Matrix,
    Scalar,
    apply_polynomial,
    echelon,
    from_coefficients,
    independent_rows,
    kernel,
    rank,
    transfer,
)
from symobs.exact.core.modular import Point, VanishingDenominator, random_prime
from symobs.exact.linear_algebra.krylov import Krylov
from symobs.exact.sympy_bridge.conversion import matrix_from_sympy, matrix_to_sympy, scalar_to_sympy
from symobs.formula.expression import parse_matrix
from tests.support.algebra import matrix_at, seeded, value_at
from tests.support.problems.strategies import (
    Twin,
    fraction_entries,
    matrices,
    numeric_entries,
    parametric_entries,
    polynomials,
    rational_functions,
    twin_number,
)

a, b, s = (Scalar.symbol(name) for name in "abs")
Pair = tuple[Matrix, Any]
SYMBOL = sympy.Symbol("s")
entries = st.sampled_from([numeric_entries, parametric_entries, fraction_entries])


@st.composite
def shaped(draw: st.DrawFn, *shapes: tuple[int, int]) -> list[Pair]:
    """Matrices of these shapes, all numeric, all with polynomial or all with fractional entries."""
    chosen = draw(entries)
    return [draw(matrices(*shape, chosen)) for shape in shapes]


@st.composite
def square(draw: st.DrawFn, largest: int = 3, columns: int = 0) -> list[Pair]:
    """A square matrix, and beside it one with as many rows and `columns` columns."""
    order = draw(st.integers(1, largest))
    return draw(shaped((order, order), (order, columns)))


def zero(expression: Any) -> bool:
    """Tell whether a SymPy scalar or matrix is 0."""
    values = expression if isinstance(expression, sympy.MatrixBase) else [expression]
    return all(sympy.cancel(sympy.together(value)) == 0 for value in values)


def same(ours: Matrix | Scalar, theirs: Any) -> bool:
    if isinstance(ours, Scalar):
        return zero(scalar_to_sympy(ours) - theirs)
    found = matrix_to_sympy(ours)
    return found.shape == theirs.shape and zero(found - theirs)


sizes = st.tuples(st.integers(0, 3), st.integers(0, 3), st.integers(0, 3))

#: Examples a test: SymPy is the slow party here.
few = settings(max_examples=15)


class TestArithmetic:
    @given(st.data(), sizes)
    @few
    def test_sums_products_and_transposes_are_those_of_sympy(self, data: st.DataObject, size: tuple[int, ...]) -> None:
        m, n, k = size
        (x, X), (y, Y), (z, Z) = data.draw(shaped((m, n), (m, n), (n, k)))
        assert same(x + y, X + Y)
        assert same(x - y, X - Y)
        assert same(-x, -X)
        assert same(x.T, X.T)
        assert same(x * Fraction(2, 3), X * sympy.Rational(2, 3))
        assert same(x * (a / 2), X * sympy.Symbol("a") / 2)
        product = x @ z
        assert product.shape == (m, k)
        assert same(product, X * Z)
        assert (x @ z).T == z.T @ x.T

    @given(st.data(), st.integers(0, 3), st.integers(0, 3))
    @few
    def test_equality_hash_and_pickling_do_not_depend_on_the_field(self, data: st.DataObject, m: int, n: int) -> None:
        ((x, X),) = data.draw(shaped((m, n)))
        wide = x.within(x.field | Field.of(("A", "s", "zeta")))
        detour = x + Matrix.of([[s] * n for _ in range(m)], n) - Matrix.of([[s] * n for _ in range(m)], n)
        back = pickle.loads(pickle.dumps(wide))  # noqa: S301 - our own bytes
        for other in (wide, detour, back, x.normal(), wide.normal(), matrix_from_sympy(X, "here")):
            assert other == x
            assert hash(other) == hash(x)
            assert str(other) == str(x)
            assert other.shape == x.shape == (m, n)
            assert other.names == x.names
            assert other.common_denominator() == x.common_denominator()
        assert x.within(wide.field).within(x.field) == x

    def test_shapes_that_do_not_fit_are_refused(self) -> None:
        with pytest.raises(ValueError, match="cannot add"):
            Matrix.zeros(2, 2) + Matrix.zeros(2, 3)
        with pytest.raises(ValueError, match="cannot multiply"):
            Matrix.zeros(2, 2) @ Matrix.zeros(3, 2)
        with pytest.raises(ValueError, match="different lengths"):
            Matrix.of([[1, 2], [3]])
        with pytest.raises(ValueError, match="differ in height"):
            Matrix.block([[Matrix.zeros(1, 1), Matrix.zeros(2, 1)]])
        with pytest.raises(ValueError, match="differ in width"):
            Matrix.block([[Matrix.zeros(1, 2)], [Matrix.zeros(1, 3)], [Matrix.zeros(1, 1)]])


class TestDeterminants:
    @given(square(3))
    @few
    def test_determinant_adjugate_and_characteristic_polynomial(self, drawn: list[Pair]) -> None:
        x, X = drawn[0]
        assert same(x.determinant(), X.det(method="berkowitz"))
        assert same(x.adjugate(), X.adjugate(method="berkowitz"))
        assert x @ x.adjugate() == x.adjugate() @ x == Matrix.identity(x.shape[0]) * x.determinant()
        assert same(x.characteristic_polynomial("s"), X.charpoly(SYMBOL).as_expr())

    @given(square(3, columns=2))
    @few
    def test_solving_and_inverting(self, drawn: list[Pair]) -> None:
        (x, X), (y, _) = drawn
        if zero(X.det(method="berkowitz")):
            for action in (x.inverse, lambda: x.solve(y)):
                with pytest.raises(ZeroDivisionError):
                    action()
            return
        assert x @ x.solve(y) == y
        assert x @ x.inverse() == Matrix.identity(x.shape[0])
        assert x**-2 @ x**3 == x

    @pytest.mark.parametrize("order", [8, 9, 10])
    def test_determinants_on_both_sides_of_the_change_of_algorithm(self, order: int) -> None:
        generator = seeded(order)
        numbers = [[generator.randint(-3, 3) for _ in range(order)] for _ in range(order)]
        numbers[0][0] = numbers[1][0] = 0  # the first pivot is found two rows below
        X = sympy.Matrix(numbers)
        x = Matrix.of(numbers)
        marked = Matrix.of(
            [[entry + (a if i == 1 == j else 0) for j, entry in enumerate(row)] for i, row in enumerate(numbers)]
        )
        minor = X.minor(1, 1)
        assert same(x.determinant(), X.det())
        assert same(marked.determinant(), X.det() + sympy.Symbol("a") * minor)
        assert marked.determinant() == marked.T.determinant()
        singular = Matrix.block([[marked.select(range(order - 1), range(order))], [marked.select([0], range(order))]])
        assert singular.determinant().is_zero


class TestElimination:
    @given(st.data(), st.integers(0, 4), st.integers(0, 4))
    @few
    def test_rank_and_kernel_are_those_of_sympy(self, data: st.DataObject, m: int, n: int) -> None:
        ((x, X),) = data.draw(shaped((m, n)))
        if m and n and data.draw(st.booleans()):  # a dependent row, so that ranks do drop
            x, X = (
                Matrix.block([[x], [x.select([0], range(n)) * (a + 1)]]),
                X.col_join(X[:1, :] * (sympy.Symbol("a") + 1)),
            )
        expected = X.rank(simplify=True) if m and n else 0
        assert rank(x) == rank(x.T) == expected
        basis = kernel(x)
        assert basis.shape == (n, n - expected)
        assert (x @ basis).is_zero
        assert rank(basis) == n - expected
        assert basis.common_denominator().is_one
        rows = independent_rows(x)
        assert len(rows) == expected
        assert rank(x.select(rows, range(n))) == expected
        pivots, vectors = echelon(x)
        assert len(pivots) == expected
        assert len(vectors) == n - expected
        assert rank(x.select(range(x.shape[0]), pivots)) == expected

    def test_modulo_a_relation_what_it_divides_is_zero(self) -> None:
        x = Matrix.of([[a - b, Scalar.of(1)], [a**2 - b**2, a + b]])
        assert rank(x) == 1
        pivots, vectors = echelon(x, a - b)
        assert pivots == (1,)
        assert [v.entries for v in vectors] == [(Scalar.of(1), Scalar.of(0))]


class TestPolynomialsOfMatrices:
    @given(square(3, columns=1), st.lists(polynomials(("a", "s"), degree=2, most=3), max_size=3))
    @few
    def test_horner_gives_what_powers_give(self, drawn: list[Pair], factors: list[Twin]) -> None:
        (x, X), (v, V) = drawn
        expected = V
        for factor in factors:
            powers = reversed(sympy.Poly(factor.expression, SYMBOL).all_coeffs())
            expected = sum((c * X**k for k, c in enumerate(powers)), sympy.zeros(*X.shape)) * expected
        assert same(apply_polynomial([f.scalar for f in factors], "s", x, v), expected)

    @given(
        st.lists(st.lists(st.fractions(-9, 9, max_denominator=9), min_size=4, max_size=4), min_size=6, max_size=6),
    )
    @few
    def test_the_gain_from_a_power_series_is_that_of_ackermann(self, rows: list[list[Fraction]]) -> None:
        *table, row, numbers = rows
        A, c = parse_matrix(table), parse_matrix([row])
        coefficients = [Fraction(1), *numbers]
        krylov = Krylov.of(A, c)
        if krylov.is_singular:
            with pytest.raises(ZeroDivisionError):
                krylov.placing(coefficients)
            return
        phi = from_coefficients([Scalar.of(number) for number in coefficients], "s")
        gain = krylov.placing(coefficients)
        assert gain == apply_polynomial([phi], "s", A, krylov.solve_last())
        assert (A - gain @ c).characteristic_polynomial("s") == phi


class TestKrylov:
    @given(st.data(), st.integers(1, 4))
    @few
    def test_rows_determinant_and_last_column_of_the_inverse(self, data: st.DataObject, n: int) -> None:
        (x, _), (c, _) = data.draw(shaped((n, n), (1, n)))
        krylov = Krylov.of(x, c)
        self.examine(krylov, x, c)
        self.examine(pickle.loads(pickle.dumps(krylov)), x, c)  # noqa: S301 - our own bytes

    @staticmethod
    def examine(krylov: Krylov, x: Matrix, c: Matrix) -> None:
        order, row = x.shape[0], c
        for k in range(order):
            assert krylov.rows[k] == row
            row = row @ x
        whole = krylov.matrix
        assert krylov.determinant == whole.determinant()
        if krylov.determinant.is_zero:
            with pytest.raises(ZeroDivisionError):
                krylov.solve_last()
        else:
            assert whole @ krylov.solve_last() == Matrix.unit(order, order - 1)


class TestTransfer:
    @given(st.data(), st.integers(1, 3))
    @few
    def test_the_transfer_function_is_its_definition(self, data: st.DataObject, n: int) -> None:
        (x, X), (u, U), (c, C), (d, D) = data.draw(shaped((n, n), (n, 1), (1, n), (1, 1)))
        numerator, characteristic = transfer(x, u, c, d[0, 0], "s")
        assert same(characteristic, X.charpoly(SYMBOL).as_expr())
        pencil = SYMBOL * sympy.eye(n) - X
        expected = (C * pencil.adjugate(method="berkowitz") * U)[0, 0] + D[0, 0] * pencil.det(method="berkowitz")
        assert same(numerator, expected)

    def test_pole_and_zero_that_cancel_are_left_in(self) -> None:
        numerator, characteristic = transfer(
            Matrix.of([[-1, 0], [0, a]]), Matrix.column([1, 0]), Matrix.row([1, 1]), Scalar.of(0), "s"
        )
        assert (numerator, characteristic) == (s - a, (s + 1) * (s - a))


class TestModularPoints:
    @given(rational_functions(), st.integers(0, 2**32))
    @few
    def test_the_residue_is_that_of_the_value_at_the_point(self, x: Twin, seed: int) -> None:
        point = Point(("a", "b", "s"), seeded(seed))
        exact = value_at(x.scalar, {name: Fraction(value) for name, value in point.values.items()})
        assert point.scalar(x.scalar) == residue(exact, point.prime)

    @given(st.data(), st.integers(0, 3), st.integers(0, 3), st.integers(0, 2**32))
    @few
    def test_the_residues_of_a_matrix_are_those_of_its_entries(
        self, data: st.DataObject, m: int, n: int, seed: int
    ) -> None:
        ((x, _),) = data.draw(shaped((m, n)))
        point = Point(("a", "b"), seeded(seed))
        exact = matrix_at(x, {name: Fraction(value) for name, value in point.values.items()})
        found = point.matrix(x)
        assert (found.nrows(), found.ncols()) == (m, n)
        expected = [[residue(entry, point.prime) for entry in row] for row in exact]
        assert [[int(found[i, j]) for j in range(n)] for i in range(m)] == expected

    def test_primes_are_prime_have_64_bits_and_repeat_with_the_seed(self) -> None:
        for seed in range(20):
            found = random_prime(seeded(seed))
            assert sympy.isprime(found)
            assert found.bit_length() == 64
            assert found == random_prime(seeded(seed))

    def test_a_vanishing_denominator_is_told(self) -> None:
        point = Point(("a",), seeded(1))
        value = 1 / (a - point.values["a"])
        with pytest.raises(VanishingDenominator):
            point.scalar(value)
        with pytest.raises(VanishingDenominator):
            point.matrix(Matrix.of([[value]]))
        assert point.scalar(twin_number(Fraction(1, 3)).scalar) * 3 % point.prime == 1


def residue(number: Fraction, prime: int) -> int:
    return number.numerator * pow(number.denominator, -1, prime) % prime
