"""Proofs that the matrix of a loop is stable although numbers in it were rounded, with the margin (trusted).

The characteristic polynomial is enclosed, and every inequality of Jury's test (Schur and Cohn) has to hold for the whole
enclosure; where one cannot be told, the enclosure is made narrower.  A matrix in continuous time is mapped by
(cI + M)(cI − M)⁻¹, which takes the open left half-plane to the open unit disc.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING

from flint import arb, arb_mat

from symobs.exact.core.precision import Precision
from symobs.exact.floating.sampled import Sampled, balls, held, joined

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from symobs.exact.linear_algebra.realisation import Realisation

    #: Encloses a matrix with so many bits.
    Enclosed = Callable[[int], arb_mat]

#: Bits of the enclosures that are tried in turn.
_BITS = (128, 256, 512, 1024, 2048, 4096)
#: A margin is looked for from this power of ten down, with three digits.
_LEAST_EXPONENT = -15


def loop_matrix(plant: Realisation, period: Fraction | None, controller: Realisation) -> Enclosed:
    """Return [Φ + ΓD_cC, ΓC_c; B_cC, A_c], the plant (without feedthrough) sampled and held, u = C_c ξ + D_c y."""

    def enclosed(bits: int) -> arb_mat:
        A, B, C, _ = Sampled(plant).enclosed(bits)
        with Precision(bits):
            own, driven, output, through = (balls(matrix) for matrix in controller)
            if period is not None:
                A, B = held(A, B, arb(period.numerator) / period.denominator)
            return joined([[A + B * through * C, B * output], [driven * C, own]])

    return enclosed


def own_matrix(controller: Realisation) -> Enclosed:
    """Return the matrix of a system that nothing is fed back to."""
    return lambda bits: Sampled(controller).enclosed(bits)[0]


def disc_margin(enclosed: Enclosed) -> Fraction | None:
    """Return some δ > 0 such that every eigenvalue has |z| < 1 − δ, proved; None where no δ is proved."""

    def is_within(margin: Fraction) -> bool:
        return _decided(lambda bits: _scaled(_polynomial(enclosed, bits), 1 - margin, bits))

    if not is_within(Fraction(0)):
        return None
    return _largest(is_within, Fraction(999, 1000))


def half_plane_margin(enclosed: Enclosed) -> Fraction | None:
    """Return some α > 0 such that every eigenvalue has Re s < −α, proved; None where no α is proved."""
    size = _size(enclosed)

    def is_left_of(margin: Fraction) -> bool:
        return _decided(lambda bits: _mapped(enclosed, margin, size, bits))

    if not is_left_of(Fraction(0)):
        return None
    return _largest(is_left_of, size)


def _decided(polynomial: Callable[[int], Sequence[arb]]) -> bool:
    """Return whether all roots are proved to lie in the open unit disc, with as many bits as it takes."""
    for bits in _BITS:
        with Precision(bits):
            found = _in_disc(polynomial(bits))
        if found is not None:
            return found
    return False


def _in_disc(coefficients: Sequence[arb]) -> bool | None:
    """Return whether all roots lie in the open unit disc, leading coefficient first; None if undecided."""
    rest = list(coefficients)
    while len(rest) > 1:
        if rest[0].contains(0):
            return None
        rest = [entry / rest[0] for entry in rest]
        last = rest[-1]
        if abs(last) >= 1:
            return False
        if not abs(last) < 1:
            return None
        rest = [rest[i] - last * rest[-1 - i] for i in range(len(rest) - 1)]
    return True


def _polynomial(enclosed: Enclosed, bits: int) -> list[arb]:
    """Return the characteristic polynomial, leading coefficient first."""
    matrix = enclosed(bits)
    with Precision(bits):
        return list(reversed(matrix.charpoly().coeffs()))


def _scaled(coefficients: Sequence[arb], radius: Fraction, bits: int) -> list[arb]:
    """Return p(ρz)/ρⁿ, whose roots are those of p divided by ρ."""
    with Precision(bits):
        factor = arb(radius.denominator) / radius.numerator
        return [entry * factor**power for power, entry in enumerate(coefficients)]


def _mapped(enclosed: Enclosed, margin: Fraction, size: Fraction, bits: int) -> list[arb]:
    """Return the characteristic polynomial of (cI + N)(cI − N)⁻¹ for N = M + αI; `size` is c."""
    matrix = enclosed(bits)
    with Precision(bits):
        order = matrix.nrows()
        shift, c = (arb(value.numerator) / value.denominator for value in (margin, size))
        one = arb_mat(order, order, [int(i == j) for i in range(order) for j in range(order)])
        moved = matrix + one * shift
        try:
            image = (one * c + moved) * (one * c - moved).inv()
        except ZeroDivisionError:  # c may be an eigenvalue, to the right of the axis
            return [arb(1), arb(2)]
        return list(reversed(image.charpoly().coeffs()))


def _size(enclosed: Enclosed) -> Fraction:
    """Return a number of the size of the largest row sum, at least 1."""
    with Precision(64):
        matrix = enclosed(64)
        largest = max((float(sum((abs(entry) for entry in row), arb(0)).mid()) for row in matrix.tolist()), default=1.0)
    return Fraction(max(1, round(largest)))


def _largest(is_proved: Callable[[Fraction], bool], bound: Fraction) -> Fraction:
    """Return the largest margin of three digits that is proved, at most `bound`; 0 is proved."""
    if is_proved(bound):
        return bound
    exponent = len(str(int(bound)))
    while exponent > _LEAST_EXPONENT and not (Fraction(10) ** exponent < bound and is_proved(Fraction(10) ** exponent)):
        exponent -= 1
    found, step = Fraction(0), Fraction(10) ** exponent
    for _ in range(3):
        while found + step < bound and is_proved(found + step):
            found += step
        step /= 10
    return found
