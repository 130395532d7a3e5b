"""The process that does the work: a job in, its row as JSON out, until nobody asks."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import digest, prepare, read_payload, row_text, run
from symobs.ground.child_processes.inside import is_for_want_of_memory, serve
from symobs.ground.errors import ProblemErrors, SymobsError

if TYPE_CHECKING:
    #: What a worker is given of a job: its key, its kind and the text of its data.
    Order = tuple[str, str, str]


def worked(order: Order) -> str:
    """Return the row of a job; raises `MemoryError` where there was not enough for it."""
    key, kind, payload = order
    return row_text(key, kind, _row(kind, payload))


def _row(kind: str, payload: str) -> dict[str, Any]:
    try:
        row = run(kind, read_payload(payload))
        return row | {"sha256": digest(row["result"])} if "result" in row else row
    except SymobsError as error:
        errors = error.errors if isinstance(error, ProblemErrors) else (error,)
        is_input = all(each.exit_code == SymobsError.exit_code for each in errors)
        return {"status": "unreadable" if is_input else "failed", "error": str(error).split("\n")}
    except Exception as error:  # noqa: BLE001 - whatever it is, the other jobs go on
        if is_for_want_of_memory(error):
            raise MemoryError from None
        return {"status": "failed", "error": [f"internal error: {type(error).__name__}: {str(error)[:200]}"]}


if __name__ == "__main__":
    serve(prepare, worked)
