"""The command `sheet`: several problems on one sheet; a failing one does not affect the others."""

from __future__ import annotations

import base64
import os
import pickle
import sys
import warnings
from contextlib import suppress
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from symobs._dataclass import dataclass
from symobs.cli.shared.common import (
    EXIT_BUG,
    EXIT_NO,
    EXIT_UNDECIDED,
    NOT_ENOUGH_MEMORY,
    chosen_format,
    place_of,
    read_file,
    write_message,
)
from symobs.cli.shared.options import LIMITS, AFile, options
from symobs.cli.shared.outcome import convention_of, page_of
from symobs.cli.shared.output import check_target, write
from symobs.errors import InputError, OutOfBudget, ProblemErrors, SymobsError, TypesettingError, UsageError
from symobs.expect import mismatches
from symobs.expression.source import shown
from symobs.phrases.languages import ENGLISH, language_named
from symobs.problem import parse, validate
from symobs.problem.question import question_of
from symobs.render.page.sheet import Sheet, SheetEntry
from symobs.result import format_named, formats, tasks

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from symobs.cli.shared.time_and_memory import Progress
    from symobs.result import Document

_LONGEST_TITLE = 300
#: So many problems are worth starting processes for.
_WORTH_CHILDREN = 24
_WORST_FIRST = (EXIT_BUG, InputError.exit_code, EXIT_NO, EXIT_UNDECIDED)


@dataclass(frozen=True)
class _Wanted:
    """The options of the command."""

    format: Any
    questions: bool
    solutions: bool
    detail: str
    templates: Path | None = None
    language: str = ""
    convention: Any = None
    timeout: float | None = None
    memory: float | None = None


@click.command("sheet")
@click.argument("files", nargs=-1, type=AFile(), metavar="FILE...")
@options("format", "target")
@click.option("--title", default="", metavar="TEXT", help="The title of the sheet.")
@click.option("--questions", is_flag=True, help="The questions only.")
@click.option("--solutions", is_flag=True, help="The solutions only; they begin with the data.")
@options("detail", "language", "templates", "convention", *LIMITS)
def command(
    files: tuple[str, ...],
    target: str | None,
    format_name: str | None,
    title: str,
    questions: bool,  # noqa: FBT001 - click's signature
    solutions: bool,  # noqa: FBT001
    detail: str,
    language: str | None,
    templates: str | None,
    convention_name: str | None,
    timeout: float | None,
    memory: float | None,
) -> None:
    """Put several problem FILEs on one sheet: all questions first, then all solutions.

    A problem that cannot be worked out keeps its place on the sheet, which says so; the reasons go to standard error.
    --timeout and --memory are for each problem: one that takes more loses no other.
    """
    if questions and solutions:
        raise UsageError("both --questions and --solutions are given", repair="leave both out for both")
    chosen = _sheet_format(format_name, target)
    told = page_of(detail, language, templates, chosen.name)
    wanted = _Wanted(
        chosen,
        not solutions,
        not questions,
        convention=convention_of(convention_name),
        timeout=timeout,
        memory=memory,
        **told,
    )
    check_target(target)
    texts = _texts(files)
    if timeout is not None or memory is not None:
        tasks()  # what all problems need is imported once, not in the process of each
    entries: list[SheetEntry] = []
    codes: set[int] = set()
    progress = _Progress(len(texts))
    for number, (entry, code, messages) in enumerate(_worked_out_all(texts, wanted, progress), 1):
        name = place_of(texts[number - 1][0])
        entries.append(entry)
        codes.add(code)
        progress.clear()
        for message in messages:
            write_message(message if message.startswith(f"{name}, ") else f"{name}: {message}")
    progress.say("typesetting" if wanted.format.name == "pdf" else "writing")
    whole = wanted.format.sheet(Sheet(title, tuple(entries), wanted.questions, wanted.solutions, wanted.templates))
    progress.clear()
    write(whole, target)
    sys.exit(next((code for code in _WORST_FIRST if code in codes), 0))


# -- before work starts -----------------------------------------------------------------------------------------------


def _sheet_format(name: str | None, target: str | None) -> Any:
    """Return the format; raises `UsageError` for one that has no sheets."""
    found = format_named(chosen_format(name, target))
    if not hasattr(found, "sheet"):
        having = ", ".join(sorted(each.name for each in formats().values() if hasattr(each, "sheet")))
        raise UsageError(f"the format {found.name} is for one problem", where="--format", repair=f"use one of {having}")
    return found


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


# -- many problems ----------------------------------------------------------------------------------------------------


def _worked_out_all(
    texts: Sequence[tuple[str, str]], wanted: _Wanted, progress: _Progress
) -> Iterator[tuple[SheetEntry, int, list[str]]]:
    """Yield entry, exit code and messages of every problem; many without a budget are worked out on all processors."""
    if wanted.timeout is None and wanted.memory is None and len(texts) >= _WORTH_CHILDREN and (os.cpu_count() or 1) > 1:
        yield from _by_children(texts, wanted, progress)
        return
    for number, (file, text) in enumerate(texts, 1):
        progress.show(number, Path(file).stem)
        yield _bounded_entry(number, file, text, wanted)


def _by_children(
    texts: Sequence[tuple[str, str]], wanted: _Wanted, progress: _Progress
) -> Iterator[tuple[SheetEntry, int, list[str]]]:
    """Yield the same, worked out by kept child processes, in the order of the sheet."""
    from symobs.batching.engine import Settings, work  # noqa: PLC0415 - a short sheet pays for none of it
    from symobs.batching.executors import workforce  # noqa: PLC0415
    from symobs.batching.jobs import Budget, job  # noqa: PLC0415

    asked = [(number, file, text, wanted) for number, (file, text) in enumerate(texts, 1)]
    jobs = [job("sheet-entry", {"asked": _packed(each)}, each[1]) for each in asked]
    found: dict[str, Any] = {}
    with workforce() as force:
        for chunk in work(iter(jobs), force, Settings(Budget(None, None), chunk_seconds=0.5, recheck=0)):
            found |= {row["key"]: row for row in chunk.rows}
            progress.show(len(found), Path(chunk.rows[-1]["name"]).stem)
    for each, its_job in zip(asked, jobs, strict=True):
        row = found[its_job.key]
        if "result" in row:
            yield _unpacked(row["result"])
        else:
            entry = _said_failed(_empty(*each[:2]), "sheet_failed", wanted)
            yield entry, EXIT_UNDECIDED if row["status"] == "undecided" else EXIT_BUG, list(row["error"])


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of one problem of a sheet, as a child process works it out."""
    with warnings.catch_warnings(record=True) as warned:
        number, file, text, wanted = _unpacked(payload["asked"])
        entry, code, messages = _entry(number, file, text, wanted, lambda _: None)
    told = [f"{each.category.__name__}: {each.message}" for each in warned]
    return {"status": "done", "result": _packed((entry, code, [*told, *messages]))}


def recheck(_payload: Mapping[str, Any], _row: Mapping[str, Any]) -> None:
    """Return that nothing is looked at again: every line of a page was checked where it was written."""


def _packed(value: object) -> str:
    return base64.b64encode(pickle.dumps(value)).decode()


def _unpacked(text: str) -> Any:
    return pickle.loads(base64.b64decode(text))  # noqa: S301 - this process and its own children alone


# -- one problem ------------------------------------------------------------------------------------------------------


def _bounded_entry(number: int, file: str, text: str, wanted: _Wanted) -> tuple[SheetEntry, int, list[str]]:
    """Return the value of `_entry`, or the partial entry if its budget is exhausted."""
    if wanted.timeout is None and wanted.memory is None:
        return _entry(number, file, text, wanted, lambda _: None)
    from symobs.cli.shared.time_and_memory import Budget, within  # noqa: PLC0415 - a budget costs nothing where there is none

    try:
        budget = Budget(wanted.timeout, wanted.memory)
        return within(budget, lambda report_progress: _entry(number, file, text, wanted, report_progress))
    except OutOfBudget as error:
        left: Any = error.facts["left"] or _empty(number, file)
        return _said_failed(left, "sheet_undecided", wanted), error.exit_code, [str(error)]


def _said_failed(entry: SheetEntry, phrase: str, wanted: _Wanted) -> SheetEntry:
    """Return an entry that says what became of it."""
    language = language_named(wanted.language or entry.language or ENGLISH.code)
    return replace(entry, failure=language.phrases[phrase], language=wanted.language or entry.language)


def _empty(number: int, file: str) -> SheetEntry:
    return SheetEntry(number, file, Path(file).stem if file != "-" else "")


def _entry(
    number: int, file: str, text: str, wanted: _Wanted, report_progress: Progress
) -> tuple[SheetEntry, int, list[str]]:
    """Return the entry of a problem, its exit code, and its messages."""
    entry = _empty(number, file)
    try:
        return _worked_out(entry, text, wanted, report_progress)
    except Exception as error:  # noqa: BLE001 - whatever fails here, the other problems are not lost
        return _failed(entry, error, wanted)


def _worked_out(
    entry: SheetEntry, text: str, wanted: _Wanted, report_progress: Progress
) -> tuple[SheetEntry, int, list[str]]:
    """Return the entry with its parts; if the solution fails, with the question alone."""
    data = parse(text, entry.file)
    entry = replace(entry, title=str(data.get("title") or entry.title)[:_LONGEST_TITLE])
    try:
        problem = validate(data, folder=Path(entry.file).parent)
        entry = replace(entry, language=wanted.language or problem.language)
        if wanted.questions:
            entry = replace(entry, question=_part(question_of(problem), wanted))
        report_progress(entry)
        results = problem.solve()
        if wanted.solutions:
            entry = replace(entry, solution=_part(problem.document(results), wanted))
    except Exception as error:  # noqa: BLE001 - as above
        return _failed(entry, error, wanted)
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
    """Return the part of a sheet for a question or a solution, in its format."""
    convention = wanted.convention or document.convention
    language = wanted.language or document.language
    told = replace(document, convention=convention, detail=wanted.detail, language=language, templates=wanted.templates)
    return wanted.format.part(told)


def _failed(entry: SheetEntry, error: Exception, wanted: _Wanted) -> tuple[SheetEntry, int, list[str]]:
    """Return the entry of a failed problem; exhausted memory is reported by the budget."""
    if wanted.memory is not None and isinstance(error, MemoryError | SystemError | ImportError):
        raise error
    phrase = "sheet_undecided" if isinstance(error, MemoryError) else "sheet_failed"
    return _said_failed(entry, phrase, wanted), *_failure(error)


def _failure(error: Exception) -> tuple[int, list[str]]:
    """Return exit code and messages of a failure; missing TeX fails for all problems."""
    if isinstance(error, TypesettingError):
        raise error
    if isinstance(error, MemoryError):
        return EXIT_UNDECIDED, [NOT_ENOUGH_MEMORY]
    if isinstance(error, SymobsError):
        several = error.errors if isinstance(error, ProblemErrors) else (error,)
        return max(found.exit_code for found in several), str(error).split("\n")
    return EXIT_BUG, [f"internal error: {type(error).__name__}: {str(error)[:200]}; please report this"]


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
