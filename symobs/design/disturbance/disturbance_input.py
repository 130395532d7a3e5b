"""How a disturbance enters a plant: E of  ẋ = A x + B u + E d."""

from __future__ import annotations

from symobs.errors import InputError, ShapeMismatch
from symobs.exact import Matrix
from symobs.system import StateSpace, read_matrix
from symobs.system.matrices import as_rows


def read_disturbance_input(plant: StateSpace, value: object) -> Matrix:
    """Return E, a flat list a column; raises `InputError` where it is missing, has other rows than A, or contains s or t."""
    where, n = "specification.E", plant.order
    if value is None:
        column = "; ".join(str(int(i == n - 1)) for i in range(n))
        message = "E is missing, by which the disturbance enters"
        raise InputError(message, where=where, repair=f'give E = "[{column}]", for example')
    E = read_matrix(as_rows("B", value), plant.symbols.seen(value), where)
    if E.shape[0] != n:
        message = f"E has {E.shape[0]} rows, A has {n}"
        raise ShapeMismatch(message, where=where, repair=f"give E {n} rows, a column for each disturbance")
    if E.names & {plant.variable, "t"}:
        message = "E contains a name that stands for the time or the variable of polynomials"
        raise InputError(message, where=where, repair="give the parameter another name")
    return E


def with_disturbance(plant: StateSpace, E: Matrix) -> StateSpace:
    """Return the plant with the inputs u and d, which has the parameters of both."""
    m = plant.matrices
    B = Matrix.block([[m.B, E]]) if m.has_input else E
    whole = StateSpace(m.A, B, m.C, dt=plant.dt, symbols=plant.symbols)
    return plant.beside(whole.restricted(plant.equations, plant.nonzero))
