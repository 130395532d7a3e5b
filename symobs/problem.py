"""Problem files: read (TOML or JSON), validate with all errors at once, run, compare with `[expect]`.

A file is never executed and never partly trusted: its size, its nesting and its keys are bounded before it is parsed.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from symobs.errors import InputError, ProblemErrors, SymobsError
from symobs.method import Document, Result, Task, tasks
from symobs.specification import KINDS
from symobs.system import StateSpace, Symbols

MAX_BYTES = 256 * 1024
_MAX_DOTTED = 400
_MAX_NESTING = 100
_MAX_DIGITS = 1000
_MAX_TITLE = 2000

_TOP = {
    "title": "a text",
    "id": "row ids of the catalogue",
    "source": "where it comes from",
    "task": "one task",
    "tasks": "a list of tasks",
    "convention": '"standard"',
    "symbols": "a table of names and signs",
    "plant": "a table with A, B, C, D or transfer_function",
    "specification": "a table",
    "expect": "answers to hold the result against",
}
_PLANT = ("A", "B", "C", "D", "transfer_function", "dt")


#: In place of a table of symbols: every well-formed name is a real symbol, as on the command line without a file.
OPEN = object()


class Decimal(str):
    """A decimal of a file, kept as its text, so that it is read exactly."""

    __slots__ = ()


@dataclass(frozen=True)
class Problem:
    """A validated problem: everything but the answers."""

    title: str
    source: str
    ids: tuple[str, ...]
    tasks: tuple[Task, ...]
    plant: StateSpace
    specification: Mapping[str, Any]
    expect: Mapping[str, Any] = field(default_factory=dict)

    def solve(self, report: Callable[[str], None] | None = None) -> tuple[Result, ...]:
        """Run every task; `report` is told which one begins.  All errors of all tasks are raised together."""
        results: list[Result] = []
        errors: list[SymobsError] = []
        for task in self.tasks:
            if report is not None:
                report(task.name)
            keywords = {name: value for name, value in self.specification.items() if name in task.keywords}
            try:
                results.append(task.function(self.plant, **keywords))
            except ProblemErrors as several:
                errors += several.errors
            except SymobsError as error:
                errors.append(error)
        if errors:
            distinct = {str(error): error for error in errors}
            raise ProblemErrors(tuple(distinct.values()))
        return tuple(results)

    def document(self, results: tuple[Result, ...]) -> Document:
        """Return what a format renders."""
        return Document(self.title, self.source, results)


def read(text: str, where: str = "problem") -> Problem:
    """Return the problem a file describes; text that starts with `{` is JSON, else TOML.

    Raises `ProblemErrors` with every error of the file.
    """
    data = parse(text, where)
    try:
        return validate(data)
    except ProblemErrors as errors:
        raise ProblemErrors(errors.errors) from None
    except SymobsError as error:
        raise ProblemErrors((error,)) from None


def parse(text: str, where: str = "problem") -> dict[str, Any]:
    """Return the file's tables, decimals as `Decimal` texts.  Raises `ProblemErrors`."""
    try:
        return _parse_json(text) if text.lstrip("\ufeff \t\r\n").startswith("{") else _parse_toml(text)
    except InputError as error:
        error.where = error.where or where
        raise ProblemErrors((error,)) from None


def _guard(text: str) -> None:
    """Refuse what would cost the parsers their memory, their stack or their time."""
    if len(text.encode("utf-8", "replace")) > MAX_BYTES:
        message = f"the file is larger than {MAX_BYTES // 1024} kB"
        raise InputError(message, repair="keep one problem to a file")
    if re.search(rf"[0-9_]{{{_MAX_DIGITS + 1},}}", text):
        message = f"a number has more than {_MAX_DIGITS} digits"
        raise InputError(message, repair=f"write at most {_MAX_DIGITS} digits")
    depth = 0
    for character in re.sub(r'"(?:[^"\\\n]|\\.)*"', "", text):
        depth += (character in "[{") - (character in "]}")
        if depth > _MAX_NESTING:
            message = f"brackets are nested more than {_MAX_NESTING} deep"
            raise InputError(message, repair="write matrices as texts or as lists of lists")


def _parse_json(text: str) -> dict[str, Any]:
    _guard(text)

    def refuse_constant(name: str) -> Any:
        message = f"{name} is not a number"
        raise InputError(message, repair="write a finite exact value")

    def unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
        found: dict[str, Any] = {}
        for key, value in pairs:
            if key in found:
                message = f"the key {key[:40]!r} stands twice"
                raise InputError(message, repair="keep one of them")
            found[key] = value
        return found

    try:
        data = json.loads(text, parse_float=Decimal, parse_constant=refuse_constant, object_pairs_hook=unique)
    except InputError:
        raise
    except (ValueError, RecursionError) as error:
        message = f"this is not JSON: {str(error)[:120]}"
        raise InputError(message, repair="check quotes, commas and brackets there") from None
    if not isinstance(data, dict):
        message = "the file is not a table"
        raise InputError(message, repair='begin with {"title": …}')
    return data


def _parse_toml(text: str) -> dict[str, Any]:
    _guard(text)
    for number, line in enumerate(text.splitlines(), 1):
        head = line.split("=", 1)[0]
        if head.count(".") > _MAX_DOTTED or (len(head) > 2 * _MAX_DOTTED and "=" in line and "#" not in head):
            message = "a dotted key is too long"
            raise InputError(message, where=f"line {number}", repair="use the tables [plant] and [specification]")
    try:
        return tomllib.loads(text, parse_float=Decimal)
    except (ValueError, RecursionError) as error:
        message = f"this is not TOML: {str(error)[:120]}"
        repair = (
            "YAML is not read: write `key = value` lines under [tables]"
            if _looks_like_yaml(text)
            else ("write `key = value` lines, texts in quotes")
        )
        raise InputError(message, repair=repair) from None


def _looks_like_yaml(text: str) -> bool:
    first = next((line for line in text.splitlines() if line.strip() and not line.startswith("#")), "")
    return first.startswith("---") or re.match(r"^[A-Za-z_]+:(\s|$)", first) is not None


def validate(data: Mapping[str, Any]) -> Problem:
    """Return the problem of a file's tables.  Raises `ProblemErrors` with every error found."""
    errors: list[SymobsError] = []

    def attempt(action: Callable[[], Any], default: Any = None) -> Any:
        try:
            return action()
        except ProblemErrors as several:
            errors.extend(several.errors)
        except SymobsError as error:
            errors.append(error)
        return default

    errors += _unknown_keys(data, _TOP, "")
    title = attempt(lambda: _text(data.get("title", ""), "title"), "")
    source = attempt(lambda: _text(data.get("source", ""), "source"), "")
    ids = attempt(lambda: _ids(data.get("id", [])), ())
    attempt(lambda: _convention(data.get("convention", "standard")))
    wanted = attempt(lambda: _tasks(data), ())
    symbols = attempt(lambda: Symbols.of(None if data.get("symbols") is OPEN else _table(data, "symbols")))
    specification = attempt(lambda: _table(data, "specification"), {})
    if wanted:
        known = {name for task in wanted for name in task.keywords}
        errors += _unknown_keys(specification, dict.fromkeys(sorted(known), ""), "specification")
    expect = attempt(lambda: _table(data, "expect"), {})
    plant = attempt(lambda: _plant(data, symbols)) if symbols is not None else None
    if not errors:
        return Problem(title, source, ids, wanted, plant, specification, expect)
    if plant is not None and wanted:
        attempt(lambda: Problem(title, source, ids, wanted, plant, _known_part(specification, wanted)).solve())
    distinct = {str(error): error for error in errors}
    raise ProblemErrors(tuple(distinct.values()))


def _known_part(specification: Mapping[str, Any], wanted: tuple[Task, ...]) -> dict[str, Any]:
    known = {name for task in wanted for name in task.keywords}
    return {name: value for name, value in specification.items() if name in known}


def _unknown_keys(
    table: Mapping[str, Any], known: Mapping[str, str] | tuple[str, ...], where: str
) -> list[SymobsError]:
    from difflib import get_close_matches  # noqa: PLC0415 - needed for messages only

    found: list[SymobsError] = []
    for key in table:
        if key in known:
            continue
        shown = key if len(key) <= 40 else key[:40] + "…"
        near = get_close_matches(key[:64], list(known), 1)
        repair = f"did you mean {near[0]}?" if near else f"known keys are {', '.join(known)}"
        found.append(InputError(f"unknown key {shown!r}", where=where or "problem", repair=repair))
    return found


def _text(value: object, where: str) -> str:
    if not isinstance(value, str) or isinstance(value, Decimal) or len(value) > _MAX_TITLE:
        message = f"{type(value).__name__} is not a text of at most {_MAX_TITLE} characters"
        raise InputError(message, where=where, repair="write it in quotes")
    return value


def _ids(value: object) -> tuple[str, ...]:
    entries = [value] if isinstance(value, str) else value
    if not isinstance(entries, list) or not all(isinstance(entry, str) for entry in entries):
        message = "not a list of texts"
        raise InputError(message, where="id", repair='write id = ["S0-Ex4.2"]')
    return tuple(entries)


def _convention(value: object) -> None:
    if value != "standard":
        message = f"{str(value)[:40]!r} is not a convention this version knows"
        raise InputError(message, where="convention", repair='write convention = "standard"')


def _table(data: Mapping[str, Any], name: str) -> Mapping[str, Any]:
    value = data.get(name, {})
    if not isinstance(value, Mapping):
        message = f"{type(value).__name__} came where a table is expected"
        raise InputError(message, where=name, repair=f"write [{name}] and its keys below")
    return value


def _tasks(data: Mapping[str, Any]) -> tuple[Task, ...]:
    known = tasks()
    if "task" in data and "tasks" in data:
        message = "both task and tasks are given"
        raise InputError(message, where="tasks", repair="keep one of them")
    entries = data.get("tasks", data.get("task", []))
    names = [entries] if isinstance(entries, str) else entries
    if not isinstance(names, list) or not names or not all(isinstance(name, str) for name in names):
        message = "no task is named"
        raise InputError(
            message, where="tasks", repair=f'write task = "observer"; known are {", ".join(sorted(known))}'
        )
    errors = [
        InputError(
            f"{name[:40]!r} is not a task", where=f"tasks[{i}]", repair=f"known tasks are {', '.join(sorted(known))}"
        )
        for i, name in enumerate(names)
        if name not in known
    ]
    if errors:
        raise ProblemErrors(tuple(errors))
    return tuple(known[name] for name in names)


def _plant(data: Mapping[str, Any], symbols: Symbols) -> StateSpace:
    table = _table(data, "plant")
    errors = _unknown_keys(table, _PLANT, "plant")
    if errors:
        raise ProblemErrors(tuple(errors))
    dt = table.get("dt", 0)
    if "transfer_function" in table:
        both = [name for name in "ABCD" if name in table]
        if both:
            message = f"both transfer_function and {both[0]} are given"
            raise InputError(message, where="plant", repair="keep one of them")
        function = _text(table["transfer_function"], "plant.transfer_function")
        return StateSpace.from_transfer_function(function, dt, symbols=symbols)
    if "A" not in table:
        message = "A is missing"
        raise InputError(message, where="plant.A", repair='give the state matrix, for example A = "[0 1; 0 -1]"')
    return StateSpace(*(table.get(name) for name in "ABCD"), dt, symbols=symbols)


def schema() -> dict[str, Any]:
    """Return the JSON schema of a problem file, read from the registry."""
    matrix = {"oneOf": [{"type": "string"}, {"type": "array"}]}
    keywords: dict[str, Any] = {}
    for task in tasks().values():
        for name, kind in task.keywords.items():
            keywords.setdefault(name, {**KINDS[kind], "tasks": []})["tasks"].append(task.name)
    plant = dict.fromkeys("ABCD", matrix) | {
        "transfer_function": {"type": "string"},
        "dt": {"description": "0 continuous, true or a positive value discrete"},
    }
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "symobs problem",
        "type": "object",
        "additionalProperties": False,
        "properties": {
            **{name: {"description": text} for name, text in _TOP.items()},
            "task": {"enum": sorted(tasks())},
            "tasks": {"type": "array", "items": {"enum": sorted(tasks())}},
            "plant": {"type": "object", "properties": plant, "additionalProperties": False},
            "specification": {"type": "object", "properties": keywords, "additionalProperties": False},
        },
    }
