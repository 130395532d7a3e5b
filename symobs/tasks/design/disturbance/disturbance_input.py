"""How a disturbance enters a plant, ẋ = A x + B u + E d, and what generates it: d = V w, ẇ = S w."""

from __future__ import annotations

from typing import NamedTuple

from symobs.exact import Matrix
from symobs.ground.errors import InputError, ShapeMismatch
from symobs.system import StateSpace, read_matrix
from symobs.system.reading import as_rows
from symobs.system.specification import constant


class Exosystem(NamedTuple):
    """E, S and V of  ẋ = A x + B u + E d,  ẇ = S w,  d = V w."""

    E: Matrix
    S: Matrix
    V: Matrix

    @property
    def order(self) -> int:
        """The number of states of the exosystem."""
        return self.S.shape[0]


def read_exosystem(plant: StateSpace, E: Matrix, S: object, V: object) -> Exosystem:
    """Return the exosystem, that of a constant d where S is left out; raises `InputError` for shapes that do not fit."""
    q = E.shape[1]
    constant = Matrix.identity(q) if plant.is_discrete else Matrix.zeros(q, q)
    model = constant if S is None else read_generator(plant, S)
    order = model.shape[0]
    if V is None and order < q:
        message = f"S has fewer states, {order}, than E has columns, {q}"
        raise ShapeMismatch(message, where="specification.S", repair="give a larger S, or V")
    chosen = Matrix.block([[Matrix.identity(q), Matrix.zeros(q, order - q)]]) if V is None else _matrix(plant, V, "V")
    if chosen.shape != (q, order):
        message = f"V is {chosen.shape[0]}×{chosen.shape[1]}, expected {q}×{order}"
        raise ShapeMismatch(message, where="specification.V", repair=f"write V as a {q}×{order} matrix")
    return Exosystem(E, model, chosen)


def read_generator(plant: StateSpace, S: object) -> Matrix:
    """Return the state matrix of an exosystem; raises `ShapeMismatch` where it is not square."""
    model = _matrix(plant, S, "S")
    order = model.shape[0]
    if model.shape[1] != order:
        message = f"S is {order}×{model.shape[1]}, and must be square"
        raise ShapeMismatch(message, where="specification.S", repair='write for example S = "[0 omega; -omega 0]"')
    return model


def _matrix(plant: StateSpace, value: object, name: str) -> Matrix:
    """Return a matrix, a flat list a row or, for E, a column; raises `InputError` where it contains s or t."""
    where = f"specification.{name}"
    found = read_matrix(as_rows("B" if name == "E" else "C", value), plant.symbols.seen(value), where, functions=True)
    return constant(found, plant, name, where)


def read_disturbance_input(plant: StateSpace, value: object) -> Matrix:
    """Return E, a flat list a column; raises `InputError` where it is missing, has other rows than A, or contains s or t."""
    where, n = "specification.E", plant.order
    if value is None:
        column = "; ".join(str(int(i == n - 1)) for i in range(n))
        message = "E is missing, by which the disturbance enters"
        raise InputError(message, where=where, repair=f'give E = "[{column}]", for example')
    E = _matrix(plant, value, "E")
    if E.shape[0] != n:
        message = f"E has {E.shape[0]} rows, A has {n}"
        raise ShapeMismatch(message, where=where, repair=f"give E {n} rows, a column for each disturbance")
    return E


def with_disturbance(plant: StateSpace, E: Matrix) -> StateSpace:
    """Return the plant with the inputs u and d, which has the parameters of both."""
    m = plant.matrices
    B = Matrix.block([[m.B, E]]) if m.has_input else E
    whole = StateSpace(m.A, B, m.C, dt=plant.dt, symbols=plant.symbols)
    return plant.beside(whole.restricted(plant.equations, plant.nonzero))
