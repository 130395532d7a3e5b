"""Proofs that the matrix of a loop is stable although numbers in it were rounded (trusted).

The characteristic polynomial is enclosed, and every inequality of Jury's test (Schur and Cohn) has to hold for the whole
enclosure; where one cannot be told, the enclosure is made narrower.  A matrix in continuous time is mapped by
(cI + M)(cI − M)⁻¹, which takes the open left half-plane to the open unit disc.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from flint import arb, arb_mat

from symobs.exact.core.precision import Precision
from symobs.exact.floating.sampled import Sampled, balls, held, joined

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from fractions import Fraction

    from symobs.exact.linear_algebra.realisation import Realisation

    #: Encloses a matrix with so many bits.
    Enclosed = Callable[[int], arb_mat]

#: Bits of the enclosures that are tried in turn.
_BITS = (128, 256, 512, 1024, 2048, 4096)


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


def is_in_disc(enclosed: Enclosed, margin: Fraction) -> bool:
    """Return whether every eigenvalue is proved to have |z| < 1 − margin."""
    return _decided(lambda bits: _scaled(_polynomial(enclosed, bits), 1 - margin, bits))


def is_left_of(enclosed: Enclosed, margin: Fraction, size: Fraction) -> bool:
    """Return whether every eigenvalue is proved to have Re s < −margin; `size` is any c > 0, best that of the matrix."""
    return _decided(lambda bits: _mapped(enclosed, margin, size, bits))


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
