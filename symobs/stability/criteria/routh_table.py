"""The Routh array of a polynomial, with the two rules for zeros, and its check.

The rows of a₀ sⁿ + … + aₙ are headed by the powers sⁿ, sⁿ⁻¹, …, s⁰.  The first two hold the coefficients, every other

    r[k] = (q₀ p[k + 1] − p₀ q[k + 1]) / q₀

where q is the row above and p the row above that.  Where a row begins with 0 and is not zero, a small ε > 0 stands in
place of this 0.  Where a row is zero, the row above holds the auxiliary polynomial, and its derivative stands in place
of the zeros.  With parameters, zero means identically zero.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import chain, pairwise
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar, from_coefficients
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence


#: How a row came about.
ORIGINS = ("coefficients", "recurrence", "epsilon", "auxiliary")


@dataclass
class RouthRow:
    """The row of one power of the variable: its entries, and its origin (one of `ORIGINS`)."""

    power: int
    entries: tuple[Scalar, ...]
    origin: str


@dataclass
class RouthTable:
    """The rows from sⁿ to s⁰; `epsilon` is the generator of a small positive number, empty if there is none."""

    rows: tuple[RouthRow, ...]
    epsilon: str = ""

    @property
    def first_column(self) -> tuple[Scalar, ...]:
        """The entries of the first column."""
        return tuple(row.entries[0] for row in self.rows)

    @property
    def is_regular(self) -> bool:
        """Whether no zero had to be replaced."""
        return all(row.origin in {"coefficients", "recurrence"} for row in self.rows)

    def auxiliary(self, row: RouthRow, variable: str) -> Scalar:
        """Return the auxiliary polynomial whose derivative a row is: it has the entries of the row above."""
        above = self.rows[self.rows.index(row) - 1]
        with_gaps = chain.from_iterable((entry, Scalar.of(0)) for entry in above.entries)
        return from_coefficients(list(with_gaps)[: above.power + 1], variable)


def routh_table(coefficients: Sequence[Scalar], taken: Iterable[str] = ()) -> RouthTable:
    """Return the Routh array of the coefficients, highest power first.

    ε has none of the names `taken`, which other things have.  Raises ValueError where the first coefficient is zero.
    """
    if not coefficients or coefficients[0].is_zero:
        raise ValueError("the first coefficient of the polynomial of a table is not zero")
    epsilon = _free_name({*taken, *chain.from_iterable(c.names for c in coefficients)})
    order = len(coefficients) - 1
    rows = [RouthRow(order, tuple(coefficients[0::2]), "coefficients")]
    for power in range(order - 1, -1, -1):
        if power == order - 1:
            natural, origin = tuple(coefficients[1::2]), "coefficients"
        else:
            natural, origin = _recurrence(rows[-2].entries, rows[-1].entries, power), "recurrence"
        rows.append(_usable(RouthRow(power, natural, origin), rows[-1], epsilon))
    return RouthTable(tuple(rows), epsilon if any(row.origin == "epsilon" for row in rows) else "")


def _free_name(taken: set[str]) -> str:
    """Return ε, or the first unused ε with an index."""
    name, index = "epsilon", 0
    while name in taken:
        index += 1
        name = f"epsilon_{index}"
    return name


def _recurrence(p: Sequence[Scalar], q: Sequence[Scalar], power: int) -> tuple[Scalar, ...]:
    return tuple((q[0] * _at(p, k + 1) - p[0] * _at(q, k + 1)) / q[0] for k in range(power // 2 + 1))


def _at(row: Sequence[Scalar], place: int) -> Scalar:
    """Return an entry, 0 beyond the end of a row."""
    return row[place] if place < len(row) else Scalar.of(0)


def _usable(row: RouthRow, above: RouthRow, epsilon: str) -> RouthRow:
    """Return the row with a zero pivot replaced by ε or by the derivative of the auxiliary polynomial."""
    first, *others = row.entries
    if first:
        return row
    if any(others):
        return RouthRow(row.power, (Scalar.symbol(epsilon), *others), "epsilon")
    return RouthRow(row.power, _derivative(above), "auxiliary")


def _derivative(above: RouthRow) -> tuple[Scalar, ...]:
    """Return the coefficients of the derivative of the polynomial of a row."""
    return tuple(entry * (above.power - 2 * k) for k, entry in enumerate(above.entries) if above.power > 2 * k)


# -- the check -----------------------------------------------------------------------------------------------------------


def is_routh_table(table: RouthTable, coefficients: Sequence[Scalar]) -> bool:
    """Return whether a table is the Routh array of these coefficients.

    Nothing is divided: a row is held to the two above it by cross-multiplication.
    """
    rows = table.rows
    shape = [(row.power, len(row.entries)) for row in rows]
    if not coefficients or shape != [(power, power // 2 + 1) for power in range(len(coefficients) - 1, -1, -1)]:
        return False
    if table.epsilon in set().union(*(c.names for c in coefficients)) or not all(table.first_column):
        return False
    if bool(table.epsilon) != any(row.origin == "epsilon" for row in rows):
        return False
    top = rows[0]
    if top.origin != "coefficients" or top.entries != tuple(coefficients[0::2]):
        return False
    return all(
        _follows(row, above, before, table.epsilon, coefficients)
        for before, above, row in zip((None, *rows), rows, rows[1:], strict=False)
    )


def _follows(
    row: RouthRow, above: RouthRow, before: RouthRow | None, epsilon: str, coefficients: Sequence[Scalar]
) -> bool:
    """Return whether a row follows from the two rows above it, or holds every other coefficient."""
    if before is None:
        factor, wanted, rule = Scalar.of(1), tuple(coefficients[1::2]), "coefficients"
    else:
        p, q = before.entries, above.entries
        factor, rule = q[0], "recurrence"
        wanted = tuple(q[0] * _at(p, k + 1) - p[0] * _at(q, k + 1) for k in range(len(row.entries)))
    if row.origin == "auxiliary":
        return not any(wanted) and all(
            entry == (above.power - 2 * k) * above.entries[k] for k, entry in enumerate(row.entries)
        )
    agree = [entry * factor == product for entry, product in zip(row.entries, wanted, strict=True)]
    if row.origin == "epsilon":
        is_epsilon = row.entries[0] == Scalar.symbol(epsilon)
        return is_epsilon and wanted[0].is_zero and any(wanted) and all(agree[1:])
    return row.origin == rule and all(agree)


# -- what the first column says --------------------------------------------------------------------------------------------


def sign_changes(table: RouthTable) -> int:
    """Return the number of sign changes in the first column of a numeric array, as ε tends to 0 from above.

    It is the number of roots with Re s > 0, except that ε may mislead: where there are roots on the imaginary axis, and
    where it stands in several places, which one ε makes equally small.
    """
    return sum(left != right for left, right in pairwise(_sign(entry, table.epsilon) for entry in table.first_column))


def _sign(value: Scalar, epsilon: str) -> int:
    """Return 1 or −1: the sign of a nonzero value for all small ε > 0."""
    lowest = [_lowest(part, epsilon) for part in (value.numerator, value.denominator)]
    return 1 if (lowest[0] > 0) == (lowest[1] > 0) else -1


def _lowest(polynomial: Scalar, epsilon: str) -> int:
    """Return the coefficient of the lowest power of ε."""
    found: Iterator[Scalar] = (c for c in reversed(polynomial.coefficients(epsilon)) if c)
    return next(found).fraction().numerator


# Numbers of roots in the right half-plane and on the imaginary axis, by the Cauchy index.
#
# Nothing of Routh's table is used. An irreducible factor f shares a root with f(−s) only where both are equal up to
# sign. Its roots are then symmetric to the axis, and those on it are the real roots of f(iω). Any other factor has none
# there, and its roots are told apart by how often f(iω) turns about 0: by the Cauchy index of the quotient of its
# imaginary and its real part.


#: The coefficients of a polynomial, highest power first; none for zero.
Coefficients: TypeAlias = "list[Fraction]"
_VARIABLE = "s"


def right_half_plane_roots(coefficients: Sequence[Scalar]) -> int:
    """Return the number of roots with Re s > 0, with multiplicity, of rational coefficients, highest power first."""
    return _counted(coefficients)[0]


def imaginary_axis_roots(coefficients: Sequence[Scalar]) -> int:
    """Return the number of roots with Re s = 0, with multiplicity, of rational coefficients, highest power first."""
    return _counted(coefficients)[1]


def _counted(coefficients: Sequence[Scalar]) -> tuple[int, int]:
    if not coefficients or coefficients[0].is_zero or not all(c.is_constant for c in coefficients):
        raise ValueError("roots are counted of polynomials with rational coefficients, the first of them not zero")
    right = on_axis = 0
    for factor, power in from_coefficients(coefficients, _VARIABLE).numerator.factors()[1]:
        found = _of_irreducible([c.fraction() for c in factor.coefficients(_VARIABLE)])
        right, on_axis = right + power * found[0], on_axis + power * found[1]
    return right, on_axis


def _of_irreducible(f: Coefficients) -> tuple[int, int]:
    """Return the numbers of roots of an irreducible polynomial on the right, and on the axis."""
    order = len(f) - 1
    if not any(f[1::2]) or f == [1, 0]:  # symmetric to the origin; the factor s is
        on_axis = _real_roots(_turned(f[0::2])) if order > 1 else 1
        return (order - on_axis) // 2, on_axis
    leading, other = _on_axis(f)
    turns = _index(other, leading)  # of left roots minus right roots, each half a turn
    return (order - turns) // 2, 0


def _turned(even: Coefficients) -> Coefficients:
    """Return h(−ω²) of h given by its coefficients: f(iω) where f(s) = h(s²)."""
    degree = len(even) - 1
    signed = [(-1) ** (degree - k) * c for k, c in enumerate(even)]
    return [entry for c in signed for entry in (c, Fraction(0))][:-1]


def _on_axis(f: Coefficients) -> tuple[Coefficients, Coefficients]:
    """Return the part of f(iω)/iⁿ of degree n in ω, and the other part, signed so that left roots count.

    f(iω)/iⁿ is Σ aₖ (−i)ᵏ ωⁿ⁻ᵏ: real part a₀ωⁿ − a₂ωⁿ⁻² + …, imaginary part −a₁ωⁿ⁻¹ + a₃ωⁿ⁻³ − ….
    """
    zero = Fraction(0)
    real = [(-1) ** (k // 2) * c if k % 2 == 0 else zero for k, c in enumerate(f)]
    imaginary = [(-1) ** (k // 2) * c if k % 2 else zero for k, c in enumerate(f)]
    return real, _stripped(imaginary)


def _real_roots(f: Coefficients) -> int:
    """Return the number of real roots of a square-free polynomial: the Cauchy index of f′/f."""
    order = len(f) - 1
    return _index([(order - k) * c for k, c in enumerate(f[:-1])], f)


def _index(above: Coefficients, below: Coefficients) -> int:
    """Return the Cauchy index of above/below over the real line, by Sturm's chain."""
    chain = [below, above]
    while rest := _remainder(chain[-2], chain[-1]):
        chain.append([-c for c in rest])
    at_plus = [f[0] > 0 for f in chain]
    at_minus = [(f[0] > 0) == (len(f) % 2 == 1) for f in chain]
    return sum(a != b for a, b in pairwise(at_minus)) - sum(a != b for a, b in pairwise(at_plus))


def _remainder(f: Coefficients, by: Coefficients) -> Coefficients:
    """Return a positive multiple of the remainder of a division."""
    left = list(f)
    while len(left) >= len(by):
        lead = left[0] / by[0]
        left = [c - lead * d for c, d in zip(left, [*by, *([Fraction(0)] * (len(left) - len(by)))], strict=True)][1:]
    rest = _stripped(left)
    return [c / abs(rest[0]) for c in rest] if rest else rest


def _stripped(f: Coefficients) -> Coefficients:
    """Return the coefficients from the first nonzero one on."""
    start = next((k for k, c in enumerate(f) if c), len(f))
    return f[start:]
