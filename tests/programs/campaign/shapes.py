"""Matrices at random: dense, in Jordan blocks, with hidden states, with parameters; in plain fractions and texts."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Sequence
    from random import Random

Table: TypeAlias = list[list[Fraction]]
Texts: TypeAlias = list[list[str]]

#: Numbers that stand where a few others than small integers are wanted.
_FRACTIONS = [Fraction(p, q) for p in range(-5, 6) for q in (2, 3, 4, 5) if p % q]


@dataclass
class Shape:
    """A plant as texts, and what is known of it from how it was made."""

    A: Texts
    B: Texts
    C: Texts
    D: Texts
    signs: dict[str, str] = field(default_factory=dict)
    discrete: bool = False
    #: Real eigenvalues that no feedback moves: tempting as desired poles.
    hidden: list[str] = field(default_factory=list)
    #: A = V J V⁻¹ as Jordan blocks (eigenvalue, size), where it was made so.
    jordan: tuple[Table, list[tuple[int, int]], Table] | None = None

    @property
    def order(self) -> int:
        return len(self.A)

    @property
    def inputs(self) -> int:
        return len(self.B[0])

    @property
    def outputs(self) -> int:
        return len(self.C)


def times(left: Table, right: Table) -> Table:
    columns = list(zip(*right, strict=True))
    return [[sum((a * b for a, b in zip(row, column, strict=True)), Fraction()) for column in columns] for row in left]


def texts(table: Table) -> Texts:
    return [[str(entry) for entry in row] for row in table]


def identity(order: int) -> Table:
    return [[Fraction(i == j) for j in range(order)] for i in range(order)]


def number(random: Random, size: int = 3, fractions: float = 0.05) -> Fraction:
    """A small integer, rarely a fraction, often zero."""
    if random.random() < fractions:
        return random.choice(_FRACTIONS)
    return Fraction(0 if random.random() < 0.2 else random.randint(-size, size))


def dense(random: Random, rows: int, columns: int, fractions: float = 0.05) -> Table:
    """A matrix of small numbers, never 0 as a whole."""
    table = [[number(random, fractions=fractions) for _ in range(columns)] for _ in range(rows)]
    if not any(any(row) for row in table):
        table[random.randrange(rows)][random.randrange(columns)] = Fraction(random.choice([-2, -1, 1, 3]))
    return table


def coordinates(random: Random, order: int, shears: int = 4) -> tuple[Table, Table]:
    """An integer matrix of determinant 1, a product of shears, and its inverse."""
    T, back = identity(order), identity(order)
    for _ in range(random.randint(0, shears) if order > 1 else 0):
        i, j = random.sample(range(order), 2)
        factor = random.choice([-2, -1, 1, 2])
        T[i] = [a + factor * b for a, b in zip(T[i], T[j], strict=True)]
        for row in back:
            row[j] -= factor * row[i]
    return T, back


def chains(random: Random, order: int) -> list[tuple[int, int]]:
    """Jordan blocks: eigenvalue and size, few eigenvalues so that some share one."""
    blocks = []
    left = order
    while left:
        size = random.randint(1, left)
        blocks.append((random.randint(-3, 1), size))
        left -= size
    return blocks


def block_matrix(blocks: Sequence[tuple[int, int]]) -> Table:
    order = sum(size for _, size in blocks)
    J = [[Fraction()] * order for _ in range(order)]
    start = 0
    for value, size in blocks:
        for k in range(start, start + size):
            J[k][k] = Fraction(value)
            if k + 1 < start + size:
                J[k][k + 1] = Fraction(1)
        start += size
    return J


# -- the shapes --------------------------------------------------------------------------------------------------------


def numeric(random: Random, order: int, inputs: int, outputs: int) -> Shape:
    A, B, C = (dense(random, rows, columns) for rows, columns in ((order, order), (order, inputs), (outputs, order)))
    return Shape(texts(A), texts(B), texts(C), zero(outputs, inputs))


def defective(random: Random, order: int, inputs: int, outputs: int) -> Shape:
    """Jordan blocks behind a change of coordinates."""
    blocks = chains(random, order)
    T, back = coordinates(random, order)
    A = times(times(T, block_matrix(blocks)), back)
    B, C = dense(random, order, inputs, 0), dense(random, outputs, order, 0)
    return Shape(texts(A), texts(B), texts(C), zero(outputs, inputs), jordan=(T, blocks, back))


def hidden(random: Random, order: int, inputs: int, outputs: int) -> Shape:
    """States that no output shows, or no input moves, or both, behind a change of coordinates."""
    A, B, C = (dense(random, *shape, 0) for shape in ((order, order), (order, inputs), (outputs, order)))
    count = random.randint(1, max(1, order - 1))
    which = random.choice(["unobservable", "uncontrollable", "both"])
    for i in range(order):
        for j in range(count):
            if i >= count or i > j:
                if which != "uncontrollable":
                    A[i][j] = Fraction()
                if which != "unobservable":
                    A[j][i] = Fraction()
    for row in C if which != "uncontrollable" else []:
        row[:count] = [Fraction()] * count
    if which != "unobservable":
        B = [[Fraction()] * inputs if i < count else row for i, row in enumerate(B)]
    modes = [str(A[j][j]) for j in range(count)]
    T, back = coordinates(random, order)
    A, B, C = times(times(T, A), back), times(T, B), times(C, back)
    return Shape(texts(A), texts(B), texts(C), zero(outputs, inputs), hidden=modes)


_FORMS = [
    "{0}",
    "{0}",
    "-{0}",
    "{0}+1",
    "2*{0}-{1}",
    "{0}*{1}",
    "1/{0}",
    "{0}^2",
    "-{0}^2",
    "{0}/{1}",
    "{0}-{1}",
    "1-{0}",
]
_SIGNS = ["positive", "positive", "real", "nonzero", "negative", "nonnegative"]


def parametric(random: Random, order: int, inputs: int, outputs: int, shape: Shape | None = None) -> Shape:
    """A sparse plant some of whose entries are expressions in one to three parameters."""
    made = shape or numeric(random, order, inputs, outputs)
    names = ["a", "b", "c"][: random.choice([1, 2, 2, 3])]
    made.signs = {name: random.choice(_SIGNS) for name in names}
    for _ in range(random.randint(1, 3)):
        table = random.choice([made.A, made.A, made.A, made.B, made.C])
        row = random.choice(table)
        form = random.choice(_FORMS).format(*(random.sample(names, 2) if len(names) > 1 else names * 2))
        row[random.randrange(len(row))] = form
    used = "".join("".join(row) for table in (made.A, made.B, made.C) for row in table)
    made.signs = {name: sign for name, sign in made.signs.items() if name in used}
    made.hidden, made.jordan = [], None
    return made


def zero(rows: int, columns: int) -> Texts:
    return [["0"] * columns for _ in range(rows)]


def feedthrough(random: Random, shape: Shape) -> Shape:
    """The plant with a D that is not 0."""
    shape.D = texts(dense(random, shape.outputs, shape.inputs, 0))
    return shape
