"""The kinds of work there are: each is a function from its data to a row, in a module of its own.

A kind is one line of the table.  Its module has

    run(payload) -> row         status (done, no, undecided, unreadable, failed), result, and error where there is one;
                                `files`, by format, where texts are to be stored beside the row
    recheck(payload, row)       what does not hold of a row, by other code than that which made it; None where it all does

Rows are plain JSON.  A row is a function of the payload alone: no times, names of machines or random numbers.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from symobs.tasks.result import tasks

KINDS = {
    "check": "symobs.applications.checking.classes.row",
    "sheet-entry": "symobs.cli.shared.sheet_entries",
    "solve": "symobs.applications.batch.solving",
    "variant": "symobs.applications.variants.acceptance.solving",
    "sweep-block": "symobs.applications.batch.sweep.block",
}


def prepare(kind: str) -> None:
    """Import what jobs of a kind need."""
    tasks()
    import_module(KINDS[kind])


def run(kind: str, payload: dict[str, Any]) -> dict[str, Any]:
    """Do a piece of work and return its row."""
    row: dict[str, Any] = import_module(KINDS[kind]).run(payload)
    return row


def recheck(kind: str, payload: dict[str, Any], row: dict[str, Any]) -> str | None:
    """Return what does not hold of a row, None where all that is looked at does."""
    found: str | None = import_module(KINDS[kind]).recheck(payload, row)
    return found
