"""What a derivation says of regions, held at points against the roots: nothing of `symobs.stability` takes part.

Stability is Routh's or Schur and Cohn's scheme in plain fractions, square roots and `CRootOf` are compared exactly
(`tests.support.regions.region_roots`).  Points are small integers, small fractions, and some far out.
"""

from __future__ import annotations

import random
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import comb
from typing import TYPE_CHECKING, Any, TypeAlias

from flint import fmpz_poly

from symobs.exact import Scalar
from symobs.exact.core.generators import function_named
from symobs.formula.figures import LinePicture, PoleMap, RegionPicture
from symobs.formula.phrases.languages import ENGLISH
from symobs.formula.tree import Literal, Relation
from tests.support.algebra import (
    characteristic,
    coefficients_at,
    is_stable,
    multiply,
    value_at,
)
from tests.support.regions.region_roots import (
    Root,
    UndefinedError,
    primitive,
    real_roots,
    root_of,
    sign,
)
from tests.support.regions.region_texts import Binary, Call, Number, expression

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.formula.figures import Curve, Place
    from symobs.formula.tree import Formula
    from symobs.proof.derivation import Sentence
    from symobs.stability.criteria.routh_table import RouthTable
    from symobs.tasks.analysis.stability_region.stability_region import StabilityRegion
    from tests.support.derivations import World

#: How many points a statement is held at, and of how many a picture.
POINTS, IN_A_PICTURE = 60, 40
#: Parts of a window that cannot be seen, and what a pole may lie off its path.
NEAR, NEAR_POLE = Fraction(1, 250), Fraction(1, 100)
ORDINALS = ("first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth", "ninth", "tenth")


def points(
    names: Sequence[str], signs: Mapping[str, str], seed: object, number: int = POINTS
) -> Iterator[dict[str, Fraction]]:
    """Yield points that the signs allow."""
    draw = random.Random(f"{seed} {sorted(names)}")  # noqa: S311 - repeatable by design
    for _ in range(number):
        kind = draw.random()
        yield {name: _drawn(draw, kind, signs.get(name, "real")) for name in sorted(names)}


def _drawn(draw: random.Random, kind: float, sign: str) -> Fraction:
    if kind < 0.35:
        value = Fraction(draw.randint(-5, 5))
    elif kind < 0.9:
        value = Fraction(draw.randint(-300, 300), draw.randint(40, 160))
    else:
        value = Fraction(draw.randint(-700, 700), draw.randint(1, 9))
    if sign in {"positive", "negative", "nonzero"} and not value:
        value = Fraction(1, draw.randint(1, 9))
    if sign in {"positive", "nonnegative"}:
        return abs(value)
    return -abs(value) if sign in {"negative", "nonpositive"} else value


# -- relations ---------------------------------------------------------------------------------------------------------

HOLDS: dict[str, Callable[[int], bool]] = {
    "<": lambda found: found < 0,
    "<=": lambda found: found <= 0,
    ">": lambda found: found > 0,
    ">=": lambda found: found >= 0,
    "=": lambda found: found == 0,
    "!=": lambda found: found != 0,
}


def text(formula: Formula) -> str:
    """Return a value as a text; a sum or product of letters is none."""
    if not isinstance(formula, Literal) or not isinstance(formula.value, Scalar):
        raise TypeError(formula)
    return str(formula.value)


def holds(relation: Relation, point: Mapping[str, Fraction]) -> bool:
    """Tell whether a chain of values is in order at a point; where one is undefined it is not."""
    values = [expression(text(member)) for member in relation.members]
    try:
        return all(
            HOLDS[operator](sign(Binary("-", left, right), point))
            for (left, right), operator in zip(pairwise(values), relation.operators, strict=True)
        )
    except UndefinedError:
        return False


def all_hold(relations: Sequence[Relation], point: Mapping[str, Fraction]) -> bool:
    return all(holds(relation, point) for relation in relations)


def number_of(name: str) -> Fraction:
    """Return a `CRootOf` as a fraction next to it: off by less than 10⁻¹⁰⁰."""
    node = expression(name)
    assert isinstance(node, Call)
    root = root_of(node, {})
    root.narrow(Fraction(1, 10**100))
    return (root.low + root.high) / 2


# -- findings ----------------------------------------------------------------------------------------------------------


def is_so(
    finding: Sentence,
    stable: Callable[[Mapping[str, Fraction]], bool],
    samples: Sequence[dict[str, Fraction]],
    names: Sequence[str],
) -> bool:
    """Tell whether what can be held at points is so; numbers of cells and pieces are told as words only."""
    slots: dict[str, Any] = dict(finding.slots)
    match finding.key:
        case "region_empty":
            return not any(map(stable, samples))
        case "box_bounded" | "box_unbounded":
            return _is_convex(stable, samples, names)
        case "point_missing":
            name, place = text(slots["name"]), Fraction(text(slots["point"]))
            return not stable({name: place}) and all(stable({name: place + d}) for d in _small())
        case "hole":
            pair = [text(slots[key]) for key in ("first", "second")]
            centre = [Fraction(text(slots[key])) for key in ("x", "y")]
            around = [(x, y) for d in _small() for x, y in ((centre[0] + d, centre[1]), (centre[0], centre[1] + d))]
            return not stable(dict(zip(pair, centre, strict=True))) and all(
                stable(dict(zip(pair, other, strict=True))) for other in around
            )
        case "number_is_root":
            return _is_root(slots["number"], ENGLISH.put(slots["which"]), slots["equation"])
    return True


def _small() -> tuple[Fraction, Fraction]:
    return Fraction(-1, 10**9), Fraction(1, 10**9)


def _is_convex(
    stable: Callable[[Mapping[str, Fraction]], bool], samples: Sequence[dict[str, Fraction]], names: Sequence[str]
) -> bool:
    """Tell whether with two points their middle is stable, the other symbols being the same."""
    inside = [point for point in samples if stable(point)][:12]
    moved = [(a, {**a, **{name: b[name] for name in names}}) for a in inside for b in inside]
    return all(stable({name: (a[name] + b[name]) / 2 for name in a}) for a, b in moved if stable(b))


def _is_root(number: Literal, which: str, equation: Relation) -> bool:
    """Tell whether a number is this root of its equation, the real roots counted from the left."""
    right = expression(text(equation.members[1]))
    assert isinstance(equation.members[0], Literal)
    (name,) = equation.members[0].value.names
    here = number_of(text(number))
    coefficients = coefficients_at(equation.members[0].value, name, {})  # type: ignore[arg-type]
    roots = real_roots(coefficients)
    place = next((k for k, root in enumerate(roots) if _is_at(root, here)), None)
    told = "the only real root" if len(roots) == 1 else f"the {ORDINALS[place or 0]} real root from the left"
    return right == Number(Fraction(0)) and place is not None and which == told


def _is_at(root: Root, here: Fraction) -> bool:
    root.narrow(Fraction(1, 10**80))
    return abs((root.low + root.high) / 2 - here) < Fraction(1, 10**70)


# -- pictures ----------------------------------------------------------------------------------------------------------


class Seen:
    """Stability of a polynomial at places of a picture."""

    def __init__(
        self,
        polynomial: Scalar,
        variable: str,
        axes: Sequence[str],
        drawn_for: Mapping[str, Fraction],
        *,
        discrete: bool,
    ) -> None:
        self.parts, self.axes, self.drawn_for = polynomial.coefficients(variable), axes, drawn_for
        self.polynomial, self.variable, self.discrete = polynomial, variable, discrete
        self.verdicts: dict[tuple[Fraction, ...], bool] = {}
        self.signs: dict[Relation, dict[tuple[Place, Place], set[int]]] = {}

    def coefficients(self, *place: Fraction) -> list[Fraction]:
        point = {**self.drawn_for, **dict(zip(self.axes, place, strict=True))}
        return coefficients_at(self.polynomial, self.variable, point)

    def stable(self, *place: Fraction) -> bool:
        if place not in self.verdicts:
            self.verdicts[place] = is_stable(self.coefficients(*place), discrete=self.discrete)
        return self.verdicts[place]

    def signs_around(self, equation: Relation) -> Callable[[Place, Place], set[int]]:
        """Return what tells the signs of left − right at a place and on the ends of its cross, once of each place."""
        known = self.signs.setdefault(equation, {})

        def signs(place: Place, step: Place) -> set[int]:
            if (place, step) not in known:
                points = ({**self.drawn_for, **dict(zip(self.axes, p, strict=True))} for p in _cross(place, step))
                known[place, step] = {sign_at(equation, point) for point in points}
            return known[place, step]

        return signs

    def around(self, step: Sequence[Fraction], *place: Fraction) -> set[bool]:
        """Return what is said of a place and of those a step away."""
        moved = [place]
        for index, by in enumerate(step):
            moved += [(*place[:index], place[index] + d, *place[index + 1 :]) for d in (-by, by)]
        return {self.stable(*other) for other in moved}


OfPolynomial: TypeAlias = RegionPicture | LinePicture | PoleMap


@lru_cache(maxsize=32)
def all_faults(picture: OfPolynomial, polynomial: Scalar, variable: str, discrete: bool) -> tuple[str, ...]:  # noqa: FBT001
    """Return what a picture shows that is not so: the same at every random point."""
    return tuple(faults(picture, polynomial, variable, discrete=discrete))


def faults(picture: OfPolynomial, polynomial: Scalar, variable: str, *, discrete: bool) -> Iterator[str]:
    """Yield what a picture shows that is not so."""
    axes = (
        (picture.moved,)
        if isinstance(picture, PoleMap)
        else picture.axes
        if isinstance(picture, RegionPicture)
        else (picture.axis,)
    )
    seen = _seen(polynomial, variable, axes, picture.drawn_for, discrete)
    if isinstance(picture, RegionPicture):
        yield from _of_region(picture, seen)
    elif isinstance(picture, LinePicture):
        yield from _of_line(picture, seen)
    else:
        yield from _of_poles(picture, seen)


@lru_cache(maxsize=4)
def _seen(
    polynomial: Scalar,
    variable: str,
    axes: tuple[str, ...],
    drawn_for: tuple[tuple[str, Scalar], ...],
    discrete: bool,  # noqa: FBT001
) -> Seen:
    """Return what is known of a polynomial: pictures that differ in one place ask it for the same."""
    numbers = {name: Fraction(str(value)) for name, value in drawn_for}
    return Seen(polynomial, variable, axes, numbers, discrete=discrete)


def _of_marks(marks: Sequence[tuple[tuple[Fraction, ...], str]], seen: Seen, step: Sequence[Fraction]) -> Iterator[str]:
    for place, kind in marks:
        stable = seen.stable(*place)
        if kind == "excluded":
            # No more can be seen than that a place which does not belong to the region lies within a 4000th of the window.
            around = {verdict for by in (16, 10**4) for verdict in seen.around([part / by for part in step], *place)}
            if stable and around == {True} and not _nearly_unstable(seen.coefficients(*place), seen.discrete):
                yield f"{place} is excluded"
        elif (kind == "stable") != stable or kind not in {"stable", "unstable"}:
            yield f"{place} is {kind}"


def _nearly_unstable(coefficients: Sequence[Fraction], discrete: bool) -> bool:  # noqa: FBT001
    """Tell whether a root lies next to the boundary."""
    roots: Any = fmpz_poly(list(reversed(primitive(coefficients)))).complex_roots()
    sizes = [float(abs(root)) - 1 if discrete else float(root.real) for root, _ in roots]
    return max(sizes) > -1e-4


def _of_region(picture: RegionPicture, seen: Seen) -> Iterator[str]:
    (left, right), (bottom, top) = picture.window
    step = ((right - left) * NEAR, (top - bottom) * NEAR)
    if min(step) <= 0:
        yield "no window"
        return
    yield from _of_marks([(mark.place, mark.kind) for mark in picture.marks], seen, step)
    draw = random.Random(0)  # noqa: S311 - repeatable by design
    drawn = [
        tuple(low + (high - low) * Fraction(draw.randint(1, 996), 997) for low, high in picture.window)
        for _ in range(IN_A_PICTURE)
    ]
    places = (*drawn, *(mark.place for mark in picture.marks))
    filled = frozenset(place for area in picture.areas for place in _contained(area, places))
    for place in drawn:
        around = seen.around(step, *place)
        if len(around) == 1 and around != {place in filled}:
            yield f"at {place} the picture is filled, or is not"
    for mark in picture.marks:
        if mark.kind != "excluded" and (mark.place in filled) != (mark.kind == "stable"):
            yield f"{mark.place} is filled, or is not"
    outside = [place for area in picture.areas for place in area if not _within(place, picture.window, step)]
    yield from (f"{place} lies outside" for place in outside)
    equations = tuple(curve.equation for curve in picture.curves)
    for curve in picture.curves:
        yield from _of_curve(curve, seen, step)
    for area in picture.areas:
        yield from _of_edges(area, equations, picture.window, seen, step)
    for curve in picture.curves:
        yield from _of_boundary(curve, picture.window, seen, step)


@lru_cache(maxsize=256)
def _of_curve(curve: Curve, seen: Seen, step: Place) -> tuple[str, ...]:
    """Return the places of a curve by which its equation does not pass."""
    signs_at, far = seen.signs_around(curve.equation), (step[0] * 5, step[1] * 5)
    places = [*curve.points, *((_middle(a, b)) for a, b in pairwise(curve.points))]
    return tuple(f"{place} lies on {curve.equation}" for place in places if signs_at(place, far) in ({1}, {-1}))


@lru_cache(maxsize=256)
def _of_edges(
    area: tuple[Place, ...], equations: tuple[Relation, ...], window: tuple[Place, Place], seen: Seen, step: Place
) -> tuple[str, ...]:
    """Return the corners of an area that lie on no curve and not on the border, and where nothing is stable."""
    told = [seen.signs_around(equation) for equation in equations]

    def is_on_border(place: Place) -> bool:
        return any(min(abs(p - low), abs(p - high)) <= s for p, (low, high), s in zip(place, window, step, strict=True))

    return tuple(
        f"an edge at {place}"
        for place in area
        if not is_on_border(place)
        and not any(len(signs_at(place, step)) > 1 for signs_at in told)
        and seen.around(step, *place) == {False}
    )


@lru_cache(maxsize=256)
def _of_boundary(curve: Curve, window: tuple[Place, Place], seen: Seen, step: Place) -> tuple[str, ...]:
    """Tell of a curve that is called a boundary where nothing is stable beside it, or not where something is."""
    nothing = (Fraction(0), Fraction(0))
    places = curve.points if len(curve.points) > 2 else (curve.points[0], _middle(*curve.points), curve.points[-1])
    votes = set()
    for k in range(1, len(places) - 1, max(1, len(places) // 8)):
        (x, y), before, after = places[k], places[k - 1], places[k + 1]
        across = -(after[1] - before[1]) / step[1], (after[0] - before[0]) / step[0]
        if not any(across):
            continue
        size = 40 * max(map(abs, across))
        off = (across[0] / size * step[0], across[1] / size * step[1])
        sides = [(x + off[0], y + off[1]), (x - off[0], y - off[1])]
        votes |= {seen.stable(*place) for place in sides if _within(place, window, nothing)}
    return (f"{curve.equation} is a boundary, or is not",) if votes and curve.boundary != (True in votes) else ()


def _middle(a: Place, b: Place) -> Place:
    return (a[0] + b[0]) / 2, (a[1] + b[1]) / 2


def _within(place: Place, window: tuple[Place, Place], step: Sequence[Fraction]) -> bool:
    return all(low - s <= part <= high + s for part, (low, high), s in zip(place, window, step, strict=True))


def _cross(place: Place, step: Sequence[Fraction]) -> list[Place]:
    x, y = place
    return [place, (x - step[0], y), (x + step[0], y), (x, y - step[1]), (x, y + step[1])]


def sign_at(equation: Relation, point: Mapping[str, Fraction]) -> int:
    """Return the sign of left − right, both of them polynomials."""
    total = Fraction(0)
    for member, factor in zip(equation.members, (1, -1), strict=True):
        assert isinstance(member, Literal)
        assert isinstance(member.value, Scalar)
        total += factor * coefficients_at(member.value, "no variable", point)[0]
    return (total > 0) - (total < 0)


@lru_cache(maxsize=256)
def _contained(area: tuple[Place, ...], places: tuple[tuple[Fraction, ...], ...]) -> frozenset[tuple[Fraction, ...]]:
    return frozenset(place for place in places if _contains(area, place))


def _contains(area: Sequence[Place], place: Sequence[Fraction]) -> bool:
    """Tell whether a ray to the left crosses the polygon an odd number of times."""
    x, y = place
    crossed = 0
    for (x0, y0), (x1, y1) in zip(area, (*area[1:], area[0]), strict=True):
        if (y0 <= y) != (y1 <= y):
            crossed += x0 + (x1 - x0) * (y - y0) / (y1 - y0) < x
    return crossed % 2 == 1


def _of_line(picture: LinePicture, seen: Seen) -> Iterator[str]:
    low, high = picture.window
    step = (high - low) * NEAR
    if step <= 0:
        yield "no window"
        return
    yield from _of_marks([((place,), kind) for place, kind in picture.marks], seen, (step,))
    ends = [(a.place if a else low, b.place if b else high) for a, b in picture.pieces]
    if [x for piece in ends for x in piece] != sorted(x for piece in ends for x in piece):
        yield "the pieces follow one another"
    for k in range(1, 97):
        place = low + (high - low) * Fraction(k, 97)
        if len(found := seen.around((step,), place)) == 1 and found != {any(a < place < b for a, b in ends)}:
            yield f"{place} belongs to it, or does not"
    for a, b in picture.pieces:
        for end in (a, b):
            if end is not None and not _is_written_at(end.label, end.place, step, seen.drawn_for):
                yield f"{end.label} is written at {end.place}"
            if end is not None and len(seen.around((step,), end.place)) == 1:
                yield f"{end.place} is an end"


def _is_written_at(label: Scalar | str, place: Fraction, step: Fraction, drawn_for: Mapping[str, Fraction]) -> bool:
    if isinstance(label, str):
        return abs(Fraction(label.strip("≈… ").replace("−", "-")) - place) <= step
    node = expression(str(label))
    signs = [sign(Binary("-", node, Number(place + by)), drawn_for) for by in (-step, step)]
    return signs[0] >= 0 >= signs[1]


def _of_poles(picture: PoleMap, seen: Seen) -> Iterator[str]:
    if (picture.variable, picture.discrete) != (seen.variable, seen.discrete):
        yield "another variable"
    order = len(seen.parts) - 1
    if len(picture.paths) != order or len(picture.along) != order:
        yield "another number of poles"
        return
    near = float(min(high - low for low, high in picture.window) * NEAR_POLE)
    begin, end = picture.values
    for path, along in zip(picture.paths, picture.along, strict=True):
        if len(path) != len(along) or (along[0], along[-1]) != (begin, end):
            yield "a path ends before its time"
            return
        if list(along) != sorted(along, reverse=begin > end):
            yield "a path goes back"
        chosen = range(0, len(path), max(1, len(path) // 60))
        for k in {*range(len(path))} if len(path) < 80 else chosen:
            if min(abs(complex(*map(float, path[k])) - root) for root in _roots(seen.coefficients(along[k]))) > near:
                yield f"{path[k]} is a pole"
    common = next((k for k in range(min(map(len, picture.along))) if len({a[k] for a in picture.along}) == 1), None)
    if common is None:
        yield "the paths are not side by side"
        return
    left = _roots(seen.coefficients(picture.along[0][common]))
    for path in picture.paths:
        place = complex(*map(float, path[common]))
        left.remove(min(left, key=lambda root: abs(root - place)))


def _roots(coefficients: Sequence[Fraction]) -> list[complex]:
    found: Any = fmpz_poly(list(reversed(primitive(coefficients)))).complex_roots()
    return [complex(float(root.real), float(root.imag)) for root, number in found for _ in range(number)]


def is_number(name: str) -> bool:
    """Tell whether a generator is a `CRootOf`."""
    function = function_named(name)
    return function is not None and function.kind == "CRootOf"


# -- answers -----------------------------------------------------------------------------------------------------------


def loop_polynomial(part: StabilityRegion, world: World) -> Fraction:
    """Return χ at a point: the polynomial given, or the determinants of sI − A + BK and sI − A + LC."""
    m, question = part.plant.matrices, part.question
    if part.plant.polynomial is not None:
        return world.scalar(part.plant.polynomial)
    A, s = world.value(m.A), world.number(part.plant.variable)
    moved = [multiply(world.value(m.B), world.value(question.K))] if question.K is not None else []
    moved += [multiply(world.value(question.L), world.value(m.C))] if question.L is not None else []
    nothing = [[Fraction(0)] * len(A) for _ in A]
    tables = [
        [
            [(s if i == j else 0) - a + b for j, (a, b) in enumerate(zip(p, q, strict=True))]
            for i, (p, q) in enumerate(zip(A, table, strict=True))
        ]
        for table in moved or [nothing]
    ]
    found = Fraction(1)
    for table in tables:
        found *= characteristic(table)[-1] * (-1) ** len(A)  # det(0 I − T) = (−1)ⁿ det T
    return found


def moved_at(part: StabilityRegion, point: Mapping[str, Fraction]) -> list[Fraction]:
    """Return the coefficients, highest power first, of χ(s − α) or χ(ρ z) at a point."""
    found = coefficients_at(part.question.polynomial, part.plant.variable, point)
    boundary, order = part.question.boundary, len(found) - 1
    if boundary.discrete:
        radius = value_at(boundary.radius, point)
        return [c * radius ** (order - k) for k, c in enumerate(found)]
    margin, total = value_at(boundary.margin, point), [Fraction(0)] * (order + 1)
    for k, c in enumerate(found):
        for j in range(order - k + 1):
            total[order - j] += c * comb(order - k, j) * (-margin) ** (order - k - j)
    return total


def is_table(part: StabilityRegion, table: RouthTable, world: World) -> bool:
    """Tell whether a table begins with the coefficients and every entry follows by the rule, at a point."""
    point = {name: world.number(name) for name in part.question.critical.parameters}
    a = moved_at(part, point)
    if part.plant.is_discrete:
        a = [value_at(part.question.critical.scale, point) * c for c in in_w(a)]
    at = {**point, table.epsilon: world.number(table.epsilon)}
    rows = [[value_at(entry, at) for entry in row.entries] for row in table.rows]
    powers = [row.power for row in table.rows]
    return powers == list(range(len(a) - 1, -1, -1)) and rows == table_at(table, a, at)


def table_at(table: RouthTable, a: Sequence[Fraction], at: Mapping[str, Fraction]) -> list[list[Fraction]] | None:
    """Return the entries by the rule, the zeros replaced as the rows say; None where a row says what is not so."""
    expected: list[list[Fraction]] = []
    for index, row in enumerate(table.rows):
        power = len(a) - 1 - index
        natural = list(a[index::2]) if index < 2 else _by_rule(expected[-2], expected[-1], power)
        if row.origin == "auxiliary":
            if any(natural):
                return None
            natural = [(power + 1 - 2 * k) * expected[-1][k] for k in range(len(natural))]
        elif row.origin == "epsilon":
            if natural[0]:
                return None
            natural = [at[table.epsilon], *natural[1:]]
        elif row.origin != ("coefficients" if index < 2 else "recurrence") or not natural[0]:
            return None
        expected.append(natural)
    return expected


def _by_rule(p: Sequence[Fraction], q: Sequence[Fraction], power: int) -> list[Fraction]:
    """Return the row of a power: (q₀ p[k + 1] − p₀ q[k + 1]) / q₀."""
    p, q = [*p, Fraction(0), Fraction(0)], [*q, Fraction(0), Fraction(0)]
    return [(q[0] * p[k + 1] - p[0] * q[k + 1]) / q[0] for k in range(power // 2 + 1)]


def in_w(a: Sequence[Fraction]) -> list[Fraction]:
    """Return the coefficients of Σ aₖ (w + 1)ⁿ⁻ᵏ (w − 1)ᵏ, highest power first."""
    order, total = len(a) - 1, [Fraction(0)] * len(a)
    for k, c in enumerate(a):
        found = [c]
        for unit in [1] * (order - k) + [-1] * k:
            found = [x + unit * y for x, y in zip([*found, Fraction(0)], [Fraction(0), *found], strict=True)]
        total = [x + y for x, y in zip(total, found, strict=True)]
    return total
