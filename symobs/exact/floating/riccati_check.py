"""Proof that digits are those of the stabilising solution of Riccati's equation, and of its gain (trusted).

F(X + D) = F(X) + L(D) − q(D) with a linear L and a quadratic q: where D ↦ L⁻¹(q(D) − F(X)) maps a box of symmetric D to
itself, one of them is a fixed point (Brouwer), and X + D a solution.  Where A − BK is stable for every P in the box, it is
the stabilising one, of which there is only one.
"""

from __future__ import annotations

from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, TypeAlias

from flint import arb, arb_mat

from symobs.exact.algebraic.enclosure import _ball
from symobs.exact.core.matrix import Matrix
from symobs.exact.core.ring import Precision
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Sequence

#: The entries of a matrix: a number, and how far the entry is from it at most.
Rounded: TypeAlias = "Sequence[Sequence[tuple[Fraction, Fraction]]]"


@dataclass
class Regulator:
    """ẋ = Ax + Bu (x_{k+1} in discrete time) with the cost ∫ (Σ) xᵀQx + 2xᵀNu + uᵀRu."""

    A: Matrix
    B: Matrix
    Q: Matrix
    R: Matrix
    N: Matrix
    discrete: bool

    @cached_property
    def uncrossed(self) -> tuple[Matrix, Matrix, Matrix]:
        """A − BR⁻¹Nᵀ, BR⁻¹Bᵀ and Q − NR⁻¹Nᵀ: the same problem in u + R⁻¹Nᵀx, which has no cross weight."""
        A, B, Q, N, inverse = self.A, self.B, self.Q, self.N, self.R.inverse()
        parts = A - B @ inverse @ N.T, B @ inverse @ B.T, Q - N @ inverse @ N.T
        return (parts[0].normal(), parts[1].normal(), parts[2].normal())


def is_proved(regulator: Regulator, centre: Matrix, radius: Fraction, P: Rounded, K: Rounded, bits: int = 256) -> bool:
    """Return whether P and the gain of the stabilising solution are as told; it is looked for near a rational matrix."""
    with Precision(bits):
        try:
            found = solution_near(regulator, balls(centre), number(radius)) if centre == centre.T else None
            return found is not None and _agree(P, found) and _agree(K, gain(regulator, found))
        except ZeroDivisionError:  # what is inverted may be singular
            return False


def _agree(told: Rounded, value: arb_mat) -> bool:
    if [len(row) for row in told] != [value.ncols()] * value.nrows():
        return False
    pairs = [(value[i, j], *each) for i, row in enumerate(told) for j, each in enumerate(row)]
    return all(abs(exact - number(near)) <= number(off) for exact, near, off in pairs)


def number(value: Fraction) -> arb:
    """Return an enclosure of a rational number."""
    return arb(value.numerator) / value.denominator


def balls(matrix: Matrix) -> arb_mat:
    """Return enclosures of the entries."""
    return arb_mat([[_ball(entry) for entry in row] for row in matrix.rows])


def solution_near(regulator: Regulator, X: arb_mat, radius: arb) -> arb_mat | None:
    """Return an enclosure of the stabilising solution, less than the radius away from the symmetric X."""
    order = X.nrows()
    box = arb_mat([[arb(0, radius)] * order] * order)
    step = correction(regulator, X, box)
    if not all(box[i, j].contains_interior(step[i, j]) for i in range(order) for j in range(order)):
        return None
    P = X + step
    loop = balls(regulator.A) - balls(regulator.B) * gain(regulator, P)
    return P if is_stable(loop, discrete=regulator.discrete) else None


def gain(regulator: Regulator, P: arb_mat) -> arb_mat:
    """Return R⁻¹(BᵀP + Nᵀ), in discrete time (R + BᵀPB)⁻¹(BᵀPA + Nᵀ)."""
    A, B, R, N = (balls(part) for part in (regulator.A, regulator.B, regulator.R, regulator.N))
    if regulator.discrete:
        return (R + B.transpose() * P * B).solve(B.transpose() * P * A + N.transpose())
    return R.solve(B.transpose() * P + N.transpose())


def excess(regulator: Regulator, P: Matrix, K: Matrix, unit: Fraction, bits: int = 256) -> Fraction | None:
    """Return the smallest power of ten found with x₀ᵀ(P_K − P*)x₀ ≤ it · x₀ᵀx₀, where P_K belongs to K and P* to the optimum.

    P and K are the optimum, rounded to multiples of the unit; E = K − K* has entries up to unit/2, and P_K − P* solves
    Lyapunov's equation of A − BK with EᵀRE, in discrete time Eᵀ(R + BᵀP*B)E.  None where A − BK is not seen to be stable.
    """
    with Precision(bits):
        B, half = balls(regulator.B), number(unit / 2)
        loop = balls(regulator.A) - B * balls(K)
        if not is_stable(loop, discrete=regulator.discrete):
            return None
        weight, error = balls(regulator.R), arb_mat([[arb(0, half)] * K.shape[1]] * K.shape[0])
        if regulator.discrete:
            weight += B.transpose() * (balls(P) + arb_mat([[arb(0, half)] * P.shape[1]] * P.shape[0])) * B
        found = _solved(loop, -(error.transpose() * weight * error), discrete=regulator.discrete)
        sums = [sum(abs(entry).upper() for entry in row) for row in found.tolist()]  # no eigenvalue is larger
        powers = (Fraction(10) ** -k for k in range(bits // 4, -9, -1))
        return next((bound for bound in powers if all(row <= number(bound) for row in sums)), None)


def correction(regulator: Regulator, X: arb_mat, D: arb_mat) -> arb_mat:
    """Return L⁻¹(q(D) − F(X))."""
    A, S, Q = (balls(part) for part in regulator.uncrossed)
    if not regulator.discrete:
        loop = A - S * X
        value = A.transpose() * X + X * A - X * S * X + Q
        return _solved(loop, D * S * D - value, discrete=False)
    one = balls(Matrix.identity(X.nrows()))
    inner = (one + S * X).inv()
    loop, T = inner * A, inner * S
    value = A.transpose() * X * loop - X + Q
    return _solved(loop, loop.transpose() * D * T * D * (one + T * D).inv() * loop - value, discrete=True)


def _solved(loop: arb_mat, right: arb_mat, *, discrete: bool) -> arb_mat:
    """Return the symmetric D with loopᵀ D + D loop = right, in discrete time loopᵀ D loop − D = right."""
    order = loop.nrows()
    places = [(i, j) for i in range(order) for j in range(i, order)]

    def coefficient(p: int, q: int, k: int, l: int) -> arb:
        moved = loop[k, p] * loop[l, q] if discrete else loop[k, p] * int(l == q) + loop[l, q] * int(k == p)
        return moved - int(discrete and (k, l) == (p, q))

    both = [[(coefficient(p, q, i, j), coefficient(p, q, j, i)) for i, j in places] for p, q in places]
    table = [[a + b if i != j else a for (a, b), (i, j) in zip(row, places, strict=True)] for row in both]
    entries = arb_mat(table).inv() * arb_mat([[right[place]] for place in places])
    at = [[places.index((min(i, j), max(i, j))) for j in range(order)] for i in range(order)]
    return arb_mat([[entries[k, 0] for k in row] for row in at])


def is_stable(matrix: arb_mat, *, discrete: bool) -> bool:
    """Return whether every matrix of an enclosure is stable, by Routh's table; M ↦ (M − I)(M + I)⁻¹ in discrete time."""
    one = balls(Matrix.identity(matrix.nrows()))
    coefficients = [*reversed(list(((matrix - one) * (matrix + one).inv() if discrete else matrix).charpoly()))]
    above, below = coefficients[0::2], coefficients[1::2]
    while below:
        if not (above[0] > 0 and below[0] > 0):
            return False
        factor, others = above[0] / below[0], [*below[1:], *([arb(0)] * (len(above) - len(below)))]
        above, below = below, [a - factor * b for a, b in zip(above[1:], others, strict=True)]
    return bool(above[0] > 0)
