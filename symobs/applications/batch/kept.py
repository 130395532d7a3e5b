"""The work of a worker: each job is done by one of its kept children, which is replaced when it dies."""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import fingerprint, row_text
from symobs.ground.child_processes.budget import Budget
from symobs.ground.child_processes.child import Died, Kept
from symobs.ground.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    #: What a worker is given of a job: its key, its kind and the text of its data.
    Order = tuple[str, str, str]

CHILD = "symobs.applications.batch.child"
#: How often a job may end its process.
_ATTEMPTS = 2
#: The children of a worker whose run is elsewhere; they end with its process.
_own = Kept(CHILD)


def run_chunk(
    orders: Sequence[Order], budget: tuple[float | None, float | None], expected: str, children: Kept = _own
) -> tuple[list[str], float]:
    """Return the rows of some jobs as JSON, made by a child of this process, and the seconds this took.

    Raises `InputError` where this worker has other versions than expected.
    """
    began = time.monotonic()
    if identity() != expected:
        message = f"a worker has {identity()}, this process {expected}"
        raise InputError(message, where="--scheduler", repair="install the same versions everywhere")
    return [_row(order, Budget(*budget), children) for order in orders], time.monotonic() - began


def run_in_process(orders: Sequence[Order], _: object, __: str) -> tuple[list[str], float]:
    """Return the same rows without a child, and so without limits."""
    from symobs.applications.batch.child import worked  # noqa: PLC0415 - it imports the kernel

    began = time.monotonic()
    return [worked(order) for order in orders], time.monotonic() - began


def identity() -> str:
    """Return the versions that must be the same wherever jobs of one run are done."""
    return f"{fingerprint()}, Python {sys.version_info.major}.{sys.version_info.minor}"


def _row(order: Order, limits: Budget, children: Kept) -> str:
    """Return the row of one job; what ends its process is tried once more, in a fresh one."""
    key, kind, _ = order
    row: dict[str, Any] = {}
    for attempt in range(1, _ATTEMPTS + 1):
        try:
            with children.one(kind, megabytes=limits.megabytes, fresh=attempt > 1) as child:
                found: str = child.ask(order, limits.seconds)
                return found
        except TimeoutError:
            row = {"status": "undecided", "error": [f"{limits.seconds:g} seconds were not enough"]}
            break
        except Died as death:
            if death.for_memory:
                row = {"status": "undecided", "error": [_too_much(limits)], "attempts": attempt}
            else:
                row = {"status": "failed", "error": [f"its process ended with {death}"], "attempts": attempt}
    told = {"seconds": limits.seconds, "megabytes": limits.megabytes}
    status, error = row.pop("status"), row.pop("error")
    return row_text(key, kind, {"status": status, "error": error, "budget": told, **row})


def _too_much(limits: Budget) -> str:
    return (
        "the memory there is was not enough"
        if limits.megabytes is None
        else f"{limits.megabytes:g} MB of memory were not enough"
    )
