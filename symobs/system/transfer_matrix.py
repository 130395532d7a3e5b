"""Transfer matrices as given, and a minimal realisation of them."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, TypeVar

from symobs.exact import Matrix, Scalar, companion, product_of, rank, reduced_echelon, transfer_matrix
from symobs.exact.core.generators import identities
from symobs.exact.linear_algebra.transfer_function import Realisation, closed
from symobs.formula.expression import parse_matrix
from symobs.formula.expression.written_fraction import parse_fractions
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import BudgetExceeded, CertificateRejected, InputError, ShapeMismatch
from symobs.system.reading import as_rows, is_identity, read_matrix, require_known
from symobs.system.transfer_function_text import (
    MOST_STATES,
    REALISATIONS,
    WrittenTransferFunction,
    over_data,
    read_transfer_function,
    written_over,
)

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.system.symbols import Symbols


@dataclass
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

    def realised(self, where: str, signs: Mapping[str, str]) -> tuple[Matrix, Matrix, Matrix, Matrix]:
        """Return a minimal realisation; raises `InputError` where functions in it depend on each other."""
        functions = require_known([self.value], signs, where)
        meanings, relations = identities([self.value])
        if not {*meanings}.isdisjoint(self.value.names) or any(
            relation.names <= self.value.names for relation in relations
        ):
            listed = ", ".join(sorted(function.text for function in functions))
            message = f"the functions of the transfer matrix depend on each other: {listed}"
            raise InputError(message, where=where, repair="give A, B and C, or write all of them with one function")
        return minimal_realisation(self.value, next(self._entries).variable, where)


def read_written(
    value: object, symbols: Symbols, variable: str, where: str, realisation: object = None
) -> WrittenTransferFunction | WrittenTransferMatrix:
    """Return a transfer function with the coordinates of its realisation, or a matrix of functions.

    Raises `InputError` for other coordinates than there are, and where they are named for a matrix.
    """
    written = _read_written(value, symbols, variable, where)
    if realisation is None:
        return written
    place = where.replace("transfer_function", "realisation")
    if realisation not in REALISATIONS:
        message = f"{str(realisation)[:40]!r} is no kind of realisation"
        raise InputError(message, where=place, repair=f"write one of {', '.join(REALISATIONS)}")
    if isinstance(written, WrittenTransferMatrix):
        message = "a matrix of transfer functions has a minimal realisation, in coordinates of its own"
        raise InputError(message, where=place, repair="leave it out")
    return replace(written, realisation=str(realisation))


def _read_written(
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
                    written_over(
                        *over_data(*(w or (f.numerator, f.denominator)), variable, where, symbols.signs), variable
                    )
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
    if (rows := _over_one_denominator(value)) is not None:
        return rows
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


def _over_one_denominator(value: Any) -> list[list[Any]] | None:
    """Return the rows of functions of ([[n, n], [n, n]], d), numerators over a common denominator; None for other values."""
    if not isinstance(value, (list, tuple)) or len(value) != 2:
        return None
    above, below = (part.tolist() if hasattr(part, "tolist") else part for part in value)
    are_lists = all(isinstance(part, (list, tuple)) and part for part in (above, below))
    if not are_lists or not all(isinstance(row, (list, tuple)) for row in above):
        return None
    if any(isinstance(part, (list, tuple)) for part in below):
        return None
    return [[(entry if isinstance(entry, (list, tuple)) else [entry], below) for entry in row] for row in above]


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
        raise CertificateRejected("the realisation found is none, or is not minimal")


# Series, parallel and feedback connections of systems in state space, with the conventions of python-control.


#: A `StateSpace`, whose methods these are.
Plant = TypeVar("Plant", bound=Any)


def series(first: Realisation, second: Realisation) -> Realisation:
    """Return the second system driven by the output of the first, in (x₁, x₂)."""
    zero = Matrix.zeros(first.A.shape[0], second.A.shape[0])
    return Realisation(
        Matrix.block([[first.A, zero], [second.B @ first.C, second.A]]).normal(),
        Matrix.block([[first.B], [second.B @ first.D]]).normal(),
        Matrix.block([[second.D @ first.C, second.C]]).normal(),
        (second.D @ first.D).normal(),
    )


def parallel(first: Realisation, second: Realisation) -> Realisation:
    """Return the sum of the outputs of two systems with one input, in (x₁, x₂)."""
    n, m = first.A.shape[0], second.A.shape[0]
    return Realisation(
        Matrix.block([[first.A, Matrix.zeros(n, m)], [Matrix.zeros(m, n), second.A]]),
        Matrix.block([[first.B], [second.B]]),
        Matrix.block([[first.C, second.C]]),
        (first.D + second.D).normal(),
    )


def connected(kind: str, plant: Plant, other: object) -> Plant:
    """Return the connection of a plant with another one, or with a gain; raises `InputError` where they do not fit."""
    other = getattr(other, "as_plant", other)
    first, second = _system(plant), _of_other(plant, other)
    size = {"series": first.D.shape[1], "gain": first.D.shape[0]}.get(kind, 1)
    if not isinstance(other, type(plant)) and second.D.shape == (1, 1) != (size, size):  # a number, for each of several
        second = _gain(Matrix.identity(size) * second.D[0, 0])
    fits = {
        "series": (first.D.shape[1], second.D.shape[0]),
        "gain": (first.D.shape[0], second.D.shape[1]),
        "parallel": (first.D.shape, second.D.shape),
    }.get(kind, (first.D.shape, second.D.shape[::-1]))
    if fits[0] != fits[1]:
        sizes = " and ".join(f"{D.shape[0]}×{D.shape[1]}" for D in (first.D, second.D))
        message = f"plants of {sizes} outputs by inputs cannot be connected in {kind.replace('gain', 'series')}"
        raise ShapeMismatch(message, where="plant", repair="connect plants whose inputs and outputs fit")
    if kind == "series":
        found = series(second, first)
    elif kind == "gain":
        found = series(first, second)
    elif kind == "parallel":
        found = parallel(first, second)
    else:
        if kind != "feedback":
            second = second._replace(C=-second.C, D=-second.D)
        if (Matrix.identity(first.D.shape[1]) + second.D @ first.D).determinant().is_zero:
            message = "the loop is algebraic: I + D₂ D₁ is singular"
            raise InputError(message, where="plant", repair="give a plant without feedthrough to one of the two")
        found = closed(first, second)
    beside = other if isinstance(other, type(plant)) else plant
    connection: Plant = _made(found, plant, beside).restricted((), (*plant.nonzero, *beside.nonzero))
    return connection


def _system(plant: Any) -> Realisation:
    """Return a plant's matrices; raises `InputError` where it cannot be connected."""
    plant.require("B", "C", task="a connection")
    if plant.is_time_varying or not all(map(is_identity, plant.equations)):
        message = "a plant that varies in time, or that is a case of another, cannot be connected"
        raise InputError(message, where="plant", repair="connect plants with constant matrices")
    if plant.delay is not None:
        message = "a plant with a dead time cannot be connected"
        raise InputError(
            message, where="plant.delay", repair="connect the plants without it, and give it to the connection"
        )
    m = plant.matrices
    return Realisation(m.A, m.B, m.C, m.D)


def _of_other(plant: Any, other: Any) -> Realisation:
    """Return the other plant's matrices, or those of a gain."""
    if isinstance(other, type(plant)):
        return _system(other)
    return _gain(read_matrix(as_rows("D", other), plant.symbols.seen(other), "plant", functions=True))


def inverse_of(plant: Any, number: object) -> Matrix:
    """Return 1/k as a gain; raises `InputError` for 0, and for what is no number."""
    found = None if isinstance(number, type(plant)) else _of_other(plant, number).D
    if found is None or found.shape != (1, 1) or found.is_zero:
        message = "a plant is divided by a number that is not 0"
        raise InputError(message, where="plant", repair="write P/2, or P.feedback(Q) for a closed loop")
    return found.inverse()


def _gain(D: Matrix) -> Realisation:
    rows, columns = D.shape
    return Realisation(Matrix.zeros(0, 0), Matrix.zeros(0, columns), Matrix.zeros(rows, 0), D)


def _made(found: Realisation, plant: Plant, other: Any) -> Plant:
    """Return the plant of a connection, with the symbols of both."""
    periods = {time for time in (plant.time, other.time) if getattr(time, "period", 0) is not None}
    if plant.is_discrete != other.is_discrete or len(periods) > 1:
        message = f"the plants have different sampling periods, {plant.dt} and {other.dt}"
        raise InputError(message, where="plant.dt", repair="give both the same dt")
    dt = next((p.dt for p in (plant, other) if p.dt is not True), True)
    made: Plant = type(plant)(*found, dt, symbols=_together(plant.symbols, other.symbols))
    made.is_from_floats = plant.is_from_floats or other.is_from_floats
    made.is_in_decimals = plant.is_in_decimals or other.is_in_decimals
    return made


def _together(first: Symbols, second: Symbols) -> Symbols:
    """Return the symbols of both; raises `InputError` where a name has two signs or is two symbols."""
    for name in first.signs.keys() & second.signs.keys():
        if first.signs[name] != second.signs[name]:
            message = f"{name} is {first.signs[name]} in one plant and {second.signs[name]} in the other"
            raise InputError(message, where=f"symbols.{name}", repair="declare it alike in both")
    known = first.seen(list(second.objects.values()))
    return replace(
        known,
        signs={**known.signs, **second.signs},
        latex={**second.latex, **known.latex},
        closed=first.closed and second.closed,
    )
