"""What a task shows and what can be moved in it: panels, sets of poles, cards."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

from symobs.ground.dataclass import dataclass
from symobs.tasks.result import result_type, tasks

if TYPE_CHECKING:
    from symobs.tasks.result import Result


@dataclass(frozen=True)
class PoleSet:
    """Poles that can be moved: the key of the specification, the word for one of them, and their mark."""

    key: str
    label: str
    mark: str


_SETS = (
    PoleSet("control_poles", "control_pole", "cross"),
    PoleSet("observer_poles", "observer_pole", "ring"),
)


def pole_sets(task: str) -> tuple[PoleSet, ...]:
    """Return the poles that can be moved: of a task with one gain they are called poles."""
    keywords, kind = tasks()[task].keywords, result_type(task)
    if "plane" not in kind.panels:
        return ()
    control, observer = _SETS
    if "poles" in keywords:
        return (replace(control if kind.gains == ("K",) else observer, key="poles"),)
    return tuple(found for found in _SETS if found.key in keywords)


def view_object(result: Result, specification: Any) -> dict[str, Any]:
    """Return what the front-end builds a task from."""
    plant = result.plant
    sets = [
        {"key": _key_in(specification, found.key), "label": found.label, "mark": found.mark}
        for found in pole_sets(result.task)
        if not _gives_polynomial(specification, found.key)
    ]
    return {
        "task": result.task,
        "discrete": plant.is_discrete,
        "order": plant.order,
        "panels": [*result.panels, "cards", "page"],
        "sets": sets,
        "cards": list(result.cards or result.letters),
    }


def _key_in(specification: Any, key: str) -> str:
    """Return the key under which a file gives the poles: a half of a compensator may be asked for by its own name."""
    halves = [f"{half}_{key}" for half in ("control", "observer")] if key == "poles" else []
    return next((name for name in halves if name in specification and key not in specification), key)


def _gives_polynomial(specification: Any, key: str) -> bool:
    return key not in specification and key.replace("poles", "polynomial") in specification
