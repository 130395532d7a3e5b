"""The worked examples that come with the package, as problems to begin with."""

from __future__ import annotations

import tomllib
from functools import cache
from pathlib import Path
from typing import Any

from symobs.applications.live.links import link_of
from symobs.tasks.result import result_type

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
        if path.stem in _LARGE:
            continue
        told = {key: entry for key, entry in data.items() if key != "language"} | {"tasks": [*names, task]}
        found.append({"name": path.stem, "title": data.get("title", path.stem), "task": task, "link": link_of(told)})
    return found
