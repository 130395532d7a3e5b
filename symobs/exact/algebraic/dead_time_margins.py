"""How far a loop N/P e^{−sT} with a dead time is from −1 on the imaginary axis, every digit certain.

With M = N e^{−jωT} and d = |P|² it is |1 + M/P|² = 1 + r/d with r = Re M(2P̄ + M̄).  It is smallest where r′d − rd′ vanishes;
above a proved frequency |N/P| is too small.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property, lru_cache, reduce
from typing import TYPE_CHECKING

from flint import acb, arb, fmpz_poly

from symobs.exact.algebraic.dead_time import (
    MOST_PIECES,
    DelayedCrossing,
    DelayedLoop,
    at,
    ball_of,
    fraction_ball,
    on_and_right,
    pade_coefficients,
)
from symobs.exact.algebraic.loop_distances import INFINITE, MARGIN_DIGITS, certain
from symobs.exact.algebraic.real_algebraic import (
    FIRST_BITS,
    RealNumber,
    ends_of,
    real_roots,
    roots_of_scalar,
    rounded_to,
    simplest_between,
)
from symobs.exact.algebraic.root_loci import LOCUS_DIGITS, on_boundary
from symobs.exact.core.ring import Precision
from symobs.exact.core.scalar import Scalar
from symobs.exact.ideals import TooLarge
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.exact.algebraic.dead_time import Edge

#: Where the distance is smallest is sought in pieces down to this length, relative to the whole.
_SHORTEST = Fraction(1, 2**40)
#: The digits after the point of what JSON tells of a number without a closed form.
LONG_DIGITS = 12
#: What a sentence tells as a word.
WORDS_OF_DEAD_TIME = ("before", "after", "around")
#: Points below the last crossover at which it is looked at first.
_FIRST_POINTS = 64


@dataclass
class Distances:
    """The distances of a loop whose closed loop is stable."""

    loop: DelayedLoop

    @property
    def crossovers(self) -> list[RealNumber]:
        """The squares of the frequencies at which |N/P| = 1."""
        level = self.loop.square - self.loop.moved_square
        return [x for x in real_roots(level) if x.sign > 0] if level.degree() > 0 else []

    def lag(self, x: RealNumber, bits: int) -> arb:
        """Return the angle in (0, 2π) by which the loop can lag at a frequency until it meets −1."""
        with Precision(bits):
            omega = x.ball(bits).sqrt()
            s = acb(0, omega)
            value = -at(self.loop.N, s) / at(self.loop.P, s) * (s * -fraction_ball(self.loop.T)).exp()
            angle: arb = value.arg()
            return angle + 2 * arb.pi() if angle < 0 else angle

    def phase(self, digits: int) -> str | None:
        """Return the least angle in degrees, either way, `oo` where |N/P| is never 1."""
        found = self.crossovers

        def least(bits: int) -> arb:
            with Precision(bits):
                angles = [angle for x in found for lag in [self.lag(x, bits)] for angle in (lag, 2 * arb.pi() - lag)]
                return reduce(arb.min, angles) * 180 / arb.pi()

        return certain(least, digits) if found else INFINITE

    def delay_margin(self, digits: int) -> str | None:
        """Return the dead time that may be added, `oo` where |N/P| is never 1."""
        found = self.crossovers

        def least(bits: int) -> arb:
            with Precision(bits):
                return reduce(arb.min, [self.lag(x, bits) / x.ball(bits).sqrt() for x in found])

        return certain(least, digits) if found else INFINITE

    def modulus(self, digits: int) -> str | None:
        """Return min |1 + N/P e^{−jωT}|."""
        return certain(self._distance, digits)

    def peak(self, digits: int) -> str | None:
        """Return the peak of the sensitivity."""
        return certain(lambda bits: 1 / self._distance(bits), digits)

    def _distance(self, bits: int) -> arb:
        with Precision(2 * bits):
            return reduce(arb.min, [self._least(low, high, bits) for low, high in self._nearest]).sqrt()

    @cached_property
    def _nearest(self) -> list[tuple[Fraction, Fraction]]:
        """Pieces on which the slope grows through 0, outside of which the distance is larger than in one of them."""
        with Precision(FIRST_BITS):
            best, first = arb(1), self.loop.reach(Fraction(1))
            places = [fraction_ball(first * k / _FIRST_POINTS) for k in range(1, 2 * _FIRST_POINTS)]
            for omega in [*places, *(c.omega(FIRST_BITS) for c in self.loop.decided[1])]:
                nearest = self._square(omega).upper()
                best = best.min(nearest) if nearest.is_finite() else best
            room = ends_of(1 - best.sqrt(), FIRST_BITS)[0]
            if room <= 0:
                raise TooLarge("the least distance from -1")
            top = self.loop.reach(1 / simplest_between(room / 2, room))  # above it |1 + N/P e^{−jωT}| > 1 − room
            pieces, found, done = [(Fraction(0), top)], list[tuple[Fraction, Fraction]](), 0
            while pieces:
                a, b = pieces.pop()
                done += 1
                if done > MOST_PIECES or b - a < top * _SHORTEST:
                    raise TooLarge("the least distance from -1")
                r, d = self._derivatives(fraction_ball(a).union(fraction_ball(b)))
                middle = self._square(fraction_ball((a + b) / 2)).upper()
                best = best.min(middle) if middle.is_finite() else best
                slope, bend = r[1] * d[0] - r[0] * d[1], r[2] * d[0] - r[0] * d[2]
                if slope < 0 or slope > 0 or (not a and bend < 0) or self._is_above(r[0], d[0], best):
                    continue  # nearer to −1 at an end, which belongs to another piece, or not near enough
                if bend > 0:
                    found.append((a, b))
                else:
                    pieces += [((a + b) / 2, b), (a, (a + b) / 2)]
            return found

    def _least(self, low: Fraction, high: Fraction, bits: int) -> arb:
        """Return the least value of 1 + r/d on a piece on which its slope grows; at 0 the slope is 0."""
        unit = Fraction(1, 2**bits)
        while low and high - low > unit:
            middle = (low + high) / 2
            r, d = self._derivatives(fraction_ball(middle))
            slope = r[1] * d[0] - r[0] * d[1]
            if not slope < 0 and not slope > 0:
                break
            low, high = (middle, high) if slope < 0 else (low, middle)
        return self._square(fraction_ball(low).union(fraction_ball(high)) if low else arb(0))

    def _square(self, omega: arb) -> arb:
        r, d = self._derivatives(omega)
        return 1 + r[0] / d[0]

    @staticmethod
    def _is_above(r: arb, d: arb, best: arb) -> bool:
        """Return whether 1 + r/d exceeds a number, also where d may vanish."""
        quotient = 1 + r / d
        return bool(quotient > best) if quotient.is_finite() else bool((d + r).lower() > best * d.upper())

    def _derivatives(self, omega: arb) -> tuple[tuple[arb, ...], tuple[arb, ...]]:
        """Return r and d with their first two derivatives by ω."""
        s, delay = acb(0, omega), fraction_ball(self.loop.T)
        P, N = ([at(part, s) for part in _with_derivatives(each)] for each in (self.loop.P, self.loop.N))
        lagging = (s * -delay).exp()
        M = [n * lagging for n in (N[0], N[1] - delay * N[0], N[2] - 2 * delay * N[1] + delay**2 * N[0])]
        return _real_product(M, [2 * p + m for p, m in zip(P, M, strict=True)]), _real_product(P, P)


def _with_derivatives(polynomial: fmpz_poly) -> tuple[fmpz_poly, fmpz_poly, fmpz_poly]:
    first = polynomial.derivative()
    return polynomial, first, first.derivative()


def _real_product(u: list[acb], v: list[acb]) -> tuple[arb, ...]:
    """Return Re u v̄ and its derivatives by ω from u, v and their derivatives by s at s = jω."""
    (a, b, c), (d, e, f) = ([w[0], w[1] * acb(0, 1), -w[2]] for w in (u, v))

    def inner(x: acb, y: acb) -> arb:
        return x.real * y.real + x.imag * y.imag

    return inner(a, d), inner(b, d) + inner(a, e), inner(c, d) + 2 * inner(b, e) + inner(a, f)


# What a page and JSON tell of a loop with a dead time.


@lru_cache(maxsize=16)
def loop_with(opened: Scalar, moved: Scalar, delay: Scalar) -> Distances:
    """Return the loop N/P e^{−sT} of polynomials of s with rational coefficients and a number T."""
    return Distances(DelayedLoop(opened, moved, delay.fraction()))


def interval_around_one(loop: DelayedLoop) -> tuple[Edge, Edge]:
    """Return the ends of the interval of gains k > 0 around 1 with a stable closed loop, which is stable for k = 1."""
    one = Fraction(1)
    for low, high, _ in loop.intervals("positive"):
        if _is_between(low, one, high):
            return low, high
    raise AssertionError(loop.P, loop.N)


def _is_between(low: Edge, value: Fraction, high: Edge) -> bool:
    bits = 2 * FIRST_BITS
    with Precision(bits):
        return bool(ball_of(low, bits) < fraction_ball(value)) and bool(fraction_ball(value) < ball_of(high, bits))


def digits_of(edge: Edge, digits: int = LOCUS_DIGITS) -> str:
    """Return an end of an interval of gains with so many digits after the point."""
    if isinstance(edge, Fraction):
        return rounded_to(edge, digits)
    return _certain(edge.k, digits)


def exact_value(edge: Edge) -> Scalar | str:
    """Return an end of an interval of gains where it has a closed form, else its first twelve digits after the point."""
    if isinstance(edge, Fraction):
        return Scalar.of(edge)
    closed = edge.closed_form()
    return closed[1] if closed is not None else digits_of(edge, LONG_DIGITS)


def landmarks_of(crossing: DelayedCrossing) -> dict[str, Scalar | str]:
    """Return frequency, gain and value of the loop at a crossing in the same way."""
    closed = crossing.closed_form()
    if closed is not None:
        return {"omega": closed[0], "k": closed[1], "value": -1 / closed[1]}
    parts = {"omega": crossing.omega, "k": crossing.k, "value": crossing.value}
    return {name: _certain(part, LONG_DIGITS) for name, part in parts.items()}


def _certain(value: Callable[[int], arb], digits: int) -> str:
    found = certain(value, digits)
    if found is None:
        raise TooLarge("the digits of a crossing")
    return found


@lru_cache(maxsize=64)
def told_of_dead_time(kind: str, opened: Scalar, moved: Scalar, delay: Scalar, sign: str) -> list[dict[str, str]]:
    """Return what a sentence of a kind tells of the loop, by rounded numbers; `sign` is that of the gain k."""
    distances = loop_with(opened, moved, delay)
    loop = distances.loop
    match kind:
        case "counts":
            before, after = unstable_before(loop), unstable_after(loop)
            around = {} if after is None else {"after": str(after), "around": str(before - after).replace("-", "−")}
            return [{"before": str(before), **around}]
        case "crossing":
            return [
                {"omega": _certain(c.omega, LOCUS_DIGITS), "k": digits_of(c)} for c in crossings_of_sign(loop, sign)
            ]
        case "axis":
            return [
                {"omega": _certain(c.omega, LOCUS_DIGITS), "value": _certain(c.value, LOCUS_DIGITS)}
                for c in crossings_of_sign(loop, "real")
            ]
        case "level":
            return [{"omega": _certain(_root_of(x), LOCUS_DIGITS)} for x in distances.crossovers]
        case "bound":
            return [{"bound": rounded_to(loop.decided[0], LOCUS_DIGITS)}]
        case "never":
            return [] if loop.intervals(sign) else [{}]
        case "unstable":
            return [] if unstable_after(loop) == 0 else [{}]
        case "delay":
            margin = distances.delay_margin(LOCUS_DIGITS)
            return [] if margin is None else [{} if margin == INFINITE else {"delay": margin}]
        case "ends":
            low, high = interval_around_one(loop)
            return [{"low": digits_of(low), "high": digits_of(high)}]
        case _:
            phase, modulus, peak = (
                distances.phase(MARGIN_DIGITS),
                distances.modulus(MARGIN_DIGITS),
                distances.peak(MARGIN_DIGITS),
            )
            if phase is None or modulus is None or peak is None:
                return []
            return [{"modulus": modulus, "peak": peak} | ({} if phase == INFINITE else {"phase": phase})]


def _root_of(x: RealNumber) -> Callable[[int], arb]:
    def root(bits: int) -> arb:
        with Precision(bits):
            return x.ball(bits).sqrt()

    return root


def crossings_of_sign(loop: DelayedLoop, sign: str) -> list[DelayedCrossing]:
    """Return the crossings below the gain at which everything is decided, of the gains that a sign allows."""
    allowed = {"positive": (1,), "nonnegative": (1,), "negative": (-1,), "nonpositive": (-1,)}.get(sign, (-1, 1))
    return [crossing for crossing in loop.decided[1] if crossing.side in allowed]


def unstable_before(loop: DelayedLoop) -> int:
    """Return how many roots of P have a positive real part."""
    return on_and_right(loop.P)[1] + on_and_right(loop.shared)[1]


def unstable_after(loop: DelayedLoop) -> int | None:
    """Return how many roots of P + N e^{−sT} have one, None where others are on the axis."""
    on, right = on_and_right(loop.shared)
    return None if on or loop.P[0] == -loop.N[0] else loop.unstable(Fraction(1)) + right


def pade_error(numerator: Scalar, denominator: Scalar, delay: Scalar, order: int) -> list[dict[str, str]]:
    """Return the largest ω with |N/P| = 1, and the error of the phase of the Padé approximation there, in degrees."""
    level = on_boundary(numerator, numerator, "s")[2] - on_boundary(denominator, denominator, "s")[2]
    found = [x for x in roots_of_scalar(level, "x") if x.sign > 0] if "x" in level.names else []
    if not found:
        return []
    root, T = _root_of(found[-1]), delay.fraction()

    def angle(bits: int) -> arb:
        with Precision(bits):
            x = root(bits) * fraction_ball(T)
            below = at(fmpz_poly(list(pade_coefficients(order))), acb(0, x))
            turned: arb = (acb(0, -x).exp() * below / below.conjugate()).arg()
            return turned * 180 / arb.pi()

    return [{"omega": _certain(root, LOCUS_DIGITS), "angle": _certain(angle, LOCUS_DIGITS)}]
