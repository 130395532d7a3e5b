"""Loops k N/P e^{−sT} of numbers with a dead time T > 0: where roots of P + k N e^{−sT} cross the axis, and which are unstable.

On the axis N P̄ = D (R + jωI) with polynomials of x = ω², R and I without a common root.  Roots meet the axis where the phase
of R + jωI less ωT is a multiple of π; at algebraic ω ≠ 0 it never is, since e^{jωT} is transcendental there (Lindemann).  So
every sign below is decided by enclosures that are fine enough.  As |k| grows, roots cross to the right exactly where the
phase falls; it falls above the largest root of a polynomial, `turning`.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property, cmp_to_key
from itertools import pairwise
from math import ceil, factorial, floor, isqrt, log2, pi
from typing import TYPE_CHECKING, Any

from flint import acb, arb, fmpz_poly

from symobs.exact.algebraic.real_algebraic import FIRST_BITS, RealNumber, ends_of, real_roots, simplest_between
from symobs.exact.algebraic.root_location import count_roots_by_half_plane, integers
from symobs.exact.core.generators import PI
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals import TooLarge
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

#: A loop whose roots cross more often below the gains looked at is left undecided.
MOST_CROSSINGS = 400
#: A curve is followed in at most so many pieces.
MOST_PIECES = 200_000
_MOST_BITS = 2048
#: An arc that turns by less than this in a piece is followed by its ends: certainly less than π.
_HALF_TURN = Fraction(3)


@dataclass
class DelayedCrossing:
    """A root jω of P + k N e^{−sT} with ω in an interval, ω = 0 where it has no length; `side` is the sign of k."""

    loop: DelayedLoop
    low: Fraction
    high: Fraction
    side: int

    def omega(self, bits: int) -> arb:
        """Return an enclosure of ω."""
        low, high = self.loop.narrowed(self.low, self.high, bits)
        with Precision(bits):
            return fraction_ball(low).union(fraction_ball(high))

    def k(self, bits: int) -> arb:
        """Return an enclosure of k = −1/(N/P e^{−jωT})."""
        omega = self.omega(2 * bits)
        with Precision(2 * bits):
            return self.loop.gain(omega)

    def size(self, bits: int) -> arb:
        """Return an enclosure of |k|."""
        return abs(self.k(bits))

    def value(self, bits: int) -> arb:
        """Return an enclosure of N/P e^{−jωT}, which is real there."""
        with Precision(2 * bits):
            return -1 / self.k(bits)

    @property
    def is_at_zero(self) -> bool:
        """Whether the root is 0."""
        return self.high == 0

    def closed_form(self) -> tuple[Scalar, Scalar] | None:
        """Return ω and k exactly where ω = 0, or where the phase does not change but for the dead time: they contain π."""
        loop = self.loop
        if self.is_at_zero:
            return Scalar.of(0), Scalar.of(-Fraction(int(loop.P[0]), int(loop.N[0])))
        if loop.R and loop.I:
            return None
        with Precision(FIRST_BITS):  # ωT is a multiple of π/2, an even one where I = 0
            quarters = round(float((self.omega(FIRST_BITS) * fraction_ball(loop.T) / arb.pi()).mid()) * 2)
        omega = Scalar.symbol(PI) * Scalar.of(Fraction(quarters, 2) / loop.T)
        turned = _polynomial(loop.real, omega) if not loop.I else omega * _polynomial(loop.imaginary, omega)
        return omega, -_polynomial(loop.square, omega) / (turned * (1 if quarters % 4 < 2 else -1))


class DelayedLoop:
    """P and N without a common factor, what they shared, and T."""

    def __init__(self, opened: Scalar, moved: Scalar, delay: Fraction) -> None:
        """Take P and N, polynomials of s with rational coefficients, the degree of N below that of P, and T > 0."""
        rational = [[c.fraction() for c in part.coefficients("s")] for part in (opened, moved)]
        whole = integers([*rational[0], *rational[1]])
        P, N = (fmpz_poly(list(reversed(part))) for part in (whole[: len(rational[0])], whole[len(rational[0]) :]))
        self.shared = P.gcd(N)
        self.P, self.N, self.T = P // self.shared, N // self.shared, delay
        (a, b), (c, d) = (_even_and_odd(part) for part in (self.P, self.N))
        x = fmpz_poly([0, 1])
        self.square, self.moved_square = a * a + x * b * b, c * c + x * d * d
        real, imaginary = a * c + x * b * d, a * d - b * c
        common = real.gcd(imaginary)
        self.R, self.I, self.real, self.imaginary = real // common, imaginary // common, real, imaginary
        R, I = self.R, self.I
        rate, size = (I + 2 * x * I.derivative()) * R - 2 * x * I * R.derivative(), R * R + x * I * I
        while size[0] == 0:  # R = 0 at ω = 0: both have the factor x
            rate, size = rate // x, size // x
        self.rate, self.size = rate, size
        self.narrow: dict[tuple[Fraction, Fraction], tuple[Fraction, Fraction]] = {}  # what was found of a root so far
        self.turning = self.T.denominator * rate - self.T.numerator * size

    # -- the real condition on the axis --------------------------------------------------------------------------------

    def condition(self, omega: arb) -> arb:
        """Return Im((R + jωI) e^{−jωT})/ω."""
        x, angle = omega * omega, omega * fraction_ball(self.T)
        found: arb = at(self.I, x) * angle.cos() - fraction_ball(self.T) * at(self.R, x) * angle.sinc()
        return found

    def sign(self, omega: Fraction) -> int:
        """Return its sign at a rational ω; 0 at 0 alone."""
        if not omega and self.I[0] * self.T.denominator == self.R[0] * self.T.numerator:
            return 0
        bits = FIRST_BITS
        while bits <= _MOST_BITS:
            with Precision(bits):
                value = self.condition(fraction_ball(omega))
            if value > 0 or value < 0:
                return 1 if value > 0 else -1
            bits *= 2
        raise TooLarge("the phase at a frequency")

    def gain(self, omega: arb) -> arb:
        """Return −|P|²/Re(N P̄ e^{−jωT})."""
        x, angle = omega * omega, omega * fraction_ball(self.T)
        turned = at(self.real, x) * angle.cos() + omega * at(self.imaginary, x) * angle.sin()
        found: arb = -at(self.square, x) / turned
        return found

    def narrowed(self, low: Fraction, high: Fraction, bits: int) -> tuple[Fraction, Fraction]:
        """Return an interval of length 2^−bits around the root of the condition in an interval with one root."""
        if low == high:
            return low, high
        known = self.narrow.setdefault((low, high), (low, high))
        first, unit = self.sign(low), Fraction(1, 2**bits)
        low_now, high_now = known
        while high_now - low_now > unit:
            middle = (low_now + high_now) / 2
            low_now, high_now = (middle, high_now) if self.sign(middle) == first else (low_now, middle)
        self.narrow[low, high] = low_now, high_now
        return low_now, high_now

    @cached_property
    def turns(self) -> list[tuple[Fraction, Fraction]]:
        """Short intervals around the frequencies at which the phase turns, without a root of the condition."""
        return [self._around(x) for x in real_roots(self.turning) if x.sign > 0] if self.turning.degree() > 0 else []

    def _around(self, x: RealNumber) -> tuple[Fraction, Fraction]:
        bits = FIRST_BITS
        while bits <= _MOST_BITS:
            with Precision(bits):
                omega = x.ball(bits).sqrt()
                value = self.condition(omega)
            if value > 0 or value < 0:
                return ends_of(omega, bits)
            bits *= 2
        raise TooLarge("the phase where it turns")

    def roots(self, top: Fraction) -> list[tuple[Fraction, Fraction]]:
        """Return intervals with one root ω each of the condition, all roots in 0 < ω ≤ top."""
        ends, found = [Fraction(0)], list[tuple[Fraction, Fraction]]()
        for low, high in self.turns:
            if high < top:
                ends += [low, high]
        for low, high in zip(ends[::2], [*ends[1::2], top], strict=True):
            found += self._roots_between(low, high)
            if len(found) > MOST_CROSSINGS:
                raise TooLarge(f"the roots cross the imaginary axis more than {MOST_CROSSINGS} times")
        return found

    def _roots_between(self, low: Fraction, high: Fraction) -> list[tuple[Fraction, Fraction]]:
        """Return the same between two frequencies with a monotone phase: a piece that turns by less than π has at most one."""
        found, pieces, done = list[tuple[Fraction, Fraction]](), [(low, high)], 0
        while pieces and len(found) <= MOST_CROSSINGS:
            a, b = pieces.pop()
            done += 1
            if done > MOST_PIECES:
                raise TooLarge("the phase of the loop")
            with Precision(FIRST_BITS):
                omega = fraction_ball(a).union(fraction_ball(b))
                x = omega * omega
                turned = abs(at(self.rate, x) / at(self.size, x) - fraction_ball(self.T)) * fraction_ball(b - a)
                is_short = turned.is_finite() and bool(turned < fraction_ball(_HALF_TURN))
            if not is_short:
                pieces += [((a + b) / 2, b), (a, (a + b) / 2)]
            elif self.sign(a) * self.sign(b) < 0:
                found.append((a, b))
        return found

    # -- which gains ---------------------------------------------------------------------------------------------------

    def reach(self, gain: Fraction) -> Fraction:
        """Return a frequency above which |P| > |gain·N|, and above which the phase falls."""
        level = gain.denominator**2 * self.square - gain.numerator**2 * self.moved_square
        largest = [x for polynomial in (level, self.turning) for x in real_roots(polynomial)[-1:]]
        return _above_root(max([Fraction(1, 16), *(x.interval()[1] for x in largest)]))

    def crossings(self, gain: Fraction) -> list[DelayedCrossing]:
        """Return the crossings with |k| ≤ gain, and those at frequencies where the phase need not fall, by ascending k."""
        found = [] if self.N[0] == 0 or self.P[0] == 0 else [DelayedCrossing(self, Fraction(0), Fraction(0), 0)]
        top = self.turns[-1][1] if self.turns else Fraction(0)
        for low, high in self.roots(self.reach(gain)):
            crossing = DelayedCrossing(self, low, high, 0)
            if high <= top or _compare(crossing.size, gain) < 0:
                found.append(crossing)
        found = [DelayedCrossing(self, c.low, c.high, _compare(c.k, Fraction(0))) for c in found]
        return sorted(found, key=cmp_to_key(_order_of))

    @cached_property
    def early(self) -> Fraction:
        """Return a bound of |k| at crossings where the phase need not fall: above it roots cross to the right alone."""
        top = self.turns[-1][1] if self.turns else Fraction(0)
        found = [DelayedCrossing(self, low, high, 0) for low, high in (self.roots(top) if top else [])]
        found += [DelayedCrossing(self, Fraction(0), Fraction(0), 0)] if self.N[0] != 0 and self.P[0] != 0 else []
        return max([Fraction(0), *(_upper(crossing.k) for crossing in found)])

    @cached_property
    def decided(self) -> tuple[Fraction, list[DelayedCrossing]]:
        """Return a gain above which |k| is unstable on either side, and the crossings below it."""
        place = complex(0, pi / float(self.T))  # near a crossing
        below = abs(_near(self.N, place))
        guess = 1.2 * abs(_near(self.P, place)) / below if below else 1.0
        gain = _rounded_up(float(self.early) * 65 / 64 if self.early else guess)
        while not (self.unstable(gain) and self.unstable(-gain)):
            gain *= Fraction(3, 2)
            if gain > 2**200:
                raise TooLarge("the gains of the loop")
        return gain, self.crossings(gain)

    def intervals(self, signs: str = "real") -> list[tuple[Edge, Edge, Fraction]]:
        """Return the open intervals of k with stable roots, each with a rational point; without the gains of other sign."""
        if any(on_and_right(self.shared)):
            return []
        gain, crossings = self.decided
        edges: list[Edge] = [-gain, *crossings, gain]
        if on_and_right(self.P)[0] or signs in {"positive", "negative"}:  # k = 0 is no stable gain, or not allowed
            edges.insert(sum(bool(ball_of(edge, FIRST_BITS) < 0) for edge in edges), Fraction(0))
        parts = [(low, high, between(low, high)) for low, high in pairwise(edges)]
        upwards = [part for part in parts if part[2] >= 0 and signs not in {"negative", "nonpositive"}]
        downwards = [part for part in parts[::-1] if part[2] < 0 and signs not in {"positive", "nonnegative"}]
        return [*self._stable(downwards)[::-1], *self._stable(upwards)]

    def _stable(self, parts: list[tuple[Edge, Edge, Fraction]]) -> list[tuple[Edge, Edge, Fraction]]:
        """Return those with stable roots, by growing |k|: above the early crossings the first unstable one is the last."""
        found = []
        for part in parts:
            if not self.unstable(part[2]):
                found.append(part)
            elif abs(part[2]) > self.early:
                break
        return found

    def unstable(self, k: Fraction) -> int:
        """Return how many roots of P + k N e^{−sT} are unstable, for a gain at which none is on the axis: n/2 − Δarg/π."""
        n, top = int(self.P.degree()), self.reach(k) if k else self.reach(Fraction(1))
        bits = FIRST_BITS
        while bits <= _MOST_BITS:
            with Precision(bits):
                gain = fraction_ball(k)

                def whole(omega: arb, gain: arb = gain) -> acb:
                    s = acb(0, omega)
                    value: acb = at(self.P, s) + gain * at(self.N, s) * (s * -fraction_ball(self.T)).exp()
                    return value

                def reversed_part(y: arb) -> acb:
                    point, value = acb(0, -y), acb(0)
                    for coefficient in self.P.coeffs():  # Σ pᵢ (−jy)^{n−i}
                        value = value * point + int(coefficient)
                    return value

                s = acb(0, fraction_ball(top))
                rest = (whole(fraction_ball(top)) / at(self.P, s)).arg()
                turned = _turn(whole, Fraction(0), top) - _turn(reversed_part, Fraction(0), 1 / top) - rest
                count = arb(n) / 2 - turned / arb.pi()
                nearest = floor(float(count.mid()) + 0.5)
                if bool(count - nearest < 0.25) and bool(count - nearest > -0.25):
                    return nearest
            bits *= 2
        raise TooLarge("the number of unstable roots")


def pade_coefficients(order: int) -> tuple[int, ...]:
    """Return (2n − k)!/(k! (n − k)!) for k = 0 … n: e^{−x} ≈ R(−x)/R(x) with these coefficients of R."""
    return tuple(factorial(2 * order - k) // (factorial(k) * factorial(order - k)) for k in range(order + 1))


Edge = Fraction | DelayedCrossing


def on_and_right(polynomial: fmpz_poly) -> tuple[int, int]:
    """Return how many roots are on the imaginary axis and how many right of it."""
    if polynomial.degree() < 1:
        return 0, 0
    _, on, right = count_roots_by_half_plane([Fraction(int(c)) for c in reversed(polynomial.coeffs())])
    return on, right


def ball_of(edge: Edge, bits: int) -> arb:
    """Return an enclosure of an end of an interval of gains."""
    if isinstance(edge, DelayedCrossing):
        return edge.k(bits)
    with Precision(bits):
        return fraction_ball(edge)


def between(low: Edge, high: Edge) -> Fraction:
    """Return a short fraction between two ends."""
    bits = FIRST_BITS
    while bits <= _MOST_BITS:
        left, right = (ends_of(ball_of(edge, bits), bits) for edge in (low, high))
        if left[1] < right[0]:
            return simplest_between(left[1], right[0])
        bits *= 2
    raise TooLarge("two gains at which roots cross the imaginary axis")


def _turn(curve: Callable[[arb], acb], low: Fraction, high: Fraction) -> arb:
    """Return by how much the argument of a curve without a zero grows from one parameter to another."""
    pieces, total, done = [(low, high)], arb(0), 0
    while pieces:
        a, b = pieces.pop()
        done += 1
        if done > MOST_PIECES:
            raise TooLarge("the curve of the loop")
        piece = curve(fraction_ball(a).union(fraction_ball(b)))
        first, last = curve(fraction_ball(a)), curve(fraction_ball(b))
        angle = (last / first).arg() if piece.is_finite() and not piece.contains(0) else arb("nan")
        if angle.is_finite() and bool(abs(angle) < fraction_ball(_HALF_TURN)):
            total += angle
        else:
            pieces += [((a + b) / 2, b), (a, (a + b) / 2)]
    return total


def _even_and_odd(polynomial: fmpz_poly) -> tuple[fmpz_poly, fmpz_poly]:
    """Return a, b with p(jω) = a(ω²) + jω b(ω²)."""
    given = polynomial.coeffs()
    even, odd = (fmpz_poly([c if k % 2 == 0 else -c for k, c in enumerate(given[start::2])]) for start in (0, 1))
    return even, odd


def at(polynomial: fmpz_poly, point: Any) -> Any:
    """Return an enclosure of a polynomial's value."""
    value = point * 0
    for coefficient in reversed(polynomial.coeffs()):
        value = value * point + int(coefficient)
    return value


def _near(polynomial: fmpz_poly, place: complex) -> complex:
    """Return a value in floating point."""
    value = 0j
    for coefficient in reversed(polynomial.coeffs()):
        value = value * place + float(int(coefficient))
    return value


def _rounded_up(value: float) -> Fraction:
    """Return a short fraction above a number, 1/64 or more of its size."""
    found = Fraction(value).limit_denominator(10**6) if value > 0 else Fraction(0)
    unit = Fraction(2) ** (floor(log2(value)) - 6) if value > 0 else Fraction(1)
    return (found // unit + 1) * unit


def _polynomial(polynomial: fmpz_poly, omega: Scalar) -> Scalar:
    """Return the value of a polynomial of ω² at ω."""
    found = Scalar.of(0)
    for coefficient in reversed(polynomial.coeffs()):
        found = found * omega**2 + int(coefficient)
    return found


def fraction_ball(value: Fraction) -> arb:
    """Return an enclosure of a fraction."""
    return arb(value.numerator) / value.denominator


def _above_root(square: Fraction) -> Fraction:
    """Return a short fraction above the square root of a positive number."""
    return Fraction(isqrt(ceil(square * 64**2)) + 1, 64)


def _upper(value: Callable[[int], arb]) -> Fraction:
    """Return a bound of a modulus."""
    bits = FIRST_BITS
    while bits <= _MOST_BITS:
        ball = value(bits)
        if ball.is_finite():
            return max(map(abs, ends_of(ball, bits)))
        bits *= 2
    raise TooLarge("a gain at which roots cross the imaginary axis")


def _order_of(one: DelayedCrossing, other: DelayedCrossing) -> int:
    return _order(one.k, other.k)


def _compare(value: Callable[[int], arb], other: Fraction) -> int:
    """Return whether a number is below or above a fraction, −1 or 1; where it stays open they are taken as equal."""
    return _order(value, lambda bits: fraction_ball(other) + 0 * bits)


def _order(one: Callable[[int], arb], other: Callable[[int], arb]) -> int:
    bits = FIRST_BITS
    while bits <= _MOST_BITS:
        with Precision(2 * bits):
            first, second = one(bits), other(bits)
            if first < second:
                return -1
            if first > second:
                return 1
        bits *= 2
    raise TooLarge("two gains at which roots cross the imaginary axis")
