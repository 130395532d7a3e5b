"""The command line: `symobs solve FILE`, one command a task, and the lists a user looks up.

Standard output carries the result only; messages go to standard error.
"""

from __future__ import annotations

import gc
import sys
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from symobs.cli.common import (
    EXIT_BUG,
    EXIT_INTERRUPTED,
    EXIT_UNDECIDED,
    NOT_ENOUGH_MEMORY,
    chosen_format,
    place_of,
    progress_on_terminal,
    read_file,
    run_work,
    write_message,
)
from symobs.cli.options import OF_A_PAGE, options, quoted
from symobs.cli.output import write, write_all
from symobs.errors import InputError, ProblemErrors, SymobsError, UsageError, reason_of

if TYPE_CHECKING:
    from symobs.cli.outcome import Outcome
    from symobs.cli.time_and_memory import Progress

_MOST_LINES = 100
#: Commands in modules of their own, imported when they are called, and what each does.
_LATE = {
    "audit": "Recompute what a source prints, and list what is wrong with the reason.",
    "sheet": "Put several problem files on one sheet: all questions first, then all solutions.",
}


class Tasks(click.Group):
    """The commands of this module, those in `_LATE`, and one for every registered task."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return all names."""
        return [*sorted([*super().list_commands(ctx), *_LATE]), *_summaries()]

    def format_commands(self, _: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands; tasks are listed from the sources, without importing the kernel."""
        own = {name: command.get_short_help_str(limit=200) for name, command in self.commands.items()} | _LATE
        for title, listed in (
            ("Commands", dict(sorted(own.items()))),
            ("Tasks, each a command of its own", _summaries()),
        ):
            with formatter.section(title):
                formatter.write_dl(list(listed.items()))

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command; that of a task is made from its signature."""
        own = super().get_command(ctx, cmd_name)
        if own is not None:
            return own
        if cmd_name == "audit":
            from symobs.cli.audit_command import audit_command  # noqa: PLC0415 - only audits pay for it

            return audit_command
        if cmd_name == "sheet":
            from symobs.cli.sheet_command import sheet  # noqa: PLC0415 - only sheets pay for it

            return sheet
        from symobs.result import task_named  # noqa: PLC0415

        task = task_named(cmd_name.replace("-", "_"))
        if task is None:
            return None
        from symobs.cli.task_command import task_command  # noqa: PLC0415 - it reads the task's signature

        return task_command(task)

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; an interruption is reported without click's empty line."""
        try:
            return super().invoke(ctx)
        except KeyboardInterrupt:
            sys.exit(_interrupted())

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        """Return the command, or raise an error that names the most similar one."""
        name = args[0]
        if not name.startswith("-") and self.get_command(ctx, name) is None:
            nearest = get_close_matches(name, self.list_commands(ctx), 1)
            meant = f'; did you mean "{nearest[0]}"?' if nearest else ""
            if Path(name).suffix in {".toml", ".json"}:
                meant = f"; write symobs solve {name[:40]}"
            ctx.fail(f"there is no command {name[:40]!r}{meant}")
        return super().resolve_command(ctx, args)


def _summaries() -> dict[str, str]:
    """Return the tasks with their summaries."""
    import symobs  # noqa: PLC0415 - the package itself stands above all floors
    from symobs.cli.task_index import task_summaries  # noqa: PLC0415

    return task_summaries(symobs.TASK_PACKAGES)


def _version(ctx: click.Context, _: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's signature
    if value and not ctx.resilient_parsing:
        from importlib.metadata import PackageNotFoundError, version  # noqa: PLC0415

        try:
            number = version("symobs")
        except PackageNotFoundError:
            number = "from a checkout that is not installed"
        click.echo(f"symobs {number}")
        ctx.exit()


@click.group(cls=Tasks, context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--version", is_flag=True, is_eager=True, expose_value=False, callback=_version, help="Show the version.")
def cli() -> None:
    """Design observers and observer-based compensators exactly, with the derivation."""


@cli.command()
@click.argument("file")
@click.option("--task", "task_name", metavar="NAME", help="Run this task only.")
@options(*OF_A_PAGE)
def solve(
    file: str,
    task_name: str | None,
    format_name: str | None,
    target: str | None,
    plot: str | None,
    convention_name: str | None,
    detail: str,
    templates: str | None,
    timeout: float | None,
    memory: float | None,
) -> None:
    """Solve a problem FILE (TOML or JSON; - is standard input) and print its derivation."""
    from symobs.cli.outcome import check_targets, convention_of, page_of, solved  # noqa: PLC0415
    from symobs.problem import parse, validate  # noqa: PLC0415
    from symobs.result import tasks  # noqa: PLC0415

    chosen = chosen_format(format_name, target)
    if task_name is not None and task_name not in tasks():
        raise UsageError(f"{quoted(task_name)} is not a task", repair=f"known tasks are {', '.join(sorted(tasks()))}")
    check_targets(target, plot)
    convention = convention_of(convention_name)
    page = page_of(detail, templates, chosen)

    def work(report_progress: Progress) -> Outcome:
        found = validate(parse(read_file(file), file), task_name, Path(file).parent)
        report_progress = progress_on_terminal(found, report_progress)
        return solved(
            found, chosen, target, plot, convention, report_progress, only_some_tasks=task_name is not None, **page
        )

    run_work(work, timeout, memory, place_of(file))


# -- lists ----------------------------------------------------------------------------------------------------------


@cli.command()
def methods() -> None:
    """List every task and its methods."""
    from symobs.result import methods as known  # noqa: PLC0415
    from symobs.result import tasks  # noqa: PLC0415

    lines: list[str] = []
    for name, task in sorted(tasks().items()):
        lines.append(f"{name}: {task.summary}")
        for found in known(name).values():
            lines += [f"    {found.name}: {found.summary}", f"        {found.source}"]
    write("\n".join(lines) + "\n")


@cli.command()
def schema() -> None:
    """Print the JSON schema of problem files."""
    import json  # noqa: PLC0415

    from symobs.problem import schema as whole  # noqa: PLC0415

    write(json.dumps(whole(), indent=2, ensure_ascii=False) + "\n")


@cli.command()
@click.argument("name", required=False)
def conventions(name: str | None) -> None:
    """List the conventions a page can be written in, or print the file of the one called NAME."""
    from symobs.convention.listing import file_of, listed  # noqa: PLC0415

    write(listed() if name is None else file_of(name))


@cli.group(invoke_without_command=True)
@click.pass_context
def templates(ctx: click.Context) -> None:
    """List the built-in LaTeX templates, or copy them."""
    if ctx.invoked_subcommand is None:
        write("".join(f"{path.name}\n" for path in _templates()))


@templates.command()
@click.argument("folder")
def copy(folder: str) -> None:
    """Copy the built-in LaTeX templates into FOLDER; no file there is overwritten."""
    target = Path(folder)
    taken = [path.name for path in _templates() if (target / path.name).exists()]
    if taken:
        message = f"{taken[0]} is already there"
        raise InputError(message, where=folder[:200], repair="name another folder, or move the file away")
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(reason_of(error), where=place_of(folder), repair="name a folder that can be written") from None
    write_all([(path.read_bytes(), str(target / path.name)) for path in _templates()])


def _templates() -> list[Path]:
    from symobs.render.formats.templates import template_folder  # noqa: PLC0415

    return sorted(template_folder().glob("*.tex"))


#: Imports make many objects that stay: collecting among them as often as usual takes a tenth of a short run.
_COLLECTED_AFTER = 50_000


def _interrupted() -> int:
    """Report the interruption in one line, safe from a second Ctrl-C, and return its exit code."""
    import signal  # noqa: PLC0415 - not for runs that nobody interrupts

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    shown = sys.stderr is not None and sys.stderr.isatty()
    write_message("\ninterrupted" if shown else "interrupted")  # a terminal has written ^C at the place where we write
    return EXIT_INTERRUPTED


def main() -> NoReturn:
    """Run the command line; every error becomes a message and an exit code, never a traceback."""
    gc.set_threshold(_COLLECTED_AFTER)
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="backslashreplace")
    try:
        cli.main(standalone_mode=False, prog_name="symobs")
        code = 0
    except SymobsError as error:
        lines = str(error).split("\n")
        more = [f"… and {len(lines) - _MOST_LINES} more"] if len(lines) > _MOST_LINES else []
        write_message("\n".join(lines[:_MOST_LINES] + more))
        several = error.errors if isinstance(error, ProblemErrors) else (error,)
        code = max(found.exit_code for found in several)
    except click.exceptions.Exit as leaving:
        code = leaving.exit_code
    except click.ClickException as error:
        from symobs.cli.hints import hint  # noqa: PLC0415 - only where the command line is not understood

        error.show()
        if found := hint(error):
            write_message(found)
        code = UsageError.exit_code
    except MemoryError:
        write_message(NOT_ENOUGH_MEMORY)
        code = EXIT_UNDECIDED
    except (KeyboardInterrupt, click.exceptions.Abort):
        code = _interrupted()
    except Exception as error:  # noqa: BLE001 - the last line of defence: a bug of ours, said as such
        write_message(f"internal error: {type(error).__name__}: {str(error)[:200]}; please report this")
        code = EXIT_BUG
    sys.exit(code)
