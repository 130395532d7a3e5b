"""`symobs audit FILE...`: what is wrong among the equations a source prints."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from symobs.errors import ProblemErrors, SymobsError, UsageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.audit import Audited

_EXIT_FINDINGS = 4


def command(read: Callable[[str], str], say: Callable[[str], None]) -> click.Command:
    """Return the command; `read` returns the text of a file, `say` writes to standard error."""

    @click.command()
    @click.argument("files", nargs=-1, required=True, metavar="FILE...")
    @click.option("--format", "format_name", default="text", metavar="NAME", help="text (default), markdown or json.")
    @click.option("-o", "target", metavar="PATH", help="Write to PATH.")
    def audit(files: tuple[str, ...], format_name: str, target: str | None) -> None:
        """Recompute what a source prints: every FILE's [[printed]] equations.

        Lists those that are wrong, with the right value and the reason. Exit code 4 where there are some.
        """
        from symobs.audit import REPORTS, report  # noqa: PLC0415 - no other command needs it
        from symobs.output import write  # noqa: PLC0415

        if format_name not in REPORTS:
            raise UsageError(f"{format_name[:40]!r} is not a format of the audit", repair=f"take {', '.join(REPORTS)}")
        found = _audited(files, read, say)
        write(report(found, format_name), target)
        sys.exit(_EXIT_FINDINGS if any(each.findings for each in found.values()) else 0)

    return audit


def _audited(files: tuple[str, ...], read: Callable[[str], str], say: Callable[[str], None]) -> dict[str, Audited]:
    """Return what each file's audit found; the errors of all files are raised together."""
    from symobs.audit import audit  # noqa: PLC0415
    from symobs.problem import read as problem  # noqa: PLC0415

    found: dict[str, Audited] = {}
    errors: list[SymobsError] = []
    shown = len(files) > 1 and sys.stderr.isatty()
    for number, file in enumerate(dict.fromkeys(files), start=1):
        if shown:
            say(f"{number}/{len(files)} {file} …")
        try:
            found[file] = audit(problem(read(file), file))
        except SymobsError as raised:
            several = raised.errors if isinstance(raised, ProblemErrors) else (raised,)
            for error in several:
                inside = error.where and not error.where.startswith(file)
                error.where = f"{file}, {error.where}" if inside and len(files) > 1 else error.where or file
            errors += several
    if errors:
        raise ProblemErrors(tuple(errors))
    return found
