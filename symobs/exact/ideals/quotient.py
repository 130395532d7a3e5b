"""The functions on finitely many zeros of an ideal: the algebra Q[names]/ideal, by matrices of multiplication."""

from __future__ import annotations

from typing import TYPE_CHECKING

from flint import fmpq, fmpq_mat

from symobs.exact.core.scalar import Scalar

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence


class QuotientRing:
    """Q[names]/ideal as a vector space with a basis of monomials, the first of which is 1."""

    def __init__(
        self,
        monomials: Sequence[Scalar],
        names: Sequence[str],
        normal_forms: Callable[[Sequence[Scalar]], Sequence[Scalar]],
    ) -> None:
        """Take what reduces several polynomials, times one common rational number."""
        self.monomials = monomials
        self.names = names
        self._normal_forms = normal_forms
        self._place = {monomial.terms()[0][1]: place for place, monomial in enumerate(monomials)}
        self.one = fmpq_mat(self.dimension, 1, [int(not place) for place in range(self.dimension)])
        self._identity = fmpq_mat([[int(i == j) for j in range(self.dimension)] for i in range(self.dimension)])
        self._known: dict[Scalar, fmpq_mat] = {}

    @property
    def dimension(self) -> int:
        """How many zeros there are, each counted with its multiplicity."""
        return len(self.monomials)

    def multiplication(self, value: Scalar) -> fmpq_mat:
        """Return the matrix of the multiplication by a polynomial."""
        if value not in self._known:
            self._known[value] = self._multiplication(value)
        return self._known[value]

    def _multiplication(self, value: Scalar) -> fmpq_mat:
        *columns, one = self._normal_forms([*(value * each for each in self.monomials), self.monomials[0]])
        scale, found = one.terms()[0][0], fmpq_mat(self.dimension, self.dimension)
        for column, image in enumerate(columns):
            for coefficient, monomial in image.each_term():
                found[self._place[monomial], column] = fmpq(coefficient, scale)
        return found

    def minimal_polynomial(self, value: Scalar, name: str) -> Scalar:
        """Return the polynomial p(name) of least degree with p(value) in the ideal."""
        powers = _powers(self.multiplication(value), self.one, self.dimension + 1)
        found = _dependence(powers, [Scalar.symbol(name) ** k for k in range(self.dimension + 1)])
        assert found is not None  # noqa: S101 - more powers than the dimension are dependent
        return found

    def by_coordinate(self, name: str, factor: Scalar, minimal: Scalar) -> tuple[Scalar, ...] | None:
        """Return generators of the ideal with a factor of the minimal polynomial of `name` added.

        They are the factor and every other name as a polynomial in `name`, of lower degree; None where `name` does not tell
        those zeros apart.  With r what of the minimal polynomial has no factor in common with it, f lies in that ideal just
        where f r lies in this one with the factor times r added.
        """
        rest, is_simple = minimal / factor, True
        while (quotient := rest / factor).denominator.is_constant:
            rest, is_simple = quotient, False
        by = self.multiplication(Scalar.symbol(name))
        beside = _applied(rest, name, by, self.one)
        beneath = [] if is_simple else _columns(_applied(rest * factor, name, by, self._identity))
        powers = [Scalar.symbol(name) ** k for k in range(factor.degree(name))]
        images = _powers(by, beside, len(powers))
        found = [factor]
        for other in (Scalar.symbol(each) for each in self.names if each != name):
            solved = _dependence([*images, self.multiplication(other) * beside], [*powers, other], beneath)
            if solved is None:
                return None
            found.append(solved)
        return tuple(found)


def _powers(by: fmpq_mat, start: fmpq_mat, count: int) -> list[fmpq_mat]:
    """Return v, M v, M² v, …, as many as are asked for."""
    found = [start]
    while len(found) < count:
        found.append(by * found[-1])
    return found[:count]


def _applied(polynomial: Scalar, name: str, by: fmpq_mat, start: fmpq_mat) -> fmpq_mat:
    """Return p(M) V by Horner's rule."""
    found = start * 0
    for coefficient in polynomial.coefficients(name):
        fraction = coefficient.fraction()
        found = by * found + start * fmpq(fraction.numerator, fraction.denominator)
    return found


def _joined(columns: Sequence[fmpq_mat]) -> fmpq_mat:
    entries = [column.entries() for column in columns]
    return fmpq_mat(len(entries[0]), len(entries), [value for row in zip(*entries, strict=True) for value in row])


def _pivots(reduced: fmpq_mat, rank: int) -> list[int]:
    """Return the columns of the leading entries of an echelon form."""
    found: list[int] = []
    for row in range(rank):
        start = found[-1] + 1 if found else 0
        found.append(next(k for k in range(start, reduced.ncols()) if reduced[row, k] != 0))
    return found


def _columns(matrix: fmpq_mat) -> list[fmpq_mat]:
    height = matrix.nrows()
    entries = matrix.entries()
    return [fmpq_mat(height, 1, entries[place :: matrix.ncols()]) for place in range(matrix.ncols())]


def _dependence(
    values: Sequence[fmpq_mat], written: Sequence[Scalar], beneath: Sequence[fmpq_mat] = ()
) -> Scalar | None:
    """Return the first linear combination of vectors, written with others, that is 0, or lies in the span of those beneath.

    None where there is none.
    """
    start = len(beneath)
    reduced, rank = _joined([*beneath, *values]).rref()
    pivots = _pivots(reduced, rank)
    last = next((k for k in range(len(values)) if k + start not in pivots), None)
    if last is None:
        return None
    found = written[last]
    for row, column in enumerate(pivots):
        if start <= column < start + last:
            entry = reduced[row, start + last]
            found -= Scalar.rational(int(entry.p), int(entry.q)) * written[column - start]
    found = found.numerator
    return found / found.factors()[0]
