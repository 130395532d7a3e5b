"""Plants of every kind drawn at random, and what the tasks are asked for them."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import symobs
from symobs.tasks.result import tasks
from tests.kit import tables

if TYPE_CHECKING:
    import random

#: What entries are made of: numbers, decimals, parameters, functions of them, and roots.
ENTRIES = tables(Path(__file__))["entries"]
#: Those of which answers are long with three states.
SHORT = [ENTRIES[kind] for kind in ("parameters", "functions", "roots")]
#: f, its states, its inputs, and their values at rest.
NONLINEAR: list[tuple[str, str, str, dict[str, Any]]] = tables(Path(__file__))["nonlinear"]


def plant_of(chance: random.Random) -> symobs.StateSpace:
    """Return a plant of one to three states, one or two inputs and outputs, in either time."""
    if chance.random() < 0.1:
        f, states, inputs, point = chance.choice(NONLINEAR)
        return symobs.linearize(f, states.partition(",")[0], states=states, inputs=inputs, equilibrium=point)
    entries = ENTRIES[chance.choice(list(ENTRIES))]
    n, m, p = (
        chance.choice(sizes) for sizes in ([1, 2, 2] if entries in SHORT else [1, 2, 2, 3], [1, 1, 2], [1, 1, 2])
    )

    def matrix(rows: int, columns: int) -> list[list[str]]:
        return [["0" if chance.random() < 0.3 else chance.choice(entries) for _ in range(columns)] for _ in range(rows)]

    return symobs.StateSpace(matrix(n, n), matrix(n, m), matrix(p, n), dt=chance.choice([0, 0, True]))


def specification_of(name: str, plant: symobs.StateSpace, chance: random.Random) -> dict[str, Any]:
    """Return what a task is asked for: poles with and without letters, horizons, kinds."""
    listed = "0 1/2 -1/2 1/3 -1/3 1/4" if plant.is_discrete else "-1 -2 -3 -4 -5 -6"
    poles = ("-p -2*p -q -1 a -3" if chance.random() < 0.3 else listed).split()
    horizon = "2" if plant.is_discrete else chance.choice(["1", "T"])
    task, asked = tasks()[name], dict[str, Any]()
    for keyword in task.keywords:
        if keyword in {"poles", "control_poles", "observer_poles"}:
            asked[keyword] = poles[: task.degree(keyword, plant, asked)]
        elif keyword == "horizon":
            asked[keyword] = horizon
        elif keyword == "reference_matrix":
            asked[keyword] = [[0] * plant.order] * plant.order
        elif keyword == "S":
            asked[keyword] = chance.choice(["[0]", "[1]", "[0 1; -1 0]", "[0 a; -a 0]"])
        elif keyword == "reference":
            asked[keyword] = [
                [chance.choice(["0", "1"]) for _ in range(1 + (";" in asked["S"]))] for _ in range(plant.outputs)
            ]
        elif keyword == "E" and name == "output_regulation":
            asked[keyword] = [
                [chance.choice(["0", "1", "a"]) for _ in range(1 + (";" in asked["S"]))] for _ in range(plant.order)
            ]
        elif keyword == "E":
            asked[keyword] = [[chance.choice(["0", "1", "a"])] for _ in range(plant.order)]
    kinds = {"gramian": "of", "pbh": "of", "canonical_form": "kind"}
    if name in kinds:
        choices = (
            ["controllable", "observable", "modal"] if kinds[name] == "kind" else ["observability", "controllability"]
        )
        asked[kinds[name]] = chance.choice(choices)
    own: dict[str, dict[str, Any]] = {
        "response": {"input": ["1"] * plant.inputs},
        "margins": {"controller": chance.choice(["2", "(s + 2)/(s + 3)"]).replace("s", plant.variable)},
        "pole_advice": {"radius": "1"},
        "lqr": {"Q": "1", "R": "1"},
        "kalman": {"W": "1", "V": "1"},
        "minimum_energy_input": {"horizon": horizon, "final": ["1"] * plant.order},
        "lyapunov": {"Q": [[int(i == j) for j in range(plant.order)] for i in range(plant.order)]},
    }
    return own.get(name, {"horizon": horizon, "output": ["1"] * plant.outputs} if name == "initial_state" else asked)
