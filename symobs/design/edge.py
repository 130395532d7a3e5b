"""A smallest gain where the Lagrangian is convex, but not strictly: one of a sphere of gains of the same size.

The multipliers are known, in the field of one root.  Along the kernel W of H all coefficients dₖ have multiples of one
quadratic part; what their differences say is linear, and what is left is the radius of a sphere.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.conditions import sign_of
from symobs.exact import EIGENVALUE, Extension, Matrix, Scalar
from symobs.exact.functions import square_root

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.exact.least_norm import Quadratic
    from symobs.exact.real import RealNumber


def at_edge(
    forms: Sequence[Quadratic], H: Matrix, root: RealNumber, multipliers: Sequence[Scalar]
) -> tuple[Scalar, ...] | None:
    """Return the entries of a smallest gain for multipliers that are polynomials in λ; None where there is none."""
    field = Extension(root.minimal_polynomial(EIGENVALUE), EIGENVALUE)
    force = sum(
        (q.slope * (m / 2) for q, m in zip(forms[1:], multipliers[1:], strict=True)),
        forms[0].slope * (multipliers[0] / 2),
    )
    rows = [[H, force]] + [[q.slope.T, Matrix.of([[q.constant]])] for q in forms if q.form.is_zero]
    found = _solutions(field, Matrix.block(rows))
    curved = [q for q in forms if not q.form.is_zero]
    for quadratic in curved:
        if found is None:
            return None
        start, ways = found
        found = _cut(field, (quadratic, _leading(field, curved, ways)), start, ways)
    if found is None:
        return None
    return _on_sphere(field, _leading(field, curved, found[1]), *found, root)


def _solutions(field: Extension, system: Matrix) -> tuple[Matrix, list[Matrix]] | None:
    """Return a solution of M x + r = 0 for a system [M r], and a basis of the kernel of M."""
    size = system.shape[1] - 1
    _, kernel = field.echelon(system)
    columns = [kernel.select(range(size + 1), [j]) for j in range(kernel.shape[1])]
    own = next((column for column in columns if not column[size, 0].is_zero), None)
    if own is None:
        return None
    start = field.reduced(own.select(range(size), [0]) * field.inverse(own[size, 0]))
    return start, [column.select(range(size), [0]) for column in columns if column[size, 0].is_zero]


def _leading(field: Extension, curved: Sequence[Quadratic], ways: Sequence[Matrix]) -> Quadratic | None:
    """Return the first polynomial that is curved along the ways, None where none is."""
    return next((q for q in curved if ways and not field.reduce((ways[0].T @ q.form @ ways[0])[0, 0]).is_zero), None)


def _cut(
    field: Extension, pair: tuple[Quadratic, Quadratic | None], start: Matrix, ways: list[Matrix]
) -> tuple[Matrix, list[Matrix]] | None:
    """Return the part of start + Σ tᵢ wᵢ on which a polynomial is a multiple of the leading one."""
    quadratic, leading = pair
    if not ways or quadratic is leading:
        return start, ways
    W = Matrix.block([ways])
    slope = W.T @ (quadratic.form @ start * 2 + quadratic.slope)
    height, bend = quadratic.at(start), W.T @ quadratic.form @ W
    if leading is not None:
        lead = W.T @ leading.form @ W
        ratio = field.reduce(bend[0, 0] * field.inverse(lead[0, 0]))
        slope = slope - W.T @ (leading.form @ start * 2 + leading.slope) * ratio
        height, bend = height - leading.at(start) * ratio, bend - lead * ratio
    if any(not field.reduce(entry).is_zero for entry in bend.entries):
        return None
    line = field.reduced(Matrix.block([[slope.T, Matrix.of([[height]])]]))
    if line.is_zero:
        return start, ways
    found = _solutions(field, line)
    if found is None:
        return None
    return field.reduced(start + W @ found[0]), [field.reduced(W @ way) for way in found[1]]


def _on_sphere(
    field: Extension, leading: Quadratic | None, start: Matrix, ways: list[Matrix], root: RealNumber
) -> tuple[Scalar, ...] | None:
    """Return the point of the sphere in the first direction in which the leading polynomial vanishes, from its centre."""
    at = {EIGENVALUE: root.scalar()}
    if leading is None:
        return start.substitute(at).entries
    W = Matrix.block([ways])
    half = W.T @ (leading.form @ start + leading.slope * Scalar.rational(1, 2))
    moved = _solutions(field, Matrix.block([[W.T @ leading.form @ W, half]]))
    if moved is None:
        return None
    centre = field.reduced(start + W @ moved[0])
    height = field.reduce(leading.at(centre))
    for way in ways:
        bend = field.reduce((way.T @ leading.form @ way)[0, 0])
        square = field.reduce(-height * field.inverse(bend)).substitute(at)
        if sign_of(square, {}) in {"positive", "zero"}:
            length = square_root(square) if square else square
            return (centre.substitute(at) + way.substitute(at) * length).entries
    return None
