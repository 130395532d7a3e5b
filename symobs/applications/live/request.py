"""Reading a request of the protocol `symobs-live/1`: sizes, kinds and keys, all errors together."""

from __future__ import annotations

import json
import re
from collections import OrderedDict
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any
from urllib.parse import quote

from symobs.applications.live.assets import MOST_BYTES, SCHEMA
from symobs.formula.expression.source import shown
from symobs.formula.phrases.languages import ENGLISH
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, reason_of
from symobs.problem import validate
from symobs.problem.schema import kinds_of
from symobs.problem.validation import gains_from
from symobs.system.linearize import linearize
from symobs.system.specification.pole_patterns import OTHERS
from symobs.tasks.result import task_named

if TYPE_CHECKING:
    from symobs.formula.phrases.languages import Language
    from symobs.problem import Problem
    from symobs.system import StateSpace


#: A request nests no deeper, and an exact value of a symbol is no longer.
MOST_DEPTH, LONGEST_VALUE = 20, 200
WANTS = ("answer", "page", "point", "view", "export", "start", "begin")
DETAILS = ("full", "outline", "answer")
EXPORTS = ("latex", "toml", "python", "json", "html", "svg")
FORMATS = ("mathml",)
#: The frequency response of the loop: not wanted, without the ends of the gain, or whole.
LOOPS = ("none", "moving", "rest")


_KEYS = {
    "schema", "id", "want", "problem", "task", "at", "cards", "cards_at", "courses", "cases", "format", "detail", "as", "goal",
    "loop", "moving",
}  # fmt: skip


_COURSES = {"start", "estimate", "end", "count", "step"}
_GOALS = {"settling", "overshoot", "gain", "phase"}
_NAME = re.compile(r"\d+\.?\d*(?:[eE][+-]?\d+)?|[A-Za-z_]\w*")
_SYMBOL = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
#: What a file holds against its answers, which are not those asked for here.
_OF_A_FILE = {"expect", "id", "printed"}
_MOST_INSTANTS, _MOST_NAMES = 1025, 60


class FieldError(InputError):
    """What is wrong with a field that the live page alone has: a phrase, so that the page says it in its language."""

    def __init__(self, phrase: str, where: str, **slots: object) -> None:
        """Say it in English."""
        self.phrase, self.slots = phrase, slots
        message, repair = self.told(ENGLISH)
        super().__init__(message, where=where, repair=repair)

    def told(self, language: Language) -> tuple[str, str]:
        """Return message and repair in a language."""
        return language.phrases[self.phrase].format(**self.slots), language.phrases[f"{self.phrase}_repair"]


@dataclass
class Responses:
    """Which time responses are wanted: from an initial state and estimate, or to a step; last instant, how many instants.

    They are `fine`, and read off wherever that can be done, unless something moves.
    """

    start: str = ""
    estimate: str = ""
    end: str | None = None
    count: int = 129
    step: bool = False
    fine: bool = True


@dataclass
class Request:
    """A request that was read; `names` are the cards wanted, None those of the task."""

    id: int | str | None
    want: str
    data: Mapping[str, Any]
    task: str | None
    at: Mapping[str, str]
    names: tuple[str, ...] | None
    cards_at: bool
    cases: bool
    responses: Responses | None
    goal: Mapping[str, str]
    detail: str
    export: str
    loop: str
    moving: bool

    def problem(self) -> Problem:
        """Return the problem as it was given."""
        return _validated(put_in(self.data, {}), self.task)

    def problem_there(self) -> Problem:
        """Return the problem with the values of `at` in the place of their symbols."""
        return _validated(put_in(self.data, self.at), self.task)

    @property
    def key(self) -> str:
        """What the result depends on, as one text."""
        return json.dumps([self.data, self.task], sort_keys=True, ensure_ascii=False)

    @property
    def key_there(self) -> str:
        """The same with the values of `at`."""
        return json.dumps([put_in(self.data, self.at), self.task], sort_keys=True, ensure_ascii=False)


#: The plants of the last questions: while a pole is moved it stays the same, with what was found out about it.
_plants: OrderedDict[str, StateSpace] = OrderedDict()
_PLANTS_KEPT = 8


def _read_once(data: Mapping[str, Any], name: str | None) -> Problem:
    """Return the problem of a file's tables, whose plant is read where it is another one than before."""
    table = _table(data, "plant")
    if "A" not in table:  # it may depend on the question
        return validate(data, name)
    pade = _table(data, "specification").get("pade")
    key = json.dumps([table, pade, data.get("symbols"), data.get("constants")], sort_keys=True)
    problem = validate(data, name, known=_plants.get(key))
    _plants[key] = problem.plant
    _plants.move_to_end(key)
    while len(_plants) > _PLANTS_KEPT:
        _plants.popitem(last=False)
    return problem


def _validated(data: Mapping[str, Any], name: str | None) -> Problem:
    """Return the problem of one task, after the earlier tasks of the file whose gains are those of it."""
    several, found = data.get("tasks"), task_named(name) if name is not None else None
    if found is None or not isinstance(several, list) or name not in several:
        return _read_once(data, name)
    specification = _table(data, "specification")
    earlier = [str(each) for each in several[: several.index(name)]]
    gains = gains_from(found, {*specification, *_table(specification, found.name)}, earlier)
    if not gains:
        return _read_once(data, name)
    wanted = [*(earlier[place] for place in sorted({*gains.values()})), name]
    own = {key: value for key, value in specification.items() if key in wanted or key not in several}
    return _read_once({**data, "tasks": wanted, "specification": own}, None)


def parsed(body: bytes) -> Any:
    """Return the JSON of a request; raises `InputError`."""
    if len(body) > MOST_BYTES:
        raise InputError(f"the request is longer than {MOST_BYTES // 1024} kB", repair="ask about a smaller problem")
    try:
        return json.loads(body.decode("utf-8"))
    except UnicodeDecodeError as error:
        raise InputError(reason_of(error), where="the request", repair="send UTF-8") from None
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"this is not JSON: {str(error)[:80]}", where="the request", repair="send one object"
        ) from None


def read(body: object) -> Request:
    """Return the request; raises `ProblemErrors` with everything that is wrong with it."""
    if not isinstance(body, Mapping):
        raise InputError("an object is expected", where="the request", repair='send {"schema": "symobs-live/1", …}')
    errors: list[SymobsError] = []

    def note(message: str, where: str, repair: str) -> None:
        errors.append(InputError(message, where=where, repair=repair))

    def one_of(name: str, known: tuple[str, ...]) -> str:
        value = body.get(name, known[0])
        if isinstance(value, str) and value in known:
            return value
        note("not one of the words known here", name, f"write one of {', '.join(known)}")
        return known[0]

    def truth(name: str) -> bool:
        value = body.get(name, False)
        if not isinstance(value, bool):
            note("true or false is expected", name, f'write "{name}": true')
        return value is True

    _refuse(body, "", 0, note)
    if errors:
        raise ProblemErrors(tuple(errors[:20]))
    for key in body:
        if key not in _KEYS:
            note("unknown key", shown(str(key), 40), f"known keys are {', '.join(sorted(_KEYS))}")
    if body.get("schema") != SCHEMA:
        note("another protocol", "schema", f'write "schema": "{SCHEMA}"')
    identity = body.get("id")
    if isinstance(identity, bool) or not (
        identity is None or isinstance(identity, int) or (isinstance(identity, str) and len(identity) <= LONGEST_VALUE)
    ):
        note("an integer is expected", "id", "number the requests")
        identity = None
    one_of("format", FORMATS)
    want, detail, export = one_of("want", WANTS), one_of("detail", DETAILS), one_of("as", EXPORTS)
    loop = one_of("loop", LOOPS)
    data = body.get("problem", {})
    if not isinstance(data, Mapping):
        note("an object is expected", "problem", "send a problem file as JSON")
        data = {}
    elif not data and want not in {"start", "begin"}:
        note("the problem is missing", "problem", "send a problem file as JSON")
    task = body.get("task")
    if task is None:
        task = _only_task(data)
    elif not isinstance(task, str) or task_named(task) is None:
        note("the name of a task is expected", "task", 'write for example "task": "observer"')
        task = None
    names = _names(body.get("cards"), note)
    at = _at(body.get("at", {}), note)
    cards_at, cases, moving, goal = truth("cards_at"), truth("cases"), truth("moving"), body.get("goal", {})
    responses = _responses(body.get("courses"), note, moving=moving)
    if not isinstance(goal, Mapping) or not _GOALS.issuperset(goal) or not all(map(_is_short, goal.values())):
        note("another object is expected", "goal", f"its keys are {', '.join(sorted(_GOALS))}, its values texts")
        goal = {}
    if errors:
        raise ProblemErrors(tuple(errors))
    return Request(
        identity, want, data, task, at, names, cards_at, cases, responses, goal, detail, export, loop, moving
    )


def _refuse(value: object, where: str, depth: int, note: Any) -> None:
    """Note floats and what is nested too deep."""
    if depth > MOST_DEPTH:
        note(f"nested deeper than {MOST_DEPTH}", where[:80], "write it flatter")
    elif isinstance(value, float):
        note("a floating-point number came", where[:80], 'numbers are exact: write it as a text, "1/4" or "0.25"')
    elif isinstance(value, Mapping):
        for key, entry in value.items():
            _refuse(entry, f"{where}.{shown(str(key), 40)}".lstrip("."), depth + 1, note)
    elif isinstance(value, (list, tuple)):
        for place, entry in enumerate(value):
            _refuse(entry, f"{where}[{place}]", depth + 1, note)


def _is_short(text: object) -> bool:
    return isinstance(text, str) and 0 < len(text) <= LONGEST_VALUE


def _only_task(data: Mapping[str, Any]) -> str | None:
    """Return the last of several tasks, which the earlier ones lead to; None leaves the choice to the problem."""
    several = data.get("tasks")
    if isinstance(several, list) and several and all(isinstance(name, str) for name in several):
        return several[-1] if task_named(several[-1]) is not None else None
    return None


def _names(value: object, note: Any) -> tuple[str, ...] | None:
    if value is None:
        return None
    if not isinstance(value, list) or len(value) > _MOST_NAMES or not all(isinstance(name, str) for name in value):
        note("a list of names is expected", "cards", 'write "cards": ["K", "L"]')
        return None
    return tuple(value)


def _at(value: object, note: Any) -> dict[str, str]:
    """Return the values of symbols, which are texts or integers."""
    if not isinstance(value, Mapping):
        note("an object is expected", "at", 'write "at": {"omega": "2"}')
        return {}
    found = {}
    for name, entry in value.items():
        text = str(entry) if isinstance(entry, int) and not isinstance(entry, bool) else entry
        where = f"at.{shown(str(name), 40)}"
        if not _SYMBOL.fullmatch(str(name)):
            note("no name of a symbol", where, "name a symbol of the problem")
        elif not isinstance(text, str) or not 0 < len(text) <= LONGEST_VALUE:
            note("an exact value is expected", where, 'write it as a text: "1/2"')
        else:
            found[name] = text
    return found


def _responses(value: object, note: Any, *, moving: bool) -> Responses | None:
    if value is None:
        return None
    if not isinstance(value, Mapping) or not _COURSES.issuperset(value):
        note("another object is expected", "courses", f"its keys are {', '.join(sorted(_COURSES))}")
        return None
    texts = {name: value.get(name, "") for name in ("start", "estimate")}
    end, count = value.get("end"), value.get("count", 129)
    for name, text in [*texts.items(), ("end", "" if end is None else end)]:
        if not isinstance(text, str) or len(text) > LONGEST_VALUE:
            note("a text is expected", f"courses.{name}", 'write exact numbers: "1, 1/2"')
            return None
    if not isinstance(count, int) or isinstance(count, bool) or not 2 <= count <= _MOST_INSTANTS:
        note(f"a number from 2 to {_MOST_INSTANTS} is expected", "courses.count", 'write "count": 129')
        return None
    step = value.get("step", False)
    if not isinstance(step, bool):
        note("true or false is expected", "courses.step", 'write "step": true')
        return None
    return Responses(texts["start"], texts["estimate"], end, count, step, fine=not moving)


# -- values in the place of symbols -----------------------------------------------------------------------------------


def put_in(data: Mapping[str, Any], values: Mapping[str, str]) -> dict[str, Any]:
    """Return a problem with values in the place of symbols, which are no longer declared; what is expected is left out."""
    found: dict[str, Any] = {key: value for key, value in data.items() if key not in _OF_A_FILE}
    if not values:
        return found
    for table in ("plant", "specification"):
        if isinstance(found.get(table), Mapping):
            found[table] = {
                key: _without(entry, values) if key == "parameters" else with_values(entry, values)
                for key, entry in found[table].items()
            }
    if isinstance(found.get("symbols"), Mapping):
        found["symbols"] = {name: sign for name, sign in found["symbols"].items() if name not in values}
    return found


def _without(names: Any, values: Mapping[str, str]) -> Any:
    if isinstance(names, str):
        names = [name.strip() for name in names.split(",")]
    return [name for name in names if name not in values] if isinstance(names, list) else names


def with_values(value: Any, values: Mapping[str, str]) -> Any:
    """Return texts with values in parentheses in the place of names, and lists of them."""
    if isinstance(value, str):
        return _NAME.sub(lambda found: f"({values[found[0]]})" if found[0] in values else found[0], value)
    return [with_values(entry, values) for entry in value] if isinstance(value, (list, tuple)) else value


# The state in a link: a problem as the text after `#`, which never reaches a server.


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
    if {"f", "equations", "kinetic"} & _table(found, "plant").keys():
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
