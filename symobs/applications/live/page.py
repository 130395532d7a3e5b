"""The second tier: the whole checked derivation as a fragment of a page, and what can be taken away."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Mapping
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.live.request import link_of
from symobs.ground.errors import InputError
from symobs.tasks.result import render, result_type

if TYPE_CHECKING:
    from symobs.problem import Problem
    from symobs.tasks.result import Result


_FORMATS = {"latex": ".tex", "json": ".json", "html": ".html", "svg": ".svg", "toml": ".toml", "python": ".py"}


def page_object(problem: Problem, result: Result, detail: str) -> dict[str, Any]:
    """Return the derivation, every line of it checked."""
    document = replace(problem.document((result,)), detail=detail)
    return {"html": render(document, "html_fragment")}


def export_object(problem: Problem, result: Result, form: str, data: Mapping[str, Any], task: str) -> dict[str, Any]:
    """Return a text to be saved, and the name of its file."""
    match form:
        case "toml":
            text = toml_of(_of_one_task(data, task))
        case "python":
            text = python_of(_of_one_task(data, task), task)
        case "svg":
            from symobs.pages.drawings.plot_file import picture_file  # noqa: PLC0415 - only with pictures

            if result.picture is None:
                raise InputError("there is no picture of this task", where="as", repair="ask for html or latex")
            text = picture_file([result], "picture.svg").decode()
        case _:
            text = str(render(problem.document((result,)), form))
    return {"text": text, "file": f"{task}{_FORMATS[form]}"}


def _of_one_task(data: Mapping[str, Any], task: str) -> dict[str, Any]:
    kept = {key: value for key, value in data.items() if key not in {"task", "tasks", "expect", "id"}}
    return {"task": task, **kept}


def toml_of(data: Mapping[str, Any]) -> str:
    """Return a problem file."""
    plain = [f"{key} = {_toml(value)}" for key, value in data.items() if not isinstance(value, Mapping)]
    tables = [
        "\n".join(["", f"[{name}]", *(f"{_key(key)} = {_toml(value)}" for key, value in table.items())])
        for name, table in data.items()
        if isinstance(table, Mapping) and table
    ]
    return "\n".join([*plain, *tables]) + "\n"


def _key(name: str) -> str:
    return name if name.replace("_", "").isalnum() and name.isascii() else json.dumps(name)


def _toml(value: Any) -> str:
    """Return a value; JSON's strings, integers, truths and lists are TOML's."""
    if isinstance(value, Mapping):
        return f"{{ {', '.join(f'{_key(key)} = {_toml(entry)}' for key, entry in value.items())} }}"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_toml, value))}]"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def python_of(data: Mapping[str, Any], task: str) -> str:
    """Return the same design as a program; without the file's convention, in which Python does not speak."""
    plant, specification = data.get("plant", {}), data.get("specification", {})
    declared = data.get("symbols", {})
    given = [f"{name}={plant[name]!r}" for name in ("A", "B", "C", "D", "dt", "delay", "pade") if name in plant]
    symbols = [f"symbols={dict(declared)!r}"] if declared else []
    if "transfer_function" in plant:
        rest = [each for each in given if each.startswith(("dt=", "delay=", "pade="))]
        made = f"symobs.StateSpace.from_transfer_function({', '.join([repr(plant['transfer_function']), *rest, *symbols])})"
    else:
        made = f"symobs.StateSpace({', '.join([*given, *symbols])})"
    lines = ["import symobs", ""]
    keywords = [f"{key}={value!r}" for key, value in specification.items()]
    if plant:
        lines.append(f"plant = {made}")
        keywords.insert(0, "plant")
    return "\n".join([*lines, f"result = symobs.{task}({', '.join(keywords)})", "print(result.to('text'))", ""])


# The worked examples that come with the package, as problems to begin with.


_PLACES = tuple(Path(__file__).parents[up] / "worked_examples" for up in (2, 3))
#: One of a few hundred kilobytes takes longer to look at than to solve.
_LARGE = {"cart_pole"}


@cache
def examples() -> list[dict[str, Any]]:
    """Return name, title, task and link of every example, with a task that has something to move where one has."""
    folder = next((place for place in _PLACES if place.is_dir()), None)
    found = []
    for path in sorted(folder.glob("*.toml")) if folder is not None else []:
        data = tomllib.loads(path.read_text(encoding="utf-8"), parse_float=str)
        names = data.get("tasks", [data.get("task")])
        task = next((name for name in reversed(names) if result_type(name).panels), names[-1])
        if path.stem in _LARGE or task == "equilibria":  # a plant without a linearisation has nothing to move
            continue
        told = {key: entry for key, entry in data.items() if key != "language"} | {"tasks": [*names, task]}
        found.append({"name": path.stem, "title": data.get("title", path.stem), "task": task, "link": link_of(told)})
    return found
