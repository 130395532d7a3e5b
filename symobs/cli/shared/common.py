"""Options, exit codes and reports shared by the commands."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import click

from symobs.cli.shared.output import binary, make_folder, write_all
from symobs.ground.errors import InputError, reason_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from symobs.cli.shared.outcome import Outcome
    from symobs.cli.shared.time_and_memory import Progress


EXIT_BUG, EXIT_NO, EXIT_UNDECIDED, EXIT_INTERRUPTED = 1, 4, 5, 130
#: Seconds of work before anything is said of it.
SILENT = 2.0
NOT_ENOUGH_MEMORY = "undecided: the memory there is was not enough; ask for less, or put numbers in place of symbols"


def run_work(work: Callable[[Progress], Outcome], timeout: float | None, memory: float | None, where: str) -> None:
    """Do the work within its time and memory, write its outputs and messages, and exit with its code."""
    if timeout is None and memory is None and not _somebody_waits():
        outcome = work(lambda _: None)
    else:
        from symobs.cli.shared.outcome import bounded  # noqa: PLC0415 - it is there already, with the work

        outcome = bounded(work, timeout, memory, where)
    for folder in outcome.folders:
        make_folder(folder)
    write_all(outcome.outputs)
    for line in outcome.messages:
        write_message(line)
    sys.exit(outcome.code)


def write_message(text: str) -> None:
    """Write a message to standard error; a closed stream is no error."""
    with suppress(OSError):
        click.echo(text, err=True)


def _somebody_waits() -> bool:
    """Return whether someone at a terminal may interrupt: work in a child ends at once, also within a call into FLINT."""
    return hasattr(os, "fork") and sys.stderr is not None and sys.stderr.isatty()


def progress_on_terminal(report_progress: Progress) -> Progress:
    """Return a progress report that writes what is at work on a terminal: after two seconds, and what begins later."""
    if sys.stderr is None or not sys.stderr.isatty():
        return report_progress
    from threading import Timer  # noqa: PLC0415 - on a terminal only

    at_work: list[str] = []

    def shown(reached: object) -> None:
        if isinstance(reached, str):
            at_work.append(reached)
            if not waiting.is_alive():
                write_message(f"{reached} …")
        report_progress(reached)

    waiting = Timer(SILENT, lambda: write_message(f"{at_work[-1]} …") if at_work else None)
    waiting.daemon = True
    waiting.start()
    return shown


def place_of(file: str) -> str:
    """Return the name of a file for messages."""
    from symobs.formula.expression.source import shown  # noqa: PLC0415 - needed for messages only

    return shown(file, 200) or "an empty name" if file != "-" else "standard input"


def read_file(file: str, kind: str = "a problem file") -> str:
    """Return the text of a file or of standard input, bounded in size; `kind` says what it is expected to be."""
    from symobs.problem import MAX_BYTES  # noqa: PLC0415

    try:
        return read_bytes(file, kind, MAX_BYTES).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise InputError(reason_of(error), where=place_of(file), repair="save the file as UTF-8 text") from None


def read_bytes(file: str, kind: str, most: int) -> bytes:
    """Return the bytes of a file or of standard input, at most so many; `kind` says what it is expected to be."""
    where = place_of(file)
    try:
        if file == "-":
            raw: bytes = binary(sys.stdin).read(most + 1)
        else:
            with Path(file).open("rb") as stream:
                raw = stream.read(most + 1)
    except (OSError, ValueError) as error:  # ValueError: a name with a null byte
        repair = f"give the path of {kind}, or - for standard input"
        raise InputError(reason_of(error), where=where, repair=repair) from None
    if len(raw) > most:
        raise InputError(f"the file is larger than {most // 1024} kB", where=where, repair=f"give {kind} alone")
    return raw
