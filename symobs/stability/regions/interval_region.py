"""Stability regions of one parameter: open intervals between critical points."""

from __future__ import annotations

import itertools
from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact.algebraic.real_algebraic import rational_between, roots_of_scalar
from symobs.ground.dataclass import dataclass
from symobs.stability.regions.short_list import Sample

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact import RealNumber, Scalar
    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials


@dataclass(frozen=True)
class IntervalPiece:
    """An open interval between neighbouring critical points (None: none on that side), and whether it is stable."""

    low: RealNumber | None
    high: RealNumber | None
    sample: Fraction
    stable: bool


@dataclass(frozen=True)
class LineRegion:
    """The set of stable values of one parameter."""

    critical: CriticalPolynomials
    name: str

    @cached_property
    def points(self) -> tuple[RealNumber, ...]:
        """The real roots of the critical polynomials, ascending."""
        return tuple(sorted({root for factor in self.critical.factors for root in roots_of_scalar(factor, self.name)}))

    @cached_property
    def pieces(self) -> tuple[IntervalPiece, ...]:
        """The intervals between them that the declared sign allows, from left to right."""
        return self._pieces(self.points)

    def _pieces(self, points: Sequence[RealNumber]) -> tuple[IntervalPiece, ...]:
        ends = [None, *points, None]
        found = []
        for low, high in itertools.pairwise(ends):
            sample = rational_between(low, high)
            point = {self.name: sample}
            if self.critical.allows(point):
                found.append(IntervalPiece(low, high, sample, self.critical.is_stable(point)))
        return tuple(found)

    @cached_property
    def intervals(self) -> tuple[IntervalPiece, ...]:
        """The stable ones."""
        return tuple(piece for piece in self.pieces if piece.stable)

    @cached_property
    def cuts(self) -> tuple[RealNumber, ...]:
        """The excluded points with stable intervals on both sides."""
        pairs = zip(self.pieces[:-1], self.pieces[1:], strict=True)
        return tuple(high.low for low, high in pairs if low.stable and high.stable and high.low is not None)

    # -- for the inequalities ----------------------------------------------------------------------------------------

    def samples(self, further: Sequence[Scalar]) -> list[Sample]:
        """Return a point of every open interval, none of the further polynomials changing its sign inside one."""
        pieces = self._pieces(self.divided(further)) if further else self.pieces
        return [Sample({self.name: piece.sample}, piece.stable) for piece in pieces]

    def divided(self, further: Sequence[Scalar]) -> tuple[RealNumber, ...]:
        """Return the critical points and the roots of further irreducible polynomials, ascending."""
        more = {root for polynomial in further for root in roots_of_scalar(polynomial, self.name)}
        return tuple(sorted(more.union(self.points)))

    def surrounded(self) -> tuple[Scalar, ...]:
        """Return the critical factors that vanish at points with the region on both sides."""
        return tuple(
            factor
            for factor in self.critical.proper
            if any(root in self.cuts for root in roots_of_scalar(factor, self.name))
        )

    def through_holes(self) -> tuple[tuple[Scalar, ...], ...]:
        """Return nothing: an excluded point of a line is a cut."""
        return ()

    @property
    def empty(self) -> bool:
        """Whether the region is empty."""
        return not self.intervals

    @property
    def everywhere(self) -> bool:
        """Whether every admissible value is stable."""
        return len(self.pieces) == len(self.intervals) and not self.surrounded()

    @property
    def bounded(self) -> bool:
        """Whether every interval is bounded."""
        return all(piece.low is not None and piece.high is not None for piece in self.intervals)
