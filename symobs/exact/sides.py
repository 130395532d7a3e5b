"""On which side of the stability boundary each root of a polynomial without parameters lies, by certified enclosures."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from flint import fmpz_poly

if TYPE_CHECKING:
    from flint import acb

    from symobs.exact.scalar import Scalar


def stable_roots(factor: Scalar, variable: str, *, discrete: bool) -> tuple[bool, ...]:
    """Return for each root of an irreducible polynomial whether it lies in Re s < 0 (|z| < 1).

    The order is that of SymPy's `CRootOf`: the real roots ascending, then the others.  Where the others do not all lie on
    one side, or an enclosure reaches over the boundary, SymPy itself is asked.
    """
    ascending = [c.fraction() for c in reversed(factor.numerator.coefficients(variable))]
    enclosures: Any = fmpz_poly([int(c) for c in ascending]).complex_roots()
    roots = [root for root, _ in enclosures]
    real = sorted((root for root in roots if root.imag == 0), key=lambda root: float(root.real.mid()))
    others = {_side(root, discrete=discrete) for root in roots if root.imag != 0}
    sides = [_side(root, discrete=discrete) for root in real]
    if None in sides or None in others or len(others) > 1:
        from symobs.exact import sympy_border  # noqa: PLC0415 - rarely needed

        return sympy_border.stable_roots(factor, variable, discrete=discrete)
    count = len(roots) - len(real)
    return tuple(bool(side) for side in [*sides, *(side for side in others for _ in range(count))])


def _side(root: acb, *, discrete: bool) -> bool | None:
    """Return whether a root is stable, None where its enclosure reaches over the boundary."""
    distance = root.real * root.real + root.imag * root.imag - 1 if discrete else root.real
    if distance < 0:
        return True
    return False if distance > 0 else None
