"""Matrices and scalars as terms that every computer algebra system can be told, and what is claimed of them.

Nothing is computed here: a term is written out in the language of a system, which does all the work.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence


@dataclass(frozen=True, eq=False)
class Term:
    """An operation, its parts, and numbers and names that belong to it; a scalar has no shape."""

    operation: str
    parts: tuple[Term, ...] = ()
    shape: tuple[int, int] | None = None
    data: Mapping[str, Any] = field(default_factory=dict)

    @property
    def rows(self) -> int:
        assert self.shape is not None
        return self.shape[0]

    @property
    def columns(self) -> int:
        assert self.shape is not None
        return self.shape[1]

    def __add__(self, other: Term) -> Term:
        return Term("plus", (self, other), self.shape)

    def __sub__(self, other: Term) -> Term:
        return Term("minus", (self, other), self.shape)

    def __neg__(self) -> Term:
        return scalar(-1) * self

    def __mul__(self, other: Term) -> Term:
        """Multiply by a scalar."""
        return Term("times", (self, other), self.shape or other.shape)

    def __matmul__(self, other: Term) -> Term:
        return Term("dot", (self, other), (self.rows, other.columns))

    @property
    def T(self) -> Term:
        return Term("transpose", (self,), (self.columns, self.rows))

    @property
    def inverse(self) -> Term:
        return Term("inverse", (self,), self.shape)

    @property
    def determinant(self) -> Term:
        return Term("determinant", (self,))

    def characteristic(self, variable: Term) -> Term:
        """Return det(s I − A)."""
        return (variable * identity(self.rows) - self).determinant

    def entry(self, row: int, column: int) -> Term:
        """Return an entry, counted from 0."""
        return Term("entry", (self,), data={"i": row, "j": column, "i1": row + 1, "j1": column + 1})

    def block(self, rows: range, columns: range) -> Term:
        ends = {"top": rows.start, "bottom": rows.stop, "left": columns.start, "right": columns.stop}
        first = {"top1": rows.start + 1, "left1": columns.start + 1, "last": rows.stop - 1, "edge": columns.stop - 1}
        data = ends | first | {"high": len(rows), "wide": len(columns)}
        return Term("block", (self,), (len(rows), len(columns)), data)

    def upper(self, count: int) -> Term:
        return self.block(range(count), range(self.columns))

    def lower(self, count: int) -> Term:
        """Return the rows from this one on."""
        return self.block(range(count, self.rows), range(self.columns))

    def derivative(self, name: str) -> Term:
        return Term("derivative", (self,), self.shape, {"name": name})

    def at(self, name: str, value: str) -> Term:
        return Term("at", (self,), self.shape, {"name": name, "value": value})


def matrix(table: Sequence[Sequence[object]]) -> Term:
    """A matrix of texts, with ** for powers."""
    texts = [[str(entry) for entry in row] for row in table]
    return Term("matrix", (), (len(texts), len(texts[0])), {"texts": texts})


def vectors(columns: Sequence[Sequence[object]]) -> Term:
    """The matrix with these columns."""
    return matrix(list(zip(*columns, strict=True)))


def scalar(text: object) -> Term:
    return Term("scalar", data={"text": str(text)})


def identity(order: int) -> Term:
    return matrix([[int(i == j) for j in range(order)] for i in range(order)])


def zeros(rows: int, columns: int) -> Term:
    return matrix([[0] * columns for _ in range(rows)])


def stack(*parts: Term) -> Term:
    return Term("stack", parts, (sum(part.rows for part in parts), parts[0].columns))


def beside(*parts: Term) -> Term:
    return Term("beside", parts, (parts[0].rows, sum(part.columns for part in parts)))


def product(factors: Sequence[Term]) -> Term:
    whole = scalar(1)
    for factor in factors:
        whole = whole * factor
    return whole


def observability_matrix(A: Term, C: Term) -> Term:
    blocks = [C]
    for _ in range(A.rows - 1):
        blocks.append(blocks[-1] @ A)
    return stack(*blocks)


# -- what is claimed ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Claim:
    """What a system is asked to confirm: by itself it has to come to the same.

    is: decided already.  zero: the term vanishes.  rank: the matrix has this rank.  Any other kind is a question that a
    system has a function of its own for, named by the kind, which takes the terms and the data and answers yes or no.
    """

    name: str
    kind: str
    terms: tuple[Term, ...] = ()
    data: Any = None


def zero(name: str, term: Term) -> Claim:
    return Claim(name, "zero", (term,))


def same(name: str, left: Term, right: Term) -> Claim:
    """Two terms are one; of two shapes they are not, without anybody being asked."""
    if left.shape != right.shape:
        return Claim(f"{name}: {left.shape} instead of {right.shape}", "is", data=False)
    return zero(name, left - right)


def rank(name: str, term: Term, value: int) -> Claim:
    return Claim(name, "rank", (term,), value)


# -- terms in the language of a system ---------------------------------------------------------------------------------


class Unsupported(Exception):
    """A system has no way to be asked this."""


@dataclass
class Sheet:
    """The parts of one question in order, every shared part once and with a name.

    `operations` are formats of the written parts, all of them with `commas` or `semicolons` between, and the data.
    """

    scalar: Callable[[str], str]
    operations: Mapping[str, str]
    assigned: str
    lines: list[str] = field(default_factory=list)
    names: dict[Term, str] = field(default_factory=dict)

    def write(self, term: Term) -> str:
        """Return the text of a term; what is no plain scalar gets a name."""
        if term in self.names:
            return self.names[term]
        if term.operation == "scalar":
            return self.scalar(term.data["text"])
        if term.operation not in self.operations:
            raise Unsupported(term.operation)
        data = {**term.data, "parts": [self.write(part) for part in term.parts]}
        if term.operation == "matrix":
            row, _, between = self.operations["row"].partition("|")
            data["parts"] = [row.format(",".join(map(self.scalar, entries))) for entries in data["texts"]]
            data["rows"] = between.join(data["parts"])
        if "text" in data:
            data["text"] = self.scalar(data["text"])
        found = data.pop("parts")
        written = self.operations[term.operation].format(
            *found, **data, commas=",".join(found), semicolons=";".join(found), count=len(found)
        )
        name = self.names[term] = f"v{len(self.names)}"
        self.lines.append(self.assigned.format(name, written))
        return name
