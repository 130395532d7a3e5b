"""Parameters at rational points, and which case of an answer holds there."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from fractions import Fraction
from itertools import combinations, islice, product
from random import Random
from typing import TYPE_CHECKING, Any

from tests.support.algebra import Point, Unreadable, evaluated, has_sign, holds, sides

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Sequence

    from tests.support.problems.random_problems import Tables

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
_VALUES = [
    Fraction(p, q) for p, q in ((1, 1), (2, 1), (3, 1), (-1, 1), (-2, 1), (-3, 1), (0, 1), (1, 2), (-3, 2), (5, 3))
]
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


def points_for(problem: Tables, answer: Tables, most: int = 5) -> Iterator[Point]:
    """Yield points: some anywhere, and one in each pattern of equations that the answer speaks of, as far as found."""
    signs = problem["symbols"]
    if not signs:
        yield {}
        return
    random = Random(str(problem))  # noqa: S311 - test points, no secrets
    equations = sorted({side for text in _relations(answer) for side in _sides(text)} | _meetings(answer))
    seen: Counter[tuple[bool, ...]] = Counter()
    for point in islice(_candidates(signs, equations, random), 60):
        pattern = tuple(_vanishes(equation, point) for equation in equations)
        if seen[pattern] < (1 if any(pattern) else 2):
            seen[pattern] += 1
            yield point
            if seen.total() >= most:
                return


def _vanishes(text: str, point: Point) -> bool:
    try:
        return bool(evaluated(text, point) == 0)
    except (ZeroDivisionError, Unreadable):
        return False


def _relations(answer: Tables) -> Iterator[str]:
    yield from answer.get("conditions", [])
    for case in answer.get("cases", []):
        yield from case["when"]
        yield from _relations(case)


def _meetings(answer: Tables) -> set[str]:
    """Return what is 0 where two of the modes are one, whether the answer speaks of that or not."""
    values = sorted({mode["eigenvalue"] for mode in answer.get("modes", []) if "CRootOf" not in mode["eigenvalue"]})
    return {f"({one})-({other})" for one, other in combinations(values, 2)}


def _sides(relation: str) -> list[str]:
    if relation in {"True", "False"}:
        return []
    left, _, right = sides(relation)
    return [f"({left})-({right})"]


def _candidates(signs: Mapping[str, str], equations: Sequence[str], random: Random) -> Iterator[Point]:
    """Yield a few points anywhere, points on every equation that is linear in a name, and then a grid."""
    names = sorted(signs)
    allowed = {name: [v for v in _VALUES if has_sign(v, signs[name])] for name in names}

    def anywhere() -> dict[str, Fraction]:
        return {name: random.choice(allowed[name]) for name in names}

    for _ in range(2):
        yield anywhere()
    for equation in equations:
        for name in names:
            for _ in range(3):
                yield from _solved(equation, name, anywhere(), signs)
    grid: Iterable[tuple[Fraction, ...]] = product(*(allowed[name] for name in names))
    if len(names) < 3:
        yield from (dict(zip(names, values, strict=True)) for values in grid)
    while True:
        yield anywhere()


def _solved(equation: str, name: str, point: dict[str, Fraction], signs: Mapping[str, str]) -> Iterator[Point]:
    """Yield the point moved along one name to where the equation holds, where that is linear in the name."""
    try:
        zero, one, two = (evaluated(equation, {**point, name: Fraction(k)}) for k in (0, 1, 2))
    except (ZeroDivisionError, Unreadable):
        return
    if one != zero and two - one == one - zero:
        found = -zero / (one - zero)
        if has_sign(found, signs[name]) and max(abs(found.numerator), found.denominator) < 10**6:
            yield {**point, name: found}
