"""Parameters at rational points, and which case of an answer holds there."""

from __future__ import annotations

import re
from collections.abc import Mapping
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING, Any

from tests.programs.strata_oracle.answers import relations
from tests.programs.strata_oracle.points import points_on
from tests.support.algebra import Point, holds

if TYPE_CHECKING:
    from tests.support.problems.random_problems import Tables

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
#: What an answer holds beside its fields.
_NOT_FIELDS = {"certificates", "in_convention", "cases", "conditions"}


# -- the answer at a point ---------------------------------------------------------------------------------------------


class Uncovered(Exception):
    """No case of an answer holds at a point where the plant is defined."""


def answer_at(answer: Tables, point: Point) -> Tables | None:
    """Return the fields of an answer that hold at a point, with the verdict; None where there is no plant.

    Raises `Uncovered` where a condition fails and no case takes its place.
    """
    if any(not holds(condition, point) for kind, condition in _conditions(answer) if kind == "domain"):
        return None
    branch = _deeper(answer, point)
    asked = [(kind, condition) for kind, condition in _conditions(branch) if kind != "domain"]
    broken = [(kind, condition) for kind, condition in asked if not holds(condition, point)]
    if branch["verdict"] != "conditional":
        if broken and branch is answer:
            raise Uncovered(f"{broken[0][1]} fails and no case holds")
        return branch
    # Where its conditions hold, and no deeper case does, what is said under conditions is said.
    if all(kind == "existence" and "!=" not in condition for kind, condition in broken):
        return branch | {"verdict": "no" if broken else "yes"}
    raise Uncovered(f"{broken[0][1]} fails and no case holds")


def _conditions(branch: Tables) -> list[tuple[str, str]]:
    return list(zip(branch.get("condition_kinds", []), branch.get("conditions", []), strict=True))


def _deeper(outer: Tables, point: Point) -> Tables:
    """Return the branch that holds at a point: a case has the fields around it where it does not say otherwise."""
    for case in outer.get("cases", []):
        if all(holds(relation, point) for relation in case["when"]):
            return _deeper({**outer, "cases": [], "conditions": [], "condition_kinds": [], **case}, point)
    return outer


def texts_at(thing: Any, point: Point) -> Any:
    """Put the numbers of a point in place of the names in every text of a value."""
    if not point:
        return thing
    if isinstance(thing, str):
        return _NAME.sub(lambda name: f"({point[name.group()]})" if name.group() in point else name.group(), thing)
    if isinstance(thing, list):
        return [texts_at(entry, point) for entry in thing]
    if isinstance(thing, Mapping):
        return {key: texts_at(entry, point) for key, entry in thing.items() if key not in _NOT_FIELDS}
    return thing


# -- points ------------------------------------------------------------------------------------------------------------


def points_for(problem: Tables, answer: Tables, most: int = 5) -> list[Point]:
    """Return points: one in general position, and some on the curves that the answer speaks of."""
    curves = [*relations(answer), *_meetings(answer)]
    return [general_point(problem), *points_on(curves, problem["symbols"], most - 1)] if problem["symbols"] else [{}]


def general_point(problem: Tables) -> Point:
    """Return numbers that are in general position."""
    primes = (101, 137, 173, 211, 251, 293, 331, 373)
    signs = ((name, -1 if sign in {"negative", "nonpositive"} else 1) for name, sign in problem["symbols"].items())
    return {name: Fraction(sign * prime, 7) for (name, sign), prime in zip(signs, primes, strict=False)}


def _meetings(answer: Tables) -> set[str]:
    """Return what is 0 where two of the modes are one, whether the answer speaks of that or not."""
    values = sorted({mode["eigenvalue"] for mode in answer.get("modes", []) if "CRootOf" not in mode["eigenvalue"]})
    return {f"({one})-({other})" for one, other in combinations(values, 2)}
