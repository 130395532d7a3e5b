"""Real algebraic numbers: a root of an irreducible polynomial, given by its index among the real roots.

Isolation is FLINT's, certified: the balls are disjoint, and a ball with imaginary part exactly 0 holds a real root.
"""

from __future__ import annotations

import itertools
from fractions import Fraction
from functools import lru_cache, total_ordering
from math import ceil, floor
from typing import TYPE_CHECKING, Any

from flint import arb, fmpq, fmpz_poly

from symobs.exact.algebraic.polynomial_roots import rational_sqrt
from symobs.exact.core.field import Field
from symobs.exact.core.generators import Function, square_root
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

#: Bits of the first enclosure; doubled whenever they do not decide.
FIRST_BITS = 64


@total_ordering
class RealNumber:
    """The root number `index` (from 0, ascending) among the real roots of an irreducible integer polynomial."""

    __slots__ = ("enclosed", "index", "polynomial")

    def __init__(self, polynomial: fmpz_poly, index: int) -> None:
        """Take an irreducible polynomial with positive leading coefficient."""
        self.polynomial = polynomial
        self.index = index
        self.enclosed: tuple[int, arb] | None = None

    @staticmethod
    def of(value: Fraction | int) -> RealNumber:
        """Return a rational number."""
        number = Fraction(value)
        return RealNumber(fmpz_poly([-number.numerator, number.denominator]), 0)

    @property
    def degree(self) -> int:
        """The degree of the minimal polynomial."""
        return int(self.polynomial.degree())

    @property
    def is_rational(self) -> bool:
        """Whether this is a rational number."""
        return self.degree == 1

    @property
    def fraction(self) -> Fraction:
        """The number, where it is rational."""
        return Fraction(-int(self.polynomial[0]), int(self.polynomial[1]))

    def __eq__(self, other: object) -> bool:
        return isinstance(other, RealNumber) and (self.index, self.polynomial) == (other.index, other.polynomial)

    def __hash__(self) -> int:
        return hash((self.index, tuple(map(int, self.polynomial.coeffs()))))

    def __lt__(self, other: RealNumber) -> bool:
        if self.polynomial == other.polynomial:
            return self.index < other.index
        bits = FIRST_BITS
        while True:  # different irreducible polynomials have no root in common, so the balls come apart
            mine, its = self.ball(bits), other.ball(bits)
            if mine < its:
                return True
            if mine > its:
                return False
            bits *= 2

    def ball(self, bits: int = FIRST_BITS) -> arb:
        """Return an enclosing ball of at least this precision."""
        kept = self.enclosed
        if kept is None or bits > kept[0]:  # kept in one piece, so that no ball is called more precise than it is
            most = max(bits, FIRST_BITS)
            kept = self.enclosed = most, _real_balls(tuple(map(int, self.polynomial.coeffs())), most)[self.index]
        return kept[1]

    def interval(self, bits: int = FIRST_BITS) -> tuple[Fraction, Fraction]:
        """Return rational bounds; both are the number itself where it is rational."""
        if self.is_rational:
            return self.fraction, self.fraction
        return ends_of(self.ball(bits), bits)

    def between(self) -> tuple[Fraction, Fraction]:
        """Return short decimals on either side that isolate the root."""
        others, digits = [root for root in real_roots(self.polynomial) if root != self], 2
        while True:
            unit, (low, high) = 10**digits, self.interval()
            ends = Fraction(floor(low * unit), unit), Fraction(ceil(high * unit), unit)
            if ends[0] < low and high < ends[1] and not any(self._within(root, ends) for root in others):
                return ends
            digits += 1

    @staticmethod
    def _within(root: RealNumber, ends: tuple[Fraction, Fraction]) -> bool:
        low, high = root.interval()
        return ends[0] < high and low < ends[1]

    def sign_of(self, polynomial: fmpz_poly) -> int:
        """Return the sign of a polynomial with integer coefficients at this number."""
        if not polynomial or polynomial.gcd(self.polynomial).degree() == self.degree:
            return 0
        bits = FIRST_BITS
        while True:
            value = at_ball(polynomial, self.ball(bits), bits)
            if value > 0:
                return 1
            if value < 0:
                return -1
            bits *= 2

    @property
    def sign(self) -> int:
        """The sign of the number."""
        return self.sign_of(fmpz_poly([0, 1]))

    def closed_form(self) -> Scalar | None:
        """Return the closed form by square roots, for degree 1 and 2 and ±√a ± √b."""
        return _closed_form(self)

    def truncated(self, digits: int = 5) -> str:
        """Return the first digits of an irrational number, truncated: 1.41421."""
        bits = FIRST_BITS
        while True:
            low, high = (int(end * 10**digits) for end in self.interval(bits))
            if low == high:
                break
            bits *= 2
        whole, rest = divmod(abs(low), 10**digits)
        return f"{'-' if self.interval()[1] < 0 else ''}{whole}.{rest:0{digits}d}"

    def decimal(self, digits: int = 6) -> str:
        """Return the number rounded to this many digits after the point, every digit certified."""
        if self.is_rational:
            return rounded_to(self.fraction, digits)
        bits = FIRST_BITS
        while True:  # an irrational number is never half-way between two decimals
            low, high = self.interval(bits)
            shown = {rounded_to(low, digits), rounded_to(high, digits)}
            if len(shown) == 1:
                return shown.pop()
            bits *= 2

    def text(self, variable: str = "x") -> str:
        """Return the exact text: a closed form, or `CRootOf(polynomial, index)`."""
        closed = self.closed_form()
        return str(closed) if closed is not None else f"CRootOf({self.minimal_polynomial(variable)}, {self.index})"

    def scalar(self, variable: str = "x") -> Scalar:
        """Return the number as a scalar: its closed form, or a generator."""
        closed = self.closed_form()
        return closed if closed is not None else RealRoot("CRootOf", self.minimal_polynomial(variable), self).value

    def minimal_polynomial(self, variable: str) -> Scalar:
        """Return the polynomial in a variable."""
        field = Field.of((variable,))
        terms: dict[tuple[int, ...], int] = {(k,): int(c) for k, c in enumerate(self.polynomial.coeffs()) if c != 0}
        return Scalar(field, field.context.from_dict(terms), field.one)

    def __str__(self) -> str:
        return self.text()

    def __repr__(self) -> str:
        return f"RealNumber({self})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _from_coefficients, (tuple(map(int, self.polynomial.coeffs())), self.index)


@dataclass
class RealRoot(Function):
    """A real algebraic number without a closed form as a generator; the argument is its minimal polynomial."""

    number: RealNumber

    @property
    def text(self) -> str:
        """SymPy's text."""
        return f"CRootOf({self.argument}, {self.number.index})"

    @property
    def radicand(self) -> Scalar | None:
        """The fraction a where this is the positive root of some degree of a, else None."""
        first, *others, last = map(int, self.number.polynomial.coeffs())
        return (
            Scalar.of(Fraction(-first, last))
            if first < 0 and not any(others) and self.number.interval()[0] >= 0
            else None
        )

    @property
    def symbols(self) -> frozenset[str]:
        """Nothing: a number has no symbols."""
        return frozenset()

    def rate(self, time: str) -> Scalar:  # noqa: ARG002 - a number does not move
        """Return 0."""
        return Scalar.of(0)

    def moved(self, values: Mapping[str, Scalar]) -> Scalar:  # noqa: ARG002
        """Return the number itself."""
        return self.value


def _from_coefficients(coefficients: tuple[int, ...], index: int) -> RealNumber:
    return RealNumber(fmpz_poly(list(coefficients)), index)


def ends_of(ball: arb, bits: int) -> tuple[Fraction, Fraction]:
    """Return rational bounds of a ball, rounded outwards to twice the bits."""
    with Precision(2 * bits):
        return _fraction(ball.lower()), _fraction(ball.upper())


def _fraction(exact: arb) -> Fraction:
    found = exact.fmpq()
    return Fraction(int(found.p), int(found.q))


def rounded_to(value: Fraction, digits: int) -> str:
    """Return a number rounded to so many digits after the point, without zeros at the end."""
    scaled = floor(abs(value) * 10**digits + Fraction(1, 2))
    whole, rest = divmod(scaled, 10**digits)
    text = f"{whole}.{rest:0{digits}d}".rstrip("0").rstrip(".") if digits else str(whole)
    return f"-{text}" if value < 0 and scaled else text


@lru_cache(maxsize=1024)
def _real_balls(coefficients: tuple[int, ...], bits: int) -> tuple[arb, ...]:
    """Return enclosures of the distinct real roots of a polynomial, lowest coefficient first, ascending."""
    with Precision(bits):
        if len(coefficients) == 2:
            return (arb(-coefficients[0]) / coefficients[1],)
        found: Any = fmpz_poly(list(coefficients)).complex_roots()
        return tuple(sorted((root.real for root, _ in found if root.imag == 0), key=lambda ball: ball.mid().fmpq()))


def at_ball(polynomial: fmpz_poly, point: arb, bits: int) -> arb:
    """Return an enclosure of a polynomial's value, by Horner's rule."""
    with Precision(2 * bits):
        value = arb(0)
        for coefficient in reversed(polynomial.coeffs()):
            value = value * point + coefficient
        return value


def real_roots(polynomial: fmpz_poly) -> list[RealNumber]:
    """Return the distinct real roots of a polynomial that is not 0, ascending."""
    found: list[RealNumber] = []
    for factor in irreducible_factors(polynomial):
        count = len(_real_balls(tuple(map(int, factor.coeffs())), FIRST_BITS))
        found += [RealNumber(factor, index) for index in range(count)]
    return sorted(found)


def irreducible_factors(polynomial: fmpz_poly) -> list[fmpz_poly]:
    """Return the distinct irreducible factors of positive degree, with positive leading coefficients."""
    parts = [factor for factor, _ in polynomial.factor()[1]] if polynomial.degree() > 0 else []
    return [factor if factor[factor.degree()] > 0 else -factor for factor in parts]


def count_roots(polynomial: fmpz_poly, low: Fraction | None, high: Fraction | None) -> int:
    """Return how many distinct real roots lie in the open interval, by Sturm's theorem; the ends must be no roots."""
    return root_counter(polynomial)(low, high)


def root_counter(polynomial: fmpz_poly) -> Callable[[Fraction | None, Fraction | None], int]:
    """Return `count_roots` of one polynomial, whose chain serves for all intervals."""
    chain = sturm_chain(polynomial)
    return lambda low, high: _variations(chain, low, -1) - _variations(chain, high, 1)


def sturm_chain(polynomial: fmpz_poly) -> list[fmpz_poly]:
    """Return Sturm's chain, each member divided by its content."""
    chain = [polynomial, polynomial.derivative()]
    while chain[-1].degree() > 0:
        above, below = chain[-2], chain[-1]
        lead = below[below.degree()]
        power = above.degree() - below.degree() + 1
        factor = lead ** (power + power % 2)  # positive, so that signs are kept
        left = above * factor % below
        if not left:
            break
        chain.append(-left // abs(left.content()) if left.content() != 1 else -left)
    return chain


def _variations(chain: Sequence[fmpz_poly], point: Fraction | None, side: int) -> int:
    """Return the sign changes of a chain at a point, or at side·∞ where there is none."""
    if point is None:
        signs = [(1 if p[p.degree()] > 0 else -1) * (side if p.degree() % 2 else 1) for p in chain]
    else:
        where = fmpq(point.numerator, point.denominator)
        values = [p(where) for p in chain]
        signs = [1 if value > 0 else -1 for value in values if value != 0]
    return sum(a != b for a, b in itertools.pairwise(signs))


def simplest_between(low: Fraction | None, high: Fraction | None) -> Fraction:
    """Return the rational number with the smallest denominator, then the smallest size, in an open interval."""
    if low is None and high is None:
        return Fraction(0)
    if low is None:
        assert high is not None  # noqa: S101 - one of the two is there
        return Fraction(0) if high > 0 else Fraction(ceil(high) - 1)
    if high is None:
        return Fraction(0) if low < 0 else Fraction(floor(low) + 1)
    if low < 0 < high:
        return Fraction(0)
    if high <= 0:
        return -simplest_between(-high, -low)
    whole = floor(low)
    if whole + 1 < high:
        return Fraction(whole + 1)
    if low == whole:  # 1/n with the smallest n
        return whole + Fraction(1, floor(1 / (high - whole)) + 1)
    return whole + 1 / simplest_between(1 / (high - whole), 1 / (low - whole))


def rational_between(low: RealNumber | None, high: RealNumber | None) -> Fraction:
    """Return a simple rational number between two different numbers, either of which may be missing."""
    bits = FIRST_BITS
    while True:
        left = None if low is None else low.interval(bits)[1]
        right = None if high is None else high.interval(bits)[0]
        if left is None or right is None or left < right:
            return simplest_between(left, right)
        bits *= 2


def _closed_form(number: RealNumber) -> Scalar | None:
    c = [Scalar.of(int(coefficient)) for coefficient in number.polynomial.coeffs()]
    if number.degree == 1:
        return -c[0] / c[1]
    if number.degree == 2:
        centre, root = -c[1] / (2 * c[2]), square_root((c[1] ** 2 - 4 * c[0] * c[2]) / (4 * c[2] ** 2))
        return centre + root if number.index else centre - root
    if number.degree == 4 and c[1].is_zero and c[3].is_zero:
        return _sum_of_two_roots(c[2] / c[4], c[0] / c[4], number.index)
    return None


def _sum_of_two_roots(p: Scalar, q: Scalar, index: int) -> Scalar | None:
    """Return a root of x⁴ + p x² + q as ±√a ± √b, a + b = −p/2 and a − b = √q, where √q is rational and a ≥ b ≥ 0."""
    product = rational_sqrt(q.fraction()) if q.fraction() >= 0 else None
    if product is None:
        return None
    a, b = (-p / 2 + Scalar.of(product)) / 2, (-p / 2 - Scalar.of(product)) / 2
    if b.fraction() <= 0:
        return None
    first, second = square_root(a), square_root(b)
    return (-first - second, -first + second, first - second, first + second)[index]


def roots_of_scalar(polynomial: Scalar, name: str) -> list[RealNumber]:
    """Return the distinct real roots of a polynomial in one name, ascending."""
    return real_roots(integer_factor(polynomial, name))


def integer_factor(polynomial: Scalar, name: str) -> fmpz_poly:
    """Return the numerator as a polynomial in one name."""
    return fmpz_poly([int(c.fraction()) for c in reversed(polynomial.numerator.coefficients(name))])


def root_of_fraction(number: Fraction, degree: int) -> Scalar:
    """Return the positive root, of some degree, of a positive fraction."""
    coefficients = [-number.numerator, *([0] * (degree - 1)), number.denominator]
    return max(real_roots(fmpz_poly(coefficients))).scalar()
