"""Check of plots against the polynomial they are drawn for, to within visible accuracy (trusted).

The points of a picture are rational and lie near what they stand for; how near is a fixed part of the window.
"""

from __future__ import annotations

from cmath import exp, phase
from fractions import Fraction
from functools import lru_cache
from itertools import chain, dropwhile, islice, pairwise
from math import comb, degrees, hypot, lcm, log10, tau
from operator import itemgetter, mul
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import EIGENVALUE, Matrix, Scalar, product_of
from symobs.exact.algebraic.enclosure import near as enclosed
from symobs.exact.algebraic.enclosure import sign_of_number
from symobs.exact.algebraic.root_location import complex_roots, shifted, value_at
from symobs.exact.core.generators import derivative
from symobs.exact.core.matrix import whole_product
from symobs.formula.figures import (
    BodePicture,
    BranchPicture,
    LinePicture,
    NyquistPicture,
    PoleMap,
    RegionPicture,
    TimeResponse,
)
from symobs.formula.tree import Block, Derivative, Exact, Letter, Literal, Product, Relation, Signal, evaluate
from symobs.proof.certificate.claims import as_scalar, verify
from symobs.proof.derivation.facts import polynomial_of
from symobs.proof.derivation.figures_check import ALLOWS, Stability, faults_of_region, within, written
from symobs.stability.criteria.stability import stability

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.formula.figures import End, Picture, Place, PlottedResponse
    from symobs.formula.tree import Environment, Formula


# Check of a root locus against its polynomial, to within visible accuracy (trusted).
#
# That a root z₀ lies near z follows from p(z + w) = Σ cₖ wᵏ, of degree n: ±cₖ/c₀ is a sum of C(n, k) products of k
# reciprocals of z₀ − z, so one root has |z₀ − z|ᵏ ≤ C(n, k) |c₀/cₖ|.


#: How far a pole may lie from its path, as a part of the window.
_NEAR_POLE = Fraction(1, 200)


def faults_of_poles(picture: PoleMap, polynomial: Scalar, variable: str, *, discrete: bool) -> Iterator[str]:
    """Yield the faults of a root locus."""
    if (picture.variable, picture.discrete) != (variable, discrete):
        yield f"the poles are those in {picture.variable}"
    degree = polynomial.degree(variable)
    if len(picture.paths) != degree or len(picture.along) != degree:
        yield f"there are {len(picture.paths)} poles"
        return
    begin, end = picture.values
    if any(not within(place, picture.window) for path in picture.paths for place in path):
        yield "the poles do not leave the window"
    near = min(high - low for low, high in picture.window) * _NEAR_POLE
    for path, along in zip(picture.paths, picture.along, strict=True):
        falling = sorted(along, reverse=begin > end)
        if len(path) != len(along) or (along[0], along[-1]) != (begin, end) or list(along) != falling:
            yield f"{picture.moved} goes from {begin} to {end}"
            return
        for place, value in zip(path, along, strict=True):
            if not is_pole(polynomial, picture.moved, value, place, variable, near):
                yield f"{written(place)} is a pole at {picture.moved} = {value}"
    if not any(_are_all(picture, polynomial, variable, at) for at in _common(picture)):
        yield "these are all poles"
    if picture.zeros is not None:
        lead, *_ = polynomial.coefficients(picture.moved)
        if begin or len(picture.zeros) != max(lead.degree(variable), 0):
            yield f"there are {len(picture.zeros)} zeros"
        for place in picture.zeros:
            if not is_pole(lead, picture.moved, begin, place, variable, near):
                yield f"{written(place)} is a zero"


def is_pole(polynomial: Scalar, moved: str, value: Fraction, place: Place, variable: str, near: Fraction) -> bool:
    """Return whether a root of a polynomial surely lies near a place where the parameter that is moved has this value."""
    return _has_root_near(_shifted(polynomial, moved, value, place, variable), near)


def _shifted(polynomial: Scalar, moved: str, value: Fraction, place: Place, variable: str) -> list[Place]:
    """Return c₀, …, cₙ of a multiple of p(z + w) = Σ cₖ wᵏ."""
    below, coefficients = _parts(polynomial, variable)
    if value_at(below, {moved: value}) == 0:
        raise ZeroDivisionError
    found = [value_at(c, {moved: value}) for c in coefficients]
    return shifted(list(dropwhile(lambda c: c == 0, found)), place)


@lru_cache(maxsize=4)
def _parts(polynomial: Scalar, variable: str) -> tuple[Scalar, tuple[Scalar, ...]]:
    """Return the denominator of a polynomial and the coefficients of its numerator, highest first."""
    return polynomial.denominator, polynomial.numerator.coefficients(variable)


def _has_root_near(around: Sequence[Place], distance: Fraction) -> bool:
    """Return whether some root surely has |w| ≤ distance."""
    degree = len(around) - 1
    constant = _square(around[0])
    return any(
        comb(degree, k) ** 2 * constant <= distance ** (2 * k) * _square(c) and _square(c) != 0
        for k, c in enumerate(around)
        if k
    )


def _square(value: Place) -> Fraction:
    """Return the square of the modulus."""
    real, imaginary = value
    return real * real + imaginary * imaginary


def _common(picture: PoleMap) -> Iterator[int]:
    """Yield the indices at which all paths stand at the same value of the parameter, from the middle on."""
    shortest = min(map(len, picture.along))
    for index in sorted(range(shortest), key=lambda index: abs(2 * index - shortest)):
        if len({along[index] for along in picture.along}) == 1:
            yield index


def _are_all(picture: PoleMap, polynomial: Scalar, variable: str, index: int) -> bool:
    """Return whether discs that hold a root each lie apart from one another, as many as there are different roots."""
    different = sum(factor.degree(variable) for factor, _ in polynomial.numerator.factors()[1])
    apart: list[tuple[Place, Fraction]] = []
    for path, along in zip(picture.paths, picture.along, strict=True):
        around = _shifted(polynomial, picture.moved, along[index], path[index], variable)
        constant, slope = _square(around[0]), _square(around[1])
        if constant and not slope:
            continue
        radius = (len(around) - 1) ** 2 * constant / slope if constant else Fraction(0)
        if all(_distance(path[index], place) > 2 * (radius + other) for place, other in apart):
            apart.append((path[index], radius))
    return len(apart) >= different


def _distance(a: Place, b: Place) -> Fraction:
    """Return the square of the distance."""
    return (a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2


#: The part of a window that is near a place or an end.
_NEAR = Fraction(1, 500)


def relations_of(picture: Picture) -> tuple[Relation, ...]:
    """Return the equations that are written into a picture."""
    return tuple(curve.equation for curve in picture.curves) if isinstance(picture, RegionPicture) else ()


def faults(picture: Picture, subject: Formula, environment: Environment, *, discrete: bool) -> Iterator[str]:
    """Yield the faults of a plot."""
    if isinstance(picture, TimeResponse):
        if picture.discrete == discrete:
            yield from faults_of_response(picture, subject, environment)
        else:
            yield "another time"
        return
    if isinstance(picture, (NyquistPicture, BodePicture)):
        loop = as_scalar(evaluate(subject, environment, Exact(environment)))
        if picture.delay == as_scalar(environment.values.get("T_t", Scalar.of(0))).fraction():
            yield from faults_of_frequency(picture, loop, environment.variable, discrete=discrete)
        else:
            yield "the dead time"
        return
    if isinstance(picture, BranchPicture):
        if picture.discrete == discrete:
            yield from faults_of_branches(picture, evaluate(subject, environment, Exact(environment)))
        else:
            yield "another time"
        return
    numbers = dict(picture.drawn_for)
    for name, value in numbers.items():
        if not value.is_constant or not ALLOWS[environment.signs.get(name, "real")](value.fraction()):
            yield f"{name} = {value}"
    variable = environment.variable
    value = as_scalar(evaluate(subject, environment, Exact(environment)))
    polynomial = polynomial_of(value, environment).substitute(numbers)
    axes = (picture.moved,) if isinstance(picture, PoleMap) else _axes(picture)
    if not polynomial.names <= {variable, *axes}:
        yield f"the polynomial {polynomial} depends on {', '.join(axes)} alone"
        return
    equations = {relation: _difference(relation, environment, numbers) for relation in relations_of(picture)}
    signs = tuple(environment.signs.get(name, "real") for name in axes)
    test = Stability(polynomial, variable, axes, signs, discrete)
    match picture:
        case RegionPicture():
            yield from faults_of_region(picture, equations, test)
        case LinePicture():
            yield from _of_line(picture, test)
        case _:
            yield from faults_of_poles(picture, polynomial, variable, discrete=discrete)


# Check of branches of equilibria: at each point f is 0 there, and every few of them the linearisation is as it is told.


#: At every so many points of a branch the stability is decided again.
_EVERY = 6
#: What is 0 is so to this many bits.
_BITS_OF_ZERO = 40


def faults_of_branches(picture: BranchPicture, f: object) -> Iterator[str]:
    """Yield the faults of branches of equilibria of f."""
    name, drawn = picture.axes
    if not isinstance(f, Matrix) or f.shape != (len(picture.states), 1):
        yield f"the states are {', '.join(picture.states)}"
        return
    slopes = Matrix.block([[derivative(f, state) for state in picture.states]])
    near = (picture.window[1][1] - picture.window[1][0]) * _NEAR / 8
    for branch in picture.branches:
        for k, (value, height) in enumerate(branch.points):
            numbers = {name: Scalar.of(value)}
            there = {**numbers, **{key: each.substitute(numbers) for key, each in branch.at}}
            found = enclosed(there[drawn], _BITS_OF_ZERO)
            if found is None or abs(found - height) > near or not within((value, height), picture.window):
                yield f"{written((value, height))} lies on a branch"
            at_rest = [there[x] for x in picture.states] if picture.discrete else [Scalar.of(0)] * len(picture.states)
            if not all(_is_small(entry.substitute(there) - x) for entry, x in zip(f.entries, at_rest, strict=True)):
                yield f"the plant rests at {written((value, height))}"
            if k % _EVERY == _EVERY // 2:
                polynomial = slopes.substitute(there).characteristic_polynomial(EIGENVALUE)
                verdict = stability(polynomial, EIGENVALUE, {}, discrete=picture.discrete).verdict
                if verdict != ("yes" if branch.stable else "no"):
                    yield f"{name} = {value} is {'' if branch.stable else 'not '}stable there"
        if len(branch.points) < _EVERY or sorted(branch.points) != list(branch.points):
            yield f"{len(branch.points)} points are a branch"
    for (value, height), exact in picture.marks:
        found = enclosed(exact, _BITS_OF_ZERO)
        across = (picture.window[0][1] - picture.window[0][0]) * _NEAR
        if found is None or abs(found - value) > across or not within((value, height), picture.window):
            yield f"{exact} is {value}"


def _is_small(value: Scalar) -> bool:
    """Return whether a number is 0 as far as it is drawn."""
    found = enclosed(value, _BITS_OF_ZERO)
    return found is not None and abs(found) < Fraction(1, 2 ** (_BITS_OF_ZERO // 2))


# Check of frequency responses: the value of the loop at each place, found exactly; places on the boundary, or outside.


def faults_of_frequency(
    picture: NyquistPicture | BodePicture, loop: Scalar, variable: str, *, discrete: bool
) -> Iterator[str]:
    """Yield the faults of a Nyquist or a Bode picture."""
    above, below = ([c.fraction() for c in p.coefficients(variable)] for p in (loop.numerator, loop.denominator))
    sizes = [_square(place) - 1 if discrete else place[0] for place in picture.contour]
    is_bode, (across, upwards) = isinstance(picture, BodePicture), picture.window
    least = min(across[1] - across[0], upwards[1] - upwards[0])
    slack = Fraction(1, 1 << 40)
    along = [phase(complex(*map(float, s))) % tau if discrete else s[1] for s in picture.contour]
    near, pairs = least * _NEAR_POLE, [(shifted(above, s)[0], shifted(below, s)[0]) for s in picture.contour]
    if picture.delay:
        pairs = [(_lagging(n, s, picture.delay), p) for (n, p), s in zip(pairs, picture.contour, strict=True)]
    beside = [_square(n) > _square(p) for size, (n, p) in zip(sizes, pairs, strict=True) if size > slack]  # near a pole
    is_along = along == sorted(along) and min(sizes) >= -slack and all(beside)
    if picture.discrete != discrete or least <= 0 or not is_along or (is_bode and beside):
        yield "places on the boundary of stability, in a window"
        return
    if isinstance(picture, BodePicture):
        lists = zip(picture.contour, picture.across, picture.levels, picture.phases, pairs, strict=True)
        for place, x, level, angle, (n, p) in lists:
            value, at = complex(*map(float, n)) / complex(*map(float, p)), complex(*map(float, place))
            off = abs(float(angle) - degrees(phase(value))) % 360
            told = log10(phase(at) if discrete else at.imag), 20 * log10(abs(value))
            if max(abs(told[0] - float(x)), abs(told[1] - float(level)), min(off, 360 - off) / 10) > float(near):
                yield f"the value at {written(place)}"
        jumps = [abs(b - a) for a, b in pairwise(picture.phases)]
        if list(picture.across) != sorted(picture.across) or max(jumps, default=0) > 200:
            yield "a phase that does not jump"
        if not _are_asymptotes(picture.asymptotes, above, below, float(near)):
            yield "the asymptotes of the modulus"
        return
    for (u, v), (n, p) in zip(picture.values, pairs, strict=True):
        missed = _square((n[0] - u * p[0] + v * p[1], n[1] - u * p[1] - v * p[0]))
        if missed > _square(p) * max(near * near, (u * u + v * v) * slack):
            yield f"the value {written((u, v))}"
    if not within((Fraction(-1), Fraction(0)), picture.window):
        yield "-1 in the window"


def _are_asymptotes(points: Sequence[Place], above: Sequence[Fraction], below: Sequence[Fraction], near: float) -> bool:
    """Return whether each factor s − p of the loop counts as the larger of ω and |p| at the points and between them."""
    sizes = [[hypot(*map(float, root)) for root in complex_roots(each)] for each in (above, below)]
    lead = log10(abs(above[0] / below[0]))

    def off(x: float, y: float) -> float:
        first, second = (sum(log10(max(10**x, size)) for size in each) for each in sizes)
        return abs(20 * (lead + first - second) - y)

    places = [(float(x), float(y)) for x, y in points]
    between = [((a + b) / 2, (c + d) / 2) for (a, c), (b, d) in pairwise(places)]
    return places == sorted(places, key=itemgetter(0)) and all(off(*place) <= near for place in (*places, *between))


def _lagging(value: Place, place: Place, delay: Fraction) -> Place:
    """Return a value times e^{−sT}, to within the accuracy of binary numbers."""
    found = complex(*map(float, value)) * exp(-complex(*map(float, place)) * float(delay))
    return Fraction(found.real), Fraction(found.imag)


def _axes(picture: RegionPicture | LinePicture) -> tuple[str, ...]:
    return picture.axes if isinstance(picture, RegionPicture) else (picture.axis,)


def _difference(relation: Relation, environment: Environment, numbers: dict[str, Scalar]) -> Scalar:
    """Return a polynomial that vanishes where the equation holds, each factor once; 1 where there is no equation."""
    if relation.operators != ("=",):
        return Scalar.of(1)
    left, right = (as_scalar(evaluate(member, environment, Exact(environment))) for member in relation.members)
    factors = (left - right).substitute(numbers).numerator.factors()[1]
    return product_of(factor for factor, _ in factors)


# -- intervals --------------------------------------------------------------------------------------------------------


def _of_line(picture: LinePicture, test: Stability) -> Iterator[str]:
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


def _of_end(end: End, inward: Fraction, near: Fraction, numbers: dict[str, Scalar], test: Stability) -> Iterator[str]:
    """Yield the faults of an end: stable on the inner side, on the outer not, unless the end alone is taken out."""
    outward = end.place - near if inward > 0 else end.place + near
    is_taken_out = test.is_excluded((end.place,), [(end.place - near,), (end.place + near,)])
    if not test.is_stable(end.place + inward) or (test.is_stable(outward) and not is_taken_out):
        yield f"{end.place} is an end"
    if not _is_labelled(end, near, numbers):
        yield f"{end.label} = {end.place}"


def _between(a: Fraction, b: Fraction) -> Iterator[Fraction]:
    return (a + (b - a) * Fraction(k, 8) for k in range(1, 8))


def _is_labelled(end: End, near: Fraction, numbers: dict[str, Scalar]) -> bool:
    """Return whether the label at an end is its place, to visible accuracy."""
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


# Check of time responses against the equations of the page (trusted).
#
# The values are found anew, in whole numbers with an error that is counted: e^{Mh} from the power series of a small
# part of Mh and by squaring, and then twice as many instants with each power e^{Mh}, e^{2Mh}, e^{4Mh}, …. In discrete
# time they are powers of M times the start, and must be met exactly.


#: Parts of the window: how far a point may lie from what it stands for, and a segment from what it passes between.
_OFF, _BETWEEN = Fraction(1, 500), Fraction(1, 100)
#: The bits of a response, by how much of them rounding at its worst may be wrong, and the bits that are kept until it is not.
_BITS, _OFF_BY, _KEPT = 72, 1 << 8, (192, 512, 1024, 2048, 4096)
#: The series is that of a matrix of norm 2⁻¹⁶ or less, so that each term brings 16 bits.
_SMALL = 16
#: A mode may turn by so much between two instants, less than π: one that turns by 2π more would look the same.
_TURN, _SQUARINGS = 3, 6


def faults_of_response(picture: TimeResponse, subject: Formula, environment: Environment) -> Iterator[str]:
    """Yield the faults of plotted responses."""
    state = Block(tuple((Letter(name),) for name in picture.states))
    for relation in ((Derivative(state), Product((subject, state))), *_signals(picture, state, environment)):
        if verify(Relation(relation, ("=",)), environment)[0] == "":
            yield f"an equation of {', '.join(picture.states)} with this matrix"
            return
    (begin, end), (bottom, top) = picture.window
    counts = {len(response.heights) for response in picture.responses}
    if len(counts) != 1 or min(counts) < 2 or begin != 0 or end <= 0 or bottom >= top or picture.parts < 1:
        yield "a window that begins at 0 and that responses fill"
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
    if not is_slow(matrix, end / (2 * steps)):
        yield "modes that do not turn unseen between two instants"
        return
    rows = tuple(response.row for response in picture.responses)
    values = _followed(matrix, beginning, rows, end / (2 * steps), 2 * steps + 1)
    for response, true in zip(picture.responses, values, strict=True):
        yield from _faults_of_component(response, picture.parts, true, (bottom, top))


def _faults_of_samples(picture: TimeResponse, matrix: Matrix, state: tuple[Fraction, ...]) -> Iterator[str]:
    """Yield the instants at which a discrete-time response differs from row · Mᵏ · start."""
    count = len(picture.responses[0].heights)
    if picture.window[0][1] != count - 1:
        yield "instants other than 0, 1, 2, ..."
        return
    table = [[entry.fraction() for entry in row] for row in matrix.rows]
    heights: list[list[Fraction]] = [[] for _ in picture.responses]
    for _ in range(count):
        for found, response in zip(heights, picture.responses, strict=True):
            found.append(sum(map(mul, response.row, state), Fraction(0)))
        state = tuple(sum(map(mul, row, state), Fraction(0)) for row in table)
    bottom, top = picture.window[1]
    for found, response in zip(heights, picture.responses, strict=True):
        if [height * picture.parts for height in found] != list(response.heights):
            yield f"the response of {response.signal}"
        if min(found) < bottom or max(found) > top:
            yield f"{response.signal}, which leaves the window,"


def _signals(picture: TimeResponse, state: Block, environment: Environment) -> Iterator[tuple[Formula, Formula]]:
    """Yield the equations that make responses components of their signals."""
    for name in dict.fromkeys(response.signal for response in picture.responses):
        rows = {response.component: response.row for response in picture.responses if response.signal == name}
        size = _size(name, environment)
        if sorted(rows) != ([0] if size == 1 else list(range(1, size + 1))):
            raise ValueError(f"not all components of {name}")
        table = Matrix.of([[Scalar.of(part) for part in rows[component]] for component in sorted(rows)])
        yield Letter(name), Product((Literal(table), state))


def _size(name: str, environment: Environment) -> int:
    """Return how many components a signal has."""
    signal = evaluate(Letter(name), environment, Exact(environment))
    return signal.size if isinstance(signal, Signal) else 0


def _faults_of_component(
    response: PlottedResponse, parts: int, true: list[int], edges: tuple[Fraction, Fraction]
) -> Iterator[str]:
    """Yield the instants at which a response is wrong; `true` are its values at all instants and between them."""
    drawn = [(height << _BITS) // parts for height in response.heights]
    bottom, top = (int(edge * (1 << _BITS)) for edge in edges)
    height = top - bottom
    off = [abs(y - value) for y, value in zip(drawn, true[::2], strict=True)]
    between = [abs((a + b) // 2 - value) for (a, b), value in zip(pairwise(drawn), true[1::2], strict=True)]
    if int(max(off)) > height * _OFF or int(max(between)) > height * _BETWEEN:
        yield f"the response of {response.signal}"
    if min(drawn) < bottom or max(drawn) > top:
        yield f"{response.signal}, which leaves the window,"


def is_slow(matrix: Matrix, step: Fraction) -> bool:
    """Return whether |λ| h ≤ 3 for all eigenvalues λ of M: no |λ|ᵏ is larger than ‖Mᵏ‖, here for k = 64."""
    table = [[entry.fraction() for entry in row] for row in matrix.rows]
    common = lcm(*(entry.denominator for row in table for entry in row))
    power = [[int(entry * common) for entry in row] for row in table]
    for _ in range(_SQUARINGS):
        power = whole_product(power, power)
    largest = (common * _TURN / step) ** (1 << _SQUARINGS)
    return all(int(sum(map(abs, row))) <= largest for row in power)


class _Enclosed(NamedTuple):
    """A matrix in parts of 2⁻ᵇⁱᵗˢ, and two norms (largest sums of a row): its own, and a bound for that of its error."""

    rows: list[list[int]]
    norm: int
    error: int

    @classmethod
    def of(cls, rows: list[list[int]], error: int) -> _Enclosed:
        return cls(rows, max(sum(map(abs, row)) for row in rows), error)

    def times(self, other: _Enclosed, bits: int, divisor: int = 1) -> _Enclosed:
        """Return the product by a whole number, each entry rounded down."""
        rows, error = self.product(other, bits)
        return _Enclosed.of(rows if divisor == 1 else [[entry // divisor for entry in row] for row in rows], error)

    def product(self, other: _Enclosed, bits: int) -> tuple[list[list[int]], int]:
        """Return the product in parts that are larger by so many bits, and a bound for its error."""
        rows = [[entry >> bits for entry in row] for row in whole_product(self.rows, other.rows)]
        error = self.norm * other.error + self.error * other.norm + self.error * other.error
        return rows, (error >> bits) + 1 + 2 * len(rows[0])

    def beside(self, other: _Enclosed) -> _Enclosed:
        """Return both matrices side by side."""
        return _Enclosed.of([a + b for a, b in zip(self.rows, other.rows, strict=True)], self.error + other.error)

    def above(self, other: _Enclosed) -> _Enclosed:
        """Return this matrix above another one."""
        return _Enclosed.of(self.rows + other.rows, max(self.error, other.error))


def _rounded(rows: Sequence[Sequence[Fraction]], bits: int) -> _Enclosed:
    """Return a matrix in parts of 2⁻ᵇⁱᵗˢ."""
    return _Enclosed.of([[round(entry * (1 << bits)) for entry in row] for row in rows], len(rows[0]))


@lru_cache(maxsize=2)
def _followed(
    matrix: Matrix, start: tuple[Fraction, ...], rows: tuple[tuple[Fraction, ...], ...], step: Fraction, count: int
) -> list[list[int]]:
    """Return row · state at `count` instants for each row, in parts of 2⁻⁷², each off by less than 2⁸ of them.

    With P = e^{Mh} these are (row Pⁱᵐ) · (Pʲ start), j < m: both factors are doubled, and one product gives all.
    Raises ValueError where rounding leaves fewer bits.
    """
    table = [[entry.fraction() * step for entry in row] for row in matrix.rows]
    for bits in _KEPT:
        power = _exponential(table, bits)
        states, seen = _rounded([(part,) for part in start], bits), _rounded(rows, bits)
        while len(states.rows[0]) ** 2 < count:
            states = states.beside(power.times(states, bits))
            power = power.times(power, bits)
        width = len(states.rows[0])
        while len(seen.rows) * width < count * len(rows):
            seen = seen.above(seen.times(power, bits))
            power = power.times(power, bits)
        found, error = seen.product(states, 2 * bits - _BITS)
        if error < _OFF_BY:
            return [list(islice(chain(*found[k :: len(rows)]), count)) for k in range(len(rows))]
    raise ValueError("a response with too much to compute")


def _exponential(table: list[list[Fraction]], bits: int) -> _Enclosed:
    """Return e^M: the power series of M/2ᵏ, of norm 2⁻¹⁶ at most, squared k times."""
    order = len(table)
    halvings = _SMALL + int(max(sum(map(abs, row), Fraction(0)) for row in table)).bit_length()
    small = _rounded([[entry / (1 << halvings) for entry in row] for row in table], bits)
    term = total = _Enclosed.of([[(i == j) << bits for j in range(order)] for i in range(order)], 0)
    for k in range(1, bits // _SMALL + 1):
        term = term.times(small, bits, k)
        rows = [[a + b for a, b in zip(*pair, strict=True)] for pair in zip(total.rows, term.rows, strict=True)]
        total = _Enclosed.of(rows, total.error + term.error)
    total = total._replace(error=total.error + 1)  # the terms left out: 2⁻¹⁶ᵏ and less, where 16 k > bits
    for _ in range(halvings):
        total = total.times(total, bits)
    return total
