"""The command `solve`: the derivation of a problem file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from symobs.cli.shared.common import place_of, progress_on_terminal, read_file, run_work
from symobs.cli.shared.options import OF_A_PAGE, AFile, OneOf, options, quoted
from symobs.cli.shared.outcome import PageOptions, of_problem, solved
from symobs.ground.errors import UsageError
from symobs.problem import parse, validate
from symobs.tasks.result import tasks

if TYPE_CHECKING:
    from symobs.cli.shared.outcome import Outcome
    from symobs.cli.shared.time_and_memory import Progress


@click.command("solve")
@click.argument("file", type=AFile())
@click.option("--task", "task_name", type=OneOf(tasks), metavar="NAME", help="Run this task only.")
@click.option("--variant", type=click.IntRange(1), metavar="N", help="Of a file with [variants]: the N-th one (1).")
@options(*OF_A_PAGE)
def command(
    file: str, task_name: str | None, variant: int | None, timeout: float | None, memory: float | None, **given: Any
) -> None:
    """Solve a problem FILE (TOML or JSON; - is standard input) and print its derivation."""
    if task_name is not None and task_name not in tasks():
        raise UsageError(f"{quoted(task_name)} is not a task", repair=f"known tasks are {', '.join(sorted(tasks()))}")
    page = PageOptions.of(given)

    def work(report_progress: Progress) -> Outcome:
        tables = _tables(read_file(file), file, variant)
        found = validate(tables, task_name, Path(file).parent)
        own = tables if task_name is None else {**tables, "task": task_name, "tasks": None}
        offered = page.offering(of_problem(page.document["web"], own))
        return solved(found, offered, progress_on_terminal(report_progress), only_some_tasks=task_name is not None)

    run_work(work, timeout, memory, place_of(file))


def _tables(text: str, file: str, variant: int | None) -> dict[str, Any]:
    """Return the tables of a problem, or those of one of its variants."""
    tables = parse(text, file)
    if "variants" not in tables:
        if variant is not None:
            repair = "leave --variant out, or name a file with [variants]"
            raise UsageError("the file has no table [variants]", where="--variant", repair=repair)
        return tables
    from symobs.applications.variants import variant_of  # noqa: PLC0415 - for files that have variants only

    try:
        return variant_of(text, file, variant or 1)
    except UsageError as error:
        error.where = "--variant"
        raise
