"""Transfer matrices as given, and a minimal realisation of them."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix, Scalar, companion, product_of, rank, reduced_echelon, transfer_matrix
from symobs.exact.core.generators import identities
from symobs.formula.expression import parse_matrix
from symobs.formula.expression.written_fraction import parse_fractions
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, CertificateRejected, InputError, ShapeMismatch
from symobs.system.reading import require_known
from symobs.system.transfer_function_text import (
    MOST_STATES,
    WrittenTransferFunction,
    over_data,
    read_transfer_function,
    written_over,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from symobs.system.symbols import Symbols


@dataclass(frozen=True)
class WrittenTransferMatrix:
    """A matrix of unreduced rational functions of the variable."""

    rows: tuple[tuple[WrittenTransferFunction, ...], ...]

    @property
    def _entries(self) -> Iterator[WrittenTransferFunction]:
        return (entry for row in self.rows for entry in row)

    @cached_property
    def value(self) -> Matrix:
        """The matrix, its entries in lowest terms."""
        return Matrix.of([[entry.value for entry in row] for row in self.rows])

    @property
    def cancelled(self) -> Scalar:
        """The product of the factors of the denominators that cancel in the entries, 1 if nothing cancels."""
        return product_of(entry.cancelled for entry in self._entries)

    @property
    def below(self) -> Scalar:
        """The product of the denominators in which something cancels."""
        return product_of(entry.below for entry in self._entries if not entry.cancelled.is_one)

    @property
    def apart(self) -> tuple[Scalar, ...]:
        """The cancelled factors in the parameters alone, which are nonzero wherever the matrix is defined."""
        return tuple(dict.fromkeys(factor for entry in self._entries for factor in entry.apart))

    def realised(self, where: str) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """Return a minimal realisation; raises `InputError` where functions in it depend on each other."""
        functions = require_known([self.value], where)
        meanings, relations = identities([self.value])
        if not {*meanings}.isdisjoint(self.value.names) or any(
            relation.names <= self.value.names for relation in relations
        ):
            listed = ", ".join(sorted(function.text for function in functions))
            message = f"the functions of the transfer matrix depend on each other: {listed}"
            raise InputError(message, where=where, repair="give A, B and C, or write all of them with one function")
        return minimal_realisation(self.value, next(self._entries).variable, where)


def read_written(
    value: object, symbols: Symbols, variable: str, where: str
) -> WrittenTransferFunction | WrittenTransferMatrix:
    """Return a transfer function, or the matrix of several that a text in brackets, nested lists or SymPy give."""
    if isinstance(value, str) and value.lstrip().startswith("["):
        found = parse_matrix(value, symbols.names, variable=variable, where=where, functions=True).rows
        written = parse_fractions(value, symbols.names, variable=variable, where=where)
        pairs = [list(zip(*rows, strict=True)) for rows in zip(written, found, strict=True)]
        return _of_rows(
            [
                [
                    written_over(*over_data(*(w or (f.numerator, f.denominator)), variable, where), variable)
                    for w, f in row
                ]
                for row in pairs
            ]
        )
    rows = _rows_of(value, variable)
    if rows is None:
        return read_transfer_function(value, symbols, variable, where)
    if len({len(row) for row in rows}) > 1:
        message = f"rows of different lengths {sorted({len(row) for row in rows})}"
        raise ShapeMismatch(message, where=where, repair="give every row the same number of entries")
    return _of_rows(
        [
            [read_transfer_function(entry, symbols, variable, f"{where}[{i}][{j}]") for j, entry in enumerate(row)]
            for i, row in enumerate(rows)
        ]
    )


def _of_rows(rows: Sequence[Sequence[WrittenTransferFunction]]) -> WrittenTransferFunction | WrittenTransferMatrix:
    """Return the one function there is, or a matrix."""
    return rows[0][0] if len(rows) == len(rows[0]) == 1 else WrittenTransferMatrix(tuple(map(tuple, rows)))


def _rows_of(value: Any, variable: str) -> list[list[Any]] | None:
    """Return the rows of a matrix of functions, None for one function: two lists of coefficients have no variable."""
    if hasattr(value, "tolist") and len(getattr(value, "shape", ())) == 2:  # a matrix or an array
        value = value.tolist()
    if (
        not isinstance(value, (list, tuple))
        or not value
        or not all(isinstance(row, (list, tuple)) and row for row in value)
    ):
        return None
    entries = [entry for row in value for entry in row]
    if not any(isinstance(entry, (list, tuple)) or _has(variable, entry) for entry in entries):
        return None
    return [list(row) for row in value]


def _has(variable: str, entry: object) -> bool:
    """Return whether a text or an expression contains the variable."""
    if isinstance(entry, str):
        return variable in entry
    return any(str(symbol) == variable for symbol in getattr(entry, "free_symbols", ()))


def minimal_realisation(G: Matrix, variable: str, where: str) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return a controllable and observable (A, B, C, D) with C (sI − A)⁻¹ B + D = G(s), G proper.

    Each column over its common denominator has a controllable canonical form; beside one another they are a controllable
    realisation of G.  Let W be the reduced echelon form of its observability matrix.  Then W A = A_o W with A_o = W A
    at the pivot columns, and (A_o, W B, C at the pivot columns, D) is observable too (Kalman).  Rows take the place of
    columns where they have fewer states.

    Raises `InputError` where G is not proper or has no pole, `BudgetExceeded` where it has too many.
    """
    for i, row in enumerate(G.rows):
        for j, entry in enumerate(row):
            if entry.numerator.degree(variable) > entry.denominator.degree(variable):
                repair = "the degree of the numerator may not exceed the denominator's"
                raise InputError(f"{entry} is not proper", where=f"{where}[{i}][{j}]", repair=repair)
    by_rows = _states(G.T, variable) < _states(G, variable)
    if min(_states(G, variable), _states(G.T, variable)) > MOST_STATES:
        message = f"a transfer matrix whose common denominators have together more than {MOST_STATES} roots"
        raise BudgetExceeded(message, where=where, repair="give one of lower order")
    if not _states(G, variable):
        message = "the transfer matrix has no pole, so it has no state"
        raise InputError(message, where=where, repair=f"give proper rational functions of {variable}")
    A, B, C, D = _observable_part(*_by_columns(G.T if by_rows else G, variable))
    found = (A.T, C.T, B.T, D.T) if by_rows else (A, B, C, D)
    _check(found, G, variable)
    return found


def _common(column: Sequence[Scalar], variable: str) -> Scalar:
    """Return the monic common denominator of functions."""
    below = Matrix.column(column).common_denominator()
    return below / below.coefficients(variable)[0]


def _states(G: Matrix, variable: str) -> int:
    """Return how many states the realisation by columns has."""
    return sum(_common(column, variable).degree(variable) for column in G.T.rows)


def _by_columns(G: Matrix, variable: str) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return the controllable realisation by columns."""
    order, (outputs, inputs) = _states(G, variable), G.shape
    A, B, C, D = (
        [[Scalar.of(0)] * columns for _ in range(rows)]
        for rows, columns in ((order, order), (order, inputs), (outputs, order), (outputs, inputs))
    )
    first = 0
    for j, column in enumerate(G.T.rows):
        below = _common(column, variable)
        degree = below.degree(variable)
        monic = below.coefficients(variable)[1:]
        for k, row in enumerate(companion(monic).rows if degree else ()):
            A[first + k][first : first + degree] = row
        if degree:
            B[first + degree - 1][j] = Scalar.of(1)
        for i, entry in enumerate(column):
            coefficients = (entry * below).coefficients(variable)
            padded = [Scalar.of(0)] * (degree + 1 - len(coefficients)) + list(coefficients)
            D[i][j] = padded[0]
            rest = [b - padded[0] * a for a, b in zip(monic, padded[1:], strict=True)]
            C[i][first : first + degree] = reversed(rest)
        first += degree
    return Matrix.of(A), Matrix.of(B), Matrix.of(C), Matrix.of(D)


def _observability_matrix(A: Matrix, C: Matrix) -> Matrix:
    blocks = [C]
    for _ in range(A.shape[0] - 1):
        blocks.append((blocks[-1] @ A).normal())
    return Matrix.block([[part] for part in blocks])


def _observable_part(A: Matrix, B: Matrix, C: Matrix, D: Matrix) -> tuple[Matrix, Matrix, Matrix, Matrix]:
    """Return the system on the row space of its observability matrix, in the basis of its reduced echelon form."""
    pivots, W = reduced_echelon(_observability_matrix(A, C))
    if len(pivots) == A.shape[0]:
        return A, B, C, D
    every = range(len(pivots))
    return (W @ A).select(every, pivots), (W @ B).normal(), C.select(range(C.shape[0]), pivots), D


def _check(found: tuple[Matrix, Matrix, Matrix, Matrix], G: Matrix, variable: str) -> None:
    """Raise `CertificateRejected` unless this is a minimal realisation of G."""
    A, B, C, _ = found
    numerators, characteristic = transfer_matrix(*found, variable)
    right = all(
        entry == below * characteristic
        for row, wanted in zip(numerators.rows, G.rows, strict=True)
        for entry, below in zip(row, wanted, strict=True)
    )
    ranks = {rank(_observability_matrix(A, C)), rank(_observability_matrix(A.T, B.T))}
    if not right or ranks != {A.shape[0]}:
        message = "the realisation found is none, or is not minimal"
        raise CertificateRejected(message, repair="please report this: it is a bug of symobs")
