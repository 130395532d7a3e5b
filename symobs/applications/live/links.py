"""The state in a link: a problem as the text after `#`, which never reaches a server."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any
from urllib.parse import quote

from symobs.applications.live.request import put_in, with_values
from symobs.problem.schema import kinds_of
from symobs.system.linearisation.linearize import linearize
from symobs.system.specification.pole_patterns import OTHERS
from symobs.tasks.result import task_named

#: Keys of a specification that a link calls by shorter names.
SHORT = {"control_poles": "control", "observer_poles": "observer", "observer": "order"}
#: Matrices of which a list of numbers is a column.
_COLUMNS = {"B", "E", "L"}


def link_of(data: Mapping[str, Any]) -> str:
    """Return the state of a problem: `v=1&task=compensator&A=[0 1; 0 -1]&…`, encoded."""
    parts: dict[str, str] = {"v": "1"}
    names = data.get("tasks")
    task = names[-1] if isinstance(names, list) and names else data.get("task")
    if isinstance(task, str):
        parts["task"] = task
        data = of_one_task(data, task)
    matrices = {*_table(data, "plant"), "K", "L", "E", "T", "reference_matrix", "Q", "R"}
    for name, value in [*_table(data, "plant").items(), *_table(data, "specification").items()]:
        is_column = name in _COLUMNS and isinstance(value, (list, tuple))
        entries = [row if isinstance(row, (list, tuple)) else [row] for row in value] if is_column else value
        parts[SHORT.get(name, name)] = _text(entries, matrix=name in matrices)
    signs = {
        name: sign["sign"] if isinstance(sign, Mapping) else sign for name, sign in _table(data, "symbols").items()
    }
    if signs:
        parts["symbols"] = ",".join(f"{name}:{sign}" for name, sign in signs.items())
    parts |= {name: str(data[name]) for name in ("convention", "language") if name in data}
    return "&".join(f"{quote(name, safe='')}={quote(text, safe=',;:/-*^()[]')}" for name, text in parts.items())


def of_one_task(data: Mapping[str, Any], task: str) -> dict[str, Any]:
    """Return a problem without what the task does not take, its constants written out: a page knows neither."""
    constants: dict[str, str] = {}
    for name, value in _table(data, "constants").items():
        constants[name] = with_values(str(value), constants)
    found, names = put_in(data, constants), data.get("tasks")
    own, *others = (kinds_of(one) for name in (task, *(names or ())) if (one := task_named(name)) is not None)
    if isinstance(found.get("specification"), Mapping):
        found["specification"] = {
            name: value
            for name, value in found["specification"].items()
            if name in own or not any(name in of for of in others)
        }
    if "f" in _table(found, "plant"):
        found["plant"] = _linearised(found)
    return {name: value for name, value in found.items() if name != "constants"}


def _linearised(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the matrices of a nonlinear plant at its equilibrium, which are what can be moved."""
    plant = linearize(**data["plant"], symbols=data.get("symbols"))
    m = plant.matrices
    there = {"A": True, "B": m.has_input, "C": m.has_output, "D": m.has_feedthrough}
    return {name: str(getattr(m, name)) for name, is_there in there.items() if is_there} | {
        key: value for key, value in data["plant"].items() if key == "dt"
    }


def _table(data: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    table = data.get(name)
    return table if isinstance(table, Mapping) else {}


def _text(value: Any, *, matrix: bool) -> str:
    """Return a value as it is typed: a matrix in brackets, a list with commas."""
    if isinstance(value, Mapping):
        named = sorted(value.items(), key=lambda item: item[0] == OTHERS)  # commas go on in what stands last
        return ", ".join(f"{name} = {_text(part, matrix=False)}" for name, part in named)
    if isinstance(value, (list, tuple)):
        if matrix and value and all(isinstance(row, (list, tuple)) for row in value):
            return f"[{'; '.join(' '.join(map(_cell, row)) for row in value)}]"
        return ", ".join(str(entry) for entry in value) if not matrix else f"[{' '.join(map(str, value))}]"
    return json.dumps(value) if value is None or isinstance(value, bool) else str(value)


def _cell(entry: Any) -> str:
    return f"({entry})" if " " in str(entry) else str(entry)
