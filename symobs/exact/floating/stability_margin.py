"""Proofs that the matrix of a loop is stable although numbers in it were rounded (trusted).

The characteristic polynomial is enclosed, and every inequality of Jury's test (Schur and Cohn) has to hold for the whole
enclosure; where one cannot be told, the enclosure is made narrower.  A matrix in continuous time is mapped by
(cI + M)(cI − M)⁻¹, which takes the open left half-plane to the open unit disc.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from flint import arb, arb_mat

from symobs.exact.core.ring import Precision
from symobs.exact.floating.sampled import Sampled, balls, held, joined

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from fractions import Fraction

    from symobs.exact.linear_algebra.transfer_function import Realisation

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


# Bound on the deviation of a double-precision program from the exact difference equation (trusted).
#
# x⁺ = Φx + Γw exactly, x̃⁺ = fl(Φ̃x̃ + Γ̃w) with doubles Φ̃, Γ̃. Each product of n + m terms, in any order, with or
# without fused operations, has an error of at most γ(|Φ̃||x̃| + |Γ̃||w|), γ = Nu/(1 − Nu), u = 2⁻⁵³ (Higham, Accuracy
# and Stability of Numerical Algorithms, section 3.1). With S = Σ‖Φʲ‖ the difference is at most S times what is added in
# one step.


#: Steps for which the bound is found at least.
STEPS = 1000
#: Bits that are tried in turn: products of enclosures grow by the absolute values of the entries.
_BITS_OF_POWERS = (256, 1024, 4096)
#: An enclosure of which this power of two is uncertain is too wide.
_UNCERTAIN = -20
_SQUARINGS = 20
_HALF = 0.5
#: Rounding to nearest, and what is lost where a product underflows.
_UNIT, _UNDERFLOW = -53, -1074


class Deviation(NamedTuple):
    """Bounds for inputs of modulus at most 1 from the state 0: of the output, of the state; at every step, or up to STEPS."""

    output: float
    state: float
    always: bool


def deviation(exact: Sampled, rounded: Realisation) -> Deviation | None:
    """Return bounds of the deviation, None where there are none in double precision."""
    powers = next((found for bits in _BITS_OF_POWERS if (found := _sum_of_powers(exact, bits)) is not None), None)
    if powers is None:
        return None
    total, always = powers
    system = exact.enclosed(_BITS_OF_POWERS[0])
    with Precision(_BITS_OF_POWERS[0]):
        _, Gamma, C, _ = system
        own = [balls(matrix) for matrix in rounded]
        terms = own[0].ncols() + own[1].ncols() + 2
        unit = arb(2) ** _UNIT * terms
        gamma, lost = unit / (1 - unit), arb(2) ** _UNDERFLOW * terms
        off = [_norm(a - b) + gamma * _norm(b) for a, b in zip(system, own, strict=True)]
        reached = total * _norm(Gamma)
        size = 2 * reached + 1
        state = total * (off[0] * size + off[1] + lost)
        if not state <= size - reached:
            return None
        output = _norm(C) * state + off[2] * size + off[3] + lost
        bounds = [_above(bound) for bound in (output, state)]
        return None if float("inf") in bounds else Deviation(bounds[0], bounds[1], always)


def _sum_of_powers(exact: Sampled, bits: int) -> tuple[arb, bool] | None:
    """Return a bound of Σ ‖Φʲ‖, and whether it is that of all j and not only of j < STEPS; None where bits do not suffice.

    Where ‖Φᵖ‖ < 1/2 the sum over all j is at most that over j < p, divided by 1 − ‖Φᵖ‖; (I + P)(I + P²)(I + P⁴) … sums the
    powers of P = Φ^STEPS.
    """
    matrix = exact.enclosed(bits)[0]
    order = matrix.nrows()
    with Precision(bits):
        power = type(matrix)(order, order, [int(i == j) for i in range(order) for j in range(order)])
        total = arb(0)
        for _ in range(STEPS):
            size = _norm(power)
            if size < _HALF:
                return total / (1 - size), True
            total, power = total + size, matrix * power
        if any(entry.rad() > _norm(power) * arb(2) ** _UNCERTAIN for entry in power.entries()):
            return None
        whole = total
        for _ in range(_SQUARINGS):
            size = _norm(power)
            if size < _HALF:
                return whole / (1 - size), True
            whole, power = whole * (1 + size), power * power
        return total, False


def _norm(matrix: arb_mat) -> arb:
    """Return a number that the largest row sum of absolute values does not exceed."""
    sums = [sum((arb(entry.abs_upper()) for entry in row), arb(0)) for row in matrix.tolist()]
    largest = arb(0)
    for found in sums:
        largest = largest.max(found)
    return arb(largest.abs_upper())


def _above(bound: arb) -> float:
    """Return a double, of two digits, that is not below a bound."""
    if not bound.is_finite():
        return float("inf")
    try:
        middle = float(bound.abs_upper())
    except OverflowError:
        return float("inf")
    return float(f"{middle * 1.06:.1e}")
