"""A candidate: a problem made from the draws of one number, not yet known to be a variant."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, NamedTuple

from symobs.applications.variants.drawing.constructions import CONSTRUCTIONS
from symobs.applications.variants.drawing.integers import Poly, Rows, of_poles
from symobs.applications.variants.drawing.parameters import Poles
from symobs.applications.variants.drawing.stream import Draws
from symobs.applications.variants.reading.substitution import matrix_text, text_of, with_values
from symobs.formula.expression import parse_matrix, parse_polynomial
from symobs.formula.expression.source import shown
from symobs.ground.errors import SymobsError
from symobs.problem.schema import kinds_of
from symobs.tasks.result import task_named

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from symobs.applications.variants.drawing.constructions import Made
    from symobs.applications.variants.drawing.parameters import Value
    from symobs.applications.variants.reading.table import Table

#: The keys that say what one half of a compensator is to be; a file that gives one of them says it itself.
_HALVES = {
    "control_poles": ("control_poles", "control_polynomial", "poles", "polynomial", "K"),
    "observer_poles": ("observer_poles", "observer_polynomial", "poles", "polynomial", "L"),
}


class Candidate(NamedTuple):
    """A problem's tables, the values that were drawn, and its matrices where they are of whole numbers."""

    number: int
    data: Mapping[str, Any]
    values: Mapping[str, Value]
    matrices: Mapping[str, Rows]
    #: Rows, columns and zeros of each matrix of numbers.
    shapes: Mapping[str, tuple[int, int, int]]
    #: The ranks of 𝒞 and 𝒪 that a construction means to have.
    ranks: tuple[int, int] | None = None

    @property
    def is_whole(self) -> bool:
        """Return whether A, and what else there is of a plant, are of whole numbers."""
        given = {name for name in "ABCD" if name in self.data.get("plant", {})}
        return "A" in given and given == set(self.matrices)


def candidate(table: Table, seed: int, number: int) -> Candidate:
    """Return a candidate; raises `InputError` where a matrix stands within an expression."""
    draws = Draws(seed, number)
    values = {name: parameter.drawn(draws[name]) for name, parameter in table.parameters.items()}
    data = with_values(table.base, values)
    if table.construct is None:
        return _tidied(Candidate(number, data, values, {}, {}))
    made = CONSTRUCTIONS[table.construct][0](draws, table.shape)
    plant = {name: entry for name, entry in data.get("plant", {}).items() if name not in "ABC"}
    if "dt" in made.specification:
        data["plant"] = {"dt": made.specification["dt"], **plant}
    if made.plant:
        data["plant"] = {**{name: matrix_text(rows) for name, rows in made.plant.items()}, **plant}
    data["specification"] = _specified(data, made)
    sizes = table.shape.get("sizes")
    ranks = (sizes[0] + sizes[1], sizes[0] + sizes[2]) if sizes else None
    return _tidied(Candidate(number, data, values, made.plant, {}, ranks))


def base_candidate(table: Table) -> Candidate:
    """Return the problem that the file has of its own."""
    return _tidied(Candidate(-1, with_values(table.base, {}), {}, {}, {}))


def _specified(data: Mapping[str, Any], made: Made) -> dict[str, Any]:
    """Return the specification with what was drawn for it, where the file leaves that open and a task reads it."""
    given = dict(data.get("specification", {}))
    names = tasks_of(data)
    read = {key for name in names if (task := task_named(name)) is not None for key in kinds_of(task)}
    is_reduced = given.get("observer") == "minimal" or "reduced_order_observer" in names
    for key, value in made.specification.items():
        if key not in read or any(other in given for other in _HALVES.get(key, (key,))):
            continue
        if isinstance(value, Poles) and key == "observer_poles" and is_reduced:
            value = Poles(value.pairs[: len(value.pairs) - len(made.plant["C"])])  # noqa: PLW2901
        given[key] = text_of(value) if isinstance(value, Poles) else value
    return given


def tasks_of(data: Mapping[str, Any]) -> list[str]:
    """Return the names of a problem's tasks."""
    value = data.get("tasks", data.get("task", []))
    return [name for name in (value if isinstance(value, list) else [value]) if isinstance(name, str)]


def _tidied(found: Candidate) -> Candidate:
    """Return a candidate whose matrices of numbers are written plainly, and known where they are whole."""
    plant = found.data.get("plant")
    if not isinstance(plant, dict):
        return found
    matrices = dict(found.matrices)
    shapes = {name: _shape(rows) for name, rows in matrices.items()}
    for name in "ABCD":
        if name in plant and name not in matrices:
            entries = _entries(plant[name])
            if entries is None:
                continue
            plant[name] = matrix_text(entries)
            shapes[name] = _shape(entries)
            if all(entry.denominator == 1 for row in entries for entry in row):
                matrices[name] = tuple(tuple(int(entry) for entry in row) for row in entries)
    return found._replace(matrices=matrices, shapes=shapes)


def _shape(rows: Sequence[Sequence[object]]) -> tuple[int, int, int]:
    return len(rows), len(rows[0]), sum(not entry for row in rows for entry in row)


def _entries(value: object) -> tuple[tuple[Any, ...], ...] | None:
    """Return the fractions of a matrix of numbers; None for any other one, and for what cannot be read."""
    try:
        matrix = parse_matrix(value, {})
        return tuple(tuple(entry.fraction() for entry in row) for row in matrix.rows)
    except (SymobsError, ArithmeticError, ValueError):
        return None


# -- what is desired --------------------------------------------------------------------------------------------------


def desired(data: Mapping[str, Any], half: str) -> Poly | None:
    """Return the polynomial desired for control or observer where it has whole coefficients, None otherwise."""
    given = data.get("specification", {})
    alone = len(tasks_of(data)) == 1
    for prefix in (f"{half}_", *([""] if alone else [])):
        if f"{prefix}poles" in given:
            return _of_text(str(_listed(given[f"{prefix}poles"])))
        if f"{prefix}polynomial" in given:
            return _of_polynomial(str(given[f"{prefix}polynomial"]))
    return None


def _listed(value: object) -> object:
    return ", ".join(map(str, value)) if isinstance(value, list) else value


@lru_cache(maxsize=4096)
def _of_text(text: str) -> Poly | None:
    """Return the polynomial of whole poles; those with imaginary parts are left to the engine."""
    try:
        return of_poles((int(part), 0) for part in text.split(","))
    except ValueError:
        return None


@lru_cache(maxsize=4096)
def _of_polynomial(text: str) -> Poly | None:
    try:
        found = [entry.fraction() for entry in parse_polynomial(text, "s", {}).coefficients("s")]
    except (SymobsError, ArithmeticError, ValueError):
        return None
    whole = all(entry.denominator == 1 for entry in found) and found[0] == 1
    return tuple(int(entry) for entry in reversed(found)) if whole else None


def pole_kinds(data: Mapping[str, Any]) -> list[list[Any]]:
    """Return of every list of poles how often each stands there, and whether it is real."""
    given = data.get("specification", {})
    found = []
    for key in sorted(key for key in given if key.endswith("poles")):
        poles = [part.strip() for part in str(_listed(given[key])).split(",")]
        counts = sorted(f"{'complex' if 'i' in pole else 'real'} {poles.count(pole)}" for pole in set(poles))
        found.append([shown(key, 40), *counts])
    return found
