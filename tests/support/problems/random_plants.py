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


def small_problem(name: str, chance: random.Random) -> dict[str, Any]:
    """Return a task of a plant of one to three states with letters that have signs, degenerate in one of many ways.

    Entries are repeated, zero or equal, columns depend on each other, weights have rank one, and a sampled plant may be the
    double integrator with the letter T.
    """
    small = tables(Path(__file__))["small"]
    pool = chance.sample(small[chance.choice(["letters", "letters", "equal"])], 3)
    n, m, p = chance.choice([1, 1, 2, 2, 2, 2, 2, 3]), chance.choice([1, 1, 1, 2]), chance.choice([1, 1, 1, 2])

    def matrix(rows: int, columns: int, zeros: float = 0.4) -> list[list[str]]:
        entries = [
            ["0" if chance.random() < zeros else chance.choice(pool) for _ in range(columns)] for _ in range(rows)
        ]
        if columns > 1 and chance.random() < 0.15:
            entries = [[row[0]] * columns for row in entries]
        return entries

    plant: dict[str, Any] = {"A": matrix(n, n), "B": matrix(n, m), "C": matrix(p, n)}
    if n > 1 and chance.random() < 0.3:  # a companion matrix
        plant["A"] = [["1" if j == i + 1 else "0" for j in range(n)] for i in range(n - 1)] + matrix(1, n)
    kind = chance.random()
    if kind < 0.1:
        plant |= {"A": "[1 T; 0 1]", "B": "[T^2/2; T]", "C": chance.choice(["[1 0]", "[0 1]", "[1 1]"]), "dt": "T"}
        n, m, p = 2, 1, 1
    elif kind < 0.2:
        plant["dt"] = True
    weights: list[str] = [chance.choice(small["weights"]) for _ in range(2)]
    signs = {letter: chance.choice(small["signs"]) for letter in "abc"} | {
        "T": "positive",
        "q": "positive",
        "r": "positive",
    }
    known = symobs.StateSpace(
        plant["A"], plant["B"], plant["C"], dt=plant.get("dt", 0), symbols={**signs, "p": "positive"}
    )
    asked = specification_of(name, known, chance)
    size = {"lqr": n, "lyapunov": n, "kalman": m}.get(name, 0)
    one = [[weights[0] if i == j == 0 else 0 for j in range(size)] for i in range(size)]
    full = [[weights[0] if i == j else 0 for j in range(size)] for i in range(size)]
    if name == "lqr":
        asked = {
            "Q": chance.choice([one, full]),
            "R": [[weights[1] if i == j else 0 for j in range(m)] for i in range(m)],
        }
    elif name == "kalman":
        asked = {"W": full, "V": [[weights[1] if i == j else 0 for j in range(p)] for i in range(p)], "G": plant["B"]}
    elif name == "lyapunov":
        asked = {"Q": chance.choice([one, full])}
    elif name == "initial_state_covariance":
        asked = {"Q": weights[0], "R": weights[1], "horizon": asked.get("horizon", "1")}
    elif name == "stability_region":
        variable = "z" if "dt" in plant else "s"
        terms = [f"({chance.choice([*pool, 'h', 'h^2', '0'])})*{variable}^{power}" for power in range(n)]
        asked = {"polynomial": f"{variable}^{n} + {' + '.join(terms)}", "parameters": ["h"]}
        plant, signs["h"] = {key: value for key, value in plant.items() if key == "dt"}, chance.choice(small["signs"])
        if plant.get("dt") == "T":
            plant = {"dt": True}
    elif name == "time_varying_observability":
        asked = {}
    texts = repr((plant, asked))
    used = {letter: sign for letter, sign in signs.items() if letter in texts}
    if "'-p'" in texts:
        used |= {"p": "positive"}
    return {"title": name, "task": name, "symbols": used, "plant": plant, "specification": asked}


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
