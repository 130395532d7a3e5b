"""A gain with small and short entries near the best conditioned placement, for several outputs and numbers alone.

All rows of Kᵀ = L that belong to one output are set to short numbers near those of the best conditioned placement, which
leaves the pair (A − L₀ C, c) of one output c: its gain l is unique, and L = L₀ + l eᵀ assigns φ exactly whatever the
numbers are.  Of many such gains, and of those with simple entries, the shortest is taken that is small enough.
"""

from __future__ import annotations

from fractions import Fraction
from itertools import islice
from math import floor, log10
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from symobs.exact import Matrix, Scalar, factored
from symobs.tasks.design.pole_placement.brunovsky_chains import cost
from symobs.tasks.design.pole_placement.conditioned_placement import best_conditioned, condition_of
from symobs.tasks.design.pole_placement.single_output import ObserverPair

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.system.specification import DesiredPolynomial
    from symobs.tasks.design.pole_placement.conditioned_placement import Placement, Reals
    from symobs.tasks.design.pole_placement.multiple_outputs import MultiOutputPair

#: A gain is small where its largest entry is at most so many times that of the best conditioned placement.
SMALL = 1.5
#: Without being asked for, a small gain is taken where the largest entry of the simple one is more than so many times as large.
LARGE = 3
#: The eigenvectors of A − L C may be conditioned so many times worse than the best: of a gain that is searched for, and of a
#: simple one.
NEAR, KEPT = 2, 5
#: For every step to which entries are rounded so many roundings are tried for each output, and so many of them exactly; then
#: the steps that have to serve, and all that are tried.
ROUNDINGS, EXACT, SERVING, STEPS = 100, 20, 3, 24
#: The golden ratio, whose multiples modulo 1 are spread evenly.
GOLDEN = (1 + 5**0.5) / 2


class Target(NamedTuple):
    """The pair in floating point, φ, and the best conditioned placement of its poles."""

    A: Reals
    C: Reals
    phi: Reals
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
        return Target(A, C, np.poly(poles).real, best)

    def admits(self, L: Reals, condition: float) -> bool:
        """Return whether a gain is small and its eigenvectors are at most so many times worse conditioned than the best."""
        if not np.isfinite(L).all() or np.abs(L).max() > SMALL * self.best.largest:
            return False
        return condition_of(self.A - L @ self.C) <= condition * self.best.condition


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


def small_gain(pair: MultiOutputPair, desired: DesiredPolynomial, simple: Matrix, *, asked: bool) -> Matrix | None:
    """Return a small gain in place of the simple one of an observable pair with numbers; None where that one stays.

    It stays where it is small, where no eigenvectors with these poles exist, and, if not `asked`, where it is not large.
    """
    target = Target.of(pair, desired)
    if target is None:
        return None
    own = in_floats(simple)
    if target.admits(own, KEPT) or (not asked and np.abs(own).max() <= LARGE * target.best.largest):
        return None
    return min(_small_gains(pair, desired, target), key=cost, default=None)


def _small_gains(pair: MultiOutputPair, desired: DesiredPolynomial, target: Target) -> Iterator[Matrix]:
    """Yield small gains, rounded to the first few steps that serve."""
    serving, outputs = 0, pair.c.shape[0]
    for step in islice(_steps(target.best.largest), STEPS):
        found = False
        for output in range(outputs):
            for numbers in islice(_promising(target, output, step), EXACT):
                L_0 = Matrix.of([[Scalar.of(step * number) for number in row] for row in numbers])
                left = left_of(pair, L_0, output)
                column = None if left is None else left.gain(desired)
                L = None if column is None else (L_0 + column @ Matrix.unit(outputs, output).T).normal()
                if L is not None and target.admits(in_floats(L), NEAR):
                    found = True
                    yield L
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


def _promising(target: Target, output: int, step: Fraction) -> Iterator[list[list[int]]]:
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
    regular = np.linalg.det(observability) != 0
    numbers, gains, closed, observability = (stack[regular] for stack in (numbers, gains, closed, observability))
    last = np.linalg.solve(observability, np.eye(order)[:, -1:])
    column = np.zeros_like(last)
    for coefficient in target.phi:
        column = closed @ column + coefficient * last
    gains[:, :, output] = column[:, :, 0]
    for found, gain in zip(numbers, gains, strict=True):
        if target.admits(gain, NEAR):
            yield [[int(number) for number in row] for row in found]


def left_of(pair: ObserverPair, L_0: Matrix, output: int) -> ObserverPair | None:
    """Return the pair (A − L₀ C, c) of one output that L₀ leaves, None where it is not observable."""
    left = ObserverPair(
        (pair.A - L_0 @ pair.c).normal(), pair.c.select([output], range(pair.A.shape[0])), pair.variable
    )
    return left if left.is_observable else None
