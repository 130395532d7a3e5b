"""The command `audit`: errors among the equations of a source."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from symobs.applications.audit import REPORTS, audit, report
from symobs.cli.shared.common import EXIT_NO, place_of, read_file, run_work, write_message
from symobs.cli.shared.options import LIMITS, AFile, OneOf, options
from symobs.cli.shared.outcome import Outcome
from symobs.cli.shared.output import check_target
from symobs.ground.errors import ProblemErrors, SymobsError, UsageError
from symobs.problem import read

if TYPE_CHECKING:
    from symobs.applications.audit import Audited
    from symobs.cli.shared.time_and_memory import Progress


@click.command("audit")
@click.argument("files", nargs=-1, required=True, type=AFile(), metavar="FILE...")
@click.option("--format", "format_name", default="text", type=OneOf(lambda: REPORTS), help="text if left out.")
@click.option("-o", "target", type=AFile(), metavar="PATH", help="Write to PATH.")
@options(*LIMITS)
def command(
    files: tuple[str, ...], format_name: str, target: str | None, timeout: float | None, memory: float | None
) -> None:
    """Recompute what a source prints: every FILE's [[printed]] equations.

    Lists those that are wrong, with what is right and the reason. Exit code 4 where there are some.
    """
    if format_name not in REPORTS:
        raise UsageError(f"{format_name[:40]!r} is not a format of the audit", repair=f"take {', '.join(REPORTS)}")
    check_target(target)
    chosen = tuple(dict.fromkeys(files))

    def work(report_progress: Progress) -> Outcome:
        found = _audited(chosen, report_progress)
        wrong = any(each.wrong for each in found.values())
        return Outcome(((report(found, format_name), target),), (), EXIT_NO if wrong else 0)

    run_work(work, timeout, memory, place_of(chosen[0]) if len(chosen) == 1 else "")


def _audited(files: tuple[str, ...], report_progress: Progress) -> dict[str, Audited]:
    """Return the findings of each file; the errors of all files are raised together."""
    found: dict[str, Audited] = {}
    errors: list[SymobsError] = []
    several = len(files) > 1
    shows = several and sys.stderr is not None and sys.stderr.isatty()
    for number, file in enumerate(files, start=1):
        report_progress(place_of(file) if several else None)
        if shows:
            write_message(f"{number}/{len(files)} {file} …")
        try:
            found[file] = audit(read(read_file(file), file, Path(file).parent))
        except SymobsError as raised:
            all_of_it = raised.errors if isinstance(raised, ProblemErrors) else (raised,)
            errors += all_of_it
            for error in all_of_it if several else ():
                error.where = error.where if error.where.startswith(file) else f"{file}, {error.where}"
    if errors:
        raise ProblemErrors(tuple(errors))
    return found
