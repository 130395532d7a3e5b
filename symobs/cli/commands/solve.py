"""The command `solve`: the derivation of a problem file."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from symobs.cli.shared.common import chosen_format, place_of, progress_on_terminal, read_file, run_work
from symobs.cli.shared.options import OF_A_PAGE, AFile, OneOf, options, quoted
from symobs.cli.shared.outcome import check_targets, convention_of, page_of, solved
from symobs.errors import UsageError
from symobs.problem import parse, validate
from symobs.result import tasks

if TYPE_CHECKING:
    from symobs.cli.shared.outcome import Outcome
    from symobs.cli.shared.time_and_memory import Progress


@click.command("solve")
@click.argument("file", type=AFile())
@click.option("--task", "task_name", type=OneOf(tasks), metavar="NAME", help="Run this task only.")
@options(*OF_A_PAGE)
def command(
    file: str,
    task_name: str | None,
    format_name: str | None,
    target: str | None,
    plot: str | None,
    bibliography: str | None,
    convention_name: str | None,
    detail: str,
    language: str | None,
    templates: str | None,
    printed: tuple[str, ...],
    period: str | None,
    hold: str,
    settings: dict[str, str],
    timeout: float | None,
    memory: float | None,
) -> None:
    """Solve a problem FILE (TOML or JSON; - is standard input) and print its derivation."""
    chosen = chosen_format(format_name, target, default="text" if printed else "latex")
    if task_name is not None and task_name not in tasks():
        raise UsageError(f"{quoted(task_name)} is not a task", repair=f"known tasks are {', '.join(sorted(tasks()))}")
    check_targets(target, plot, bibliography)
    convention = convention_of(convention_name)
    page = page_of(detail, language, templates, chosen, printed=printed, period=period, hold=hold)

    def work(report_progress: Progress) -> Outcome:
        found = validate(parse(read_file(file), file), task_name, Path(file).parent)
        report_progress = progress_on_terminal(report_progress)
        return solved(
            found,
            chosen,
            target,
            plot,
            convention,
            report_progress,
            bibliography=bibliography,
            only_some_tasks=task_name is not None,
            settings=settings,
            **page,
        )

    run_work(work, timeout, memory, place_of(file))
