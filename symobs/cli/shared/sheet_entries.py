"""The problems of a sheet, each worked out by itself: a failing one does not affect the others."""

from __future__ import annotations

import base64
import os
import pickle
import warnings
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.cli.shared.common import EXIT_BUG, EXIT_NO, EXIT_UNDECIDED, NOT_ENOUGH_MEMORY
from symobs.cli.shared.outcome import of_problem
from symobs.formula.phrases.languages import ENGLISH, Language, language_named
from symobs.ground.child_processes.budget import Budget
from symobs.ground.dataclass import dataclass
from symobs.ground.errors import OutOfBudget, ProblemErrors, SymobsError, TypesettingError
from symobs.pages.page.detail_level import FINAL
from symobs.pages.page.sheet import SheetEntry, points_in_words
from symobs.problem import parse, validate
from symobs.problem.expect import mismatches
from symobs.problem.question import question_of
from symobs.tasks.result.output_methods import PLAIN, WebPage

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence

    from symobs.cli.shared.time_and_memory import Progress
    from symobs.problem.sheet_file import SheetProblem
    from symobs.tasks.result import Document

    #: What is said of a problem, and the text of its file.
    Text = tuple[SheetProblem, str]
    #: The entry of a problem, its exit code and its messages.
    Found = tuple[SheetEntry, int, list[str]]
    #: Called with how many problems are done or begun, and the name of one.
    Show = Callable[[int, str], None]

_LONGEST_TITLE = 300
#: So many problems are worth starting processes for: of 12, these would take four thirds of the time, of 24 five sixths, of
#: 118 half of it.
_WORTH_CHILDREN = 24


@dataclass
class Wanted:
    """The options of the command."""

    format: Any
    questions: bool
    solutions: bool
    detail: str
    references: str = "short"
    digits: int | None = None
    templates: Path | None = None
    web: WebPage = PLAIN
    language: str = ""
    convention: Any = None
    timeout: float | None = None
    memory: float | None = None
    final_answers: bool = False
    #: Whether every solution stands below its question, and need not say again where it comes from.
    is_exam: bool = False
    #: Whether more than the question is wanted.
    is_solved: bool = True


# -- many problems ----------------------------------------------------------------------------------------------------


def worked_out_all(texts: Sequence[Text], wanted: Wanted, show: Show) -> Iterator[Found]:
    """Yield entry, exit code and messages of every problem; many are worked out on all processors."""
    if len(texts) >= _WORTH_CHILDREN and (os.cpu_count() or 1) > 1:
        yield from _by_children(texts, wanted, show)
        return
    for number, (asked, text) in enumerate(texts, 1):
        show(number, Path(asked.file).stem)
        yield _bounded_entry(number, asked, text, wanted)


def _by_children(texts: Sequence[Text], wanted: Wanted, show: Show) -> Iterator[Found]:
    """Yield the same, worked out by kept child processes, in the order of the sheet."""
    orders = [(number, *each, wanted) for number, each in enumerate(texts, 1)]
    rows = _rows(orders, wanted, show)
    late = [order for order, row in zip(orders, rows, strict=True) if row["status"] == "undecided"]
    asked_alone = [
        (*order[:3], replace(wanted, solutions=False, final_answers=False, is_solved=False)) for order in late
    ]
    left = dict(zip((order[0] for order in late), _rows(asked_alone, wanted, show), strict=True)) if late else {}
    for (number, asked, _, _), row in zip(orders, rows, strict=True):
        if row["status"] == "done":
            found = _unpacked(row["result"])
            if isinstance(found, TypesettingError):
                raise found
            yield found
        elif row["status"] == "undecided":
            known = left[number]
            entry = _unpacked(known["result"])[0] if known["status"] == "done" else _empty(number, asked)
            yield _said_failed(entry, "sheet_undecided", wanted), EXIT_UNDECIDED, [_undecided(row["error"][0])]
        else:
            yield _said_failed(_empty(number, asked), "sheet_failed", wanted), EXIT_BUG, list(row["error"])


def _undecided(reason: str) -> str:
    """Return the message for a problem that takes more than it is allowed."""
    option = "--memory" if "memory" in reason else "--timeout"
    return f"undecided: {reason}; give more with {option}, ask for less, or put numbers in place of symbols"


def _rows(orders: Sequence[tuple[Any, ...]], wanted: Wanted, show: Show) -> list[dict[str, Any]]:
    """Return the rows of some problems, in their order."""
    from symobs.applications.batch.engine import (  # noqa: PLC0415 - a short sheet pays for none of it
        Settings,
        work,
        workforce,
    )
    from symobs.applications.batch.jobs import job  # noqa: PLC0415

    jobs = [job("sheet-entry", {"asked": _packed(order)}, order[1].file) for order in orders]
    budget = Budget(wanted.timeout, wanted.memory)
    found: dict[str, dict[str, Any]] = {}
    with workforce() as force:
        for chunk in work(iter(jobs), force, Settings(budget, chunk_seconds=0.5, recheck=0)):
            found |= {row["key"]: row for row in chunk.rows}
            show(len(found), Path(chunk.rows[-1]["name"]).stem)
    return [found[each.key] for each in jobs]


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of one problem of a sheet, as a child process works it out."""
    with warnings.catch_warnings(record=True) as warned:
        number, asked, text, wanted = _unpacked(payload["asked"])
        try:
            entry, code, messages = _entry(number, asked, text, wanted, lambda _: None)
        except TypesettingError as error:
            return {"status": "done", "result": _packed(error)}
    warning_lines = [f"{each.category.__name__}: {each.message}" for each in warned]
    return {"status": "done", "result": _packed((entry, code, [*warning_lines, *messages]))}


def recheck(_payload: Mapping[str, Any], _row: Mapping[str, Any]) -> None:
    """Return that nothing is looked at again: every line of a page was checked where it was written."""


def _packed(value: object) -> str:
    return base64.b64encode(pickle.dumps(value)).decode()


def _unpacked(text: str) -> Any:
    return pickle.loads(base64.b64decode(text))  # noqa: S301 - this process and its own children alone


# -- one problem ------------------------------------------------------------------------------------------------------


def _bounded_entry(number: int, asked: SheetProblem, text: str, wanted: Wanted) -> Found:
    """Return the value of `_entry`, or the partial entry if its budget is exhausted."""
    if wanted.timeout is None and wanted.memory is None:
        return _entry(number, asked, text, wanted, lambda _: None)
    from symobs.cli.shared.time_and_memory import within  # noqa: PLC0415 - a budget costs nothing where there is none

    try:
        budget = Budget(wanted.timeout, wanted.memory)
        return within(budget, lambda report_progress: _entry(number, asked, text, wanted, report_progress))
    except OutOfBudget as error:
        left: Any = error.facts["left"] or _empty(number, asked)
        return _said_failed(left, "sheet_undecided", wanted), error.exit_code, [str(error)]


def _said_failed(entry: SheetEntry, phrase: str, wanted: Wanted) -> SheetEntry:
    """Return an entry that says what became of it, in the language of the sheet."""
    code = wanted.language or entry.language
    return replace(entry, failure=language_named(code or ENGLISH.code).phrases[phrase], language=code)


def _empty(number: int, asked: SheetProblem) -> SheetEntry:
    title = Path(asked.file).stem if asked.file != "-" else ""
    return SheetEntry(number, asked.file, title, points=asked.points, hint=asked.hint, version=asked.version)


def _entry(number: int, asked: SheetProblem, text: str, wanted: Wanted, report_progress: Progress) -> Found:
    """Return the entry of a problem, its exit code, and its messages."""
    entry = _empty(number, asked)
    try:
        return _worked_out(entry, asked, text, wanted, report_progress)
    except Exception as error:  # noqa: BLE001 - whatever fails here, the other problems are not lost
        return _failed(entry, error, wanted)


def _worked_out(entry: SheetEntry, asked: SheetProblem, text: str, wanted: Wanted, report_progress: Progress) -> Found:
    """Return the entry with its parts; if the solution fails, with the question alone."""
    data = parse(text, entry.file)
    title, variant = str(data.get("title") or entry.title)[:_LONGEST_TITLE], str(data.get("variant") or "")
    entry = replace(entry, title=title, variant=variant)
    try:
        problem = validate(data, folder=Path(entry.file).parent)
        entry = replace(entry, language=wanted.language or problem.language)
        if wanted.questions:
            question = replace(
                question_of(problem),
                handout=_handout(asked, len(problem.tasks), wanted, language_named(entry.language)),
            )
            entry = replace(entry, question=_part(question, replace(wanted, web=wanted.web.of_question)))
        report_progress(entry)
        if not wanted.is_solved:
            return entry, 0, []
        results = problem.solve()
        document = problem.document(results)
        if wanted.solutions:
            shown = document
            if asked.version:
                from symobs.cli.shared.sheet_versions import steps_of  # noqa: PLC0415 - for keys to versions only

                steps = steps_of(problem, results, asked.points, language_named(entry.language))
                shown = replace(document, handout=(steps,))
            elif wanted.is_exam and wanted.questions:  # it stands below its question
                shown = replace(document, source="", text="", is_below=True)
            elif wanted.questions:  # which say where they come from
                shown = replace(document, source="")
            entry = replace(entry, solution=_part(shown, replace(wanted, web=of_problem(wanted.web, data))))
        if wanted.questions and wanted.final_answers:
            entry = replace(entry, answer=_part(document, replace(wanted, detail=FINAL, web=wanted.web.of_question)))
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


def _handout(asked: SheetProblem, parts: int, wanted: Wanted, language: Language) -> tuple[Any, ...]:
    """Return what a sheet adds to each part of a question: its points, and room for answers where none are given."""
    each = asked.points if len(asked.points) == parts > 1 else ()
    words = [points_in_words((points,), language) for points in each] or [""] * parts
    space = None if wanted.solutions and not asked.version else asked.space
    return tuple((word, space) for word in words) if each or space else ()


def _part(document: Document, wanted: Wanted) -> Any:
    """Return the part of a sheet for a question or a solution, in its format."""
    convention = wanted.convention or document.convention
    digits = document.digits if wanted.digits is None else wanted.digits
    of_page: dict[str, Any] = {
        "detail": wanted.detail,
        "references": wanted.references,
        "digits": digits,
        "language": wanted.language or document.language,
    }
    of_page |= {"templates": wanted.templates, "web": wanted.web}
    return wanted.format.part(replace(document, convention=convention, **of_page))


def _failed(entry: SheetEntry, error: Exception, wanted: Wanted) -> tuple[SheetEntry, int, list[str]]:
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
