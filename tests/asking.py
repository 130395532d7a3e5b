"""How the contract tests ask each task: what it takes besides poles, and which plants it is for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.method import tasks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.system import StateSpace

#: Tasks that place fewer poles than the plant has states; by how many.
FEWER = {"reduced_order_observer": 1}
#: Tasks whose gain is not one of x̄ = T x: they choose coordinates themselves.
OWN_COORDINATES = {"reduced_order_observer"}


def specification(task: str, poles: Any) -> dict[str, Any]:
    """Return a specification: every keyword that takes poles gets these, or as many as it needs; others something plain."""
    found = poles[: -FEWER[task]] if task in FEWER and poles is not None else poles
    values = {"Poles": found, "TimeFunctions": "0", "Intensity": "1"}
    kinds = tasks()[task].keywords.items()
    return {name: values[kind] for name, kind in kinds if kind in values and name != "input"}


def factors(task: str, listed: Sequence[Any]) -> Sequence[Any]:
    """Return as many factors of a desired polynomial as a task needs."""
    return listed[: len(listed) - FEWER.get(task, 0)]


def is_for(task: str, plant: StateSpace, poles: Sequence[str]) -> bool:
    """Whether a task can be asked about a plant at all: there is something left to estimate, and pairs stay whole."""
    if task not in FEWER:
        return True
    return plant.order > 1 and not plant.matrices.C.is_zero and "i" not in poles[-1]
