"""Reading functions of time: measured outputs and known inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.errors import InputError, ShapeMismatch
from symobs.exact.functions import symbols_in
from symobs.exact.quasi import Table, table_of
from symobs.expression import parse_matrix
from symobs.system import is_sympy

if TYPE_CHECKING:
    from symobs.exact import Matrix
    from symobs.system import StateSpace

_MOST_TERMS = 60


def read_functions(value: object, plant: StateSpace, name: str, count: int) -> tuple[Matrix, Table]:
    """Return a column of `count` functions of t, as a matrix and as sums; raises `InputError`, `ShapeMismatch`."""
    where = f"specification.{name}"
    if value is None:
        message = f"the {name} is missing"
        raise InputError(message, where=where, repair=f'give it as a function of t, {name} = "1 - exp(-t)"')
    known = plant.symbols.seen(value, "t")
    listed = [str(v) if is_sympy(v) else v for v in value] if isinstance(value, (list, tuple)) else value
    text = str(listed) if is_sympy(listed) else listed
    rows = [v if isinstance(v, (list, tuple)) else [v] for v in text] if isinstance(text, (list, tuple)) else text
    if not isinstance(rows, (str, list)):
        rows = [[rows]]
    found = parse_matrix(rows, known.names, variable="t", where=where, functions=True)
    if found.shape[1] == count and found.shape[0] == 1:
        found = found.T
    if found.shape != (count, 1):
        message = f"{found.shape[0]}×{found.shape[1]} functions are given, {count} are needed"
        raise ShapeMismatch(message, where=where, repair=f"give one function of t for each component, {count} in all")
    try:
        sums = table_of(found)
    except ValueError as error:
        repair = "write sums of exponentials, sines and cosines times powers of t, such as 2 t exp(-t) sin(3 t)"
        raise InputError(str(error), where=where, repair=repair) from None
    if sum(len(entry.terms) for row in sums for entry in row) > _MOST_TERMS:
        raise InputError("the functions have too many terms", where=where, repair=f"keep to {_MOST_TERMS} terms")
    return found, sums


def moves(matrix: Matrix) -> bool:
    """Whether a matrix depends on the time."""
    return "t" in symbols_in(matrix)
