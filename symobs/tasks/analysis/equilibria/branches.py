"""The picture of equilibria over the one parameter that is left: branches, their stability, and exact branch points."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from math import cos, pi
from typing import TYPE_CHECKING, Any

from symobs.exact import Scalar
from symobs.exact.algebraic.enclosure import near, sign_of_number
from symobs.exact.algebraic.real_algebraic import RealNumber, rational_between, roots_of_scalar
from symobs.exact.core.generators import NotWritten, all_roots, functions_in, symbols_in
from symobs.formula.figures import Branch, BranchPicture
from symobs.stability.criteria.stability import stability
from symobs.stability.plots import range_around
from symobs.system.motion import with_primes

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.figures import Interval, Place
    from symobs.system.equilibria import Equilibrium

#: Points of a piece of a branch; they crowd towards its ends, where branches turn.
_POINTS = 32
#: The ends of a piece are this part of its width inside of it.
_INSIDE = Fraction(1, 1 << 16)
_HOLDS = {">": {"positive"}, ">=": {"positive"}, "!=": {"positive", "negative"}}
_MOST = 8


def picture_of(result: Any) -> BranchPicture | None:
    """Return the branches over a parameter; None where there are none or several, or nothing changes with it."""
    given = result.given
    signals = {*given.states, *given.inputs}
    parameters = symbols_in(given.f) - signals - {"pi"}
    points = result.found.points
    if len(parameters) != 1 or not 0 < len(points) <= _MOST:
        return None
    (parameter,) = parameters
    drawn = next((name for name in given.states if len({str(result.values_at(p)[name]) for p in points}) > 1), None)
    if drawn is None:
        return None
    try:
        critical = sorted(_critical(result, parameter))
        return _picture(result, parameter, drawn, critical) if critical else None
    except (NotWritten, ZeroDivisionError, _NoPicture):
        return None


class _NoPicture(Exception):
    """There is none that would be exact at its branch points."""


def _critical(result: Any, parameter: str) -> set[RealNumber]:
    """Return the values of the parameter at which a branch begins or ends, or its stability changes."""
    sign = result.plant.symbols.sign(parameter)
    found: set[RealNumber] = set()
    for point in result.found.points:
        values = [condition.expression for condition in point.conditions]
        if (polynomial := result.polynomial_at(point)) is not None:
            values += stability(
                polynomial, result.plant.variable, result.signs_at_rest, discrete=result.plant.is_discrete
            ).positive
        for value in map(_without_root, values):
            if functions_in([value]) or not symbols_in(value) <= {parameter}:
                raise _NoPicture
            for part in (value.numerator, value.denominator):
                for factor, _ in part.factors()[1]:
                    found |= {root for root in roots_of_scalar(factor, parameter) if _allowed(root, sign)}
    return found


def _without_root(value: Scalar) -> Scalar:
    """Return what vanishes where a number times one square root does: its radicand; any other value as it is."""
    _, factors = value.factors()
    if len(factors) == 1 and (roots := all_roots(value)) and len(roots) == 1:
        (root,) = roots
        return root.argument if factors[0][0] in {root.value, -root.value} else value
    return value


def _allowed(root: RealNumber, sign: str) -> bool:
    """Return whether a parameter of this sign can have a value."""
    if sign in {"positive", "nonnegative"}:
        return root.sign >= 0
    return sign not in {"negative", "nonpositive"} or root.sign <= 0


def _picture(result: Any, parameter: str, drawn: str, critical: Sequence[RealNumber]) -> BranchPicture | None:
    across = _across([_middle(root) for root in critical], result.plant.symbols.sign(parameter))
    inner = [root for root in critical if across[0] < _middle(root) < across[1]]
    ends = [RealNumber.of(across[0]), *inner, RealNumber.of(across[1])]
    branches, touching = list[Branch](), dict[RealNumber, set[Fraction]]()
    for point in result.found.points:
        for low, high in pairwise(ends):
            branch = _branch(result, point, parameter, drawn, (low, high))
            if branch is not None:
                branches.append(branch)
                for end in {low, high} & {*inner}:
                    touching.setdefault(end, set()).add(_height_at(branch, parameter, drawn, end))
    if not branches:
        return None
    upwards = _upwards([y for branch in branches for _, y in branch.points])
    branches = [kept for branch in branches if (kept := _within(branch, upwards)) is not None]
    step = (upwards[1] - upwards[0]) / 100
    marks = [
        ((_middle(root), y), root.scalar())
        for root in inner
        for y in _apart(sorted(touching.get(root, ())), step)
        if upwards[0] <= y <= upwards[1] and _changes(branches, _middle(root), y, across, step)
    ]
    return BranchPicture(
        (parameter, with_primes(drawn)),
        result.given.states,
        (across, upwards),
        tuple(branches),
        tuple(marks),
        result.plant.is_discrete,
    )


def _across(critical: Sequence[Fraction], sign: str) -> Interval:
    """Return the range of the parameter, the critical values well inside."""
    low, high = range_around(critical, spread=True)
    room = max(high - low, *map(abs, critical), Fraction(1, 10))
    low, high = low - room / 2, high + room / 2
    low, high = (x.limit_denominator(1000) for x in range_around([low, high], spread=True))
    if sign in {"positive", "nonnegative"}:
        return Fraction(0), high
    return (low, Fraction(0)) if sign in {"negative", "nonpositive"} else (low, high)


def _upwards(heights: Sequence[Fraction]) -> Interval:
    return range_around(
        heights, spread=max(map(abs, heights)) < 20 * (sorted(map(abs, heights))[len(heights) // 2] + 1)
    )


def _middle(root: RealNumber) -> Fraction:
    low, high = root.interval()
    return (low + high) / 2


def _branch(
    result: Any, point: Equilibrium, parameter: str, drawn: str, ends: tuple[RealNumber, RealNumber]
) -> Branch | None:
    """Return the piece of a branch between two values of the parameter; None where there is none."""
    middle = rational_between(*ends)
    numbers = {parameter: Scalar.of(middle)}
    if not all(
        sign_of_number(c.expression.substitute(numbers)) in _HOLDS.get(c.operator, ()) for c in point.conditions
    ):
        return None
    polynomial = result.polynomial_at(point)
    if polynomial is None:
        raise _NoPicture
    verdict = stability(
        polynomial.substitute(numbers), result.plant.variable, {}, discrete=result.plant.is_discrete
    ).verdict
    if verdict not in {"yes", "no"}:
        raise _NoPicture
    at = {name: value for name, value in result.values_at(point).items() if value != Scalar.symbol(name)}
    places = [*_places(at[drawn], parameter, ends)]
    return Branch(tuple(at.items()), tuple(places), verdict == "yes")


def _places(value: Scalar, parameter: str, ends: tuple[RealNumber, RealNumber]) -> Iterator[Place]:
    low, high = ends[0].interval()[1], ends[1].interval()[0]
    for k in range(_POINTS + 1):
        part = Fraction(round((1 - cos(pi * k / _POINTS)) * (1 << 29)), 1 << 30)
        x = low + (high - low) * min(max(part, _INSIDE), 1 - _INSIDE)
        x = x.limit_denominator(1 << 24)
        height = near(value.substitute({parameter: Scalar.of(x)}))
        if height is None:
            raise _NoPicture
        yield x, height.limit_denominator(1 << 24)


def _height_at(branch: Branch, parameter: str, drawn: str, end: RealNumber) -> Fraction:
    """Return the height of a branch at an end of its piece."""
    found = near(dict(branch.at)[drawn].substitute({parameter: end.scalar()}))
    if found is None:
        raise _NoPicture
    return found.limit_denominator(1 << 24)


def _within(branch: Branch, upwards: Interval) -> Branch | None:
    """Return the part of a branch inside the window; None where that is short."""
    kept = [place for place in branch.points if upwards[0] <= place[1] <= upwards[1]]
    return Branch(branch.at, tuple(kept), branch.stable) if len(kept) > _POINTS // 4 else None


def _apart(heights: Sequence[Fraction], step: Fraction) -> list[Fraction]:
    """Return heights without those that lie near the one before."""
    found: list[Fraction] = []
    for height in heights:
        if not found or height - found[-1] > step:
            found.append(height)
    return found


def _changes(branches: Sequence[Branch], x: Fraction, y: Fraction, across: Interval, step: Fraction) -> bool:
    """Return whether branches begin, end, cross or change their stability at a place."""
    close = (across[1] - across[0]) / 100
    before = [b.stable for b in branches if abs(b.points[-1][0] - x) < close and abs(b.points[-1][1] - y) <= step]
    behind = [b.stable for b in branches if abs(b.points[0][0] - x) < close and abs(b.points[0][1] - y) <= step]
    return before != behind or len(before) != 1
