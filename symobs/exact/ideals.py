"""Polynomial ideals over the rational numbers, by Gröbner bases.

An ideal stands for what is known to be 0: the equations of a stratum, the minimal polynomial of an eigenvalue, the
relation c² + s² = 1 of a cosine and a sine.  It is kept as a reduced Gröbner basis (Buchberger's algorithm of FLINT in
the graded reverse lexicographic order; with an eigenvalue in the lexicographic one), whose size is limited, since its
computation cannot be interrupted.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property, lru_cache, reduce
from itertools import product
from math import prod
from typing import TYPE_CHECKING

from flint import Ordering, fmpq, fmpq_mat, fmpq_poly, fmpz_mpoly_vec

from symobs.exact.core.field import EIGENVALUE, Field, context_of
from symobs.exact.core.generators import function_named
from symobs.exact.core.polynomial import from_coefficients
from symobs.exact.core.scalar import Scalar
from symobs.ground.errors import Undecided

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from flint import fmpz_mpoly, fmpz_mpoly_ctx


# The functions on finitely many zeros of an ideal: the algebra Q[names]/ideal, by matrices of multiplication.


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


# Finitely many points by one coordinate: a polynomial p(x) that is 0, and every other name as a polynomial in x.
#
# Over Q[x]/(p) such a system needs no Buchberger: what is univariate is divided by p, what is linear in a new name with
# a unit as its coefficient is solved for that name, and of several equations in one new name Euclid finds the common
# divisor. Each step keeps the ideal, and the result is its reduced Gröbner basis in every lexicographic order in which
# x comes last.


def conjugate_points(equations: Iterable[Scalar]) -> tuple[str, tuple[Scalar, ...]] | None:
    """Return x and other generators of the same ideal: p(x), and y − g(x) for every other name y; None for other systems.

    Where the equations have no common zero the only generator is 1.  Equations are polynomials without roots of numbers.
    """
    for x, basis in _divided(equations):
        if all(each.degree(name) == 1 for each in basis for name in each.names - {x}):
            return x, basis
    return None


def shortened(equations: Iterable[Scalar]) -> tuple[Scalar, ...] | None:
    """Return two other generators of an ideal in two names: p(x), and a polynomial in y over Q[x]/(p); None if not found."""
    return next((basis for _, basis in _divided(equations)), None)


def _divided(equations: Iterable[Scalar]) -> Iterator[tuple[str, tuple[Scalar, ...]]]:
    """Yield for the name x of each equation in one name what is left when the others are divided."""
    given = [equation.numerator for equation in equations if not equation.is_zero]
    if not any(equation.field.roots for equation in given):
        alone = (equation for equation in given if len(equation.names) == 1)
        yield from filter(None, (_by_coordinate(each, given) for each in alone))


def _by_coordinate(first: Scalar, equations: list[Scalar]) -> tuple[str, tuple[Scalar, ...]] | None:
    """Return x, p(x) and the others by Euclid's algorithm; None where an equation holds several names that are not known."""
    (x,) = first.names
    modulus, known, left = _univariate(first, x), {x: fmpq_poly([0, 1])}, equations
    divisors: dict[str, list[fmpq_poly]] = {}
    while left:
        rest = []
        by_name: dict[str, list[list[fmpq_poly]]] = {}
        for equation in left:
            unknown = equation.names - known.keys()
            if len(unknown) > 1:
                rest.append(equation)
                continue
            coefficients = _at(equation, known, unknown, modulus)
            if len(coefficients) > 1:
                rest.append(equation)
                by_name.setdefault(next(iter(unknown)), []).append(coefficients)
                continue
            modulus = modulus.gcd(coefficients[0])
            known = {name: value % modulus for name, value in known.items()}
        divisors = {name: _divisor(polynomials, modulus) for name, polynomials in by_name.items()}
        if modulus.degree() == 0 or any(len(each) == 1 for each in divisors.values()):
            return x, (Scalar.of(1),)
        solved = {name: -each[0] for name, each in divisors.items() if len(each) == 2}
        if len(rest) == len(left) and not solved:
            if (
                len(divisors) != 1
                or not all(divisors.values())
                or any(len(each.names - known.keys()) > 1 for each in rest)
            ):
                return None
            break
        known, left = known | solved, rest
    values = (_polynomial([-value, fmpq_poly([1])], name, x) for name, value in known.items() if name != x)
    others = (_polynomial(divisor, name, x) for name, divisor in divisors.items() if left)
    return x, (_scalar(modulus, x).numerator, *values, *others)


def _divisor(polynomials: list[list[fmpq_poly]], modulus: fmpq_poly) -> list[fmpq_poly]:
    """Return the monic common divisor of polynomials over Q[x]/(p); nothing where a lead is no unit.

    One that is linear is taken alone: the others are looked at when its name is known.
    """
    found, *others = sorted(polynomials, key=len)
    if len(found) > 2 or _inverse(found[1], modulus) is None:
        found = reduce(lambda one, other: _common_divisor(one, other, modulus), others, found)
    inverse = _inverse(found[-1], modulus) if found else None
    return [] if inverse is None else [coefficient * inverse % modulus for coefficient in found]


def _common_divisor(one: list[fmpq_poly], other: list[fmpq_poly], modulus: fmpq_poly) -> list[fmpq_poly]:
    """Return the greatest common divisor over Q[x]/(p), lowest coefficient first; nothing where a lead is no unit."""
    while other and one:
        inverse = _inverse(other[-1], modulus)
        if inverse is None:
            return []
        below = [coefficient * inverse % modulus for coefficient in other]
        rest = list(one)
        while len(rest) >= len(below):
            lead, shift = rest.pop(), len(rest) + 1 - len(below)
            for place, coefficient in enumerate(below[:-1]):
                rest[shift + place] = (rest[shift + place] - lead * coefficient) % modulus
        while rest and not rest[-1]:
            rest.pop()
        one, other = below, rest
    return one


def _polynomial(coefficients: list[fmpq_poly], name: str, x: str) -> Scalar:
    """Return a polynomial in a name, its coefficients lowest first, as one in two names."""
    powers = (Scalar.symbol(name) ** k for k in range(len(coefficients)))
    parts = (_scalar(c, x) * power for c, power in zip(coefficients, powers, strict=True))
    return sum(parts, Scalar.of(0)).numerator


def _at(
    equation: Scalar, known: Mapping[str, fmpq_poly], unknown: frozenset[str], modulus: fmpq_poly
) -> list[fmpq_poly]:
    """Return the coefficients of an equation in the unknown name, lowest first, as polynomials in x modulo p."""
    powers = {name: [fmpq_poly([1])] for name in equation.names & known.keys()}
    found: list[fmpq_poly] = [fmpq_poly()]
    for coefficient, monomial in equation.each_term():
        term, place = fmpq_poly([coefficient]), 0
        for name, power in monomial:
            if name in unknown:
                place = power
                continue
            while len(powers[name]) <= power:
                powers[name].append(powers[name][-1] * known[name] % modulus)
            term = term * powers[name][power] % modulus
        found += [fmpq_poly()] * (place + 1 - len(found))
        found[place] += term
    while len(found) > 1 and not found[-1] % modulus:
        found.pop()
    return [each % modulus for each in found]


def _inverse(value: fmpq_poly, modulus: fmpq_poly) -> fmpq_poly | None:
    """Return the inverse modulo p, None where there is none."""
    common, inverse, _ = value.xgcd(modulus)
    return inverse / common[0] % modulus if common.degree() == 0 else None


def _univariate(value: Scalar, x: str) -> fmpq_poly:
    return fmpq_poly([fmpq(c.numerator, c.denominator) for c in map(Scalar.fraction, reversed(value.coefficients(x)))])


def _scalar(value: fmpq_poly, x: str) -> Scalar:
    fractions = [Fraction(int(c.p), int(c.q)) for c in reversed(value.coeffs())]
    return from_coefficients([Scalar.of(each) for each in fractions], x) if fractions else Scalar.of(0)


#: The most polynomials of a basis, terms of one of them, and bits of a coefficient, before the work is given up.
LIMITS = (120, 600, 4_000)
#: The most terms that the generators may have together.
TERMS = 1_000
#: The most monomials among which a basis of the functions on finitely many points is looked for.
_MONOMIALS = 150
#: Beyond so many conjugate points they are kept by the polynomial of one coordinate: a graded basis of them is longer still.
FEW = 6
#: What the names of the coordinates of a vector begin with; no parameter's name begins so.
_UNIT = "_e"
#: What the name of the inverse of a polynomial begins with.
_INVERSE = "1/"


class TooLarge(Undecided, ArithmeticError):
    """A Gröbner basis exceeds the limits: what depends on it is undecided."""


class Ideal:
    """The ideal that polynomials generate in Q[names]; of a rational function the numerator counts."""

    def __init__(
        self, field: Field, basis: fmpz_mpoly_vec, home: fmpz_mpoly_ctx, coordinate: str | None = None
    ) -> None:
        """Take a reduced Gröbner basis; that of points by a coordinate x holds p(x), and y − g(x) for every other name y."""
        self.field = field
        self.basis = basis
        self.home = home
        self.coordinate = coordinate

    @staticmethod
    def of(generators: Iterable[Scalar]) -> Ideal:
        """Return the ideal generated by polynomials; raises `TooLarge`."""
        return _ideal(tuple(dict.fromkeys(g.numerator for g in generators if not g.is_zero)))

    @staticmethod
    def where(relations: Iterable[Scalar]) -> Ideal:
        """Return the ideal of relations, without those 1 − w q that add nothing to it; raises `TooLarge`.

        Where no q lies in a prime ideal, p lies in it with 1 − w q just if it does without.
        """
        relations = tuple(relations)
        apart = [relation for relation in relations if any(map(is_inverse, relation.names))]
        equations = Ideal.of(relation for relation in relations if relation not in apart)
        if apart and equations.is_seen_prime and not any(value in equations for value in map(kept_from_zero, apart)):
            return equations
        return Ideal.of(relations)

    @cached_property
    def generators(self) -> tuple[Scalar, ...]:
        """The reduced Gröbner basis."""
        found = [self._back(polynomial) for polynomial in self.basis]
        return tuple(generator for generator in found if generator)

    @property
    def is_whole(self) -> bool:
        """Whether 1 lies in the ideal: there is no common complex zero."""
        return any(polynomial.is_constant() for polynomial in self.basis)

    @cached_property
    def is_seen_prime(self) -> bool:
        """Whether this is 0, the ideal of one irreducible curve, or that of conjugate points by a coordinate."""
        if self.field.roots or (len(self.generators) != 1 and self.coordinate is None):
            return not self.field.roots and not self.generators
        leading = [g for g in self.generators if self.coordinate is None or g.names <= {self.coordinate}]
        factors = leading[0].factors()[1] if len(leading) == 1 else ()
        return len(factors) == 1 and factors[0][1] == 1

    def remainder(self, value: Scalar) -> Scalar:
        """Return the normal form of a numerator up to a nonzero rational factor; 0 exactly for members."""
        if not self.generators:
            return value.numerator
        field = self.field | value.field
        if field is not self.field:
            return self.within(field).remainder(value)
        moved = field.lift(value.numerator.numerator_part, value.field).project_to_context(self.home)
        return self._back(moved.reduction_primitive_part(self.basis))  # type: ignore[attr-defined]

    def within(self, field: Field) -> Ideal:
        """Return the ideal in a larger field: further generators leave a reduced basis of the same order what it is."""
        if (EIGENVALUE in field.position) != (EIGENVALUE in self.field.position):
            return _ideal(self.generators, field)
        if field.roots:
            return _ideal(self.generators, field)
        home = _home(field, self.coordinate)
        moved = [field.lift(g.numerator_part, g.field).project_to_context(home) for g in self.generators]
        return Ideal(field, fmpz_mpoly_vec(moved, home), home, self.coordinate)

    def reduced_column(self, entries: Sequence[Scalar]) -> tuple[Scalar, ...]:
        """Return the normal forms of the entries of a vector, times one common rational number.

        Entries are polynomials.  They are reduced as the linear form Σ entryᵢ eᵢ in new generators, which keeps their
        proportions.
        """
        names = [f"{_UNIT}{index}" for index in range(len(entries))]
        form = sum((e * Scalar.symbol(n) for e, n in zip(entries, names, strict=True)), Scalar.of(0))
        rest = self.remainder(form)
        zeros = {name: Scalar.of(0) for name in names}
        return tuple(rest.substitute({**zeros, name: Scalar.of(1)}) for name in names)

    def __contains__(self, value: Scalar) -> bool:
        return self.remainder(value).is_zero

    def simplified(self, value: Scalar) -> Scalar:
        """Return a rational function that agrees with `value` wherever the ideal vanishes, in normal form.

        Where that would be longer, or divide by 0, the value stays as it is, and where a square would be hidden: modulo
        cos² + sin² − 1 a product (a + cos)² (a − cos) may be a polynomial without factors.
        """
        if not self.generators:
            return value
        above, below, one = self.reduced_column([value.numerator, value.denominator, Scalar.of(1)])
        if below.is_zero or one.is_zero:
            return value
        found = above / below
        return found if found.size <= value.size and not self._hides_a_square(value, found) else value

    def _hides_a_square(self, value: Scalar, found: Scalar) -> bool:
        """Return whether a value with cosines or sines has a factor twice, and what agrees with it has fewer factors."""
        kinds = {f.kind for name in value.numerator.names if (f := function_named(name)) is not None}
        if found.is_constant or kinds.isdisjoint({"cos", "sin"}):
            return False
        factors = value.numerator.factors()[1]
        if all(power == 1 for _, power in factors):
            return False
        before = sum(power for factor, power in factors if not self.simplified(factor).is_constant)
        return before > sum(power for _, power in found.numerator.factors()[1])

    @cached_property
    def _bounds(self) -> tuple[int, ...] | None:
        """The exponents at which each generator alone is a leading monomial; None where one never is.

        Beside roots of numbers there are none: the zeros would be counted once for each sign of a root.
        """
        if self.field.roots:
            return None
        leading = [polynomial.monoms()[0] for polynomial in self.basis]
        found = [_pure_power(leading, k) for k in range(len(self.home.names()))]
        return tuple(bound for bound in found if bound is not None) if found and None not in found else None

    @property
    def is_finite(self) -> bool:
        """Whether there are finitely many complex zeros."""
        return self._bounds is not None

    @property
    def dimension(self) -> int | None:
        """How many complex zeros there are, each counted with its multiplicity; None where they are too many to be counted."""
        return None if self.quotient is None else self.quotient.dimension

    @cached_property
    def quotient(self) -> QuotientRing | None:
        """The functions on the zeros, by the monomials that no leading monomial of the basis divides."""
        if self._bounds is None or prod(self._bounds) > _MONOMIALS:
            return None
        leading = [polynomial.monoms()[0] for polynomial in self.basis]
        found = [p for p in product(*map(range, self._bounds)) if not any(_divides(lead, p) for lead in leading)]
        generators = {str(name): name for name in self.field.names}
        names = [Scalar.symbol(generators[name]) for name in self.home.names()]
        monomials = [prod((x**k for x, k in zip(names, p, strict=True)), start=Scalar.of(1)) for p in found]
        return QuotientRing(monomials, self.field.names, self.reduced_column)

    @cached_property
    def by_coordinate(self) -> tuple[Scalar, ...] | None:
        """Other generators: a polynomial in one name, and every other name as a polynomial in it; None where there are none."""
        if self.coordinate is not None:
            return self.generators
        if self.quotient is None:
            return None
        for name in reversed(self.field.names) if self.dimension else ():
            below = self.quotient.minimal_polynomial(Scalar.symbol(name), name)
            if below.degree(name) == self.dimension:
                return self.quotient.by_coordinate(name, below, below)
        return None

    def extended_by(self, *others: Scalar) -> Ideal:
        """Return the ideal with further generators; raises `TooLarge`."""
        return Ideal.of((*self.generators, *others))

    def _back(self, polynomial: fmpz_mpoly) -> Scalar:
        return Scalar(self.field, self.field.normal(polynomial.project_to_context(self.field.context)), self.field.one)


def _pure_power(leading: Sequence[tuple[int, ...]], place: int) -> int | None:
    """Return the exponent of the one generator whose power is a leading monomial, None where none is."""
    return next((powers[place] for powers in leading if sum(powers) == powers[place]), None)


def _divides(lead: tuple[int, ...], powers: tuple[int, ...]) -> bool:
    return all(here <= there for here, there in zip(lead, powers, strict=True))


def apart_from_zero(value: Scalar) -> Scalar:
    """Return the polynomial 1 − w p, which has zeros exactly where p is not 0; w is a generator that belongs to p alone."""
    return 1 - Scalar.symbol(f"{_INVERSE}({value.numerator})") * value.numerator


def kept_from_zero(relation: Scalar) -> Scalar:
    """Return the p of a relation 1 − w p."""
    (name,) = filter(is_inverse, relation.names)
    return -relation.coefficients(name)[0]


def is_inverse(name: str) -> bool:
    """Return whether a generator stands for the inverse of a polynomial."""
    return name.startswith(_INVERSE)


def _home(field: Field, coordinate: str | None = None) -> fmpz_mpoly_ctx:
    """Return the context of a basis; an eigenvalue among the names is eliminated first.

    It comes first in a lexicographic order, which eliminates it.  Roots of numbers come last in one: then the basis is
    that over the field of the numbers, and the squares of the roots.  A coordinate by which points are known comes last, too.
    """
    if EIGENVALUE not in field.position and not field.roots and coordinate is None:
        return context_of(field.names, Ordering.degrevlex)
    numbers = field.numbers.names if coordinate is None else (coordinate,)
    first = (EIGENVALUE,) if EIGENVALUE in field.position else ()
    others = (name for name in field.names if name != EIGENVALUE and name not in numbers)
    return context_of((*first, *others, *numbers), Ordering.lex)


@lru_cache(maxsize=512)
def _ideal(generators: tuple[Scalar, ...], field: Field | None = None) -> Ideal:
    if field is None:  # only of what occurs: with an idle generator there are never finitely many zeros
        field = Field.of({name for generator in generators for name in generator.names})
    home = _home(field)
    moved = [field.lift(g.numerator_part, g.field).project_to_context(home) for g in generators]
    if any(polynomial.is_constant() for polynomial in moved):
        return Ideal(field, fmpz_mpoly_vec([home.constant(1)], home), home)
    if any(_alone(generator) > FEW for generator in generators) and (points := _points(generators, field)):
        return points
    moved += [square.project_to_context(home) for square in field.relations] if moved else []
    has_few = len(moved) <= 1 or sum(len(polynomial) for polynomial in moved) <= TERMS
    basis, complete = fmpz_mpoly_vec(moved, home).buchberger_naive(limits=LIMITS) if has_few else (None, False)
    if basis is None or not complete:
        if points := _points(generators, field):
            return points
        if (shorter := shortened(generators)) and set(shorter) != set(generators):
            return _ideal(shorter, field)
        raise TooLarge(f"the equations {'are too long to be decided' if has_few else 'have too many terms'}")
    return Ideal(field, fmpz_mpoly_vec(_reduced(list(basis), home), home), home)  # type: ignore[call-overload]


def _reduced(basis: list[fmpz_mpoly], home: fmpz_mpoly_ctx) -> list[fmpz_mpoly]:
    """Return the reduced Gröbner basis of a Gröbner basis.

    The members whose leading monomials no other one divides are one, too, and each is reduced by the others once.
    """
    kept: dict[tuple[int, ...], fmpz_mpoly] = {}
    for member in sorted(basis, key=lambda member: sum(member.monoms()[0])):
        lead = member.monoms()[0]
        if not any(_divides(other, lead) for other in kept):
            kept[lead] = member
    others = {lead: fmpz_mpoly_vec([kept[each] for each in kept if each != lead], home) for lead in kept}
    return [member.reduction_primitive_part(others[lead]) for lead, member in kept.items()]  # type: ignore[attr-defined]


def _alone(generator: Scalar) -> int:
    """Return the degree of a polynomial in one name, 0 of another."""
    return generator.degree(*generator.names) if len(generator.names) == 1 else 0


def _points(generators: tuple[Scalar, ...], field: Field) -> Ideal | None:
    """Return the ideal of points that one of their coordinates gives, None where the generators are no such system."""
    found = conjugate_points(generators)
    if found is None or found[0] == EIGENVALUE:
        return None
    coordinate, basis = found
    home = _home(field, coordinate)
    moved = [field.lift(g.numerator_part, g.field).project_to_context(home) for g in basis]
    return Ideal(field, fmpz_mpoly_vec(moved, home), home, coordinate)


# Triangular systems of polynomial equations by lexicographic Gröbner bases of limited size.


#: The most polynomials of a basis, terms of one of them, and bits of a coefficient, before the work is given up.
TRIANGULAR_LIMITS = (40, 120, 600)


def triangular(equations: Sequence[Scalar], unknowns: Sequence[str]) -> tuple[Scalar, ...]:
    """Return a basis of the ideal of equations from which the unknowns are eliminated one after the other.

    Polynomials free of all unknowns come first, then those in the last of them alone, and so on.  Raises `TooLarge`.
    """
    field = Field.of(())
    for equation in equations:
        field = field | equation.field
    others = [name for name in field.names if name not in unknowns]
    home = context_of((*unknowns, *others), Ordering.lex)
    moved = [field.lift(e.numerator.numerator_part, e.field).project_to_context(home) for e in equations if e]
    if any(polynomial.is_constant() for polynomial in moved):
        return (Scalar.of(1),)
    moved += [square.project_to_context(home) for square in field.relations]
    if sum(len(polynomial) for polynomial in moved) > TERMS:
        raise TooLarge("the equations have too many terms")
    basis, complete = fmpz_mpoly_vec(moved, home).buchberger_naive(limits=TRIANGULAR_LIMITS)
    if not complete:
        raise TooLarge("the equations are too long to be eliminated")
    reduced = basis.autoreduction(groebner=True)  # type: ignore[attr-defined]
    back = (field.normal(polynomial.project_to_context(field.context)) for polynomial in reduced)
    found = [Scalar(field, polynomial, field.one) for polynomial in back if polynomial]
    order = {name: place for place, name in enumerate(unknowns)}
    return tuple(
        sorted(found, key=lambda p: (-min((order[n] for n in p.names if n in order), default=len(order)), p.size))
    )
