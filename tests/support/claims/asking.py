"""How the contract tests ask each task: what it takes besides poles, and which plants it is for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import sympy

from symobs.tasks.result import tasks

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.system import StateSpace

#: Tasks and methods some of whose polynomials have one root less than the plant has states; which.
FEWER = {
    "reduced_order_observer": ("",),
    "compensator/minimal_order": ("observer_",),
    "tracking": ("observer_",),
}
#: Tasks some of whose polynomials have as many roots more as there are outputs, or states of an exosystem: one; which.
MORE = {"integral_action": ("",), "disturbance_observer": ("",), "output_regulation": ("observer_",)}
#: Tasks whose gain is not one of x̄ = T x: they choose coordinates themselves.
OWN_COORDINATES = {"reduced_order_observer", "compensator/minimal_order", "tracking"}
#: Tasks whose weights belong to the coordinates of the states.
WEIGHTED = {"kalman", "lqr"}
#: Methods that answer another question than the other methods of their task.
OTHER_QUESTIONS = {"compensator/minimal_order", "pole_advice/dominant_pair"}
#: Which of a task's keywords for quantities, and which inputs, are asked for, and with what: not all of them go together.
QUANTITIES = {"pole_advice/dominant_pair": {"settling_time": "2", "overshoot": "1/20"}}
QUANTITIES["response"] = QUANTITIES["response/superposition"] = QUANTITIES["response/auto"] = {"input": "1 - exp(-t)"}
#: Tasks about plants with disturbances, or between given states, which are asked for plants with two states.
DISTURBED = {name: {"E": "[1; 0]"} for name in ("unknown_input_observer", "disturbance_observer")}
DISTURBED["minimum_energy_input"] = {"final": "[1; 0]"}
DISTURBED["output_regulation"] = {"S": "[0]", "reference": "[1]", "E": "[1; 0]"}
QUANTITIES |= {name: given for task, given in DISTURBED.items() for name in (task, f"{task}/auto")}
QUANTITIES |= {"minimum_energy_input/gramian": DISTURBED["minimum_energy_input"]}
QUANTITIES |= {"unknown_input_observer/decoupled": DISTURBED["unknown_input_observer"]}
QUANTITIES |= {"disturbance_observer/extended_state": DISTURBED["disturbance_observer"]}
QUANTITIES |= {"output_regulation/regulator_equations": DISTURBED["output_regulation"]}
QUANTITIES |= {name: {"radius": "3"} for name in ("pole_advice", "pole_advice/butterworth", "pole_advice/auto")}


#: Keywords that are not asked for together with the others.
UNASKED = {
    "margins": {"control_poles", "control_polynomial", "observer_poles", "observer_polynomial"},
    "lyapunov": {"P"},
}


def fewer(asked: str, keyword: str) -> int:
    """Return by how many roots the polynomial of a keyword is shorter than the order, for `task` or `task/method`."""
    return int(any(_prefix(keyword) in FEWER.get(name, ()) for name in (asked, asked.partition("/")[0])))


def _prefix(keyword: str) -> str:
    return keyword.removesuffix("poles").removesuffix("polynomial")


def specification(asked: str, poles: Any) -> dict[str, Any]:
    """Return a specification: every keyword that takes poles gets as many as it needs; others something plain."""
    values = {"Poles": poles, "TimeFunctions": "0", "Intensity": "1"}
    kinds = tasks()[asked.partition("/")[0]].keywords.items()
    given = {name: values[kind] for name, kind in kinds if kind in values and name != "input"}
    given = {name: value for name, value in given.items() if name not in UNASKED.get(asked.partition("/")[0], ())}
    asked_for = {name: factors(asked, name, v) if v is poles and poles else v for name, v in given.items()}
    return asked_for | QUANTITIES.get(asked, {})


def factors(asked: str, keyword: str, listed: Sequence[Any]) -> Sequence[Any]:
    """Return as many poles, or factors of a desired polynomial, as a keyword needs."""
    if _prefix(keyword) in MORE.get(asked.partition("/")[0], ()):
        in_s = any("s" in map(str, getattr(entry, "free_symbols", ())) for entry in listed)
        return [*listed, sympy.Symbol("s") + 7 if in_s else "-7"]
    return listed[: len(listed) - fewer(asked, keyword)]


def is_for(asked: str, plant: StateSpace, poles: Sequence[str]) -> bool:
    """Whether a task can be asked about a plant at all: there is something left to estimate, and pairs stay whole."""
    if asked.partition("/")[0] in DISTURBED:
        return plant.order == 2 and (asked.partition("/")[0] not in MORE or plant.outputs == 1)
    if asked.partition("/")[0] == "margins":
        return plant.inputs == 1
    if asked.partition("/")[0] == "root_locus":  # there is a loop, and k is its gain
        m = plant.matrices
        moves = any(not (m.C @ m.A**power @ m.B).is_zero for power in range(plant.order))
        return plant.inputs == plant.outputs == 1 and moves and "k" not in plant.field.names
    if asked.partition("/")[0] in MORE:
        return plant.outputs == 1
    if not {asked, asked.partition("/")[0]} & FEWER.keys():
        return True
    return plant.order > 1 and not plant.matrices.C.is_zero and "i" not in poles[-1]
