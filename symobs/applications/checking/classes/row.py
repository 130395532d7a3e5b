"""From the text of a problem and what a student handed in to a report: the unit of work of a class."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from symobs.applications.batch.jobs import Job, job
from symobs.applications.checking.answers.answer_file import MAX_BYTES, Answer, read_answer
from symobs.applications.checking.checker import Checked
from symobs.applications.checking.classes.submissions import Submission
from symobs.applications.checking.report.report import CheckReport
from symobs.ground.errors import InputError, ProblemErrors, SymobsError
from symobs.problem import read

if TYPE_CHECKING:
    from collections.abc import Mapping

#: What of a submission decides its report.
_HANDED_IN = ("text", "values", "convention", "steps")
DAMAGED = "this answer could not be checked: please report it"


@lru_cache(maxsize=32)
def solved(problem: str, folder: str = "") -> Checked:
    """Return the solved problem of a file's text; a process solves each problem once."""
    return Checked.of(read(problem, "problem", Path(folder) if folder else None))


def job_of(problem: str, folder: str, submission: Submission, show: str) -> Job:
    """Return the job of checking a submission: whoever hands in the same has the same one, and it is done once."""
    handed_in = {name: getattr(submission, name) for name in _HANDED_IN}
    data = {"problem": problem, "folder": folder, "show": show, "submission": handed_in}
    return job("check", data, submission.student)


def run(payload: Mapping[str, Any]) -> dict[str, Any]:
    """Return the row of a submission: its report, which names no student."""
    submission = Submission("", **payload["submission"])
    report = report_of(payload["problem"], payload["folder"], submission, payload["show"])
    return {"status": "done", "result": {**report.as_data(), "page": report.page}}


def recheck(_payload: Mapping[str, Any], _row: Mapping[str, Any]) -> None:
    """Return that nothing is looked at again: a verdict is the check."""


def report_of_row(row: Mapping[str, Any], problem: str, folder: str, show: str) -> CheckReport:
    """Return the report of a row: `undecided` where time, memory or the process came to an end."""
    if "result" in row:
        return CheckReport.from_data(row["result"])
    return solved(problem, folder).without_answer("", None, "undecided", "; ".join(row["error"]), show)


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
