"""The columns of the table of a sweep, and the doubles nearest to what stands in them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Protocol

from symobs.applications.batch.sweep.program import MARGINS_STATUS
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from symobs.applications.batch.sweep.grid import Grid


class Swept(Protocol):
    """What a table is written from: a plan, its grid, and the blocks in the order of their points."""

    plan: Any

    @property
    def grid(self) -> Grid:
        """The points."""

    def blocks(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yield the first index and the result of every block."""


SCHEMA = "symobs-sweep/1"
ROW_GROUP = 65_536
PART = 2**20
_LAST_COLUMNS = ("status", "case", "checked")


def columns_of(table: Swept, first: int, result: dict[str, Any], *, decimals: bool) -> dict[str, list[Any]]:
    """Return a block as columns: the index, the names, the exact entries with their decimals, how it went."""
    count = len(result["status"])
    points = [table.grid.point(first + place) for place in range(count)]
    found: dict[str, list[Any]] = {"index": list(range(first, first + count))}
    exact = {name: [str(point[k]) for point in points] for k, name in enumerate(table.grid.names)}
    for name, column in {**exact, **result["columns"]}.items():
        found[name] = column
        if decimals and name != MARGINS_STATUS:
            found[f"{name}.d"] = nearest_of(name, {**result, "columns": {name: column}})
    checked = [status == "done" for status in result["status"]]
    return {**found, "status": result["status"], "case": result["case"], "checked": checked}


def nearest_of(name: str, result: dict[str, Any]) -> list[float | None]:
    """Return the binary numbers nearest to the entries of a column of a block."""
    known = result.get("nearest", {}).get(name, {})
    return [
        known[str(place)] if str(place) in known else None if entry is None else nearest(entry)
        for place, entry in enumerate(result["columns"][name])
    ]


def nearest(text: str) -> float | None:
    """Return the binary number nearest to an exact one, None beyond their range."""
    above, _, below = text.partition("/")
    try:
        if "." in text or text == "oo":
            return float(text.replace("oo", "inf"))
        return int(above) / int(below or 1)  # Python rounds the quotient of integers correctly
    except OverflowError:
        return None
    except ValueError:
        return _nearest_irrational(text)


def _nearest_irrational(text: str) -> float | None:
    from symobs.exact.floating.sampled import nearest_double  # noqa: PLC0415 - few tables have such numbers
    from symobs.formula.expression import parse_scalar  # noqa: PLC0415

    try:
        return nearest_double(parse_scalar(text, {}, functions=True))
    except (InputError, ValueError):
        return None


def header(table: Swept, *, decimals: bool) -> list[str]:
    """Return the names of the columns."""
    exact = [*table.grid.names, *table.plan.columns]
    named = [
        each for name in exact for each in ((name, f"{name}.d") if decimals and name != MARGINS_STATUS else (name,))
    ]
    return ["index", *named, *_LAST_COLUMNS]
