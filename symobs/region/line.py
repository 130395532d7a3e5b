"""The region of one parameter in which a polynomial is stable: open intervals between its critical points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.half_plane import all_to_the_left
from symobs.exact.real import rational_between, roots_of_scalar

from symobs.region.inequalities import Sample

if TYPE_CHECKING:
    from collections.abc import Sequence
    from fractions import Fraction

    from symobs.exact import RealNumber
    from symobs.region.critical import Critical


@dataclass(frozen=True)
class Piece:
    """An open interval between neighbouring critical points (None: none on that side), and whether it is stable."""

    low: RealNumber | None
    high: RealNumber | None
    sample: Fraction
    stable: bool


@dataclass(frozen=True)
class LineRegion:
    """All values of one parameter at which the polynomial is stable."""

    critical: Critical
    name: str

    @cached_property
    def points(self) -> tuple[RealNumber, ...]:
        """The real roots of the critical polynomials, ascending."""
        return tuple(sorted({root for factor in self.critical.factors for root in roots_of_scalar(factor, self.name)}))

    @cached_property
    def pieces(self) -> tuple[Piece, ...]:
        """The intervals between them, from left to right."""
        return self._divided(self.points)

    def _divided(self, points: Sequence[RealNumber]) -> tuple[Piece, ...]:
        ends = [None, *points, None]
        found = []
        for low, high in zip(ends[:-1], ends[1:], strict=True):
            sample = rational_between(low, high)
            found.append(Piece(low, high, sample, self.is_stable(sample)))
        return tuple(found)

    def is_stable(self, value: Fraction) -> bool:
        """Tell whether the polynomial is stable at a rational value."""
        point = {self.name: Scalar.of(value)}
        if self.critical.denominator.substitute(point).is_zero:
            return False
        return all_to_the_left(self.critical.at(point))

    @cached_property
    def intervals(self) -> tuple[Piece, ...]:
        """The stable ones."""
        return tuple(piece for piece in self.pieces if piece.stable)

    @cached_property
    def cuts(self) -> tuple[RealNumber, ...]:
        """The points with stable intervals on both sides: they are not in the region."""
        pairs = zip(self.pieces[:-1], self.pieces[1:], strict=True)
        return tuple(point for point, (low, high) in zip(self.points, pairs, strict=True) if low.stable and high.stable)

    # -- for the inequalities ----------------------------------------------------------------------------------------

    def samples(self, further: Sequence[Scalar]) -> list[Sample]:
        """Return a point of every open interval, none of the further polynomials changing its sign inside one."""
        more = {root for polynomial in further for root in roots_of_scalar(polynomial, self.name)}
        pieces = self._divided(sorted(more.union(self.points))) if further else self.pieces
        return [Sample({self.name: Scalar.of(piece.sample)}, piece.stable) for piece in pieces]

    def surrounded(self) -> tuple[Scalar, ...]:
        """Return the critical factors that vanish at points with the region on both sides."""
        return tuple(
            factor
            for factor in self.critical.factors
            if any(root in self.cuts for root in roots_of_scalar(factor, self.name))
        )

    def through_holes(self) -> tuple[tuple[Scalar, ...], ...]:
        """Return nothing: a point of a line is no hole but a cut."""
        return ()

    @property
    def empty(self) -> bool:
        """Whether nothing is stable."""
        return not self.intervals

    @property
    def everywhere(self) -> bool:
        """Whether every value is stable."""
        return not self.points and not self.empty

    @property
    def bounded(self) -> bool:
        """Whether no interval reaches to infinity."""
        return all(piece.low is not None and piece.high is not None for piece in self.intervals)
