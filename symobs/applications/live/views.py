"""What each task shows and what can be moved in it: panels, sets of poles, cards."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.ground.dataclass import dataclass
from symobs.pages.cards import NAMES

if TYPE_CHECKING:
    from symobs.tasks.result import Result


@dataclass(frozen=True)
class PoleSet:
    """Poles that can be moved: the key of the specification, the word for one of them, and their mark."""

    key: str
    label: str
    mark: str


@dataclass(frozen=True)
class View:
    """A task on the screen: what is moved, the panels, and the cards that are open at first."""

    sets: tuple[PoleSet, ...] = ()
    panels: tuple[str, ...] = ("cards", "page")
    cards: tuple[str, ...] = ()


_CONTROL = PoleSet("control_poles", "control_pole", "cross")
_OBSERVER = PoleSet("observer_poles", "observer_pole", "ring")
_DESIGN = ("plane", "responses", "cards", "page")
_RANK = ("cases", "cards", "page")
VIEWS: dict[str, View] = {
    "compensator": View((_CONTROL, _OBSERVER), _DESIGN, ("K", "L", "F", "closed_loop_polynomial")),
    "feedforward": View((_CONTROL, _OBSERVER), _DESIGN, ("F", "K", "L", "transfer_function")),
    "tracking": View((_CONTROL, _OBSERVER), ("plane", "cards", "page"), ("K", "K_d", "L")),
    "observer": View((PoleSet("poles", "observer_pole", "ring"),), _DESIGN, ("L", "polynomial", "A")),
    "reduced_order_observer": View(
        (PoleSet("poles", "observer_pole", "ring"),), _DESIGN, ("L", "F", "G", "H", "M", "polynomial")
    ),
    "state_feedback": View(
        (PoleSet("poles", "control_pole", "cross"),), _DESIGN, ("K", "polynomial", "closed_loop_matrix")
    ),
    "stability_region": View((), ("region", "cards", "page"), ("polynomial",)),
    "observability": View((), _RANK, ("matrix", "rank", "determinant", "kernel")),
    "controllability": View((), _RANK, ("matrix", "rank", "determinant", "kernel")),
    "detectability": View((), _RANK, ("rank", "polynomial", "fixed_polynomial")),
    "stabilizability": View((), _RANK, ("rank", "polynomial", "fixed_polynomial")),
    "pbh": View((), _RANK, ("polynomial", "fixed_polynomial")),
}


def view_of(task: str) -> View:
    """Return the view of a task; one without handles shows its answers and its page."""
    return VIEWS.get(task) or View(cards=tuple(NAMES.get(task, ())))


def view_object(result: Result, specification: Any) -> dict[str, Any]:
    """Return what the front-end builds a task from."""
    view, plant = view_of(result.task), result.plant
    sets = [
        {"key": _key_in(specification, found.key), "label": found.label, "mark": found.mark}
        for found in view.sets
        if not _gives_polynomial(specification, found.key)
    ]
    return {
        "task": result.task,
        "discrete": plant.is_discrete,
        "order": plant.order,
        "panels": list(view.panels),
        "sets": sets,
        "cards": list(view.cards),
    }


def _key_in(specification: Any, key: str) -> str:
    """Return the key under which a file gives the poles: a half of a compensator may be asked for by its own name."""
    halves = [f"{half}_{key}" for half in ("control", "observer")] if key == "poles" else []
    return next((name for name in halves if name in specification and key not in specification), key)


def _gives_polynomial(specification: Any, key: str) -> bool:
    return key not in specification and key.replace("poles", "polynomial") in specification
