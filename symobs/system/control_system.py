"""State-space and transfer-function systems of python-control, floats read as their shortest decimals."""

from __future__ import annotations

from math import isfinite
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.errors import InputError
from symobs.exact.floating.doubles import nearest_double

if TYPE_CHECKING:
    from symobs.exact import Matrix


class ControlSystem(NamedTuple):
    """The data of a system: numerator and denominator, or else the matrices by name; dt is 0 in continuous time."""

    transfer_function: list[list[str]] | None
    matrices: dict[str, Any]
    dt: Any


def read_control_system(system: Any) -> ControlSystem:
    """Return the data of a python-control system.

    Raises `InputError` where the system has no A, B, C, D and no numerator and denominator of numbers.
    """
    dt = (repr(system.dt) if isinstance(system.dt, float) else system.dt) or 0 if hasattr(system, "dt") else 0
    if not (hasattr(system, "num") and hasattr(system, "den")):
        return ControlSystem(
            None, {name: _shortest_decimals(system, name, getattr(system, name, None)) for name in "ABCD"}, dt
        )
    if len(system.num) != 1 or len(system.num[0]) != 1:
        message = "a transfer matrix has several realisations"
        raise InputError(message, where="plant", repair="convert it by control.ss(system)")
    parts = [_shortest_decimals(system, name, [getattr(system, name)[0][0]])[0] for name in ("num", "den")]
    return ControlSystem(parts, {}, dt)


def exact_of(system: Any) -> Any:
    """Return the exact plant that a system was made of, None where there is none or its floats are others by now."""
    exact = getattr(system, "exact", None)
    if exact is None or not all(_are_of(getattr(exact.matrices, name), getattr(system, name)) for name in "ABCD"):
        return None
    return exact if (exact.dt if isinstance(exact.dt, int) else float(exact.dt)) == system.dt else None


def _are_of(matrix: Matrix, array: Any) -> bool:
    """Return whether an array holds the doubles nearest to the entries of an exact matrix."""
    return bool(array.shape == matrix.shape) and array.reshape(-1).tolist() == [*map(nearest_double, matrix.entries)]


def _shortest_decimals(system: Any, name: str, rows: Any) -> list[list[str]]:
    """Return rows of floats as texts, each the shortest that names the same float."""
    try:
        found = [[float(entry) for entry in (row.tolist() if hasattr(row, "tolist") else row)] for row in rows]
    except (TypeError, ValueError) as error:
        message = (
            f"a python-control state-space system is expected, {type(system).__name__} has no matrix of numbers {name}"
        )
        raise InputError(message, where=f"plant.{name}", repair="convert it by control.ss(system)") from error
    for entry in (entry for row in found for entry in row):
        if not isfinite(entry):
            message = f"{entry} is not a finite number"
            raise InputError(message, where=f"plant.{name}", repair="give finite entries")
    return [[repr(entry) for entry in row] for row in found]
