"""Bound on the deviation of a double-precision program from the exact difference equation (trusted).

x⁺ = Φx + Γw exactly, x̃⁺ = fl(Φ̃x̃ + Γ̃w) with doubles Φ̃, Γ̃.  Each product of n + m terms, in any order, with or without
fused operations, has an error of at most γ(|Φ̃||x̃| + |Γ̃||w|), γ = Nu/(1 − Nu), u = 2⁻⁵³ (Higham, Accuracy and Stability of
Numerical Algorithms, section 3.1).  With S = Σ‖Φʲ‖ the difference is at most S times what is added in one step.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from flint import arb

from symobs.exact.core.precision import Precision
from symobs.exact.floating.sampled import balls

if TYPE_CHECKING:
    from flint import arb_mat

    from symobs.exact.floating.sampled import Sampled
    from symobs.exact.linear_algebra.realisation import Realisation

#: Steps for which the bound is found at least.
STEPS = 1000
#: Bits that are tried in turn: products of enclosures grow by the absolute values of the entries.
_BITS = (256, 1024, 4096)
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
    powers = next((found for bits in _BITS if (found := _sum_of_powers(exact, bits)) is not None), None)
    if powers is None:
        return None
    total, always = powers
    system = exact.enclosed(_BITS[0])
    with Precision(_BITS[0]):
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
