"""The shortest vector that quadratic equations with rational coefficients allow, written exactly in one real root.

Newton's method finds the multipliers that make the Lagrangian's least value greatest, then the vector to many digits.
Lattice reduction recognises its entries as polynomials in one of them; that they solve the equations is checked in
exact arithmetic before they are returned, and that the vector is the shortest is for a certificate to show.
"""

from __future__ import annotations

import itertools
from math import log
from operator import itemgetter
from typing import TYPE_CHECKING, TypeAlias

from flint import arb, arb_mat, ctx, fmpq, fmpq_mat, fmpq_poly, fmpz_mat, fmpz_poly

from symobs.exact.field import EIGENVALUE
from symobs.exact.polynomial import from_coefficients
from symobs.exact.real import RealNumber, real_roots
from symobs.exact.scalar import Scalar
from symobs.record import dataclass

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence

    from symobs.exact.matrix import Matrix

Floats: TypeAlias = list[list[float]]
#: x, the slope of the dual function, its value and how it bends.
Dual: TypeAlias = tuple[list[float], list[float], float, Floats]

#: Steps of Newton's method, halvings of one step, and what counts as no step at all.
_STEPS, _HALVINGS, _STILL = 100, 16, 1e-20
#: The weights of log det H beside the dual function.
_BARRIERS = (1.0, 0.1, 1e-2, 1e-4, 1e-6, 1e-8)
#: What is added to the bend of the dual function, as a part of it, where less does not lead upwards.
_EASED = (1e-12, 1e-6, 1e-3, 0.1, 10.0)
#: The degrees of minimal polynomials that are looked for one after the other, and the bits each is looked for with.
_LADDER = ((2, 200), (4, 500), (8, 1_500), (12, 3_500), (18, 8_000), (24, 16_000))
#: What a lattice's shortest vector must stay below, as a part of what chance would give, to be no chance.
_NO_CHANCE = 0.7
_SPARE_BITS = 64


@dataclass(frozen=True)
class Quadratic:
    """The polynomial xᵀ Q x + bᵀ x + c with Q symmetric, b a column."""

    form: Matrix
    slope: Matrix
    constant: Scalar

    def at(self, x: Matrix) -> Scalar:
        """Return the value at a column."""
        return (x.T @ (self.form @ x + self.slope))[0, 0] + self.constant


def shortest(equations: Sequence[Quadratic]) -> tuple[RealNumber, tuple[Scalar, ...]] | None:
    """Return a root and, as polynomials in λ for it, the entries of x and the multipliers λₖ of the equations.

    x is short where xᵀx + Σ λₖ (equation k) is convex.  None where no multipliers with this property are found, or where
    the root is of too high a degree.
    """
    try:
        problem = Problem(equations)
        start = problem.started()
    except OverflowError:
        return None
    return None if start is None else _recognised(problem, start)


def at_sum_of_squares(
    equations: Sequence[Quadratic], start: Sequence[float], root: RealNumber
) -> tuple[Scalar, ...] | None:
    """Return what `shortest` does for a stationary point near `start`, as polynomials in the sum of squares `root`."""
    before, problem = ctx.prec, Problem(equations)
    try:
        found = _in_root(problem, start, lambda point: sum((v * v for v in point[: problem.size]), arb(0)).mid(), root)
    except ZeroDivisionError:
        return None
    finally:
        ctx.prec = before
    return None if found is None else tuple(_scalar(entry) for entry in found)


class Problem:
    """The equations in floating point and, converted to the precision in use, in balls."""

    def __init__(self, equations: Sequence[Quadratic]) -> None:
        """Take equations in rational numbers."""
        self.forms = [_rational(q.form) for q in equations]
        self.slopes = [[_number(entry) for entry in q.slope.entries] for q in equations]
        self.constants = [_number(q.constant) for q in equations]
        self.size, self.count = len(self.slopes[0]), len(equations)
        self.near = [[[float(entry.fraction()) for entry in row] for row in q.form.rows] for q in equations]
        self.near_slopes = [[float(entry.fraction()) for entry in q.slope.entries] for q in equations]
        self.near_constants = [float(q.constant.fraction()) for q in equations]

    def started(self) -> list[float] | None:
        """Return x and the multipliers nearly: where the dual function is greatest, by Newton's method.

        A part of log det H, which becomes smaller and smaller, keeps the steps where H is definite.  None where the
        greatest value is not taken there.
        """
        within = self.within()
        multipliers = None if within is None else self._topped(within, 0.0)
        state = None if multipliers is None else self._dual(multipliers, 0.0)
        return None if state is None or multipliers is None else [*state[0], *multipliers]

    def within(self) -> list[float] | None:
        """Return multipliers near those where the dual function is greatest, at which H is definite."""
        multipliers: list[float] | None = [0.0] * self.count
        for weight in _BARRIERS:
            multipliers = self._topped(multipliers, weight) if multipliers is not None else None
        return multipliers

    def edge(self, multipliers: Sequence[float]) -> tuple[list[float], list[float]] | None:
        """Return x for multipliers where H is nearly singular, and a vector that H nearly sends to 0."""
        size = range(self.size)
        H = [
            [(i == j) + sum(m * form[i][j] for m, form in zip(multipliers, self.near, strict=True)) for j in size]
            for i in size
        ]
        state, way = self._dual(multipliers, 0.0), [[1.0 + 0.1 * i] for i in size]
        for _ in range(3):
            found = _solved(H, way)
            if found is None:
                return None
            length = sum(row[0] ** 2 for row in found[0]) ** 0.5
            way = [[row[0] / length] for row in found[0]]
        return None if state is None else (state[0], [row[0] for row in way])

    def _topped(self, multipliers: list[float], weight: float) -> list[float] | None:
        """Return the multipliers where the dual function and its barrier are greatest."""
        state = self._dual(multipliers, weight)
        for _ in range(_STEPS):
            if state is None:
                return None
            _, values, height, bend = state
            step = self._way(bend, values, _EASED[0])
            if step is not None and _product(values, step) < max(_STILL, weight * 1e-3) * (1 + abs(height)):
                return multipliers
            tried = (self._climbed(multipliers, state, eased, weight) for eased in _EASED)
            found = next((moved for moved in tried if moved is not None), None)
            if found is None:
                return multipliers if weight else None
            multipliers, state = found, self._dual(found, weight)
        return multipliers if weight else None

    def _way(self, bend: Floats, values: Sequence[float], eased: float) -> list[float] | None:
        """Return Newton's step, the bend made definite by a part of itself."""
        more = eased * (sum(bend[k][k] for k in range(self.count)) + 1e-9)
        table = [[entry + (more if i == j else 0.0) for j, entry in enumerate(row)] for i, row in enumerate(bend)]
        found = _solved(table, [[value] for value in values])
        return None if found is None else [row[0] for row in found[0]]

    def _climbed(self, multipliers: Sequence[float], state: Dual, eased: float, weight: float) -> list[float] | None:
        """Return multipliers where the dual function is higher by as much as its slope lets expect."""
        _, values, height, bend = state
        step = self._way(bend, values, eased)
        if step is None:
            return None
        length, slope = 1.0, _product(values, step)
        for _ in range(_HALVINGS):
            moved = [old + length * way for old, way in zip(multipliers, step, strict=True)]
            reached = self._dual(moved, weight)
            if reached is not None and reached[2] >= height + 0.1 * length * slope - 1e-15 * abs(height):
                return moved
            length /= 2
        return None

    def _dual(self, multipliers: Sequence[float], weight: float) -> Dual | None:
        """Return x, the slope of the dual function, its value and how it bends; with the weighted log det H in all."""
        size, count = range(self.size), range(self.count)
        H = [[(i == j) + sum(multipliers[k] * self.near[k][i][j] for k in count) for j in size] for i in size]
        right = [-sum(multipliers[k] * self.near_slopes[k][i] for k in count) / 2 for i in size]
        solved = _solved(H, [[right[i], *(float(i == j) for j in size)] for i in size])
        if solved is None:
            return None
        rows, volume = solved
        x, inverse = [row[0] for row in rows], [row[1:] for row in rows]
        images = [[_product(self.near[k][i], x) for i in size] for k in count]
        sides = [[images[k][i] + self.near_slopes[k][i] / 2 for i in size] for k in count]
        values = [
            _product(x, [a + b for a, b in zip(images[k], self.near_slopes[k], strict=True)]) + self.near_constants[k]
            for k in count
        ]
        height = _product(x, x) + _product(multipliers, values) + weight * volume
        moved = [[_product(inverse[i], sides[k]) for i in size] for k in count]
        turned = [[[_product(inverse[i], self.near[k][j]) for j in size] for i in size] for k in count]
        traces = [[sum(turned[a][i][j] * turned[b][j][i] for i in size for j in size) for b in count] for a in count]
        bend = [[2 * _product(sides[a], moved[b]) + weight * traces[a][b] for b in count] for a in count]
        slope = [values[k] + weight * sum(turned[k][i][i] for i in size) for k in count]
        return x, slope, height, bend

    def refined(self, start: Sequence[float], bits: int) -> list[arb]:
        """Return x and the multipliers to this many bits, by Newton's method on the equations of Lagrange."""
        point = [arb(value) for value in start]
        precision = 2 * _SPARE_BITS
        while True:
            ctx.prec = precision
            for _ in range(2):
                point = self._stepped(point)
            if precision >= bits + _SPARE_BITS:
                return point
            precision = min(2 * precision, bits + _SPARE_BITS)

    def _stepped(self, point: Sequence[arb]) -> list[arb]:
        table, off = self.linearised(point)
        step = table.solve(off)
        return [(value - step[i, 0]).mid() for i, value in enumerate(point)]

    def linearised(self, point: Sequence[arb]) -> tuple[arb_mat, arb_mat]:
        """Return the matrix of Newton's method, which is symmetric, and by how much the equations of Lagrange are missed."""
        size = self.size
        x, multipliers = arb_mat([[value] for value in point[:size]]), point[size:]
        forms = [arb_mat(form) for form in self.forms]
        slopes = [arb_mat([[arb(entry)] for entry in slope]) for slope in self.slopes]
        H = arb_mat(fmpq_mat([[int(i == j) for j in range(size)] for i in range(size)]))
        force = arb_mat(size, 1)
        for form, slope, multiplier in zip(forms, slopes, multipliers, strict=True):
            H, force = H + form * multiplier, force + slope * (multiplier / 2)
        sides = [form * x + slope * (arb(1) / 2) for form, slope in zip(forms, slopes, strict=True)]
        values = [
            (x.transpose() * (side + slope * (arb(1) / 2)))[0, 0] + arb(constant)
            for side, slope, constant in zip(sides, slopes, self.constants, strict=True)
        ]
        off = H * x + force
        rows = [[*(H[i, j] for j in range(size)), *(side[i, 0] for side in sides)] for i in range(size)]
        rows += [[*(side[i, 0] for i in range(size)), *([arb(0)] * self.count)] for side in sides]
        return arb_mat(rows), arb_mat([*([off[i, 0]] for i in range(size)), *([value / 2] for value in values)])

    def holds(self, entries: Sequence[fmpq_poly], modulus: fmpq_poly) -> bool:
        """Tell whether polynomials in a root solve the equations of Lagrange, exactly."""
        x, multipliers, zero = entries[: self.size], entries[self.size :], fmpq_poly([0])
        images = [
            [sum((form[i, j] * x[j] for j in range(self.size) if form[i, j] != 0), zero) for i in range(self.size)]
            for form in self.forms
        ]
        for i in range(self.size):
            total = x[i]
            for image, slope, multiplier in zip(images, self.slopes, multipliers, strict=True):
                total += multiplier * (image[i] + fmpq_poly([slope[i] / 2]))
            if total % modulus:
                return False
        for image, slope, constant in zip(images, self.slopes, self.constants, strict=True):
            value = fmpq_poly([constant])
            for entry, moved, b in zip(x, image, slope, strict=True):
                value += entry * (moved + fmpq_poly([b]))
            if value % modulus:
                return False
        return True


def _recognised(problem: Problem, start: Sequence[float]) -> tuple[RealNumber, tuple[Scalar, ...]] | None:
    """Return the solution near `start` in one real root, tried with one multiplier, then one entry after the other."""
    before = ctx.prec
    try:
        for place in reversed(range(len(start))):
            root = _minimal_polynomial(problem, start, place)
            if root is None:
                return None  # an entry of higher degree than is looked for
            found = _in_root(problem, start, itemgetter(place), root)
            if found is not None:
                return root, tuple(_scalar(entry) for entry in found)
    except ZeroDivisionError:  # the equations of Lagrange are singular there
        pass
    finally:
        ctx.prec = before
    return None


def _minimal_polynomial(problem: Problem, start: Sequence[float], place: int) -> RealNumber | None:
    for degree, bits in _LADDER:
        value = problem.refined(start, bits)[place]
        short = short_relation(list(itertools.islice(powers_of(value, bits), degree + 1)), bits)
        if short is not None:
            roots = real_roots(fmpz_poly(short))
            return next((root for root in roots if abs(root.ball(bits // 2) - value) < arb(2) ** (-bits // 4)), None)
    return None


def _in_root(
    problem: Problem, start: Sequence[float], value_of: Callable[[list[arb]], arb], root: RealNumber
) -> list[fmpq_poly] | None:
    """Return the solution as polynomials in the root, each recognised as one over the derivative of its polynomial."""
    modulus = fmpq_poly(root.polynomial)
    slope = root.polynomial.derivative()
    inverse = fmpq_poly(slope).xgcd(modulus)[1]
    height = max(abs(int(c)) for c in root.polynomial.coeffs()).bit_length()
    for factor in (2, 5):
        bits = (root.degree + 2) * (factor * height + 2 * _SPARE_BITS)
        solution = problem.refined(start, bits)
        theta = value_of(solution)
        powers = list(itertools.islice(powers_of(theta, bits), root.degree))
        scale = sum((int(c) * theta**k for k, c in enumerate(slope.coeffs())), arb(0))
        relations = [short_relation([*powers, value * scale], bits) for value in solution]
        if all(relations) and all(relation[-1] for relation in relations if relation):
            found = [fmpq_poly(r[:-1], -r[-1]) * inverse % modulus for r in relations if r]
            if problem.holds(found, modulus):
                return found
    return None


def powers_of(value: arb, bits: int) -> Iterator[arb]:
    """Yield 1, v, v², … of a number, precise enough for a lattice of this many bits."""
    ctx.prec = bits + 2 * _SPARE_BITS
    power = arb(1)
    while True:
        yield power
        power = (power * value).mid()


def short_relation(values: Sequence[arb], bits: int) -> list[int] | None:
    """Return small integers whose combination of the values is nearly 0; None where they are no smaller than by chance."""
    count = len(values)
    rows = [[*(int(i == j) for j in range(count)), _whole(value, bits)] for i, value in enumerate(values)]
    shortest_row = fmpz_mat(rows).lll().tolist()[0]
    found = [int(entry) for entry in shortest_row[:-1]]
    size = max(abs(int(entry)).bit_length() for entry in shortest_row)
    return found if size * count < _NO_CHANCE * bits else None


def _whole(value: arb, bits: int) -> int:
    exact = value.mid().fmpq()
    return (int(exact.p) << bits) // int(exact.q)


def _solved(matrix: Floats, right: Floats) -> tuple[Floats, float] | None:
    """Return the solution for a symmetric positive definite matrix, by Gauss's elimination, and log det; None for others."""
    size, volume = len(matrix), 0.0
    work = [[*row, *side] for row, side in zip(matrix, right, strict=True)]
    for i in range(size):
        pivot = work[i][i]
        if not pivot > 1e-13 * max(1.0, abs(matrix[i][i])):
            return None
        volume += log(pivot)
        work[i] = [entry / pivot for entry in work[i]]
        for k in range(size):
            if k != i and work[k][i]:
                factor = work[k][i]
                work[k] = [a - factor * b for a, b in zip(work[k], work[i], strict=True)]
    return [row[size:] for row in work], volume


def _product(left: Sequence[float], right: Sequence[float]) -> float:
    return sum(a * b for a, b in zip(left, right, strict=True))


def _rational(matrix: Matrix) -> fmpq_mat:
    return fmpq_mat(*matrix.shape, [_number(entry) for entry in matrix.entries])


def _number(value: Scalar) -> fmpq:
    exact = value.fraction()
    return fmpq(exact.numerator, exact.denominator)


def _scalar(polynomial: fmpq_poly) -> Scalar:
    """Return a polynomial in λ."""
    below = Scalar.of(int(polynomial.denom()))
    above = [Scalar.of(int(c)) for c in reversed(polynomial.numer().coeffs())] or [Scalar.of(0)]
    return from_coefficients(above, EIGENVALUE) / below
