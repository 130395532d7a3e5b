"""Rational functions at many rational points, and characteristic polynomials there.

The points run over a grid, the last name fastest: whatever depends on the other names is worked out once for a line of
points, and what is left are polynomials in one name.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import fmpq, fmpq_mat, fmpq_poly, fmpz_mpoly

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact.core.scalar import Scalar

#: For every power of the last name: the coefficients, and the powers of the other names that stand beside each.
Sliced = dict[int, list[tuple[int, tuple[tuple[int, int], ...]]]]


class PointEvaluator:
    """The values of some rational functions of the same names; `on_line` fixes all names but the last one."""

    def __init__(self, values: Sequence[Scalar], names: Sequence[str]) -> None:
        """Take the functions apart.  Raises `ValueError` where one has other names, or a name that is a function."""
        self.names = tuple(names)
        strange = {name for value in values for name in value.names} - set(names)
        if strange:
            message = f"{', '.join(sorted(strange))} is not among {', '.join(names)}"
            raise ValueError(message)
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
