"""The systems that a design consists of: as systems of python-control, and the one of them that a program runs.

This module is below the type of results, which therefore has no name here.
"""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.exact.algebraic.enclosure import is_number
from symobs.exact.core.generators import symbols_in
from symobs.exact.floating.sampled import nearest_double
from symobs.ground.errors import InputError, UsageError
from symobs.system import StateSpace

if TYPE_CHECKING:
    from collections.abc import Iterable

    from symobs.exact import Matrix
    from symobs.exact.linear_algebra.transfer_function import Realisation


class Controller(NamedTuple):
    """The system that a program runs: its inputs and its output with their sizes; `returns` where that is the plant's input."""

    name: str
    system: Realisation
    inputs: tuple[tuple[str, int], ...]
    output: tuple[str, int]
    returns: bool
    gains: tuple[str, ...]


def observer_of(result: Any) -> Controller | None:
    """Return the observer of a design as a program runs it, None where there is none."""
    system, plant = result.systems.get("observer"), result.plant
    if system is None:
        return None
    inputs = (("u", plant.inputs), ("y", plant.outputs)) if plant.inputs else (("y", plant.outputs),)
    return Controller("observer", system, inputs, ("x_hat", plant.order), returns=False, gains=("L",))


def require_numbers(matrices: Iterable[Matrix], wanted: str) -> None:
    """Raise `InputError` where matrices contain letters, naming them and how to give them values."""
    names = {
        name for matrix in matrices for entry in matrix.entries if not is_number(entry) for name in symbols_in(entry)
    }
    if names:
        listed = ", ".join(sorted(names))
        message = f"{wanted} needs numbers, and {listed} {'has' if len(names) == 1 else 'have'} no value"
        first = min(names)
        raise InputError(message, where="values", repair=f"set them: --set {first}=1, or .at({first}=1) in Python")


def to_control(result: Any) -> dict[str, Any]:
    """Return the systems of a design as systems of python-control, as `Result.to_control` says."""
    try:
        import control  # type: ignore[import-untyped, unused-ignore]
    except ImportError:
        message = "systems of python-control need python-control, which is not installed"
        raise UsageError(message, repair='pip install "symobs[control]"') from None
    plant = result.plant
    found: dict[str, Any] = {}
    for name, system in result.systems.items():
        require_numbers(system, "a system of python-control")
        arrays = [_array(matrix) for matrix in system]
        inputs, outputs = _signals(name, plant, system.C.shape[0])
        dt = float(plant.dt) if isinstance(plant.dt, Fraction) else plant.dt if isinstance(plant.dt, int) else True
        made = control.ss(*arrays, dt, inputs=inputs, outputs=outputs, name=name)
        made.exact = _exact(system, plant)
        found[name] = made
    return found


def _exact(system: Realisation, plant: StateSpace) -> StateSpace:
    """Return the system as a plant, which `from_control` gives back where it meets the same floats."""
    if system == (plant.matrices.A, plant.matrices.B, plant.matrices.C, plant.matrices.D):
        return plant
    return StateSpace(*system, plant.dt)


def _signals(name: str, plant: StateSpace, count: int) -> tuple[list[str], list[str]]:
    """Return the names of the inputs and of the outputs, so many of them, of a system."""
    m, n, p = plant.inputs, plant.order, plant.outputs
    u, y, x_hat = _labels("u", m), _labels("y", p), _labels("x_hat", n)
    return {
        "plant": (u, y),
        "observer": ([*u, *y], x_hat),
        "disturbance_observer": ([*u, *y], [*x_hat, *_labels("d_hat", count - n)]),
        "compensator": (y, _labels("w", m)),
        "closed_loop": (_labels("v", m), y),
        "servo": (_labels("r", p), y),
    }[name]


def _labels(letter: str, count: int) -> list[str]:
    return [letter] if count == 1 else [f"{letter}[{i}]" for i in range(count)]


def _array(matrix: Matrix) -> Any:
    import numpy as np

    entries = [nearest_double(entry) for entry in matrix.entries]
    return np.array(entries, dtype=float).reshape(matrix.shape)
