"""Points on every curve that an answer speaks of: singular points, crossings, and points with small coordinates.

Curves are read from the texts of the answer and solved in FLINT's rational polynomials: coordinates are given small values
until one is left, whose rational roots are points.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import chain, combinations, islice, product
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import Ordering, fmpq, fmpq_mpoly_ctx, fmpq_poly
from flint.utils.flint_exceptions import DomainError

from tests.support.algebra import evaluated, has_sign

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

Point: TypeAlias = dict[str, Fraction]

SMALL = [Fraction(p, q) for p, q in ((0, 1), (1, 1), (-1, 1), (2, 1), (-2, 1), (1, 2), (3, 1), (-3, 1), (-3, 2))]
#: Curves of more terms or higher degree are not crossed with others.
_TERMS, _DEGREE = 60, 8
#: The most curves whose crossings are looked for, and points of each kind of one curve.
_CURVES, _EACH = 10, 6


class Curves:
    """The distinct irreducible curves of an answer in the parameters of its problem."""

    def __init__(self, texts: Iterable[str], names: Sequence[str]) -> None:
        """Read relations; a side that is a fraction, or no polynomial in these names, is left out."""
        self.names = list(names)
        self.ring = fmpq_mpoly_ctx.get(self.names, Ordering.lex)
        found: dict[str, Any] = {}
        for text in dict.fromkeys(texts):
            try:
                value = evaluated(text, dict(zip(self.names, self.ring.gens(), strict=True)), number=self.ring.constant)
                factors = value.factor()[1]
            except (ValueError, TypeError, ArithmeticError, DomainError):
                continue
            for factor, _ in factors:
                found.setdefault(str(factor), factor)
        self.curves = [curve for curve in found.values() if len(curve) <= 4 * _TERMS]

    def vanishing(self, point: Point) -> tuple[int, ...]:
        """Return the numbers of the curves that a point lies on."""
        numbers = [_rational(point[name]) for name in self.names]
        return tuple(k for k, curve in enumerate(self.curves) if not curve(*numbers))

    def points(self) -> Iterator[Point]:
        """Yield crossings and singular points first, then points with small coordinates."""
        short = [c for c in self.curves if len(c) <= _TERMS and max(c.degrees(), default=0) <= _DEGREE][:_CURVES]
        singular = ([curve, curve.derivative(k)] for curve in short for k in range(len(self.names)))
        for pair in chain(singular, map(list, combinations(short, 2))):
            yield from islice(self._common([p for p in pair if p]), _EACH)
        for curve in self.curves:
            yield from islice(self._common([curve]), 3 * _EACH)

    def _common(self, polynomials: list[Any]) -> Iterator[Point]:
        """Yield rational common zeros: as many coordinates as are free are small, the others are solved for."""
        free = max(len(self.names) - len(polynomials), 0)
        for fixed in combinations(range(len(self.names)), free):
            for values in islice(product(SMALL, repeat=free), 27):
                point = dict(zip((self.names[k] for k in fixed), values, strict=True))
                yield from self._solved([self._at(p, point) for p in polynomials], point)

    def _solved(self, polynomials: list[Any], point: Point) -> Iterator[Point]:
        left = [name for name in self.names if name not in point]
        polynomials = [p for p in polynomials if p]
        if any(p.is_constant() for p in polynomials):
            return
        if not left:
            yield point
        elif not polynomials:
            for value in SMALL[:3]:
                yield from self._solved([], {**point, left[0]: value})
        else:
            name = left[0]
            for root in self._roots(polynomials, left):
                at = {name: root}
                yield from self._solved([self._at(p, at) for p in polynomials], {**point, **at})

    def _roots(self, polynomials: list[Any], left: list[str]) -> list[Fraction]:
        """Return values of the first name that is left: roots of a polynomial in it alone, or small ones."""
        others = {self.names.index(name) for name in left[1:]}

        def alone(p: Any) -> bool:
            return not any(p.degrees()[k] for k in others)

        univariate = [p for p in polynomials if alone(p)]
        if not univariate and len(polynomials) > 1 and len(others) == 1:
            (other,) = others
            eliminated = polynomials[0].resultant(polynomials[1], other)
            univariate = [eliminated] if eliminated else []
        if not univariate:
            return SMALL
        return rational_roots(univariate[0], self.names.index(left[0]))

    def _at(self, polynomial: Any, point: Point) -> Any:
        return polynomial.subs({name: _rational(value) for name, value in point.items()})


def rational_roots(polynomial: Any, place: int) -> list[Fraction]:
    """Return the rational roots of a polynomial in one name."""
    if polynomial.is_constant():
        return []
    terms = {powers[place]: coefficient for powers, coefficient in polynomial.to_dict().items()}
    whole = fmpq_poly([terms.get(k, fmpq(0)) for k in range(max(terms) + 1)]).numer()
    linear = [factor for factor, _ in whole.factor()[1] if factor.degree() == 1]
    found = [Fraction(-int(factor[0]), int(factor[1])) for factor in linear]
    return [root for root in found if max(abs(root.numerator), root.denominator) < 10**5]


def _rational(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def points_on(texts: Iterable[str], signs: Mapping[str, str], most: int) -> list[Point]:
    """Return points on the curves of an answer that have the declared signs, the ones on many curves first.

    Of the points on the same curves two are kept, and two points that lie on none.
    """
    names = sorted(signs)
    if not names:
        return [{}]
    curves = Curves(texts, names)
    kept: dict[tuple[int, ...], list[Point]] = {}
    for point in islice(chain(curves.points(), _grid(names)), 3000):
        if not all(has_sign(value, signs[name]) for name, value in point.items()):
            continue
        same = kept.setdefault(curves.vanishing(point), [])
        if len(same) < 2 and point not in same:
            same.append(point)
    ordered = sorted(kept, key=lambda pattern: (-len(pattern), pattern))
    first, second = ([kept[pattern][k] for pattern in ordered if len(kept[pattern]) > k] for k in (0, 1))
    return [*first, *second][:most]


def _grid(names: Sequence[str]) -> Iterator[Point]:
    for values in islice(product(SMALL[:7], repeat=len(names)), 400):
        yield dict(zip(names, values, strict=True))
