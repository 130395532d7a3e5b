"""The group of all commands, and the last line of defence: every error becomes a message and an exit code.

Standard output carries the result only; messages go to standard error.
"""

from __future__ import annotations

import gc
import sys
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import click

from symobs.cli.shared.common import EXIT_BUG, EXIT_INTERRUPTED, EXIT_UNDECIDED, NOT_ENOUGH_MEMORY, write_message
from symobs.ground.child_processes import COLLECTED_AFTER
from symobs.ground.errors import ProblemErrors, SymobsError, UsageError

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

_MOST_LINES = 100
#: What each command does; `command` in the module of its name in `symobs.cli.commands` is imported when it is called,
#: or in `symobs.cli.listings` where it is one of these.
LISTINGS = ("conventions", "methods")
COMMANDS = {
    "audit": "Recompute what a source prints: every FILE's [[printed]] equations.",
    "batch": "Solve many problems, on all processors or on a cluster, into a folder from which a run goes on.",
    "check": "Check an ANSWER, or those of a class, against a PROBLEM file: any valid answer is right.",
    "conventions": "List the conventions a page can be written in, or print the file of the one called NAME.",
    "examples": "List the worked examples, or print the one called NAME.",
    "export": "Export problems as questions of a learning platform, which accept what `symobs check` accepts.",
    "mcp": "Serve the tasks, `check` and `audit` to an assistant over standard input (Model Context Protocol).",
    "methods": "List every task and its methods.",
    "schema": "Print the JSON schema of problem files, of the file of a sheet, or of the results of the command NAME.",
    "serve": "Move poles, parameters and entries in a browser, every answer checked; FILE is the problem to begin with.",
    "sheet": "Put several problem FILEs on one sheet: all questions first, then all solutions.",
    "solve": "Solve a problem FILE (TOML or JSON; - is standard input) and print its derivation.",
    "sweep": "Design at every point of a grid, each exact and checked, into a table or a picture.",
    "templates": "List the built-in LaTeX templates, or copy them.",
    "variants": "Make many problems of the same kind from a PROBLEM file with a table [variants].",
}


def place_of(name: str) -> str:
    """Return the module of a command of the table."""
    return f"symobs.cli.{'listings' if name in LISTINGS else 'commands'}.{name}"


class Tasks(click.Group):
    """The commands of the table, and one for every registered task."""

    def list_commands(self, _: click.Context) -> list[str]:
        """Return all names."""
        return [*COMMANDS, *_summaries()]

    def format_commands(self, _: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the list of commands; tasks are listed from the sources, without importing the kernel."""
        for title, listed in (("Commands", COMMANDS), ("Tasks, each a command of its own", _summaries())):
            with formatter.section(title):
                formatter.write_dl(list(listed.items()))

    def get_command(self, _: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command; that of a task is made from its signature."""
        if cmd_name in COMMANDS:
            found: click.Command = import_module(place_of(cmd_name)).command
            return found
        from symobs.tasks.result import task_named  # noqa: PLC0415

        task = task_named(cmd_name.replace("-", "_"))
        if task is None:
            return None
        from symobs.cli.task_command import task_command  # noqa: PLC0415 - it reads the task's signature

        return task_command(task)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem]:
        """Complete commands and tasks from the tables, without importing what they run."""
        from click.shell_completion import CompletionItem  # noqa: PLC0415 - for completion only

        found = {**COMMANDS, **_summaries()}
        named = [CompletionItem(name, help=text) for name, text in found.items() if name.startswith(incomplete)]
        return [*named, *click.Command.shell_complete(self, ctx, incomplete)]

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
            from difflib import get_close_matches  # noqa: PLC0415 - needed for messages only

            import symobs  # noqa: PLC0415 - the package itself stands above all floors

            nearest = get_close_matches(name, self.list_commands(ctx), 1)
            meant = f'; did you mean "{nearest[0]}"?' if nearest else ""
            if name in symobs.SYNONYMS:
                meant = f"; it is called {symobs.SYNONYMS[name]} here"
            if Path(name).suffix in {".toml", ".json"}:
                meant = f"; write symobs solve {name[:40]}"
            ctx.fail(f"there is no command {name[:40]!r}{meant}")
        return super().resolve_command(ctx, args)


def _summaries() -> dict[str, str]:
    """Return the tasks with their summaries."""
    import symobs  # noqa: PLC0415 - the package itself stands above all floors
    from symobs.cli.shared.task_index import task_summaries  # noqa: PLC0415

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


def _interrupted() -> int:
    """Report the interruption in one line, safe from a second Ctrl-C, and return its exit code."""
    import signal  # noqa: PLC0415 - not for runs that nobody interrupts

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    shown = sys.stderr is not None and sys.stderr.isatty()
    write_message("\ninterrupted" if shown else "interrupted")  # a terminal has written ^C at the place where we write
    return EXIT_INTERRUPTED


def main() -> NoReturn:
    """Run the command line; every error becomes a message and an exit code, never a traceback."""
    gc.set_threshold(COLLECTED_AFTER)
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
