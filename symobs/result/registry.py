"""The registries of tasks, methods and formats (trusted): they register themselves in modules that are discovered."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache, wraps
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, TypeVar, get_args

import symobs
from symobs._dataclass import dataclass
from symobs.errors import InputError, UsageError
from symobs.system import as_plant

if TYPE_CHECKING:
    from symobs.derivation.builder import Page
    from symobs.result.result import Document, Result

Kind = TypeVar("Kind", bound=type)
Callback = TypeVar("Callback", bound=Callable[..., Any])
Writer = TypeVar("Writer", bound="Callable[[Page, Any], None]")


@dataclass(frozen=True)
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


@dataclass(frozen=True)
class Task:
    """A question one can ask: its function, its keywords with their kinds; `alone` where it needs no plant."""

    name: str
    function: Callable[..., Result]
    keywords: Mapping[str, str]
    summary: str
    alone: bool


_TASKS: dict[str, Task] = {}
_IN_TIME: list[str] = []
_METHODS: dict[str, Method] = {}
_FORMATS: dict[str, Any] = {}
_PAGES: dict[type, Callable[[Page, Any], None]] = {}
_DISCOVERED: set[str] = set()


def task(function: Callback) -> Callback:
    """Register a task for plants with constant matrices; its keywords are its specification."""
    return _registered(_of_constant_plants(function))


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
    """Let a task take the plants of other programs; one that needs a plant refuses what is none."""
    only = inspect.signature(function).parameters["plant"].default is not None

    @wraps(function)
    def reading(*arguments: Any, **keywords: Any) -> Result:
        if arguments and arguments[0] is not None:
            arguments = (as_plant(arguments[0], only=only), *arguments[1:])
        elif keywords.get("plant") is not None:
            keywords["plant"] = as_plant(keywords["plant"], only=only)
        result: Result = function(*arguments, **keywords)
        asked = {name: value for name, value in keywords.items() if name != "plant" and value is not None}
        return result.specified(asked)

    return reading  # type: ignore[return-value]


def _registered(function: Callback) -> Callback:
    """Register a task; its keyword-only parameters are its specification, their annotations the kinds."""
    function = _of_plants(function)
    signature = inspect.signature(function).parameters
    keywords = {n: _kind(p.annotation) for n, p in signature.items() if p.kind is inspect.Parameter.KEYWORD_ONLY}
    alone = signature["plant"].default is None
    _TASKS[function.__name__] = Task(function.__name__, function, keywords, _summary(function), alone)
    return function


def _kind(annotation: Any) -> str:
    """Return the name of a kind: of the text `Poles | None` as of the types themselves."""
    if isinstance(annotation, str):
        return annotation.split(" ")[0]
    kinds: tuple[str, ...] = getattr(annotation, "__metadata__", ())
    return kinds[0] if kinds else _kind(get_args(annotation)[0])


def method(name: str, *, source: str, page: Callable[..., None] | None = None) -> Callable[[Callback], Callback]:
    """Register a method under `task/name`, with what writes its page."""

    def register(function: Callback) -> Callback:
        of, _, short = name.partition("/")
        _METHODS[name] = Method(of, short, source, function, _summary(function), page)
        return function

    return register


def page_of(kind: type[Result]) -> Callable[[Writer], Writer]:
    """Register the function that writes the page of a result type.

    It stands beside the type, in the module of the same name with `_page` after it, and is imported when first needed.
    """

    def register(writer: Writer) -> Writer:
        _PAGES[kind] = writer
        return writer

    return register


def writer_of(kind: type[Result]) -> Callable[[Page, Any], None]:
    """Return what writes the page of a result type: its own, or that of the type it is derived from."""
    for base in kind.__mro__:
        if base not in _PAGES and find_spec(f"{base.__module__}_page") is not None:
            importlib.import_module(f"{base.__module__}_page")
        if base in _PAGES:
            return _PAGES[base]
    message = f"no page is registered for {kind.__name__}: write {kind.__module__.replace('.', '/')}_page.py"
    raise NotImplementedError(message)


def output_format(kind: Kind) -> Kind:
    """Register an output format: a class with `name`, `suffix` and `render(document)`."""
    _FORMATS[kind.name] = kind()  # type: ignore[attr-defined]
    return kind


def _summary(function: Callable[..., Any]) -> str:
    return (inspect.getdoc(function) or "").partition("\n")[0]


def _discover(package: str) -> None:
    """Import every module of a package and of its folders, once: of what was interrupted the rest follows next time."""
    if package not in _DISCOVERED:
        for name in _modules(package):
            importlib.import_module(name)
        _DISCOVERED.add(package)


@lru_cache(maxsize=8)
def _modules(package: str) -> tuple[str, ...]:
    """Return the modules of a package and of its folders by dotted name, without importing them."""
    return tuple(name for path in importlib.import_module(package).__path__ for name in _below(path, package))


def _below(folder: str, package: str) -> Iterator[str]:
    for found in pkgutil.iter_modules([folder]):
        name = f"{package}.{found.name}"
        if found.ispkg:
            yield from _below(f"{folder}/{found.name}", name)
        else:
            yield name


def _look_at(package: str, name: str) -> None:
    """Import the modules of this name below a package, wherever they lie."""
    for found in _modules(package):
        if found.rpartition(".")[2] == name:
            importlib.import_module(found)


def tasks() -> Mapping[str, Task]:
    """Return all tasks by name."""
    for package in symobs.TASK_PACKAGES:
        _discover(package)
    return _TASKS


def task_named(name: str) -> Task | None:
    """Return a task, None where there is none; a module of its name is looked at first: a run pays for what it needs."""
    if name not in _TASKS:
        for package in symobs.TASK_PACKAGES:
            _look_at(package, name)
    return _TASKS.get(name) or tasks().get(name)


def methods(of: str | None = None) -> Mapping[str, Method]:
    """Return all methods, or those of one task, by `task/name`."""
    tasks()
    return {name: found for name, found in _METHODS.items() if of is None or found.task == of}


def choose(of: str, name: str, automatic: str) -> Method:
    """Return the method asked for; `auto` means `automatic`.  Raises `InputError` naming what exists."""
    wanted = f"{of}/{automatic if name == 'auto' else name}"
    if wanted not in _METHODS and wanted not in methods(of):
        message = f"{name[:40]!r} is not a method of {of}"
        existing = ", ".join(["auto", *(found.name for found in methods(of).values())])
        raise InputError(message, where="specification.method", repair=f"write one of {existing}")
    return _METHODS[wanted]


def formats() -> Mapping[str, Any]:
    """Return all output formats by name."""
    _discover(symobs.FORMAT_PACKAGE)
    return _FORMATS


def render(document: Document, format_name: str) -> str | bytes:
    """Return a document in a format; raises `UsageError` naming the formats that exist."""
    rendered: str | bytes = format_named(format_name).render(document)
    return rendered


def format_named(name: str) -> Any:
    """Return a format; raises `UsageError` naming those that exist.

    A module with the format's name is looked at first, so that a run which needs one format does not pay for all.
    """
    _look_at(symobs.FORMAT_PACKAGE, name)
    if name not in _FORMATS and name not in formats():
        message = f"{name[:40]!r} is not an output format"
        raise UsageError(message, repair=f"use one of {', '.join(sorted(_FORMATS))}")
    return _FORMATS[name]
