"""Whether a picture shows what is true, as far as an eye can tell (trusted).

The points of a picture are rational and lie near what they stand for; how near is a fixed part of the window.  That a
curve passes by is seen from a change of sign.
"""

from __future__ import annotations

from collections import deque
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import TYPE_CHECKING

from symobs.certificate import SENSELESS, as_scalar
from symobs.derivation.places import within, written
from symobs.derivation.pole_paths import faults_of_poles
from symobs.derivation.properties import polynomial_of
from symobs.exact import RealNumber, Scalar, product_of
from symobs.exact.enclosure import sign_of_number
from symobs.exact.real import roots_of_scalar
from symobs.formula import Exact, evaluate
from symobs.formula.plain import plain_relation
from symobs.picture import LinePicture, PoleMap, RegionPicture, TimeResponse
from symobs.stability import stability

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.formula import Environment, Formula, Relation
    from symobs.picture import Curve, End, Interval, Picture, Place

#: Parts of a window: what is near a curve or an end, and what the middle of a drawn segment may lie off its curve.
_NEAR, _BETWEEN = Fraction(1, 500), Fraction(1, 50)
#: A condition of stability is all but zero where it is so much smaller than at the points around.
_SMALLER = 16
#: How many places in a row are asked for all over a window and beside a curve, and how far beside it.
_PLACES, _ASKED, _BESIDE = 7, 8, Fraction(1, 10_000)
#: The last pictures in which nothing was false, and of what: a page asks before it shows one, and again when it is
#: checked.  A picture cannot be changed, so the same one shows the same; another one of equal parts is looked at anew.
_FAITHFUL: deque[tuple[Picture, tuple[object, ...]]] = deque(maxlen=4)
_ON_SEGMENT = (Fraction(2, 7), Fraction(5, 9), Fraction(3, 4))
_ALONG = (Fraction(1, 10), Fraction(1, 2), Fraction(9, 10))
_SIGNS: dict[str, Callable[[Fraction], bool]] = {
    "positive": lambda value: value > 0,
    "negative": lambda value: value < 0,
    "nonnegative": lambda value: value >= 0,
    "nonpositive": lambda value: value <= 0,
    "nonzero": lambda value: value != 0,
    "real": lambda _: True,
}


def relations_of(picture: Picture) -> tuple[Relation, ...]:
    """Return the equations that are written into a picture."""
    return tuple(curve.equation for curve in picture.curves) if isinstance(picture, RegionPicture) else ()


def faults(picture: Picture, subject: Formula, environment: Environment, *, discrete: bool) -> Iterator[str]:
    """Yield what a picture shows that is not so."""
    if isinstance(picture, TimeResponse):
        from symobs.derivation.responses import faults_of_response  # noqa: PLC0415 - only pages with one pay for it

        if picture.discrete == discrete:
            yield from faults_of_response(picture, subject, environment)
        else:
            yield "another time"
        return
    numbers = dict(picture.drawn_for)
    for name, value in numbers.items():
        if not value.is_constant or not _SIGNS[environment.signs.get(name, "real")](value.fraction()):
            yield f"{name} = {value}"
    variable = environment.variable
    value = as_scalar(evaluate(subject, environment, Exact(environment)))
    polynomial = polynomial_of(value, environment).substitute(numbers)
    axes = (picture.moved,) if isinstance(picture, PoleMap) else _axes(picture)
    if not polynomial.names <= {variable, *axes}:
        yield f"the polynomial {polynomial} depends on {', '.join(axes)} alone"
        return
    equations = {relation: _difference(relation, environment, numbers) for relation in relations_of(picture)}
    of = polynomial, variable, discrete, dict(environment.signs), equations
    if any(seen is picture and held == of for seen, held in _FAITHFUL):
        return
    told = False
    test = _Test(polynomial, variable, axes, discrete, environment.signs)
    match picture:
        case RegionPicture():
            found = _of_region(picture, equations, test)
        case LinePicture():
            found = _of_line(picture, test)
        case _:
            found = faults_of_poles(picture, polynomial, variable, discrete=discrete)
    for fault in found:
        told = True
        yield fault
    if not told:
        _FAITHFUL.append((picture, of))


def is_faithful(picture: Picture, subject: Formula, environment: Environment, *, discrete: bool) -> bool:
    """Tell whether nothing that a picture shows is false."""
    try:
        return next(faults(picture, subject, environment, discrete=discrete), None) is None
    except SENSELESS:
        return False


def _axes(picture: RegionPicture | LinePicture) -> tuple[str, ...]:
    return picture.axes if isinstance(picture, RegionPicture) else (picture.axis,)


def _difference(relation: Relation, environment: Environment, numbers: dict[str, Scalar]) -> Scalar:
    """Return a polynomial that vanishes where the equation holds, each factor once; 1 where there is no equation."""
    if relation.operators != ("=",):
        return Scalar.of(1)
    left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in relation.members)
    factors = (left - right).substitute(numbers).numerator.factors()[1]
    return product_of(factor for factor, _ in factors)


class _Test:
    """Stability of one polynomial at points of the picture: the same question is asked again and again."""

    def __init__(
        self,
        polynomial: Scalar,
        variable: str,
        axes: tuple[str, ...],
        discrete: bool,  # noqa: FBT001
        signs: Mapping[str, str],
    ) -> None:
        self.allowed = [_SIGNS[signs.get(name, "real")] for name in axes]
        self.polynomial, self.variable, self.axes, self.discrete = polynomial, variable, axes, discrete
        self.degree = polynomial.degree(variable)

    def is_stable(self, *place: Fraction) -> bool:
        """Whether all roots are stable where the signs allow it; where the degree drops a root has gone to infinity."""
        if not all(allows(part) for allows, part in zip(self.allowed, place, strict=True)):
            return False
        try:
            there = self.polynomial.substitute(_at(self.axes, place))
        except ZeroDivisionError:
            return False
        if there.degree(self.variable) < self.degree:
            return False
        return stability(there, self.variable, {}, discrete=self.discrete).verdict == "yes"

    def is_excluded(self, place: tuple[Fraction, ...], around: Sequence[tuple[Fraction, ...]]) -> bool:
        """Whether a point is not stable, or one that is not lies near: there a condition all but vanishes."""
        if not self.is_stable(*place):
            return True
        conditions = stability(self.polynomial, self.variable, {}, discrete=self.discrete).positive
        leading = self.polynomial.coefficients(self.variable)[0]
        return any(
            _SMALLER * abs(_number(value, self.axes, place)) <= min(abs(_number(value, self.axes, p)) for p in around)
            for value in (leading, *conditions)
        )


def _at(axes: Sequence[str], place: Sequence[Fraction]) -> dict[str, Scalar]:
    return {name: Scalar.of(part) for name, part in zip(axes, place, strict=True)}


def _number(value: Scalar, axes: Sequence[str], place: Sequence[Fraction]) -> Fraction:
    return value.substitute(_at(axes, place)).fraction()


# -- regions ----------------------------------------------------------------------------------------------------------


def _of_region(picture: RegionPicture, equations: dict[Relation, Scalar], test: _Test) -> Iterator[str]:
    (left, right), (bottom, top) = picture.window
    width, height = right - left, top - bottom
    if width <= 0 or height <= 0:
        yield "the window is empty"
        return
    near = width * _NEAR, height * _NEAR
    between = width * _BETWEEN, height * _BETWEEN
    for curve in picture.curves:
        value = equations[curve.equation]
        if value.is_constant or not value.names <= set(picture.axes):
            yield f"{plain_relation(curve.equation, test.variable)} is the equation of a curve"
            continue
        middles = [_middle(a, b) for a, b in pairwise(curve.points)]
        inside = [place for place in middles if within(place, picture.window)]
        if not all(_passes(value, test.axes, place, near) for place in curve.points) or not all(
            _passes(value, test.axes, place, between) for place in inside
        ):
            yield plain_relation(curve.equation, test.variable)
        elif curve.boundary not in _are_boundaries(curve, picture.window, test):
            yield f"{plain_relation(curve.equation, test.variable)} is {'a' if curve.boundary else 'no'} boundary"
    drawn = list(equations.values())
    excluded = {mark.place for mark in picture.marks if mark.kind == "excluded"}
    for area in picture.areas:
        for place in area:
            if not within(place, picture.window, near):
                yield f"an edge at {written(place)}, outside of the window"
            elif not _on_border(place, picture.window, near):
                passes = any(_passes(value, test.axes, place, near) for value in drawn)
                if not passes:
                    yield f"an edge at {written(place)}"
        for place in _sloping(area, near):
            if not any(_passes(value, test.axes, place, between) for value in drawn):
                yield f"an edge at {written(place)}"
        samples = (place for place in _inside(area, near[0]) if place not in excluded)
        yield from (f"{written(place)} is stable" for place in samples if not test.is_stable(*place))
    for mark in picture.marks:
        x, y = mark.place
        around = [(x - near[0], y), (x + near[0], y), (x, y - near[1]), (x, y + near[1])]
        is_stable, is_filled = test.is_stable(x, y), any(_contains(area, mark.place) for area in picture.areas)
        agrees = {
            "stable": is_stable and is_filled,
            "unstable": not is_stable and not is_filled,
            "excluded": test.is_excluded((x, y), around),
        }
        if not agrees.get(mark.kind):
            yield f"{written(mark.place)} is {mark.kind}"
    for place in _grid(picture.window):
        is_apart = not any(_passes(value, test.axes, place, near) for value in drawn)
        if is_apart and test.is_stable(*place) != any(_contains(area, place) for area in picture.areas):
            yield f"{written(place)} is {'not ' if test.is_stable(*place) else ''}stable"


def _passes(value: Scalar, axes: Sequence[str], place: Place, step: Place) -> bool:
    """Whether the curve value = 0 has a point on the cross of half-width `step` at a place."""
    (x, y), (dx, dy) = place, step
    here = _sign(value, axes, place)
    ends = (x - dx, y), (x + dx, y), (x, y - dy), (x, y + dy)
    if any(here * _sign(value, axes, end) <= 0 for end in ends):
        return True
    return any(_has_root(value, axes, place, step, along) for along in (0, 1))


def _has_root(value: Scalar, axes: Sequence[str], place: Place, step: Place, along: int) -> bool:
    """Whether the curve meets one arm of the cross: where two branches are that close no sign changes."""
    on_line = value.substitute({axes[1 - along]: Scalar.of(place[1 - along])})
    if axes[along] not in on_line.names:
        return on_line.is_zero
    low, high = (RealNumber.of(place[along] + side * step[along]) for side in (-1, 1))
    return any(low <= root <= high for root in roots_of_scalar(on_line, axes[along]))


def _sign(value: Scalar, axes: Sequence[str], place: Place) -> int:
    """Return a number with the sign of a polynomial at a place: its value times a power of the denominators."""
    (a, c), (b, d) = ((part.numerator, part.denominator) for part in place)
    terms, i, j = _table(value, *axes)
    return sum(k * a**m * c ** (i - m) * b**n * d ** (j - n) for k, m, n in terms)


@lru_cache(maxsize=64)
def _table(value: Scalar, first: str, second: str) -> tuple[list[tuple[int, int, int]], int, int]:
    """Return the terms of a polynomial in two names as (coefficient, power, power), and both degrees."""
    terms = [(k, dict(powers).get(first, 0), dict(powers).get(second, 0)) for k, powers in value.terms()]
    return terms, value.degree(first), value.degree(second)


def _middle(a: Place, b: Place) -> Place:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _sloping(area: Sequence[Place], near: Place) -> Iterator[Place]:
    """Yield the middles of edges that can be seen to be parallel to no axis: they are parts of curves."""
    for a, b in zip(area, (*area[1:], area[0]), strict=True):
        if all(abs(p - q) > step for p, q, step in zip(a, b, near, strict=True)):
            yield _middle(a, b)


def _grid(window: tuple[Interval, Interval]) -> Iterator[Place]:
    """Yield places all over the window."""
    (left, right), (bottom, top) = window
    for i in range(_PLACES):
        for j in range(_PLACES):
            x, y = Fraction(97 * i + 41, 97 * _PLACES), Fraction(97 * j + 43, 97 * _PLACES)
            yield left + (right - left) * x, bottom + (top - bottom) * y


def _are_boundaries(curve: Curve, window: tuple[Interval, Interval], test: _Test) -> set[bool]:
    """Return whether a curve can be called a boundary, and whether it can be called none.

    At some of its points a place on either side is asked for; a boundary is what something stable lies beside.
    """
    width, height = (high - low for low, high in window)
    points = curve.points if len(curve.points) > 2 else _along(*curve.points)
    seen: set[bool] = set()
    for k in range(1, len(points) - 1, max(1, len(points) // _ASKED)):
        (x, y), (x0, y0), (x1, y1) = points[k], points[k - 1], points[k + 1]
        across = (y0 - y1) / height, (x1 - x0) / width
        if not any(across):
            continue  # it turns back here
        size = _BESIDE / max(map(abs, across))
        aside = across[0] * size * width, across[1] * size * height
        for place in ((x + aside[0], y + aside[1]), (x - aside[0], y - aside[1])):
            if within(place, window):
                seen.add(test.is_stable(*place))
    return {True in seen} if seen else {True, False}


def _along(a: Place, b: Place) -> tuple[Place, ...]:
    """Return places on a segment, ends included, none at its middle, where another curve may cross."""
    return tuple((a[0] + (b[0] - a[0]) * part, a[1] + (b[1] - a[1]) * part) for part in (0, *_ON_SEGMENT, 1))


def _on_border(place: Place, window: tuple[Interval, Interval], near: Place) -> bool:
    """Whether a place lies on the border of the window."""
    return any(
        part <= low + step or part >= high - step for part, (low, high), step in zip(place, window, near, strict=True)
    )


def _inside(area: Sequence[Place], near: Fraction) -> Iterator[Place]:
    """Yield places inside a polygon, at three heights three on every stretch; none on what is too short to be seen."""
    heights = [y for _, y in area]
    bottom, top = min(heights), max(heights)
    for k in (1, 2, 3):
        y = bottom + (top - bottom) * (Fraction(k, 4) + Fraction(1, 97))
        crossings = sorted(_crossings(area, y))
        for a, b in zip(crossings[::2], crossings[1::2], strict=True):
            if b - a > 2 * near:
                yield from ((a + (b - a) * part, y) for part in _ALONG)


def _crossings(area: Sequence[Place], y: Fraction) -> Iterator[Fraction]:
    """Yield where the edges of a polygon cross a horizontal line."""
    for (x0, y0), (x1, y1) in zip(area, (*area[1:], area[0]), strict=True):
        if (y0 <= y) != (y1 <= y):
            yield x0 + (x1 - x0) * (y - y0) / (y1 - y0)


def _contains(area: Sequence[Place], place: Place) -> bool:
    return sum(x < place[0] for x in _crossings(area, place[1])) % 2 == 1


# -- intervals --------------------------------------------------------------------------------------------------------


def _of_line(picture: LinePicture, test: _Test) -> Iterator[str]:
    low, high = picture.window
    near = (high - low) * _NEAR
    if near <= 0:
        yield "the window is empty"
        return
    drawn = [(a.place if a else low, b.place if b else high) for a, b in picture.pieces]
    borders = [low, *(part for piece in drawn for part in piece), high]
    if borders != sorted(borders):
        yield "the pieces follow one another"
    for a, b in drawn:
        yield from (f"{x} is stable" for x in _between(a, b) if not test.is_stable(x))
    for a, b in zip(borders[::2], borders[1::2], strict=True):
        if b - a > 2 * near:
            yield from (f"{x} is not stable" for x in _between(a, b) if test.is_stable(x))
    for (begin, end), (a, b) in zip(picture.pieces, drawn, strict=True):
        inward = min(near, (b - a) / 3)
        for found, step in ((begin, inward), (end, -inward)):
            if found is not None:
                yield from _of_end(found, step, near, dict(picture.drawn_for), test)
    for place, kind in picture.marks:
        around = [(place - near,), (place + near,)]
        is_stable = test.is_stable(place)
        agrees = {"stable": is_stable, "unstable": not is_stable, "excluded": test.is_excluded((place,), around)}
        if not agrees.get(kind):
            yield f"{place} is {kind}"


def _of_end(end: End, inward: Fraction, near: Fraction, numbers: dict[str, Scalar], test: _Test) -> Iterator[str]:
    """Stable on the inner side; on the outer not, unless the end alone is taken out."""
    outward = end.place - near if inward > 0 else end.place + near
    is_taken_out = test.is_excluded((end.place,), [(end.place - near,), (end.place + near,)])
    if not test.is_stable(end.place + inward) or (test.is_stable(outward) and not is_taken_out):
        yield f"{end.place} is an end"
    if not _is_labelled(end, near, numbers):
        yield f"{end.label} = {end.place}"


def _between(a: Fraction, b: Fraction) -> Iterator[Fraction]:
    return (a + (b - a) * Fraction(k, 8) for k in range(1, 8))


def _is_labelled(end: End, near: Fraction, numbers: dict[str, Scalar]) -> bool:
    """Whether what is written at an end is its place, as near as can be seen."""
    if isinstance(end.label, str):
        try:
            value = Scalar.of(Fraction(end.label.strip("≈… ").replace("−", "-")))
        except ValueError:
            return False
    else:
        value = end.label.substitute(numbers)
    above, below = value - (end.place - near), (end.place + near) - value
    return all(
        difference.fraction() >= 0 if difference.is_constant else sign_of_number(difference) == "positive"
        for difference in (above, below)
    )
