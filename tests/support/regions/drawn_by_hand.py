"""Pictures made for tests, by means of their own: numpy's roots between the critical places, rounded to fractions."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from symobs.exact import Scalar
from symobs.formula.figures import Curve, End, LinePicture, MarkedPoint, PoleMap, RegionPicture
from symobs.formula.tree import Literal, Relation

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from symobs.formula.figures import Place

    Window = tuple[tuple[int, int], tuple[int, int]]
    Branch = tuple[list[Place], int]

s, z, h1, h2, k, b, omega = (Scalar.symbol(name) for name in ("s", "z", "h1", "h2", "k", "b", "omega"))
#: Nodes in a cylinder.
_NODES = 48


def fraction(value: float) -> Fraction:
    return Fraction(round(value * 10**7), 10**7)


def equation(left: Scalar | int, right: Scalar | int) -> Relation:
    return Relation((Literal(Scalar.of(left)), Literal(Scalar.of(right))), ("=",))


def at(value: Scalar, **numbers: Fraction) -> Scalar:
    return value.substitute({name: Scalar.of(number) for name, number in numbers.items()})


def real_roots(coefficients: Sequence[float]) -> list[float]:
    found = np.roots(np.trim_zeros(np.array(coefficients, dtype=float), "f"))
    return sorted(float(root.real) for root in found if abs(root.imag) < 1e-6)


def heights(curve: Scalar, x: Fraction) -> list[float]:
    there = at(curve, h1=x)
    return real_roots([float(c.fraction()) for c in there.coefficients("h2")]) if there.degree("h2") > 0 else []


def is_stable(chi: Scalar, *, discrete: bool, **numbers: Fraction) -> bool:
    (variable,) = chi.names & {"s", "z"}
    roots = np.roots([float(c.fraction()) for c in at(chi, **numbers).coefficients(variable)])
    return bool(max(abs(roots)) < 1) if discrete else bool(max(roots.real) < 0)


def critical(curves: Sequence[Scalar], window: Window) -> list[float]:
    """Where the number of branches may change, two cross, or one leaves the window; by halving, but for the last."""
    low, high = window[0]

    def pattern(x: Fraction) -> tuple[int, ...]:
        found = sorted((y, place) for place, curve in enumerate(curves) for y in heights(curve, x))
        return tuple(place for _, place in found)

    grid = [fraction(low + (high - low) * (j + 0.37) / 200) for j in range(-1, 200)]
    changes: list[float] = [low]
    for first, second in pairwise(grid):
        a, c = first, second
        before = pattern(a)
        if before == pattern(c):
            continue
        while c - a > Fraction(1, 10**6):
            middle = fraction(float(a + c) / 2)
            a, c = (middle, c) if pattern(middle) == before else (a, middle)
        changes.append(float(a + c) / 2)
    leading = [curve.coefficients("h2")[0] for curve in curves]
    walls = [x for value in leading for x in real_roots(_numbers(value, "h1")) if "h1" in value.names]
    cut = [at(curve, h2=Fraction(y)) for curve in curves for y in window[1]]
    leaving = [x for value in cut for x in real_roots(_numbers(value, "h1")) if "h1" in value.names]
    inside = [x for x in (*changes[1:], *walls, *leaving) if low < x < high]
    return sorted({low, *inside, high})


def _numbers(curve: Scalar, name: str) -> list[float]:
    return [float(c.fraction()) for c in curve.coefficients(name)]


def region(
    chi: Scalar,
    curves: dict[Scalar, Relation],
    window: Window,
    *,
    discrete: bool = False,
    excluded: Sequence[Place] = (),
    marked: bool = True,
) -> RegionPicture:
    """Cells between the branches of the curves, cylinder by cylinder."""
    (_, _), (bottom, top) = window
    areas: list[tuple[Place, ...]] = []
    drawn: list[Curve] = []
    marks: list[MarkedPoint] = [MarkedPoint(place, "excluded") for place in excluded]
    for left, right in pairwise(critical(list(curves), window)):
        nodes = [
            fraction(left + (right - left) * (1 - np.cos(np.pi * (j + 0.2) / (_NODES + 0.4))) / 2)
            for j in range(_NODES + 1)
        ]
        middle = nodes[_NODES // 2]
        branches = list(_branches(curves, nodes))
        lines = [[(x, Fraction(bottom)) for x in nodes], *(points for points, _ in branches)]
        lines.append([(x, Fraction(top)) for x in nodes])
        lines = [[(fraction(left), line[0][1]), *line[1:-1], (fraction(right), line[-1][1])] for line in lines]
        lines = [[(x, min(max(y, Fraction(bottom)), Fraction(top))) for x, y in line] for line in lines]
        verdicts = []
        for below, above in pairwise(lines):
            y0, y1 = below[_NODES // 2][1], above[_NODES // 2][1]
            stable = is_stable(chi, discrete=discrete, h1=middle, h2=(2 * y0 + 3 * y1) / 5)
            verdicts.append(stable)
            if stable and any(low[1] != high[1] for low, high in zip(below, above, strict=True)):
                areas.append((*below, *reversed(above)))
            if marked and y1 - y0 > Fraction(top - bottom, 12) and right - left > (window[0][1] - window[0][0]) / 12:
                marks.append(MarkedPoint((middle, (2 * y0 + 3 * y1) / 5), "stable" if stable else "unstable"))
        for (points, place), low, high in zip(branches, verdicts, verdicts[1:], strict=False):
            if any(bottom < y < top for _, y in points):
                drawn.append(Curve(tuple(points), list(curves.values())[place], boundary=low != high))
    for curve, relation in curves.items():
        if "h2" not in curve.names:
            walls = map(fraction, real_roots(_numbers(curve, "h1")))
            drawn += [Curve(((x, Fraction(bottom)), (x, Fraction(top))), relation) for x in walls]
    exact = tuple((Fraction(low), Fraction(high)) for low, high in window)
    return RegionPicture(("h1", "h2"), (exact[0], exact[1]), tuple(areas), tuple(drawn), tuple(marks))


def _branches(curves: dict[Scalar, Relation], nodes: Sequence[Fraction]) -> Iterator[Branch]:
    """The k-th roots over all nodes, sorted from below."""
    found: list[Branch] = []
    for place, curve in enumerate(curves):
        stacks = [heights(curve, x) for x in nodes]
        for index in range(len(stacks[_NODES // 2])):
            pairs = zip(nodes, stacks, strict=True)
            found.append(([(x, fraction(stack[index])) for x, stack in pairs if len(stack) > index], place))
    full = [(points, place) for points, place in found if len(points) == len(nodes)]
    yield from sorted(full, key=lambda branch: branch[0][_NODES // 2][1])


# -- regions ----------------------------------------------------------------------------------------------------------

HYPERBOLA = s**3 + h1 * s**2 + h2 * s + 1
PENDULUM = s**2 + (b + h2) * s + omega**2 * (1 - h1)
ANNULUS = s**2 + (5 - h1**2 - h2**2) * s + h1**2 + h2**2 - 1
RING = s**2 + s + h1**2 + h2**2
DISC_CUBIC = s**3 + (2 + h1) * s**2 + (h1**2 + h2**2 - 4) * s + h1 * h2 + 1
JURY2 = z**2 + h1 * z + h2
JURY4 = z**4 + h1 * z**3 + h2 * z + Scalar.rational(1, 8)
QUINTIC = s**5 + 3 * s**4 + (5 + h1) * s**3 + (6 + h2) * s**2 + (4 + h1 - h2) * s + 1 + h2


@cache
def hyperbola() -> RegionPicture:
    return region(HYPERBOLA, {h1 * h2 - 1: equation(h1 * h2, 1)}, ((-1, 5), (-1, 5)))


@cache
def pendulum() -> RegionPicture:
    """Two walls whose equations keep their symbols: h1 = 1 and h2 = −b."""
    chi = at(PENDULUM, b=Fraction(1), omega=Fraction(1))
    curves = {1 - h1: equation(h1, 1), h2 + 1: equation(h2, -b)}
    found = region(chi, curves, ((-3, 3), (-3, 3)))
    return RegionPicture(
        found.axes, found.window, found.areas, found.curves, found.marks, (("b", Scalar.of(1)), ("omega", Scalar.of(1)))
    )


@cache
def annulus() -> RegionPicture:
    curves = {h1**2 + h2**2 - 1: equation(h1**2 + h2**2, 1), h1**2 + h2**2 - 5: equation(h1**2 + h2**2, 5)}
    return region(ANNULUS, curves, ((-3, 3), (-3, 3)))


@cache
def ring_hole() -> RegionPicture:
    return region(RING, {h1**2 + h2**2 + 1: equation(0, 1)}, ((-2, 2), (-2, 2)), excluded=[(Fraction(0), Fraction(0))])


@cache
def three_components() -> RegionPicture:
    cubic = h1**3 + 2 * h1**2 + h1 * h2**2 - h1 * h2 - 4 * h1 + 2 * h2**2 - 9
    curves = {h1 * h2 + 1: equation(h1 * h2, -1), cubic: equation(cubic, 0)}
    return region(DISC_CUBIC, curves, ((-4, 5), (-4, 5)))


@cache
def triangle() -> RegionPicture:
    curves = {h2 - 1: equation(h2, 1), h2 - h1 + 1: equation(h2, h1 - 1), h2 + h1 + 1: equation(h2, -h1 - 1)}
    return region(JURY2, curves, ((-3, 3), (-2, 2)), discrete=True, marked=False)


@cache
def fourth_order() -> RegionPicture:
    conic = 64 * h1**2 - 576 * h1 * h2 + 512 * h2**2 - 441
    curves = {
        8 * h1 + 8 * h2 + 9: equation(8 * h1 + 8 * h2, -9),
        8 * h1 + 8 * h2 - 9: equation(8 * h1 + 8 * h2, 9),
        conic: equation(64 * h1**2 - 576 * h1 * h2 + 512 * h2**2, 441),
    }
    return region(JURY4, curves, ((-2, 2), (-2, 2)), discrete=True)


@cache
def fifth_order() -> RegionPicture:
    long = 6 * h1**2 - 3 * h1 * h2**2 - 2 * h1 * h2 + 36 * h1 + h2**3 - 18 * h2**2 + 6 * h2 + 50
    curves = {h2 + 1: equation(h2, -1), 3 * h1 - h2 + 9: equation(h2, 3 * h1 + 9), long: equation(long, 0)}
    return region(QUINTIC, curves, ((-6, 20), (-4, 12)))


# -- lines and poles --------------------------------------------------------------------------------------------------


@cache
def interval() -> LinePicture:
    """s³ + 6 s² + 11 s + 6 + k is stable for −6 < k < 60."""
    ends = (End(Fraction(-6), Scalar.of(-6)), End(Fraction(60), Scalar.of(60)))
    marks = ((Fraction(27), "stable"), (Fraction(-9), "unstable"), (Fraction(63), "unstable"))
    return LinePicture("k", (Fraction(-14), Fraction(70)), (ends,), marks)


INTERVAL = s**3 + 6 * s**2 + 11 * s + 6 + k
PIECES = s**2 + s + (k + 2) * k * (k - 1) ** 2 * (k - 4) * (3 * k - 13)


@cache
def four_pieces() -> LinePicture:
    places = (Scalar.of(-2), Scalar.of(0), Scalar.of(1), Scalar.of(4), Scalar.rational(13, 3))
    a, c, d, e, f = (End(place.fraction(), place) for place in places)
    pieces: tuple[tuple[End | None, End | None], ...] = ((None, a), (c, d), (d, e), (f, None))
    return LinePicture("k", (Fraction(-4), Fraction(7)), pieces, ((Fraction(-1), "unstable"), (Fraction(2), "stable")))


def pole_map(
    chi: Scalar,
    values: tuple[int, int],
    window: Window,
    *,
    steps: int = 80,
    through: tuple[str, ...] = (),
    **circle: Fraction,
) -> PoleMap:
    """The roots of chi as k goes along, followed by nearness."""
    (variable,) = chi.names & {"s", "z"}
    begin, end = values
    even = (Fraction(begin) + Fraction(end - begin) * j / steps for j in range(steps + 1))
    along = tuple(sorted({*even, *map(Fraction, through)}))
    stacks: list[list[complex]] = []
    for value in along:
        roots = [
            complex(root) for root in np.roots([float(c.fraction()) for c in at(chi, k=value).coefficients(variable)])
        ]
        stacks.append(_nearest(stacks[-1], roots) if stacks else sorted(roots, key=lambda root: (root.real, root.imag)))
    paths = tuple(tuple((fraction(p.real), fraction(p.imag)) for p in path) for path in zip(*stacks, strict=True))
    exact = tuple((Fraction(low), Fraction(high)) for low, high in window)
    return PoleMap(
        variable,
        "k",
        (Fraction(begin), Fraction(end)),
        paths,
        (exact[0], exact[1]),
        discrete=variable == "z",
        along=(along,) * len(paths),
        margin=circle.get("margin"),
        radius=circle.get("radius"),
    )


def _nearest(before: Sequence[complex], roots: list[complex]) -> list[complex]:
    left = list(roots)
    found = []
    for place in before:
        near = min(left, key=lambda root: abs(root - place))
        left.remove(near)
        found.append(near)
    return found


SECOND_ORDER = s**2 + s + k
THIRD_ORDER = s * (s + 1) * (s + 3) + k
SAMPLED = z**2 - Scalar.rational(3, 2) * z + Scalar.rational(1, 2) + k * (z + 1) / 10


@cache
def second_order() -> PoleMap:
    return pole_map(SECOND_ORDER, (0, 2), ((-3, 1), (-2, 2)))


@cache
def third_order() -> PoleMap:
    return pole_map(THIRD_ORDER, (0, 20), ((-5, 2), (-4, 4)), through=("0.6311303",), margin=Fraction(1, 2))


@cache
def sampled() -> PoleMap:
    return pole_map(SAMPLED, (0, 6), ((-2, 2), (-2, 2)), radius=Fraction(1))


#: Each picture with the polynomial it is a picture of, and whether time is discrete.
ALL: dict[str, tuple[Callable[[], RegionPicture | LinePicture | PoleMap], Scalar, bool]] = {
    "hyperbola": (hyperbola, HYPERBOLA, False),
    "pendulum": (pendulum, PENDULUM, False),
    "annulus": (annulus, ANNULUS, False),
    "three_components": (three_components, DISC_CUBIC, False),
    "triangle": (triangle, JURY2, True),
    "fourth_order": (fourth_order, JURY4, True),
    "fifth_order": (fifth_order, QUINTIC, False),
    "ring_hole": (ring_hole, RING, False),
    "interval": (interval, INTERVAL, False),
    "four_pieces": (four_pieces, PIECES, False),
    "second_order": (second_order, SECOND_ORDER, False),
    "third_order": (third_order, THIRD_ORDER, False),
    "sampled": (sampled, SAMPLED, True),
}
