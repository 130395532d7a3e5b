"""Butterworth polynomials, with cosines of rational angles by square roots."""

from __future__ import annotations

from fractions import Fraction

from symobs.exact.algebraic.conjugates import root_in_field
from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.core.generators import NotWritten, square_root
from symobs.exact.core.scalar import Scalar


def twice_cosine(turns: Fraction) -> Scalar:
    """Return 2 cos(π turns) for 0 ≤ turns ≤ 1, by halving angles.

    An even denominator is halved down, 2 cos θ = √(2 + 2 cos 2θ); 1, 3 and 5 are known.  Raises `NotWritten` elsewhere.
    """
    if turns > Fraction(1, 2):
        return -twice_cosine(1 - turns)
    if turns == Fraction(1, 2):
        return Scalar.of(0)
    if turns.denominator % 2 == 0:
        square = twice_cosine(2 * turns) + 2
        root = root_in_field(square) if is_number(square) else None
        return square_root(square) if root is None else root
    if turns == 0:
        return Scalar.of(2)
    if turns.denominator == 3:
        return Scalar.of(1)
    if turns.denominator == 5:
        return (square_root(Scalar.of(5)) + (1 if turns.numerator == 1 else -1)) / 2
    message = f"cos({turns}*pi) is not written with square roots here"
    raise NotWritten(message)


def butterworth_angles(count: int) -> tuple[Fraction, ...]:
    """Return the angles of the complex pairs from the negative real axis, in half turns."""
    return tuple(Fraction(2 * k + 1 - count % 2, 2 * count) for k in range(count % 2, count // 2 + count % 2))


def butterworth(count: int, radius: Scalar, variable: str) -> tuple[Scalar, ...]:
    """Return the real factors of the p with p(s) p(−s) = ω^{2N} + (−1)^N s^{2N} whose roots lie in Re s < 0 for ω > 0."""
    s = Scalar.symbol(variable)
    pairs = [s**2 + twice_cosine(turns) * radius * s + radius**2 for turns in butterworth_angles(count)]
    return (*([s + radius] if count % 2 else []), *pairs)
