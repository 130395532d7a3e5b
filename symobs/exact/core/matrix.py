"""Matrices over Q(generators): an integral table over one common denominator.

The table is an `fmpz_mat` where the field has no generators, rows of `fmpz_mpoly` otherwise.  Products and sums do
not reduce; reading an entry does, and `rows` (all entries, reduced) is computed once.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from functools import cached_property, lru_cache, reduce
from math import gcd, lcm
from typing import TYPE_CHECKING, cast

from flint import fmpq_mat, fmpz, fmpz_mat, fmpz_mpoly

from symobs.exact.core import ring
from symobs.exact.core.field import RATIONALS, Field
from symobs.exact.core.ring import degree_bound, length_bits, number_of, polynomial_fingerprint
from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence


class Matrix:
    """An immutable matrix; shape (rows, columns), either may be 0."""

    def __init__(
        self, field: Field, table: fmpz_mat | ring.Rows, denominator: fmpz_mpoly, shape: tuple[int, int]
    ) -> None:
        """Take a table over a common denominator; `Matrix.of` is the general constructor."""
        self.field, self.shape = field, shape
        self.table, self.denominator = (
            ring.normal_table(field, table, denominator) if field.roots else (table, denominator)
        )
        self._elsewhere: dict[Field, Matrix] = {}

    # -- construction ---------------------------------------------------------------------------------------------

    @staticmethod
    def of(entries: Iterable[Sequence[Scalar | int | Fraction]], columns: int | None = None) -> Matrix:
        """Return the matrix with these rows; `columns` is needed only where there is no row."""
        rows = tuple([tuple([Scalar.of(entry) for entry in row]) for row in entries])
        field = reduce(Field.__or__, {entry.field: None for row in rows for entry in row}, RATIONALS)
        shape = (len(rows), len(rows[0]) if rows else (columns or 0))
        if any(len(row) != shape[1] for row in rows):
            message = f"rows of different lengths: {[len(row) for row in rows]}"
            raise ValueError(message)
        lifted = [[entry.within(field) for entry in row] for row in rows]
        parts = (entry.denominator_part for entry in itertools.chain(*lifted))
        denominator = reduce(ring.common_multiple, parts, field.one)
        table = tuple([tuple([entry.over(denominator) for entry in row]) for row in lifted])
        matrix = build(field, table, denominator, shape)
        matrix.__dict__["rows"] = rows
        return matrix

    @staticmethod
    @lru_cache(maxsize=64)
    def identity(order: int) -> Matrix:
        """Return the identity."""
        return Matrix.of([[int(i == j) for j in range(order)] for i in range(order)])

    @staticmethod
    @lru_cache(maxsize=64)
    def zeros(rows: int, columns: int) -> Matrix:
        """Return the zero matrix."""
        return Matrix.of([[0] * columns for _ in range(rows)], columns)

    @staticmethod
    def unit(order: int, index: int) -> Matrix:
        """Return the column with 1 at `index` and 0 elsewhere."""
        return Matrix.of([[int(i == index)] for i in range(order)])

    @staticmethod
    def column(entries: Sequence[Scalar | int | Fraction]) -> Matrix:
        """Return a column."""
        return Matrix.of([[entry] for entry in entries], 1)

    @staticmethod
    def row(entries: Sequence[Scalar | int | Fraction]) -> Matrix:
        """Return a row."""
        return Matrix.of([list(entries)])

    @staticmethod
    def block(blocks: Sequence[Sequence[Matrix]]) -> Matrix:
        """Return the matrix of blocks of matching sizes."""
        for line in blocks:
            heights = {part.shape[0] for part in line}
            if len(heights) != 1:
                message = f"blocks of one row differ in height: {sorted(heights)}"
                raise ValueError(message)
        widths = {sum(part.shape[1] for part in line) for line in blocks}
        if len(widths) > 1:
            message = f"rows of blocks differ in width: {sorted(widths)}"
            raise ValueError(message)
        if all(isinstance(part.table, fmpz_mat) for line in blocks for part in line):
            return _block_of_numbers(blocks)
        rows = [[entry for part in line for entry in part.rows[i]] for line in blocks for i in range(line[0].shape[0])]
        return Matrix.of(rows, sum(part.shape[1] for part in blocks[0]))

    def within(self, field: Field) -> Matrix:
        """Return the same matrix over `field`; cached."""
        if field is self.field:
            return self
        if field not in self._elsewhere:
            if len(self._elsewhere) == 16:  # the identity meets every field there is
                self._elsewhere.clear()
            self._elsewhere[field] = self._carried(field)
        return self._elsewhere[field]

    def _carried(self, field: Field) -> Matrix:
        if isinstance(self.table, fmpz_mat):
            table = ring.rows_of(self.table, field)
        elif not field.names:
            return Matrix.of([[Scalar.of(entry.fraction()) for entry in row] for row in self.rows], self.shape[1])
        else:
            table = tuple(tuple(map(field.route_from(self.field).carry, row)) for row in self.table)
        return Matrix(field, table, field.lift(self.denominator, self.field), self.shape)

    @property
    def polynomials(self) -> ring.Rows:
        """The table as rows of polynomials, in the numeric case too."""
        return ring.rows_of(self.table, self.field) if isinstance(self.table, fmpz_mat) else self.table

    # -- reading --------------------------------------------------------------------------------------------------

    @cached_property
    def rows(self) -> tuple[tuple[Scalar, ...], ...]:
        """All entries, reduced."""
        return tuple(tuple(self._reduced(i, j) for j in range(self.shape[1])) for i in range(self.shape[0]))

    def _reduced(self, i: int, j: int) -> Scalar:
        entry = self.field.context.constant(self.table[i, j]) if isinstance(self.table, fmpz_mat) else self.table[i][j]
        return Scalar.reduced(self.field, entry, self.denominator)

    def __getitem__(self, index: tuple[int, int]) -> Scalar:
        return self.rows[index[0]][index[1]]

    @property
    def entries(self) -> tuple[Scalar, ...]:
        """All entries, row by row."""
        return tuple(entry for row in self.rows for entry in row)

    @cached_property
    def names(self) -> frozenset[str]:
        """The generators that really occur."""
        return frozenset().union(*(entry.names for entry in self.entries)) if self.field.names else frozenset()

    @property
    def size(self) -> int:
        """The number of terms of the table and the denominator."""
        if isinstance(self.table, fmpz_mat):
            return self.shape[0] * self.shape[1] + 1
        return sum(len(entry) for row in self.table for entry in row) + len(self.denominator)

    def degrees(self) -> tuple[int, int]:
        """Return upper bounds of the total degrees of the table's entries and of the denominator."""
        return self._degrees

    @cached_property
    def _degrees(self) -> tuple[int, int]:
        if isinstance(self.table, fmpz_mat):
            return 0, 0
        above = max([degree_bound(entry) for row in self.table for entry in row], default=0)
        return above, degree_bound(self.denominator)

    def lengths(self) -> tuple[float, float]:
        """Return bounds of log₂ of the sums of the |coefficients| of the table's entries and of the denominator."""
        if isinstance(self.table, fmpz_mat):
            above = float(max((abs(entry).bit_length() for entry in self.table.entries()), default=0))
        else:
            above = max((length_bits(entry) for row in self.table for entry in row), default=0.0)
        return above, length_bits(self.denominator)

    def fingerprint(self) -> str:
        """Return a text that identifies the matrix in practice."""
        if isinstance(self.table, fmpz_mat):
            return f"{self.table.tolist()} {self.denominator}"
        texts = [polynomial_fingerprint(entry) for row in self.table for entry in row]
        return f"{' '.join(texts)} {polynomial_fingerprint(self.denominator)}"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Matrix):
            return NotImplemented
        if self.shape != other.shape:
            return False
        a, b, _ = self._fit(other)
        if a.denominator == b.denominator:
            return a is b or bool(a.table == b.table)
        return (a - b).is_zero

    def __hash__(self) -> int:
        return hash((self.shape, self.rows))

    def __reduce__(self) -> tuple[object, ...]:
        return (Matrix.of, (self.rows, self.shape[1]))

    def __str__(self) -> str:
        return "[" + "; ".join(" ".join(str(entry).replace(" ", "") for entry in row) for row in self.rows) + "]"

    def __repr__(self) -> str:
        return f"Matrix({self})"

    def common_denominator(self) -> Scalar:
        """Return the least common denominator of the entries."""
        if isinstance(self.table, fmpz_mat):
            return Scalar(self.field, _lowest(self).denominator, self.field.one)
        parts = (entry.within(self.field).denominator for entry in self.entries)
        return reduce(lambda multiple, below: multiple * (below / multiple).numerator, parts, Scalar.of(1))

    @property
    def is_zero(self) -> bool:
        """Whether every entry is 0."""
        if isinstance(self.table, fmpz_mat):
            return bool(self.table == fmpz_mat(*self.shape))
        return not any(entry for row in self.table for entry in row)

    def select(self, rows: Iterable[int], columns: Iterable[int]) -> Matrix:
        """Return the submatrix of these rows and columns."""
        wanted = tuple(columns)
        return Matrix.of([[self.rows[i][j] for j in wanted] for i in rows], len(wanted))

    # -- arithmetic -----------------------------------------------------------------------------------------------

    def _fit(self, other: Matrix) -> tuple[Matrix, Matrix, Field]:
        if self.field is other.field:
            return self, other, self.field
        field = self.field | other.field
        return self.within(field), other.within(field), field

    def __add__(self, other: Matrix) -> Matrix:
        if self.shape != other.shape:
            message = f"cannot add {self.shape} and {other.shape}"
            raise ValueError(message)
        a, b, field = self._fit(other)
        denominator, left, right = ring.align(a.denominator, b.denominator)
        a, b = a.scaled(left), b.scaled(right)
        if isinstance(a.table, fmpz_mat) and isinstance(b.table, fmpz_mat):
            return Matrix(field, a.table + b.table, denominator, self.shape)
        return Matrix(field, ring.added(a.polynomials, b.polynomials), denominator, self.shape)

    def __neg__(self) -> Matrix:
        return self.scaled(self.field.context.constant(-1))

    def __sub__(self, other: Matrix) -> Matrix:
        return self + (-other)

    def scaled(self, factor: fmpz_mpoly) -> Matrix:
        """Return the table times a polynomial of the field, over the same denominator."""
        if factor.is_one():
            return self
        if isinstance(self.table, fmpz_mat):
            return Matrix(self.field, self.table * ring.number_of(factor), self.denominator, self.shape)
        table = tuple(tuple(entry * factor for entry in row) for row in self.table)
        return Matrix(self.field, table, self.denominator, self.shape)

    def __mul__(self, factor: Scalar | int | Fraction) -> Matrix:
        scalar = Scalar.of(factor)
        field = self.field | scalar.field
        scalar, matrix = scalar.within(field), self.within(field)
        scaled = matrix.scaled(scalar.numerator_part)
        return Matrix(field, scaled.table, matrix.denominator * scalar.denominator_part, self.shape)

    __rmul__ = __mul__

    def __matmul__(self, other: Matrix) -> Matrix:
        if self.shape[1] != other.shape[0]:
            message = f"cannot multiply {self.shape} by {other.shape}"
            raise ValueError(message)
        a, b, field = self._fit(other)
        shape = (self.shape[0], other.shape[1])
        denominator = a.denominator * b.denominator
        if isinstance(a.table, fmpz_mat) and isinstance(b.table, fmpz_mat):
            return _lowest(Matrix(field, a.table * b.table, denominator, shape))
        if 0 in (*shape, self.shape[1]):
            return Matrix.zeros(*shape).within(field)
        return Matrix(field, ring.product(a.polynomials, b.polynomials, field.zero), denominator, shape)

    def __pow__(self, exponent: int) -> Matrix:
        if exponent < 0:
            return self.inverse() ** -exponent
        power = Matrix.identity(self.shape[0])
        for _ in range(exponent):
            power = power @ self
        return power

    @cached_property
    def T(self) -> Matrix:
        """The transpose."""
        shape = (self.shape[1], self.shape[0])
        if isinstance(self.table, fmpz_mat):
            return Matrix(self.field, self.table.transpose(), self.denominator, shape)
        if 0 in shape:
            return Matrix.zeros(*shape).within(self.field)
        return Matrix(self.field, ring.transpose(self.table), self.denominator, shape)

    def normal(self) -> Matrix:
        """Return the same matrix with the common factor of entries and denominator cancelled."""
        if isinstance(self.table, fmpz_mat):
            return _lowest(self)
        if ring.coprime(self.denominator, (entry for row in self.table for entry in row)):
            return self
        shared = self.denominator
        for row in self.table:
            for entry in row:
                if shared.is_one():
                    return self
                if entry:
                    shared = shared.gcd(entry)
        table = tuple(tuple(entry / shared for entry in row) for row in self.table)
        return Matrix(self.field, table, self.denominator / shared, self.shape)

    def substitute(self, values: Mapping[str, Scalar]) -> Matrix:
        """Return the matrix with generators replaced; raises ZeroDivisionError where a denominator vanishes."""
        return Matrix.of([[entry.substitute(values) for entry in row] for row in self.rows], self.shape[1])

    # -- determinants and what follows from them ------------------------------------------------------------------

    def determinant(self) -> Scalar:
        """Return the determinant of a square matrix; raises ValueError for any other."""
        order, width = self.shape
        if order != width:
            raise ValueError(self.shape)
        if isinstance(self.table, fmpz_mat):
            top = self.field.context.constant(self.table.det())
        else:
            top = ring.determinant(self.table, self.field)
        return Scalar.reduced(self.field, top, self.denominator**order)

    def adjugate(self) -> Matrix:
        """Return adj(M), with M adj(M) = det(M) I."""
        order = self.shape[0]
        columns = [self.adjugate_column(j).entries for j in range(order)]
        return Matrix.of(list(zip(*columns, strict=True)), order)

    def adjugate_column(self, index: int) -> Matrix:
        """Return one column of adj(M): the cofactors of row `index`."""
        order = self.shape[0]
        column = tuple((entry,) for entry in ring.cofactors(self.polynomials, index, self.field))
        return build(self.field, column, self.denominator ** (order - 1), (order, 1))

    def inverse(self) -> Matrix:
        """Return the inverse; raises ZeroDivisionError where the determinant is 0."""
        return self.solve(Matrix.identity(self.shape[0]))

    def solve(self, right: Matrix) -> Matrix:
        """Return X with M X = right; raises ZeroDivisionError where det M = 0."""
        a, b, field = self._fit(right)
        if isinstance(a.table, fmpz_mat) and isinstance(b.table, fmpz_mat):
            table, below = fmpq_mat(a.table).solve(fmpq_mat(b.table)).numer_denom()
            top, bottom = a.denominator, b.denominator * field.context.constant(below)
            return _lowest(Matrix(field, table * top.leading_coefficient(), bottom, b.shape))
        rows, order = a.polynomials, a.shape[0]
        determinant = ring.determinant(rows, field)
        if not determinant:
            message = "the matrix is singular"
            raise ZeroDivisionError(message)
        adjugate = ring.transpose(tuple(ring.cofactors(rows, i, field) for i in range(order)))
        product = ring.product(adjugate, b.polynomials, field.zero)
        return Matrix(field, product, determinant * b.denominator, b.shape).scaled(a.denominator)

    def characteristic_polynomial(self, variable: str) -> Scalar:
        """Return det(variable · I − M) for a matrix free of `variable`."""
        order = self.shape[0]
        field = self.field | Field.of((variable,))
        generator = field.context.gen(field.position[variable])
        if isinstance(self.table, fmpz_mat):
            scale = self.denominator.leading_coefficient()
            top = field.zero
            for power, coefficient in enumerate(self.table.charpoly()):
                top = top + field.context.constant(coefficient * scale**power) * generator**power
            return Scalar.reduced(field, top, field.context.constant(scale**order))
        lifted = self.within(field)
        diagonal = generator * lifted.denominator
        rows = tuple(
            tuple((diagonal - entry) if i == j else -entry for j, entry in enumerate(row))
            for i, row in enumerate(lifted.polynomials)
        )
        return Scalar.reduced(field, ring.determinant(rows, field), lifted.denominator**order)


def build(field: Field, table: ring.Rows, denominator: fmpz_mpoly, shape: tuple[int, int]) -> Matrix:
    """Return the matrix of a table of polynomials, as integers if the field has no generators."""
    if field.names:
        return Matrix(field, table, denominator, shape)
    numbers = [ring.number_of(entry) for row in table for entry in row]
    return _lowest(Matrix(field, fmpz_mat(*shape, numbers), denominator, shape))


def _lowest(matrix: Matrix) -> Matrix:
    """Cancel the common integer of a numeric table and its denominator."""
    if not isinstance(matrix.table, fmpz_mat) or matrix.denominator.is_one():
        return matrix
    below = matrix.denominator.leading_coefficient()
    shared = below
    for entry in matrix.table.entries():
        shared = shared.gcd(entry)
        if shared == 1:
            break
    if below < 0:
        shared = -shared
    if shared == 1:
        return matrix
    table = fmpz_mat(*matrix.shape, [entry // shared for entry in matrix.table.entries()])
    return Matrix(matrix.field, table, matrix.field.context.constant(below // shared), matrix.shape)


def _block_of_numbers(blocks: Sequence[Sequence[Matrix]]) -> Matrix:
    """Return the matrix of blocks of numbers."""
    below = reduce(ring.common_multiple, [part.denominator for line in blocks for part in line], RATIONALS.one)
    rows: list[list[fmpz]] = []
    for line in blocks:
        tables = [part.scaled(below / part.denominator).table.tolist() for part in line]  # type: ignore[union-attr]
        rows += [[entry for part in row for entry in part] for row in zip(*tables, strict=True)]
    width = sum(part.shape[1] for part in blocks[0])
    return _lowest(
        Matrix(RATIONALS, fmpz_mat(len(rows), width, list(itertools.chain(*rows))), below, (len(rows), width))
    )


# Matrices of numbers, in integers over one common denominator, and numbers as multiples of common measures.


#: Euclid's algorithm on a few numbers takes as many steps as their quotients have in sum.
_EUCLIDEAN_STEPS = 1000


def matrix_of_numbers(rows: Sequence[Sequence[int | Fraction]]) -> Matrix:
    """Return the matrix with these rows, all of one length and none empty, over their least common denominator."""
    common = lcm(*(entry.denominator for row in rows for entry in row))
    numbers = [entry.numerator * (common // entry.denominator) for row in rows for entry in row]
    shape = (len(rows), len(rows[0]))
    return Matrix(RATIONALS, fmpz_mat(*shape, numbers), RATIONALS.context.constant(common), shape)


def horner(coefficients: Sequence[Scalar], matrix: Matrix, vector: Matrix) -> Matrix:
    """Return Σ cₖ Mⁿ⁻ᵏ v, nothing cancelled: with M = N/d and cₖ = nₖ/b the step is w ← N w + nₖ dᵏ v."""
    table, column = matrix.table, vector.table
    assert isinstance(table, fmpz_mat)  # noqa: S101 - an invariant of the rationals
    assert isinstance(column, fmpz_mat)  # noqa: S101 - the same
    fractions = [coefficient.fraction() for coefficient in coefficients]
    common = lcm(*(fraction.denominator for fraction in fractions))
    first, *others = (fraction.numerator * (common // fraction.denominator) for fraction in fractions)
    image, power, scale = column * first, fmpz(1), number_of(matrix.denominator)
    for number in others:
        power *= scale
        image = table * image
        if number:
            image += column * (number * power)
    below = number_of(vector.denominator) * common * power
    return Matrix(RATIONALS, image, RATIONALS.context.constant(below), vector.shape)


def whole_product(left: Sequence[Sequence[int]], right: Sequence[Sequence[int]]) -> list[list[int]]:
    """Return the product of two matrices of whole numbers, given by their rows.

    Its entries stay numbers of the kernel: to turn them into Python's takes longer than the product.
    """
    return cast("list[list[int]]", (fmpz_mat(left) * fmpz_mat(right)).tolist())


def measures(numbers: Sequence[Fraction], bound: int) -> dict[Fraction, list[tuple[Fraction, int]]]:
    """Return positive numbers as sums of whole multiples of a few positive ones: (measure, multiple) for each.

    One measure is enough, but where it is small the multiples are large.  The relations Σ nᵢ cᵢ = 0 of the numbers that
    are kept have |nᵢ| ≤ `bound`; the others would need a polynomial of such a degree, and count as none.
    """
    below = lcm(*(number.denominator for number in numbers))
    whole = [int(number * below) for number in numbers]
    common = gcd(*whole)
    if whole[-1] // common <= bound:
        return {c: [(Fraction(common, below), count // common)] for c, count in zip(numbers, whole, strict=True)}
    kept = [row for row in _kernel([whole], len(whole)) if max(map(abs, row)) <= bound]
    basis = _kernel(kept, len(whole))
    gram = fmpz_mat([[sum(x * y for x, y in zip(p, q, strict=True)) for p in basis] for q in basis])
    solved = gram.solve(fmpz_mat([[sum(x * y for x, y in zip(p, whole, strict=True))] for p in basis]))
    sizes = [Fraction(int(entry.p), int(entry.q)) / below for entry in solved.entries()]
    basis = [row if size > 0 else [-x for x in row] for row, size in zip(basis, sizes, strict=True)]
    sizes = [abs(size) for size in sizes]
    _turn_positive(basis, sizes)
    return {
        c: [(size, row[i]) for row, size in zip(basis, sizes, strict=True) if row[i] and size]
        for i, c in enumerate(numbers)
    }


def _kernel(rows: Sequence[Sequence[int]], length: int) -> list[list[int]]:
    """Return short vectors that are a basis of the whole-numbered vectors orthogonal to linearly independent rows."""
    weight = (1 << length) * length * max((abs(x) for row in rows for x in row), default=1) ** max(2 * len(rows), 1)
    lattice = [[int(i == j) for j in range(length)] + [weight * row[i] for row in rows] for i in range(length)]
    reduced = [[int(x) for x in row] for row in fmpz_mat(lattice).lll().tolist()]
    return [row[:length] for row in reduced if not any(row[length:])]


def _turn_positive(basis: list[list[int]], sizes: list[Fraction]) -> None:
    """Change a basis by Euclid's algorithm, c = Σ sizeⱼ basisⱼ the same, until no multiple is negative."""
    for _ in range(_EUCLIDEAN_STEPS):
        negative = [(j, i) for j, row in enumerate(basis) if sizes[j] for i, x in enumerate(row) if x < 0]
        if not negative:
            return
        j, i = negative[0]
        other = max(range(len(basis)), key=lambda row: basis[row][i] * sizes[row])
        less, more = sorted((j, other), key=lambda row: sizes[row])
        sizes[more] -= sizes[less]
        basis[less] = [x + y for x, y in zip(basis[less], basis[more], strict=True)]
