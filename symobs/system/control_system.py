"""State-space and transfer-function systems of python-control."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.exact.floating.doubles import nearest_double
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from symobs.exact import Matrix


class ControlSystem(NamedTuple):
    """The data of a system: rows of numerators over denominators, or else the matrices by name; dt is 0 in continuous time."""

    transfer_function: list[list[Any]] | None
    matrices: dict[str, Any]
    dt: Any


def read_control_system(system: Any) -> ControlSystem:
    """Return the data of a python-control system.

    Raises `InputError` where the system has no A, B, C, D and no numerator and denominator of numbers.
    """
    dt = (repr(system.dt) if isinstance(system.dt, float) else system.dt) or 0 if hasattr(system, "dt") else 0
    if hasattr(system, "num") and hasattr(system, "den"):
        try:
            rows = [
                [[above.tolist(), below.tolist()] for above, below in zip(*row, strict=True)]
                for row in zip(system.num, system.den, strict=True)
            ]
        except (AttributeError, TypeError) as error:
            message = f"a system of python-control is expected, but a {type(system).__name__} came"
            raise InputError(message, where="plant", repair="give what control.ss or control.tf returns") from error
        return ControlSystem(rows[0][0] if len(rows) == len(rows[0]) == 1 else rows, {}, dt)
    for name in "ABCD":
        if getattr(getattr(system, name, None), "dtype", None) is None or getattr(system, name).dtype.kind not in "iuf":
            message = (
                f"a python-control state-space system is expected, {type(system).__name__} has no matrix of numbers "
                f"{name}"
            )
            raise InputError(message, where=f"plant.{name}", repair="convert it by control.ss(system)")
    return ControlSystem(None, {name: getattr(system, name) for name in "ABCD"}, dt)


def exact_of(system: Any) -> Any:
    """Return the exact plant that a system was made of, None where there is none or its floats are others by now."""
    exact = getattr(system, "exact", None)
    if exact is None or not all(_are_of(getattr(exact.matrices, name), getattr(system, name)) for name in "ABCD"):
        return None
    return exact if (exact.dt if isinstance(exact.dt, int) else float(exact.dt)) == system.dt else None


def _are_of(matrix: Matrix, array: Any) -> bool:
    """Return whether an array holds the doubles nearest to the entries of an exact matrix."""
    return bool(array.shape == matrix.shape) and array.reshape(-1).tolist() == [*map(nearest_double, matrix.entries)]
