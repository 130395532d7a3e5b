"""The command line: `symobs solve FILE`, one command a task, and the lists a user looks up.

Standard output carries the result only; messages go to standard error.
"""

from __future__ import annotations

import os
import sys
import tempfile
from pathlib import Path
from typing import Any, NoReturn

import click

from symobs.errors import InputError, ProblemErrors, SymobsError, UsageError

EXIT_BUG, EXIT_NO, EXIT_UNDECIDED, EXIT_INTERRUPTED = 1, 4, 5, 130
PLANT_OPTIONS = ("A", "B", "C", "D", "transfer_function", "dt")


class Tasks(click.Group):
    """The commands that stand in this file, and one for every registered task."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Return all names; tasks come from the registry."""
        from symobs.method import tasks  # noqa: PLC0415 - --help pays for it, --version does not

        return [*super().list_commands(ctx), *sorted(tasks())]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Return a command, made from the task's signature where it is a task."""
        own = super().get_command(ctx, cmd_name)
        if own is not None:
            return own
        from symobs.method import tasks  # noqa: PLC0415

        task = tasks().get(cmd_name.replace("-", "_"))
        return None if task is None else _task_command(task)


def _version(ctx: click.Context, _: click.Parameter, value: bool) -> None:  # noqa: FBT001 - click's signature
    if value and not ctx.resilient_parsing:
        from importlib.metadata import version  # noqa: PLC0415

        click.echo(f"symobs {version('symobs')}")
        ctx.exit()


@click.group(cls=Tasks, context_settings={"help_option_names": ["-h", "--help"]})
@click.option("--version", is_flag=True, is_eager=True, expose_value=False, callback=_version, help="Show the version.")
def cli() -> None:
    """Design observers and observer-based compensators exactly, with the derivation."""


FORMAT = click.option("--format", "format_name", default=None, help="latex (default), text, json, pdf, …")
OUTPUT = click.option("-o", "--output", "output", default=None, help="Write to this file instead of standard output.")


@cli.command()
@click.argument("file")
@click.option("--task", "task_name", default=None, help="Run this task only.")
@FORMAT
@OUTPUT
def solve(file: str, task_name: str | None, format_name: str | None, output: str | None) -> None:
    """Solve a problem FILE (TOML or JSON; - is standard input) and print its derivation."""
    from symobs import problem  # noqa: PLC0415

    data = problem.parse(_read(file), file)
    if task_name is not None:
        data.pop("tasks", None)
        data["task"] = task_name
    _run(data, _format_of(format_name, output), output)


def _run(data: dict[str, Any], format_name: str, output: str | None) -> None:
    """Solve a problem's tables, write the document, and leave with the contract's exit code."""
    from symobs import problem  # noqa: PLC0415
    from symobs.expect import mismatches  # noqa: PLC0415
    from symobs.method import formats, render  # noqa: PLC0415

    if format_name not in formats():
        message = f"{format_name[:40]!r} is not an output format"
        raise UsageError(message, repair=f"use one of {', '.join(sorted(formats()))}")
    found = problem.validate(data)
    results = found.solve(_progress(found))
    unmet = mismatches(results, found.expect)
    _write(render(found.document(results), format_name), output)
    for line in unmet:
        click.echo(line, err=True)
    if found.expect:
        sys.exit(EXIT_NO if unmet else 0)
    verdicts = {result.verdict for result in results}
    for result in results:
        if result.verdict in {"no", "undecided"}:
            click.echo(f"{result.task}: {result.verdict}", err=True)
    sys.exit(EXIT_NO if "no" in verdicts else EXIT_UNDECIDED if "undecided" in verdicts else 0)


def _progress(found: Any) -> Any:
    """Return a reporter of the task being run, on a terminal with several tasks only."""
    if not sys.stderr.isatty() or len(found.tasks) < 2:
        return None
    return lambda name: click.echo(f"{name} …", err=True)


def _format_of(format_name: str | None, output: str | None) -> str:
    """Return the format asked for, or the one the output's suffix names, or LaTeX."""
    if format_name is not None:
        return format_name
    if output is not None and Path(output).suffix:
        from symobs.method import formats  # noqa: PLC0415

        for name, found in formats().items():
            if found.suffix == Path(output).suffix and name != "fragment":
                return name
    return "latex"


def _read(file: str) -> str:
    """Return the text of a file or of standard input, bounded in size."""
    from symobs.problem import MAX_BYTES  # noqa: PLC0415

    try:
        if file == "-":
            raw = sys.stdin.buffer.read(MAX_BYTES + 1)
        else:
            with Path(file).open("rb") as stream:
                raw = stream.read(MAX_BYTES + 1)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(
            reason, where=file[:200], repair="give the path of a problem file, or - for standard input"
        ) from None
    if len(raw) > MAX_BYTES:
        message = f"the file is larger than {MAX_BYTES // 1024} kB"
        raise InputError(message, where=file[:200], repair="keep one problem to a file")
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        message = f"byte {error.start} is not UTF-8"
        raise InputError(message, where=file[:200], repair="save the file as UTF-8 text") from None


def _write(content: str | bytes, output: str | None) -> None:
    """Write the whole result or nothing."""
    data = content.encode() if isinstance(content, str) else content
    if output is None or output == "-":
        if isinstance(content, bytes) and sys.stdout.isatty():
            message = "this format is not text"
            raise UsageError(message, repair="name a file with -o")
        try:
            sys.stdout.buffer.write(data)
            sys.stdout.buffer.flush()
        except BrokenPipeError:
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return
    target = Path(output)
    try:
        with tempfile.NamedTemporaryFile(dir=target.parent, prefix=".symobs-", delete=False) as stream:
            temporary = Path(stream.name)
            stream.write(data)
        temporary.chmod(0o666 & ~_umask())
        temporary.replace(target)
    except OSError as error:
        if "temporary" in locals():
            temporary.unlink(missing_ok=True)
        reason = error.strerror or str(error)
        raise InputError(reason, where=output[:200], repair="name a file in a folder that can be written") from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def _task_command(task: Any) -> click.Command:
    """Return the command of a task: the plant's options, then the task's keywords."""
    parameters: list[click.Parameter] = [
        click.Option(
            [f"--{name}", f"--{name.replace('_', '-')}"] if "_" in name else [f"--{name}"], help=f"plant: {name}"
        )
        for name in PLANT_OPTIONS
    ]
    parameters.append(
        click.Option(["--symbol", "symbols"], multiple=True, help="NAME=SIGN, for example omega=positive; repeat it.")
    )
    for name, kind in task.keywords.items():
        from symobs.specification import KINDS  # noqa: PLC0415

        flags = [f"--{name}"] + ([f"--{name.replace('_', '-')}"] if "_" in name else [])
        parameters.append(click.Option([*flags, name], help=KINDS[kind]["description"]))
    parameters.append(
        click.Option(["--format", "format_name"], default=None, help="latex (default), text, json, pdf, …")
    )
    parameters.append(click.Option(["-o", "--output", "output"], default=None, help="Write to this file."))

    def run(**options: Any) -> None:
        _run_task(task, options)

    return click.Command(
        task.name, params=parameters, callback=run, help=task.function.__doc__, short_help=task.summary
    )


def _run_task(task: Any, options: dict[str, Any]) -> None:
    """Put the options into a problem's tables and run it; undeclared names are real symbols."""
    from symobs.problem import OPEN  # noqa: PLC0415

    output, format_name = options.pop("output"), options.pop("format_name")
    declared = options.pop("symbols")
    plant = {name: options.pop(name) for name in PLANT_OPTIONS}
    plant = {name: value for name, value in plant.items() if value is not None}
    if "dt" in plant and plant["dt"] in {"true", "True"}:
        plant["dt"] = True
    data: dict[str, Any] = {
        "title": "",
        "task": task.name,
        "plant": plant,
        "specification": {name: value for name, value in options.items() if value is not None},
    }
    data["symbols"] = dict(_declaration(entry) for entry in declared) if declared else OPEN
    _run(data, _format_of(format_name, output), output)


def _declaration(entry: str) -> tuple[str, str]:
    name, separator, sign = entry.partition("=")
    return name.strip(), sign.strip() if separator else "real"


@cli.command()
def methods() -> None:
    """List every task and its methods."""
    from symobs.method import methods as known  # noqa: PLC0415
    from symobs.method import tasks  # noqa: PLC0415

    for name, task in sorted(tasks().items()):
        click.echo(f"{name}: {task.summary}")
        for found in known(name).values():
            click.echo(f"    {found.name}: {found.summary}")
            click.echo(f"        {found.source}")


@cli.command()
def schema() -> None:
    """Print the JSON schema of problem files."""
    import json  # noqa: PLC0415

    from symobs.problem import schema as whole  # noqa: PLC0415

    click.echo(json.dumps(whole(), indent=2))


@cli.command()
def conventions() -> None:
    """List the conventions a page can be written in."""
    click.echo(
        "standard: u = -K x_hat, observer matrix A - L C, error e = x - x_hat, compensator F in negative feedback"
    )


def main() -> NoReturn:
    """Run the command line; every error becomes a message and an exit code, never a traceback."""
    try:
        cli.main(standalone_mode=False)
        code = 0
    except ProblemErrors as errors:
        click.echo(str(errors), err=True)
        code = max((error.exit_code for error in errors.errors), default=errors.exit_code)
    except SymobsError as error:
        click.echo(str(error), err=True)
        code = error.exit_code
    except click.exceptions.Exit as leaving:
        code = leaving.exit_code
    except click.ClickException as error:
        error.show()
        code = 2
    except (KeyboardInterrupt, click.exceptions.Abort):
        click.echo("interrupted", err=True)
        code = EXIT_INTERRUPTED
    except Exception as error:  # noqa: BLE001 - the last line of defence: a bug of ours, said as such
        click.echo(f"internal error: {type(error).__name__}: {str(error)[:200]}; please report this", err=True)
        code = EXIT_BUG
    sys.exit(code)
