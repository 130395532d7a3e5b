"""The command `check`: one answer, or those of a class, against a problem."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

import click

from symobs.applications.checking import SHOW, Checked
from symobs.applications.checking.checker import answer_file
from symobs.applications.checking.folders import MOST_BYTES
from symobs.cli.shared.common import place_of, read_bytes, read_file, run_work, write_message
from symobs.cli.shared.options import LIMITS, WORKERS, options, quoted
from symobs.cli.shared.outcome import Outcome, convention_of
from symobs.cli.shared.output import check_target, make_folder, write_all
from symobs.ground.errors import UsageError
from symobs.problem import read

if TYPE_CHECKING:
    from symobs.applications.checking import CheckReport
    from symobs.cli.shared.time_and_memory import Progress

#: The formats of a report, with the suffixes of their files.
FORMATS = {"text": ".txt", "markdown": ".md", "html": ".html", "json": ".json"}


@click.command("check")
@click.argument("problem")
@click.argument("answer", required=False)
@click.option("--format", "format_name", metavar="NAME", help="text (default), markdown, html or json.")
@click.option(
    "--show",
    default="reason",
    metavar="LEVEL",
    help="What is given away: verdict, place, reason (default) or solution.",
)
@click.option(
    "-o",
    "target",
    metavar="PATH",
    help="Write to PATH, whose suffix names the format; for a class the folder of the results.",
)
@click.option("--asked", is_flag=True, help="Print an empty answer file: what an answer may hold.")
@click.option("--echo", is_flag=True, help="Print how the ANSWER is read, and no word on whether it is right.")
@click.option("--submissions", metavar="PATH", help="Check a class: a CSV or JSON Lines file, or a folder of answers.")
@click.option("--map", "mapped", multiple=True, metavar="COLUMN=FIELD", help="Read a column of the CSV as a field.")
@click.option("--variants", metavar="MANIFEST", help="The class has variants of PROBLEM: those of this manifest.")
@click.option("--feedback", is_flag=True, help="Write a page of feedback for each student of a class.")
@options("convention", *LIMITS)
@WORKERS
def command(
    problem: str,
    answer: str | None,
    format_name: str | None,
    show: str,
    target: str | None,
    asked: bool,  # noqa: FBT001 - click's signature
    echo: bool,  # noqa: FBT001 - click's signature
    submissions: str | None,
    mapped: tuple[str, ...],
    variants: str | None,
    feedback: bool,  # noqa: FBT001 - click's signature
    convention_name: str | None,
    timeout: float | None,
    memory: float | None,
    workers: int | None,
) -> None:
    """Check an ANSWER, or those of a class, against a PROBLEM file: any valid answer is right.

    A class is checked on all processors, --timeout and --memory are for each answer, and the same command after a run
    that was ended goes on.
    Exit code 0: right; 4: wrong or incomplete; 3: unreadable; 5: undecided. For a class 0 where all have a verdict, 3
    where a file could not be read.
    """
    if format_name is not None and format_name not in FORMATS:
        raise UsageError(f"{quoted(format_name)} is not a format of this command", repair=f"take {', '.join(FORMATS)}")
    if show not in SHOW:
        raise UsageError(f"{quoted(show)} is nothing to show", where="--show", repair=f"take {', '.join(SHOW)}")
    if sum((asked, submissions is not None, answer is not None)) != 1:
        repair = "give the ANSWER, or --submissions PATH, or --asked"
        raise UsageError("one thing is to be done at a time", repair=repair)
    if problem == answer == "-":
        raise UsageError("standard input holds one file", repair="give one of the two as a path")
    convention = convention_of(convention_name)
    if submissions is not None:
        limits = (timeout, memory)
        _class(problem, submissions, variants, target, mapped, show, feedback=feedback, workers=workers, limits=limits)
        return
    if variants is not None:
        raise UsageError("one answer is to one problem", where="--variants", repair="name the file of the variant")
    check_target(target)
    chosen = _format(format_name, None if asked else target)

    def work(report_progress: Progress) -> Outcome:
        report_progress("the problem")
        checked = Checked.of(read(read_file(problem), problem, Path(problem).parent))
        if asked:
            return Outcome(((answer_file(checked, convention), target),))
        assert answer is not None  # noqa: S101 - one of the three is there
        name = None if convention is None else convention_name
        raw = read_bytes(answer, "an answer file", MOST_BYTES)
        report = checked.report_of_file(raw, place_of(answer), "place" if echo else show, name)
        if echo:
            return Outcome(((report.echo(), target),), (), 3 if report.verdict == "unreadable" else 0)
        return _outcome(report, chosen, target)

    run_work(work, timeout, memory, place_of(problem))


def _format(format_name: str | None, target: str | None) -> str:
    """Return the format: that of --format, else that of the suffix, which is not to contradict it."""
    suffix = Path(target).suffix if target is not None else ""
    named = next((name for name, each in FORMATS.items() if each == suffix), None)
    if suffix and format_name is None and named is None:
        repair = f"end it in {', '.join(FORMATS.values())}, or give --format"
        raise UsageError(f"the suffix {quoted(suffix)} names no format of this command", where="-o", repair=repair)
    if None not in {format_name, named} and format_name != named:
        repair = f"end it in {FORMATS[str(format_name)]}, or leave --format out"
        raise UsageError(
            f"the suffix {quoted(suffix)} is that of {named}, not of {format_name}", where="-o", repair=repair
        )
    return format_name or named or "text"


def _outcome(report: CheckReport, format_name: str, target: str | None) -> Outcome:
    writers = {
        "text": report.to_text,
        "markdown": report.to_markdown,
        "html": report.to_html,
        "json": report.to_json,
    }
    return Outcome(((writers[format_name](), target),), (), report.exit_code)


def _class(
    problem: str,
    submissions: str,
    variants: str | None,
    target: str | None,
    mapped: tuple[str, ...],
    show: str,
    *,
    feedback: bool,
    workers: int | None,
    limits: tuple[float | None, float | None],
) -> None:
    """Check a class and write its results into a folder."""
    from symobs.applications.batch.store import discard_work, work_folder  # noqa: PLC0415
    from symobs.applications.checking.classroom import check_class  # noqa: PLC0415
    from symobs.applications.checking.submissions import class_variants, one_problem  # noqa: PLC0415
    from symobs.ground.child_processes.budget import Budget  # noqa: PLC0415 - a single answer does not pay for it

    if target is None:
        raise UsageError("the results of a class need a folder", where="-o", repair="write -o RESULTS/")
    columns: dict[str, str] = {}
    for entry in mapped:
        column, found, name = entry.rpartition("=")
        if not found or not column or not name:
            raise UsageError(
                f"{quoted(entry)} maps nothing", where="--map", repair='write --map "Email address=student"'
            )
        columns[column] = name
    folder = Path(target)
    shown = sys.stderr is not None and sys.stderr.isatty()

    def progress(done: int, total: int) -> None:
        if shown and (done == total or done % 25 == 0):
            write_message(f"{done}/{total} …")

    text = read_file(problem)
    problems = one_problem(text) if variants is None else class_variants(text, place_of(problem), Path(variants))
    files, said, code = check_class(
        problems,
        Path(problem).parent,
        Path(submissions),
        columns=columns,
        show=show,
        feedback=feedback,
        work=work_folder(folder),
        workers=workers,
        budget=Budget(*limits),
        progress=progress,
        tell=write_message,
    )
    for made in (folder, folder / "feedback") if feedback else (folder,):
        make_folder(made)
    write_all([(content, str(folder / name)) for name, content in files.items()])
    discard_work(folder)
    for line in (*said, f"results: {folder / 'summary.md'}, {folder / 'marks.csv'}"):
        click.echo(line)
    sys.exit(code)
