"""Regions of stability to be found, as `region_problems.toml` has them."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

from tests.support.regions.region_problem import Problem

_GROUPS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))


def _problem(given: dict[str, Any]) -> Problem:
    tuples = {name: tuple(given[name]) for name in {"parameters"} & given.keys()}
    holes = {name: tuple(map(tuple, given[name])) for name in {"excluded"} & given.keys()}
    return Problem(**{**given, **tuples, **holes})


RECORDED, SHAPES, OBSERVERS, ONE_PARAMETER = ([*map(_problem, problems)] for problems in _GROUPS.values())
PROBLEMS = [*RECORDED, *SHAPES, *OBSERVERS, *ONE_PARAMETER]


def by_name(name: str) -> Problem:
    """Return a problem of this name."""
    return next(problem for problem in PROBLEMS if problem.name == name)
