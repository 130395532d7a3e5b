"""Whether courses over time are those of the equations of the page (trusted).

The values are found anew, by steps: e^{Mh} from its power series in rational numbers, with a bound for the rest, and
then one product a step, in fixed point with as many bits as rounding can eat up.  In discrete time they are powers of M
times the start, and must be met exactly.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import lcm
from operator import mul
from typing import TYPE_CHECKING

from symobs.certificate import verify
from symobs.exact import Matrix, Scalar
from symobs.formula import Block, Derivative, Exact, Letter, Literal, Product, Relation, Signal, evaluate

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.formula import Environment, Formula
    from symobs.picture import Course, TimeResponse

#: Parts of the window: how far a point may lie from what it stands for, and a segment from what it passes between.
_NEAR, _BETWEEN = Fraction(1, 500), Fraction(1, 100)
#: Bits that are left when rounding has done its worst, those that a factor e takes, and the most that are worth it.
_BITS, _BITS_OF_E, _MOST_BITS = 64, Fraction(3, 2), 20_000

Vector = list[Fraction]


def faults_of_response(picture: TimeResponse, subject: Formula, environment: Environment) -> Iterator[str]:
    """Yield what a picture of courses shows that is not so."""
    state = Block(tuple((Letter(name),) for name in picture.states))
    for relation in ((Derivative(state), Product((subject, state))), *_signals(picture, state, environment)):
        if verify(Relation(relation, ("=",)), environment)[0] == "":
            yield f"an equation of {', '.join(picture.states)} with this matrix"
            return
    (begin, end), (bottom, top) = picture.window
    counts = {len(course.heights) for course in picture.courses}
    if len(counts) != 1 or min(counts) < 2 or begin != 0 or end <= 0 or bottom >= top or picture.parts < 1:
        yield "a window that begins at 0 and that courses fill"
        return
    steps = min(counts) - 1
    sizes = [_size(name, environment) for name in picture.states]
    if [len(start) for start in picture.starts] != sizes:
        yield f"a start of {', '.join(picture.states)}"
        return
    matrix = evaluate(subject, environment, Exact(environment))
    beginning = tuple(part for start in picture.starts for part in start)
    if picture.discrete:
        yield from _faults_of_samples(picture, matrix, beginning)
        return
    values = _stepped(matrix, beginning, end / (2 * steps), 2 * steps + 1)
    for course in picture.courses:
        yield from _faults_of_course(course, picture.parts, values, (bottom, top))


def _faults_of_samples(picture: TimeResponse, matrix: Matrix, state: tuple[Fraction, ...]) -> Iterator[str]:
    """Yield where a course of discrete time is not what it is said to be: exactly row · Mᵏ · start."""
    count = len(picture.courses[0].heights)
    if picture.window[0][1] != count - 1:
        yield "instants other than 0, 1, 2, ..."
        return
    table = [[entry.fraction() for entry in row] for row in matrix.rows]
    heights: list[list[Fraction]] = [[] for _ in picture.courses]
    for _ in range(count):
        for found, course in zip(heights, picture.courses, strict=True):
            found.append(sum(map(mul, course.row, state), Fraction(0)))
        state = tuple(sum(map(mul, row, state), Fraction(0)) for row in table)
    bottom, top = picture.window[1]
    for found, course in zip(heights, picture.courses, strict=True):
        if [height * picture.parts for height in found] != list(course.heights):
            yield f"the course of {course.signal}"
        if min(found) < bottom or max(found) > top:
            yield f"{course.signal}, which leaves the window,"


def _signals(picture: TimeResponse, state: Block, environment: Environment) -> Iterator[tuple[Formula, Formula]]:
    """Yield the equations that make courses components of their signals."""
    for name in dict.fromkeys(course.signal for course in picture.courses):
        rows = {course.component: course.row for course in picture.courses if course.signal == name}
        size = _size(name, environment)
        if sorted(rows) != ([0] if size == 1 else list(range(1, size + 1))):
            raise ValueError(f"not all components of {name}")
        table = Matrix.of([[Scalar.of(part) for part in rows[component]] for component in sorted(rows)])
        yield Letter(name), Product((Literal(table), state))


def _size(name: str, environment: Environment) -> int:
    """Return how many components a signal has."""
    signal = evaluate(Letter(name), environment, Exact(environment))
    return signal.size if isinstance(signal, Signal) else 0


def _faults_of_course(
    course: Course, parts: int, values: list[list[int]], edges: tuple[Fraction, Fraction]
) -> Iterator[str]:
    """Yield where a course is not what it is said to be; `values` are those at all instants and between them."""
    common = lcm(*(part.denominator for part in course.row))
    row = [int(part * common) for part in course.row]
    true = [sum(map(mul, row, value)) // common for value in values]
    drawn = [(height << _BITS) // parts for height in course.heights]
    bottom, top = (int(edge * (1 << _BITS)) for edge in edges)
    height = top - bottom
    off = [abs(y - value) for y, value in zip(drawn, true[::2], strict=True)]
    between = [abs((a + b) // 2 - value) for (a, b), value in zip(pairwise(drawn), true[1::2], strict=True)]
    if max(off) > height * _NEAR or max(between) > height * _BETWEEN:
        yield f"the course of {course.signal}"
    if min(drawn) < bottom or max(drawn) > top:
        yield f"{course.signal}, which leaves the window,"


@lru_cache(maxsize=2)
def _stepped(matrix: Matrix, start: tuple[Fraction, ...], step: Fraction, count: int) -> list[list[int]]:
    """Return the state at `count` instants, in parts of 2 to the power of _BITS.

    A step enlarges an error at most by e^‖Mh‖ and adds some units of its own: bits are kept in reserve for the former,
    and _BITS of them, beside those of the start and of the steps, are more than the latter add up to.
    """
    table = [[entry.fraction() * step for entry in row] for row in matrix.rows]
    norm = max(sum(map(abs, row), Fraction(0)) for row in table)
    largest = max(map(abs, start))
    bits = 2 * _BITS + int(count * norm * _BITS_OF_E) + count.bit_length() + int(largest).bit_length()
    if bits > _MOST_BITS:
        raise ValueError("a course with too much to compute")
    once = _exponential(table, norm, bits)
    state = [round(part * (1 << bits)) for part in start]
    values = []
    for _ in range(count):
        values.append([part >> (bits - _BITS) for part in state])
        state = [sum(map(mul, row, state)) >> bits for row in once]
    return values


def _exponential(table: list[Vector], norm: Fraction, bits: int) -> list[list[int]]:
    """Return e^M in fixed point by its power series, until its terms are nothing and go on falling."""
    order = len(table)
    fixed = [[round(entry * (1 << bits)) for entry in row] for row in table]
    term = [[(i == j) << bits for j in range(order)] for i in range(order)]
    total = [list(row) for row in term]
    k = 0
    columns = list(zip(*fixed, strict=True))
    while k <= 2 * norm or any(entry not in {0, -1} for row in term for entry in row):
        k += 1
        term = [[(sum(map(mul, row, column)) >> bits) // k for column in columns] for row in term]
        total = [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(total, term, strict=True)]
    return total
