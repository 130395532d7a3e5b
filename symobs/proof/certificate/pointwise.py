"""Statements at every real point of a variety: values never 0 together, and ranks (trusted)."""

from __future__ import annotations

import itertools
import math
from math import log2
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.exact import (
    EIGENVALUE,
    Ideal,
    Matrix,
    Scalar,
    TooLarge,
    echelon,
    independent_rows,
    is_inverse,
    kept_from_zero,
)
from symobs.exact.core.generators import all_roots
from symobs.exact.core.modular import POINT_BITS, squares_of
from symobs.exact.ideals import conjugate_points
from symobs.formula.tree import ModuloIdeal
from symobs.ground.errors import NotShown
from symobs.system.conditions import never_zero, real_consequences, vanishing_factors

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.formula.tree import Environment, Modular


#: The most minors of one order that are looked at, and how many of the shortest are tried before all are.
_MINORS = 100
_FEW = (4, 12)
#: So many terms a product may have that is looked for in an ideal.
_MOST_TERMS = 2000


def never_together_zero(
    values: Iterable[Scalar], relations: Iterable[Scalar], signs: Mapping[str, str], nonzero: tuple[Scalar, ...] = ()
) -> bool:
    """Return whether the values have no common real zero with these signs where the relations hold.

    Irreducible polynomials that are known not to vanish there may be given as `nonzero`; a sum of squares is one where its
    terms do not vanish together.

    With the values the relations generate an ideal that holds 1, or a polynomial that the signs keep from 0.  What real
    parameters imply is added to it: a² + b² = 0 only where a = b = 0, and a² b = 0 with b > 0 only where a = 0; to
    an eigenvalue, which may be complex, nothing, but to what is left of the parameters when it is eliminated.  The
    equations among the relations are reduced by what follows from the values, and what is kept from 0 by what follows from
    both, which keeps long ones short.
    """
    values = list(values)
    relations = _without_other_roots(tuple(relations), values)
    apart = [relation for relation in relations if any(is_inverse(name) for name in relation.names)]
    equations = [relation for relation in relations if relation not in apart]
    known = _implied([_stripped(value, signs, nonzero) for value in values if value], signs, nonzero)
    known = [part for ideal in known for part in _within(ideal, equations, signs, nonzero)]
    known = [part for part in known if not _holds_one_of(part, nonzero)]
    kept = [kept_from_zero(relation) for relation in apart]
    return all(
        any(value in part for value in kept) or (not part.is_seen_prime and not _within(part, apart, signs, nonzero))
        for part in known
    )


def _holds_one_of(ideal: Ideal, nonzero: tuple[Scalar, ...]) -> bool:
    """Return whether the ideal holds one of the values, or the product of all of them: it has no zero where none vanishes."""
    if any(value in ideal for value in nonzero):
        return True
    return (
        1 < math.prod(value.size for value in nonzero) <= _MOST_TERMS
        and math.prod(nonzero, start=Scalar.of(1)) in ideal
    )


def _within(
    ideal: Ideal, relations: Iterable[Scalar], signs: Mapping[str, str], nonzero: tuple[Scalar, ...]
) -> list[Ideal]:
    """Return ideals of the real points of an ideal where relations hold, none where there is none."""
    relations = tuple(relations)
    # Points by a coordinate are left as they are: they reduce the others.
    if conjugate_points(relations) is None or Ideal.of(relations).coordinate is None:
        relations = tuple(map(ideal.remainder, relations))
    found = _implied([*relations, *ideal.generators], signs, nonzero)
    return [part for reduced in found for part in _parts(reduced, signs, nonzero)]


def _parts(ideal: Ideal, signs: Mapping[str, str], nonzero: tuple[Scalar, ...]) -> Iterator[Ideal]:
    """Yield ideals one of which vanishes at each real point of these signs where an ideal does.

    A polynomial of the ideal tells points apart where different factors of it vanish, and leaves out those where none can;
    among finitely many points there is one in each parameter alone.
    """
    quotient = ideal.quotient if EIGENVALUE not in ideal.field.position else None
    if quotient is None:
        split = (vanishing_factors([g], signs) for g in ideal.generators)
        several = next((factors for factors in split if len(factors) > 1), ())
        if not several:
            yield ideal
        for factor in several:
            for part in _implied([*ideal.generators, factor], signs, nonzero):
                yield from _parts(part, signs, nonzero)
        return
    for name in ideal.field.names if quotient.dimension else ():
        alone = quotient.minimal_polynomial(Scalar.symbol(name), name)
        factors = [factor for factor in vanishing_factors([alone], signs) if factor not in nonzero]
        if alone not in ideal or (len(factors) == 1 and factors[0] in ideal):
            continue
        for factor in factors:
            equations = quotient.by_coordinate(name, factor, alone) or [*ideal.generators, factor]
            for part in _implied(equations, signs, nonzero):
                yield from _parts(part, signs, nonzero)
        return
    yield ideal


def _without_other_roots(relations: tuple[Scalar, ...], values: Sequence[Scalar]) -> tuple[Scalar, ...]:
    """Drop relations on square roots that do not occur in the values.

    Roots of q and of −q may stand on one page, each in a case of its own: taken as real together they leave no point, and
    of no point everything is true.
    """
    others = {root.name for root in all_roots(*relations)} - {root.name for root in all_roots(*values)}
    return tuple(relation for relation in relations if others.isdisjoint(relation.names))


def _implied(equations: Iterable[Scalar], signs: Mapping[str, str], nonzero: tuple[Scalar, ...]) -> list[Ideal]:
    """Return an ideal of polynomials that vanish at all real points of these signs where equations hold.

    There is none in the list where that is nowhere.
    """
    ideal = Ideal.of(equations)
    while not ideal.is_whole and not any(never_zero(generator, signs) for generator in ideal.generators):
        implied = (c for g in ideal.generators for c in (_stripped(g, signs, nonzero), *real_consequences(g, signs)))
        news = [value for value in implied if value not in ideal]
        if not news:
            return [ideal]
        ideal = ideal.extended_by(*news)
    return []


def _stripped(value: Scalar, signs: Mapping[str, str], nonzero: tuple[Scalar, ...]) -> Scalar:
    """Return the product of the distinct factors of a value that can vanish."""
    factors = (factor for factor in vanishing_factors([value], signs) if factor not in nonzero)
    return math.prod(factors, start=Scalar.of(1))


def _minors(matrix: Matrix, order: int) -> Iterator[tuple[tuple[int, ...], ...]]:
    """Yield the rows and the columns of every square part of an order."""
    return itertools.product(*(itertools.combinations(range(size), order) for size in matrix.shape))


class Pointwise(ModuloIdeal):
    """The exact arithmetic modulo relations, with the rank of a matrix common to all points of the variety."""

    def __init__(self, environment: Environment, *, everywhere: bool = True) -> None:
        """Keep the signs and the nonzero values; a rank is the generic one unless it is asked for `everywhere`."""
        super().__init__(environment)
        self.everywhere = everywhere
        self.signs = environment.signs
        self.nonzero = (*environment.nonzero, *environment.domain)

    def _meaningful(self, value: Scalar | Matrix) -> None:
        """Accept a denominator that vanishes nowhere, too, where the relations are too long to be taken together."""
        try:
            super()._meaningful(value)
        except TooLarge:
            if not never_together_zero([value.common_denominator()], self.relations, self.signs, self.nonzero):
                raise

    def apply(self, function: str, value: Matrix) -> Any:
        """Return det, adj, or the rank: r where r×r minors never vanish together and none is higher.

        That it is not higher a kernel of dimension n − r shows, or that all larger minors vanish where they are few.

        Raises TypeError where that cannot be shown.
        """
        at_number = self.relations and all(relation.names == {EIGENVALUE} for relation in self.relations)
        if function != "rank" or at_number:
            return super().apply(function, value)
        columns, vectors = echelon(value, self.ideal)
        if not self.everywhere:
            return Scalar.of(len(columns))
        kernel = Matrix.of([[v[i, 0] for v in vectors] for i in range(value.shape[1])], len(vectors))
        sent_to_zero = all(entry in self.ideal for entry in (value @ kernel).entries)
        rows = independent_rows(value.select(range(value.shape[0]), columns), self.ideal)
        if not self._has_minor(value, len(columns), (rows, columns)) or not (
            (sent_to_zero and self._has_minor(kernel, len(vectors))) or self._has_none(value, len(columns) + 1)
        ):
            raise NotShown("the rank is not seen to be the same everywhere")
        return Scalar.of(len(columns))

    def _has_minor(
        self, matrix: Matrix, order: int, first: tuple[tuple[int, ...], tuple[int, ...]] | None = None
    ) -> bool:
        """Return whether at every point a minor of some order is not zero; a likely one may be tried first."""
        if not order or (first is not None and self._never_together_zero([matrix.select(*first).determinant()])):
            return True
        minors = [matrix.select(*minor).determinant() for minor in itertools.islice(_minors(matrix, order), _MINORS)]
        shortest = sorted((minor for minor in minors if minor not in self.ideal), key=lambda minor: minor.size)
        return any(self._never_together_zero(shortest[:count]) for count in (*_FEW, len(shortest)))

    def _has_none(self, matrix: Matrix, order: int) -> bool:
        """Return whether all minors of an order vanish; False if there are too many to check."""
        if math.prod(math.comb(size, order) for size in matrix.shape) > _MINORS:
            return False
        return all(matrix.select(*minor).determinant() in self.ideal for minor in _minors(matrix, order))

    def _never_together_zero(self, values: Sequence[Scalar]) -> bool:
        try:
            return never_together_zero(values, self.relations, self.signs, self.nonzero)
        except TooLarge:
            return False


# Error bounds of the randomised check: degrees and heights propagated through formulas (trusted).


class SizeBound(NamedTuple):
    """The size of a rational function: degrees and log₂ of the lengths of its two parts; shape of a matrix."""

    above: float
    below: float
    above_bits: float
    below_bits: float
    shape: tuple[int, int] | None = None


class Bounds:
    """The arithmetic of sizes: bounds for degree and height of the value of a formula.

    Heights are those of the integers the leaves became at the point.  Named coefficients are rational there, and roots
    of numbers have conjugates, so with them the heights are bounded through the coefficients of the leaves instead.
    """

    def __init__(self, environment: Environment, arithmetic: Modular) -> None:
        """Bound the values of named coefficients in the order of their definition."""
        self.arithmetic = arithmetic
        self.named = bool(environment.coefficients) or bool(squares_of(arithmetic.point.values))
        degrees: dict[str, float] = {}
        bits: dict[str, float] = {}
        for name, meaning in environment.coefficients.items():
            above, below = meaning.degrees()
            growth = max((degrees[other] for other in meaning.names if other in degrees), default=1.0)
            length = max((bits[other] for other in meaning.names if other in bits), default=float(POINT_BITS))
            degrees[name] = max(1.0, (above + below) * growth)
            bits[name] = sum(meaning.lengths()) + (above + below) * max(length, POINT_BITS)
        self.larger = max(degrees.values(), default=1.0)
        squares = squares_of(arithmetic.point.values).values()
        self.longer = max([*bits.values(), POINT_BITS, *(square.bit_length() for square in squares)])

    def leaf(self, value: Scalar | Matrix) -> SizeBound:
        above, below = value.degrees()
        shape = value.shape if isinstance(value, Matrix) else None
        if not self.named and id(value) in self.arithmetic.known:
            return SizeBound(above, below, *self.arithmetic.point.bits[id(value)], shape)
        above_bits, below_bits = value.lengths()
        grown = (above + below) * self.longer
        degree = (above + below) * self.larger
        return SizeBound(degree, degree, above_bits + grown, below_bits + grown, shape)

    def shape(self, value: SizeBound) -> tuple[int, int] | None:
        return value.shape

    def entry(self, value: SizeBound) -> SizeBound:
        return SizeBound(value.above, value.below, value.above_bits, value.below_bits)

    def add(self, left: SizeBound, right: SizeBound) -> SizeBound:
        return SizeBound(
            max(left.above + right.below, right.above + left.below),
            left.below + right.below,
            1 + max(left.above_bits + right.below_bits, right.above_bits + left.below_bits),
            left.below_bits + right.below_bits,
            left.shape,
        )

    def scale(self, value: SizeBound, factor: SizeBound) -> SizeBound:
        return SizeBound(
            value.above + factor.above,
            value.below + factor.below,
            value.above_bits + factor.above_bits,
            value.below_bits + factor.below_bits,
            value.shape,
        )

    def matmul(self, left: SizeBound, right: SizeBound) -> SizeBound:
        inner, outer = left.shape or (1, 1), right.shape or (1, 1)
        product = self.scale(left, right)
        return SizeBound(
            product.above,
            product.below,
            product.above_bits + log2(max(inner[1], 1)),
            product.below_bits,
            (inner[0], outer[1]),
        )

    def _determinant(self, value: SizeBound, order: int) -> SizeBound:
        return SizeBound(
            order * value.above,
            order * value.below,
            order * (value.above_bits + log2(max(order, 1))),
            order * value.below_bits,
        )

    def invert(self, value: SizeBound) -> SizeBound:
        if value.shape is None:
            return SizeBound(value.below, value.above, value.below_bits, value.above_bits)
        whole = self._determinant(value, value.shape[0])
        return SizeBound(
            whole.above + whole.below,
            whole.above + whole.below,
            whole.above_bits + whole.below_bits,
            whole.above_bits + whole.below_bits,
            value.shape,
        )

    def transpose(self, value: SizeBound) -> SizeBound:
        rows, columns = value.shape or (1, 1)
        return SizeBound(value.above, value.below, value.above_bits, value.below_bits, (columns, rows))

    def apply(self, function: str, value: SizeBound) -> SizeBound:
        rows, columns = value.shape or (1, 1)
        whole = self._determinant(value, min(rows, columns))
        if function == "adj":
            return SizeBound(whole.above, whole.below, whole.above_bits, whole.below_bits, value.shape)
        return whole

    def block(self, rows: list[list[SizeBound]]) -> SizeBound:
        """Return all blocks over one common denominator."""
        parts = [part for row in rows for part in row]
        below, below_bits = sum(p.below for p in parts), sum(p.below_bits for p in parts)
        height = sum((row[0].shape or (1, 1))[0] for row in rows)
        width = sum((part.shape or (1, 1))[1] for part in rows[0])
        return SizeBound(
            max(p.above for p in parts) + below,
            below,
            max(p.above_bits for p in parts) + below_bits,
            below_bits,
            (height, width),
        )

    def equal(self, left: SizeBound, right: SizeBound) -> bool:
        raise AssertionError(f"sizes are not compared: {left}, {right}")
