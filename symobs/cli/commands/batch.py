"""The command `batch`: many problems, on the processors of this machine or on a cluster, into a folder."""

from __future__ import annotations

import signal
import sys
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from symobs.applications.batch.engine import Settings, Unfinished
from symobs.applications.batch.jobs import USUAL_BUDGET
from symobs.applications.batch.run import Batch, files_of, jobs_of, require_own_folder, require_texts, verified
from symobs.cli.shared.common import EXIT_NO, EXIT_UNDECIDED, write_message
from symobs.cli.shared.options import WORKERS, options
from symobs.ground.child_processes.budget import Budget
from symobs.ground.errors import UsageError, raise_all
from symobs.problem.file_tables import Errors
from symobs.tasks.result.output_methods import digits_asked

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

    from symobs.applications.batch.jobs import Job

_SPEAK_EVERY = 30.0


def of_a_run(command: Callable[..., Any]) -> Callable[..., Any]:
    """Give a command the options that say who does the work, and how long."""
    given = [
        WORKERS,
        click.option(
            "--scheduler", metavar="ADDRESS", help="Let the workers of a dask scheduler do the work: tcp://HOST:8786."
        ),
        click.option(
            "--worker-timeout",
            type=click.FloatRange(0.1),
            default=60.0,
            metavar="SECONDS",
            help="Wait so long for a worker to come back (60).",
        ),
        click.option(
            "--deadline",
            type=click.FloatRange(0.001),
            metavar="SECONDS",
            help="Begin nothing after so many seconds; the same command goes on later.",
        ),
        click.option(
            "--recheck",
            type=click.FloatRange(0, 1),
            default=0.01,
            metavar="SHARE",
            help="Check this share of the results again by other code (0.01; of the first 200 all).",
        ),
        click.option(
            "--chunk-seconds",
            type=click.FloatRange(0.01),
            default=2.0,
            metavar="SECONDS",
            help="Hand over work in chunks of so many seconds (2).",
        ),
        click.option("--in-process", is_flag=True, help="Work in this process, without limits: for debuggers."),
        click.option("--quiet", is_flag=True, help="Say nothing on the way."),
    ]
    for option in reversed(given):
        command = option(command)
    return command


@click.command("batch")
@click.argument("problems", nargs=-1, metavar="FOLDER|FILE...")
@click.option("--out", metavar="FOLDER", help="Keep the results here; a run that was ended goes on from them.")
@click.option(
    "--format",
    "formats",
    default="",
    metavar="NAMES",
    help="Write pages as well: latex, html, markdown, text; with commas between.",
)
@click.option(
    "--fields",
    type=click.Choice(["all", "answer"]),
    default="all",
    help="answer: only what is asked for, not what follows from it.",
)
@options("digits", "exact", "timeout", "memory")
@click.option("--retry", type=click.Choice(["failed", "undecided"]), multiple=True, help="Try these again.")
@click.option("--fail-fast", is_flag=True, help="End at the first problem that fails.")
@click.option("--dry-run", is_flag=True, help="Say what would be done, and do nothing.")
@click.option("--verify", metavar="FOLDER", help="Check the stored results of a run again, by other code.")
@of_a_run
def command(
    problems: tuple[str, ...],
    out: str | None,
    formats: str,
    fields: str,
    digits: object,
    exact: bool,  # noqa: FBT001 - click's signature
    timeout: float | None,
    memory: float | None,
    retry: tuple[str, ...],
    fail_fast: bool,  # noqa: FBT001
    dry_run: bool,  # noqa: FBT001
    verify: str | None,
    **run: Any,
) -> None:
    """Solve many problems, on all processors or on a cluster, into a folder from which a run goes on.

    Every problem has a process, 60 seconds and 2000 MB of its own unless --timeout and --memory say otherwise: one that
    takes more is undecided and loses no other.  Run the same command again after a run that was ended.
    """
    if verify is not None:
        write_message(f"{verified(Path(verify))} results hold")
        return
    if not problems:
        raise UsageError("no problem is named", repair="write for example `symobs batch problems/ --out results`")
    if not out:
        raise UsageError("no folder for the results is named", where="--out", repair="write --out results")
    files, errors = [], Errors()
    for each in map(Path, problems):
        with errors:
            files += files_of(each)
    raise_all(errors.found)
    require_own_folder(Path(out), map(Path, problems))
    pages = tuple(name for name in formats.replace(" ", "").split(",") if name)
    require_texts(pages)
    asked = digits_asked(digits, exact=exact, where="--digits")

    jobs = partial(jobs_of, files, formats=pages, fields=fields, digits=asked)
    budget = Budget(timeout or USUAL_BUDGET.seconds, memory or USUAL_BUDGET.megabytes)
    work = batch_of(jobs, Path(out), budget, run, retry=retry, fail_fast=fail_fast)
    if dry_run:
        write_message(work.told(len(files)))
        return
    finish(work, len(files), quiet=run["quiet"])


def batch_of(jobs: Callable[[], Iterator[Job]], out: Path, budget: Budget, run: dict[str, Any], **more: Any) -> Batch:
    """Return the run that the options of a command ask for."""
    settings = Settings(budget, run["chunk_seconds"], run["recheck"], run["deadline"])
    who = {name: run[name] for name in ("workers", "scheduler", "in_process", "worker_timeout")}
    return Batch(jobs, out, settings=settings, **who, **more)


def finish(
    work: Batch, total: int, *, quiet: bool, done: Callable[[], str] | None = None, unit: str = "problems"
) -> NoReturn:
    """Do the work of a run, tell how far it has come, and end with its exit code.

    `done` is called when all is done, and returns what is said of it in place of the counts.
    """
    usual = signal.signal(signal.SIGTERM, _interrupt)
    progress = _Progress(total, quiet=quiet)
    try:
        for _ in work:
            progress.show(work)
    except Unfinished as error:
        progress.clear()
        write_message(f"{error}; {min(work.stored, total)} of {total} {unit} done, run the same command again to go on")
        sys.exit(EXIT_UNDECIDED)
    finally:
        signal.signal(signal.SIGTERM, usual)
        progress.clear()
    told = done() if done is not None else _told(work.counts) + work.told_of_equals()
    if not quiet:
        write_message(told or "nothing to do")
    failed = work.counts["failed"] + work.counts["unreadable"]
    sys.exit(EXIT_NO if failed else EXIT_UNDECIDED if work.counts["undecided"] else 0)


def _told(counts: Mapping[str, int]) -> str:
    return ", ".join(f"{count} {status}" for status, count in counts.items() if count)


def _interrupt(_: int, __: object) -> NoReturn:
    raise KeyboardInterrupt


class _Progress:
    """How far a run has come: a line that is overwritten on a terminal, elsewhere one every 30 seconds."""

    def __init__(self, total: int, *, quiet: bool) -> None:
        self.total, self.quiet = total, quiet
        self.began = self.said = time.monotonic()
        self.shows = sys.stderr is not None and sys.stderr.isatty()
        self.first: int | None = None

    def show(self, work: Batch) -> None:
        """Say how many jobs are done, how fast, and how long the rest takes at that pace."""
        now, count = time.monotonic(), sum(work.counts.values())
        if self.first is None:
            self.first = count - 1
        if self.quiet or now - self.said < (0.2 if self.shows else _SPEAK_EVERY):
            return
        self.said = now
        pace = (count - self.first) / (now - self.began)
        troubles = "".join(
            f", {work.counts[name]} {name}" for name in ("undecided", "failed", "unreadable") if work.counts[name]
        )
        text = f"{count}/{self.total}, {pace:.1f} a second{troubles}, {max(0, self.total - count) / pace:.0f} s left"
        click.echo(f"\r\x1b[K{text}" if self.shows else text, nl=not self.shows, err=True)

    def clear(self) -> None:
        """Erase the line."""
        if self.shows and not self.quiet:
            click.echo("\r\x1b[K", nl=False, err=True)
