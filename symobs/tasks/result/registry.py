"""The registries of tasks and methods, which are filled when their modules are imported."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, TypeVar, get_args

import symobs
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import InputError, SymobsError, Undecided
from symobs.proof.certificate.claims import BEYOND_LIMITS
from symobs.system import StateSpace, as_plant, read_floats
from symobs.system.dead_time import approximated, read_order
from symobs.system.specification import as_typed
from symobs.tasks.result.result import Result
from symobs.tasks.result.writers import discover, import_named

Callback = TypeVar("Callback", bound=Callable[..., Any])


@dataclass
class Method:
    """One way to meet a result type's claim: `solve` returns the result, `page` writes how it was found.

    Where a method has no page of its own, the result and the check of its claim are all that is printed.
    """

    task: str
    name: str
    source: str
    solve: Callable[..., Result]
    summary: str
    page: Callable[..., None] | None = None


@dataclass
class Task:
    """A task: its function, its keywords with their kinds and defaults, and whether it works without a plant."""

    name: str
    function: Callable[..., Result]
    keywords: Mapping[str, str]
    defaults: Mapping[str, Any]
    summary: str
    works_without_plant: bool

    def degree(self, poles: str, plant: StateSpace, asked: Mapping[str, Any]) -> int:
        """Return how many poles a keyword means, as the task states it: where it states nothing, the order of the plant."""
        count: Callable[..., int] | None = getattr(self.function, "degrees", {}).get(poles)
        return plant.order if count is None else count(plant, {**self.defaults, **asked})


_TASKS: dict[str, Task] = {}
_IN_TIME: list[str] = []
_METHODS: dict[str, Method] = {}


def task(function: Callback) -> Callback:
    """Register a task for plants with constant matrices; its keywords are its specification."""
    return _registered(_of_constant_plants(function))


def poles_of(**degrees: Callable[[StateSpace, Mapping[str, Any]], int]) -> Callable[[Callback], Callback]:
    """State how many poles the keywords of a task mean, other than the order of the plant."""

    def state(function: Callback) -> Callback:
        function.degrees = degrees  # type: ignore[attr-defined]
        return function

    return state


def task_in_time(function: Callback) -> Callback:
    """Register a task that takes time-varying plants as well."""
    _IN_TIME.append(function.__name__)
    return _registered(function)


def _of_constant_plants(function: Callback) -> Callback:
    """Refuse a plant whose matrices contain the time t, naming the tasks that take it."""

    @wraps(function)
    def refusing(*arguments: Any, **keywords: Any) -> Result:
        plant = arguments[0] if arguments else keywords.get("plant")
        if getattr(plant, "is_time_varying", False):  # a text is no plant
            message = f"{function.__name__} is for plants with constant matrices, and this plant depends on the time t"
            tasks()
            repair = f"use {' or '.join(_IN_TIME)}, or give a constant that is called t another name"
            raise InputError(message, where="plant", repair=repair)
        result: Result = function(*arguments, **keywords)
        return result

    return refusing  # type: ignore[return-value]


def _of_plants(function: Callback) -> Callback:
    """Wrap a task to accept plants of other programs, and floats on request."""
    signature = inspect.signature(function).parameters
    only = signature["plant"].default is not None
    kinds = {name: _kind(given.annotation) for name, given in signature.items() if name != "plant"}
    words = [name for name, kind in kinds.items() if kind == "Name"]

    @wraps(function)
    def reading(*arguments: Any, floats: str | None = None, pade: object = None, **keywords: Any) -> Result:
        if arguments and (only or arguments[0] is not None):
            arguments = (_asked_anew(as_plant(arguments[0], only=only, floats=floats)), *arguments[1:])
        elif "plant" in keywords and (only or keywords["plant"] is not None):
            keywords["plant"] = _asked_anew(as_plant(keywords["plant"], only=only, floats=floats))
        for name in words:
            if not isinstance(keywords.get(name, ""), str):
                message = f"a name is expected, but a value of type {type(keywords[name]).__name__} came"
                raise InputError(message, where=f"specification.{name}", repair="write it in quotes")
        came = {name: value for name, value in keywords.items() if name != "plant" and value is not None}
        plant = arguments[0] if arguments else keywords.get("plant")
        if isinstance(plant, StateSpace) and plant.delay is not None:
            plant = _with_dead_time(plant, pade, function.__name__, came)
            arguments, keywords = (plant, *arguments[1:]), {n: v for n, v in keywords.items() if n != "plant"}
        _require_equilibrium(plant, function.__name__)
        known = plant if isinstance(plant, StateSpace) else None
        came = {name: as_typed(name, kinds.get(name, ""), value, known) for name, value in came.items()}
        asked = {name: read_floats(value, floats, f"specification.{name}") for name, value in came.items()}
        try:
            result: Result = function(*arguments, **keywords | asked)
        except BEYOND_LIMITS as error:
            if isinstance(error, SymobsError):
                raise
            raise Undecided(f"{function.__name__} is undecided: {error}") from error
        if any(asked[name] is not value for name, value in came.items()):
            result.plant.is_from_floats = True  # the plant of this result alone: the page says how they were read
        return result.specified(asked)

    return reading  # type: ignore[return-value]


def _require_equilibrium(plant: Any, name: str) -> None:
    """Refuse a nonlinear plant that is not linearised, but for the question where it rests."""
    nonlinear = getattr(plant, "nonlinear", None)
    if nonlinear is not None and not nonlinear.equilibrium and name != "equilibria":
        message = f"{name} is about a linearisation, and this plant has no equilibrium that was chosen"
        raise InputError(message, where="plant.equilibrium", repair="give one to symobs.linearize")


#: The tasks of plants with a dead time, and the keyword by which they are about a loop.
_OF_DEAD_TIME = {"margins": "controller", "stability_region": "controller"}


def _with_dead_time(plant: StateSpace, given: object, name: str, asked: Mapping[str, Any]) -> StateSpace:
    """Return a plant, its dead time approximated where that is asked for; raises `InputError` where a task needs that."""
    is_exact = _OF_DEAD_TIME.get(name) in asked
    order = read_order(given) or (None if is_exact else plant.pade)
    if order is None and not is_exact:
        message = f"{name} is for plants without a dead time"
        repair = "give pade = 2 for a Padé approximation of it; margins and stability_region with a controller take it exactly"
        raise InputError(message, where="plant.delay", repair=repair)
    return plant if order is None else approximated(plant, order)


def _asked_anew(plant: Any) -> Any:
    """Return a plant with empty findings, which are freed with the result of the task."""
    return plant.asked_anew() if isinstance(plant, StateSpace) else plant


def _registered(function: Callback) -> Callback:
    """Register a task; its keyword-only parameters are its specification, their annotations the kinds."""
    function = _of_plants(function)
    signature = inspect.signature(function).parameters
    keywords = {n: _kind(p.annotation) for n, p in signature.items() if p.kind is inspect.Parameter.KEYWORD_ONLY}
    defaults = {name: signature[name].default for name in keywords}
    function.kinds = keywords  # type: ignore[attr-defined]  # a result that is asked anew reads its specification so
    _TASKS[function.__name__] = Task(
        function.__name__, function, keywords, defaults, _summary(function), signature["plant"].default is None
    )
    return function


def _kind(annotation: Any) -> str:
    """Return the name of a kind: of the text `Poles | None` as of the types themselves; no name where there is none."""
    if isinstance(annotation, str):
        return annotation.split(" ")[0]
    kinds: tuple[str, ...] = getattr(annotation, "__metadata__", ())
    if kinds:
        return kinds[0]
    alternatives = get_args(annotation)
    return _kind(alternatives[0]) if alternatives else ""


def method(name: str, *, source: str, page: Callable[..., None] | None = None) -> Callable[[Callback], Callback]:
    """Register a method under `task/name`, with what writes its page."""

    def register(function: Callback) -> Callback:
        of, _, short = name.partition("/")
        _METHODS[name] = Method(of, short, source, function, _summary(function), page)
        return function

    return register


def _summary(function: Callable[..., Any]) -> str:
    return (inspect.getdoc(function) or "").partition("\n")[0]


def tasks() -> Mapping[str, Task]:
    """Return all tasks by name."""
    for package in symobs.TASK_PACKAGES:
        discover(package)
    return _TASKS


def task_named(name: str) -> Task | None:
    """Return a task, None where there is none; a module of its name is looked at first: a run pays for what it needs."""
    if name not in _TASKS:
        for package in symobs.TASK_PACKAGES:
            import_named(package, name)
    return _TASKS.get(name) or tasks().get(name)


def result_type(task_name: str) -> type[Result]:
    """Return the type of a task's results, `Result` where it is that of another task."""
    task_named(task_name)
    kinds = [Result]
    for kind in kinds:
        kinds += kind.__subclasses__()
    return next((kind for kind in kinds[1:] if kind.__dict__.get("task") == task_name), Result)


def methods(of: str | None = None) -> Mapping[str, Method]:
    """Return all methods, or those of one task, by `task/name`."""
    tasks()
    return {name: found for name, found in _METHODS.items() if of is None or found.task == of}


def choose(of: str, name: str, automatic: str) -> Method:
    """Return the requested method; `auto` means `automatic`.  Raises `InputError` naming those that exist."""
    wanted = f"{of}/{automatic if name == 'auto' else name}"
    if wanted not in _METHODS and wanted not in methods(of):
        message = f"{name[:40]!r} is not a method of {of}"
        existing = ", ".join(["auto", *(found.name for found in methods(of).values())])
        raise InputError(message, where="specification.method", repair=f"write one of {existing}")
    return _METHODS[wanted]
