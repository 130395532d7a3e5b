"""From a problem an oracle disagrees about to a smaller one it still disagrees about."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Any

from tests.programs.campaign.asked import Asked, Tables, listed, rows, text_of
from tests.programs.campaign.points import NotRational, texts_at, value
from tests.programs.campaign.solving import solved

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from tests.programs.campaign.discovery import Oracle

#: Tries beyond this many are not worth their time.
_MOST = 300


def disagrees(oracle: Oracle, kind: str, problem: Tables) -> str | None:
    """Return the disagreement of an oracle about our answer to a problem; None where there is none."""
    if not oracle.covers(problem):
        return None
    asked = solved(kind, 0, problem)
    if not isinstance(asked, Asked):
        return None
    (found,) = oracle.differences([asked])
    return found if isinstance(found, str) else None


def shrunk(problem: Tables, fails: Callable[[Tables], bool]) -> Tables:
    """Return a problem that still fails and none of whose smaller neighbours does."""
    left = _MOST
    while True:
        for smaller in _smaller(problem):
            left -= 1
            if left < 0:
                return problem
            if fails(smaller):
                problem = smaller
                break
        else:
            return problem


def _smaller(problem: Tables) -> Iterator[Tables]:
    """Yield simpler problems, the largest steps first."""
    yield from _without_parameters(problem)
    yield from _without_states(problem)
    yield from _without_ports(problem)
    plant = problem["plant"]
    if "D" in plant:
        yield _with(problem, {key: text for key, text in plant.items() if key != "D"})
    if plant.get("dt"):
        yield _with(problem, {key: text for key, text in plant.items() if key != "dt"})
    yield from _plainer_entries(problem)


def _with(problem: Tables, plant: Tables, specification: Tables | None = None) -> Tables:
    return {
        **problem,
        "plant": plant,
        "specification": problem["specification"] if specification is None else specification,
    }


def _without_parameters(problem: Tables) -> Iterator[Tables]:
    """Yield the problem with a number for one of its parameters."""
    for name in problem["symbols"]:
        for number in (1, -1, 2):
            point = {name: Fraction(number)}
            signs = {other: sign for other, sign in problem["symbols"].items() if other != name}
            plant, asked = texts_at(problem["plant"], point), texts_at(problem["specification"], point)
            if asked.get("parameters") == problem["specification"].get("parameters"):
                yield {
                    **problem,
                    "symbols": signs,
                    "plant": {k: _valued(t) for k, t in plant.items()},
                    "specification": asked,
                }


def _valued(text: Any) -> Any:
    """Return a matrix with entries that are numbers written as numbers."""
    if not isinstance(text, str) or not text.startswith("["):
        return text
    return text_of([[_number(entry) for entry in row] for row in rows(text)])


def _number(entry: str) -> str:
    try:
        return str(value(entry, {}))
    except (NotRational, ZeroDivisionError):
        return entry


def _without_states(problem: Tables) -> Iterator[Tables]:
    """Yield the problem without one of its states; poles are asked for one less."""
    plant = problem["plant"]
    if "A" not in plant:
        return
    order = len(rows(plant["A"]))
    for state in range(order if order > 1 else 0):
        smaller = dict(plant)
        smaller["A"] = text_of(_dropped(_dropped(rows(plant["A"]), state, None), None, state))
        if "B" in plant:
            smaller["B"] = text_of(_dropped(rows(plant["B"]), state, None))
        if "C" in plant:
            smaller["C"] = text_of(_dropped(rows(plant["C"]), None, state))
        yield _with(
            problem, smaller, {name: _fewer(name, text, state) for name, text in problem["specification"].items()}
        )


def _fewer(name: str, text: Any, state: int) -> Any:
    """Return an entry of the specification for one state less."""
    if name.endswith("poles"):
        poles = listed(text)
        return ", ".join([f"-{k + 1}" for k in range(len(poles) - 1)]) or "-1"
    if name == "reference_matrix":
        return text_of(_dropped(_dropped(rows(text), state, None), None, state))
    return text


def _dropped(table: list[list[str]], row: int | None, column: int | None) -> list[list[str]]:
    return [[entry for j, entry in enumerate(line) if j != column] for i, line in enumerate(table) if i != row]


def _without_ports(problem: Tables) -> Iterator[Tables]:
    """Yield the problem without one of its inputs or outputs."""
    plant = problem["plant"]
    for letter, across in (("B", True), ("C", False)):
        if letter not in plant:
            continue
        table = rows(plant[letter])
        for k in range(len(table[0] if across else table)):
            drop = (None, k) if across else (k, None)
            smaller = {**plant, letter: text_of(_dropped(table, *drop))}
            if "D" in plant:
                smaller["D"] = text_of(_dropped(rows(plant["D"]), *drop))
            if len(table[0] if across else table) > 1:
                yield _with(problem, smaller)


def _plainer_entries(problem: Tables) -> Iterator[Tables]:
    """Yield the problem with one entry 0 or 1."""
    plant = problem["plant"]
    for letter in "ABCD":
        if letter not in plant:
            continue
        table = rows(plant[letter])
        for i, row in enumerate(table):
            for j, entry in enumerate(row):
                for plain in ("0", "1") if entry not in {"0", "1"} else ("0",) if entry == "1" else ():
                    changed = [
                        [plain if (a, b) == (i, j) else x for b, x in enumerate(line)] for a, line in enumerate(table)
                    ]
                    yield _with(problem, {**plant, letter: text_of(changed)})
