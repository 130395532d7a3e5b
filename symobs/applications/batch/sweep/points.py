"""The work of a sweep: a block of consecutive points, each checked exactly."""

from __future__ import annotations

import json
import random
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import canonical, read_payload
from symobs.applications.batch.recheck import Beyond, fault_at
from symobs.applications.batch.solving import given_for
from symobs.applications.batch.sweep.grid import Axis, Grid
from symobs.applications.batch.sweep.margins import cells_at
from symobs.applications.batch.sweep.program import MARGINS, MARGINS_STATUS, Program

if TYPE_CHECKING:
    from collections.abc import Mapping
    from fractions import Fraction

#: Points of a block that are looked at again.
_LOOKED_AT = 3


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a block: how each point went, its case, and the columns as exact texts."""
    grid, program = grid_of(payload), _program(canonical(payload["program"]))
    outer: tuple[Fraction, ...] | None = None
    rows = []
    for index in range(payload["first"], payload["first"] + payload["count"]):
        point = grid.point(index)
        if point[:-1] != outer:
            outer = point[:-1]
            program.line(outer)
        rows.append(program.at(point))
    whole = {name: [row.values[k] for row in rows] for k, name in enumerate(program.columns())}
    columns = {name: whole[name] for name in payload["columns"] if name in whole}
    result: dict[str, Any] = {
        "status": [row.status for row in rows],
        "case": [row.case for row in rows],
        "columns": columns,
    }
    if MARGINS_STATUS in payload["columns"]:
        result["nearest"] = _add_margins(columns, whole, program, grid, payload)
    return {"status": "undecided" if "undecided" in result["status"] else "done", "result": result}


def _add_margins(
    columns: dict[str, Any], whole: Mapping[str, list[Any]], program: Program, grid: Grid, payload: Mapping[str, Any]
) -> dict[str, dict[str, float]]:
    """Add the margins to the columns; return by column and place the binary numbers nearest to what is no fraction."""
    names = [name for name in (*MARGINS, MARGINS_STATUS) if name in payload["columns"]]
    columns |= {name: [None] * payload["count"] for name in names}
    nearest: dict[str, dict[str, float]] = {}
    for place in range(payload["count"]):
        entries = {name: column[place] for name, column in whole.items()}
        if None in entries.values():
            continue
        cells, doubles = cells_at(program, grid.point(payload["first"] + place), entries)
        for name in names:
            columns[name][place] = cells.get(name)
            if name in doubles:
                nearest.setdefault(name, {})[str(place)] = doubles[name]
    return nearest


def grid_of(payload: Mapping[str, Any]) -> Grid:
    """Return the grid of a block's data."""
    return Grid(tuple(Axis.of(axis) for axis in payload["over"]))


@lru_cache(maxsize=4)
def _program(text: str) -> Program:
    """Return the program of all blocks of a sweep: read once by a process."""
    data = read_payload(text)
    return Program(data["problem"], data["names"], data["answer"], with_F=data["with_F"])


def recheck(payload: Mapping[str, Any], row: Mapping[str, Any]) -> str | None:
    """Return what does not hold at some points of a block, in plain fractions; None where all that is looked at does."""
    if "result" not in row:
        return None
    result, grid = row["result"], grid_of(payload)
    program = _program(canonical(payload["program"]))
    given = given_for(program.problem, program.task)
    places = [k for k, status in enumerate(result["status"]) if status == "done"]
    drawn = random.Random(row["key"])  # noqa: S311 - no secret
    for place in drawn.sample(places, min(_LOOKED_AT, len(places))):
        point = grid.point(payload["first"] + place)
        here = dict(zip(grid.names, point, strict=True))
        answer = _answer(program, {name: column[place] for name, column in result["columns"].items()})
        try:
            found = fault_at(here, program.task.name, given, answer)
        except Beyond:
            continue
        if found is not None:
            return f"{found}, at {json.dumps({name: str(value) for name, value in here.items()})}"
    return None


def _answer(program: Program, cells: Mapping[str, str]) -> dict[str, Any]:
    """Return the matrices and F of a row of the table."""
    shapes = {"K": (program.m, program.n), "L": (program.n, program.p)}
    answer: dict[str, Any] = {}
    for gain in program.gains:
        rows, columns = shapes[gain]
        names = [[f"{gain}[{i + 1},{j + 1}]" for j in range(columns)] for i in range(rows)]
        if all(name in cells for row in names for name in row):
            answer[gain] = [[cells[name] for name in row] for row in names]
    parts = [[cells.get(f"F.{part}[{k}]") for k in range(program.n + 1)] for part in ("num", "den")]
    if all(entry is not None for part in parts for entry in part):
        above, below = (" + ".join(f"({c})*{program.variable}**{k}" for k, c in enumerate(part)) for part in parts)
        answer["F"] = f"({above})/({below})"
    return answer
