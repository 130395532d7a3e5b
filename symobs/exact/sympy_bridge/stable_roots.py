"""Location of the roots of a numeric polynomial relative to the stability boundary, by certified enclosures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import arb, fmpq, fmpz_poly

from symobs.exact.core.ring import Precision

if TYPE_CHECKING:
    from collections.abc import Sequence

    from flint import acb

    from symobs.exact.core.scalar import Scalar

_FIRST_BITS = 64


def stable_roots(factor: Scalar, variable: str, *, discrete: bool) -> tuple[bool, ...]:
    """Return, for each root of an irreducible polynomial, whether Re s < 0 (|z| < 1).

    The order is that of SymPy's `CRootOf`: the real roots ascending, then the others.  Where the others do not all lie on
    one side, SymPy's isolation tells which comes first.
    """
    polynomial = fmpz_poly([int(c.fraction()) for c in reversed(factor.numerator.coefficients(variable))])
    roots, sides = _decided(polynomial, discrete=discrete)
    real = sorted((k for k, root in enumerate(roots) if root.imag == 0), key=lambda k: float(roots[k].real.mid()))
    others = [k for k in range(len(roots)) if k not in real]
    if len({sides[k] for k in others}) > 1:
        others = _as_counted(factor, variable, roots, others)
    return tuple(sides[k] for k in (*real, *others))


def _decided(polynomial: fmpz_poly, *, discrete: bool) -> tuple[list[acb], list[bool]]:
    """Return enclosures of the roots and whether each is stable, increasing the precision until all are decided."""
    bits = _FIRST_BITS
    while True:
        with Precision(bits):
            found: Any = polynomial.complex_roots()
            roots = [root for root, _ in found]
            distances = [r.real * r.real + r.imag * r.imag - 1 if discrete else r.real for r in roots]
            if all(
                distance < 0 or distance > 0 or _is_on_boundary(k, roots, polynomial, discrete=discrete)
                for k, distance in enumerate(distances)
            ):
                return roots, [bool(distance < 0) for distance in distances]
        bits *= 2


def _is_on_boundary(number: int, roots: Sequence[acb], polynomial: fmpz_poly, *, discrete: bool) -> bool:
    """Return whether a root certainly lies on the boundary: its mirror image is a root and no other root is near."""
    coefficients = polynomial.coeffs()
    image = coefficients[::-1] if discrete else [-c if k % 2 else c for k, c in enumerate(coefficients)]
    if fmpz_poly(image) not in (polynomial, -polynomial):
        return False
    root = roots[number].conjugate()
    mirrored = 1 / root if discrete else -root
    return not any(mirrored.overlaps(other) for k, other in enumerate(roots) if k != number)


def _as_counted(factor: Scalar, variable: str, roots: Sequence[acb], numbers: Sequence[int]) -> list[int]:
    """Return the indices of the nonreal roots in SymPy's order, by their isolating rectangles."""
    from symobs.exact.sympy_bridge.conversion import rectangles  # noqa: PLC0415 - rarely needed

    found = []
    for scale, rectangle in rectangles(factor, variable, len(roots) - len(numbers)):
        inside, scaled = rectangle, [root / _number(scale) for root in roots]
        while len(near := [k for k in numbers if _meets(scaled[k], inside)]) != 1:
            inside = inside.refine()
        found += near
    return found


def _meets(root: acb, rectangle: Any) -> bool:
    """Return whether an enclosure intersects a rectangle."""
    ends = ((root.real, rectangle.ax, rectangle.bx), (root.imag, rectangle.ay, rectangle.by))
    return all(not (part < _number(low) or part > _number(high)) for part, low, high in ends)


def _number(value: Any) -> arb:
    return arb(fmpq(int(value.numerator), int(value.denominator)))
