"""The command `variants`: many problems of the same kind from one file, into a folder."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import click

from symobs.applications.variants import TooFew, Variants
from symobs.applications.variants.files import assignment
from symobs.applications.variants.search import PROFILES
from symobs.cli.shared.common import place_of, read_file, write_message
from symobs.cli.shared.options import quoted
from symobs.cli.shared.output import check_target, write, write_all
from symobs.ground.errors import UsageError

_REASONS_SHOWN = 12


@click.command("variants")
@click.argument("problem", required=False)
@click.option("--count", type=click.IntRange(1), default=30, metavar="N", help="How many variants (30).")
@click.option("--seed", type=int, default=0, metavar="N", help="The seed, a whole number from 0 (0).")
@click.option("-o", "target", metavar="FOLDER", help="The folder of the variants, their manifest and the report.")
@click.option("--list", "listed", is_flag=True, help="Print a line of JSON for each variant, and write nothing.")
@click.option("--report", is_flag=True, help="Write report.md: data, answers and load of each, and what was left out.")
@click.option("--profile", default="loose", metavar="NAME", help="How alike they are: loose (default) or strict.")
@click.option("--attempts", type=click.IntRange(1), metavar="N", help="Try so many candidates for each variant.")
@click.option("--partial", is_flag=True, help="Write those there are, where there are not so many.")
@click.option("--assign", metavar="CSV", help="Write assignment.csv: a variant for each student of a table.")
@click.option("--responses", metavar="SUMMARY", help="From summary.json of a class: was a variant harder than others?")
@click.option("--workers", type=click.IntRange(1, 1024), metavar="N", help="Processes of this machine; default: all.")
def command(
    problem: str | None,
    count: int,
    seed: int,
    target: str | None,
    listed: bool,  # noqa: FBT001 - click's signature
    report: bool,  # noqa: FBT001
    profile: str,
    attempts: int | None,
    partial: bool,  # noqa: FBT001
    assign: str | None,
    responses: str | None,
    workers: int | None,
) -> None:
    """Make many problems of the same kind from a PROBLEM file with a table [variants].

    Each is solved and checked, and like the first one in what it takes to work it out.  The same seed gives the same
    variants on every machine.  Exit code 4: there are not so many; nothing is written then.
    """
    if (problem is None) == (responses is None):
        raise UsageError("one thing is to be done at a time", repair="give the PROBLEM, or --responses SUMMARY")
    if responses is not None:
        _responses(responses)
        return
    assert problem is not None  # noqa: S101 - one of the two is there
    if listed == (target is not None):
        raise UsageError("a folder or a list is expected", repair="write -o FOLDER, or --list")
    if listed and (report or assign or partial):
        raise UsageError("with --list nothing is written", repair="write -o FOLDER instead")
    if profile not in PROFILES:
        raise UsageError(f"{quoted(profile)} is no profile", where="--profile", repair=f"write {' or '.join(PROFILES)}")
    students = read_file(assign, "a CSV file with a column student") if assign is not None else None
    text, folder = read_file(problem, "a problem file with [variants]"), Path(problem).parent
    options = {"profile": profile, "attempts": attempts, "workers": workers}
    try:
        found = Variants(text, count, seed, where=place_of(problem), folder=folder, **options)  # type: ignore[arg-type]
    except UsageError as error:
        error.where = f"--{error.where}"
        raise
    shares = None if students is None else assignment(students, seed, count, place_of(str(assign)))
    found.told = _told(count)
    if target is None:
        lines = [json.dumps({"number": each.number, **each.as_data()}, ensure_ascii=False) for each in found]
        write("".join(f"{line}\n" for line in lines))
        return
    code = 0
    try:
        for _ in found:
            pass
    except TooFew as error:
        write_message(str(error))
        for reason, times in list(error.facts["rejected"].items())[:_REASONS_SHOWN]:  # type: ignore[attr-defined]
            write_message(f"{times:8}  {reason}")
        if not partial or not found.found:
            sys.exit(error.exit_code)
        code = error.exit_code
        if students is not None:
            shares = assignment(students, seed, len(found.found), place_of(str(assign)))
    found.write(target, report=report)
    if shares is not None:
        place = str(Path(target) / "assignment.csv")
        check_target(place)
        write_all([(shares, place)])
    if report:
        for reason, times in list(found.rejected.items())[:_REASONS_SHOWN]:
            write_message(f"{times:8}  {reason}")
    sys.exit(code)


def _responses(summary: str) -> None:
    """Print how the variants were answered."""
    from symobs.applications.variants.search import as_text, responses_of  # noqa: PLC0415 - a question of its own

    write(as_text(responses_of(read_file(summary, "the summary.json of a class"), place_of(summary))))


def _told(count: int):  # type: ignore[no-untyped-def]  # noqa: ANN202 - a closure
    """Return what tells how far the search has come, on a terminal."""
    shown = sys.stderr is not None and sys.stderr.isatty()
    said = [-1]

    def tell(done: int, tried: int) -> None:
        if shown and (done != said[0] or tried % 1000 == 0):
            said[0] = done
            write_message(f"{done}/{count} variants, {tried} candidates …")

    return tell
