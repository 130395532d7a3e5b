"""From the text of a problem and what a student handed in to a report: the unit of work of a class."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.checking.answers.answer_file import MAX_BYTES, Answer, read_answer
from symobs.checking.checker import Checked
from symobs.errors import InputError, ProblemErrors, SymobsError
from symobs.problem import read

if TYPE_CHECKING:
    from collections.abc import Mapping

    from symobs.checking.classes.submissions import Submission
    from symobs.checking.report.report import CheckReport

DAMAGED = "this answer could not be checked: please report it"


@lru_cache(maxsize=32)
def solved(problem: str, folder: str = "") -> Checked:
    """Return the solved problem of a file's text; a process solves each problem once."""
    return Checked.of(read(problem, "problem", Path(folder) if folder else None))


def report_of(problem: str, folder: str, submission: Submission, show: str) -> CheckReport:
    """Return the report on a submission: an answer that cannot be read harms no other one, nor does a bug of ours."""
    checked = solved(problem, folder)
    try:
        answer = answer_of(submission)
        return checked.report(answer, show, None, submission.variant)
    except SymobsError as error:
        return checked.without_answer(submission.student, submission.variant, "unreadable", str(error), show)
    except (ArithmeticError, AssertionError, AttributeError, LookupError, RuntimeError, TypeError, ValueError):
        return checked.without_answer(submission.student, submission.variant, "undecided", DAMAGED, show)


def answer_of(submission: Submission) -> Answer:
    """Return what a submission says; raises `ProblemErrors` where it cannot be read."""
    if submission.text is not None:
        read_as = read_answer(submission.text)
        return Answer(
            submission.student,
            read_as.convention,
            read_as.symbols,
            read_as.let,
            read_as.values,
            read_as.steps,
            read_as.loose,
        )
    values: dict[str, Any] = {}
    size = len(submission.steps)
    for name, value in (submission.values or {}).items():
        size += len(str(value))
        task, _, field = name.rpartition(".")
        _within(values, task)[field] = value
    if size > MAX_BYTES:
        message = f"the answer is larger than {MAX_BYTES // 1024} kB"
        raise ProblemErrors((InputError(message, where="answer", repair="hand in the answer alone"),))
    lines = read_answer(submission.steps, "steps") if submission.steps.strip() else Answer()
    read_as = read_answer({"answer": values})
    return Answer(submission.student, submission.convention, (), {}, read_as.values, lines.steps)


def _within(values: dict[str, Any], task: str) -> dict[str, Any]:
    """Return the table of a task, or the whole one."""
    if not task:
        return values
    found = values.setdefault(task, {})
    return found if isinstance(found, dict) else {}


def key_of(submission: Submission) -> tuple[Any, ...]:
    """Return what two submissions share that hand in the same: they are checked once."""
    values: Mapping[str, Any] = submission.values or {}
    return (
        submission.text,
        str(sorted(values.items(), key=lambda item: item[0])),
        submission.convention,
        submission.steps,
    )
