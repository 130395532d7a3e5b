"""The command `sheet`: several problems on one sheet; a failing one does not affect the others.

The problems are files named on the command line, or the entries of one file that describes the whole sheet.
"""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from symobs.cli.shared.common import (
    EXIT_BUG,
    EXIT_NO,
    EXIT_UNDECIDED,
    place_of,
    read_file,
    write_message,
)
from symobs.cli.shared.options import LIMITS, AFile, options
from symobs.cli.shared.outcome import chosen_format, convention_of, page_of, runs_tex, typeset_slides
from symobs.cli.shared.output import check_target, write
from symobs.cli.shared.sheet_entries import Wanted, worked_out_all
from symobs.formula.expression.source import shown
from symobs.ground.errors import InputError, ProblemErrors, SymobsError, UsageError
from symobs.pages.page.sheet import Header, Sheet, SheetEntry
from symobs.problem.sheet_file import SheetFile, SheetProblem, is_sheet, read_sheet
from symobs.tasks.result import format_named, formats, tasks

if TYPE_CHECKING:
    from collections.abc import Sequence


_WORST_FIRST = (EXIT_BUG, InputError.exit_code, EXIT_NO, EXIT_UNDECIDED)


@click.command("sheet")
@click.argument("files", nargs=-1, type=AFile(), metavar="FILE...")
@options("format", "target")
@click.option("--title", default="", metavar="TEXT", help="The title of the sheet.")
@click.option("--questions", is_flag=True, help="The questions only.")
@click.option("--solutions", is_flag=True, help="The solutions only; they begin with the data.")
@click.option(
    "--versions",
    type=click.IntRange(2, 26),
    metavar="N",
    help="So many versions A, B, ... of the questions, with other variants of files with [variants] and in another order, "
    "and one key to all of them with the points of each step.",
)
@options(
    "detail", "references", "language", "digits", "exact", "details", "copy", "live", "templates", "convention", *LIMITS
)
def command(
    files: tuple[str, ...],
    target: str | None,
    format_name: str | None,
    title: str,
    questions: bool,  # noqa: FBT001 - click's signature
    solutions: bool,  # noqa: FBT001
    versions: int | None,
    convention_name: str | None,
    timeout: float | None,
    memory: float | None,
    **given: Any,
) -> None:
    """Put several problem FILEs on one sheet: all questions first, then all solutions.

    One FILE may describe the whole sheet: course, due date, logo, points, hints, room for answers, and its [[problem]]s.

    A problem that cannot be worked out keeps its place on the sheet, which says so; the reasons go to standard error.
    --timeout and --memory are for each problem: one that takes more loses no other.
    """
    if questions and solutions:
        raise UsageError("both --questions and --solutions are given", repair="leave both out for both")
    chosen = _sheet_format(format_name, target)
    page_options = page_of(chosen.name, given)
    check_target(target)
    file = _sheet_file(files)
    if given["language"] is None and file.language:
        page_options["language"] = file.language
    wanted = Wanted(
        chosen,
        not solutions,
        not questions,
        convention=convention_of(convention_name) or file.convention,
        timeout=timeout,
        memory=memory,
        final_answers=file.has_final_answers and not (questions and file.header.is_exam),
        is_exam=file.header.is_exam,
        **page_options,
    )
    header = _header(file, target, chosen, files[0])
    texts = list(zip(file.problems, file.texts, strict=True)) if versions is None else _versions(file, versions)
    if timeout is not None or memory is not None:
        tasks()  # what all problems need is imported once, not in the process of each
    entries: list[SheetEntry] = []
    codes: set[int] = set()
    progress = _Progress(len(texts))
    for number, (entry, code, messages) in enumerate(worked_out_all(texts, wanted, progress.show), 1):
        name = place_of(texts[number - 1][0].file)
        entries.append(entry)
        codes.add(code)
        progress.clear()
        for message in messages:
            write_message(message if message.startswith(f"{name}, ") else f"{name}: {message}")
    progress.say("typesetting" if runs_tex(wanted.format.name, target) else "writing")
    if versions is not None:
        entries = [replace(entry, number=place % len(file.problems) + 1) for place, entry in enumerate(entries)]
    halves = (wanted.questions, wanted.solutions)
    offered: dict[str, Any] = {"web": wanted.web, "detail": wanted.detail}
    sheet = Sheet(title or file.title, tuple(entries), *halves, wanted.templates, header, **offered)
    whole = typeset_slides(wanted.format.sheet(sheet), wanted.format.name, target)
    progress.clear()
    write(whole, target)
    sys.exit(next((code for code in _WORST_FIRST if code in codes), 0))


def _versions(file: SheetFile, count: int) -> list[tuple[SheetProblem, str]]:
    """Return the problems of all versions, with their texts."""
    from symobs.cli.shared.sheet_versions import versions_of  # noqa: PLC0415 - for sheets with versions only

    return versions_of(file, count)


# -- before work starts -----------------------------------------------------------------------------------------------


def _sheet_format(name: str | None, target: str | None) -> Any:
    """Return the format; raises `UsageError` for one that has no sheets."""
    found = format_named(chosen_format(name, target))
    if not hasattr(found, "sheet"):
        having = ", ".join(sorted(each.name for each in formats().values() if hasattr(each, "sheet")))
        raise UsageError(f"the format {found.name} is for one problem", where="--format", repair=f"use one of {having}")
    return found


def _sheet_file(files: Sequence[str]) -> SheetFile:
    """Return the sheet that the only file describes, or that of the problems in all files."""
    texts = _texts(files)
    described = [file for file, text in texts if is_sheet(text)]
    if described and len(files) > 1:
        repair = "name it alone; its problems stand in it as [[problem]]"
        raise UsageError(f"{place_of(described[0])} describes a whole sheet", repair=repair)
    if described:
        file, text = texts[0]
        return read_sheet(text, place_of(file), Path(file).parent, read_file)
    problems, contents = zip(*((SheetProblem(file), text) for file, text in texts), strict=True)
    return SheetFile("", Header(), problems, contents)


def _header(file: SheetFile, target: str | None, chosen: Any, name: str) -> Header:
    """Return the head of a sheet, its picture where LaTeX finds it from the folder of the target."""
    header = file.header
    if header.logo is None:
        return header
    if header.logo.kind not in getattr(chosen, "pictures", (header.logo.kind,)):
        message = f"the format {chosen.name} shows no picture of the kind {header.logo.kind}"
        repair = f"give it as {' or '.join(chosen.pictures)}, or write another format"
        raise InputError(message, where=f"{place_of(name)}, logo", repair=repair)
    path = os.path.relpath(header.logo.path, Path(target).parent if target else None)
    return replace(header, logo=replace(header.logo, path=Path(path).as_posix()))


def _texts(files: Sequence[str]) -> list[tuple[str, str]]:
    """Return the text of every file; raises all errors together, before work starts."""
    if not files:
        raise UsageError("no problem file is named", repair="write for example `symobs sheet *.toml -o sheet.pdf`")
    if list(files).count("-") > 1:
        raise UsageError("standard input stands twice", repair="name - once")
    texts: list[tuple[str, str]] = []
    errors: list[SymobsError] = []
    for file in files:
        try:
            texts.append((file, read_file(file)))
        except InputError as error:
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    return texts


# -- what a terminal shows --------------------------------------------------------------------------------------------


class _Progress:
    """A progress line on a terminal, overwritten each time; nothing unless standard error is a terminal."""

    def __init__(self, total: int) -> None:
        self.total = total
        self.shows = sys.stderr.isatty()

    def show(self, number: int, name: str) -> None:
        """Show the problem in progress."""
        self.say(f"{number}/{self.total} {name}")

    def say(self, text: str) -> None:
        """Write the line, no longer than any terminal is wide."""
        if self.shows:
            with suppress(OSError):
                click.echo(f"\r\x1b[K{shown(text, 70)}", nl=False, err=True)

    def clear(self) -> None:
        """Erase the line."""
        if self.shows:
            with suppress(OSError):
                click.echo("\r\x1b[K", nl=False, err=True)
