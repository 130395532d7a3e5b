"""The command `sheet`: several problems on one sheet, of which one that fails loses no other."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from symobs.cli import (
    CONVENTION_HELP,
    DETAIL_HELP,
    EXIT_BUG,
    EXIT_NO,
    EXIT_UNDECIDED,
    TARGET_HELP,
    TEMPLATES_HELP,
    _convention,
    _format_of,
    _page,
    _read,
    _say,
)
from symobs.errors import InputError, ProblemErrors, SymobsError, TypesettingError, UsageError
from symobs.expect import mismatches
from symobs.expression.source import shown
from symobs.method import format_named, formats
from symobs.output import write
from symobs.phrases import PHRASES
from symobs.problem import parse, validate
from symobs.problem.question import question_of
from symobs.record import dataclass
from symobs.sheet import Entry, Sheet

if TYPE_CHECKING:
    from collections.abc import Sequence

    from symobs.method import Document

_LONGEST_TITLE = 300
_WORST_FIRST = (EXIT_BUG, InputError.exit_code, EXIT_NO, EXIT_UNDECIDED)


@dataclass(frozen=True)
class _Wanted:
    """What was asked for on the command line."""

    format: Any
    questions: bool
    solutions: bool
    detail: str
    templates: Path | None = None
    convention: Any = None


@click.command()
@click.argument("files", nargs=-1, metavar="FILE...")
@click.option("-o", "target", metavar="PATH", help=TARGET_HELP)
@click.option("--format", "format_name", metavar="NAME", help="latex (default), pdf, html, text, json, …")
@click.option("--title", default="", metavar="TEXT", help="The title of the sheet.")
@click.option("--questions", is_flag=True, help="The questions only.")
@click.option("--solutions", is_flag=True, help="The solutions only; they begin with the data.")
@click.option("--detail", default="full", metavar="NAME", help=DETAIL_HELP)
@click.option("--templates", metavar="FOLDER", help=TEMPLATES_HELP)
@click.option("--convention", "convention_name", metavar="NAME", help=CONVENTION_HELP)
def sheet(
    files: tuple[str, ...],
    target: str | None,
    format_name: str | None,
    title: str,
    questions: bool,  # noqa: FBT001 - click's signature
    solutions: bool,  # noqa: FBT001
    detail: str,
    templates: str | None,
    convention_name: str | None,
) -> None:
    """Put several problem FILEs on one sheet: all questions first, then all solutions.

    A problem that cannot be worked out keeps its place on the sheet, which says so; the reasons go to standard error.
    """
    if questions and solutions:
        raise UsageError("both --questions and --solutions are given", repair="leave both out for both")
    chosen = _sheet_format(format_name, target)
    told = _page(detail, templates, chosen.name)
    wanted = _Wanted(chosen, not solutions, not questions, convention=_convention(convention_name), **told)
    _check_target(target)
    texts = _texts(files)
    entries: list[Entry] = []
    codes: set[int] = set()
    progress = _Progress(len(texts))
    for number, (file, text) in enumerate(texts, 1):
        progress.show(number, Path(file).stem)
        name = shown(file, 200)
        entry, code, messages = _entry(number, file, text, wanted)
        entries.append(entry)
        codes.add(code)
        progress.clear()
        for message in messages:
            _say(message if message.startswith(f"{name}, ") else f"{name}: {message}")
    progress.say("typesetting" if wanted.format.name == "pdf" else "writing")
    whole = wanted.format.sheet(Sheet(title, tuple(entries), wanted.questions, wanted.solutions, wanted.templates))
    progress.clear()
    write(whole, target)
    sys.exit(next((code for code in _WORST_FIRST if code in codes), 0))


# -- before work starts -----------------------------------------------------------------------------------------------


def _sheet_format(name: str | None, target: str | None) -> Any:
    """Return the format; raises `UsageError` for one that has no sheets."""
    found = format_named(_format_of(name, target))
    if not hasattr(found, "sheet"):
        having = ", ".join(sorted(each.name for each in formats().values() if hasattr(each, "sheet")))
        raise UsageError(f"the format {found.name} is for one problem", where="--format", repair=f"use one of {having}")
    return found


def _check_target(target: str | None) -> None:
    """Say before the work that its result could not be written."""
    if target is None or target == "-":
        return
    path = Path(os.path.realpath(target))
    place = path if path.exists() and not path.is_file() else path.parent
    if path.is_dir() or not place.exists() or not os.access(place, os.W_OK):
        reason = "is a folder" if path.is_dir() else "cannot be written"
        raise InputError(reason, where=target[:200], repair="name a file in a folder that can be written")


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
            texts.append((file, _read(file)))
        except InputError as error:
            errors.append(error)
    if errors:
        raise ProblemErrors(tuple(errors))
    return texts


# -- one problem ------------------------------------------------------------------------------------------------------


def _entry(number: int, file: str, text: str, wanted: _Wanted) -> tuple[Entry, int, list[str]]:
    """Return a problem's place on the sheet, its exit code, and what there is to say about it."""
    entry = Entry(number, file, Path(file).stem if file != "-" else "")
    try:
        return _worked_out(entry, text, wanted)
    except Exception as error:  # noqa: BLE001 - whatever fails here, the other problems are not lost
        return replace(entry, failure=PHRASES["sheet_failed"]), *_failure(error)


def _worked_out(entry: Entry, text: str, wanted: _Wanted) -> tuple[Entry, int, list[str]]:
    """Return the entry with its parts; a solution that fails leaves the question where there is one."""
    data = parse(text, entry.file)
    entry = replace(entry, title=str(data.get("title") or entry.title)[:_LONGEST_TITLE])
    try:
        problem = validate(data, folder=Path(entry.file).parent)
        if wanted.questions:
            entry = replace(entry, question=_part(question_of(problem), wanted))
        results = problem.solve()
        if wanted.solutions:
            entry = replace(entry, solution=_part(problem.document(results), wanted))
    except Exception as error:  # noqa: BLE001 - as above
        return replace(entry, failure=PHRASES["sheet_failed"]), *_failure(error)
    try:
        unmet = mismatches(problem.viewed(results), problem.expect)
    except SymobsError as error:  # what is expected cannot be read: the solution stands all the same
        return entry, *_failure(error)
    if problem.expect:
        return entry, EXIT_NO if unmet else 0, unmet
    verdicts = [(result.task, result.verdict) for result in results if result.verdict in {"no", "undecided"}]
    messages = [f"{task}: {verdict}" for task, verdict in verdicts]
    codes = [EXIT_NO if verdict == "no" else EXIT_UNDECIDED for _, verdict in verdicts]
    return entry, min(codes, default=0), messages


def _part(document: Document, wanted: _Wanted) -> Any:
    """Return what the format will want of a question or a solution."""
    convention = wanted.convention or document.convention
    told = replace(document, convention=convention, detail=wanted.detail, templates=wanted.templates)
    return wanted.format.part(told)


def _failure(error: Exception) -> tuple[int, list[str]]:
    """Return the exit code of what failed, and its messages; TeX that is missing fails for all."""
    if isinstance(error, TypesettingError):
        raise error
    if isinstance(error, SymobsError):
        several = error.errors if isinstance(error, ProblemErrors) else (error,)
        return max(found.exit_code for found in several), str(error).split("\n")
    return EXIT_BUG, [f"internal error: {type(error).__name__}: {str(error)[:200]}; please report this"]


# -- what a terminal shows --------------------------------------------------------------------------------------------


class _Progress:
    """One line on a terminal, written over again and again; nothing where standard error is none."""

    def __init__(self, total: int) -> None:
        self.total = total
        self.shows = sys.stderr.isatty()

    def show(self, number: int, name: str) -> None:
        """Say which problem is being worked on."""
        self.say(f"{number}/{self.total} {name}")

    def say(self, text: str) -> None:
        """Write the line, no longer than any terminal is wide."""
        if self.shows:
            with suppress(OSError):
                click.echo(f"\r\x1b[K{shown(text, 70)}", nl=False, err=True)

    def clear(self) -> None:
        """Take the line away."""
        if self.shows:
            with suppress(OSError):
                click.echo("\r\x1b[K", nl=False, err=True)
