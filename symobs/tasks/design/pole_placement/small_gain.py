"""A gain with small and short entries near the best conditioned placement, for several outputs and numbers alone.

All rows of Kᵀ = L that belong to one output are set to short numbers near those of the best conditioned placement, which
leaves the pair (A − L₀ C, c) of one output c: its gain l is unique, and L = L₀ + l eᵀ assigns φ exactly whatever the
numbers are.  Of many such gains the shortest is taken that is small enough.

For a pole that is wanted more often no such column is left: A − L C is to have several eigenvectors for it, and is not
cyclic.  There the free components of the eigenvectors are set to short numbers, and Lᵀ = f Ψ⁻¹ as by row reduction.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import islice
from math import floor, log10
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.exact import Matrix, Scalar, factored, reduced_echelon
from symobs.ground.later import Later
from symobs.tasks.design.pole_placement.brunovsky_chains import cost
from symobs.tasks.design.pole_placement.conditioned_placement import best_conditioned, condition_of
from symobs.tasks.design.pole_placement.row_reduction import block_of, null_matrix, null_vector
from symobs.tasks.design.pole_placement.single_output import ObserverPair

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    import numpy as np

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.conditioned_placement import Placement, Reals
    from symobs.tasks.design.pole_placement.multiple_outputs import MultiOutputPair
else:
    np = Later("numpy")

#: A gain is small where its largest entry is at most so many times that of the best conditioned placement.
SMALL = 1.5
#: Without being asked for, a small gain is taken where the largest entry of the simple one is more than so many times as large.
LARGE = 3
#: The eigenvectors of A − L C may be conditioned so many times worse than the best: of a gain that is searched for, and of a
#: simple one, or where no other is found.
NEAR, KEPT = 1.4, 4
#: For every step to which entries are rounded so many roundings are tried for each output, and so many of them exactly; then
#: the steps that have to serve, and all that are tried.
ROUNDINGS, EXACT, SERVING, STEPS = 100, 20, 3, 24
#: Where the condition of a matrix is greater its inverse in floating point says nothing.
SOLVABLE = 1e13
#: The golden ratio, whose multiples modulo 1 are spread evenly.
GOLDEN = (1 + 5**0.5) / 2


class Small(NamedTuple):
    """A small gain L; where it was found by eigenvectors these, Ψ, with f = LᵀΨ and J: (A − L C)ᵀ Ψ = Ψ J."""

    gain: Matrix
    vectors: tuple[Matrix, Matrix, Matrix] | None = None


class Target(NamedTuple):
    """The pair in floating point, φ, and the best conditioned placement of its poles."""

    A: Reals
    C: Reals
    phi: Reals
    poles: Sequence[complex]
    best: Placement

    @staticmethod
    def of(pair: MultiOutputPair, desired: DesiredPolynomial) -> Target | None:
        """Return what is aimed at; None where a pole is wanted more often than eigenvectors suffice for, or beyond floats."""
        try:
            A, C = in_floats(pair.A), in_floats(pair.c)
            poles = poles_of(desired)
            best = best_conditioned(A.T, C.T, poles)
        except (OverflowError, np.linalg.LinAlgError):
            return None
        if best is None or not np.isfinite(best.gain).all() or not best.largest:
            return None
        return Target(A, C, np.poly(poles).real, poles, best)

    def admits(self, L: Reals, condition: float) -> bool:
        """Return whether a gain is small and its eigenvectors are at most so many times worse conditioned than the best."""
        if not np.isfinite(L).all() or np.abs(L).max() > SMALL * self.best.largest:
            return False
        return condition_of(self.A - L @ self.C, self.poles) <= condition * self.best.condition


def in_floats(matrix: Matrix) -> Reals:
    """Return a matrix of rational numbers in floating point; raises OverflowError beyond its range."""
    return np.array([[float(entry.fraction()) for entry in row] for row in matrix.rows])


def poles_of(desired: DesiredPolynomial) -> list[complex]:
    """Return the roots of φ, those of a factor as often as it is one."""
    found: list[complex] = []
    for factor, power in factored(desired.polynomial, desired.variable).factors:
        coefficients = [float(c.fraction()) for c in factor.coefficients(desired.variable)]
        found += [complex(root) for root in np.roots(coefficients)] * power
    return found


def is_small(pair: MultiOutputPair, desired: DesiredPolynomial, L: Matrix) -> bool:
    """Return whether a gain of a pair with numbers is small, and its eigenvectors not much worse conditioned than the best."""
    target = Target.of(pair, desired)
    return target is not None and target.admits(in_floats(L), KEPT)


def small_gain(pair: MultiOutputPair, desired: DesiredPolynomial, simple: Matrix, *, asked: bool) -> Small | None:
    """Return a small gain in place of the simple one of an observable pair with numbers; None where that one stays.

    It stays where it is small, where no eigenvectors with these poles exist, and, if not `asked`, where it is not large.
    """
    target = Target.of(pair, desired)
    if target is None:
        return None
    own = in_floats(simple)
    if target.admits(own, KEPT) or (not asked and np.abs(own).max() <= LARGE * target.best.largest):
        return None
    search = _by_eigenvectors if len(set(target.poles)) < len(target.poles) else _by_columns
    for condition in (NEAR, KEPT):
        found = min(search(pair, desired, target, condition), key=lambda small: cost(small.gain), default=None)
        if found is not None:
            return found
    return None


def _by_columns(pair: MultiOutputPair, desired: DesiredPolynomial, target: Target, condition: float) -> Iterator[Small]:
    """Yield small gains with all columns but one rounded to the first few steps that serve."""
    serving, outputs = 0, pair.c.shape[0]
    for step in islice(_steps(target.best.largest), STEPS):
        found = False
        for output in range(outputs):
            for numbers in islice(_promising(target, output, step, condition), EXACT):
                L_0 = Matrix.of([[Scalar.of(step * number) for number in row] for row in numbers])
                left = left_of(pair, L_0, output)
                column = None if left is None else left.gain(desired)
                L = None if column is None else (L_0 + column @ Matrix.unit(outputs, output).T).normal()
                if L is not None and target.admits(in_floats(L), condition):
                    found = True
                    yield Small(L)
        serving += found
        if serving == SERVING:
            return


def _steps(size: float) -> Iterator[Fraction]:
    """Yield short numbers below a size, in descending order: 10, 5, 5/2, 2, 1, 1/2 and so on."""
    power = floor(log10(size)) + 1
    while True:
        for part in (Fraction(1), Fraction(1, 2), Fraction(1, 4), Fraction(1, 5)):
            if (step := part * Fraction(10) ** power) <= size:
                yield step
        power -= 1


def _promising(target: Target, output: int, step: Fraction, condition: float) -> Iterator[list[list[int]]]:
    """Yield the entries of L₀ in steps, up or down from those of the best placement, for which L is small in floating point.

    The column of one output is 0; the gain l = φ(A − L₀ C) 𝒪⁻¹ eₙ of the pair that is left takes its place.
    """
    (order, outputs), near = target.C.T.shape, target.best.gain.T / float(step)
    near[:, output] = 0
    places = np.arange(1, order * outputs + 1).reshape(order, outputs)
    up = np.array([(places * GOLDEN * number + 0.5) % 1 for number in range(ROUNDINGS)])
    up[:, :, output] = 0.5
    numbers = np.unique(np.floor(near + up), axis=0)
    gains = numbers * float(step)
    closed = target.A - gains @ target.C
    rows = [np.broadcast_to(target.C[output], (len(closed), 1, order))]
    for _ in range(order - 1):
        rows.append(rows[-1] @ closed)
    observability = np.concatenate(rows, axis=1)
    regular = np.linalg.cond(observability) < SOLVABLE
    numbers, gains, closed, observability = (stack[regular] for stack in (numbers, gains, closed, observability))
    right = np.broadcast_to(np.eye(order)[:, -1:], (len(observability), order, 1))  # NumPy 1 stacks vectors otherwise
    last = np.linalg.solve(observability, right)
    column = np.zeros_like(last)
    for coefficient in target.phi:
        column = closed @ column + coefficient * last
    gains[:, :, output] = column[:, :, 0]
    for found, gain in zip(numbers, gains, strict=True):
        if target.admits(gain, condition):
            yield [[int(number) for number in row] for row in found]


class _Block(NamedTuple):
    """The null vectors that belong to a factor of φ: J, a basis as columns, and the weights of the best placement in it."""

    J: Matrix
    basis: Matrix
    weights: Reals


def _by_eigenvectors(
    pair: MultiOutputPair, desired: DesiredPolynomial, target: Target, condition: float
) -> Iterator[Small]:
    """Yield small gains with eigenvectors whose free components are rounded to the first few steps that serve."""
    serving, blocks = 0, list(_blocks(pair, desired, target.best))
    bases = [in_floats(block.basis) for block in blocks]
    ends = np.cumsum([basis.shape[1] for basis in bases])
    for step in islice(_steps(1.0), STEPS):
        found = False
        for number in range(EXACT):
            up = np.split((np.arange(1, 1 + ends[-1]) * GOLDEN * number + 0.5) % 1, ends[:-1])
            numbers = [np.floor(block.weights / float(step) + u) for block, u in zip(blocks, up, strict=True)]
            near = [basis @ n for basis, n in zip(bases, numbers, strict=True)]
            Psi, f = (np.array(rows).T for rows in _split(near, blocks))
            if np.linalg.cond(Psi) > SOLVABLE or not target.admits(np.linalg.solve(Psi.T, f.T), condition):
                continue
            small = _with_vectors(blocks, [[step * int(n) for n in each] for each in numbers])
            if small is not None and target.admits(in_floats(small.gain), condition):
                found = True
                yield small
        serving += found
        if serving == SERVING:
            return


def _blocks(pair: MultiOutputPair, desired: DesiredPolynomial, best: Placement) -> Iterator[_Block]:
    """Yield the blocks, one for each factor of φ as often as it is one."""
    left = list(range(len(best.poles)))
    for factor, power in factored(desired.polynomial, desired.variable).factors:
        J = _of_numbers(block_of(factor, desired))
        matrix = null_matrix(pair, J)
        pivots, reduced = reduced_echelon(matrix)
        free = [column for column in range(matrix.shape[1]) if column not in pivots]
        basis = Matrix.block([[null_vector(column, pivots, reduced) for column in free]])
        values, W = np.linalg.eig(in_floats(J))
        for _ in range(power):
            own: list[int] = []
            for value in values:
                own.append(min(left, key=lambda k: abs(best.poles[k] - value)))
                left.remove(own[-1])
            psi = (best.vectors[:, own] @ np.linalg.inv(W)).real
            weights = np.concatenate([psi.T.ravel(), (best.gain @ psi).T.ravel()])[free]
            yield _Block(J, basis, weights / weights[np.argmax(np.abs(weights))])


def _of_numbers(matrix: Matrix) -> Matrix:
    """Return a matrix of rational numbers over their own field."""
    return Matrix.of([[entry.fraction() for entry in row] for row in matrix.rows])


def _split(vectors: Sequence[Any], blocks: Sequence[_Block]) -> tuple[list[Any], list[Any]]:
    """Return the columns of Ψ and of f, which are stacked in the vector of each block."""
    psi, f, order = [], [], sum(block.J.shape[0] for block in blocks)
    for vector, block in zip(vectors, blocks, strict=True):
        size = block.J.shape[0]
        outputs = len(vector) // size - order
        psi += [vector[k * order : (k + 1) * order] for k in range(size)]
        f += [vector[order * size + k * outputs : order * size + (k + 1) * outputs] for k in range(size)]
    return psi, f


def _with_vectors(blocks: Sequence[_Block], weights: Sequence[Sequence[Fraction]]) -> Small | None:
    """Return the gain for free components, None where the eigenvectors are dependent."""
    vectors = [(block.basis @ Matrix.column(own)).entries for block, own in zip(blocks, weights, strict=True)]
    Psi, f = (Matrix.of(columns).T for columns in _split(vectors, blocks))
    if Psi.determinant().is_zero:
        return None
    return Small(Psi.T.solve(f.T).normal(), (Psi, f, block_diagonal([block.J for block in blocks])))


def block_diagonal(blocks: Sequence[Matrix]) -> Matrix:
    """Return the matrix with blocks along its diagonal."""
    rows = [
        [block if i == k else Matrix.zeros(block.shape[0], other.shape[1]) for k, other in enumerate(blocks)]
        for i, block in enumerate(blocks)
    ]
    return Matrix.block(rows)


def left_of(pair: ObserverPair, L_0: Matrix, output: int) -> ObserverPair | None:
    """Return the pair (A − L₀ C, c) of one output that L₀ leaves, None where it is not observable."""
    left = ObserverPair(
        (pair.A - L_0 @ pair.c).normal(), pair.c.select([output], range(pair.A.shape[0])), pair.variable
    )
    return left if left.is_observable else None
