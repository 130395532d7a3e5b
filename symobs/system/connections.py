"""Series, parallel and feedback connections of systems in state space, with the conventions of python-control."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

from symobs.exact import Matrix
from symobs.exact.linear_algebra.realisation import Realisation, closed
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.system.matrices import as_rows
from symobs.system.reading import is_identity, read_matrix

if TYPE_CHECKING:
    from symobs.system.symbols import Symbols

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
    return _made(found, plant, other if isinstance(other, type(plant)) else plant)


def _system(plant: Any) -> Realisation:
    """Return a plant's matrices; raises `InputError` where it cannot be connected."""
    plant.require("B", "C", task="a connection")
    if plant.is_time_varying or not all(map(is_identity, plant.equations)):
        message = "a plant that varies in time, or that is a case of another, cannot be connected"
        raise InputError(message, where="plant", repair="connect plants with constant matrices")
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
