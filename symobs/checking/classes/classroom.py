"""A class against a problem: every submission gets a report, equal ones are checked once, and all of it is counted."""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from typing import TYPE_CHECKING

from symobs.batching.engine import Settings
from symobs.batching.jobs import Budget
from symobs.batching.run import Batch
from symobs.checking.classes.row import job_of, report_of_row, solved
from symobs.checking.classes.submissions import read_submissions
from symobs.checking.classes.summary import as_markdown, marks, summary
from symobs.expect import available

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping
    from pathlib import Path

    from symobs.checking.checker import Checked

#: So many submissions are worth starting processes for.
_WORTH_CHILDREN = 24


def check_class(
    problem: str,
    folder: Path,
    path: Path,
    *,
    columns: Mapping[str, str],
    show: str,
    feedback: bool,
    work: Path,
    workers: int | None,
    budget: Budget,
    progress: Callable[[int, int], None],
) -> tuple[dict[str, str], int]:
    """Return the files of the results by name, and the exit code: 5 where some are undecided.

    Reports are kept in the folder `work` until the files are there: a run that was ended goes on from it.
    Raises `ProblemErrors` where the problem or the table as a whole cannot be used.
    """
    checked = solved(problem, str(folder))
    submissions = read_submissions(path, _parts(checked), columns)
    jobs = [job_of(problem, str(folder), submission, show) for submission in submissions.entries]
    few = workers is None and budget == Budget(None, None) and len(jobs) < _WORTH_CHILDREN
    allowed = Budget(*(given or usual for given, usual in zip(budget, Budget(), strict=True)))
    settings = Settings(allowed, chunk_seconds=0.5, recheck=0)
    run = Batch(lambda: jobs, work, workers=workers, in_process=few, settings=settings)
    for _ in run:
        progress(sum(run.counts.values()), len(jobs))
    done = {row["key"]: report_of_row(row, problem, str(folder), show) for row in run.rows()}
    reports = [
        replace(done[job.key], student=submission.student, variant=submission.variant)
        for job, submission in zip(jobs, submissions.entries, strict=True)
    ]
    found = summary(checked.problem.title, reports, submissions.superseded)
    files = {
        "results.jsonl": "".join(json.dumps(report.as_data(), ensure_ascii=False) + "\n" for report in reports),
        "marks.csv": marks(reports),
        "summary.md": as_markdown(found),
        "summary.json": json.dumps(found, indent=2, ensure_ascii=False) + "\n",
    }
    if feedback:
        files |= {f"feedback/{name_of(report.student)}.html": report.to_html() for report in reports}
    return files, 5 if any(report.verdict == "undecided" for report in reports) else 0


def name_of(student: str) -> str:
    """Return the name of a student's page: no path is made of what somebody handed in."""
    return hashlib.sha256(student.encode(errors="surrogatepass")).hexdigest()[:16]


def _parts(checked: Checked) -> list[str]:
    """Return the names that a column may have: fields, and task.field."""
    views = checked.views()
    named = [f"{view.task}.{name}" for view in views for name in available(view)]
    return [*dict.fromkeys(name for view in views for name in available(view)), *named]
