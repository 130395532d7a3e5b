"""State-space and transfer-function systems of python-control."""

from __future__ import annotations

from typing import Any, NamedTuple

from symobs.errors import InputError


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
