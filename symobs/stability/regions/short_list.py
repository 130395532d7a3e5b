"""A short list of strict inequalities that holds exactly on a region of one or two parameters.

The region is known as cells.  Candidates are the critical factors and the conditions of Liénard and Chipart; a list is right
when it holds at a point of every stable cell and fails at a point of every other one, in a division fine enough that
no listed polynomial changes its sign inside a cell, and when it excludes the curves and the points that the region
surrounds without containing them.
"""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, NamedTuple, Protocol

from symobs.exact import Scalar
from symobs.exact.algebraic.rational_points import value_at
from symobs.ground.dataclass import dataclass
from symobs.stability.criteria.critical_polynomials import irreducible
from symobs.system.conditions import sign_of

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from fractions import Fraction

    from symobs.stability.criteria.critical_polynomials import CriticalPolynomials


class RegionInequality(NamedTuple):
    """polynomial > 0, or with the operator `!=` polynomial ≠ 0."""

    polynomial: Scalar
    operator: str = ">"

    def at(self, point: dict[str, Fraction]) -> bool:
        """Return whether the inequality holds at a rational point."""
        value = value_at(self.polynomial, point)
        return value > 0 if self.operator == ">" else value != 0


@dataclass(frozen=True)
class Sample:
    """A rational point of an open cell, and whether the polynomial is stable in the cell."""

    point: dict[str, Fraction]
    stable: bool


class ExactRegion(Protocol):
    """The interface of exact regions of one and two parameters."""

    @property
    def critical(self) -> CriticalPolynomials:
        """The critical polynomials."""

    def samples(self, further: Sequence[Scalar]) -> list[Sample]:
        """Return a point of every open cell, none of the further polynomials changing its sign inside one."""

    def surrounded(self) -> tuple[Scalar, ...]:
        """Return critical factors that vanish on every curve with the region on both sides."""

    def through_holes(self) -> tuple[tuple[Scalar, ...], ...]:
        """Return, for every isolated excluded point, the critical factors that vanish there."""


@lru_cache(maxsize=256)
def short_list(region: ExactRegion) -> tuple[RegionInequality, ...]:
    """Return the inequalities of a nonempty region; none if every admissible point is stable."""
    samples = region.samples(())
    bounds = [RegionInequality(factor, "!=") for factor in region.surrounded()]
    bounds += _oriented(region.critical.proper, samples)
    listed = {bound.polynomial for bound in bounds} | {-bound.polynomial for bound in bounds}
    bounds += [
        RegionInequality(through[0], "!=") for through in region.through_holes() if not listed.intersection(through)
    ]
    waiting = _candidates(region.critical, samples)
    while True:
        missed = [sample for sample in samples if not sample.stable and _hold(bounds, sample)]
        if missed:
            bounds.append(_next(waiting, missed, samples))
            continue
        finer = region.samples(irreducible(bound.polynomial for bound in bounds))
        wrong = {b for b in bounds if any(s.stable and not b.at(s.point) for s in finer)}
        bounds = [bound for bound in bounds if bound not in wrong]
        samples = finer
        if not wrong and all(sample.stable or not _hold(bounds, sample) for sample in finer):
            break
    return _without_the_superfluous(bounds, samples, region.through_holes())


def is_exact(region: ExactRegion, bounds: Sequence[RegionInequality]) -> bool:
    """Return whether these inequalities hold exactly on the region."""
    factors = irreducible(bound.polynomial for bound in bounds)
    # these do not vanish anywhere in the region; of others a curve or a point inside might be left out by a list
    known = {*region.critical.factors, *irreducible(region.critical.conditions)}
    if not known.issuperset(factors):
        return False
    right = all(sample.stable == _hold(bounds, sample) for sample in region.samples(factors))
    cuts = all(factor in factors for factor in region.surrounded())
    holes = all(any(factor in factors for factor in through) for through in region.through_holes())
    return right and cuts and holes


def _hold(bounds: Iterable[RegionInequality], sample: Sample) -> bool:
    return all(bound.at(sample.point) for bound in bounds)


def _oriented(polynomials: Iterable[Scalar], samples: Sequence[Sample]) -> list[RegionInequality]:
    """Return the polynomials of constant sign at all stable samples, signed to be positive."""
    found = []
    for polynomial in polynomials:
        signs = {value_at(polynomial, sample.point) > 0 for sample in samples if sample.stable}
        if len(signs) == 1:
            found.append(RegionInequality(polynomial if signs.pop() else -polynomial))
    return found


def _candidates(critical: CriticalPolynomials, samples: Sequence[Sample]) -> list[RegionInequality]:
    """Return the factors of the conditions with constant sign on the region, and their cofactors, simple ones first."""
    found: dict[RegionInequality, None] = {}
    for condition in critical.conditions:
        if condition.is_constant:
            continue
        unit, factors = condition.factors()
        rest = Scalar.of(1 if sign_of(unit, {}) == "positive" else -1)
        for factor, power in factors:
            oriented = _oriented([factor], samples)
            if oriented:
                found |= dict.fromkeys(oriented)
                rest = rest if oriented[0].polynomial == factor or power % 2 == 0 else -rest
            elif power % 2:
                rest = rest * factor
        if not rest.is_constant:
            found[RegionInequality(rest)] = None
    return sorted(found, key=lambda bound: _length(bound.polynomial))


def _length(polynomial: Scalar) -> tuple[int, int]:
    return polynomial.degrees()[0], polynomial.size


def _next(waiting: list[RegionInequality], missed: Sequence[Sample], samples: Sequence[Sample]) -> RegionInequality:
    """Remove the simplest candidate that excludes a wrongly included point and no stable one."""
    for bound in waiting:
        stable = all(bound.at(sample.point) for sample in samples if sample.stable)
        if stable and not all(bound.at(sample.point) for sample in missed):
            waiting.remove(bound)
            return bound
    message = "the conditions of stability do not describe the region"
    raise AssertionError(message)


def _without_the_superfluous(
    bounds: Sequence[RegionInequality], samples: Sequence[Sample], holes: Sequence[tuple[Scalar, ...]]
) -> tuple[RegionInequality, ...]:
    """Drop implied inequalities, the longest first, except those that alone exclude a curve or a point."""
    kept = list(bounds)
    unstable = [sample for sample in samples if not sample.stable]
    for bound in sorted(bounds, key=lambda b: _length(b.polynomial), reverse=True):
        others = [other for other in kept if other is not bound]
        left = irreducible(other.polynomial for other in others)
        alone = any(not any(factor in left for factor in through) for through in holes)
        if bound.operator == ">" and not alone and not any(_hold(others, sample) for sample in unstable):
            kept = others
    return tuple(sorted(kept, key=lambda b: _length(b.polynomial)))
