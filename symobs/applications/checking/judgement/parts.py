"""The parts of an answer: what each task asks for, and which fields are inputs of others."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from symobs.tasks.result import Result

#: The fields that a task asks for where the file says nothing; others ask for their verdict.
ASKED: dict[str, tuple[str, ...]] = {
    "canonical_form": ("T", "A", "B", "C"),
    "characteristic_polynomial": ("polynomial",),
    "compensator": ("K", "L", "F"),
    "controllability": ("rank",),
    "decomposition": ("T", "sizes"),
    "disturbance_observer": ("L_x", "L_w"),
    "dual": ("A", "B", "C"),
    "feedforward": ("F",),
    "gramian": ("matrix",),
    "initial_state": ("x0",),
    "initial_state_covariance": ("covariance",),
    "integral_action": ("K", "k_I"),
    "matrix_exponential": ("matrix",),
    "observability": ("rank",),
    "observer": ("L",),
    "pole_advice": ("poles",),
    "reduced_order_observer": ("F", "G", "H", "M"),
    "response": ("state",),
    "stability_region": ("stable_if",),
    "state_feedback": ("K",),
    "tracking": ("K_d",),
    "transfer_function": ("transfer_function",),
    "unknown_input_observer": ("H", "L"),
}
#: The gains of a task.  Each is right where its claim holds, and the other fields follow from them.
GAINS: dict[str, tuple[str, ...]] = {
    "compensator": ("K", "L"),
    "disturbance_observer": ("L_x", "L_w"),
    "feedforward": ("K", "L"),
    "integral_action": ("K", "k_I"),
    "observer": ("L",),
    "reduced_order_observer": ("L",),
    "state_feedback": ("K",),
    "tracking": ("K", "L"),
    "unknown_input_observer": ("L",),
}
#: Tasks whose two gains are one of a larger system: they are right together.
TOGETHER = {"disturbance_observer", "integral_action"}
#: Fields besides gains that many values meet: their claim decides, given the gains; that of H comes before the gain.
CLAIMED = {("tracking", "K_d"), ("feedforward", "F"), ("unknown_input_observer", "H")}
#: A matrix from which a gain L that is not given follows: A − L C, or T A − L C.
OF_GAIN = {"observer": "A", "unknown_input_observer": "F"}
#: Tasks whose fields are right in many coordinates, and these fields.
IN_COORDINATES: dict[str, tuple[str, ...]] = {
    "canonical_form": ("T", "A", "B", "C"),
    "decomposition": ("T", "A", "B", "C", "sizes"),
    "reduced_order_observer": ("F", "G", "H", "M"),
}
#: What a page calls a function of time that its field calls by a word, written without spaces and signs of products.
_OF_TIME: dict[str, dict[str, str]] = {
    "matrix_exponential": {"exp(At)": "matrix"},
    "response": {"x": "state", "x(t)": "state", "y": "output", "y(t)": "output"},
}
#: Letters that a derivation keeps for the plant, also where an answer has parts of these names.
OF_THE_PLANT = ("A", "B", "C", "D")


def asked_of(result: Result) -> tuple[str, ...]:
    """Return the fields that a task asks for; the verdict where there is nothing else to be found."""
    there = tuple(name for name in ASKED.get(result.task, ()) if exists(result, name))
    return there or ("verdict",)


def field_called(task: str, name: str) -> str:
    """Return the field that a page writes x(t), y(t) or exp(A t); another name as it is."""
    return _OF_TIME.get(task, {}).get(re.sub(r"[\s*]", "", name), name)


def is_of_time(tasks: Iterable[str], name: str) -> bool:
    """Return whether a name is that of a function of time, such as x(t), in one of the tasks."""
    return any(field_called(task, name) != name for task in tasks)


def exists(result: Result, name: str) -> bool:
    """Return whether a field has a value, or is the verdict."""
    return name in {"verdict", "conditions"} or result.fields.get(name) is not None
