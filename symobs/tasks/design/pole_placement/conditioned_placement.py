"""The placement whose eigenvectors are best conditioned, in floating point: where a search for a gain begins.

An eigenvector of A − B K for the pole λ lies in S(λ) = {x : (A − λI) x in im B}, and any independent choice of one for each
pole, conjugates for conjugate poles, belongs to one gain K.  One vector after the other is replaced by that of its S(λ) for
which |det X| is greatest, X the matrix of all of them with length one, until that grows no more.  Source: J. Kautsky,
N. K. Nichols, P. Van Dooren, Int. J. Control 41 (1985), 1129-1155; A. L. Tits, Y. Yang, IEEE Trans. Automatic Control 41
(1996), 1432-1452.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

from symobs.ground.later import Later

if TYPE_CHECKING:
    from collections.abc import Sequence

    import numpy as np
    from numpy.typing import NDArray

    Reals: TypeAlias = NDArray[np.floating[Any]]
    #: Real for a real pole.
    Vectors: TypeAlias = NDArray[np.inexact[Any]]
else:
    np = Later("numpy")

#: From so many bases the vectors are improved, each so often at most: |det X| may have several maxima.
STARTS, SWEEPS = 6, 60
#: A smaller growth of |det X| ends the improvement.
GROWTH = 1e-3
#: Of placements whose eigenvectors are conditioned as well as the best but for this factor the smallest gain is taken.
ALIKE = 1.1
#: An input that adds less to the rank of B counts as none, and less independent eigenvectors are given up.
NEGLIGIBLE = 1e-12
#: Vectors that a matrix moves farther from their multiples, beside its norm, are no eigenvectors.
DEFECT = 1e-7


class Placement(NamedTuple):
    """A gain K, the condition ‖X‖ ‖X⁻¹‖ of the eigenvectors of A − B K, these as columns, and the poles they are for."""

    gain: Reals
    condition: float
    vectors: Vectors
    poles: Sequence[complex]

    @property
    def largest(self) -> float:
        """The largest absolute value of an entry of K."""
        return float(np.abs(self.gain).max())


def best_conditioned(A: Reals, B: Reals, poles: Sequence[complex]) -> Placement | None:
    """Return the placement found; None where a pole is wanted more often than B has rank, and no eigenvectors suffice.

    Of conjugate poles only the one above the real axis is used.
    """
    order, upper = A.shape[0], [pole for pole in poles if pole.imag >= 0]
    Q, sizes, _ = np.linalg.svd(B)
    count = int((sizes > NEGLIGIBLE * sizes[0]).sum())
    if any(poles.count(pole) > count for pole in upper):
        return None
    outside = Q[:, count:].T
    spaces = [_kernel(outside @ (A - (pole if pole.imag else pole.real) * np.eye(order)), count) for pole in upper]
    found = (_improved(_start(spaces, number), spaces) for number in range(STARTS))
    placements = [_placement(A, B, upper, X) for X in found if X is not None]
    best = min((placement.condition for placement in placements), default=0.0)
    alike = (placement for placement in placements if placement.condition <= ALIKE * best)
    return min(alike, key=lambda placement: placement.largest, default=None)


def condition_of(closed: Reals, poles: Sequence[complex]) -> float:
    """Return the condition of the eigenvectors of a matrix, each of length one; to a repeated pole belong orthogonal ones."""
    if len(set(poles)) == len(poles):
        return float(np.linalg.cond(np.linalg.eig(closed)[1]))
    eye = np.eye(len(closed))
    found = [_kernel(closed - pole * eye, poles.count(pole)) for pole in dict.fromkeys(poles)]
    X = np.column_stack(found)
    moved = np.column_stack([space * pole for space, pole in zip(found, dict.fromkeys(poles), strict=True)])
    is_basis = np.linalg.norm(closed @ X - moved) <= DEFECT * (1 + np.linalg.norm(closed))
    return float(np.linalg.cond(X)) if is_basis else float("inf")


def _kernel(M: Vectors, dimension: int) -> Vectors:
    """Return an orthonormal basis of the kernel of a matrix as columns."""
    rows: Vectors = np.linalg.svd(M)[2] if M.shape[0] else np.eye(M.shape[1], dtype=M.dtype)
    return rows[rows.shape[0] - dimension :].conj().T


def _start(spaces: Sequence[Vectors], number: int) -> list[Vectors]:
    """Return a vector of each space; for each number other ones, the same at every run."""
    chance = np.random.default_rng(number)
    found = []
    for space in spaces:
        weights = chance.normal(size=(2, space.shape[1]))
        found.append(_of_length_one(space @ (weights[0] + 1j * weights[1] if np.iscomplexobj(space) else weights[0])))
    return found


def _of_length_one(x: Vectors) -> Vectors:
    """Return a multiple of length one; of a complex vector that with orthogonal real and imaginary part."""
    return x / np.linalg.norm(x) * (np.exp(-0.5j * np.angle(x @ x)) if np.iscomplexobj(x) else 1)


def _columns(vectors: Sequence[Vectors]) -> Reals:
    """Return the matrix of real vectors, and of the real and imaginary parts of complex ones."""
    return np.column_stack([part for x in vectors for part in ((x.real, x.imag) if np.iscomplexobj(x) else (x,))])


def _improved(vectors: list[Vectors], spaces: Sequence[Vectors]) -> list[Vectors] | None:
    """Replace one vector after the other, as long as |det X| grows; None where they do not become independent."""
    last = 0.0
    for _ in range(SWEEPS):
        for k, space in enumerate(spaces):
            others = [x for i, x in enumerate(vectors) if i != k]
            free = np.linalg.qr(_columns(others), mode="complete")[0] if others else np.eye(space.shape[0])
            normals = free[:, space.shape[0] - (2 if np.iscomplexobj(space) else 1) :]
            vectors[k] = _farthest(space, normals)
        reached = abs(float(np.linalg.det(_columns(vectors))))
        if reached <= last * (1 + GROWTH):
            break
        last = reached
    return vectors if last > NEGLIGIBLE else None


def _farthest(space: Vectors, normals: Reals) -> Vectors:
    """Return the vector of a space that spans the largest volume with those to which the normals are orthogonal.

    For a complex x that is |Re(p·x) Im(q·x) − Im(p·x) Re(q·x)| with the normals p and q, a Hermitian form.
    """
    along = normals.T @ space
    if not np.iscomplexobj(space):
        length = np.linalg.norm(along[0])
        return space @ (along[0] / length) if length else space[:, 0]
    form = (np.outer(along[0].conj(), along[1]) - np.outer(along[1].conj(), along[0])) / 2j
    values, weights = np.linalg.eigh(form)
    return _of_length_one(space @ weights[:, int(np.argmax(np.abs(values)))])


def _placement(
    A: Reals,
    B: Reals,
    poles: Sequence[complex],
    vectors: Sequence[Vectors],
) -> Placement:
    """Return the gain with B K = A − X J X⁻¹."""
    X, moved = _columns(vectors), _columns([x * pole for x, pole in zip(vectors, _as_kinds(poles), strict=True)])
    gain = np.linalg.lstsq(B, A - moved @ np.linalg.inv(X), rcond=None)[0]
    every = np.column_stack([y for x in vectors for y in ((x, x.conj()) if np.iscomplexobj(x) else (x,))])
    placed = [y for pole in poles for y in ((pole, pole.conjugate()) if pole.imag else (pole,))]
    return Placement(gain, float(np.linalg.cond(every)), every, placed)


def _as_kinds(poles: Sequence[complex]) -> list[complex]:
    """Return real poles as real numbers."""
    return [pole if pole.imag else pole.real for pole in poles]
