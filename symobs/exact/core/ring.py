"""Matrices over the ring Z[generators], without denominators: plain functions on rows of polynomials.

`Table` is `fmpz_mat` where there is no generator and a tuple of rows of `fmpz_mpoly` otherwise; FLINT does the
numeric case, the functions here the parametric one.  Everything is fraction-free.
"""

from __future__ import annotations

from bisect import bisect_left
from math import log2
from threading import RLock
from typing import TYPE_CHECKING, TypeAlias

from flint import ctx, fmpq, fmpq_mpoly_ctx, fmpz, fmpz_mat, fmpz_mpoly

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence
    from types import TracebackType

    from symobs.exact.core.field import Field


Rows: TypeAlias = tuple[tuple[fmpz_mpoly, ...], ...]
#: Up to this many terms a fingerprint is the whole text; of longer ones the length and some coefficients are told.
_WHOLE_TEXT, _TOLD = 40, 6
#: Of this many terms, or some more, the exponents are looked at where polynomials are told apart.
_LOOKED_AT = 6
#: From this many terms on a common divisor is first looked for in a leading coefficient.
_LONG = 150
#: `fmpz_mpoly.factor` sorts factors through C integers and fails from here on; `fmpq_mpoly.factor` does not.
_COEFFICIENT_LIMIT = 2**31
#: Up to this order determinants go by minors, which keeps sparse parametric entries small; beyond, by elimination.
MINORS_UP_TO = 8


def dot(left: Sequence[fmpz_mpoly], right: Sequence[fmpz_mpoly], zero: fmpz_mpoly) -> fmpz_mpoly:
    """Return Σ left_k right_k."""
    total = None
    for a, b in zip(left, right, strict=True):
        if a and b:
            if total is None:
                total = a * b
            else:
                total.iadd(a * b)
    return zero if total is None else total


def product(left: Rows, right: Rows, zero: fmpz_mpoly) -> Rows:
    """Return the matrix product."""
    columns = transpose(right)
    return tuple(tuple(dot(row, column, zero) for column in columns) for row in left)


def added(left: Rows, right: Rows) -> Rows:
    """Return the sum of two matrices of one shape."""
    return tuple(tuple(x + y for x, y in zip(p, q, strict=True)) for p, q in zip(left, right, strict=True))


def normal_table(field: Field, table: fmpz_mat | Rows, denominator: fmpz_mpoly) -> tuple[Rows, fmpz_mpoly]:
    """Return the same matrix with its entries and its denominator in normal form; roots may stay in the denominator."""
    rows = rows_of(table, field) if isinstance(table, fmpz_mat) else table
    return tuple(tuple(map(field.normal, row)) for row in rows), field.normal(denominator)


def transpose(rows: Rows) -> Rows:
    """Return the transpose."""
    return tuple(zip(*rows, strict=True))


def plus_diagonal(rows: Rows, factor: fmpz_mpoly, addend: fmpz_mpoly) -> Rows:
    """Return factor · M + addend · I."""
    scaled = rows if factor.is_one() else tuple(tuple(entry * factor for entry in row) for row in rows)
    return tuple((*row[:i], row[i] + addend, *row[i + 1 :]) for i, row in enumerate(scaled))


def leading_coefficient(polynomial: fmpz_mpoly, foreign: Sequence[int]) -> fmpz_mpoly:
    """Return the coefficient of the highest powers of these generators, one after the other; powers may be thousands.

    The quotient by the highest power of a generator is the coefficient; a loop over the terms would take ten times as long.
    """
    context = polynomial.context()
    for index in foreign:
        if degree := polynomial.degrees()[index]:
            polynomial = polynomial // context.gen(index) ** degree
    return polynomial


def coprime(denominator: fmpz_mpoly, entries: Iterable[fmpz_mpoly]) -> bool:
    """Return whether entries and denominator are coprime by an inexpensive test; False if undecided.

    A factor of the denominator is free of the generators that the denominator lacks, so it divides the coefficients
    of the entries in those; the leading ones are much shorter than the entries, and mostly two of them suffice.
    """
    if denominator.is_one():
        return True
    foreign = _foreign(denominator)
    leading = sorted((leading_coefficient(entry, foreign) for entry in entries if entry), key=len)
    shared = None
    for polynomial in [*leading, denominator]:
        shared = polynomial if shared is None else shared.gcd(polynomial)
        if shared.is_one():
            return True
    return False


def common_factor(numerator: fmpz_mpoly, denominator: fmpz_mpoly) -> fmpz_mpoly:
    """Return the greatest common divisor; of a long numerator that of its leading coefficient is tried first.

    What divides both divides the coefficients of the numerator in the generators that the denominator lacks.
    """
    foreign = _foreign(denominator) if len(numerator) > _LONG else []
    if foreign:
        denominator = leading_coefficient(numerator, foreign).gcd(denominator)
    return numerator.gcd(denominator)


def _foreign(polynomial: fmpz_mpoly) -> list[int]:
    """Return the generators that do not occur in a polynomial."""
    return [index for index, degree in enumerate(polynomial.degrees()) if degree <= 0]


def determinant(rows: Rows, field: Field) -> fmpz_mpoly:
    """Return the determinant, by minors for small orders and by Bareiss' elimination beyond."""
    if not rows:
        return field.one
    content, rows = strip_row_contents(rows, field)
    value = _by_minors(rows, field) if len(rows) <= MINORS_UP_TO else _by_elimination(rows, field)
    return field.normal(value * content)


def strip_row_contents(rows: Rows, field: Field) -> tuple[fmpz_mpoly, Rows]:
    """Divide each row by the monomial and integer its entries share; return their product and the rows."""
    total = field.one
    stripped = []
    for row in rows:
        shared = None
        for entry in row:
            if entry:
                shared = entry.term_content() if shared is None else shared.gcd(entry.term_content())
                if shared.is_one():
                    break
        if shared is None or shared.is_one():
            stripped.append(row)
        else:
            total = total * shared
            stripped.append(tuple(entry / shared for entry in row))
    return total, tuple(stripped)


def _by_minors(rows: Rows, field: Field) -> fmpz_mpoly:
    """Expand along the rows from the bottom."""
    return maximal_minors(rows, field).get(tuple(range(len(rows))), field.zero)


def maximal_minors(rows: Rows, field: Field) -> dict[tuple[int, ...], fmpz_mpoly]:
    """Return every minor that uses all rows, by its columns: each row extends the minors of the rows below it."""
    width = len(rows[0])
    minors: dict[tuple[int, ...], fmpz_mpoly] = {(): field.one}
    for row in reversed(rows):
        larger: dict[tuple[int, ...], fmpz_mpoly] = {}
        for columns, minor in minors.items():
            if not minor:
                continue
            for column in range(width):
                entry = row[column]
                if column in columns or not entry:
                    continue
                position = bisect_left(columns, column)
                chosen = (*columns[:position], column, *columns[position:])
                term = entry * minor
                known = larger.get(chosen)
                if position % 2:
                    larger[chosen] = -term if known is None else known - term
                else:
                    larger[chosen] = term if known is None else known + term
        minors = {chosen: field.normal(minor) for chosen, minor in larger.items()} if field.roots else larger
    return minors


def _by_elimination(rows: Rows, field: Field) -> fmpz_mpoly:
    work = [list(row) for row in rows]
    order, previous, sign = len(work), field.one, 1
    for k in range(order - 1):
        pivot = next((i for i in range(k, order) if work[i][k]), None)
        if pivot is None:
            return field.zero
        if pivot != k:
            work[k], work[pivot], sign = work[pivot], work[k], -sign
        for i in range(k + 1, order):
            for j in range(k + 1, order):
                work[i][j] = (work[i][j] * work[k][k] - work[i][k] * work[k][j]) / previous
        previous = work[k][k]
    return work[-1][-1] if sign > 0 else -work[-1][-1]


def cofactors(rows: Rows, row: int, field: Field) -> tuple[fmpz_mpoly, ...]:
    """Return the cofactors of a row, up to small orders all from one expansion of the rows around it."""
    order, around = len(rows), (*rows[:row], *rows[row + 1 :])
    if order > MINORS_UP_TO:
        rest = (tuple((*line[:column], *line[column + 1 :]) for line in around) for column in range(order))
        minors = [determinant(part, field) for part in rest]
    else:
        content, around = strip_row_contents(around, field)
        found = maximal_minors(around, field) if around else {(): field.one}
        every = (found.get((*range(column), *range(column + 1, order)), field.zero) for column in range(order))
        minors = [field.normal(minor * content) for minor in every]
    return tuple(-minor if (row + column) % 2 else minor for column, minor in enumerate(minors))


def echelon(
    rows: Rows, vanishes: Callable[[fmpz_mpoly], bool], field: Field
) -> tuple[list[int], list[list[fmpz_mpoly]]]:
    """Return (pivot columns, reduced rows): elimination without fractions, `vanishes` deciding what counts as zero.

    In the reduced rows each pivot column is zero but at its own pivot.  Pivots are the simplest entries available:
    constants first, then fewest terms, so that a witness holds as widely as possible.
    """
    work = [list(row) for row in rows]
    pivots: list[int] = []
    columns = len(work[0]) if work else 0
    for column in range(columns):
        rank = len(pivots)
        candidates = [i for i in range(rank, len(work)) if not vanishes(work[i][column])]
        if not candidates:
            continue
        best = min(candidates, key=lambda i: (work[i][column].total_degree(), len(work[i][column])))
        work[rank], work[best] = work[best], work[rank]
        lead = work[rank][column]
        for i, line in enumerate(work):
            if i != rank and not vanishes(line[column]):
                factor = line[column]
                cleared = [field.normal(lead * a - factor * b) for a, b in zip(line, work[rank], strict=True)]
                work[i] = _primitive(cleared, vanishes)
        pivots.append(column)
        if len(pivots) == len(work):
            break
    return pivots, work[: len(pivots)]


def _primitive(line: list[fmpz_mpoly], vanishes: Callable[[fmpz_mpoly], bool]) -> list[fmpz_mpoly]:
    shared = None
    for entry in line:
        if entry and not vanishes(entry):
            shared = entry if shared is None else shared.gcd(entry)
            if shared.is_one():
                return line
    if shared is None or vanishes(shared):
        return line
    if any(entry and (entry % shared) for entry in line):
        return line
    return [entry / shared for entry in line]


def rows_of(table: fmpz_mat, field: Field) -> Rows:
    """Return a numeric table as rows of polynomials of `field`."""
    constant = field.context.constant
    return tuple(tuple(constant(entry) for entry in row) for row in table.tolist())


def common_multiple(left: fmpz_mpoly, right: fmpz_mpoly) -> fmpz_mpoly:
    """Return a common multiple as small as FLINT's gcd makes it."""
    if right.is_one() or left == right:
        return left
    if left.is_one():
        return right
    multiple = left * (right / left.gcd(right))
    return -multiple if multiple.leading_coefficient() < 0 else multiple


def align(left: fmpz_mpoly, right: fmpz_mpoly) -> tuple[fmpz_mpoly, fmpz_mpoly, fmpz_mpoly]:
    """Return (common denominator, factor for the left, factor for the right)."""
    common = common_multiple(left, right)
    return common, common / left, common / right


def number_of(constant: fmpz_mpoly) -> fmpz:
    """Return the integer that a constant polynomial is."""
    return constant.leading_coefficient() if constant else fmpz(0)


def polynomial_fingerprint(polynomial: fmpz_mpoly) -> str:
    """Return FLINT's text of a short polynomial, else a summary."""
    length = len(polynomial)
    if length <= _WHOLE_TEXT:
        return str(polynomial)
    return f"{length} {' '.join(str(polynomial.coefficient(k * (length - 1) // _TOLD)) for k in range(_TOLD + 1))}"


def invariants(polynomial: fmpz_mpoly, places: Sequence[int]) -> tuple[object, ...]:
    """Return the coefficients, and the exponents that some terms have at these places: the same in every field."""
    looked_at = range(0, len(polynomial), len(polynomial) // _LOOKED_AT or 1)
    exponents = [polynomial.monomial(k) for k in looked_at]
    return (*polynomial.coeffs(), *(powers[index] for powers in exponents for index in places))


def length_bits(polynomial: fmpz_mpoly) -> float:
    """Return an upper bound of log₂ Σ |coefficients|."""
    if not polynomial:
        return 0.0
    return max(abs(c) for c in polynomial.coeffs()).bit_length() + log2(len(polynomial))


def degree_bound(polynomial: fmpz_mpoly) -> int:
    """Return the sum of the degrees in each generator, which the total degree cannot exceed (and which is cheap)."""
    if len(polynomial) == 1:
        return int(polynomial.total_degree())
    return sum(map(int, polynomial.degrees())) if polynomial else 0


def occurring(polynomial: fmpz_mpoly, names: Sequence[str]) -> list[str]:
    """Return those of the names of the generators that occur in a polynomial."""
    if len(polynomial) < 2 and polynomial.is_constant():  # which asks each term for its degree
        return []
    return [name for name, degree in zip(names, polynomial.degrees(), strict=True) if degree > 0]


def factors_of(field: Field, polynomial: fmpz_mpoly) -> tuple[int, list[tuple[fmpz_mpoly, int]]]:
    """Factor over Z into (unit, primitive irreducible factors with positive leading coefficient)."""
    if polynomial.is_constant():
        return int(number_of(polynomial)), []
    if max(abs(c) for c in polynomial.coeffs()) < _COEFFICIENT_LIMIT:
        try:
            unit, parts = polynomial.factor()
        except OverflowError:
            unit, parts = _factor_over_rationals(field, polynomial)
    else:
        unit, parts = _factor_over_rationals(field, polynomial)
    whole, found = int(unit), []
    for part, power in parts:
        positive = part
        if part.leading_coefficient() < 0:
            positive, whole = -part, whole * (-1) ** (power % 2)
        found.append((positive, int(power)))
    return whole, in_order(found)


def in_order(factors: Sequence[tuple[fmpz_mpoly, int]]) -> list[tuple[fmpz_mpoly, int]]:
    """Return factors with their powers by degree and length; their texts, which FLINT's binding never frees, settle ties."""
    sized = [(int(factor.total_degree()), len(factor)) for factor, _ in factors]
    tied = len(set(sized)) < len(sized)
    keys = [(size, str(factor) if tied else "") for size, (factor, _) in zip(sized, factors, strict=True)]
    return [factors[k] for k in sorted(range(len(factors)), key=keys.__getitem__)]


def _factor_over_rationals(field: Field, polynomial: fmpz_mpoly) -> tuple[fmpz, list[tuple[fmpz_mpoly, int]]]:
    letters = tuple(f"x{index}" for index in range(len(field.names)))  # the library keeps what it is asked for
    rational = fmpq_mpoly_ctx.get(letters, field.context.ordering())
    _, parts = rational.from_dict({p: fmpq(c) for p, c in polynomial.terms()}).factor()
    found, product = [], field.one
    for part, power in parts:
        scale = fmpz(1)
        for coefficient in part.coeffs():
            scale = scale * coefficient.q // scale.gcd(coefficient.q)
        whole = field.context.from_dict({p: (c * scale).p for p, c in part.terms()})
        _, whole = whole.primitive()
        found.append((whole, power))
        product = product * whole**power
    return number_of(polynomial / product), found


# The precision of enclosures: FLINT has one for the process, held by one thread at a time.


_IN_USE = RLock()


class Precision:
    """A context manager that computes with this many bits, `with Precision(128): ...`; it may be nested."""

    __slots__ = ("before", "bits")

    def __init__(self, bits: int) -> None:
        """Take the bits of the block."""
        self.bits = bits

    def __enter__(self) -> None:
        _IN_USE.acquire()
        self.before, ctx.prec = ctx.prec, self.bits

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        ctx.prec = self.before
        _IN_USE.release()
