"""The command `audit`: what is wrong among the equations a source prints."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from symobs.audit import REPORTS, audit, report
from symobs.cli import EXIT_NO, _read, _say
from symobs.errors import ProblemErrors, SymobsError, UsageError
from symobs.output import write
from symobs.problem import read

if TYPE_CHECKING:
    from symobs.audit import Audited


@click.command("audit")
@click.argument("files", nargs=-1, required=True, metavar="FILE...")
@click.option("--format", "format_name", default="text", metavar="NAME", help="text (default), markdown or json.")
@click.option("-o", "target", metavar="PATH", help="Write to PATH.")
def audit_command(files: tuple[str, ...], format_name: str, target: str | None) -> None:
    """Recompute what a source prints: every FILE's [[printed]] equations.

    Lists those that are wrong, with what is right and the reason. Exit code 4 where there are some.
    """
    if format_name not in REPORTS:
        raise UsageError(f"{format_name[:40]!r} is not a format of the audit", repair=f"take {', '.join(REPORTS)}")
    found = _audited(tuple(dict.fromkeys(files)))
    write(report(found, format_name), target)
    sys.exit(EXIT_NO if any(each.findings for each in found.values()) else 0)


def _audited(files: tuple[str, ...]) -> dict[str, Audited]:
    """Return what each file's audit found; the errors of all files are raised together."""
    found: dict[str, Audited] = {}
    errors: list[SymobsError] = []
    shown = len(files) > 1 and sys.stderr.isatty()
    for number, file in enumerate(files, start=1):
        if shown:
            _say(f"{number}/{len(files)} {file} …")
        try:
            found[file] = audit(read(_read(file), file, Path(file).parent))
        except SymobsError as raised:
            several = raised.errors if isinstance(raised, ProblemErrors) else (raised,)
            errors += several
            for error in several if len(files) > 1 else ():
                error.where = error.where if error.where.startswith(file) else f"{file}, {error.where}"
    if errors:
        raise ProblemErrors(tuple(errors))
    return found
