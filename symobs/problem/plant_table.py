"""The table [plant] of a problem file: matrices, a transfer function, or a nonlinear plant with an equilibrium."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import islice
from typing import Any

from symobs.problem.noted_errors import Errors, report_unknown, table_of
from symobs.problem.schema import NONLINEAR, PLANT, repair_of
from symobs.system import StateSpace, Symbols, read_scalar
from symobs.system.linearisation.linearize import linearize
from symobs.system.time_domain import read_time

_MAX_CELLS = 1000


def period_of(data: Mapping[str, Any], symbols: Symbols, errors: Errors) -> object:
    """Return dt, 0 where it is none."""
    table = data.get("plant")
    with errors:
        dt: object = table.get("dt", 0) if isinstance(table, Mapping) else 0
        read_time(dt, symbols)
        return dt
    return 0


def plant_of(
    data: Mapping[str, Any], symbols: Symbols, dt: object, errors: Errors, *, optional: bool
) -> StateSpace | None:
    """Return the plant, None where it cannot be had; where it is `optional` a polynomial does instead."""
    table = table_of(data, "plant", errors)
    if not isinstance(data.get("plant", {}), Mapping):
        return None
    report_unknown(table, PLANT, "plant", errors, repair_of)
    given = [name for name in "ABCD" if name in table]
    nonlinear = {name: table[name] for name in NONLINEAR if name in table}
    forms = [*given[:1], *(name for name in ("transfer_function",) if name in table), *list(nonlinear)[:1]]
    if len(forms) > 1:
        errors.note(f"both {forms[-1]} and {forms[0]} are given", "plant", "keep one of them")
    elif nonlinear:
        with errors:
            return linearize(**{"f": None, "states": "", "equilibrium": None, **nonlinear}, dt=dt, symbols=symbols)
    elif "transfer_function" in table:
        with errors:
            return StateSpace.from_transfer_function(table["transfer_function"], dt, symbols=symbols)
    elif optional and not given and "polynomial" in (specification := table_of(data, "specification", errors)):
        with errors:
            known = symbols.naming(specification.get("parameters"), "specification.parameters")
            return StateSpace.from_polynomial(specification["polynomial"], dt, symbols=known)
    elif "A" not in table:
        errors.note("the state matrix is missing", "plant.A", 'give it, for example A = "[0 1; 0 -1]"')
    else:
        with errors:
            B, C, D = (table.get(name) for name in "BCD")
            return StateSpace(table["A"], B, C, D, dt, symbols=symbols)
        others = Errors()
        for name in given:
            read_cells(table[name], symbols.with_time(), f"plant.{name}", others)
        errors.add_elsewhere(others)
    return None


def read_cells(value: object, symbols: Symbols, where: str, errors: Errors) -> None:
    """Note every unreadable cell of a matrix in lists; reading the matrix as a whole stops at the first."""
    rows = value if isinstance(value, list) else []
    cells = ((i, j, cell) for i, row in enumerate(rows) if isinstance(row, list) for j, cell in enumerate(row))
    for i, j, cell in islice(cells, _MAX_CELLS):
        with errors:
            read_scalar(cell, symbols, f"{where}[{i}][{j}]")
