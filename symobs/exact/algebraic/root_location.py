"""Location of the roots of a rational polynomial relative to the imaginary axis, by three methods."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache, reduce
from math import gcd, lcm
from typing import TYPE_CHECKING, Any

from flint import fmpq, fmpq_mpoly, fmpq_mpoly_ctx, fmpq_poly, fmpz, fmpz_mat, fmpz_poly

from symobs.exact.algebraic.real_algebraic import RealNumber, count_roots, real_roots
from symobs.exact.core.ring import Precision

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.exact.core.scalar import Scalar


def all_to_the_left(coefficients: Sequence[Fraction]) -> bool:
    """Return whether all roots have Re s < 0, by the fraction-free Routh array; a zero leading coefficient gives False."""
    whole = integers(coefficients)
    if not whole[0]:
        return False
    if whole[0] < 0:
        whole = [-c for c in whole]
    above, below = whole[0::2], whole[1::2]
    while below:
        if below[0] <= 0:
            return False
        lead, first = above[0], below[0]
        others = [*below[1:], *([0] * (len(above) - len(below)))]
        row = [first * a - lead * b for a, b in zip(above[1:], others, strict=True)]
        common = reduce(gcd, row, 0) or 1
        above, below = below, [entry // common for entry in row]
    return True


def has_positive_minors(coefficients: Sequence[Fraction]) -> bool:
    """Return whether all roots have Re s < 0, by Hurwitz: Δ₁, …, Δₙ of (a₂ⱼ₋ᵢ) are positive for a₀ > 0."""
    whole = integers(coefficients)
    if not whole[0]:
        return False
    order, sign = len(whole) - 1, 1 if whole[0] > 0 else -1
    padded = [0] * order + [sign * c for c in whole] + [0] * order
    return all(
        fmpz_mat([[padded[order + 2 * j - i] for j in range(1, k + 1)] for i in range(1, k + 1)]).det() > 0
        for k in range(1, order + 1)
    )


def count_roots_by_half_plane(coefficients: Sequence[Fraction]) -> tuple[int, int, int]:
    """Return the numbers of roots to the left of, on, and to the right of the imaginary axis, by isolation.

    Those on the axis, and pairs r, −r, are roots of the greatest common divisor of p(s) and p(−s), which is sᵏ q(s²):
    they lie on the axis where s² is real and not positive.
    """
    whole = fmpz_poly(list(reversed(integers(coefficients))))
    mirrored = fmpz_poly([c if k % 2 == 0 else -c for k, c in enumerate(whole.coeffs())])
    symmetric = whole.gcd(mirrored)
    left, right = _split(whole // symmetric)
    ascending = symmetric.coeffs()
    zeros = next(k for k, c in enumerate(ascending) if c != 0)
    squares = fmpz_poly(ascending[zeros::2])
    negative = sum(
        power * sum(root < RealNumber.of(0) for root in real_roots(factor)) for factor, power in squares.factor()[1]
    )
    pairs = int(squares.degree()) - negative
    return left + pairs, zeros + 2 * negative, right + pairs


def _split(polynomial: fmpz_poly) -> tuple[int, int]:
    """Return how many roots lie to the left and to the right, none being on the axis."""
    bits = 64
    while True:
        roots = _roots(polynomial, bits)
        if not any(root.real.contains(0) for root, _ in roots):
            left = sum(m for root, m in roots if root.real < 0)
            return left, int(polynomial.degree()) - left
        bits *= 2


def _roots(polynomial: fmpz_poly, bits: int) -> list[Any]:
    if polynomial.degree() < 1:
        return []
    with Precision(bits):
        return list(polynomial.complex_roots())


def integers(coefficients: Sequence[Fraction]) -> list[int]:
    """Return rational coefficients scaled to integers by a positive factor."""
    below = lcm(*(c.denominator for c in coefficients))
    return [int(c * below) for c in coefficients]


def root_boxes(coefficients: Sequence[Fraction], places: int) -> list[tuple[tuple[Fraction, ...], int]]:
    """Return (least real, largest real, least imaginary, largest imaginary part) of each root, and its multiplicity.

    The bounds are decimals of `places` places, rounded outwards.
    """
    below, found = 10**places, []
    for root, multiplicity in _roots(fmpz_poly(list(reversed(integers(coefficients)))), 64 + 4 * places):
        box = []
        for part in (root.real, root.imag):
            scaled: Any = part * below
            low, high = scaled.lower().floor(), scaled.upper().ceil()
            box += [Fraction(int(low.unique_fmpz()), below), Fraction(int(high.unique_fmpz()), below)]
        found.append((tuple(box), multiplicity))
    return found


def complex_roots(coefficients: Sequence[Fraction]) -> list[tuple[Fraction, Fraction]]:
    """Return rational approximations (real, imaginary) of all roots, with multiplicity."""
    found = []
    for root, multiplicity in _roots(fmpz_poly(list(reversed(integers(coefficients)))), 64):
        place = tuple(Fraction(round(float(part.mid()) * (1 << 40)), 1 << 40) for part in (root.real, root.imag))
        found += [(place[0], place[1])] * multiplicity
    return found


# Values of polynomials at rational points, computed by FLINT for plots and regions.


_ONE, _ZERO = Fraction(1), fmpq(0)


def value_at(polynomial: Scalar, point: Mapping[str, Fraction]) -> Fraction:
    """Return the value of a polynomial at a rational point; raises KeyError where the point lacks one of its names."""
    return _fraction(_value_at(polynomial, point))


def sign_at(polynomial: Scalar, point: Mapping[str, Fraction]) -> int:
    """Return the sign of a polynomial at a rational point: 1, 0 or −1."""
    value = _value_at(polynomial, point)
    return (value > 0) - (value < 0)


def _value_at(polynomial: Scalar, point: Mapping[str, Fraction]) -> fmpq:
    names, ready = _prepared(polynomial)
    return ready(*[_ratio(point[name]) if name else _ZERO for name in names])


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
