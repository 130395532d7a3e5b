"""Rank, kernel and bases by fraction-free elimination."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import fmpq, fmpq_mat, fmpq_poly, fmpz_mat, fmpz_mpoly

from symobs.exact.core import ring
from symobs.exact.core.matrix import Matrix, build
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals import Ideal, TooLarge

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from fractions import Fraction

    from symobs.exact.core.field import Field


#: The most terms of an entry that an elimination modulo relations may meet.
TERMS = 400


def echelon(matrix: Matrix, relations: Ideal | Scalar | None = None) -> tuple[tuple[int, ...], tuple[Matrix, ...]]:
    """Return (pivot columns, basis of the kernel), where `relations` = 0 hold if any are given.

    The kernel vectors are columns with polynomial entries without common factor.  What lies in the ideal of the
    relations counts as zero; both answers are sure where no pivot vanishes, and everywhere in general where the ideal
    is prime (of a single relation: where it is irreducible).  Raises `TooLarge` where relations are given and an entry
    grows beyond `TERMS`.
    """
    if isinstance(relations, Scalar):
        relations = Ideal.of([relations])
    field = matrix.field if relations is None else matrix.field | relations.field
    rows = matrix.within(field).polynomials

    def vanishes(entry: fmpz_mpoly) -> bool:
        if not entry or relations is None:
            return not entry
        if len(entry) > TERMS:
            raise TooLarge("an entry is too long to be decided")
        return Scalar(field, entry, field.one) in relations

    pivots, reduced = ring.echelon(rows, vanishes, field)
    columns = range(matrix.shape[1])
    kernel = [_kernel_vector(j, pivots, reduced, field, vanishes, len(columns)) for j in columns if j not in pivots]
    return tuple(pivots), tuple(kernel)


def _kernel_vector(
    free: int,
    pivots: list[int],
    reduced: list[list[fmpz_mpoly]],
    field: Field,
    vanishes: Callable[[fmpz_mpoly], bool],
    columns: int,
) -> Matrix:
    """Solve for the pivot components, the free component being the common multiple of the pivots."""
    bound = [(row, pivot) for row, pivot in zip(reduced, pivots, strict=True) if not vanishes(row[free])]
    common = field.one
    for row, pivot in bound:
        common = ring.common_multiple(common, row[pivot])
    vector = [field.zero] * columns
    vector[free] = common
    for row, pivot in bound:
        vector[pivot] = -row[free] * (common / row[pivot])
    shared = field.zero
    for entry in vector:
        shared = shared.gcd(entry)
    return build(field, tuple((entry / shared,) for entry in vector), field.one, (columns, 1))


def rank(matrix: Matrix, relations: Ideal | None = None) -> int:
    """Return the rank over the field: for parameters, the generic rank (where the relations hold)."""
    if isinstance(matrix.table, fmpz_mat):
        return int(matrix.table.rank())
    return len(echelon(matrix, relations)[0])


def modulo(matrix: Matrix, relations: Ideal | None) -> Matrix:
    """Return a matrix with its entries simplified by relations."""
    if relations is None or not matrix.names:
        return matrix
    return Matrix.of([[relations.simplified(entry) for entry in row] for row in matrix.rows], matrix.shape[1])


def kernel(matrix: Matrix, relations: Ideal | None = None) -> Matrix:
    """Return a basis of {v : M v = 0} as columns (where the relations hold); no columns where it is trivial."""
    vectors = echelon(matrix, relations)[1]
    return Matrix.of([[v[i, 0] for v in vectors] for i in range(matrix.shape[1])], len(vectors))


def primitive_kernel(matrix: Matrix, relations: Ideal | None, order: Sequence[int] = ()) -> Matrix:
    """Return the basis of `kernel` in the normal form of the relations, eliminated with the columns in some order.

    The columns are polynomials without common factor.
    """
    order = order or range(matrix.shape[1])
    columns = []
    for vector in echelon(matrix.select(range(matrix.shape[0]), order), relations)[1]:
        entries = [vector[order.index(i), 0] for i in range(len(order))]
        columns.append(primitive(entries if relations is None else relations.reduced_column(entries)))
    return Matrix.of([[column[i] for column in columns] for i in range(len(order))], len(columns))


def primitive(entries: Iterable[Scalar]) -> list[Scalar]:
    """Return a vector of rational functions as polynomials without common factor, the first coefficient positive."""
    entries = list(entries)
    whole = Matrix.column(entries)
    entries = [(entry * whole.common_denominator()) for entry in entries]
    field = Matrix.column(entries).field
    shared = field.zero
    for entry in entries:
        shared = shared.gcd(entry.within(field).numerator_part)
    return entries if not shared else [entry / Scalar(field, shared, field.one) for entry in entries]


def independent_rows(matrix: Matrix, relations: Ideal | None = None) -> tuple[int, ...]:
    """Return as many rows as the rank, chosen so that they are independent (where the relations hold)."""
    return echelon(matrix.T, relations)[0] if matrix.shape[1] else ()


def solve_or_refute(M: Matrix, right: Matrix, relations: Ideal | None = None) -> tuple[Matrix | None, Matrix | None]:
    """Return a Y with M Y = right, or else a row w with w M = 0 and w right ≠ 0 (where the relations hold).

    Raises `TooLarge` where neither is found, since the relations have several parts, or an entry is too long.
    """
    rows, columns = independent_rows(M, relations), independent_rows(M.T, relations)
    several = "where the relations hold the equations have different ranks"
    if len(rows) != len(columns):
        raise TooLarge(several)
    parts = right.select(rows, range(right.shape[1]))
    lines = dict(zip(columns, M.select(rows, columns).solve(parts).rows, strict=True)) if columns else {}
    nothing = [Scalar.of(0)] * right.shape[1]
    Y = Matrix.of([list(lines.get(i, nothing)) for i in range(M.shape[1])], right.shape[1])
    if modulo((M @ Y - right).normal(), relations).is_zero:
        return Y, None
    left = primitive_kernel(M.T, relations)
    for j in range(left.shape[1]):
        w = left.select(range(left.shape[0]), [j]).T
        if not modulo((w @ right).normal(), relations).is_zero:
            return None, w
    raise TooLarge(several)


def unit_rows(order: int, rows: tuple[int, ...]) -> Matrix:
    """Return the rows eᵢᵀ of the identity."""
    return Matrix.of([[int(j == i) for j in range(order)] for i in rows], order)


def reduced_echelon(matrix: Matrix) -> tuple[tuple[int, ...], Matrix]:
    """Return (pivot columns, row-reduced echelon form without its zero rows)."""
    pivots, reduced = ring.echelon(matrix.polynomials, lambda entry: not entry, matrix.field)
    field, one = matrix.field, matrix.field.one
    rows = [
        [Scalar(field, entry, one) / Scalar(field, row[pivot], one) for entry in row]
        for row, pivot in zip(reduced, pivots, strict=True)
    ]
    return tuple(pivots), Matrix.of(rows, matrix.shape[1])


# Rational functions at many rational points, and characteristic polynomials there.
#
# The points run over a grid, the last name fastest: whatever depends on the other names is worked out once for a line
# of points, and what is left are polynomials in one name.


#: For every power of the last name: the coefficients, and the powers of the other names that stand beside each.
Sliced = dict[int, list[tuple[int, tuple[tuple[int, int], ...]]]]


class PointEvaluator:
    """The values of some rational functions of the same names; `on_line` fixes all names but the last one."""

    def __init__(self, values: Sequence[Scalar], names: Sequence[str]) -> None:
        """Take the functions apart.  Raises `ValueError` where one has other names, or a name that is a function."""
        self.names = tuple(names)
        strange = {name for value in values for name in value.names} - set(names)
        if strange:
            raise ValueError(f"{', '.join(sorted(strange))} is not among {', '.join(names)}")
        self._parts = [(self._sliced(v.numerator_part, v), self._sliced(v.denominator_part, v)) for v in values]
        self._line: list[tuple[fmpq_poly | fmpq, fmpq_poly | fmpq]] = []

    def _sliced(self, polynomial: fmpz_mpoly, value: Scalar) -> Sliced:
        place = {name: self.names.index(name) for name in value.names}
        last = len(self.names) - 1
        slices: Sliced = {}
        for powers, coefficient in polynomial.terms():
            named = [(place[name], int(p)) for name, p in zip(value.field.names, powers, strict=True) if p]
            power = sum(p for where, p in named if where == last)
            others = tuple((where, p) for where, p in named if where != last)
            slices.setdefault(power, []).append((int(coefficient), others))
        return slices

    def on_line(self, outer: Sequence[Fraction]) -> None:
        """Fix the values of all names but the last."""
        fixed = [_rational(value) for value in outer]
        self._line = [(_in_one_name(above, fixed), _in_one_name(below, fixed)) for above, below in self._parts]

    def at(self, last: Fraction) -> list[fmpq | None]:
        """Return the values where the last name has this value, None where a denominator vanishes."""
        x = _rational(last)
        found: list[fmpq | None] = []
        for above, below in self._line:
            under = below if isinstance(below, fmpq) else below(x)
            if under == 0:
                found.append(None)
                continue
            over = above if isinstance(above, fmpq) else above(x)
            found.append(over if under == 1 else over / under)
        return found


def _rational(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _in_one_name(slices: Sliced, fixed: Sequence[fmpq]) -> fmpq_poly | fmpq:
    """Return a polynomial with all names but the last fixed; a number where that does not occur."""
    coefficients = [fmpq(0)] * (max(slices, default=0) + 1)
    for power, terms in slices.items():
        total = fmpq(0)
        for number, others in terms:
            term = fmpq(number)
            for where, exponent in others:
                term *= fixed[where] ** exponent
            total += term
        coefficients[power] = total
    return fmpq_poly(coefficients) if len(coefficients) > 1 else coefficients[0]


def characteristic(matrix: fmpq_mat) -> fmpq_poly:
    """Return det(sI − matrix)."""
    found: fmpq_poly = matrix.charpoly()
    return found


def numbers(rows: int, columns: int, entries: Sequence[Any]) -> fmpq_mat:
    """Return a matrix of numbers, given row by row."""
    return fmpq_mat(rows, columns, list(entries))


def polynomial(coefficients: Sequence[Any]) -> fmpq_poly:
    """Return the polynomial with these coefficients, highest power first."""
    return fmpq_poly(list(reversed(coefficients)))


def texts(part: fmpq_poly, count: int) -> list[str]:
    """Return so many coefficients of a polynomial as texts, constant first."""
    return [str(part[k]) for k in range(count)]


def reduced_fraction(above: fmpq_poly, below: fmpq_poly) -> tuple[fmpq_poly, fmpq_poly]:
    """Return a fraction in lowest terms, the denominator monic."""
    common = above.gcd(below) if above else below
    above, below = above // common, below // common
    lead = below[below.degree()]
    return above / lead, below / lead
