"""Reading functions of time: measured outputs and known inputs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from symobs.errors import InputError
from symobs.exact.time_functions.quasipolynomial import Table, table_of
from symobs.specification import read_signal

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
    found = read_signal(value, plant, name, count, functions=True)
    try:
        sums = table_of(found)
    except ValueError as error:
        repair = "write sums of exponentials, sines and cosines times powers of t, such as 2 t exp(-t) sin(3 t)"
        raise InputError(str(error), where=where, repair=repair) from None
    if sum(len(entry.terms) for row in sums for entry in row) > _MOST_TERMS:
        raise InputError("the functions have too many terms", where=where, repair=f"keep to {_MOST_TERMS} terms")
    return found, sums
