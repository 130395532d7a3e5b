"""The rank of a matrix with parameters: where it drops, and the kernel there, as a list of strata.

On a locus the rank is that of an elimination which counts as zero what vanishes on the locus.  It drops only where the
minor that was found vanishes too; on every component of that set another elimination follows, which finds another minor
of the same order, or a smaller rank.  Loci of smaller rank are treated in the same way, each of them once.
"""

from __future__ import annotations

import itertools
import math
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.exact import (
    Ideal,
    Matrix,
    Scalar,
    TooLarge,
    apart_from_zero,
    echelon,
    independent_rows,
    modulo,
    primitive_kernel,
)
from symobs.ground.dataclass import dataclass
from symobs.system.conditions import FACTORED_UP_TO
from symobs.tasks.analysis.strata.loci import Locus, loci, maximal

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.tasks.analysis.strata.loci import Region

#: A minor: its rows and its columns.
Minor = tuple[tuple[int, ...], tuple[int, ...]]

#: The most eliminations of one tree, and terms of a test matrix whose rank is asked for on a locus.
_ELIMINATIONS = 150
_TERMS = 3_000

#: The most minors of the same rows that are looked at together, and terms of one of them.
_BESIDE, _TERMS_BESIDE = 20, 200
#: A minor of up to this many terms is followed alone.
_SHORT = 12

#: Beyond this many terms a matrix is not eliminated but its rank read off at a point.
ELIMINATED_UP_TO = 300
#: The most terms a determinant may have before cancellation.
EXPANDED = 10**8


@dataclass
class Kernel:
    """A basis N of the kernel as columns, X with A N = N X, and rows of a minor of N that X was solved from."""

    basis: Matrix
    restricted: Matrix
    free: tuple[int, ...]


@dataclass
class Node:
    """A locus with the rank that holds on it outside `below`; the minors never vanish together there.

    Each locus of `below` lies in the one of `covers` that stands at the same place: another node's, or undecided.
    """

    locus: Locus
    rank: int
    minors: tuple[Minor, ...]
    kernel: Kernel | None = None
    below: tuple[Locus, ...] = ()
    covers: tuple[Locus, ...] = ()


@dataclass
class Tree:
    """The generic rank, the strata with another one, and the undecided loci.

    `eliminations` is how many it took.
    """

    generic: Node
    strata: tuple[Node, ...]
    undecided: tuple[Locus, ...]
    eliminations: int


class _Exhausted(Exception):
    """The budget of eliminations is spent, or one of them grows too large."""


class _Search:
    """The eliminations of one tree, counted."""

    def __init__(self, matrix: Matrix, region: Region, generic: Minor) -> None:
        self.matrix = matrix
        self.region = region
        self.generic = generic
        self.left = self.allowed = _ELIMINATIONS if matrix.size <= _TERMS else 0

    @property
    def spent(self) -> int:
        """How many eliminations there were."""
        return self.allowed - self.left

    def eliminated(self, locus: Locus) -> tuple[int, Minor, Scalar]:
        """Return the rank on a locus, a minor of that order and its value, 0 where that vanishes on the locus."""
        if locus == self.region.whole:
            return len(self.generic[0]), self.generic, self._minor(self.generic)
        if self.left <= 0:
            raise _Exhausted
        self.left -= 1
        ideal = locus.ideal
        assert ideal is not None  # noqa: S101 - what is undecided is not asked about
        try:
            columns = echelon(self.matrix, ideal)[0]
            rows = independent_rows(self.matrix.select(range(self.matrix.shape[0]), columns), ideal)
        except TooLarge as error:
            raise _Exhausted from error
        if len(rows) != len(columns):  # the locus is several, and a pivot vanishes on some of them
            raise _Exhausted
        return len(columns), (rows, columns), self._minor((rows, columns), ideal)

    def _minor(self, minor: Minor, ideal: Ideal | None = None) -> Scalar:
        """Return the numerator of a minor, 0 where it lies in an ideal."""
        value = self.matrix.select(*minor).determinant().numerator
        return Scalar.of(0) if ideal is not None and value in ideal else value

    def drops(self, locus: Locus) -> tuple[int, list[Minor], list[Locus]]:
        """Return the rank on a locus, minors of that order, and the loci where all of them vanish."""
        rank, minor, value = self.eliminated(locus)
        minors, values = [minor], [value]
        found: list[Locus] = []
        if value.is_zero:  # entries that are not seen to vanish, though products of them do
            sharper = self._sharpened(locus, minor)
            return self.drops(sharper) if sharper is not None else (rank, minors, [Locus(locus.equations)])
        if locus.equations and not self.region.vanishing(value):
            return rank, minors, found
        for other, beside in self._beside(locus, minor) if value.size > _SHORT else ():
            minors.append(other)
            values.append(beside)
        for part in loci((*locus.equations, *self.region.simplest_first(values)), self.region):
            if part.ideal is None:
                found.append(part)
                continue
            try:
                lower = self.eliminated(part)[0] < rank
                if lower:
                    found.append(part)
                    continue
                _, others, deeper = self.drops(part)
                minors += others
                found += deeper
            except _Exhausted:
                found.append(Locus(part.equations))
        return rank, minors, found

    def _beside(self, locus: Locus, minor: Minor) -> Iterator[tuple[Minor, Scalar]]:
        """Yield the other minors of the same rows on a locus, where they are few: the rank drops where all vanish."""
        rows, columns = minor
        every = range(self.matrix.shape[1])
        if not locus.equations or not rows or math.comb(len(every), len(rows)) > _BESIDE:
            return
        for chosen in itertools.combinations(every, len(rows)):
            value = self._minor((rows, chosen), locus.ideal)
            if chosen != columns and not value.is_zero and value.size <= _TERMS_BESIDE:
                yield (rows, chosen), value

    def node(self, locus: Locus) -> Node:
        """Return the node of a locus, with the loci of smaller rank below it."""
        if locus.ideal is None:
            raise _Exhausted
        try:
            rank, minors, found = self.drops(locus)
        except TooLarge as error:
            raise _Exhausted from error
        return Node(locus, rank, tuple(minors), below=maximal(found))

    def _sharpened(self, locus: Locus, minor: Minor) -> Locus | None:
        """Return the same locus with an entry of a minor among its equations that vanishes on it unseen."""
        try:
            for value in (entry.numerator for entry in self.matrix.select(*minor).entries):
                if locus.ideal is None or value in locus.ideal:
                    continue
                if not locus.ideal.extended_by(apart_from_zero(value)).is_whole:
                    continue
                found = loci((*locus.equations, value), self.region)
                if len(found) == 1 and found[0].ideal is not None:
                    return found[0]
        except TooLarge:  # the locus stays as it is, and undecided
            return None
        return None


def node_of(matrix: Matrix, region: Region, minor: Minor) -> Node | None:
    """Return the rank of a matrix in a region with the loci below; None where that is beyond the limits.

    `minor` does not vanish in general.
    """
    try:
        return _Search(matrix, region, minor).node(region.whole)
    except _Exhausted:
        return None


def rank_tree(matrix: Matrix, A: Matrix, region: Region, minor: Minor, kernel: Kernel) -> Tree:
    """Return rank and kernel of a matrix whose kernel is invariant under A, for all parameters of a region.

    `minor` and `kernel` are those that hold in general.
    """
    search = _Search(matrix, region, minor)
    nodes: dict[Locus, Node] = {}
    undecided: list[Locus] = []
    waiting = deque([region.whole])
    while waiting:
        locus = waiting.popleft()
        if locus in nodes:
            continue
        try:
            nodes[locus] = search.node(locus)
        except _Exhausted:
            undecided.append(Locus(locus.equations))
            continue
        undecided += [each for each in nodes[locus].below if each.ideal is None]
        waiting += [each for each in nodes[locus].below if each.ideal is not None]
    generic = replace(nodes.pop(region.whole), kernel=kernel)
    kept = []
    for rank in sorted({node.rank for node in nodes.values()}, reverse=True):
        kept += [nodes[each] for each in maximal(each for each, node in nodes.items() if node.rank == rank)]
    return _with_kernels(search, A, [generic, *kept], list(maximal(undecided)))


def _with_kernels(search: _Search, A: Matrix, nodes: list[Node], undecided: list[Locus]) -> Tree:
    """Give every node a kernel; where a basis degenerates though the rank does not, there is a further node."""
    done: list[Node] = []
    waiting = deque(nodes)
    known = [*(node.locus for node in nodes), *undecided]
    while waiting:
        node = waiting.popleft()
        below = [*(each for each in known if each != node.locus and each.lies_in(node.locus)), *node.below]
        found = node.kernel
        failing: tuple[Locus, ...] = ()
        if found is None:
            try:
                found, failing = _best_kernel(search.matrix, A, node, below, search.region)
            except TooLarge:  # the rank is known there, a basis of the kernel is not
                undecided.append(Locus(node.locus.equations))
                continue
        elif found.basis.shape[1]:
            failing = _failing(found, node.locus, below, search.region)
        for each in failing:
            try:
                waiting.append(search.node(each))
            except _Exhausted:
                undecided.append(Locus(each.equations))
        known += failing
        done.append(replace(node, kernel=found))
    done = [_with_covers(node, known, undecided) for node in done]
    if search.region.work.left < 0:
        drops = tuple(Locus(each.equations) for each in nodes[0].below)
        return Tree(replace(nodes[0], below=drops, covers=drops), (), drops, search.spent)
    return Tree(done[0], tuple(done[1:]), tuple(undecided), search.spent)


def _with_covers(node: Node, known: list[Locus], undecided: list[Locus]) -> Node:
    """Return a node with the loci below it, and for each one of the known loci that it lies in; else it is undecided."""
    below = maximal([*(each for each in known if each != node.locus and each.lies_in(node.locus)), *node.below])
    others = [each for each in known if not node.locus.lies_in(each)]
    covers = []
    for each in below:
        cover = next((other for other in others if each.lies_in(other)), None)
        if cover is None:
            cover = Locus(each.equations)
            undecided.append(cover)
        covers.append(cover)
    return replace(node, below=below, covers=tuple(covers))


def _best_kernel(
    matrix: Matrix, A: Matrix, node: Node, below: list[Locus], region: Region
) -> tuple[Kernel, tuple[Locus, ...]]:
    """Return a kernel that holds on as much of a node's locus as possible, and where it does not."""
    best: tuple[Kernel, tuple[Locus, ...]] | None = None
    count = matrix.shape[1]
    seen: set[tuple[Scalar, frozenset[Matrix]]] = set()
    for shift in range(count):
        order = tuple((index + shift) % count for index in range(count))
        kernel = kernel_on(matrix, A, node.locus.ideal if node.locus.equations else None, order)
        columns = frozenset(kernel.basis.select(range(count), [j]) for j in range(kernel.basis.shape[1]))
        if (kernel.restricted.common_denominator(), columns) in seen:
            continue
        seen.add((kernel.restricted.common_denominator(), columns))
        failing = _failing(kernel, node.locus, below, region)
        if best is None or len(failing) < len(best[1]):
            best = kernel, failing
        if not failing:
            break
    assert best is not None  # noqa: S101 - there is at least one order
    return best


def kernel_on(matrix: Matrix, A: Matrix, ideal: Ideal | None, order: tuple[int, ...]) -> Kernel:
    """Return the kernel where an ideal vanishes, eliminated with the columns in some order."""
    return with_restriction(primitive_kernel(matrix, ideal, order), A, ideal)


def with_restriction(N: Matrix, A: Matrix, ideal: Ideal | None = None) -> Kernel:
    """Return the kernel with the X of A N = N X."""
    count = range(N.shape[1])
    free = independent_rows(N, ideal)
    if not count or len(free) < len(count):
        return Kernel(N, Matrix.zeros(len(count), len(count)), free)
    X = N.select(free, count).solve((A @ N).select(free, count)).normal()
    return Kernel(N, modulo(X, ideal), free)


def maximal_minors(N: Matrix) -> list[Scalar]:
    """Return the minors of a matrix that use all its columns."""
    count = N.shape[1]
    return [N.select(rows, range(count)).determinant() for rows in itertools.combinations(range(N.shape[0]), count)]


def _failing(kernel: Kernel, locus: Locus, below: list[Locus], region: Region) -> tuple[Locus, ...]:
    """Return the loci, not among those below, where N is no basis or X has no meaning."""
    ideal = locus.ideal
    assert ideal is not None  # noqa: S101 - what is undecided has no kernel
    independent = [ideal.remainder(minor.numerator) for minor in maximal_minors(kernel.basis)]
    meaningful = kernel.restricted.common_denominator()
    failing: list[Locus] = []
    for values in ([value for value in independent if not value.is_zero], [meaningful]):
        if any(value.is_constant for value in values):
            continue
        parts = loci((*locus.equations, *region.simplest_first(values)), region)
        failing += [part for part in parts if not any(part.lies_in(other) for other in below) and part != locus]
    return maximal(failing)


def exclusions(node: Node, region: Region) -> tuple[Scalar, ...]:
    """Return polynomials that all differ from 0 on the locus of a node exactly outside the loci below.

    A locus that no single equation cuts out of the node's is excluded by a sum of squares, since parameters are real.
    Raises `TooLarge` where that is too long.
    """
    chosen: list[Scalar] = []
    ideal = node.locus.ideal
    assert ideal is not None  # noqa: S101 - nodes are decided
    for lower in node.below:
        if lower.ideal is not None and any(value in lower.ideal for value in chosen):
            continue
        rest = [ideal.remainder(equation) for equation in lower.equations]
        rest = [math.prod(region.vanishing(value), start=Scalar.of(1)) for value in rest if not value.is_zero]
        rest.sort(key=lambda value: (sum(value.degrees()), value.size))
        single = next((value for value in rest if cuts_out(value, node, region)), None)
        if len(rest) == 1:
            single = rest[0]
        if single is None:
            chosen.append(Locus(tuple(rest)).distance)
        else:
            chosen += [f for f in _factors(single, region) if f not in chosen]
    return tuple(chosen)


def _factors(value: Scalar, region: Region) -> tuple[Scalar, ...]:
    return (value,) if value.size > FACTORED_UP_TO else region.vanishing(value)


def cuts_out(value: Scalar, node: Node, region: Region) -> bool:
    """Return whether a polynomial vanishes on the locus of a node only on loci below."""
    parts = loci((*node.locus.equations, value), region)
    return all(any(part.lies_in(lower) for lower in node.below) for part in parts)


def determinant_terms(matrix: Matrix) -> int:
    """Return a bound of the number of terms of a determinant before cancellation: the product of those of its rows."""
    if not matrix.names:
        return 1
    return math.prod(sum(entry.size - 1 for entry in row if not entry.is_zero) for row in matrix.rows)


def minor_at_a_point(matrix: Matrix) -> Minor:
    """Return the rows and columns of a minor that is not zero at a point, of the order of the rank there."""
    names = sorted(matrix.names)
    values = {name: Scalar.rational(7919 + 104729 * index**2, 997 + index) for index, name in enumerate(names)}
    there = matrix.substitute(values)
    columns = echelon(there)[0]
    return independent_rows(there.select(range(there.shape[0]), columns)), columns
