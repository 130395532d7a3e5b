"""Matrices and scalars as terms that every computer algebra system can be told, and what is claimed of them.

Nothing is computed here: a term is written out in the language of a system, which does all the work.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

if TYPE_CHECKING:
    from collections.abc import Sequence

Shape: TypeAlias = tuple[int, int] | None
Rows: TypeAlias = "Sequence[Sequence[object]]"


@dataclass(frozen=True, eq=False)
class Term:
    """An operation and its parts; a scalar has no shape."""

    operation: str
    parts: tuple[Any, ...]
    shape: Shape = None

    def __add__(self, other: Term) -> Term:
        return Term("plus", (self, other), self.shape)

    def __sub__(self, other: Term) -> Term:
        return Term("minus", (self, other), self.shape)

    def __mul__(self, other: Term) -> Term:
        """Multiply by a scalar."""
        return Term("times", (self, other), self.shape or other.shape)

    def __truediv__(self, other: Term) -> Term:
        return Term("over", (self, other), self.shape)

    def __matmul__(self, other: Term) -> Term:
        return Term("dot", (self, other), (rows_of(self), columns_of(other)))

    @property
    def T(self) -> Term:
        return Term("transpose", (self,), (columns_of(self), rows_of(self)))

    @property
    def inverse(self) -> Term:
        return Term("inverse", (self,), self.shape)

    @property
    def determinant(self) -> Term:
        return Term("determinant", (self,))

    def characteristic(self, variable: Term) -> Term:
        """Return det(s I − A)."""
        return (variable * identity(rows_of(self)) - self).determinant

    def entry(self, row: int, column: int) -> Term:
        """Return an entry, counted from 0."""
        return Term("entry", (self, row, column))

    def block(self, rows: range, columns: range) -> Term:
        return Term("block", (self, rows, columns), (len(rows), len(columns)))

    def upper(self, count: int) -> Term:
        return self.block(range(count), range(columns_of(self)))

    def lower(self, count: int) -> Term:
        """Return the rows from this one on."""
        return self.block(range(count, rows_of(self)), range(columns_of(self)))

    def derivative(self, name: str) -> Term:
        return Term("derivative", (self, name), self.shape)

    def at(self, name: str, value: str) -> Term:
        return Term("at", (self, name, value), self.shape)


def rows_of(term: Term) -> int:
    assert term.shape is not None
    return term.shape[0]


def columns_of(term: Term) -> int:
    assert term.shape is not None
    return term.shape[1]


def matrix(table: Rows) -> Term:
    """A matrix of texts, with ** for powers."""
    texts = tuple(tuple(str(entry) for entry in row) for row in table)
    return Term("matrix", texts, (len(texts), len(texts[0])))


def vectors(columns: Sequence[Sequence[object]]) -> Term:
    """The matrix with these columns."""
    return matrix(list(zip(*columns, strict=True)))


def scalar(text: object) -> Term:
    return Term("scalar", (str(text),))


def identity(order: int) -> Term:
    return matrix([[int(i == j) for j in range(order)] for i in range(order)])


def zeros(rows: int, columns: int) -> Term:
    return matrix([[0] * columns for _ in range(rows)])


def stack(*parts: Term) -> Term:
    return Term("stack", parts, (sum(map(rows_of, parts)), columns_of(parts[0])))


def beside(*parts: Term) -> Term:
    return Term("beside", parts, (rows_of(parts[0]), sum(map(columns_of, parts))))


def product(factors: Sequence[Term]) -> Term:
    whole = scalar(1)
    for factor in factors:
        whole = whole * factor
    return whole


def observability_matrix(A: Term, C: Term) -> Term:
    blocks = [C]
    for _ in range(rows_of(A) - 1):
        blocks.append(blocks[-1] @ A)
    return stack(*blocks)


# -- what is claimed ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Claim:
    """What a system is asked to confirm: by itself it has to come to the same.

    zero:  the term vanishes.  rank: the matrix has this rank.  Any other kind is a question that a system has a
    function of its own for, named by the kind, which takes the terms and the data and answers 1 (yes) or 0 (no).
    """

    name: str
    kind: str
    terms: tuple[Term, ...]
    data: Any = None


def zero(name: str, term: Term) -> Claim:
    return Claim(name, "zero", (term,))


def same(name: str, left: Term, right: Term) -> Claim:
    """Two terms are one; of two shapes they are not, without anybody being asked."""
    if left.shape != right.shape:
        return Claim(f"{name}: {left.shape} instead of {right.shape}", "never", ())
    return zero(name, left - right)


def rank(name: str, term: Term, value: int) -> Claim:
    return Claim(name, "rank", (term,), value)
