"""Members of the family of gains that are easy to read: one output alone, or chains of Brunovsky's form.

For an order of the outputs the first independent ones among c₁, c₂, …, c₁A, c₂A, … have lengths ν₁, ν₂, …, and in
coordinates made of them the dual pair (Aᵀ, Cᵀ) consists of chains of integrators, at whose ends the gain acts freely.
There the chains are linked to one, or each is given factors of φ of its own.  Source: P. Brunovsky, Kybernetika 6
(1970), 173-188.
"""

from __future__ import annotations

from itertools import combinations, islice, pairwise, permutations
from math import prod
from typing import TYPE_CHECKING

from symobs.exact import Field, Matrix, Scalar, apply_polynomial, rank
from symobs.exact.linear_algebra.krylov import Krylov
from symobs.ground.dataclass import dataclass

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.exact import Ideal

#: So many orders of the outputs, links of chains and ways to share the factors of φ are tried.
ORDERS, LINKS, SHARES = 6, 6, 8


@dataclass
class BrunovskyChains:
    """The dual pair in Brunovsky's coordinates: T rows, the end of each chain, the outputs they belong to."""

    T: Matrix
    inverse: Matrix
    lengths: tuple[int, ...]
    outputs: tuple[int, ...]
    ends: tuple[int, ...]
    last_rows: Matrix
    driven: Matrix

    @staticmethod
    def of(A: Matrix, C: Matrix, order: Sequence[int], ideal: Ideal | None = None) -> BrunovskyChains:
        """Return the chains for an order of the outputs; (C, A) must be observable.  What lies in `ideal` is 0."""
        states = A.shape[0]
        lengths = _lengths(A, C, order, ideal)
        outputs = tuple(i for i in order if lengths[i])
        rows = [_powers(C.select([i], range(states)), A, lengths[i]) for i in outputs]
        inverse = Matrix.block([[row] for part in rows for row in part]).T.inverse()
        ends, position = [], -1
        for i in outputs:
            position += lengths[i]
            ends.append(position)
        T = Matrix.block(
            [
                [row]
                for end, i in zip(ends, outputs, strict=True)
                for row in _powers(inverse.select([end], range(states)), A.T, lengths[i])
            ]
        )
        back = T.inverse()
        last_rows = (T.select(ends, range(states)) @ A.T @ back).normal()
        driven = T.select(ends, range(states)) @ C.select(outputs, range(states)).T
        return BrunovskyChains(T, back, tuple(lengths[i] for i in outputs), outputs, tuple(ends), last_rows, driven)

    def gain(self, wanted: Matrix, count: int) -> Matrix:
        """Return L for which the ends of the chains of (A − LC)ᵀ have these rows."""
        found = (self.driven.solve(self.last_rows - wanted) @ self.T).normal()
        rows = {output: found.select([k], range(found.shape[1])) for k, output in enumerate(self.outputs)}
        empty = Matrix.zeros(1, found.shape[1])
        return Matrix.block([[rows.get(i, empty)] for i in range(count)]).T

    @property
    def starts(self) -> tuple[int, ...]:
        """The first state of each chain."""
        return tuple(end - length + 1 for end, length in zip(self.ends, self.lengths, strict=True))

    @property
    def by_output(self) -> frozenset[tuple[int, Matrix]]:
        """The chains without their order: the rows of T that belong to each output."""
        return frozenset(
            (output, self.T.select(range(start, end + 1), range(self.T.shape[0])))
            for output, start, end in zip(self.outputs, self.starts, self.ends, strict=True)
        )

    def linked(self, order: Sequence[int], coefficients: Sequence[Scalar]) -> Matrix:
        """Return the last rows that make one chain of all: each goes on with the next, the last one has φ."""
        size = self.T.shape[0]
        rows = [[Scalar.of(0)] * size for _ in self.ends]
        for here, following in pairwise(order):
            rows[here][self.starts[following]] = Scalar.of(1)
        states = [state for k in order for state in range(self.starts[k], self.ends[k] + 1)]
        for state, coefficient in zip(states, reversed(coefficients), strict=True):
            rows[order[-1]][state] = -coefficient
        return Matrix.of(rows)

    def shared(self, polynomials: Sequence[Sequence[Scalar]], beyond: str) -> Matrix:
        """Return the last rows that assign each chain its polynomial.

        `beyond` says what leads from a chain to later ones: `nothing`, `one` entry into the next, or what there is in
        the `plant`, so that less has to be changed.
        """
        size = self.T.shape[0]
        rows = []
        for k, coefficients in enumerate(polynomials):
            row = [Scalar.of(0)] * size
            if beyond == "plant":
                row = [self.last_rows[k, j] if j > self.ends[k] else Scalar.of(0) for j in range(size)]
            elif beyond == "one" and k + 1 < len(self.starts):
                row[self.starts[k + 1]] = Scalar.of(1)
            row[self.starts[k] : self.ends[k] + 1] = [-c for c in reversed(coefficients)]
            rows.append(row)
        return Matrix.of(rows)


def _powers(row: Matrix, A: Matrix, length: int) -> list[Matrix]:
    rows = [row]
    for _ in range(length - 1):
        rows.append((rows[-1] @ A).normal())
    return rows[:length]


def _lengths(A: Matrix, C: Matrix, order: Sequence[int], ideal: Ideal | None) -> list[int]:
    """Return how many of cᵢ, cᵢA, … are independent of those chosen before them, level by level."""
    states = A.shape[0]
    lengths = [0] * C.shape[0]
    chosen: list[Matrix] = []
    waiting = {i: C.select([i], range(states)) for i in order}
    while waiting:
        for i in list(waiting):
            if rank(Matrix.block([[row] for row in [*chosen, waiting[i]]]), ideal) == len(chosen):
                del waiting[i]
                continue
            chosen.append(waiting[i])
            lengths[i] += 1
            waiting[i] = (waiting[i] @ A).normal()
    return lengths


def simple_gains(
    A: Matrix, C: Matrix, factors: Sequence[Scalar], variable: str, ideal: Ideal | None = None
) -> Iterator[Matrix]:
    """Yield gains with det(sI − A + LC) = φ that are easy to read, for an observable pair."""
    yield from _of_one_output(A, C, factors, variable)
    coefficients = _coefficients(factors, variable)
    count = C.shape[0]
    for order in islice(permutations(range(count)), ORDERS if not (A.names or C.names) else 2):
        chains = BrunovskyChains.of(A, C, order, ideal)
        for link in islice(permutations(range(len(chains.outputs))), LINKS):
            yield chains.gain(chains.linked(link, coefficients), count)
        for share in islice(split_polynomial(factors, chains.lengths, variable), SHARES):
            for beyond in ("nothing", "one", "plant"):
                yield chains.gain(chains.shared(share, beyond), count)


def _of_one_output(A: Matrix, C: Matrix, factors: Sequence[Scalar], variable: str) -> Iterator[Matrix]:
    """Yield l w by Ackermann's formula, where (w C, A) is observable for a combination of few outputs."""
    count = C.shape[0]
    singles = [[int(i == j) for j in range(count)] for i in range(count)]
    pairs = [
        [int(j == i) + sign * int(j == k) for j in range(count)]
        for i, k in combinations(range(count), 2)
        for sign in (1, -1)
    ]
    for weights in (singles, pairs):
        found = False
        for row in weights:
            w = Matrix.of([row])
            krylov = Krylov.of(A, w @ C)
            if not krylov.is_singular:
                found = True
                yield (apply_polynomial(factors, variable, A, krylov.solve_last()) @ w).normal()
        if found:
            return


def split_polynomial(
    factors: Sequence[Scalar], lengths: Sequence[int], variable: str
) -> Iterator[list[tuple[Scalar, ...]]]:
    """Yield the ways to share the factors of φ among chains of these lengths, as coefficients."""
    if not lengths:
        yield []
        return
    degrees = [factor.degree(variable) for factor in factors]
    for size in range(len(factors) + 1):
        for chosen in _chosen(factors, degrees, size, lengths[0]):
            own = [factors[k] for k in chosen]
            rest = [f for k, f in enumerate(factors) if k not in chosen]
            coefficients = _coefficients(own, variable)
            for others in split_polynomial(rest, lengths[1:], variable):
                yield [coefficients, *others]


def _coefficients(factors: Sequence[Scalar], variable: str) -> tuple[Scalar, ...]:
    """Return the coefficients of a product of monic polynomials but the first: numbers as numbers."""
    product = prod(factors, start=Scalar.of(1))
    return product.coefficients(variable, Field.of(sorted(product.names - {variable})))[1:]


def _chosen(
    factors: Sequence[Scalar], degrees: Sequence[int], size: int, degree: int, first: int = 0
) -> Iterator[tuple[int, ...]]:
    """Yield the places of so many factors whose degrees add up to `degree`; of equal ones the first are taken."""
    if not size:
        if not degree:
            yield ()
        return
    tried: set[Scalar] = set()
    for k in range(first, len(factors) - size + 1):
        if factors[k] not in tried and degrees[k] <= degree:
            tried.add(factors[k])
            for others in _chosen(factors, degrees, size - 1, degree - degrees[k], k + 1):
                yield (k, *others)


def cost(gain: Matrix) -> tuple[int, int]:
    """Return how hard a gain is to read: parameters in denominators, then the length of its numbers."""
    below = gain.common_denominator()
    total = 0
    for entry in gain.entries:
        if entry.is_zero:
            continue
        if entry.is_constant:
            number = entry.fraction()
            total += abs(number.numerator).bit_length() + 3 * (number.denominator.bit_length() - 1)
        else:
            total += 8 * entry.size
    return len(below.names), total
