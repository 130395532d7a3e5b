"""From a seed to a problem: a plant of one of the kinds, and one task asked about it."""

from __future__ import annotations

from random import Random
from typing import TYPE_CHECKING, Any

from tests.programs.campaign import shapes
from tests.programs.campaign.asked import Tables, text_of
from tests.programs.campaign.specifications import TASKS, specification

if TYPE_CHECKING:
    from collections.abc import Collection

    from tests.programs.campaign.shapes import Shape

#: How often each kind of plant is drawn.
KINDS: dict[str, float] = {
    "numeric": 20,
    "large": 0.7,
    "several": 18,
    "defective": 12,
    "hidden": 14,
    "discrete": 12,
    "feedthrough": 8,
    "parametric": 6,
    "parametric several": 3,
    "parametric hidden": 3,
}
_LETTERS = "ABCD"


def drawn(seed: int, tasks: Collection[str] = ()) -> tuple[str, Tables]:
    """Return the kind and the problem of a seed; with `tasks` one of these is asked, else any."""
    random = Random(f"symobs {seed}")  # noqa: S311 - test problems, no secrets
    weights = {name: weight for name, weight in TASKS.items() if not tasks or name in tasks}
    while True:
        kind = random.choices(list(KINDS), list(KINDS.values()))[0]
        task = random.choices(list(weights), list(weights.values()))[0]
        shape = _shape(random, kind, task)
        asked = specification(random, task, shape)
        if asked is not None:
            return kind, _problem(task, shape, asked)


def _problem(task: str, shape: Shape, asked: dict[str, Any]) -> Tables:
    signs = {**shape.signs, **asked.pop("symbols", {})}
    plant: dict[str, Any] = {letter: text_of(getattr(shape, letter)) for letter in _LETTERS}
    if not any(entry != "0" for row in shape.D for entry in row):
        del plant["D"]
    plant = asked.pop("plant", plant)
    if shape.discrete:
        plant["dt"] = True
    return {"task": task, "symbols": signs, "plant": plant, "specification": asked}


def _shape(random: Random, kind: str, task: str) -> Shape:
    """Return a plant of the kind, of a size that the task is asked for."""
    few = _FEW.get(task, 4)
    order = min(random.choice([1, 2, 2, 2, 3, 3, 3, 4]), few)
    inputs, outputs = 1, 1
    match kind:
        case "large":
            order = random.choice([5, 5, 6, 6, 7, 8, 10, 12]) if few >= 4 else few
            if random.random() < 0.5:
                inputs, outputs = random.randint(1, 3), random.randint(1, 3)
            return shapes.numeric(random, order, inputs, outputs)
        case "several":
            order = max(order, min(2, few))
            inputs, outputs = random.choice([(1, 2), (2, 1), (2, 2), (2, 2), (3, 2), (2, 3), (3, 3)])
            return shapes.numeric(random, order, inputs, outputs)
        case "defective":
            inputs, outputs = random.choice([(1, 1), (1, 1), (2, 2), (1, 2), (2, 1)])
            return shapes.defective(random, order, inputs, outputs)
        case "hidden":
            inputs, outputs = random.choice([(1, 1), (1, 1), (1, 1), (2, 2), (1, 2), (2, 1)])
            return shapes.hidden(random, max(2, order), inputs, outputs)
        case "discrete":
            inner = random.choice(["numeric", "several", "defective", "hidden", "feedthrough", "parametric"])
            shape = _shape(random, inner, task)
            shape.discrete = True
            return shape
        case "feedthrough":
            inner = random.choice(["numeric", "several", "defective", "hidden", "parametric"])
            return shapes.feedthrough(random, _shape(random, inner, task))
        case "parametric" | "parametric several":
            order = min(order, 2) if random.random() < 0.8 else order
            if kind == "parametric several":
                inputs, outputs = random.choice([(1, 2), (2, 1), (2, 2)])
            return shapes.parametric(random, order, inputs, outputs)
        case "parametric hidden":
            order = max(2, min(order, 3))
            return shapes.parametric(random, order, 1, 1, shapes.hidden(random, order, 1, 1))
    return shapes.numeric(random, order, inputs, outputs)


#: Tasks whose answers are functions of time stay small.
_FEW = {"initial_state_covariance": 2, "time_varying_observability": 3, "gramian": 3, "initial_state": 3}
