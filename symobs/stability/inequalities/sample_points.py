"""Rational points where polynomials are positive, searched by floats and checked by fractions.

The search goes one coordinate at a time to where most polynomials are positive, from starts that are the same in
every run.  What it returns has been tried exactly; that it finds nothing says nothing.
"""

from __future__ import annotations

import random
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import isfinite, sqrt
from typing import TYPE_CHECKING, TypeAlias

from symobs.exact.algebraic.root_location import value_at
from symobs.stability.inequalities.z3_backend import is_free, names_of

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.exact import Scalar

Point: TypeAlias = dict[str, Fraction]
#: A coefficient and the places of the names with their exponents.
Term: TypeAlias = tuple[int, tuple[tuple[int, int], ...]]

#: How many starts, and how often one start goes through all coordinates.
STARTS, _ROUNDS = range(12), 8
#: How many starts are used where several points are wanted; a point is made simpler for up to so many terms.
_DIFFERENT, _SIMPLIFIED = 6, 200
#: Polynomials of more terms are left alone: one try would take too long.
_TERMS = 3_000
_SIZES = (1e-3, 0.05, 0.3, 1.0, 3.0, 10.0, 100.0, 1e4)
_ALLOWED = {
    "positive": lambda x: x > 0,
    "negative": lambda x: x < 0,
    "nonnegative": lambda x: x >= 0,
    "nonpositive": lambda x: x <= 0,
    "nonzero": lambda x: x != 0,
}


def holds_at(positive: Sequence[Scalar], point: Mapping[str, Fraction]) -> bool:
    """Return whether all polynomials are positive at a rational point."""
    return all(value_at(value, point) > 0 for value in positive)


def respects(point: Mapping[str, Fraction], signs: Mapping[str, str]) -> bool:
    """Return whether the coordinates have their declared signs."""
    return all(_may_be(value, signs.get(name, "real")) for name, value in point.items())


def find_point(
    positive: Sequence[Scalar], signs: Mapping[str, str], *, names: Sequence[str] = (), starts: range = STARTS
) -> Point | None:
    """Return a rational point with these signs where all polynomials are positive, None if none was found."""
    names = sorted({*names, *names_of(positive)})
    if not all(map(is_free, names)) or sum(value.size for value in positive) > _TERMS:
        return None
    if not all(value.denominator.is_constant for value in positive):
        return None
    polynomials = [_terms(value, tuple(names)) for value in positive]
    for start in starts:
        try:
            met = _from_start(polynomials, [signs.get(name, "real") for name in names], start)
        except OverflowError:  # a coefficient is beyond all floats
            return None
        if met is None or not all(map(isfinite, met)):
            continue
        for point in _rounded(met):
            named = dict(zip(names, point, strict=True))
            if respects(named, signs) and holds_at(positive, named):
                return (
                    named if sum(value.size for value in positive) > _SIMPLIFIED else _simpler(named, positive, signs)
                )
    return None


def find_points(positive: Sequence[Scalar], signs: Mapping[str, str]) -> tuple[Point, ...]:
    """Return distinct such points, from a few starts."""
    found = (find_point(positive, signs, starts=range(k, k + 1)) for k in range(_DIFFERENT))
    return tuple(point for point in found if point is not None)


def _rounded(point: Sequence[float]) -> Iterator[list[Fraction]]:
    for limit in (1, 2, 10, 1000, 10**6):
        yield [Fraction(x).limit_denominator(limit) for x in point]
    yield [Fraction(x) for x in point]


def _simpler(point: Point, positive: Sequence[Scalar], signs: Mapping[str, str]) -> Point:
    """Return a point with shorter coordinates and the same property."""
    for name, value in point.items():
        for simple in (Fraction(0), Fraction(1), Fraction(-1), *(value.limit_denominator(k) for k in (1, 2, 10, 100))):
            if simple == value:
                break
            moved = {**point, name: simple}
            if _may_be(simple, signs.get(name, "real")) and holds_at(positive, moved):
                point = moved
                break
    return point


def _may_be(value: float | Fraction, sign: str) -> bool:
    return sign not in _ALLOWED or bool(_ALLOWED[sign](value))


def _from_start(polynomials: Sequence[Sequence[Term]], signs: Sequence[str], start: int) -> list[float] | None:
    """Return a point where all are positive in floating point; `signs` belong to the coordinates."""
    generator = random.Random(start)  # noqa: S311 - the same starts in every run
    grids = [_grid(sign) for sign in signs]
    point = [1.0 if start == 0 and 1.0 in grid else generator.choice(grid) for grid in grids]
    met = sum(_line(terms, point, -1)[0] > 0 for terms in polynomials)
    for _ in range(_ROUNDS):
        places = list(range(len(point)))
        generator.shuffle(places)
        for place in places:
            if met == len(polynomials):
                return point
            lines = [_line(terms, point, place) for terms in polynomials]
            met, choices = _best_on_line(lines, grids[place], signs[place])
            point[place] = generator.choice(choices)
    return point if met == len(polynomials) else None


def _grid(sign: str) -> list[float]:
    return [x for size in (0.0, *_SIZES) for x in ((size, -size) if size else (size,)) if _may_be(x, sign)]


def _best_on_line(lines: Sequence[Sequence[float]], grid: Sequence[float], sign: str) -> tuple[int, list[float]]:
    """Maximise the number of positive polynomials along one coordinate; heuristic."""
    edges = sorted(root for line in lines for root in _roots(line))
    between = [(a + b) / 2 for a, b in pairwise(edges)]
    beyond = [x for e in edges for x in (e - 0.1 * (1 + abs(e)), e + 0.1 * (1 + abs(e)))]
    choices = [x for x in [*between, *beyond] if _may_be(x, sign)] + [*grid]
    counts = [sum(_horner(line, x) > 0 for line in lines) for x in choices]
    best = max(counts)
    return best, [x for x, count in zip(choices, counts, strict=True) if count == best]


@lru_cache(maxsize=512)
def _terms(polynomial: Scalar, names: tuple[str, ...]) -> tuple[Term, ...]:
    places = {name: place for place, name in enumerate(names)}
    return tuple((c, tuple((places[name], power) for name, power in powers)) for c, powers in polynomial.each_term())


def _line(terms: Sequence[Term], point: Sequence[float], place: int) -> list[float]:
    found = [0.0]
    for coefficient, powers in terms:
        value, degree = float(coefficient), 0
        for where, exponent in powers:
            if where == place:
                degree = exponent
                continue
            value *= point[where] if exponent == 1 else point[where] ** exponent
        found += [0.0] * (degree + 1 - len(found))
        found[degree] += value
    return found


def _horner(coefficients: Sequence[float], x: float) -> float:
    value = 0.0
    for coefficient in reversed(coefficients):
        value = value * x + coefficient
    return value


def _roots(line: Sequence[float]) -> list[float]:
    """Return the real roots of a polynomial of degree 1 or 2, none of a higher degree."""
    line = list(line)
    while len(line) > 1 and line[-1] == 0:
        line.pop()
    if len(line) == 2:
        return [-line[0] / line[1]]
    if len(line) == 3:
        c, b, a = line
        inside = b * b - 4 * a * c
        return [(-b - sqrt(inside)) / (2 * a), (-b + sqrt(inside)) / (2 * a)] if inside > 0 else []
    return []


def point_where_zero(vanishing: Scalar, positive: Sequence[Scalar], signs: Mapping[str, str]) -> Point | None:
    """Return a rational zero of one polynomial where others are positive, on a graph over the other names."""
    for name in sorted(vanishing.names):
        if vanishing.degree(name) != 1 or not is_free(name):
            continue
        lead, rest = vanishing.coefficients(name)
        put = {name: -rest / lead}
        wanted = [lead**2, *(value.substitute(put) for value in positive)]
        if sign := {"positive": 1, "negative": -1}.get(signs.get(name, "real")):
            wanted.append(-sign * rest / lead)
        cleared = [value.numerator * value.denominator for value in wanted if not value.is_constant]
        if any(value.is_constant and value.fraction() <= 0 for value in wanted):
            continue
        names = {*names_of([vanishing, *positive])} - {name}
        point = find_point(cleared, signs, names=sorted(names))
        if point is None:
            continue
        point[name] = -value_at(rest, point) / value_at(lead, point)
        if respects(point, signs) and holds_at(positive, point):
            return point
    return None
