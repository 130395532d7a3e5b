"""Check of time responses against the equations of the page (trusted).

The values are found anew, in whole numbers with an error that is counted: e^{Mh} from the power series of a small part
of Mh and by squaring, and then twice as many instants with each power e^{Mh}, e^{2Mh}, e^{4Mh}, ….  In discrete time
they are powers of M times the start, and must be met exactly.
"""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache
from itertools import islice, pairwise
from math import lcm
from operator import mul
from typing import TYPE_CHECKING, NamedTuple

from symobs.exact import Matrix, Scalar
from symobs.exact.core.rational_matrix import whole_product
from symobs.formula.tree import Block, Derivative, Exact, Letter, Literal, Product, Relation, Signal, evaluate
from symobs.proof.certificate.claims import verify

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.formula.figures.plot import PlottedResponse, TimeResponse
    from symobs.formula.tree import Environment, Formula

#: Parts of the window: how far a point may lie from what it stands for, and a segment from what it passes between.
_NEAR, _BETWEEN = Fraction(1, 500), Fraction(1, 100)
#: Bits that are left when rounding has done its worst, and those that are kept in turn until they are left.
_BITS, _KEPT = 64, (256, 512, 1024, 2048, 4096)
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
    values = _stepped(matrix, beginning, end / (2 * steps), 2 * steps + 1)
    for response in picture.responses:
        yield from _faults_of_component(response, picture.parts, values, (bottom, top))


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
    response: PlottedResponse, parts: int, values: list[list[int]], edges: tuple[Fraction, Fraction]
) -> Iterator[str]:
    """Yield the instants at which a response is wrong; `values` are those at all instants and between them."""
    common = lcm(*(part.denominator for part in response.row))
    row = [int(part * common) for part in response.row]
    true = [sum(map(mul, row, value)) // common for value in values]
    drawn = [(height << _BITS) // parts for height in response.heights]
    bottom, top = (int(edge * (1 << _BITS)) for edge in edges)
    height = top - bottom
    off = [abs(y - value) for y, value in zip(drawn, true[::2], strict=True)]
    between = [abs((a + b) // 2 - value) for (a, b), value in zip(pairwise(drawn), true[1::2], strict=True)]
    if max(off) > height * _NEAR or max(between) > height * _BETWEEN:
        yield f"the response of {response.signal}"
    if min(drawn) < bottom or max(drawn) > top:
        yield f"{response.signal}, which leaves the window,"


def is_slow(matrix: Matrix, step: Fraction) -> bool:
    """Return whether |λ| h ≤ 3 for all eigenvalues λ of M: no |λ|ᵏ is larger than ‖Mᵏ‖, here for k = 64."""
    power = Matrix.of([[Scalar.of(entry.fraction() * step / _TURN) for entry in row] for row in matrix.rows])
    for _ in range(_SQUARINGS):
        power = power @ power
    return all(sum(abs(entry.fraction()) for entry in row) <= 1 for row in power.rows)


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
        rows = [[(entry >> bits) // divisor for entry in row] for row in whole_product(self.rows, other.rows)]
        error = self.norm * other.error + self.error * other.norm + self.error * other.error
        return _Enclosed.of(rows, (error >> bits) // divisor + 1 + 2 * len(rows[0]))


@lru_cache(maxsize=2)
def _stepped(matrix: Matrix, start: tuple[Fraction, ...], step: Fraction, count: int) -> list[list[int]]:
    """Return the state at `count` instants, in parts of 2 to the power of _BITS, each off by at most one.

    Raises ValueError where rounding leaves fewer bits.
    """
    table = [[entry.fraction() * step for entry in row] for row in matrix.rows]
    for bits in _KEPT:
        power = _exponential(table, bits)
        states, error = [[round(part * (1 << bits))] for part in start], 1  # a column for each instant
        while len(states[0]) < count:
            largest = max(max(map(abs, row)) for row in states)
            more = [[entry >> bits for entry in row] for row in whole_product(power.rows, states)]
            error = max(error, ((power.norm * error + power.error * (largest + error)) >> bits) + 3)
            states = [known + new for known, new in zip(states, more, strict=True)]
            power = power.times(power, bits)
        spare = bits - _BITS
        if error < 1 << (spare - 1):
            half = 1 << (spare - 1)
            return [[(part + half) >> spare for part in state] for state in islice(zip(*states, strict=True), count)]
    raise ValueError("a response with too much to compute")


def _exponential(table: list[list[Fraction]], bits: int) -> _Enclosed:
    """Return e^M: the power series of M/2ᵏ, of norm 2⁻¹⁶ at most, squared k times."""
    order = len(table)
    halvings = _SMALL + int(max(sum(map(abs, row), Fraction(0)) for row in table)).bit_length()
    small = _Enclosed.of([[round(entry * (1 << bits) / (1 << halvings)) for entry in row] for row in table], order)
    term = total = _Enclosed.of([[(i == j) << bits for j in range(order)] for i in range(order)], 0)
    for k in range(1, bits // _SMALL + 1):
        term = term.times(small, bits, k)
        rows = [[a + b for a, b in zip(*pair, strict=True)] for pair in zip(total.rows, term.rows, strict=True)]
        total = _Enclosed.of(rows, total.error + term.error)
    total = total._replace(error=total.error + 1)  # the terms left out: 2⁻¹⁶ᵏ and less, where 16 k > bits
    for _ in range(halvings):
        total = total.times(total, bits)
    return total
