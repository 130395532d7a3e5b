"""Values of polynomials at rational points, computed by FLINT for plots and regions."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from typing import TYPE_CHECKING

from flint import fmpq, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly, fmpz

from symobs.exact.algebraic.real_algebraic import count_roots

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from flint import fmpz_poly

    from symobs.exact.core.scalar import Scalar

_ONE, _ZERO = Fraction(1), fmpq(0)


def value_at(polynomial: Scalar, point: Mapping[str, Fraction]) -> Fraction:
    """Return the value of a polynomial at a rational point; raises KeyError where the point lacks one of its names."""
    names, ready = _prepared(polynomial)
    return _fraction(ready(*[_ratio(point[name]) if name else _ZERO for name in names]))


@lru_cache(maxsize=4096)
def _prepared(polynomial: Scalar) -> tuple[tuple[str, ...], fmpq_mpoly]:
    """Return the generators, "" for those that do not occur, and the polynomial with rational coefficients."""
    field, occurring = polynomial.field, polynomial.names
    letters = tuple(f"x{index}" for index in range(len(field.names)))  # the library keeps what it is asked for
    context = fmpq_mpoly_ctx.get(letters, field.context.ordering())
    below = fmpq(1, int(polynomial.denominator.fraction()))
    ready = context.from_dict({powers: below * c for powers, c in polynomial.numerator_part.terms()})
    return tuple(name if name in occurring else "" for name in field.names), ready


def vanishes_near(polynomial: fmpz_poly, middle: Fraction, off: Fraction) -> bool:
    """Return whether a polynomial has a root within distance `off` of a number.

    With p(middle + off t) = Σ cₖ tᵏ there is none where |c₀| > |c₁| + |c₂| + …, one where the ends differ in sign, and
    else Sturm's theorem tells.
    """
    around = fmpq_poly(polynomial)(fmpq_poly([_ratio(middle), _ratio(off)])).numer()
    constant, *others = around.coeffs() or [fmpz(0)]
    if abs(constant) > sum(map(abs, others)):
        return False
    return bool(around(1) * around(-1) <= 0) or count_roots(around, -_ONE, _ONE) > 0


def shifted(coefficients: Sequence[Fraction], place: tuple[Fraction, Fraction]) -> list[tuple[Fraction, Fraction]]:
    """Return c₀, …, cₙ of p(z + w) = Σ cₖ wᵏ at a complex z, as pairs of parts; those of p are given highest first."""
    x, y = map(_ratio, place)
    left = [(_ratio(c), _ZERO) for c in coefficients]
    found = []
    while left:  # divide by w = s − z again and again; what remains are the coefficients
        for k in range(1, len(left)):
            (a, b), (c, d) = left[k - 1], left[k]
            left[k] = c + a * x - b * y, d + a * y + b * x
        real, imaginary = left.pop()
        found.append((_fraction(real), _fraction(imaginary)))
    return found


def _ratio(value: Fraction) -> fmpq:
    return fmpq(value.numerator, value.denominator)


def _fraction(value: fmpq) -> Fraction:
    return Fraction(int(value.p), int(value.q))
