"""Stability regions and root loci as plots."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from itertools import pairwise
from math import cos, pi, prod
from typing import TYPE_CHECKING

from symobs.exact import Scalar
from symobs.exact.algebraic.real_algebraic import FIRST_BITS, RealNumber, real_roots, roots_of_scalar
from symobs.exact.algebraic.root_location import complex_roots
from symobs.exact.core.polynomial import discriminant
from symobs.formula.figures import Curve, End, LinePicture, MarkedPoint, PoleMap, RegionPicture
from symobs.formula.tree import Literal, Relation
from symobs.stability.criteria.critical_polynomials import CriticalPolynomials
from symobs.stability.regions.region import LineRegion, exact_region

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping, Sequence

    from symobs.exact.cad.decomposition import CriticalLine, Cylinder
    from symobs.formula.figures import Interval, Picture, Place
    from symobs.stability.criteria.critical_polynomials import StabilityBoundary
    from symobs.stability.regions.region import Cell, PlaneRegion


# Plot of a region: its window, areas, curves and marked points.


#: Nodes in every cylinder; they crowd towards the critical lines, where branches turn.
NODES = 48
#: This part of the way from a critical line to the middle of a cylinder is close to the critical line.
_CLOSE = 64
#: The corners of a box are sought at this part, extremes of branches between so many points, halved so many times.
_CLOSEST, _ACROSS, _SEARCHED = 1 << 16, 12, 6
#: Beyond this many samples only the stable ones are marked.
MOST_MARKS = 16
#: Nodes lie on this grid of the window: numbers of many digits cost time over every one of them.
_NODE_GRID = 1 << 14
#: How often nodes are added where a branch is farther off a straight line than this part of the window.
_PASSES, _STRAIGHT = 2, Fraction(1, 100)
#: Coordinates are rounded to this fraction of the window.
_GRID = 1 << 20
#: What lies farther out than this many times the usual distance does not widen the window.
_FAR = 8
#: A dividing curve ends where the region is nearer than this part of the window: there it could not be told from a boundary.
_THICK = Fraction(1, 10_000)
#: Where along a dividing curve this is asked for: at so many points, on a segment at these parts of it.
_ASKED, _ON_SEGMENT = 8, (Fraction(0), Fraction(2, 7), Fraction(5, 9), Fraction(3, 4), Fraction(1))


def picture_of_plane(region: PlaneRegion) -> RegionPicture:
    """Return the plot of a region of two parameters."""
    window = _window(region)
    areas, curves, seen = [], [], []
    for number, cylinder in enumerate(region.plane.cylinders):
        found = _nodes(region, cylinder, window)
        if len(found) < 2:
            continue
        allowed = [cell for cell in region.cells if cell.cylinder == number and cell.allowed]
        seen += [cell for cell in allowed if _inside(cell.sample, window) and _holds_sample(cell, found, window)]
        nodes, rows = list(found), list(found.values())
        areas += [a for cell in allowed if cell.stable and (a := _area(cell, nodes, rows, window))]
        curves += _branches(region, cylinder, number, nodes, rows, window)
    curves += _verticals(region, window)
    shown = [cell for cell in seen if cell.stable or len(seen) <= MOST_MARKS]
    marks = [MarkedPoint(cell.sample, "stable" if cell.stable else "unstable") for cell in shown]
    marks += [MarkedPoint(hole.near, "excluded") for hole in region.holes]
    return RegionPicture(region.names, window, tuple(areas), tuple(curves), tuple(marks))


def oriented(picture: RegionPicture, names: Sequence[str]) -> RegionPicture:
    """Return the plot with the first of the names on the horizontal axis."""
    if picture.axes == tuple(names):
        return picture

    def turned(places: Iterable[Place]) -> tuple[Place, ...]:
        return tuple((y, x) for x, y in places)

    return replace(
        picture,
        axes=(picture.axes[1], picture.axes[0]),
        window=(picture.window[1], picture.window[0]),
        areas=tuple(map(turned, picture.areas)),
        curves=tuple(replace(curve, points=turned(curve.points)) for curve in picture.curves),
        marks=tuple(replace(mark, place=turned([mark.place])[0]) for mark in picture.marks),
    )


# -- the window -------------------------------------------------------------------------------------------------------


def _window(region: PlaneRegion) -> tuple[Interval, Interval]:
    """Return the ranges of both parameters: the boxes around the bounded components, a tenth of their size around them.

    Of an unbounded component, its corners and samples with room around them.
    """
    boxed: list[Place] = []
    unbounded: list[Cell] = []
    for component in region.components:
        for cell in (region.cells[number] for number in component.cells):
            if component.bounded:
                boxed += _extremes(region, cell)
            else:
                unbounded.append(cell)
    found = []
    if boxed:
        found.append(tuple(_around(min(values), max(values)) for values in zip(*boxed, strict=True)))
    if unbounded:
        tried = []
        for near in (_corners, _nearest):
            places = [near(region, cell) for cell in unbounded]
            tried.append(tuple(range_around(x for each in places for x in each[k]) for k in (0, 1)))
        found.append(min(tried, key=lambda window: prod(high - low for low, high in window)))
    if not found:
        lines = [_middle(line.x) for line in region.plane.critical_lines]
        found.append((range_around(lines), range_around([cell.sample[1] for cell in region.cells])))
    first, second = ((min(low for low, _ in each), max(high for _, high in each)) for each in zip(*found, strict=True))
    return first, second


def _around(low: Fraction, high: Fraction) -> Interval:
    """Return a range with a tenth of its size on both sides, with round ends."""
    room = (high - low) / 10
    step = _round_step(high - low + 2 * room)
    return _down(low - room, step), -_down(-high - room, step)


def _extremes(region: PlaneRegion, cell: Cell) -> Iterator[Place]:
    """Yield corners of a box around a bounded cell: its critical lines, and the extremes of its two branches between them."""
    cylinder = region.plane.cylinders[cell.cylinder]
    assert cylinder.left is not None  # noqa: S101 - the cell is bounded
    assert cylinder.right is not None  # noqa: S101
    left, right = cylinder.left.interval()[0], cylinder.right.interval()[1]
    for place, sign in ((cell.height - 1, -1), (cell.height, 1)):
        heights = {x: sign * _heights(region, x)[place] for x in (*_spread(cylinder), *_near_ends(cylinder, _CLOSEST))}
        for _ in range(_SEARCHED):
            xs = sorted(heights)
            k = max(range(len(xs)), key=lambda i: heights[xs[i]])
            for one, other in pairwise(xs[max(k - 1, 0) : k + 2]):
                x = (one + other) / 2
                heights[x] = sign * _heights(region, x)[place]
        top = sign * max(heights.values())
        yield from ((left, top), (right, top))


def _spread(cylinder: Cylinder) -> list[Fraction]:
    """Return points of a bounded cylinder, evenly spaced."""
    assert cylinder.left is not None  # noqa: S101 - the caller's cell is bounded
    assert cylinder.right is not None  # noqa: S101
    low, high = cylinder.left.interval()[1], cylinder.right.interval()[0]
    return (
        [(low + (high - low) * k / _ACROSS).limit_denominator(1 << 24) for k in range(1, _ACROSS)] if low < high else []
    )


def _corners(region: PlaneRegion, cell: Cell) -> tuple[list[Fraction], list[Fraction]]:
    """Return the coordinates of the corners of a cell, and of its sample."""
    cylinder = region.plane.cylinders[cell.cylinder]
    xs = [cell.sample[0], *(_middle(end) for end in (cylinder.left, cylinder.right) if end is not None)]
    ys = [cell.sample[1]]
    for x in (cylinder.x, *_near_ends(cylinder)):
        ys += [_heights(region, x)[k] for k in _sides(cell, cylinder)]
    return xs, ys


def _sides(cell: Cell, cylinder: Cylinder) -> list[int]:
    """Return the numbers of the branches below and above a cell."""
    return [k for k in (cell.height - 1, cell.height) if 0 <= k < len(cylinder.branches)]


def _nearest(region: PlaneRegion, cell: Cell) -> tuple[list[Fraction], list[Fraction]]:
    """Return the same where no branch runs off at a critical line, else its places that are least far from there and from 0."""
    cylinder = region.plane.cylinders[cell.cylinder]
    ends = [_middle(end) for end in (cylinder.left, cylinder.right) if end is not None]
    for line, near, nearer in zip(ends, _near_ends(cylinder), _near_ends(cylinder, _CLOSEST), strict=False):
        for k in _sides(cell, cylinder):
            if abs(_heights(region, nearer)[k]) > _FAR * (abs(_heights(region, near)[k]) + 1):
                away, outermost = cylinder.x - line, 1 if len(ends) > 1 else 12
                inside = [line + away * Fraction(2) ** n for n in range(-6, outermost)]
                heights = {x: _heights(region, x)[k] for x in inside}
                best = sorted(heights, key=lambda x: max(abs(x - line), abs(heights[x])))[:3]
                return [line, *best], [heights[x] for x in best]
    return _corners(region, cell)


def _near_ends(cylinder: Cylinder, close: int = _CLOSE) -> list[Fraction]:
    """Return points of a cylinder close to its critical lines."""
    ends = [cylinder.left.interval()[1]] if cylinder.left is not None else []
    ends += [cylinder.right.interval()[0]] if cylinder.right is not None else []
    near = [(end + (cylinder.x - end) / close).limit_denominator(1 << 30) for end in ends]
    inside = [x for x in near if cylinder.left is None or cylinder.left < RealNumber.of(x)]
    return [x for x in inside if cylinder.right is None or RealNumber.of(x) < cylinder.right]


def range_around(values: Iterable[Fraction], *, spread: bool = False) -> Interval:
    """Return a range around most values, with `spread` around all of them, with round ends."""
    known = list(values) or [Fraction(0)]
    if spread:
        low, high = min(known, key=float), max(known, key=float)
        room = (high - low) / 8 or Fraction(1)
    else:
        middle = sorted(known)[len(known) // 2]
        distances = sorted(abs(value - middle) for value in known)
        usual = distances[len(distances) * 2 // 3] or distances[-1] or Fraction(1)
        near = [value for value in known if abs(value - middle) <= _FAR * usual]
        low, high = min(near), max(near)
        room = max((high - low) * Fraction(3, 5), Fraction(1, 2) if high - low < 1 else Fraction(0), abs(middle) / 5)
    step = _round_step(high - low + 2 * room)
    return _down(low - room, step), -_down(-high - room, step)


def _round_step(width: Fraction) -> Fraction:
    """Return 1, 2 or 5 times a power of ten, about a twentieth of a width."""
    step = Fraction(1)
    while step * 20 < width:
        step *= 10
    while step * 2 > width:
        step /= 10
    return next((step / k for k in (20, 10, 5, 4, 2) if step / k * 10 >= width / 3), step)


def _down(value: Fraction, step: Fraction) -> Fraction:
    return Fraction((value / step).__floor__()) * step


def _middle(number: RealNumber) -> Fraction:
    low, high = number.interval()
    return (low + high) / 2


def _inside(place: Place, window: tuple[Interval, Interval]) -> bool:
    return all(low <= value <= high for value, (low, high) in zip(place, window, strict=True))


def _holds_sample(cell: Cell, nodes: dict[Fraction, list[Fraction]], window: tuple[Interval, Interval]) -> bool:
    """Return whether the sample of a cell lies between the rounded chords that stand for its branches."""
    (x, y), (dx, dy) = cell.sample, (cell.stable * (high - low) / (2 * _GRID) for low, high in window)
    if not min(nodes) + dx <= x <= max(nodes) - dx:
        return False
    (a, before), (b, after) = next((left, right) for left, right in pairwise(nodes.items()) if left[0] <= x <= right[0])
    ends = ((_clipped(low, window[1]), _clipped(high, window[1])) for low, high in zip(before, after, strict=True))
    heights = [low + (x - a) / (b - a) * (high - low) for low, high in ends]
    return all(h + dy < y for h in heights[: cell.height]) and all(y < h - dy for h in heights[cell.height :])


# -- branches ---------------------------------------------------------------------------------------------------------


def _nodes(
    region: PlaneRegion, cylinder: Cylinder, window: tuple[Interval, Interval]
) -> dict[Fraction, list[Fraction]]:
    """Return rational points of a cylinder inside the window with the heights of all branches there, ascending.

    They are crowded towards its ends, and stand where a branch meets the border.
    """
    (left, right), (bottom, top) = window
    low = left if cylinder.left is None else max(left, cylinder.left.interval(FIRST_BITS)[1])
    high = right if cylinder.right is None else min(right, cylinder.right.interval(FIRST_BITS)[0])
    if low >= high:
        return {}
    found = {
        low + (high - low) * Fraction(round((1 - cos(pi * k / NODES)) * (1 << 29)), 1 << 30) for k in range(NODES + 1)
    }
    for curve in region.plane.curves:
        if curve.degree:
            for height in (bottom, top):
                found |= {x for root in real_roots(curve.on_horizontal(height)) if low < (x := _middle(root)) < high}
    grid = (right - left) / _NODE_GRID
    rounded = {round(x / grid) * grid for x in found}
    inside = [x for x in rounded if (cylinder.left is None or cylinder.left < RealNumber.of(x))]
    within = sorted(x for x in inside if cylinder.right is None or RealNumber.of(x) < cylinder.right)
    if within and left < cylinder.x < right:  # its samples stand there, in the area that is drawn
        within += [] if within[0] < cylinder.x else [(low + cylinder.x) / 2]
        within += [] if cylinder.x < within[-1] else [(cylinder.x + high) / 2]
        within.sort()
    nodes = {x: _heights(region, x) for x in within}
    for _ in range(_PASSES):
        nodes = _finer(region, nodes, (top - bottom) * _STRAIGHT)
    return nodes


def _finer(region: PlaneRegion, nodes: dict[Fraction, list[Fraction]], off: Fraction) -> dict[Fraction, list[Fraction]]:
    """Return the nodes, refined where a branch deviates from the chord by more than this."""
    found = dict(nodes)
    for (x, low), (z, high) in pairwise(nodes.items()):
        middle = (x + z) / 2
        between = _heights(region, middle)
        if any(abs(2 * b - a - c) > 2 * off for a, b, c in zip(low, between, high, strict=True)):
            found[middle] = between
    return dict(sorted(found.items()))


def _heights(region: PlaneRegion, x: Fraction) -> list[Fraction]:
    """Return the heights of all branches over x, from below."""
    return sorted(_middle(root) for found in region.plane.roots_over(x) for root in found)


def _clipped(value: Fraction, bounds: Interval) -> Fraction:
    return min(max(value, bounds[0]), bounds[1])


def _area(
    cell: Cell, nodes: Sequence[Fraction], rows: Sequence[Sequence[Fraction]], window: tuple[Interval, Interval]
) -> tuple[Place, ...]:
    """Return the polygon of a cell inside the window, empty if it lies outside."""
    vertical = window[1]
    below = [_clipped(row[cell.height - 1], vertical) if cell.height else vertical[0] for row in rows]
    above = [_clipped(row[cell.height], vertical) if cell.height < len(row) else vertical[1] for row in rows]
    if all(low >= high for low, high in zip(below, above, strict=True)):
        return ()
    lower = list(zip(nodes, below, strict=True))
    upper = list(zip(nodes, above, strict=True))
    return _rounded([*lower, *reversed(upper)], window)


def _rounded(places: Iterable[Place], window: tuple[Interval, Interval]) -> tuple[Place, ...]:
    """Return places on a fine grid of the window, each once in a row."""
    grids = [(high - low) / _GRID for low, high in window]
    found: list[Place] = []
    for x, y in places:
        place = (round(x / grids[0]) * grids[0], round(y / grids[1]) * grids[1])
        if not found or found[-1] != place:
            found.append(place)
    return tuple(found)


def _branches(
    region: PlaneRegion,
    cylinder: Cylinder,
    number: int,
    nodes: Sequence[Fraction],
    rows: Sequence[Sequence[Fraction]],
    window: tuple[Interval, Interval],
) -> list[Curve]:
    """Return the pieces of branches inside the window."""
    stable = region.stable_in(number)
    bottom, top = window[1]
    found = []
    for place, branch in enumerate(cylinder.branches):
        equation = equation_of(region.plane.curves[branch.curve].scalar)
        piece: list[Place] = []
        slack = (top - bottom) / _GRID
        for x, row in zip(nodes, rows, strict=True):
            if bottom - slack <= row[place] <= top + slack:
                piece.append((x, _clipped(row[place], window[1])))
            elif len(piece) > 1:
                found.append((piece, equation, stable[place] or stable[place + 1]))
                piece = []
            else:
                piece = []
        if len(piece) > 1:
            found.append((piece, equation, stable[place] or stable[place + 1]))
    curves = [Curve(_rounded(piece, window), equation, boundary) for piece, equation, boundary in found]
    return [seen for curve in curves if (seen := _seen_apart(region, curve, window))]


def _seen_apart(region: PlaneRegion, curve: Curve, window: tuple[Interval, Interval]) -> Curve | None:
    """Return a curve, a dividing one without ends too near to the region, and not if it runs along a boundary."""
    points = curve.points
    if curve.boundary or len(points) < 2:
        return curve if len(points) > 1 else None
    for _ in range(2):
        while len(points) > 2 and _is_near_region(region, points[:3], window):
            points = points[1:]
        points = points[::-1]
    (x0, y0), (x1, y1) = points[0], points[-1]
    along = points if len(points) > 2 else [(x0 + (x1 - x0) * t, y0 + (y1 - y0) * t) for t in _ON_SEGMENT]
    asked = range(1, len(along) - 1, max(1, len(along) // _ASKED))
    is_near = any(_is_near_region(region, along[k - 1 : k + 2], window) for k in asked)
    return None if is_near else replace(curve, points=points)


def _is_near_region(region: PlaneRegion, points: Sequence[Place], window: tuple[Interval, Interval]) -> bool:
    """Return whether the region reaches to a thick line at the second of three points."""
    (x0, y0), (x, y), (x1, y1) = points
    width, height = (high - low for low, high in window)
    across = (y0 - y1) / height, (x1 - x0) / width
    size = _THICK / (max(map(abs, across)) or 1)
    dx, dy = across[0] * size * width, across[1] * size * height
    beside = (place for k in (1, -1) if _inside(place := (x + k * dx, y + k * dy), window))
    places = (dict(zip(region.names, place, strict=True)) for place in beside)
    return any(region.critical.allows(place) and region.critical.is_stable(place) for place in places)


def _verticals(region: PlaneRegion, window: tuple[Interval, Interval]) -> list[Curve]:
    """Return the vertical lines among the critical curves in pieces: a boundary where something stable stands beside."""
    found = []
    (left, right), (bottom, top) = window
    for line in region.plane.critical_lines:
        for curve in region.plane.vertical_at(line):
            x = _middle(line.x)
            if not left <= x <= right:
                continue
            equation = equation_of(region.plane.curves[curve].scalar)
            beside = _beside(region, line, (right - left) / _GRID)
            heights = {y for place in beside for y in _heights(region, place) if bottom < y < top}
            for low, high in _pieces(sorted({bottom, top, *heights}), (top - bottom) / 100):
                points = ({region.names[0]: place, region.names[1]: (low + high) / 2} for place in beside)
                stable = any(region.critical.allows(p) and region.critical.is_stable(p) for p in points)
                found.append(Curve(_rounded([(x, low), (x, high)], window), equation, stable))
    return [seen for curve in found if (seen := _seen_apart(region, curve, window))]


def _beside(region: PlaneRegion, line: CriticalLine, step: Fraction) -> list[Fraction]:
    """Return a point close to a critical line on either side, inside the cylinders there."""
    found = []
    for end, cylinder in zip(line.x.interval(), region.plane.cylinders[line.index : line.index + 2], strict=True):
        place = end + (cylinder.x - end) * min(Fraction(1, _CLOSE), step / abs(cylinder.x - end))
        found.append(place.limit_denominator(1 << 40))
    return found


def _pieces(ends: Sequence[Fraction], least: Fraction) -> list[tuple[Fraction, Fraction]]:
    """Return the intervals between ends that are not closer than this."""
    kept = [ends[0]]
    for end in ends[1:-1]:
        if end - kept[-1] > least and ends[-1] - end > least:
            kept.append(end)
    return list(pairwise([*kept, ends[-1]]))


def equation_of(polynomial: Scalar, parameters: Sequence[str] = ()) -> Relation:
    """Return the equation of a curve, solved for a parameter that stands alone in it."""
    for name in sorted(polynomial.names, key=lambda n: (n not in parameters, n)):
        if polynomial.degree(name) == 1:
            lead, rest = polynomial.coefficients(name)
            others = (lead.names | rest.names).intersection(parameters) if parameters else lead.names | rest.names
            if not others or (lead.is_constant and polynomial.degrees()[0] == 1):
                return Relation((Literal(Scalar.symbol(name)), Literal(-rest / lead)), ("=",))
    constant = polynomial.substitute(dict.fromkeys(polynomial.names, Scalar.of(0)))
    return Relation((Literal(polynomial - constant), Literal(-constant)), ("=",))


# -- one parameter ----------------------------------------------------------------------------------------------------


def picture_of_line(region: LineRegion) -> LinePicture:
    """Return the plot of a region of one parameter."""
    ends = [_middle(end) for piece in region.intervals for end in (piece.low, piece.high) if end is not None]
    window = range_around(ends or [Fraction(0)])
    pieces = tuple((_end(piece.low), _end(piece.high)) for piece in region.intervals)
    return LinePicture(region.name, window, pieces, tuple((piece.sample, "stable") for piece in region.intervals))


def _end(number: RealNumber | None) -> End | None:
    if number is None:
        return None
    closed = number.closed_form()
    return End(_middle(number), closed if closed is not None else number.decimal(4))


# Plot of a region with further symbols: drawn at sample values of them, its curves labelled in general.


#: Small numbers that are tried for the symbols, so that no two curves coincide by chance.
_VALUES = ((1, 1, 1), (1, 2, 3), (2, 1, 3), (3, 1, 2))


def picture_with_symbols(
    critical: CriticalPolynomials, parameters: Sequence[str], symbols: Sequence[str]
) -> Picture | None:
    """Return the plot of a region of one or two parameters at values of the symbols, None if it is empty."""
    if not symbols or not 1 <= len(parameters) <= 2 or critical.never:
        return None
    for values in _choices(symbols, critical.signs):
        found = _drawn(critical, parameters, values)
        if found is not None:
            return found
    return None


def _choices(symbols: Sequence[str], signs: Mapping[str, str]) -> Iterator[dict[str, Scalar]]:
    down = {"negative", "nonpositive"}
    for numbers in _VALUES:
        yield {
            name: Scalar.of(numbers[k % 3] * (-1 if signs.get(name) in down else 1)) for k, name in enumerate(symbols)
        }


def _drawn(critical: CriticalPolynomials, parameters: Sequence[str], values: dict[str, Scalar]) -> Picture | None:
    """Return the plot at these values, None if the region is empty there."""
    try:
        there = CriticalPolynomials(
            critical.polynomial.substitute(values), critical.boundary.substitute(values), critical.signs
        )
    except ZeroDivisionError:
        return None
    if there.never or there.parameters != tuple(sorted(parameters)):
        return None
    drawn_for = tuple(values.items())
    region = exact_region(there, tuple(parameters))
    if region is None or region.empty:
        return None
    if isinstance(region, LineRegion):
        return replace(picture_of_line(region), drawn_for=drawn_for)
    picture = oriented(picture_of_plane(region), parameters)
    labels = {equation_of(factor): _general(factor, values, critical, parameters) for factor in there.factors}
    curves = tuple(replace(curve, equation=labels[curve.equation]) for curve in picture.curves)
    return replace(picture, curves=curves, drawn_for=drawn_for)


def _general(
    factor: Scalar, values: Mapping[str, Scalar], critical: CriticalPolynomials, parameters: Sequence[str]
) -> Relation:
    """Return the equation with symbols that specialises to this factor."""
    for polynomial in critical.proper:
        there = polynomial.substitute(values)
        if not there.is_constant and (there / factor).is_constant:
            return equation_of(polynomial, parameters)
    return equation_of(factor)


# Root locus in one parameter: the roots at every node, each joined to the nearest at the next node.


#: Nodes along the way, and how near to a double root, in parts of the way, further ones stand on both sides of it.
LOCUS_NODES = 120
_BESIDE = (Fraction(1, 3000), Fraction(1, 600), Fraction(1, 200))
#: A root is known to about 50 bits of its modulus: in a window so much longer than wide its place cannot be drawn.
_LONGEST = 1 << 40


def pole_map(region: LineRegion, polynomial: Scalar, boundary: StabilityBoundary) -> PoleMap | None:
    """Return the root locus over the window of a region, None if a root goes to infinity or the window is too long."""
    name, variable = region.name, boundary.variable
    if not polynomial.coefficients(variable)[0].is_constant or not boundary.names <= {variable}:
        return None
    low, high = _way(region)
    if _runs_off(polynomial, name, low, high):
        return None
    margin = None if boundary.discrete else boundary.margin.fraction()
    radius = boundary.radius.fraction() if boundary.discrete else None
    return root_locus(polynomial, variable, name, (low, high), margin, radius)


def root_locus(
    polynomial: Scalar, variable: str, name: str, values: Interval, margin: Fraction | None, radius: Fraction | None
) -> PoleMap | None:
    """Return the paths of the roots while a parameter runs through an interval, None where the window is too long.

    In discrete time there is a radius of stability.
    """
    nodes = _locus_nodes(polynomial, variable, name, *values)
    rows = [_roots(polynomial, variable, name, value) for value in nodes]
    paths = [[root] for root in rows[0]]
    for row in rows[1:]:
        for path, root in zip(paths, _paired([path[-1] for path in paths], row), strict=True):
            path.append(root)
    places = [place for path in paths for place in path]
    window = range_around([x for x, _ in places], spread=True), range_around([y for _, y in places], spread=True)
    sides = [end - begin for begin, end in window]
    if max(sides) > _LONGEST * min(sides):
        return None
    return PoleMap(
        variable,
        name,
        (nodes[0], nodes[-1]),
        tuple(tuple(path) for path in paths),
        window,
        radius is not None,
        margin,
        radius,
        tuple(tuple(nodes) for _ in paths),
    )


def _way(region: LineRegion) -> tuple[Fraction, Fraction]:
    """Return the range of the parameter: all ends of the region, with a margin."""
    ends = [end.interval()[0] for piece in region.intervals for end in (piece.low, piece.high) if end is not None]
    samples = [piece.sample for piece in region.intervals]
    low, high = range_around(ends + samples or [Fraction(0)])
    sign = region.critical.signs.get(region.name)
    if sign in {"positive", "nonnegative"}:
        low = max(low, Fraction(0))
    if sign in {"negative", "nonpositive"}:
        high = min(high, Fraction(0))
    return low, high


def _runs_off(polynomial: Scalar, name: str, low: Fraction, high: Fraction) -> bool:
    """Return whether a denominator vanishes on the way: of `s^2 + s + 1/a` at a = 0, where the roots have no bound."""
    below = polynomial.denominator
    places = [root.interval() for root in roots_of_scalar(below, name)] if name in below.names else []
    return any(begin <= high and low <= end for begin, end in places)


def _locus_nodes(polynomial: Scalar, variable: str, name: str, low: Fraction, high: Fraction) -> list[Fraction]:
    """Return values of the parameter, evenly spaced and close to those with a double root."""
    way = high - low
    found = {low + way * k / LOCUS_NODES for k in range(LOCUS_NODES + 1)}
    meeting = discriminant(polynomial, variable)
    if meeting.names == {name} and not meeting.is_constant:
        for root in roots_of_scalar(meeting, name):
            where = root.interval()[0].limit_denominator(1 << 24)
            found |= {where + sign * way * part for part in _BESIDE for sign in (-1, 1)} | {where}
    return sorted(value for value in found if low <= value <= high)


def _roots(polynomial: Scalar, variable: str, name: str, value: Fraction) -> list[Place]:
    there = polynomial.substitute({name: Scalar.of(value)})
    return sorted(complex_roots([c.fraction() for c in there.coefficients(variable)]))


def _paired(before: Sequence[Place], after: Sequence[Place]) -> list[Place]:
    """Return the roots in the order of the previous ones, nearest pairs first, to the accuracy of binary numbers."""
    first, second = ([complex(float(x), float(y)) for x, y in row] for row in (before, after))
    distances = sorted((abs(one - other), i, j) for i, one in enumerate(first) for j, other in enumerate(second))
    chosen: dict[int, int] = {}
    for _, i, j in distances:
        if i not in chosen and j not in chosen.values():
            chosen[i] = j
    return [after[chosen[i]] for i in range(len(before))]
