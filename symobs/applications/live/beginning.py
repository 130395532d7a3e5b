"""Beginning a task: what the problem on the screen does not say is filled in, so that its first answer stands."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from contextlib import suppress
from fractions import Fraction
from typing import TYPE_CHECKING, Any

from symobs.exact import Matrix
from symobs.ground.errors import ProblemErrors, SymobsError, Undecided
from symobs.problem import validate
from symobs.problem.schema import kinds_of
from symobs.tasks.result import result_type, task_named, tasks
from symobs.tasks.result.output_methods import to_json

if TYPE_CHECKING:
    from symobs.system import StateSpace
    from symobs.tasks.result import Result, Task

#: The plant of an empty page.
SERVO = {"A": "[0 1; 0 -1]", "B": "[0; 1]", "C": "[1 0]"}
#: B, C, and each of two sets of poles may be taken out once and put in once.
_ROUNDS = 8


def begun(data: Mapping[str, Any], task: Task) -> dict[str, Any]:
    """Return the problem on the screen as one of another task: with what that takes of it, and with what it lacks.

    Poles stay poles, with another half of a design as their name.  What cannot be read or has no answer is replaced; the
    plant is not, but an input or output that the task needs is added.
    """
    table = data.get("plant") or ({} if task.works_without_plant and _given(data).get("polynomial") else SERVO)
    whole = {**data, "task": task.name, "plant": table}
    carried = _carried(data, task)
    poles = {key: value for key, value in carried.items() if kinds_of(task)[key] == "Poles"}
    tried = [_completed(whole | {"specification": given}, task) for given in _distinct(carried, poles, {})]
    return min(tried, key=lambda found: found[0])[1]


def _distinct(*given: dict[str, Any]) -> list[dict[str, Any]]:
    return [one for place, one in enumerate(given) if one not in given[:place]]


def _given(data: Mapping[str, Any]) -> Mapping[str, Any]:
    table = data.get("specification")
    return table if isinstance(table, Mapping) else {}


def _carried(data: Mapping[str, Any], task: Task) -> dict[str, Any]:
    """Return what a task takes of a specification; the poles of one gain are those of its half of a compensator."""
    takes, old = kinds_of(task), task_named(str(data.get("task")))
    halves = {key.partition("_")[2]: key for key in kinds_of(old) if key not in old.keywords} if old else {}
    named = {key if key in takes else halves.get(key, key): value for key, value in _given(data).items()}
    return {key: value for key, value in named.items() if key in takes and key != "method"}


def _completed(data: dict[str, Any], task: Task) -> tuple[int, dict[str, Any]]:
    """Return a problem with what it lacked, and how far it is from an answer."""
    for _ in range(_ROUNDS):
        try:
            data = _with_beginning(data, task)
            result = validate(data, task.name).solve()[-1]
        except Undecided:
            return 2, data
        except SymobsError as error:
            mended = _mended(data, task, error)
            if mended == data:
                break
            data = mended
        else:
            return (0, data) if result.verdict != "no" else _with_fixed_modes(data, task, result)
    return 3, data


def _plant_of(data: Mapping[str, Any]) -> StateSpace:
    return validate({key: data[key] for key in ("plant", "symbols") if key in data}, "dual").plant


def _with_beginning(data: dict[str, Any], task: Task) -> dict[str, Any]:
    """Return a problem with the values that its task begins with, wherever it gives none."""
    if task.name not in _BEGINNINGS or not data["plant"]:
        return data
    first = _BEGINNINGS[task.name](_plant_of(data))
    letters = {name: "real" for name in first.get("parameters", "").split(", ") if name}
    symbols = {**letters, **data.get("symbols", {})}
    return data | {"specification": {**first, **data["specification"]}} | ({"symbols": symbols} if symbols else {})


def _mended(data: dict[str, Any], task: Task, error: SymobsError) -> dict[str, Any]:
    """Return a problem with what its errors name: an input or output that is missing, poles, what cannot be read."""
    plant, given = dict(data["plant"]), dict(data["specification"])
    for each in error.errors if isinstance(error, ProblemErrors) else (error,):
        key = each.where.partition(".")[2].partition("[")[0]
        if each.where in {"plant.B", "plant.C"} and not plant.keys() & {key, "transfer_function"}:
            unit = ["0"] * (_plant_of(data).order - 1)
            plant[key] = f"[{'; '.join([*unit, '1'])}]" if key == "B" else f"[{' '.join(['1', *unit])}]"
        elif key in given:
            del given[key]
        elif key.endswith("poles") or each.where == "specification":
            given[key or "poles"] = _poles(key or "poles", _plant_of(data), task, given)
    return data | {"plant": plant, "specification": given}


def _poles(key: str, plant: StateSpace, task: Task, given: Mapping[str, Any], fixed: tuple[str, ...] = ()) -> str:
    """Return distinct stable poles, those of an observer faster; modes that no gain moves are among them."""
    count = task.degree(key if key in task.keywords else "poles", plant, given)
    of_observer = any(gain.startswith("L") for gain in result_type(task.name).gains)
    is_control = key.startswith("control") or (key == "poles" and not of_observer)
    if plant.is_discrete:
        free = [Fraction(5 - k, 10) if is_control else Fraction(2 - k, 20) for k in range(count)]
    else:
        free = [Fraction(-2 - k if is_control else -10 - k) for k in range(count)]
    return ", ".join([*fixed, *map(str, free)][: max(count, len(fixed))])


def halves(result: Result) -> dict[str, Any]:
    """Return the state feedback and the observer that a design consists of, by the keys of their poles."""
    names = {"control_poles": "feedback", "observer_poles": "estimator"}
    return {key: half for key, name in names.items() if (half := vars(result).get(name)) is not None}


def _with_fixed_modes(data: dict[str, Any], task: Task, result: Result) -> tuple[int, dict[str, Any]]:
    """Return a problem whose desired poles contain the modes that no gain moves, if it has an answer."""
    parts = halves(result) or {key: result for key in data["specification"] if key.endswith("poles")}
    given = dict(data["specification"])
    for key, part in parts.items():
        if fixed := tuple(map(str, part.fields.get("fixed_modes") or ())):
            given[key] = _poles(key, result.plant, task, given, fixed)
    with suppress(SymobsError):
        if validate(data | {"specification": given}, task.name).solve()[-1].verdict != "no":
            return 0, data | {"specification": given}
    return 1, data


# -- what tasks begin with --------------------------------------------------------------------------------------------


def _column(entries: Iterable[object]) -> str:
    """Return a column as it is typed, one entry without brackets."""
    texts = [str(entry).replace("**", "^") for entry in entries]
    return texts[0] if len(texts) == 1 else f"[{'; '.join(f'({text})' if ' ' in text else text for text in texts)}]"


def _ones(count: int) -> str:
    return _column(["1"] * count)


def _entering(plant: StateSpace) -> str:
    """Return a direction in which a disturbance enters: with the first input, or else with the last derivative."""
    m, order = plant.matrices, plant.order
    return _column(m.B.select(range(order), [0]).entries if m.has_input else [0] * (order - 1) + [1])


def _seen(plant: StateSpace) -> str:
    """Return a direction that the first output measures."""
    m = plant.matrices
    return _column(m.C.rows[0] if m.has_output else [1] + [0] * (plant.order - 1))


def _measured(plant: StateSpace) -> dict[str, Any]:
    """Return an output that an initial state explains: that of the state of ones if it can be typed, or else 0."""
    m, state = plant.matrices, Matrix.column([1] * plant.order)
    if not m.has_output:
        return {}
    if plant.is_discrete:
        samples = []
        for _ in range(plant.order):
            samples.append(m.C @ state)
            state = m.A @ state
        return {"output": str(Matrix.block([samples])).replace("**", "^")}
    with suppress(SymobsError):
        response = tasks()["response"].function(plant, initial=_ones(plant.order))
        output = _column(row[0] for row in to_json(response.fields["output"]))
        if tasks()["initial_state"].function(plant, output=output).verdict == "yes":
            return {"output": output}
    return {"output": _column(["0"] * plant.outputs)}


def _region(plant: StateSpace) -> dict[str, Any]:
    """Return two parameters: letters of the plant, or else two entries of a stabilising gain."""
    m, order = plant.matrices, plant.order
    letters = sorted(m.A.names & plant.symbols.signs.keys())  # a root is a number
    if letters or not (m.has_input or m.has_output):
        return {"parameters": ", ".join(letters[:2])} if letters else {}
    name, task = ("K", "state_feedback") if m.has_input else ("L", "observer")
    found = tasks()[task]
    gain = found.function(plant, poles=_poles("poles", plant, found, {})).fields.get(name)
    table = (
        [["0"] * order] if gain is None else [[str(x) for x in row] for row in (gain if name == "K" else gain.T).rows]
    )
    entries = [f"{name.lower()}{place}" for place in range(1, min(order, 2) + 1)]
    table[0][: len(entries)] = entries
    rows = table if name == "K" else [list(row) for row in zip(*table, strict=True)]
    return {name: f"[{'; '.join(map(' '.join, rows))}]", "parameters": ", ".join(entries)}


#: Tasks that need more than a plant and poles, and what they begin with.
_BEGINNINGS: dict[str, Callable[[StateSpace], dict[str, Any]]] = {
    "disturbance_observer": lambda plant: {"E": _entering(plant)},
    "initial_state": _measured,
    "initial_state_covariance": lambda _: {"R": "1"},
    "kalman": lambda _: {"W": "1", "V": "1"},
    "lqr": lambda _: {"Q": "1", "R": "1"},
    "minimum_energy_input": lambda plant: {"final": _ones(plant.order), "horizon": str(max(plant.order, 1))},
    "output_regulation": lambda plant: {"S": "0", "reference": _ones(plant.outputs)},
    "pole_advice": lambda _: {"settling_time": "2", "overshoot": "1/20"},
    "response": lambda plant: {"input" if plant.matrices.has_input else "initial": _ones(plant.inputs or plant.order)},
    "stability_region": _region,
    "unknown_input_observer": lambda plant: {"E": _seen(plant)},
    "zero_order_hold": lambda _: {"sampling_period": "1/10"},
}
