"""Numbers of roots in the right half-plane and on the imaginary axis, by the Cauchy index.

Nothing of Routh's table is used.  An irreducible factor f shares a root with f(−s) only where both are equal up to
sign.  Its roots are then symmetric to the axis, and those on it are the real roots of f(iω).  Any other factor has none
there, and its roots are told apart by how often f(iω) turns about 0: by the Cauchy index of the quotient of its
imaginary and its real part.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact import Scalar, from_coefficients

if TYPE_CHECKING:
    from collections.abc import Sequence

#: The coefficients of a polynomial, highest power first; none for zero.
Coefficients: TypeAlias = "list[Fraction]"
_VARIABLE = "s"


def right_half_plane_roots(coefficients: Sequence[Scalar]) -> int:
    """Return the number of roots with Re s > 0, with multiplicity, of rational coefficients, highest power first."""
    return _counted(coefficients)[0]


def imaginary_axis_roots(coefficients: Sequence[Scalar]) -> int:
    """Return the number of roots with Re s = 0, with multiplicity, of rational coefficients, highest power first."""
    return _counted(coefficients)[1]


def _counted(coefficients: Sequence[Scalar]) -> tuple[int, int]:
    if not coefficients or coefficients[0].is_zero or not all(c.is_constant for c in coefficients):
        raise ValueError("roots are counted of polynomials with rational coefficients, the first of them not zero")
    right = on_axis = 0
    for factor, power in from_coefficients(coefficients, _VARIABLE).numerator.factors()[1]:
        found = _of_irreducible([c.fraction() for c in factor.coefficients(_VARIABLE)])
        right, on_axis = right + power * found[0], on_axis + power * found[1]
    return right, on_axis


def _of_irreducible(f: Coefficients) -> tuple[int, int]:
    """Return the numbers of roots of an irreducible polynomial on the right, and on the axis."""
    order = len(f) - 1
    if not any(f[1::2]) or f == [1, 0]:  # symmetric to the origin; the factor s is
        on_axis = _real_roots(_turned(f[0::2])) if order > 1 else 1
        return (order - on_axis) // 2, on_axis
    leading, other = _on_axis(f)
    turns = _index(other, leading)  # of left roots minus right roots, each half a turn
    return (order - turns) // 2, 0


def _turned(even: Coefficients) -> Coefficients:
    """Return h(−ω²) of h given by its coefficients: f(iω) where f(s) = h(s²)."""
    degree = len(even) - 1
    signed = [(-1) ** (degree - k) * c for k, c in enumerate(even)]
    return [entry for c in signed for entry in (c, Fraction(0))][:-1]


def _on_axis(f: Coefficients) -> tuple[Coefficients, Coefficients]:
    """Return the part of f(iω)/iⁿ of degree n in ω, and the other part, signed so that left roots count.

    f(iω)/iⁿ is Σ aₖ (−i)ᵏ ωⁿ⁻ᵏ: real part a₀ωⁿ − a₂ωⁿ⁻² + …, imaginary part −a₁ωⁿ⁻¹ + a₃ωⁿ⁻³ − ….
    """
    zero = Fraction(0)
    real = [(-1) ** (k // 2) * c if k % 2 == 0 else zero for k, c in enumerate(f)]
    imaginary = [(-1) ** (k // 2) * c if k % 2 else zero for k, c in enumerate(f)]
    return real, _stripped(imaginary)


def _real_roots(f: Coefficients) -> int:
    """Return the number of real roots of a square-free polynomial: the Cauchy index of f′/f."""
    order = len(f) - 1
    return _index([(order - k) * c for k, c in enumerate(f[:-1])], f)


def _index(above: Coefficients, below: Coefficients) -> int:
    """Return the Cauchy index of above/below over the real line, by Sturm's chain."""
    chain = [below, above]
    while rest := _remainder(chain[-2], chain[-1]):
        chain.append([-c for c in rest])
    at_plus = [f[0] > 0 for f in chain]
    at_minus = [(f[0] > 0) == (len(f) % 2 == 1) for f in chain]
    return sum(a != b for a, b in pairwise(at_minus)) - sum(a != b for a, b in pairwise(at_plus))


def _remainder(f: Coefficients, by: Coefficients) -> Coefficients:
    """Return a positive multiple of the remainder of a division."""
    left = list(f)
    while len(left) >= len(by):
        lead = left[0] / by[0]
        left = [c - lead * d for c, d in zip(left, [*by, *([Fraction(0)] * (len(left) - len(by)))], strict=True)][1:]
    rest = _stripped(left)
    return [c / abs(rest[0]) for c in rest] if rest else rest


def _stripped(f: Coefficients) -> Coefficients:
    """Return the coefficients from the first nonzero one on."""
    start = next((k for k, c in enumerate(f) if c), len(f))
    return f[start:]
